"""What a report says of a range of load factors."""

from __future__ import annotations

from limitblocks.evidence.range_answer import Origin
from limitblocks.evidence.range_result import Extreme, LoadFactorRange
from limitblocks.model import Model
from limitblocks.reports.document import Table
from limitblocks.reports.rows import AS_READ, limits
from limitblocks.reports.section import Design, Section
from limitblocks.reports.words import cut, figures

MEANING = (
    "Without dilatancy many load factors solve the equations. The large one is that of the load path. "
    "Those reached start from admissible states of the permanent loads, which construction, settlement and "
    "creep may have left: the uncertainty to design for. The certified ones solve too, but nothing says "
    "that loading leads there; the least is often a block that slips out because hardly anything presses "
    "on it. What was not found may exist."
)
HEADS = ("Load factor", "Origin", "Way", "What moves")


def range_section(_model: Model, result: LoadFactorRange) -> Section:
    """Return the section of a range of load factors."""
    shown = result.load_path or (result.answers[0] if result.answers else None)
    (reached, below), (lowest, highest) = result.reached, result.certified
    (tried, ended), (drawn, led) = result.paths, result.mechanisms
    rows = tuple(
        (figures(one.load_factor, 6), one.origin.value, one.solution.how, one.mechanism)
        for one in result.answers
    )
    ends = [(word, end) for word, end in (("Least", result.least), ("Greatest", result.greatest)) if end]
    told = AS_READ if result.from_file else ""
    arrived = (one for one in result.answers if one.origin is not Origin.SEARCHED)
    return Section(
        title="Range of load factors",
        meaning=MEANING,
        headline=cut(result.load_path.load_factor) if result.load_path else "none",
        quantity="load factor α of the load path",
        values=(
            ("Reached", _between(reached, below), "paths from permanent-load states"),
            ("Certified", _between(lowest, highest), "reachable or not"),
            *((f"{word} of all", str(end), told or _source(end)) for word, end in ends),
            ("Solutions without gap", _spans(result.intervals), told or "every value solves, by convexity"),
            *(limits(shown.solution) if shown else ()),
            ("Wedging", str(result.wedging), told),
            ("Paths", f"{ended} of {tried}", "ended at a solution"),
            ("Mechanisms", f"{led} of {drawn}", "drawn at random, led to one"),
        ),
        judged=(shown.check.residuals, result.tolerance) if shown else None,
        rates=shown.solution.displacement_rates if shown else None,
        designs=tuple(
            Design(one.load_factor, "range of load factors", one.solution.remarks, one.solution.dilatancy)
            for one in arrived
        ),
        warnings=result.remarks
        + (() if result.complete else ("the search was stopped early, by the time limit or by hand",)),
        parts=(Table.of("Certified load factors", HEADS, rows, right=(0,)),),
    )


def _source(end: Extreme) -> str:
    """What says so: the program, or for a load factor without limit a ray of stresses."""
    if end.load_factor == float("inf"):
        return "stresses that balance the live load alone can be added to an answer without end"
    return f"mixed-integer program, gap {end.gap:.1e}"


def _between(least: float, greatest: float) -> str:
    found = least <= greatest  # NaN where nothing was found
    return f"{figures(least, 6)} to {figures(greatest, 6)}" if found else "none"


def _spans(intervals: tuple[tuple[float, float], ...]) -> str:
    return ", ".join(f"{figures(low, 6)} to {figures(high, 6)}" for low, high in intervals) or "none"

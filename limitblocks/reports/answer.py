"""The one number to design with, why it is the one, and how it compares with what is required."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import floor, isfinite, log10
from typing import Any

from limitblocks.evidence.associated import Bounds
from limitblocks.evidence.load_path_result import LoadPath
from limitblocks.evidence.range_answer import Origin
from limitblocks.evidence.range_result import LoadFactorRange
from limitblocks.evidence.results import Nonassociated
from limitblocks.model import Model
from limitblocks.reports.claims import CheckedClaim
from limitblocks.reports.words import as_acceleration

CERTIFIED = (
    "Stresses, mechanism and multipliers that satisfy equilibrium, yield, flow rule and complementarity, "
    "Eqs (54)-(59), prove it, recomputed without the solver. Joints that slide do not dilate by the friction "
    "angle, as in real masonry. Other solutions may exist at other load factors."
)
LEAST = "It is the least of the {} certified load factors of this report that loading leads to."
UPPER = (
    "It is the static bound for joints that dilate by the friction angle (associated flow). No certified "
    "load factor without that dilatancy is in this report."
)
WARNING = (
    "This number is an upper estimate: real friction dilates less than associated flow assumes, and the "
    "structure may collapse at a smaller load factor. The non-associated analysis gives one to design with."
)
NONE = "No certified load factor is in this report."
UNDEMANDED = "Safety: no required load factor (demand) was stated, so this report says nothing about safety."


@dataclass(frozen=True)
class Answer:
    """Load factor to design with.

    Attributes
    ----------
    load_factor : float, optional
        None where the report has none.
    certified : bool
        Whether it is a certified non-associated one; else it is an upper estimate.
    source : str
        Which result it is of.
    reason : str
        Why it is the one.
    """

    load_factor: float | None = None
    certified: bool = False
    source: str = ""
    reason: str = NONE

    @property
    def number(self) -> str:
        """The load factor as text."""
        if self.load_factor is None:
            return "none"
        return f"{'' if self.certified else '≤ '}{self.load_factor:#.4g}"

    def quantity(self, model: Model) -> str:
        """What the number is, in words."""
        if self.load_factor is None:
            return "no load factor to design with"
        kind = f"load factor α to design with, {'certified' if self.certified else 'upper estimate'}"
        said = as_acceleration(model, self.load_factor)
        return f"{kind}, {self.source}" + (f": {said}" if said else "")


@dataclass(frozen=True)
class Verdict:
    """How the load factor compares with the one that is required."""

    demand: float
    ratio: float
    text: str


def answer(results: Sequence[Any]) -> Answer:
    """Return the load factor to design with: the least certified non-associated one that loading leads to.

    Without one it is the least static bound, as an upper estimate.
    """
    certified = sorted(_certified(results))
    if certified:
        load_factor, source = certified[0]
        least = f"{LEAST.format(len(certified))} " if len(certified) > 1 else ""
        return Answer(load_factor, True, source, least + CERTIFIED)
    bounds = [one.lower for one in results if isinstance(one, Bounds)]
    bounds += [one.load_factor for one in results if isinstance(one, CheckedClaim) and one.check.accepted]
    if bounds:
        return Answer(min(bounds), False, "static bound", UPPER)
    return Answer()


def verdict(found: Answer, demand: float) -> Verdict | None:
    """Return the load factor over the demand, in words; None where there is no load factor."""
    if found.load_factor is None:
        return None
    ratio = found.load_factor / demand
    word = "load factor" if found.certified else "upper estimate of the load factor"
    said = f"the {word} {found.load_factor:.4g} is {rounded_down(ratio)} times the demand {demand:.4g}"
    if ratio < 1.0:
        meaning = "the demand is not reached"
    elif found.certified:
        meaning = "the demand is reached"
    else:
        meaning = "whether the demand is reached is open, because real friction may give less"
    return Verdict(demand, ratio, f"{said}: {meaning}. This is no statement of compliance with a code.")


def _certified(results: Sequence[Any]) -> Iterator[tuple[float, str]]:
    """Load factors with their source: of results, and of a range those that a load path reached."""
    for result in results:
        if isinstance(result, Nonassociated | LoadPath):
            end = result.collapse if isinstance(result, LoadPath) else result
            word = "load path" if isinstance(result, LoadPath) else "non-associated solution"
            if end.accepted and isfinite(end.load_factor):
                yield end.load_factor, word
        elif isinstance(result, LoadFactorRange):
            reached = (one for one in result.answers if one.origin is not Origin.SEARCHED)
            yield from ((one.load_factor, "range of load factors") for one in reached)
        elif isinstance(result, CheckedClaim) and result.certified:
            yield result.load_factor, "claimed solution, checked"


def rounded_down(ratio: float) -> str:
    """Three digits, never more than there is: .9996 is not 1.00."""
    digits = 2 - floor(log10(abs(ratio))) if ratio else 2
    scale = 10.0**digits
    return f"{floor(ratio * scale * (1 + 1e-12)) / scale:.{max(digits, 0)}f}"

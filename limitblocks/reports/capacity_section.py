"""What a report says of a capacity curve: every point with its evidence."""

from __future__ import annotations

from limitblocks.errors import few
from limitblocks.mechanics.loads.load import triple
from limitblocks.model import Model
from limitblocks.practice import CapacityCurve, CapacityPoint
from limitblocks.reports.curve import Curve, line_curve
from limitblocks.reports.document import Table
from limitblocks.reports.section import Section
from limitblocks.reports.words import cut, figures
from limitblocks.shown import coordinates


def capacity_section(_model: Model, curve: CapacityCurve) -> Section:
    """Return the section of a capacity curve."""
    first, last = curve.points[0], curve.points[-1]
    filled = last.displacement > curve.proven_to
    beyond = (
        (f"beyond {curve.proven_to:.4g} m joints of the capacity curve press across their gaps",)
        if filled
        else ()
    )
    alone = (f"the curve is its first point alone: {curve.ended}",) if len(curve.points) == 1 else ()
    # what snaps through zero has its last point beyond
    end = last.displacement if curve.zero is None else curve.zero
    proven = figures(curve.proven_to, 6)
    ended = "end of the curve" if curve.zero is None else "load factor zero"
    return Section(
        title="Capacity curve",
        meaning=(
            "The mechanism without dilatancy moves the blocks by finite screws; contacts are found anew and "
            "each point is an answer of its own, recomputed without the solver. Slow motion: no impact, no "
            "rebound."
        ),
        headline=f"{cut(end)} m",
        quantity=f"displacement at {ended}",
        values=(
            ("Load factor at rest", figures(first.load_factor, 7), "without dilatancy, the first point"),
            ("Ends", f"{figures(end, 6)} m", curve.ended),
            ("No joint presses across a gap up to", f"{proven} m", "proven for the geometry"),
            ("Control point", coordinates(curve.control.point.tolist()), f"m, on {curve.control.block}"),
            ("Direction", triple(curve.control.direction.tolist()), "in which its displacement is measured"),
        ),
        judged=(last.result.residuals, last.result.tolerance),
        warnings=alone + beyond + curve.remarks,
        curve=_capacity_curve(curve),
        parts=(_points(curve),),
    )


def _points(curve: CapacityCurve) -> Table:
    rows = [
        (figures(one.displacement, 6), f"{_clean(one.load_factor):.6g}", _changes(one),
         few(one.across) or "none", f"{one.result.residuals.worst.value:.1e}")
        for one in curve.points
    ]  # fmt: skip
    heads = ("Displacement, m", "Load factor", "Contacts that change", "Presses across a gap", "Residual")
    return Table.of("Points of the capacity curve", heads, rows, right=(0, 1, 4))


def _changes(point: CapacityPoint) -> str:
    alone = f"the dead loads alone do not stand: solved from {-point.shift:.3g} of the live load"
    return few([*point.changes, *[alone] * bool(point.shift)]) or "none"


def _capacity_curve(curve: CapacityCurve) -> Curve | None:
    if len(curve.points) < 2:
        return None
    control = curve.control
    label = f"displacement of {control.block} along {triple(control.direction.tolist())}, m"
    title = "Load factor against displacement"
    said = [f"{one.displacement:.4g} m: load factor {_clean(one.load_factor):.4g}" for one in curve.points]
    caption = f"{title}, a dot a point with an answer of its own: {curve.ended}."
    return line_curve((title, caption, label, "load factor"), (curve.displacements, curve.load_factors), said)


def _clean(load_factor: float) -> float:
    """The load factor without the rounding errors about its zero."""
    return round(load_factor, 9) + 0.0

"""What a report says of a capacity curve and of a support that settles until the structure falls."""

from __future__ import annotations

from limitblocks.drawing.picture import mechanism_picture
from limitblocks.errors import few
from limitblocks.mechanics.loads.load import triple
from limitblocks.model import Model
from limitblocks.practice import CapacityCurve, CapacityPoint, SettlementCurve
from limitblocks.reports.curve import Curve, line_curve
from limitblocks.reports.document import Figure, Table
from limitblocks.reports.section import LEGEND, Section
from limitblocks.reports.words import cut, figures, kilonewtons
from limitblocks.shown import coordinates

FOLLOWING = (
    "The structure at a settlement of {:.6g} m, drawn as it then is, and the mechanism that follows "
    "what settles, {:.3g} times, linearly. Dashed: the moving blocks before they move on."
)
_GAPS, _FALLS = "no joint presses across a gap", ", then it falls"


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
        own=True,
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
        parts=(_capacity_points(curve),),
    )


def _capacity_points(curve: CapacityCurve) -> Table:
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


def collapse_section(_model: Model, curve: SettlementCurve) -> Section:
    """Return the section of a support that settles until the structure falls."""
    first, last = curve.points[0], curve.points[-1]
    end = last.found.result or last.found.bounds
    fallen = curve.falls is not None
    flow = "without dilatancy" if last.found.result else "of associated flow"
    upper = "" if curve.falls is None else f"{figures(curve.falls, 7)} m"
    return Section(
        title=f"Settlement of {few(curve.supports)} until collapse",
        meaning=(
            f"Under the dead loads {first.found.settling.gives_way}. "
            f"The mechanism {flow} that follows moves the blocks by finite screws, "
            "contacts are found anew, and the least reaction of the displaced structure is an answer of its "
            "own, recomputed without the solver. Where no stresses within yield carry the dead loads any "
            "more, it falls (static theorem). Slow motion: no impact."
        ),
        headline=f"{cut(curve.stands_to)} m",
        quantity="settlement up to which " + (_GAPS if curve.filled else "it stands" + _FALLS * fallen),
        own=True,
        values=(
            ("Stands up to", f"{figures(curve.stands_to, 7)} m", _GAPS),
            *(
                (("Falls at", upper, "proven: no equilibrium of the structure so displaced"),)
                if fallen
                else ()
            ),
            ("Reaction at rest", kilonewtons(first.reaction), f"least one, {flow}"),
            ("Reaction at the end", kilonewtons(last.reaction), curve.ended),
        ),
        judged=(end.residuals, end.tolerance),
        warnings=curve.filled + curve.remarks,
        curve=_settlement_curve(curve),
        parts=(_settled_points(curve), _settled_figure(curve)),
    )


def _settled_figure(curve: SettlementCurve) -> Figure:
    last = curve.points[-1]
    end = last.found.result or last.found.bounds
    picture = mechanism_picture(last.found.settling.model, end.displacement_rates, pushed=False)
    drawn = picture.sheet(f"The structure at a settlement of {last.displacement:.6g} m")
    return Figure(drawn, FOLLOWING.format(last.displacement, picture.magnification), LEGEND)


def _settled_points(curve: SettlementCurve) -> Table:
    rows = [
        (figures(one.displacement, 7), kilonewtons(one.found.lower), kilonewtons(one.found.upper),
         "" if one.found.nonassociated is None else kilonewtons(one.found.nonassociated),
         few(one.changes) or "none", few(one.across) or "none")
        for one in curve.points
    ]  # fmt: skip
    heads = ("Settlement, m", "Mechanism", "Stress state", "Without dilatancy", "Contacts that change",
             "Presses across a gap")  # fmt: skip
    return Table.of("Points of the settlement: least reaction at each", heads, rows, right=(0, 1, 2, 3))


def _settlement_curve(curve: SettlementCurve) -> Curve | None:
    if len(curve.points) < 2:
        return None
    label = f"settlement of {few(curve.supports)} along {triple(curve.direction.tolist())}, m"
    title = "Least reaction against settlement"
    said = [f"{one.displacement:.6g} m: {kilonewtons(one.reaction)}" for one in curve.points]
    caption = f"{title}, a dot a point with an answer of its own: {curve.ended}."
    return line_curve(
        (title, caption, label, "reaction, kN"), (curve.displacements, curve.reactions / 1e3), said
    )

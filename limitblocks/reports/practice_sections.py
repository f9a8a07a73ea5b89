"""What a report says of the answers of practice, from verification to vehicle."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from limitblocks.drawing.picture import mechanism_picture
from limitblocks.mechanics.loads.load import triple
from limitblocks.model import Model
from limitblocks.reports.answer import rounded_down
from limitblocks.reports.curve import Curve, line_curve
from limitblocks.reports.document import Figure, Part, Table, Text
from limitblocks.reports.section import LEGEND, Section, checks_of
from limitblocks.reports.words import some

if TYPE_CHECKING:  # they would load the solvers, which a report does without
    from limitblocks.practice import (
        Adequacy,
        CapacityCurve,
        CapacityPoint,
        Repair,
        Settlement,
        Verification,
        WorstPosition,
    )

SETTLED = (
    "The mechanism that follows the support, drawn {:.3g} times, linearly; its size is arbitrary. Joints "
    "that move are the cracks. Dashed: the moving blocks before they moved."
)


FACTORED = (
    "Load factor of the structure with design values: gamma_G multiplies the dead loads, gamma_Q the live "
    "loads, gamma_M divides strengths and cohesion of the joints, gamma_phi (gamma_M where it is not given) "
    "their friction coefficient, gamma_S the strength of ties and dowels (EN 1990, Eqs (6.1), (6.3); EN "
    "1997-1, Table A.4, for friction). An adequacy factor of one is E_d = R_d, Eq. (6.8), for the loads and "
    "factors given; which factors a code asks for is not judged here. Where dead loads help, the answer with "
    "a gamma_G of 1 or less counts as well."
)


def of_practice(result: Any) -> Callable[[Model, Any], Section] | None:
    """Return what makes the section of an answer of practice; None of anything else."""
    kind = type(result)
    return KINDS.get(kind.__name__) if kind.__module__.startswith("limitblocks.practice.") else None


def _verification(_model: Model, found: Verification) -> Section:
    from limitblocks.practice.verification_result import UNSEEN

    worst = min(found.checks, key=lambda one: one.ratio)
    quantities = [
        (one.symbol, one.meaning, one.formula, _with_unit(one.value, one.unit), one.source)
        for one in found.quantities
    ]
    checks = [
        (one.name, _with_unit(one.capacity, one.unit), _with_unit(one.demand, one.unit),
         rounded_down(one.ratio), _word(one.satisfied))
        for one in found.checks
    ]  # fmt: skip
    sources = ", ".join(dict.fromkeys(one.source for one in found.checks))
    heads = ("Symbol", "Quantity", "Formula", "Value", "Source")
    return Section(
        title="Kinematic verification of the mechanism",
        meaning=f"A local mechanism as a rigid-body motion, {sources} with NTC 2018. {UNSEEN}",
        headline=rounded_down(worst.ratio),
        quantity=f"least ratio of capacity to demand: {worst.name}, {_word(worst.satisfied)}",
        values=(),
        checks=(),
        tolerance=0.0,
        parts=(
            Table.of("Quantities, in the order in which they are found", heads, quantities, right=(3,)),
            Table.of(
                f"Checks, {sources}: satisfied where capacity over demand is at least one",
                ("Check", "Capacity", "Demand", "Ratio", "Result"),
                checks,
                right=(1, 2, 3),
            ),
            Text(f"Blocks of the mechanism: {some(list(found.moving))}."),
        ),
    )


def _capacity(_model: Model, curve: CapacityCurve) -> Section:
    first, last = curve.points[0], curve.points[-1]
    filled = last.displacement > curve.proven_to
    beyond = (
        (f"beyond {curve.proven_to:.4g} m joints of the capacity curve press across their gaps",)
        if filled
        else ()
    )
    ended = "load factor zero" if curve.zero is not None else "end of the curve"
    return Section(
        title="Capacity curve",
        meaning=(
            "The mechanism without dilatancy moves the blocks by finite screws; contacts are found anew and "
            "each point is an answer of its own, recomputed without the solver. Slow motion: no impact, no "
            "rebound."
        ),
        headline=f"{last.displacement:#.4g} m",
        quantity=f"displacement at {ended}",
        values=(
            ("Load factor at rest", f"{first.load_factor:#.7g}", "without dilatancy, the first point"),
            ("Ends", f"{last.displacement:#.6g} m", curve.ended),
            ("No joint presses across a gap up to", f"{curve.proven_to:#.6g} m", "proven for the geometry"),
            ("Control point", triple(curve.control.point.tolist()), f"m, on {curve.control.block}"),
            ("Direction", triple(curve.control.direction.tolist()), "in which its displacement is measured"),
        ),
        checks=checks_of(last.result.residuals, last.result.tolerance),
        tolerance=last.result.tolerance,
        warnings=beyond,
        curve=_capacity_curve(curve),
        parts=(_points(curve),),
    )


def _points(curve: CapacityCurve) -> Table:
    rows = [
        (f"{one.displacement:#.6g}", f"{_clean(one.load_factor):.6g}", _changes(one),
         some(list(one.across)) or "none", f"{one.result.residuals.worst.value:.1e}")
        for one in curve.points
    ]  # fmt: skip
    heads = ("Displacement, m", "Load factor", "Contacts that change", "Presses across a gap", "Residual")
    return Table.of("Points of the capacity curve", heads, rows, right=(0, 1, 4))


def _changes(point: CapacityPoint) -> str:
    taken = [f"{point.shift:.3g} of the live load taken from the dead loads"] if point.shift else []
    return some([*point.changes, *taken]) or "none"


def _capacity_curve(curve: CapacityCurve) -> Curve | None:
    if len(curve.points) < 2:
        return None
    control = curve.control
    label = f"displacement of {control.block} along {triple(control.direction.tolist())}, m"
    title = "Load factor against displacement"
    said = [f"{one.displacement:.4g} m: load factor {_clean(one.load_factor):.4g}" for one in curve.points]
    caption = f"{title}, a dot a point with an answer of its own: {curve.ended}."
    return line_curve((title, caption, label, "load factor"), (curve.displacements, curve.load_factors), said)


def _settlement(_model: Model, found: Settlement) -> Section:
    own, end = found.settling, found.result or found.bounds
    least = found.lower if found.nonassociated is None else found.nonassociated
    values = [
        ("Least reaction, mechanism", _newtons(found.lower), "associated: of a mechanism that follows"),
        ("Least reaction, stress state", _newtons(found.upper), "associated: no stress state has less"),
    ]
    if found.nonassociated is not None:
        values.append(
            ("Without dilatancy", _newtons(found.nonassociated), "at which the structure follows, certified")
        )
    picture = mechanism_picture(own.model, end.displacement_rates)
    drawn = picture.sheet(f"Mechanism that follows {own.support}")
    return Section(
        title=f"Settlement of {own.support}",
        meaning=(
            f"The support {own.support} gives way along {triple(own.direction.tolist())}, without turning, "
            "under the dead loads. The structure needs less and less of its reaction until, at the least "
            "one, it follows as a mechanism. Reactions are components against that direction; the weight of "
            "the support itself is left out."
        ),
        headline=_newtons(least),
        quantity="least reaction" + (" without dilatancy" if found.result else ", associated flow"),
        values=tuple(values),
        checks=checks_of(end.residuals, end.tolerance),
        tolerance=end.tolerance,
        parts=(Figure(drawn, SETTLED.format(picture.magnification), LEGEND),),
    )


def _repair(_model: Model, found: Repair) -> Section:
    pairs = zip(found.candidates, found.amounts.tolist(), strict=True)
    rows = [(name, _newtons(amount) if amount else "not needed") for name, amount in pairs]
    return Section(
        title="Least reinforcement",
        meaning=(
            "The least sum of forces or weights with which the structure reaches the required load factor "
            "if its joints dilate by the friction angle (static theorem, Eqs (56)-(57)); then the answer "
            "without dilatancy of the structure so reinforced, which may be less."
        ),
        headline=_newtons(found.total),
        quantity=f"least sum for load factor {found.required:.6g}",
        values=(
            ("Required", f"{found.required:#.7g}", "load factor"),
            ("Associated", f"{found.bounds.lower:#.7g}", "static load factor of the reinforced structure"),
            ("Without dilatancy", f"{found.result.load_factor:#.7g}", "of the reinforced structure"),
        ),
        checks=checks_of(found.result.residuals, found.result.tolerance),
        tolerance=found.result.tolerance,
        warnings=_short_of(found),
        parts=(Table.of("Reinforcement", ("Candidate", "Least"), rows, right=(1,)),),
    )


def _short_of(found: Repair) -> tuple[str, ...]:
    if found.result.load_factor >= found.required:
        return ()
    said = f"without dilatancy the reinforced structure carries {found.result.load_factor:.6g}"
    return (f"{said}, less than the load factor {found.required:.6g} required",)


def _worst(_model: Model, found: WorstPosition) -> Section:
    order = np.argsort(found.positions)
    x, factors = found.positions[order], found.load_factors[order]
    rows = [
        (f"{a:#.6g}", f"{b:#.6g}" if np.isfinite(b) else "unlimited", "worst" if a == found.position else "")
        for a, b in zip(x.tolist(), factors.tolist(), strict=True)
    ]
    parts: tuple[Part, ...] = (
        Table.of("Load factor by position", ("First axle at X, m", "Load factor", ""), rows, right=(0, 1)),
    )
    return Section(
        title="Vehicle on the deck",
        meaning=(
            "Associated load factor of the axle loads given, with the vehicle at each position; the fill "
            "disperses the axles. The least one is found by a search between the worst positions, a local "
            "minimum."
        ),
        headline=f"{found.bounds.lower:#.4g}",
        quantity=f"load factor with the first axle at X = {found.position:.4g} m, the worst position found",
        values=(
            ("Static load factor", f"{found.bounds.lower:#.7g}", "at the worst position"),
            ("Kinematic load factor", f"{found.bounds.upper:#.7g}", "at the worst position"),
        ),
        checks=checks_of(found.bounds.residuals, found.bounds.tolerance),
        tolerance=found.bounds.tolerance,
        curve=_envelope(x[np.isfinite(factors)], factors[np.isfinite(factors)]),
        parts=parts,
    )


def _envelope(x: Any, factors: Any) -> Curve | None:
    if len(x) < 2:
        return None
    title = "Load factor against the position of the first axle"
    said = [f"X = {a:.4g} m: load factor {b:.4g}" for a, b in zip(x, factors, strict=True)]
    return line_curve((title, f"{title}, a dot a position.", "X, m", "load factor"), (x, factors), said)


def _adequacy(_model: Model, found: Adequacy) -> Section:
    end = found.result or found.bounds
    real = [("Without dilatancy", f"{found.factor:#.7g}", "of the design model")] if found.result else []
    rows = [
        (one.symbol, one.where, _with_unit(one.characteristic, one.unit), one.factor,
         f"{found.factors.value(one.factor):.6g}", _with_unit(one.design, one.unit))
        for one in found.values
    ]  # fmt: skip
    heads = ("Symbol", "Of", "Characteristic", "Partial factor", "Its value", "Design")
    return Section(
        title="Adequacy with partial factors",
        meaning=FACTORED,
        headline=rounded_down(found.factor),
        quantity=f"adequacy factor, {'at least one' if found.satisfied else 'LESS than one'}",
        values=(
            ("Characteristic load factor", f"{found.characteristic.lower:#.7g}", "associated, as given"),
            ("Design load factor, static", f"{found.bounds.lower:#.7g}", "associated, of the design model"),
            (
                "Design load factor, kinematic",
                f"{found.bounds.upper:#.7g}",
                "associated, of the design model",
            ),
            *real,
        ),
        checks=checks_of(end.residuals, end.tolerance),
        tolerance=end.tolerance,
        parts=(Table.of("Characteristic and design values", heads, rows, right=(2, 4, 5)),),
    )


def _clean(load_factor: float) -> float:
    """The load factor without the rounding errors about its zero."""
    return round(load_factor, 9) + 0.0


def _with_unit(value: float, unit: str) -> str:
    return f"{value:.6g} {unit.replace('s2', 's²')}".strip()


def _newtons(value: float) -> str:
    return f"{value / 1e3:.6g} kN"


def _word(satisfied: bool) -> str:
    return "satisfied" if satisfied else "NOT satisfied"


#: By name, so that the classes need not be imported.
KINDS: dict[str, Callable[[Model, Any], Section]] = {
    "Adequacy": _adequacy,
    "CapacityCurve": _capacity,
    "Repair": _repair,
    "Settlement": _settlement,
    "Verification": _verification,
    "WorstPosition": _worst,
}

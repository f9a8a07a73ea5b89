"""What a report says of a support that settles, of the least reinforcement and of a vehicle."""

from __future__ import annotations

from typing import Any

import numpy as np

from limitblocks.drawing.picture import mechanism_picture
from limitblocks.errors import few
from limitblocks.model import Model
from limitblocks.practice import Repair, Settlement, WorstPosition
from limitblocks.practice.partial_factors import live_factor
from limitblocks.practice.worst_position import STOPPED
from limitblocks.reports.curve import Curve, line_curve
from limitblocks.reports.document import Figure, Part, Table
from limitblocks.reports.section import LEGEND, Section
from limitblocks.reports.words import at_least, at_most, cut, figures, kilonewtons
from limitblocks.shown import coordinate

SETTLED = (
    "The mechanism that follows what settles, drawn {:.3g} times, linearly; its size is arbitrary. Joints "
    "that move are the cracks. Dashed: the moving blocks before they moved."
)
LOADED = (
    "The mechanism with the vehicle at its worst position, drawn {:.3g} times, linearly; its size is "
    "arbitrary. Dashed: the moving blocks before they moved."
)
SLIDING = "may be less where joints slide: nonassociated of worst.model, or of what --model writes"
DRIVEN = (
    "Associated load factor of the axle loads given, with the vehicle at each position, in place of the "
    "model's own live load; the fill disperses the axles. Every mechanism found bounds the load factor at "
    "all positions; tried is where they carry least, until that is attained. That no other position is worse "
    "is searched for, not proven."
)


def settlement_section(_model: Model, found: Settlement) -> Section:
    """Return the section of a support that settles."""
    own, end = found.settling, found.result or found.bounds
    least = found.lower if found.nonassociated is None else found.nonassociated
    values = [
        ("Least reaction, mechanism", kilonewtons(found.lower), "associated: of a mechanism that follows"),
        ("Least reaction, stress state", kilonewtons(found.upper), "associated: no stress state has less"),
    ]
    if found.nonassociated is not None:
        values.append(
            (
                "Without dilatancy",
                kilonewtons(found.nonassociated),
                "at which the structure follows, certified",
            )
        )
    picture = mechanism_picture(own.model, end.displacement_rates, pushed=False)  # by the dead loads alone
    drawn = picture.sheet(f"Mechanism that follows {few(own.supports)}")
    return Section(
        title=f"Settlement of {few(own.supports)}",
        own=True,
        meaning=(
            f"Under the dead loads {own.gives_way}. The structure needs less and less of the reaction "
            "until, at the least one, it follows as a mechanism. Reactions are components against that "
            "direction; the weight of what gives way is left out."
        ),
        headline=kilonewtons(least),
        quantity="least reaction" + (" without dilatancy" if found.result else ", associated flow"),
        values=tuple(values),
        judged=(end.residuals, end.tolerance),
        warnings=found.remarks,
        parts=(Figure(drawn, SETTLED.format(picture.magnification), LEGEND),),
    )


def repair_section(_model: Model, found: Repair) -> Section:
    """Return the section of the least reinforcement."""
    pairs = zip(found.candidates, found.amounts.tolist(), strict=True)
    rows = [(name, kilonewtons(amount) if amount else "not needed") for name, amount in pairs]
    return Section(
        title="Least reinforcement",
        own=True,
        meaning=(
            "The least sum of forces or weights with which the structure reaches the required load factor "
            "if its joints dilate by the friction angle (static theorem, Eqs (56)-(57)); then the answer "
            "without dilatancy of the structure so reinforced, which may be less."
        ),
        headline=kilonewtons(found.total),
        quantity=f"least sum for load factor {found.required:.6g}",
        values=(
            ("Required", figures(found.required, 7), "load factor"),
            ("Associated", at_least(found.bounds.lower), "static load factor of the reinforced structure"),
            ("Without dilatancy", figures(found.result.load_factor, 7), "of the reinforced structure"),
        ),
        judged=(found.result.residuals, found.result.tolerance),
        warnings=_short_of(found) + found.remarks,
        parts=(Table.of("Reinforcement", ("Candidate", "Least"), rows, right=(1,)),),
    )


def _short_of(found: Repair) -> tuple[str, ...]:
    if found.result.load_factor >= found.required:
        return ()
    said = f"without dilatancy the reinforced structure carries {found.result.load_factor:.6g}"
    return (f"{said}, less than the load factor {found.required:.6g} required",)


def vehicle_section(_model: Model, found: WorstPosition) -> Section:
    """Return the section of a vehicle at its worst position."""
    order = np.argsort(found.positions)
    x, factors = found.positions[order], found.load_factors[order]
    rows = [
        (f"{a:.3f}", cut(b) if np.isfinite(b) else "unlimited", "worst" if a == found.position else "")
        for a, b in zip(x.tolist(), factors.tolist(), strict=True)
    ]
    picture = mechanism_picture(found.model, found.bounds.displacement_rates)
    drawn = picture.sheet("Mechanism with the vehicle at its worst position")
    acting = found.model.live.on(found.model.free_blocks)[:, :3].sum(axis=0)
    parts: tuple[Part, ...] = (
        Figure(drawn, LOADED.format(picture.magnification), LEGEND),
        Table.of("Load factor by position", ("First axle at X, m", "Load factor", ""), rows, right=(0, 1)),
    )
    return Section(
        title="Vehicle on the deck",
        own=True,
        meaning=DRIVEN,
        headline=cut(found.bounds.lower),
        quantity="associated load factor of the vehicle, worst found: axle 1 at X = "
        f"{coordinate(found.position)} m",
        values=(
            *_vehicle_rows(found),
            ("Static load factor", at_least(found.bounds.lower), "at the worst position"),
            ("Kinematic load factor", at_most(found.bounds.upper), "at the worst position"),
            ("Without dilatancy", "not computed", SLIDING),
            (
                "Axles on the structure",
                kilonewtons(-float(acting[2])),
                f"of {kilonewtons(sum(found.vehicle.axles))}, at load factor one, at the worst position",
            ),
        ),
        judged=(found.bounds.residuals, found.bounds.tolerance),
        warnings=found.bounds.remarks + (() if found.complete else (STOPPED,)),
        curve=_envelope(x, np.where(np.isfinite(factors), factors, np.nan)),
        parts=parts,
    )


def _vehicle_rows(found: WorstPosition) -> tuple[tuple[str, str, str], ...]:
    vehicle, deck = found.vehicle, found.deck
    loads = ", ".join(f"{load / 1e3:.6g}" for load in vehicle.axles)
    gamma_Q = live_factor(found.model)
    one = f"at load factor one{f', times gamma_Q {gamma_Q:g}' * (gamma_Q != 1.0)}"
    places = ", ".join(f"{distance:.6g}" for distance in vehicle.distances)
    spread = f"axles spread {deck.spread:g} m to each side along the deck per m of fill"
    return (
        ("Axles", f"{loads} kN", f"{one}, {places} m along X from the first axle"),
        ("Contact of a wheel", f"{vehicle.contact:g} m", "along the deck"),
        ("Road", f"Z = {coordinate(deck.level)} m", f"along y = {deck.y:g} m; {spread}"),
    )


def _envelope(x: Any, factors: Any) -> Curve | None:
    if np.isfinite(factors).sum() < 2:
        return None
    title = "Load factor against the position of the first axle"
    said = [f"X = {coordinate(a)} m: load factor {b:.4g}" for a, b in zip(x, factors, strict=True)]
    gaps = " It has a gap where the load is unlimited." * bool(np.isnan(factors).any())
    return line_curve(
        (title, f"{title}, a dot a position.{gaps}", "first axle at X, m", "load factor"), (x, factors), said
    )

"""Kinematic verification of a local mechanism: Circolare 7/2019, Section C8.7.1.2 (NTC 2018).

The Circolare's text was not at hand: quantities and checks follow Section C8.7.1.2 as worked examples apply
it. No verdict of a code beyond the inequalities named.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.evidence.interface_states import Collapse, collapse_of
from limitblocks.mechanics.loads.forces import AddedMass, MassProportional
from limitblocks.mechanics.loads.load import number
from limitblocks.model import Model
from limitblocks.practice.capacity_result import CapacityCurve
from limitblocks.practice.inputs import GIVEN, carried, given
from limitblocks.practice.spectra import Floor, G, Spectrum
from limitblocks.practice.verification_result import Inequality, Quantity, Verification

STILL = 1e-6  # of the largest displacement: a mass below it does not move
SECTION = "Circolare 7/2019, C8.7.1.2"
SLV, SLC = 0.4, 0.6  # of d0*: displacement at the limit state
PERIODS = {"SLV": (SLV, 1.68), "SLC": (SLC, 1.56)}  # T = factor pi sqrt(d* / a*)


def verification(
    model: Model,
    result: Collapse,
    demand: Spectrum,
    *,
    q: float,
    curve: CapacityCurve | None = None,
    confidence: float = 1.35,
    floor: Floor | None = None,
    collapse_demand: Spectrum | None = None,
) -> Verification:
    """Verify a mechanism against an earthquake: linear and, with a capacity curve, non-linear analysis.

    Parameters
    ----------
    model : Model
        Its live load is mass-proportional and horizontal, added masses included: the load factor is an
        acceleration over g.
    result : Nonassociated
        The mechanism, of this model; its load factor is alpha0.
    demand : Spectrum
        Of the limit state of life safety (SLV).
    q : float
        Behaviour factor of the linear check, such as 2.
    curve : CapacityCurve, optional
        Of this model, to zero: gives d0* and the non-linear checks.
    confidence : float
        FC, at least 1.
    floor : Floor, optional
        Where the mechanism is not at the ground: its height Z by the modes of the building.
    collapse_demand : Spectrum, optional
        Of the limit state of collapse (SLC); with it and a curve the non-linear check at SLC is made.

    Raises
    ------
    ModelError
        If a number is out of range, the live load is no horizontal weight, or the curve does not end at zero.
    LimitBlocksError
        If the result is not one of this model.

    Notes
    -----
    With P_i the weights of the live load on blocks that move and delta_i their displacements along it:
    M* = (sum P delta)^2 / (g sum P delta^2), e* = g M* / sum P, a0* = alpha0 g / (e* FC),
    d* = d_k sum P delta^2 / (delta_k sum P delta). At the ground a0* >= a_g S / q. Limit states:
    d*_SLV = .4 d0*, d*_SLC = .6 d0* on a* = a0* (1 - d* / d0*), periods 1.68 and 1.56 times pi sqrt(d* / a*).
    """
    collapse = collapse_of(model, result)
    q, confidence = number(q, "q", "", least=1.0), number(confidence, "FC", "", least=1.0)
    weights, delta, moving = _weights(model, collapse.displacement_rates)
    alpha = float(result.load_factor)  # type: ignore[attr-defined] # bounds have none
    sums = float(weights @ delta), float(weights @ delta**2)
    mass = sums[0] ** 2 / (G * sums[1])
    e = G * mass / float(weights.sum())
    a0 = alpha * G / (e * confidence)
    found = [
        Quantity(
            "alpha0", "load factor of the mechanism", "without dilatancy", alpha, "", "result of this report"
        ),
        Quantity("sum P", "weight that moves", "sum P_i", float(weights.sum()), "N", SECTION),
        Quantity(
            "M*", "participating mass", "(sum P_i delta_i)^2 / (g sum P_i delta_i^2)", mass, "kg", SECTION
        ),
        Quantity("e*", "participating share", "g M* / sum P_i", e, "", SECTION),
        Quantity("FC", "confidence factor", GIVEN, confidence, "", "Circolare 7/2019, C8.5.4"),
        Quantity("a0*", "acceleration that sets it off", "alpha0 g / (e* FC)", a0, "m/s2", SECTION),
    ]
    largest = floor.largest(demand) if floor else demand.a_g * demand.S
    found += given(demand)
    if floor:
        found += carried(floor, largest)
    words = "a_Z / q" if floor else "a_g S / q"
    found += [
        Quantity("q", "behaviour factor", GIVEN, q, "", SECTION),
        Quantity("a_d", "demand of the linear check", words, largest / q, "m/s2", SECTION),
    ]
    checks = [Inequality("linear, SLV", a0, largest / q, "m/s2", SECTION)]
    if curve:
        d0 = _spectral(model, collapse.displacement_rates, curve, sums)
        found.append(
            Quantity("d0*", "spectral displacement of no resistance",
                     "d_k0 sum P_i delta_i^2 / (delta_k sum P_i delta_i)", d0, "m", SECTION)
        )  # fmt: skip
        for state, spectrum in (("SLV", demand), ("SLC", collapse_demand)):
            found += given(spectrum, state) if spectrum and state != "SLV" else []
            if spectrum:
                more, check = _non_linear(state, a0, d0, spectrum, floor)
                found += more
                checks.append(check)
    return Verification(tuple(found), tuple(checks), moving, model.digest)


def _non_linear(
    state: str, a0: float, d0: float, spectrum: Spectrum, floor: Floor | None
) -> tuple[list[Quantity], Inequality]:
    """Displacement, period and demand at a limit state."""
    share, factor = PERIODS[state]
    d, a = share * d0, a0 * (1.0 - share)
    period = factor * np.pi * float(np.sqrt(d / a))
    wanted = floor.displacement(spectrum, period) if floor else spectrum.displacement(period)
    said = "S_DeZ(T)" if floor else "S_De(T)"
    quantities = [
        Quantity(f"d*_{state}", f"displacement at {state}", f"{share:g} d0*", d, "m", SECTION),
        Quantity(f"a*_{state}", f"acceleration at {state}", f"a0* (1 - {share:g})", a, "m/s2", SECTION),
        Quantity(
            f"T_{state}", f"secant period at {state}", f"{factor:g} pi sqrt(d* / a*)", period, "s", SECTION
        ),
        Quantity(
            f"S_De_{state}", f"displacement demand at {state}", said, wanted, "m", "NTC 2018, 3.2.3.2.1"
        ),
    ]
    return quantities, Inequality(f"non-linear, {state}", d, wanted, "m", SECTION)


def _weights(model: Model, rates: Array) -> tuple[Array, Array, tuple[str, ...]]:
    """Weights of the live load that move, their displacements along it, and the blocks that move."""
    direction: Array | None = None
    weights, delta, blocks = [], [], []
    place = {block.name: k for k, block in enumerate(model.blocks)}
    for factor, term in model.live.terms:
        if not isinstance(term, MassProportional | AddedMass):
            raise ModelError(f"the live load has a {type(term).__name__}; expected weights and added masses")
        own = np.array(term.direction)
        if abs(own[2]) > 1e-9 or (direction is not None and not np.allclose(own, direction)):
            raise ModelError(f"the live load acts along {own.tolist()}; expected one horizontal direction")
        direction = own
        masses: Sequence[tuple[str, float, Array]] = (
            [(block.name, block.weight, block.centroid) for block in model.free_blocks]
            if isinstance(term, MassProportional)
            else [(term.block, term.weight, np.array(term.at))]
        )
        for name, weight, at in masses:
            k = place[name]
            velocity = rates[k, :3] + np.cross(rates[k, 3:], at - model.blocks[k].centroid)
            weights.append(factor * weight)
            delta.append(float(velocity @ own))
            blocks.append(name)
    speed = np.abs(delta)
    moves = speed > STILL * speed.max()
    moving = tuple(dict.fromkeys(name for name, own in zip(blocks, moves, strict=True) if own))
    return np.array(weights)[moves], np.array(delta)[moves], moving


def _spectral(model: Model, rates: Array, curve: CapacityCurve, sums: tuple[float, float]) -> float:
    """d0* of the displacement of the control point at which nothing resists any more."""
    if curve.zero is None:
        raise ModelError(f"the capacity curve does not end at zero: {curve.ended}")
    if curve.digest != model.digest:
        raise ModelError("the capacity curve belongs to another model")
    k = [block.name for block in model.blocks].index(curve.control.block)
    arm = curve.control.point - model.blocks[k].centroid
    delta_k = float((rates[k, :3] + np.cross(rates[k, 3:], arm)) @ curve.control.direction)
    return curve.zero * sums[1] / (delta_k * sums[0])

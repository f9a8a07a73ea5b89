"""Kinematic verification of a local mechanism: Circolare 7/2019, Section C8.7.1.2.1 (NTC 2018).

Equation numbers are those of the Circolare (C.S.LL.PP., 21 January 2019, n. 7), read in a transcription of
the official text. No verdict of a code beyond the inequalities named.
"""

from __future__ import annotations

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.evidence.interface_states import Collapse, collapse_of
from limitblocks.mechanics.loads.load import number
from limitblocks.model import Model
from limitblocks.practice.capacity_result import CapacityCurve
from limitblocks.practice.displacement_check import displacement_check
from limitblocks.practice.inputs import GIVEN, carried, given
from limitblocks.practice.moving_masses import MovingMass, moving_masses
from limitblocks.practice.spectra import Floor, G, Spectrum
from limitblocks.practice.verification_result import Inequality, Quantity, Verification

LC1 = 1.35  # confidence factor of the lowest level of knowledge, Table C8.5.IV
SIMPLIFIED = "C8.7.1.2.1.7"


def verification(
    model: Model,
    result: Collapse,
    demand: Spectrum,
    *,
    q: float | None = None,
    curve: CapacityCurve | None = None,
    confidence: float = LC1,
    floor: Floor | None = None,
    collapse_demand: Spectrum | None = None,
    damage_demand: Spectrum | None = None,
    damping: tuple[float, float] = (0.08, 0.10),
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
        Needed: behaviour factor of the linear check, C8.7.1.2.1.7: 2 unless there is better.
    curve : CapacityCurve, optional
        Of this model, to zero: gives d0* and the non-linear checks.
    confidence : float
        FC, at least 1; that of LC1, 1.35, where joints have no compressive strength (C8.7.1.2.1.3).
    floor : Floor, optional
        Where the mechanism is not at the ground: its height z by the modes of the building.
    collapse_demand : Spectrum, optional
        Of the limit state of collapse (SLC); with it and a curve the non-linear check at SLC is made.
    damage_demand : Spectrum, optional
        Of the limit state of damage (SLD); with it the mechanism is checked not to set off, [C8.7.1.8].
    damping : (float, float)
        Equivalent damping of the mechanism at SLV and SLC, C8.7.1.2.1.8.

    Raises
    ------
    ModelError
        If a number is out of range, the live load is no horizontal weight, or the curve does not end at zero.
    LimitBlocksError
        If the result is not one of this model.

    Notes
    -----
    With P_k the weights of the live load on blocks that move and delta_k their displacements along it:
    e* = (sum P delta)^2 / (sum P sum P delta^2) [C8.7.1.5], a0* = alpha0 g / (e* FC) [C8.7.1.8],
    d = d_C sum P delta^2 / (delta_C sum P delta) [C8.7.1.4]; at the ground a0* >= a_g S / q.
    The acceleration at .4 and .6 of d0* is taken from the capacity curve [C8.7.1.3] and, beside it, from the
    straight line between a0* and d0*; the larger demand of both counts.
    """
    collapse = collapse_of(model, result)
    if q is None:
        raise ModelError("q is missing: the check at SLV needs a behaviour factor, such as 2 (C8.7.1.2.1.7)")
    q, confidence = number(q, "q", "", least=1.0), number(confidence, "FC", "", least=1.0)
    masses, scale = moving_masses(model, collapse.displacement_rates)
    alpha = float(result.load_factor)  # type: ignore[attr-defined] # bounds have none
    found, a0, e = _oscillator(masses, alpha, confidence)
    found += given(demand)
    largest = floor.largest(demand) if floor else demand.a_g * demand.S
    found += carried(floor, demand) if floor else []
    found += _linear(a0, demand.a_g, largest, q, "a_Z" if floor else "a_g S")
    checks = [Inequality("linear, SLV", a0, largest / q, "m/s2", SIMPLIFIED)]
    if damage_demand:
        most = floor.largest(damage_demand) if floor else damage_demand.a_g * damage_demand.S
        found += given(damage_demand, "SLD")
        checks.append(Inequality("linear, SLD", a0, most, "m/s2", "[C8.7.1.8]"))
    if curve:
        per_control = _per_control(model, scale * collapse.displacement_rates, curve, masses)
        for state, spectrum, own in zip(("SLV", "SLC"), (demand, collapse_demand), damping, strict=True):
            found += given(spectrum, state) if spectrum and state != "SLV" else []
            if spectrum:
                xi = number(own, f"damping at {state}", "", above=0.0)
                more, check = displacement_check(
                    state, curve, (per_control, G / (e * confidence)), spectrum, floor, xi
                )
                found += more
                checks.append(check)
    return Verification(tuple(found), tuple(checks), masses, model.digest, _remarks(model, confidence))


def _oscillator(
    masses: tuple[MovingMass, ...], alpha: float, confidence: float
) -> tuple[list[Quantity], float, float]:
    """Sums over the masses, alpha0, e*, a0* as quantities; a0* and e*."""
    P, x, y = (np.array([getattr(one, of) for one in masses]) for of in ("weight", "horizontal", "vertical"))
    total, first, second = float(P.sum()), float(P @ x), float(P @ x**2)
    e = first**2 / (total * second)
    a0 = alpha * G / (e * confidence)
    mass = e * total / G
    return [
        Quantity("alpha0", "load factor that sets it off", "without dilatancy, this report", alpha, "",
                 "[C8.7.1.1]"),
        Quantity("sum P", "weight that moves", "sum (P_k + Q_k)", total, "N", "[C8.7.1.5]"),
        Quantity("sum P dx", "weights times displacements along the push", "sum (P_k + Q_k) delta_PQx,k",
                 first, "N", "[C8.7.1.5]"),
        Quantity("sum P dx^2", "the same with squares", "sum (P_k + Q_k) delta_PQx,k^2", second, "N",
                 "[C8.7.1.5]"),
        Quantity("sum P dy", "the same with displacements upwards", "sum (P_k + Q_k) delta_Py,k",
                 float(P @ y), "N", "[C8.7.1.1]"),
        Quantity("e*", "participating share of the mass", "(sum P dx)^2 / (sum P  sum P dx^2)", e, "",
                 "[C8.7.1.5]"),
        Quantity("M*", "participating mass", "e* sum P / g", mass, "kg", "Circolare 617/2009 (not seen)"),
        Quantity("FC", "confidence factor", GIVEN, confidence, "", "C8.5.4, C8.7.1.2.1.3"),
        Quantity("a0*", "acceleration that sets it off", "alpha0 g / (e* FC)", a0, "m/s2", "[C8.7.1.8]"),
    ], a0, e  # fmt: skip


def _linear(a0: float, a_g: float, largest: float, q: float, word: str) -> list[Quantity]:
    """The check with a behaviour factor, as accelerations of the mechanism and of the ground."""
    ground = a_g * a0 / largest
    return [
        Quantity("q", "behaviour factor", GIVEN, q, "", SIMPLIFIED),
        Quantity("a_d", "demand of the linear check", f"{word} / q", largest / q, "m/s2", SIMPLIFIED),
        Quantity("a_g,SLD", "ground acceleration that sets it off", f"a_g a0* / ({word})", ground, "m/s2",
                 "[C8.7.1.8], [C7.2.8]"),
        Quantity("a_g,SLV", "ground acceleration of the linear check", "q a_g,SLD", q * ground, "m/s2",
                 SIMPLIFIED),
        Quantity("zeta_E", "a_g,SLV over that of the site", "a_g,SLV / a_g", q * ground / a_g, "",
                 "NTC 2018 8.3"),
    ]  # fmt: skip


def _per_control(model: Model, rates: Array, curve: CapacityCurve, masses: tuple[MovingMass, ...]) -> float:
    """Spectral displacement over that of the control point, [C8.7.1.4]."""
    if curve.zero is None:
        raise ModelError(f"the capacity curve does not end at zero: {curve.ended}")
    if curve.digest != model.digest:
        raise ModelError("the capacity curve belongs to another model")
    k = [block.name for block in model.blocks].index(curve.control.block)
    arm = curve.control.point - model.blocks[k].centroid
    delta = float((rates[k, :3] + np.cross(rates[k, 3:], arm)) @ curve.control.direction)
    P, x = (np.array([getattr(one, of) for one in masses]) for of in ("weight", "horizontal"))
    return float(P @ x**2) / (delta * float(P @ x))


def _remarks(model: Model, confidence: float) -> tuple[str, ...]:
    weak = any(getattr(own.joint, "compressive_strength", None) is not None for own in model.interfaces)
    if weak or confidence >= LC1:
        return ()
    return (
        f"FC {confidence:g} with joints without compressive strength: C8.7.1.2.1.3 asks that of LC1, {LC1}",
    )

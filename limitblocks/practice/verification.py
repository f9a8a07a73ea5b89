"""Kinematic verification of a local mechanism: Circolare 7/2019, Section C8.7.1.2.1 (NTC 2018).

Equation numbers are those of the Circolare (C.S.LL.PP., 21 January 2019, n. 7), read in a transcription of
the official text. No verdict of a code beyond the inequalities named.
"""

from __future__ import annotations

import numpy as np

from limitblocks.analysis.magnitudes import of_ground, of_limit_states
from limitblocks.errors import ModelError, refuse_kind
from limitblocks.evidence.interface_states import Collapse, collapse_of
from limitblocks.mechanics.loads.load import number
from limitblocks.mechanics.loads.load import place as pair
from limitblocks.model import Model, checked_model
from limitblocks.practice.capacity_result import CapacityCurve
from limitblocks.practice.displacement_check import displacement_check, per_control
from limitblocks.practice.inputs import (
    GIVEN,
    LC1,
    carried,
    flow_words,
    given,
    other_answers,
    other_mechanisms,
    refuse_unproven,
    remarks,
    unproven,
)
from limitblocks.practice.moving_masses import STILL, MovingMass, moving_masses
from limitblocks.practice.spectra import MOST, MOST_DAMPING, Floor, G, Place, Spectrum, ground_acceleration
from limitblocks.practice.verification_result import MANY, NO_CURVE, Inequality, Quantity, Verification, steps

SIMPLIFIED = "C8.7.1.2.1.7"
SHARE = "(sum P dx)^2 / (sum P  sum P dx^2)"
MOST_FC = 2.0  # the code has 1 to 1.35
MOST_GROUND = 2.0 * G  # m/s2 of the ground: more is in another unit


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
    elastic_period: float = 0.0,
) -> Verification:
    """Verify a mechanism against an earthquake: linear and, with a capacity curve, non-linear analysis.

    Parameters
    ----------
    model : Model
        Its live load is the whole weight along a horizontal, added masses included: the load factor is an
        acceleration over g. This direction alone is verified.
    result : Nonassociated
        The mechanism, of this model; its load factor is alpha0.
    demand : Spectrum
        Of the limit state of life safety (SLV).
    q : float
        Needed: behaviour factor of the linear check, C8.7.1.2.1.7: 2 unless there is better.
    curve : CapacityCurve, optional
        Of this model and this mechanism, to zero: gives d0* and the non-linear checks, which are `left_out`
        where others have the same alpha0.
    confidence : float
        FC, at least 1; that of LC1, 1.35, where joints have no compressive strength (C8.7.1.2.1.3).
    floor : Floor, optional
        Where the mechanism is not at the ground: its height z by the modes of the building.
    collapse_demand : Spectrum, optional
        Of the limit state of collapse (SLC): the non-linear check at SLC is made, `left_out` without a curve.
    damage_demand : Spectrum, optional
        Of the limit state of damage (SLD); with it the mechanism is checked not to set off, [C8.7.1.8].
    damping : (float, float)
        Equivalent damping of the mechanism at SLV and SLC as ratios, C8.7.1.2.1.8.
    elastic_period : float
        T_0, s, of an element free to vibrate before it is set off (parapet, pinnacle, top of a facade):
        :func:`~limitblocks.practice.elastic_period`. 0 of a wall that its returns hold.

    Raises
    ------
    ModelError
        If a number is out of range, the live load is not that, or the curve does not end at zero or is of
        another mechanism.
    LimitBlocksError
        If the result is not one of this model, or no solution: one of a file, or a claim, is checked first.

    Notes
    -----
    With P_k the weights of the live load on blocks that move along it, delta_k their displacements along it
    (a block that is lifted only does work in [C8.7.1.1] and is not in e*, which is safe):
    e* = (sum P delta)^2 / (sum P sum P delta^2) [C8.7.1.5], a0* = alpha0 g / (e* FC) [C8.7.1.8],
    d = d_C sum P delta^2 / (delta_C sum P delta) [C8.7.1.4]; at the ground a0* >= a_g S / q, free to vibrate
    a0* >= S_e(T_0) / q [C8.7.1.9]. Where several mechanisms have this alpha0, e* is 1, the most that it can
    be (Cauchy and Schwarz): none of them has a smaller a0*. The acceleration at .4 and .6 of d0* is taken
    from the capacity curve [C8.7.1.3] and, beside it, from the straight line between a0* and d0*; the larger
    demand of both counts. The non-linear checks compare ground accelerations, a_g,SLV no less than that
    which sets it off.
    """
    collapse = collapse_of(checked_model(model), result)
    refuse_unproven(model, result)
    _refuse(demand, collapse_demand, damage_demand, curve, floor)
    q, confidence = _factors(q, confidence, damping)
    for state, ratio in zip(("SLV", "SLC"), damping, strict=True):
        number(ratio, f"damping at {state}", "", above=0.0, most=MOST_DAMPING)
    place = Place(floor, number(elastic_period, "T_0", "s", least=0.0, most=MOST))
    masses, scale = moving_masses(model, collapse.displacement_rates)
    alpha = float(result.load_factor)  # type: ignore[attr-defined] # bounds have none
    flow = flow_words(collapse.dilatancy)  # type: ignore[attr-defined] # of every state
    rates = scale * collapse.displacement_rates
    ratio = per_control(model, alpha, rates, curve, masses) if curve else 0.0
    others = other_mechanisms(model, collapse, _participation(masses), curve=curve is not None)
    sums, a0, e = _oscillator(masses, alpha, flow, confidence, many=bool(others))
    found = steps("activation", sums)
    found += steps("demand", [*given(demand), *carried(place, demand)])
    set_off = ground_acceleration(demand, place.acceleration, a0)
    found += steps("linear", _linear(demand, place, q, set_off))
    checks = [Inequality("linear, SLV", a0, place.acceleration(demand) / q, "m/s2", SIMPLIFIED)]
    if damage_demand:
        found += steps("demand", given(damage_demand, "SLD"))
        needed = place.acceleration(damage_demand)
        checks.append(Inequality("linear, SLD", a0, needed, "m/s2", _equation(place)))
    if curve and not others:
        scales = (ratio, G / (e * confidence))
        more, non_linear = _non_linear(curve, scales, (demand, collapse_demand), damping, place, set_off)
        found += more
        checks += non_linear
    states = ("SLD", damage_demand), ("SLV", demand), ("SLC", collapse_demand)
    said = (
        *of_ground(demand.a_g),
        *of_limit_states({state: one.a_g for state, one in states if one}),
        *unproven(collapse, curve),
        *other_answers(collapse),
        *others,
        *collapse.remarks,  # type: ignore[attr-defined] # of every state
        *remarks(model, collapse.displacement_rates, confidence),
    )
    left_out = MANY if curve and others else NO_CURVE if collapse_demand and not curve else ""
    return Verification(tuple(found), tuple(checks), masses, model.digest, said, left_out)


def _refuse(demand: object, *others: object) -> None:
    """ModelError where what is given is not of its kind, or an acceleration in another unit."""
    kinds = (Spectrum, Spectrum, Spectrum, CapacityCurve, Floor)
    words = ("demand", "collapse_demand", "damage_demand", "curve", "floor")
    for own, kind, word in zip((demand, *others), kinds, words, strict=True):
        if own is not None or word == "demand":
            refuse_kind(own, kind, word)
        if isinstance(own, Spectrum) and own.a_g > MOST_GROUND:
            raise ModelError(f"a_g is {own.a_g:g} m/s2, {own.a_g / G:.3g} g; expected at most 2 g: its unit?")


def _factors(q: float | None, confidence: float, damping: tuple[float, float]) -> tuple[float, float]:
    """Return q and FC; ModelError where they are out of range, or the damping is not that of two states."""
    pair(damping, "damping, at SLV and at SLC,")
    if q is None:
        raise ModelError("q is missing: the check at SLV needs a behaviour factor, such as 2 (C8.7.1.2.1.7)")
    return number(q, "q", "", least=1.0), number(confidence, "FC", "", least=1.0, most=MOST_FC)


def _weights(masses: tuple[MovingMass, ...]) -> tuple[float, float, float, float]:
    """Sums of weights, N, that move along the push, times displacements along it, their squares, upwards."""
    P, x, y = (np.array([getattr(one, of) for one in masses]) for of in ("weight", "horizontal", "vertical"))
    along = np.abs(x) > STILL  # a mass that is lifted only would make e* less and a0* more
    return float(P[along].sum()), float(P @ x), float(P @ x**2), float(P @ y)


def _participation(masses: tuple[MovingMass, ...]) -> float:
    """Participating share of the mass, e*, [C8.7.1.5]."""
    total, first, second, _ = _weights(masses)
    return first**2 / (total * second)


def _oscillator(
    masses: tuple[MovingMass, ...], alpha: float, flow: str, confidence: float, *, many: bool
) -> tuple[list[Quantity], float, float]:
    """Sums over the masses, alpha0, e*, a0* as quantities; a0* and e*, of `many` mechanisms at most 1."""
    total, first, second, up = _weights(masses)
    e = 1.0 if many else _participation(masses)
    share = "1, the most that one of the mechanisms with this alpha0 can have" if many else SHARE
    a0 = alpha * G / (e * confidence)
    mass = e * total / G
    return [
        Quantity("alpha0", "load factor that sets it off", f"{flow}, this report", alpha, "", "[C8.7.1.1]"),
        Quantity("sum P", "weight that moves along the push", "sum (P_k + Q_k)", total, "N", "[C8.7.1.5]"),
        Quantity("sum P dx", "weights times displacements along the push", "sum (P_k + Q_k) delta_PQx,k",
                 first, "N", "[C8.7.1.5]"),
        Quantity("sum P dx^2", "the same with squares", "sum (P_k + Q_k) delta_PQx,k^2", second, "N",
                 "[C8.7.1.5]"),
        Quantity("sum P dy", "the same with displacements upwards", "sum (P_k + Q_k) delta_Py,k",
                 up, "N", "[C8.7.1.1]"),
        Quantity("e*", "participating share of the mass", share, e, "", "[C8.7.1.5]"),
        Quantity("M*", "participating mass", "e* sum P / g", mass, "kg", "Circolare 617/2009 (not seen)"),
        Quantity("FC", "confidence factor", GIVEN, confidence, "", "C8.5.4, C8.7.1.2.1.3"),
        Quantity("a0*", "acceleration that sets it off", "alpha0 g / (e* FC)", a0, "m/s2", "[C8.7.1.8]"),
    ], a0, e  # fmt: skip


def _equation(place: Place) -> str:
    """Number of what is compared with a0*."""
    return "[C8.7.1.9]" if place.elastic_period else "[C8.7.1.8]"


def _linear(demand: Spectrum, place: Place, q: float, ground: float) -> list[Quantity]:
    """The check with a behaviour factor, as accelerations of the mechanism and of the ground."""
    rigid, free = ("a_Z", "S_eZ(T_0)") if place.floor else ("a_g S", "S_e(T_0)")
    word = free if place.elastic_period else rigid
    wanted = place.acceleration(demand)
    source = f"{_equation(place)}, {'[C7.2.5]' if place.elastic_period else '[C7.2.8]'}"
    at = [
        Quantity("T_0", "period before it is set off", GIVEN, place.elastic_period, "s", "[C8.7.1.7]"),
        Quantity(free, "acceleration at T_0, damping 5 %", "spectrum", wanted, "m/s2", source),
    ]  # fmt: skip
    return [
        *(at if place.elastic_period else []),
        Quantity("q", "behaviour factor", GIVEN, q, "", SIMPLIFIED),
        Quantity("a_d", "demand of the linear check", f"{word} / q", wanted / q, "m/s2", SIMPLIFIED),
        Quantity("a_g,SLD", "ground acceleration that sets it off", f"from {word} = a0*", ground, "m/s2",
                 source),
        Quantity("a_g,SLV", "ground acceleration of the linear check", "q a_g,SLD", q * ground, "m/s2",
                 SIMPLIFIED),
        Quantity("zeta_E", "a_g,SLV over that of the site", "a_g,SLV / a_g", q * ground / demand.a_g, "",
                 "NTC 2018 8.3"),
    ]  # fmt: skip


def _non_linear(
    curve: CapacityCurve,
    scales: tuple[float, float],
    demands: tuple[Spectrum, Spectrum | None],
    damping: tuple[float, float],
    place: Place,
    set_off: float,
) -> tuple[list[Quantity], list[Inequality]]:
    """The checks at SLV and, with its spectrum, at SLC; the text has what sets it off of SLV alone."""
    found, checks = [], []
    for state, spectrum, xi, least in zip(("SLV", "SLC"), demands, damping, (set_off, 0.0), strict=True):
        if spectrum:
            found += steps("demand", given(spectrum, state)) if state != "SLV" else []
            more, check = displacement_check(state, curve, scales, spectrum, place, xi, least)
            found += steps(state, more)
            checks.append(check)
    return found, checks

"""The check of displacements at SLV and SLC on a capacity curve: Circolare 7/2019, C8.7.1.2.1.8."""

from __future__ import annotations

from math import isclose

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.evidence.relative_rates import largest_rate
from limitblocks.model import Model, refuse_other
from limitblocks.practice.advance import velocity
from limitblocks.practice.capacity_result import CapacityCurve, zero_of
from limitblocks.practice.inputs import GIVEN
from limitblocks.practice.moving_masses import MovingMass, moving_masses
from limitblocks.practice.spectra import Place, Spectrum, ground_acceleration
from limitblocks.practice.verification_result import Inequality, Quantity

SHARES = {"SLV": 0.4, "SLC": 0.6}  # of d0*, C8.7.1.2.1.6
FACTORS = {"SLV": 1.68, "SLC": 1.56}  # T = factor pi sqrt(d / a), [C8.7.1.10], [C8.7.1.11]
EQUATIONS = {"SLV": "[C8.7.1.10]", "SLC": "[C8.7.1.11]"}
SAME = 1e-3  # of the load factor, of the largest velocity: less of a difference is none


def displacement_check(
    state: str,
    curve: CapacityCurve,
    scales: tuple[float, float],
    spectrum: Spectrum,
    place: Place,
    damping: float,
    set_off: float,
) -> tuple[list[Quantity], Inequality]:
    """Return displacement, acceleration, period and demand at a limit state, and the check.

    Parameters
    ----------
    state : "SLV" or "SLC"
    curve : CapacityCurve
        To zero.
    scales : (float, float)
        Spectral displacement over that of the control point [C8.7.1.4], and acceleration over load factor,
        g / (e* FC), m/s2 [C8.7.1.3].
    spectrum, place, damping
        Demand.
    set_off : float
        Ground acceleration that sets the mechanism off, m/s2: that of the limit state is no less.
    """
    assert curve.zero is not None  # the caller has refused it
    share, factor, T_0 = SHARES[state], FACTORS[state], place.elastic_period
    d0, a0 = curve.zero * scales[0], curve.load_factors[0] * scales[1]
    d = share * d0
    there = _least_at(curve, share * curve.zero)
    elastic = 4.0 * np.pi**2 * d / T_0**2 if T_0 else np.inf
    if not there > 0.0:
        raise ModelError(
            f"the capacity curve has too few points near {share:g} of its zero: by the chords beside them it "
            "may be zero there; ask for more steps"
        )
    line, own = min(a0 * (1.0 - share), elastic), min(there * scales[1], elastic)
    periods = [factor * np.pi * float(np.sqrt(d / a)) for a in (line, own)]
    demand = place.displacement(spectrum, periods, damping)
    most = ground_acceleration(spectrum, lambda site: place.displacement(site, periods, damping), d)
    said, source = (
        ("S_eZ(T) (T / 2 pi)^2", "[C8.7.1.12]") if place.floor else ("S_De(T)", "NTC 2018 [3.2.10]")
    )
    until, branch = (", at most 4 pi^2 d / T_0^2", "[C8.7.1.3], [C8.7.1.6]") if T_0 else ("", "[C8.7.1.3]")
    compared = Inequality(f"non-linear, {state}", max(most, set_off), spectrum.a_g, "m/s2", "C8.7.1.2.1.8")
    first = [
        Quantity("d0*", "spectral displacement of no resistance",
                 "d_C0 sum P dx^2 / (delta_C sum P dx)", d0, "m", "[C8.7.1.4]"),
    ]  # fmt: skip
    return [
        *(first if state == "SLV" else []),
        Quantity(f"d*_{state}", f"displacement at {state}", f"{share:g} d0*", d, "m", "C8.7.1.2.1.6"),
        Quantity(f"a*_{state}", f"acceleration at {state}, straight line from a0* to d0*",
                 f"a0* (1 - {share:g}){until}", line, "m/s2", "C8.7.1.2.1.3"),
        Quantity(f"T_{state}", f"secant period at {state}, straight line", f"{factor:g} pi sqrt(d* / a*)",
                 periods[0], "s", EQUATIONS[state]),
        Quantity(f"a*_{state},c", f"acceleration at {state}, capacity curve",
                 f"alpha(d_C) g / (e* FC){until}", own, "m/s2", branch),
        Quantity(f"T_{state},c", f"secant period at {state}, capacity curve",
                 f"{factor:g} pi sqrt(d* / a*)", periods[1], "s", EQUATIONS[state]),
        Quantity(f"xi_{state}", f"damping of the mechanism at {state}", GIVEN, damping, "", "C8.7.1.2.1.8"),
        Quantity(f"S_De_{state}", f"displacement demand at {state}, the largest of these periods", said,
                 demand, "m", source),
        Quantity(f"d*/S_De_{state}", f"displacement at {state} over the demand", f"d*_{state} / S_De_{state}",
                 d / demand, "", "C8.7.1.2.1.8"),
        Quantity(f"a_g,{state},d", f"ground acceleration at which the demand is d*_{state}",
                 "from S_De = d*", most, "m/s2", "[C8.7.1.12]"),
    ], compared  # fmt: skip


def _least_at(curve: CapacityCurve, displacement: float) -> float:
    """Least load factor at a displacement before the zero: a curve that snaps may pass there again.

    Between two points it is on the chord or, if that is less, on the higher of the chords beside it drawn on:
    at most that of a curve that bends one way.
    """
    until = len(curve.points) - curve.points[-1].snapped
    x, y = curve.displacements[:until] - displacement, curve.load_factors[:until]
    way = np.diff(x)
    found = []
    for k in np.flatnonzero(x[:-1] * x[1:] <= 0.0):
        drawn_on = [
            y[j] - x[j] * (y[j + 1] - y[j]) / way[j]
            for j in (k - 1, k + 1)
            if 0 <= j < len(way) and way[j] * way[k] > 0.0
        ]
        chord = y[k] - x[k] * (y[k + 1] - y[k]) / way[k]
        found.append(min(chord, max(drawn_on, default=chord)))
    return float(min(found))


def per_control(
    model: Model, alpha: float, rates: Array, curve: CapacityCurve, masses: tuple[MovingMass, ...]
) -> float:
    """Return the spectral displacement over that of the control point, [C8.7.1.4].

    Parameters
    ----------
    model : Model
    alpha : float
        Load factor that sets the mechanism off.
    rates : Array, shape (n, 6)
        Of the mechanism, scaled as those of its masses.
    curve : CapacityCurve
    masses : tuple of MovingMass

    Raises
    ------
    ModelError
        If the curve is of another model or mechanism, or does not end at a zero that its points have.
    """
    if curve.zero is None:
        raise ModelError(f"the capacity curve does not end at zero: {curve.ended}")
    refuse_other(model, curve)
    if curve.zero == 0.0:
        raise ModelError("the capacity curve is zero from the first: the live load meets no resistance")
    if not isclose(curve.zero, zero := zero_of(curve.points)):
        raise ModelError(
            f"the capacity curve says that it is zero at {curve.zero:g} m; by its last points, at {zero:g} m"
        )
    _refuse_other_mechanism(model, alpha, rates, curve)
    delta = float(velocity(model, curve.control, rates) @ curve.control.direction)
    P, x = (np.array([getattr(one, of) for one in masses]) for of in ("weight", "horizontal"))
    return float(P @ x**2) / (delta * float(P @ x))


def _refuse_other_mechanism(model: Model, alpha: float, rates: Array, curve: CapacityCurve) -> None:
    """ModelError where the curve starts at another load factor, or with another mechanism."""
    first = curve.points[0]
    _, scale = moving_masses(model, first.result.displacement_rates)
    apart = largest_rate(model, scale * first.result.displacement_rates - rates)
    if isclose(first.load_factor, alpha, rel_tol=SAME) and apart <= SAME * largest_rate(model, rates):
        return
    raise ModelError(
        f"the capacity curve is that of another answer (alpha0 = {first.load_factor:.6g}) than the one "
        f"verified (alpha0 = {alpha:.6g}), or of another mechanism: verify that of nonassociated, where it "
        "starts, or leave the curve out"
    )

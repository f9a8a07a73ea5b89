"""What a verification takes of a capacity curve: one that follows the mechanism that is verified."""

from __future__ import annotations

from math import isclose

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.evidence.relative_rates import largest_rate
from limitblocks.model import Model, refuse_other
from limitblocks.practice.advance import velocity
from limitblocks.practice.capacity_result import CapacityCurve, zero_of
from limitblocks.practice.moving_masses import MovingMass, moving_masses

SAME = 1e-3  # of the load factor, of the largest velocity: less of a difference is none


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

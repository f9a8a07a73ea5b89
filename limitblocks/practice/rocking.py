"""Further checks of walls in earthquakes: floor acceleration of Eurocode 8, periods of walls, rocking.

Sources: EN 1998-1:2004, Section 4.3.5.2, Eqs (4.24), (4.25); Circolare 7/2019, [C8.7.1.7]; Housner (1963),
The behavior of inverted pendulum structures during earthquakes, Bull. Seism. Soc. Am. 53(2).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from limitblocks.errors import ModelError
from limitblocks.mechanics.loads.load import number
from limitblocks.practice.spectra import G


def element_acceleration(
    alpha: float, S: float, *, z: float, height: float, element_period: float, building_period: float
) -> float:
    """Return the seismic coefficient S_a of a non-structural element, over g, EN 1998-1 Eq. (4.25).

    ``S_a = alpha S [3 (1 + z / H) / (1 + (1 - T_a / T_1)^2) - 0.5]``, at least ``alpha S``.

    Parameters
    ----------
    alpha : float
        Design ground acceleration on rock over g.
    S : float
        Soil factor.
    z, height : float
        Of the element above the foundation and of the building, m.
    element_period, building_period : float
        T_a and T_1, s.

    Raises
    ------
    ModelError
        If a number is out of range.
    """
    a, soil = number(alpha, "alpha", "", above=0.0), number(S, "S", "", above=0.0)
    H = number(height, "height of the building", "m", above=0.0)
    T_1 = number(building_period, "period of the building", "s", above=0.0)
    T_a = number(element_period, "period of the element", "s", least=0.0)
    share = number(z, "height of the element", "m", least=0.0) / H
    if share > 1.0:
        raise ModelError(f"height of the element is {z!r} m, above the building of {height!r} m")
    return a * soil * max(3.0 * (1.0 + share) / (1.0 + (1.0 - T_a / T_1) ** 2) - 0.5, 1.0)


def element_force(acceleration: float, weight: float, *, importance: float = 1.0, q_a: float = 2.0) -> float:
    """Return the horizontal force F_a = S_a W_a gamma_a / q_a on an element, N, EN 1998-1 Eq. (4.24).

    `acceleration` S_a is over g, `weight` W_a in N, `importance` the factor gamma_a, `q_a` that of behaviour.

    Raises
    ------
    ModelError
        If a number is out of range: the last is at least 1, the others above 0.
    """
    return (
        number(acceleration, "S_a", "", above=0.0)
        * number(weight, "weight", "N", above=0.0)
        * number(importance, "importance factor", "", above=0.0)
        / number(q_a, "q_a", "", least=1.0)
    )


def elastic_period(
    length: float, thickness: float, unit_weight: float, modulus: float, *, cantilever: bool = True
) -> float:
    """Return the period T_0 of a wall free to vibrate before it rocks, s, Circolare 7/2019 [C8.7.1.7].

    ``T_0 = kappa lambda L sqrt(W / (E g))`` of a beam with even mass; lambda = L / t, kappa 6.2 or 2.2.

    Parameters
    ----------
    length, thickness : float
        L and t, m.
    unit_weight : float
        W, N/m3.
    modulus : float
        E, Pa; of cracked masonry.
    cantilever : bool
        Whether it stands free (a parapet, a pinnacle), or is held at both ends.

    Raises
    ------
    ModelError
        If a number is not above 0.
    """
    L, t = (number(x, name, "m", above=0.0) for x, name in ((length, "length"), (thickness, "thickness")))
    W = number(unit_weight, "unit weight", "N/m3", above=0.0)
    E = number(modulus, "modulus of elasticity", "Pa", above=0.0)
    return float((6.2 if cantilever else 2.2) * L / t * L * np.sqrt(W / (E * G)))


@dataclass(frozen=True)
class Rocking:
    """A rigid rectangle that rocks about its lower corners, Housner (1963).

    Parameters
    ----------
    width, height : float
        m.

    Raises
    ------
    ModelError
        If a dimension is not positive.
    """

    width: float
    height: float

    def __post_init__(self) -> None:
        number(self.width, "width", "m", above=0.0)
        number(self.height, "height", "m", above=0.0)

    @property
    def slenderness(self) -> float:
        """Angle alpha of the diagonal, rad: the load factor is its tangent."""
        return float(np.arctan2(self.width, self.height))

    @property
    def frequency(self) -> float:
        """Frequency parameter p = sqrt(3 g / 4 R), 1/s, R half the diagonal."""
        return float(np.sqrt(1.5 * G / np.hypot(self.width, self.height)))

    @property
    def restitution(self) -> float:
        """Angular velocity after an impact over that before: 1 - 1.5 sin^2 alpha, Housner's Eq. (6)."""
        return 1.0 - 1.5 * float(np.sin(self.slenderness)) ** 2

    def period(self, amplitude: float) -> float:
        """Return the period of free rocking, s: 4 / p acosh(1 / (1 - amplitude)), Housner's Eq. (4).

        `amplitude` is the largest rotation over alpha, 0 to less than 1. Of slender blocks, without losses.

        Raises
        ------
        ModelError
            If the amplitude is outside that.
        """
        if not 0.0 <= number(amplitude, "amplitude", "") < 1.0:
            raise ModelError(f"amplitude is {amplitude!r} of the slenderness, expected 0 to less than 1")
        return 4.0 / self.frequency * float(np.arccosh(1.0 / (1.0 - amplitude)))

"""Elastic response spectrum of NTC 2018 and floor spectra of Circolare 7/2019, with explicit inputs.

Sources: NTC 2018 (D.M. 17/01/2018), Section 3.2.3.2, Eqs [3.2.2]-[3.2.7], [3.2.10]; Circolare 7/2019, Section
C7.2.3, Eqs [C7.2.5]-[C7.2.10], and [C8.7.1.12], checked against a transcription of the official text.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

from limitblocks.errors import ModelError, sequence_of
from limitblocks.joints.base import checked_count
from limitblocks.mechanics.loads.load import number

G = 9.81  # m/s2, as the code's examples take it
MOST = 10.0  # of S, F0 and periods in s, several times what the code has: more is a slip or another unit
MOST_T_C = 1.6  # s, the least T_D of [3.2.7]: beyond it the branches would not meet
MOST_DAMPING = 0.3  # from .281 on eta is .55, its least: more is in per cent
WIDEST = 1e6  # times the ground acceleration of the site: where that of a limit state is looked for


def damping_factor(damping: float) -> float:
    """Return eta = sqrt(10 / (5 + damping in %)), at least .55, Eq. [3.2.4]; `damping` as a ratio."""
    xi = number(damping, "damping", "", least=0.0, most=MOST_DAMPING)
    return max(float(np.sqrt(10.0 / (5.0 + 100.0 * xi))), 0.55)


@dataclass(frozen=True)
class Spectrum:
    """Elastic horizontal spectrum of one limit state, NTC 2018 Section 3.2.3.2.1.

    Parameters
    ----------
    a_g : float
        Ground acceleration on rock, m/s2.
    S : float
        Soil and topography, S_S S_T, Eq. [3.2.3].
    F0 : float
        Largest amplification, at least 2.2.
    T_C : float
        Start of the branch of constant velocity, s, at most 1.6: C_C T*_C, Eq. [3.2.5]. T_B = T_C / 3, and
        T_D = 4 a_g / g + 1.6, Eqs [3.2.6], [3.2.7].

    Raises
    ------
    ModelError
        If a number is out of range.
    """

    a_g: float
    S: float
    F0: float
    T_C: float

    def __post_init__(self) -> None:
        number(self.a_g, "a_g", "m/s2", above=0.0)
        number(self.S, "S", "", above=0.0, most=MOST)
        number(self.F0, "F0", "", least=2.2, most=MOST)
        number(self.T_C, "T_C", "s", above=0.0, most=MOST_T_C)

    @property
    def T_B(self) -> float:
        """Start of the branch of constant acceleration, s."""
        return self.T_C / 3.0

    @property
    def T_D(self) -> float:
        """Start of the branch of constant displacement, s."""
        return 4.0 * self.a_g / G + 1.6

    def acceleration(self, period: float, damping: float = 0.05) -> float:
        """Return S_e(T), m/s2, Eq. [3.2.2], at a `period` T, s; `damping` as a ratio."""
        eta, T = damping_factor(damping), number(period, "period", "s", least=0.0)
        plateau = self.a_g * self.S * eta * self.F0
        if self.T_B > T:
            return plateau * (T / self.T_B + (1.0 - T / self.T_B) / (eta * self.F0))
        if self.T_C > T:
            return plateau
        if self.T_D > T:
            return plateau * self.T_C / T
        return plateau * self.T_C * self.T_D / T**2

    def displacement(self, period: float, damping: float = 0.05) -> float:
        """Return S_De(T) = S_e(T) (T / 2 pi)^2, m, Eq. [3.2.10].

        Beyond T_E, 4.5 s and more, the code lets it fall; here it stays, on the safe side.
        """
        return self.acceleration(period, damping) * (period / (2.0 * np.pi)) ** 2


@dataclass(frozen=True)
class FloorMode:
    """A mode of the building that carries the mechanism up to the height Z.

    Parameters
    ----------
    period : float
        T_k, s.
    participation : float
        gamma_k, modal participation factor.
    shape : float
        psi_k(Z), modal shape at the height at which the mechanism is fixed.
    damping : float
        xi_k, equivalent damping as a ratio.
    """

    period: float
    participation: float
    shape: float
    damping: float = 0.05

    def __post_init__(self) -> None:
        number(self.period, "period of a mode", "s", above=0.0, most=MOST)
        number(self.participation, "participation of a mode", "")
        number(self.shape, "shape of a mode", "")
        number(self.damping, "damping of a mode", "", above=0.0, most=MOST_DAMPING)

    @classmethod
    def first(cls, period: float, storeys: int, height: float, damping: float = 0.05) -> FloorMode:
        """Return the first mode of a building of `storeys` of equal mass, linear over its height.

        psi = z / H, `height`, 0 to 1; gamma = 3 n / (2 n + 1), Eq. [C7.2.10]. `period` in s, `damping` as a
        ratio.

        Raises
        ------
        ModelError
            If a number is out of range.
        """
        checked_count("storeys", n := storeys, 1)
        if number(height, "height z / H", "", least=0.0) > 1.0:
            raise ModelError(f"height z / H is {height!r}, expected 0 to 1: a share of that of the building")
        return cls(period, 3.0 * n / (2.0 * n + 1.0), height, damping)


@dataclass(frozen=True)
class Floor:
    """The height z above the ground at which a mechanism is fixed, and the modes that carry it there.

    Floor spectrum of Circolare 7/2019, Eqs [C7.2.5], [C7.2.6] (after Degli Abbati, Cattari & Lagomarsino
    2018): in each mode 1.1 xi_k^-0.5 eta(xi) times the largest acceleration between `a` T_k and `b` T_k,
    falling on both sides, at T = 0 to the largest acceleration. T_1 of [C8.7.1.12] is the longest period.
    The text has xi_k in per cent; under the root of [C7.2.6] it is taken as a ratio, for 1.1 x 5^-0.5 would
    be less than one at resonance.
    """

    modes: tuple[FloorMode, ...]
    a: float = 0.8
    b: float = 1.1

    def __post_init__(self) -> None:
        object.__setattr__(self, "modes", sequence_of("modes of the building", self.modes, FloorMode))
        if not self.modes:
            raise ModelError("a floor spectrum needs at least one mode of the building")
        if not 0.0 < number(self.a, "a", "") <= number(self.b, "b", ""):
            raise ModelError(f"a is {self.a!r} and b is {self.b!r}, expected 0 < a <= b, .8 and 1.1")

    def peaks(self, ground: Spectrum) -> Sequence[float]:
        """Return the largest acceleration of the floor in each mode, m/s2.

        It is ``S_e(T_k, xi_k) |gamma_k psi_k| sqrt(1 + .0004 xi_k^2)``, xi_k in %, Eq. [C7.2.7].
        """
        return [
            ground.acceleration(mode.period, mode.damping)
            * abs(mode.participation * mode.shape)
            * float(np.sqrt(1.0 + 0.0004 * (100.0 * mode.damping) ** 2))
            for mode in self.modes
        ]

    def largest(self, ground: Spectrum) -> float:
        """Return the largest floor acceleration, m/s2, Eq. [C7.2.8], here no less than that of the ground."""
        return max(float(np.linalg.norm(self.peaks(ground))), ground.acceleration(0.0))

    def acceleration(self, ground: Spectrum, period: float, damping: float = 0.05) -> float:
        """Return S_eZ(T), m/s2, Eqs [C7.2.5], [C7.2.6]; no less than the spectrum of the ground at any T."""
        eta, shares, period = damping_factor(damping), [], number(period, "period", "s", least=0.0)
        for mode, peak in zip(self.modes, self.peaks(ground), strict=True):
            excess = 1.1 * mode.damping**-0.5 * eta - 1.0
            most = (1.0 + excess) * peak
            if period < self.a * mode.period:
                most /= 1.0 + excess * (1.0 - period / (self.a * mode.period)) ** 1.6
            elif period >= self.b * mode.period:
                most /= 1.0 + excess * (period / (self.b * mode.period) - 1.0) ** 1.2
            shares.append(most)
        return max(float(np.linalg.norm(shares)), ground.acceleration(period, damping))

    def displacement(self, ground: Spectrum, period: float, damping: float = 0.05) -> float:
        """Return S_eZ(T) (T / 2 pi)^2, m, and beyond b T_1 no less than there, Eq. [C8.7.1.12]."""
        first = max(mode.period for mode in self.modes)
        found = self.acceleration(ground, period, damping) * (period / (2.0 * np.pi)) ** 2
        if period <= self.b * first:
            return found
        least = self.acceleration(ground, first, damping) * (self.b * first / (2.0 * np.pi)) ** 2
        return max(found, least)


@dataclass(frozen=True)
class Place:
    """Where a mechanism is: on the ground or a floor; rigid until set off, or free to vibrate at T_0."""

    floor: Floor | None
    elastic_period: float

    def acceleration(self, ground: Spectrum) -> float:
        """Return what sets it off, m/s2: a_g S or a_Z [C7.2.8]; the spectrum at T_0 [C8.7.1.9]."""
        if self.floor:
            return self.floor.acceleration(ground, self.elastic_period)
        return ground.acceleration(self.elastic_period)

    def displacement(self, ground: Spectrum, periods: Sequence[float], damping: float) -> float:
        """Return the largest displacement of the spectrum at some periods and at T_0, m."""
        every = (*periods, self.elastic_period)
        if self.floor:
            return max(self.floor.displacement(ground, T, damping) for T in every)
        return max(ground.displacement(T, damping) for T in every)


def ground_acceleration(ground: Spectrum, demand: Callable[[Spectrum], float], capacity: float) -> float:
    """Return the a_g of a spectrum at which a demand, which grows with it, is the capacity; m/s2.

    Zero where it is less than a millionth of that of the site; ModelError where more than a million times.
    """

    def excess(a_g: float) -> float:
        return demand(replace(ground, a_g=a_g)) - capacity

    if excess(ground.a_g / WIDEST) >= 0.0:
        return 0.0
    if excess(ground.a_g * WIDEST) < 0.0:
        raise ModelError(f"a_g is {ground.a_g:g} m/s2: {WIDEST:g} times as much does not reach the capacity")
    return float(brentq(excess, ground.a_g / WIDEST, ground.a_g * WIDEST, rtol=1e-13))

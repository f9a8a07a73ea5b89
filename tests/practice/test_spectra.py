"""Spectra of the ground and of floors: their branches, formulas of C7.2.3, misuse."""

import numpy as np
import pytest
from facades import SITE

from limitblocks.errors import ModelError
from limitblocks.practice import Floor, FloorMode
from limitblocks.practice.spectra import Place, ground_acceleration


def test_a_ground_acceleration_is_looked_for_within_a_million_times_that_of_the_site():
    """a_g S is the capacity; a mechanism at its limit has next to none."""

    def found(share):
        return ground_acceleration(SITE, Place(None, 0.0).acceleration, share * SITE.a_g * SITE.S)

    assert found(0.3) == pytest.approx(0.3 * SITE.a_g, rel=1e-12)
    assert found(1e-7) == 0.0
    with pytest.raises(ModelError, match="1e\\+06 times as much does not reach the capacity"):
        found(1e7)


def test_order_of_the_modes_does_not_matter():
    """T_1 of [C8.7.1.12] is that of the fundamental mode: S_eZ(T_1) (1.1 T_1 / 2 pi)^2 from 1.1 T_1 on."""
    modes = FloorMode(0.5, 1.3, 1.0), FloorMode(0.15, -0.4, 1.0)
    floor = Floor(modes)
    expected = floor.acceleration(SITE, 0.5) * (1.1 * 0.5 / (2 * np.pi)) ** 2
    assert floor.displacement(SITE, 0.6) == pytest.approx(expected)
    assert Floor(modes[::-1]).displacement(SITE, 0.6) == pytest.approx(expected)


def test_displacement_of_a_floor_does_not_fall_beyond_its_first_mode():
    """[C8.7.1.12]: beyond b T_1 at least S_eZ(T_1) (b T_1 / 2 pi)^2."""
    floor = Floor((FloorMode(period=0.5, participation=1.3, shape=1.0),))
    least = floor.acceleration(SITE, 0.5) * (1.1 * 0.5 / (2 * np.pi)) ** 2
    assert floor.displacement(SITE, 0.6) == pytest.approx(least)
    assert floor.acceleration(SITE, 0.6) * (0.6 / (2 * np.pi)) ** 2 < least
    for period in (0.5, 0.53):  # up to b T_1 = .55 s what the spectrum has
        assert floor.displacement(SITE, period) == pytest.approx(
            floor.acceleration(SITE, period) * (period / (2 * np.pi)) ** 2
        )


def test_two_modes_add_by_squares():
    """[C7.2.8]: the root of the sum of the squares of [C7.2.7]."""
    modes = FloorMode(0.4, 1.3, 0.8, 0.1), FloorMode(0.15, -0.4, 1.0)
    shares = [
        SITE.acceleration(mode.period, mode.damping)
        * abs(mode.participation * mode.shape)
        * np.sqrt(1 + 0.0004 * (100 * mode.damping) ** 2)
        for mode in modes
    ]
    assert Floor(modes).peaks(SITE) == pytest.approx(shares)
    assert Floor(modes).largest(SITE) == pytest.approx(np.hypot(*shares))


def test_spectrum_is_continuous_and_has_its_branches():
    for period in (SITE.T_B, SITE.T_C, SITE.T_D):
        assert SITE.acceleration(period - 1e-9) == pytest.approx(SITE.acceleration(period + 1e-9), rel=1e-6)
    assert SITE.acceleration(0.0) == pytest.approx(SITE.a_g * SITE.S)
    assert SITE.acceleration(0.3) == pytest.approx(SITE.a_g * SITE.S * SITE.F0)
    assert SITE.acceleration(1.0) == pytest.approx(SITE.a_g * SITE.S * SITE.F0 * SITE.T_C)
    assert SITE.displacement(6.0) == pytest.approx(SITE.displacement(8.0))
    assert pytest.approx(2.6) == SITE.T_D


@pytest.mark.parametrize("damping", [0.02, 0.05, 0.20])
def test_ground_itself_is_not_damped(damping):
    """Eq. [3.2.2] is a_g S at T = 0 whatever eta, and straight from there to a_g S eta F0 at T_B."""
    start, plateau = SITE.a_g * SITE.S, SITE.a_g * SITE.S * SITE.F0 * np.sqrt(10 / (5 + 100 * damping))
    assert SITE.acceleration(0.0, damping) == pytest.approx(start)
    assert SITE.acceleration(0.25 * SITE.T_B, damping) == pytest.approx(0.75 * start + 0.25 * plateau)


def test_floor_spectrum():
    """At T = 0 the largest acceleration of the floor, flat about the period, continuous, not below ground."""
    mode = FloorMode(period=0.4, participation=1.3, shape=0.8)
    floor = Floor((mode,))
    largest = SITE.acceleration(0.4) * 1.3 * 0.8 * np.sqrt(1.01)
    assert floor.largest(SITE) == pytest.approx(largest)
    assert floor.acceleration(SITE, 0.0) == pytest.approx(largest)
    for period in (0.35, 0.43):  # between .8 and 1.1 T_k
        assert floor.acceleration(SITE, period) == pytest.approx(1.1 * 0.05**-0.5 * largest)
    for period in (0.8 * 0.4, 1.1 * 0.4):
        assert floor.acceleration(SITE, period - 1e-9) == pytest.approx(
            floor.acceleration(SITE, period + 1e-9), rel=1e-5
        )
    excess = 1.1 * 0.05**-0.5 - 1.0
    half = (1.0 + excess) / (1.0 + excess * 0.5**1.6)  # [C7.2.6] at half of a T_1
    assert floor.acceleration(SITE, 0.5 * 0.8 * 0.4) == pytest.approx(half * largest)
    for period in np.linspace(0.0, 4.0, 50):
        assert floor.acceleration(SITE, period) >= SITE.acceleration(period)
    # what stands on the floor is damped by its own share, eta = sqrt(10 / (5 + 2)) for 2 %
    assert floor.acceleration(SITE, 0.35, 0.02) == pytest.approx(1.1 * 0.05**-0.5 * np.sqrt(10 / 7) * largest)
    still = Floor((FloorMode(period=0.4, participation=1.3, shape=0.0),))
    assert still.acceleration(SITE, 0.7) == pytest.approx(SITE.acceleration(0.7))
    velocity = SITE.a_g * SITE.S * SITE.F0 * SITE.T_C  # of the ground, times eta / T
    assert still.acceleration(SITE, 0.7, 0.02) == pytest.approx(np.sqrt(10 / 7) * velocity / 0.7)
    assert still.largest(SITE) == pytest.approx(SITE.a_g * SITE.S)


def test_displacement_is_at_least_that_at_the_period_before_it_is_set_off():
    assert Place(None, 2.0).displacement(SITE, (0.1, 0.3), 0.05) == pytest.approx(SITE.displacement(2.0))
    assert Place(None, 0.2).displacement(SITE, (0.1, 0.3), 0.05) == pytest.approx(SITE.displacement(0.3))

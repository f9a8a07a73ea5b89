"""Domes: least thickness of two opposite lunes, and what hoop forces add."""

from functools import partial

import numpy as np
import pytest
from least_thickness import least_thickness, least_thickness_of_thrust_lines, lune_half, stands

import limitblocks as lb
from limitblocks import structures

JOINT = lb.PointContact(0.8)


def lunes(thickness, voussoirs, angle=0.1):
    return structures.dome_lunes(JOINT, radius=1.0, thickness=thickness, voussoirs=voussoirs, angle=angle)


def test_hemisphere_of_lunes_converges_to_the_published_least_thickness():
    """t/R = 0.0428 (Heyman 1967: 0.042), two opposite lunes without hoop force."""
    counts = (25, 51)
    thicknesses = np.array([least_thickness(partial(lunes, voussoirs=n), 0.0434) for n in counts])
    assert not stands(lunes(0.0427, 101))
    assert stands(lunes(0.0429, 101))
    limit = least_thickness_of_thrust_lines(lune_half, 0.03, 0.06)
    assert limit == pytest.approx(0.0428, abs=5e-5)
    assert np.all(np.abs(thicknesses / limit - 1) * np.square(counts) < 6.0)


@pytest.mark.parametrize("angle", [0.02, 0.5])
def test_least_thickness_does_not_depend_on_the_width_of_the_lunes(angle):
    assert not stands(lunes(0.0425, 51, angle))
    assert stands(lunes(0.0431, 51, angle))


def test_a_dome_stands_where_its_lunes_do():
    """Meridian joints that go through leave its lunes as they are; hoop forces can only help."""
    thickness, courses = 0.06, 5
    assert stands(lunes(thickness, 2 * courses + 1))
    for running_bond in (False, True):
        model = structures.dome(
            JOINT, radius=1.0, thickness=thickness, courses=courses, stones=8, running_bond=running_bond
        )
        assert stands(model)

"""Domes beside that of docs/validation.md: width of lunes, and what hoop forces add."""

import pytest
from least_thickness import stands

import limitblocks as lb
from limitblocks import structures

JOINT = lb.PointContact(0.8)


def lunes(thickness, voussoirs, angle=0.1):
    return structures.dome_lunes(JOINT, radius=1.0, thickness=thickness, voussoirs=voussoirs, angle=angle)


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

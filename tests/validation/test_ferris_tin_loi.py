"""Ferris & Tin-Loi (2001), Int. J. Mech. Sci. 43, 209-224: walls 1-4, associated flow, friction 0.65."""

import pytest

import limitblocks as lb
from limitblocks.structures.cases import FERRIS_TIN_LOI
from limitblocks.structures.ferris_tin_loi import BLOCK_HEIGHT, COURSES

JOINTS = [lb.OrdunaLourenco(0.65), lb.PointContact(0.65)]
ASSOCIATED = {number: one.value for number, one in FERRIS_TIN_LOI.items()}


@pytest.mark.parametrize("joint", JOINTS, ids=lambda joint: type(joint).__name__)
@pytest.mark.parametrize("number", ASSOCIATED)
def test_associated_load_factor_in_plane(number, joint):
    result = lb.bounds(lb.structures.ferris_tin_loi_wall(number, joint))
    assert result.lower == pytest.approx(ASSOCIATED[number], abs=1e-5)
    assert result.upper == pytest.approx(ASSOCIATED[number], abs=1e-5)
    assert result.gap < 1e-6


@pytest.mark.parametrize("thickness", [0.1, 1.0])
@pytest.mark.parametrize("joint", JOINTS, ids=lambda joint: type(joint).__name__)
def test_load_factor_in_plane_does_not_depend_on_the_thickness(joint, thickness):
    result = lb.bounds(lb.structures.ferris_tin_loi_wall(3, joint, thickness=thickness))
    assert result.lower == pytest.approx(ASSOCIATED[3], abs=1e-5)


@pytest.mark.parametrize("joint", JOINTS, ids=lambda joint: type(joint).__name__)
@pytest.mark.parametrize("number", [1, 2])
@pytest.mark.parametrize("thickness", [0.2, 0.4])
def test_plain_wall_pushed_out_of_plane_rocks_as_a_whole(number, joint, thickness):
    wall = lb.structures.ferris_tin_loi_wall(number, joint, thickness=thickness, direction=(0, 1, 0))
    result = lb.bounds(wall)
    expected = thickness / (len(COURSES[number]) * BLOCK_HEIGHT)
    assert result.lower == pytest.approx(expected, rel=1e-6)
    assert result.upper == pytest.approx(expected, rel=1e-6)
    assert result.gap < 1e-6


@pytest.mark.parametrize("joint", [lb.OrdunaLourenco(0.1), lb.PointContact(0.1)], ids=["OL", "PC"])
def test_plain_wall_pushed_out_of_plane_slides_on_its_base_at_low_friction(joint):
    wall = lb.structures.ferris_tin_loi_wall(1, joint, thickness=0.4, direction=(0, 1, 0))
    assert lb.bounds(wall).lower == pytest.approx(0.1, rel=1e-6)

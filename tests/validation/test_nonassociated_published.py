"""Ferris & Tin-Loi (2001), Int. J. Mech. Sci. 43, 209-224: walls 1-4 without dilatancy, friction 0.65."""

import pytest

import limitblocks as lb
from limitblocks.structures.cases import FERRIS_TIN_LOI, FERRIS_TIN_LOI_NONASSOCIATED

JOINTS = [lb.OrdunaLourenco(0.65), lb.PointContact(0.65)]
NONASSOCIATED = {number: one.value for number, one in FERRIS_TIN_LOI_NONASSOCIATED.items()}
ASSOCIATED = {number: one.value for number, one in FERRIS_TIN_LOI.items()}

WALLS = tuple(NONASSOCIATED)
both_joints = pytest.mark.parametrize("joint", JOINTS, ids=lambda joint: type(joint).__name__)


def assert_published(model, result, number):
    """Not unique: 1 % of the reference, at most the associated value, and every residual of the MCP."""
    assert result.load_factor == pytest.approx(NONASSOCIATED[number], rel=0.01)
    assert result.load_factor <= ASSOCIATED[number] + 1e-5
    assert result.associated == pytest.approx(ASSOCIATED[number], abs=1e-5)
    assert result.frictionless == pytest.approx(0.0, abs=1e-9)  # the base resists no push
    check = lb.check_mcp(model, result)
    assert check.worst.value <= 1e-6
    assert not check.mechanism_found


# lesson 09 has all walls with the first joint, scripts/validation all walls with both joints and all analyses
@pytest.mark.parametrize(
    ("number", "joint"), [(1, JOINTS[0]), (4, JOINTS[0]), *((k, JOINTS[1]) for k in WALLS)]
)
def test_nonassociated_load_factor(number, joint):
    wall = lb.structures.ferris_tin_loi_wall(number, joint)
    assert_published(wall, lb.nonassociated(wall), number)


@pytest.mark.parametrize(
    ("number", "joint"), [(1, JOINTS[0]), (3, JOINTS[0]), (3, JOINTS[1]), (4, JOINTS[1])]
)
def test_load_path_ends_at_the_nonassociated_load_factor(number, joint):
    wall = lb.structures.ferris_tin_loi_wall(number, joint)
    path = lb.load_path(wall)
    assert_published(wall, path.collapse, number)
    assert path.steps[0].load_factor == 0.0
    assert max(max(step.residuals.values()) for step in path.steps) <= 1e-6
    assert path.peak <= ASSOCIATED[number] + 1e-5  # statically admissible states: the static theorem


def test_a_wall_checked_again_from_its_result_file(tmp_path):
    wall = lb.structures.ferris_tin_loi_wall(3, JOINTS[0])
    result = lb.nonassociated(wall)
    again = lb.read_result(lb.files.write_result(result, tmp_path / "wall.json"))
    check = lb.check_mcp(wall, again)
    assert check.worst.value <= 1e-6
    assert not check.mechanism_found
    assert again.load_factor == result.load_factor
    with pytest.raises(lb.ModelError, match="belongs to model"):
        lb.check_mcp(lb.structures.ferris_tin_loi_wall(3, JOINTS[1]), again)


@both_joints
@pytest.mark.parametrize("thickness", [0.2, 0.4])
def test_plain_wall_pushed_out_of_plane_rocks_as_a_whole(joint, thickness):
    """Six courses of 0.175 m: no joint slides, so that thickness / height holds for any flow rule."""
    wall = lb.structures.ferris_tin_loi_wall(1, joint, thickness=thickness, direction=(0, 1, 0))
    result = lb.nonassociated(wall)
    assert result.load_factor == pytest.approx(thickness / (6 * 0.175), rel=1e-5)
    assert lb.check_mcp(wall, result).passed

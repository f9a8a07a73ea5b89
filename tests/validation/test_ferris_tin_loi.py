"""Ferris & Tin-Loi (2001), Int. J. Mech. Sci. 43, 209-224: what docs/validation.md does not say of walls 1-4.

That has the load factors of all walls by all analyses, pushed along and out of plane.
"""

import pytest

import limitblocks as lb
from limitblocks.structures.cases import FERRIS_TIN_LOI

JOINTS = [lb.OrdunaLourenco(0.65), lb.PointContact(0.65)]
ASSOCIATED = {number: one.value for number, one in FERRIS_TIN_LOI.items()}


@pytest.mark.parametrize(("number", "joint"), [(4, JOINTS[0]), (3, JOINTS[1])])
def test_the_path_and_its_end_lie_within_the_limits(number, joint):
    """Steps are statically admissible: the static theorem; the base resists no push without friction."""
    wall = lb.structures.ferris_tin_loi_wall(number, joint)
    path = lb.load_path(wall)
    result = path.collapse
    assert result.load_factor <= ASSOCIATED[number] + 1e-5
    assert result.associated == pytest.approx(ASSOCIATED[number], abs=1e-5)
    assert result.frictionless == pytest.approx(0.0, abs=1e-9)
    assert path.steps[0].load_factor == 0.0
    assert max(max(step.residuals.values()) for step in path.steps) <= 1e-6
    assert path.peak <= ASSOCIATED[number] + 1e-5


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


@pytest.mark.parametrize("kind", [lb.OrdunaLourenco, lb.PointContact])
def test_plain_wall_pushed_out_of_plane_slides_on_its_base_at_low_friction(kind):
    wall = lb.structures.ferris_tin_loi_wall(1, kind(0.1), thickness=0.4, direction=(0, 1, 0))
    assert lb.bounds(wall).lower == pytest.approx(0.1, rel=1e-6)

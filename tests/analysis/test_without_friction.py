"""Joints without friction, such as sliding bearings: what slides freely, and what still carries."""

from dataclasses import replace

import pytest

import limitblocks as lb

WIDTH, BLOCK, PUSH, AT = 0.5, 10e3, 1e3, 0.35  # m; N; N; m from the middle of the upper block


def tower(lower, upper, live):
    """Two cubes, one on the other."""
    stones = [
        lb.Block.box("ground", (4, 1, 0.2), (0, 0, -0.1)),
        lb.Block.box("a", (WIDTH, 1, 1), (0, 0, 0.5), BLOCK / WIDTH),
        lb.Block.box("b", (WIDTH, 1, 1), (0, 0, 1.5), BLOCK / WIDTH),
    ]
    found = lb.find_interfaces(stones, lb.OrdunaLourenco(0.6))
    joints = map(lb.OrdunaLourenco, (lower, upper))
    given = [replace(one, joint=joint) for one, joint in zip(found, joints, strict=True)]
    return lb.Model(stones, ["ground"], given, lb.self_weight(), live)


@pytest.mark.parametrize("direction", [(1, 0, 0), (0, 1, 0)])
@pytest.mark.parametrize("frictions", [(0.0, 0.6), (0.6, 0.0), (0.0, 0.0)])
@pytest.mark.parametrize("analysis", [lb.bounds, lb.nonassociated, lb.load_path])
def test_what_slides_freely_has_the_load_factor_zero(analysis, frictions, direction):
    found = analysis(tower(*frictions, lb.mass_proportional(direction)))
    assert found.load_factor == 0.0
    assert "load factor 0" in str(found)


@pytest.mark.parametrize("analysis", [lb.bounds, lb.nonassociated])
def test_a_block_tips_on_a_tower_that_may_slide(analysis):
    # about the edge of b: PUSH alpha (AT - WIDTH/2) = BLOCK WIDTH/2
    live = lb.loads.force("b", (0, 0, -PUSH), at=(AT, 0, 2))
    expected = BLOCK * WIDTH / 2.0 / (PUSH * (AT - WIDTH / 2.0))
    assert analysis(tower(0.0, 0.6, live)).load_factor == pytest.approx(expected, rel=1e-6)

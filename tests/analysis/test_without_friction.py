"""Joints without friction, such as sliding bearings: what slides freely, and what still carries."""

from dataclasses import replace

import numpy as np
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


@pytest.mark.parametrize("kind", [lb.OrdunaLourenco, lb.PointContact])
@pytest.mark.parametrize("corners", [3, 4, 5, 7])
@pytest.mark.parametrize("turned", [0.1, 0.3])
def test_a_level_joint_without_friction_carries_what_leans_on_it_however_it_lies_in_plan(
    kind, corners, turned
):
    """Its normal is upright but for rounding: that was an equation of its own, and left no normal force."""
    corner = turned + 2.0 * np.pi * np.arange(corners) / corners
    circle = np.stack([np.cos(corner), np.sin(corner)], axis=1)
    upper = lb.Block.prism("upper", 0.4 * circle, (0.6, 1.0), 2e4, along="z")
    lower = lb.Block.prism("lower", 0.5 * circle, (0.0, 0.6), 2e4, along="z")
    stones = [lb.Block.box("ground", (4, 4, 0.3), (0, 0, -0.15)), lower, upper]
    smooth, rough = kind(0.0), kind(0.3)
    joints = lb.find_interfaces(stones, lambda a, b: smooth if "upper" in (a.name, b.name) else rough)
    push = lb.loads.force("lower", (1e3, 0, 0), at=(0, 0, 0.05))
    model = lb.Model(stones, ["ground"], joints, lb.self_weight(), push)
    expected = 0.3 * (lower.weight + upper.weight) / 1e3
    assert lb.bounds(model).load_factor == pytest.approx(expected, rel=1e-6)
    assert lb.nonassociated(model).load_factor == pytest.approx(expected, rel=1e-6)

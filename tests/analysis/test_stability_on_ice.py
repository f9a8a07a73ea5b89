"""Joints of little or no friction beside others, and flat arches: where paths do not start."""

from dataclasses import replace

import pytest
from stones import model_of

import limitblocks as lb
from limitblocks.analysis.nonassociated.permanent import arose
from limitblocks.problem import Flow

GAMMA = 20e3
JOINTS = [lb.PointContact, lb.OrdunaLourenco]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("joint", JOINTS)
@pytest.mark.parametrize("share", [1.0, 1e-6, 1e-9])
def test_blocks_on_ice_beside_others_decades_heavier_stand(joint, share):
    """Nothing resists sliding: the elastic equations were singular, and a warning of scipy came through."""
    blocks = [lb.Block.box("ground", (9, 2, 0.2), (0, 0, -0.1))]
    blocks += [
        lb.Block.box(f"{x}", (1, 1, 1), (x, 0, 0.5), GAMMA * (share if x < 0 else 1.0))
        for x in (-3, -2, 0, 1)
    ]
    assert lb.stability(model_of(blocks, ["ground"], joint(0.0))).stands


@pytest.mark.parametrize("joint", JOINTS)
@pytest.mark.parametrize("beds", [0.0, 0.5])
def test_heavy_stones_beside_a_light_one_on_ice_stand(joint, beds):
    """Each is borne by the ground alone, so that nothing presses them together: no path starts there."""
    blocks = [lb.Block.box("ground", (6, 2, 0.2), (0, 0, -0.1))]
    blocks += [
        lb.Block.box(name, (1, 1, height), (x, 0, height / 2), weight * GAMMA)
        for name, x, height, weight in (("left", -1, 1.2, 3), ("stone", 0, 1.0, 1), ("right", 1, 1.2, 3))
    ]
    interfaces = [
        replace(one, joint=joint(beds if "ground" in (one.block_i, one.block_j) else 0.5))
        for one in lb.find_interfaces(blocks, joint(0.5))
    ]
    push = lb.mass_proportional((1, 0, 0))
    structure = lb.Model(blocks, ["ground"], interfaces, lb.self_weight(), push)
    assert lb.stability(structure).stands
    flow = Flow(structure.problem)
    assert arose(flow, structure.problem.compliance)


@pytest.mark.parametrize("push", [(0.0, 0.0), (0.0, 0.1), (0.0, 0.2), (0.1, 0.1)])
def test_a_flat_arch_of_three_stones_stands_under_a_push_beside_its_weight(push):
    """Joints at 1 in 5, friction 1 in 2: the thrust grows until friction holds what slides down.

    Rounds that go all the way to what the last friction gives never end under a push askew.
    """
    slope = 0.2
    outlines = {
        "left": [(-3, 0), (-1.5, 0), (-1.5 - slope, 1), (-3, 1)],
        "a": [(-1.5, 0), (-0.5, 0), (-0.5 - slope / 2, 1), (-1.5 - slope, 1)],
        "b": [(-0.5, 0), (0.5, 0), (0.5 + slope / 2, 1), (-0.5 - slope / 2, 1)],
        "c": [(0.5, 0), (1.5, 0), (1.5 + slope, 1), (0.5 + slope / 2, 1)],
        "right": [(1.5, 0), (3, 0), (3, 1), (1.5 + slope, 1)],
    }
    blocks = [
        lb.Block.prism(name, outline, (-0.5, 0.5), GAMMA if len(name) == 1 else None, along="y")
        for name, outline in outlines.items()
    ]
    arch = model_of(blocks, ["left", "right"], lb.OrdunaLourenco(0.5))
    pushed = arch.dead + push[0] * lb.mass_proportional((1, 0, 0)) + push[1] * lb.mass_proportional((0, 1, 0))
    assert lb.stability(replace(arch, dead=pushed)).stands


@pytest.mark.parametrize("mu", [0.01, 0.02, 0.04, 0.06, 0.08, 0.3])
def test_margin_of_a_block_that_is_wedged_is_one(mu):
    """Nothing limits N: at each of eight points mu N - W / 8 may be as much as W."""
    blocks = [
        lb.Block.box("left", (1, 1, 2), (-1, 0, 0)),
        lb.Block.box("right", (1, 1, 2), (1, 0, 0)),
        lb.Block.box("stone", (1, 1, 2), (0, 0, 0), GAMMA),
    ]
    structure = model_of(blocks, ["left", "right"], lb.PointContact(mu))
    assert lb.stability(structure).margin == pytest.approx(1.0, rel=1e-9)

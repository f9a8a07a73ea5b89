"""Capacity curves of walls whose toe crushes under a tie: moments about the middle of the stress block."""

import numpy as np
import pytest
from scipy.optimize import brentq
from stones import model_of, shaft

import limitblocks as lb
from limitblocks.practice import capacity_curve, reinforced, tie

UNIT_WEIGHT, AREA = 18e3, 1e-4
FACADE = {"size": (0.5, 4.0, 5.0), "head": (-0.25, 4.5), "anchor": (-4.75, 0.0), "strength": 40e3}
SLENDER = {"size": (0.5, 1.0, 3.0), "head": (0.0, 3.0), "anchor": (0.0, -3.0), "strength": 8e3}
STOUT = {"size": (0.5, 1.0, 5.0), "head": (0.0, 5.0), "anchor": (0.0, -4.0), "strength": 12e3}


def tied(size, head, anchor, strength, crushing, prestress=0.0):
    _, depth, height = size
    blocks = [
        lb.Block.box("ground", (30, depth, 0.4), at=(0, 0, -0.2)),
        lb.Block.box("wall", size, at=(0, 0, height / 2), unit_weight=UNIT_WEIGHT),
    ]
    joint = lb.OrdunaLourenco(0.6, compressive_strength=crushing)
    push = lb.mass_proportional((1, 0, 0))
    bare = lb.Model(blocks, ["ground"], lb.find_interfaces(blocks, joint), lb.self_weight(), push)
    ends = (("wall", (head[0], 0, head[1])), ("ground", (anchor[0], 0, anchor[1])))
    return reinforced(bare, tie(*ends[0], *ends[1], area=AREA, strength=strength / AREA, prestress=prestress))


def by_hand(turn, size, head, anchor, strength, crushing, prestress=0.0):
    """Load factor and normal force after a turn about the toe; crushed are N / (crushing depth) at the toe.

    The crushing toe turns about the inner edge of that: beyond the tie's line it unloads the tie, in between
    the edge is on the line.
    """
    width, depth, height = size
    weight, toe = UNIT_WEIGHT * np.prod(size), np.array([width / 2, 0.0])
    turned = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    centre, end = (toe + turned @ (np.array(at) - toe) for at in ((0.0, height / 2), head))
    along = (anchor - end) / np.linalg.norm(anchor - end)
    line = end[0] - along[0] / along[1] * end[1]  # where it meets the floor
    least, most = (weight - tension * along[1] for tension in (prestress, strength))
    normal = np.clip(crushing * depth * (toe[0] - line), least, most)
    pull = (weight - normal) / along[1] * along
    middle = toe[0] - normal / (2 * crushing * depth)
    moment = weight * (middle - centre[0]) - pull[0] * end[1] + pull[1] * (end[0] - middle)
    return moment / (weight * centre[1]), normal


@pytest.mark.parametrize(
    ("case", "steps"),
    [
        *(({**FACADE, "crushing": strength}, 4) for strength in (1.8e6, 2.4e6, 4e6)),
        *(({**SLENDER, "crushing": 1e6}, steps) for steps in (6, 20)),
        ({**STOUT, "crushing": 1e6, "prestress": 9e3}, 10),
        ({**STOUT, "crushing": 3e5}, 8),
    ],
)
def test_a_tied_wall_whose_toe_crushes(case, steps):
    """Strips of the facade carry .02 m of the 4 m: 192 kN for 2.4 MPa, where 208 are needed.

    The other ties run down: their lines pass the inner edge of the crushed zone before the toe.
    """
    curve = capacity_curve(tied(**case), steps=steps)
    height = case["size"][2]
    for point in curve.points:
        expected, normal = by_hand(np.arcsin(point.displacement / height), **case)
        assert point.load_factor == pytest.approx(expected, abs=1e-6)
        assert -point.result.stress_resultants[0, 2] == pytest.approx(normal, rel=1e-5)
    zero = height * np.sin(brentq(lambda turn: by_hand(turn, **case)[0], 0.0, 1.0))
    assert curve.zero == pytest.approx(zero, rel=1e-5)


@pytest.mark.parametrize("strength", [1e6, 3e6])
def test_a_hollow_shaft_whose_wall_crushes(strength):
    """Pieces of its joint carry what the stress block does, d = W / (2 fc) deep along a wall 2 m long."""
    height = 4.0
    stones = shaft(height=height)
    crushed = stones[1].weight / (2.0 * strength)
    model = model_of(stones, ["ground"], lb.OrdunaLourenco(0.7, compressive_strength=strength))
    curve = capacity_curve(model, control=(stones[1].name, (1.0, 0.0, height)), steps=4)
    for point in curve.points:
        turn = np.arcsin(point.displacement / height)
        arm = np.cos(turn) - height / 2 * np.sin(turn) - crushed / 2
        rise = np.sin(turn) + height / 2 * np.cos(turn)
        assert point.load_factor == pytest.approx(arm / rise, abs=1e-6)


def test_a_curve_ends_where_its_last_step_falls_short_by_rounding():
    """One wall leans on another; what was left to .4 m moved nothing, as if a contact stopped it."""
    blocks = [
        lb.Block.box("ground", (30, 1, 0.4), at=(0, 0, -0.2)),
        lb.Block.box("higher", (0.5, 1, 4), at=(-0.25, 0, 2), unit_weight=UNIT_WEIGHT),
        lb.Block.box("lower", (0.7, 1, 3), at=(0.35, 0, 1.5), unit_weight=UNIT_WEIGHT),
    ]
    joints = lb.find_interfaces(blocks, lb.OrdunaLourenco(0.6, compressive_strength=1e7))
    model = lb.Model(blocks, ["ground"], joints, lb.self_weight(), lb.mass_proportional((1, 0, 0)))
    curve = capacity_curve(model, steps=5, largest=0.4)
    assert curve.ended == "the displacement 0.4 m is reached"
    assert np.diff(curve.displacements).min() > 1e-6

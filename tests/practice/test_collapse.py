"""A support that settles until the structure falls: closed forms of arches and beams."""

from dataclasses import replace

import numpy as np
import pytest
from few_blocks import moved
from scipy.optimize import brentq
from settling_blocks import SPREAD, arch, beam_on
from spreading_arch import beside_the_crown, first_hinge, fourth_hinge, half_ring, three_hinged
from stones import model_of

import limitblocks as lb
from limitblocks.arrays import read_only
from limitblocks.loads import force
from limitblocks.practice import Control, reinforced, settlement_to_collapse, tie
from limitblocks.practice.advance import Advanced, shut
from limitblocks.practice.displaced import assembly_of


@pytest.mark.parametrize(
    ("voussoirs", "thickness", "without_dilatancy"), [(8, 0.2, True), (8, 0.2, False), (16, 0.15, False)]
)  # fmt: skip
def test_arch_spreads_until_its_thrust_leaves_the_springing(voussoirs, thickness, without_dilatancy):
    """Its fourth hinge is at the extrados of the springing; in between the thrust of a three-hinged arch.

    The case of Ochsendorf (2006), The masonry arch on spreading supports, by another program.
    """
    hinge = first_hinge(voussoirs, thickness)
    ring, weight = arch(voussoirs, thickness)
    fourth = fourth_hinge(voussoirs, thickness)
    curve = settlement_to_collapse(
        ring, "right support", SPREAD, step=0.1, accuracy=1e-2, without_dilatancy=without_dilatancy
    )
    expected = [three_hinged(voussoirs, thickness, d, hinge)[0] * weight for d in curve.displacements]
    assert curve.reactions == pytest.approx(expected, rel=1e-6)
    assert curve.stands_to <= fourth <= curve.falls
    assert curve.falls - curve.stands_to <= 1e-2
    assert curve.ended.startswith("the structure falls between")
    said = (
        f"reaction of {curve.reactions[0]:.6g} N to {curve.reactions[-1]:.6g} N: the structure falls between"
    )
    assert said in str(curve)
    assert all(point.found.bounds.proven and not point.across for point in curve.points)
    assert len(curve.points[1].changes) == 3
    crown = f"voussoir {voussoirs // 2}|voussoir {voussoirs // 2 + 1} opens"
    assert set(curve.points[1].changes) >= {crown, f"voussoir {hinge}|voussoir {hinge + 1} opens"}


@pytest.mark.parametrize("joint", [lb.OrdunaLourenco(0.8), lb.PointContact(0.8)], ids=["planes", "points"])
def test_a_stone_at_the_crown_goes_with_one_side(joint):
    """The first mechanism may open both of its joints, by any parts; then one of them closes again.

    The arch leans to that side, where the hinge moves from the first joint to the second. It pressed across
    the gaps of both, from the first step on, and was said to fall at .175 in place of .162.
    """
    fourth = brentq(lambda d: beside_the_crown(9, 0.16, d, 2, 1)[1] - 1.0, 0.01, 0.2)
    model, weight = arch(9, 0.16, joint)
    curve = settlement_to_collapse(model, "right support", SPREAD, step=0.03, accuracy=1e-3)
    assert not any(point.across for point in curve.points)
    d = curve.displacements
    expected = [beside_the_crown(9, 0.16, one, 2, 1)[0] * weight for one in d]
    assert curve.reactions[0] == pytest.approx(beside_the_crown(9, 0.16, 0.0, 1, 1)[0] * weight, rel=1e-6)
    assert curve.reactions[d > 0.02] == pytest.approx(np.array(expected)[d > 0.02], rel=1e-6)
    assert curve.stands_to <= fourth <= curve.falls
    assert curve.falls - curve.stands_to <= 2e-3


@pytest.mark.parametrize(
    ("top", "sinks", "aside", "closes"),
    [(0.0, 2e-3, 0.0, True), (0.0, 2e-3, 1e-3, False), (0.0, 1e-3, 0.0, False), (-1e-3, 0.0, 0.0, False)],
)
def test_a_gap_is_closed_unless_another_block_bars_it(top, sinks, aside, closes):
    """A support sinks by 2 mm, and the beam follows: unless another one, joined or not, is met 1 mm before.

    Nor on two that have moved apart: where faces do not slide they are as they were.
    """
    stones = [
        lb.Block.box("left", (0.5, 1, 0.5), (-1, 0, -0.25)),
        lb.Block.box("other", (0.5, 1, 0.5), (1, 0, top - 0.25)),
        lb.Block.box("beam", (3, 1, 0.4), (0, 0, 0.2), 20e3),
    ]
    found = lb.find_interfaces(stones, lb.PointContact(0.6))
    assert len(found) == 2 - (top == -1e-3)
    first = assembly_of(lb.Model(stones, ["left", "other"], found, lb.self_weight(), lb.self_weight()))
    ways = np.zeros((3, 6))
    ways[:2, 2], ways[1, 0] = (-2e-3, -sinks), aside
    sunk = moved(first, ways)
    control = Control("beam", read_only(np.zeros(3)), read_only(np.array([0.0, 0, -1])))
    both = [0, 1][: 1 + (sinks == 2e-3)]
    there = shut(
        Advanced(sunk, control, tuple(f"{first.contacts[k].interface.name} opens" for k in both)), both
    )
    assert (there is not None) == closes
    if there:
        assert there.assembly.model.blocks[2].vertices[:, 2].min() == pytest.approx(-2e-3, abs=1e-8)
        assert there.changes == ()


def test_two_stones_that_lean_on_one_another():
    """Thrust W x / h of the half at any spread; they slide off at their friction.

    They turn about edges that both faces share, where the normal is anywhere between those of the faces; half
    way is taken, so that friction begins at atan(mu) and half the turn of a stone.
    """
    friction, thickness = 0.5, 0.3
    ring, weight = arch(2, thickness, lb.PointContact(friction))
    inner, outer, _, centres = half_ring(2, thickness)
    arm, mass = outer[-1] - inner[0], centres[0] - inner[0]

    def turn(spread):
        return np.arccos((arm[0] + spread / 2) / np.hypot(*arm)) - np.arctan2(arm[1], arm[0])

    def thrust(spread):
        x = mass[0] * np.cos(turn(spread)) - mass[1] * np.sin(turn(spread))
        return weight / 2 * x / np.sqrt(arm @ arm - (arm[0] + spread / 2) ** 2)

    def left(spread):
        return np.arctan(friction) - turn(spread) / 2 - np.arctan(2 * thrust(spread) / weight)

    slides = brentq(left, 0.0, 2 * (np.hypot(*arm) - arm[0]) - 1e-9)
    curve = settlement_to_collapse(ring, "right support", SPREAD, step=0.3, accuracy=1e-2)
    assert curve.reactions == pytest.approx([thrust(d) for d in curve.displacements], rel=1e-6)
    assert curve.stands_to <= slides <= curve.falls
    assert curve.falls - curve.stands_to <= 1e-2


def reaction_of_a_beam(friction, settlement, corner):
    """Reaction under a beam of 5 m whose face lies on an edge at x = 0 and whose end on a flat `corner` away.

    Forces H outwards on both: friction of the end, mu R, or of the edge about the normal of the beam's face.
    """
    slope, weight = np.arctan2(settlement, corner), 5 * 0.3 * 20e3
    x = corner - 2.5 * np.cos(slope) + 0.15 * np.sin(slope)  # of the weight
    end = weight * x / (corner + friction * settlement)
    k = settlement * np.tan(np.arctan(friction) - slope)
    edge = weight * (x - k) / (corner - k)
    return max(end, edge)  # that slides whose friction is used up first


@pytest.mark.parametrize("friction", [0.5, 0.8])
def test_a_beam_slides_off_the_edge_that_it_rests_on(friction):
    """A beam of 5 m, a support sinking: its end slides, then its face on the edge for as long as it is on it.

    An edge on a face has the normal of that face: the beam's on the left, the sunk support's on the right. At
    the fall its lower corners are on that edge and on the top of the sunk support, 5 m from one another.
    """
    stones = [
        lb.Block.box("left", (1, 1, 1), (-0.5, 0, -0.5)),
        lb.Block.box("right", (1, 1, 1), (4.5, 0, -0.5)),
        lb.Block.box("beam", (5, 1, 0.3), (2.0, 0, 0.15), unit_weight=20e3),
    ]
    beam = model_of(stones, ["left", "right"], lb.PointContact(friction))
    curve = settlement_to_collapse(beam, "right", (0, 0, -1), step=0.5, accuracy=1e-2)
    lows = [point.model.blocks[2].vertices[:, [0, 2]] for point in curve.points[1:]]
    x = np.array([low[low[:, 1].argmin(), 0] for low in lows])  # of the end
    d = curve.displacements[1:]
    expected = [reaction_of_a_beam(friction, *one) for one in zip(d, x, strict=True)]
    assert curve.reactions[1:] == pytest.approx(expected, rel=1e-8)
    kept = np.isclose(x, np.sqrt(4.5**2 - d**2), rtol=1e-9)  # the end slides: the edge stays at 4.5 m
    assert kept.sum() > 2
    assert np.ptp(x[~kept]) < 1e-9  # then the edge slides: the end stays
    assert (np.diff(kept.astype(int)) <= 0).all()
    assert curve.stands_to <= np.sqrt(5.0**2 - x[-1] ** 2) <= curve.falls
    assert curve.falls - curve.stands_to <= 1e-2


@pytest.mark.parametrize("slope", [0.0, 0.15])
def test_a_ladder_whose_head_slides_down_a_wall_and_whose_foot_then_slides(slope):
    """Of the textbook: normals of the floor, or of the wedge, and of the wall. The wall moves away from it.

    Moments about the foot: N = W a / (h + mu c); the foot slides once its force is at atan(mu) to its normal.
    """
    friction, rise = 0.5, 0.3 * np.tan(slope)
    foot, head = np.array([0.3, rise]), np.array([2.0, 3.0])
    low, high = -1 * np.tan(slope), 1.9 * np.tan(slope)
    stones = [
        lb.Block.prism("floor", [(-1, -1), (1.9, -1), (1.9, high), (-1, low)], (-1, 1)),
        lb.Block.box("wall", (1, 2, 4), (2.5, 0, 2)),
        lb.Block.prism("ladder", [(0, 0), foot, (2.0, 2.7), head], (-0.5, 0.5), 20e3),
    ]
    model = model_of(stones, ["floor", "wall"], lb.PointContact(friction))
    ladder = stones[2]
    arm, mass = head - foot, ladder.centroid[[0, 2]] - foot

    def push(away):  # over the weight
        c = arm[0] + away
        h = np.sqrt(arm @ arm - c * c)
        turn = np.arctan2(arm[1], arm[0]) - np.arctan2(h, c)
        return (mass[0] * np.cos(turn) + mass[1] * np.sin(turn)) / (h + friction * c)

    def left(away):
        return np.arctan(friction) - slope - np.arctan(push(away) / (1 - friction * push(away)))

    slides = brentq(left, 0.0, 1.6)
    curve = settlement_to_collapse(model, "wall", (1, 0, 0), step=0.3, accuracy=1e-2)
    expected = [ladder.weight * push(away) for away in curve.displacements[1:]]
    assert curve.reactions[1:] == pytest.approx(expected, rel=1e-8)
    assert curve.stands_to <= slides <= curve.falls
    assert curve.falls - curve.stands_to <= 1e-2


@pytest.mark.parametrize("joint", [lb.PointContact(0.5), lb.OrdunaLourenco(0.3)], ids=["points", "planes"])
def test_a_beam_rests_on_a_support_that_slides_away_until_its_bearing_is_used_up(joint):
    """Bearing of .2 m; friction drags the support back by mu N, N from moments about where the beam bears."""
    model = beam_on({"left": (-2.0, -1.9), "right": (1.4, 1.6)}, (-2.4, 1.6), joint)
    curve = settlement_to_collapse(model, "right", SPREAD, step=0.1, accuracy=1e-3)
    weight, middle, edge = model.free_blocks[0].weight, -0.4, 1.4 + curve.displacements
    least = weight * (middle + 1.9) / (1.6 + 1.9)
    most = weight * (middle + 2.0) / (edge + 2.0)
    assert (-curve.reactions >= joint.friction * least * (1 - 1e-6)).all()
    assert (-curve.reactions <= joint.friction * most * (1 + 1e-6)).all()
    assert curve.ended.startswith("the structure falls between")
    assert 0.2 - 2e-3 < curve.stands_to < curve.falls < 0.2 + 1e-3  # a bearing of 1 mm is too narrow


def test_a_fall_of_a_long_step_that_shorter_ones_survive_is_none():
    """It took half of what was left to that fall for ever, and the fall itself came from the step."""
    model = beam_on({"left": (-0.5, 0.5), "right": (3.5, 4.5)}, (-0.5, 4.5), lb.PointContact(0.5))
    longer, shorter = (
        settlement_to_collapse(model, "right", (1, 0, -1), step=step, accuracy=accuracy)
        for step, accuracy in ((0.3, 0.1), (0.2, 0.1))
    )
    assert longer.stands_to < shorter.falls
    assert shorter.stands_to < longer.falls
    assert max(one.falls - one.stands_to for one in (longer, shorter)) <= 0.1


def test_slip_of_associated_flow_opens_the_joint_of_a_support_that_slides_away():
    model = beam_on({"left": (-0.5, 0.5), "right": (3.5, 4.5)}, (-0.5, 4.5), lb.PointContact(0.5))
    curve = settlement_to_collapse(
        model, "right", SPREAD, step=0.1, largest=0.1, accuracy=1e-2, without_dilatancy=False
    )
    assert curve.stands_to == 0.0
    assert "m is reached; beyond 0 m joints press across their gaps, as slip of associated flow" in str(curve)
    (section,) = (one for one in lb.report(model, curve).sections if one.title.startswith("Settlement"))
    assert section.quantity == "settlement up to which no joint presses across a gap"


def test_a_slack_tie_carries_nothing_until_its_ends_are_as_far_apart_again():
    """A stone that 1 kN holds back rides on a plate; a tie of it, .2 m ahead, is passed and slack to .4 m."""
    stones = [
        lb.Block.box("plate", (4.0, 1.0, 0.2), (0, 0, -0.1)),
        lb.Block.box("mast", (0.2, 1.0, 1.0), (5.0, 0, 0.5)),
        lb.Block.box("stone", (0.5, 1.0, 0.5), (0, 0, 0.25), 20e3),
    ]
    alone = model_of(stones, ["plate", "mast"], lb.PointContact(0.6))
    held_back = replace(alone, dead=alone.dead + force("stone", (-1e3, 0, 0), (0, 0, 0)))
    rod = tie("stone", (0, 0, 0.5), "mast", (0.2, 0, 1.0), area=1e-4, strength=20e6)
    way = settlement_to_collapse(
        reinforced(held_back, rod), "plate", (1, 0, 0), step=0.1, largest=0.35, without_dilatancy=False
    )
    assert way.displacements[-1] == pytest.approx(0.35)
    assert way.reactions == pytest.approx(np.full(len(way.points), -1e3), rel=1e-6)

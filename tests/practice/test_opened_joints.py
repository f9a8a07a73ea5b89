"""Opened joints: gaps and steps of faces, rims overrun by a little, pressure off closed corners."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from few_blocks import moved
from stones import model_of, shaft

import limitblocks as lb
from limitblocks.geometry.accuracy import GAP
from limitblocks.practice import capacity_curve, dowel, reinforced
from limitblocks.practice.advance import _last
from limitblocks.practice.displaced import _screw_shift, assembly_of
from limitblocks.practice.resting import face_at
from limitblocks.practice.touching import across, pressed_in
from limitblocks.practice.trimmed import trimmed

B, H, PHI = 0.2, 1.0, 0.1


def opened(gap=0.0, slide=0.0, base=1.0):
    """A block turned by PHI about its toe, 1 m long, which then slides along it; on a base across a gap."""
    stones = [
        lb.Block.box("base", (base, 1, 1), (0, 0, -0.5)),
        lb.Block.box("block", (B, 1, H), (0, 0, H / 2 + gap), 20e3),
    ]
    found = lb.find_interfaces(stones, lb.PointContact(0.6))
    model = lb.Model(stones, ["base"], found, lb.self_weight(), lb.mass_proportional((1, 0, 0)))
    toe, screw = found[0].centroid + np.array([B / 2, 0, 0]), np.zeros((2, 6))
    screw[1, 4] = PHI
    screw[1, :3] = PHI * np.cross([0, 1, 0], stones[1].centroid - toe)
    along = np.zeros((2, 6))
    along[1, 1] = slide
    return moved(moved(assembly_of(model), screw), along)


@pytest.mark.parametrize("gap", [0.0, 1e-5, 0.4 * GAP])
def test_a_joint_found_across_a_gap_rests_on_the_face(gap):
    """The toe is within the face of the base, whose normal is vertical; not half way, at PHI / 2."""
    (own,) = opened(gap).contacts
    assert own.interface.axes[2] == pytest.approx([0, 0, 1], abs=1e-12)


def test_a_step_in_a_face_is_not_part_of_it():
    """Treads of 1 m x 1 m, the upper one higher by a hundredth of the size of the block."""
    outline = [(0, 0), (2, 0), (2, 1.02), (1, 1.02), (1, 1), (0, 1)]
    block = lb.Block.prism("step", outline, (0, 1), 1.0)
    plane, up = np.eye(3)[:2], np.array([0.0, 0.0, 1.0])
    for x, z in ((0.5, 1.0), (1.5, 1.02)):
        assert face_at(block, up, np.array([x, 0.5, z]), plane).area == pytest.approx(1.0)


@pytest.mark.parametrize("slide", [1e-5, 1e-3])
def test_a_joint_over_the_rim_by_a_little_is_cut_by_as_much(slide):
    there = opened(slide=slide)
    (left,) = trimmed(there.contacts[0], there.model.blocks, there.size)
    assert np.sort(np.ptp(left.interface.polygon, axis=0))[-1] == pytest.approx(1.0 - slide, abs=1e-9)


@pytest.mark.parametrize(("off", "named"), [(0.0, 0), (3e-4, 0), (3e-3, 1)])
def test_a_centre_of_pressure_off_the_closed_corners_is_named(off, named):
    """At `off` times the half length, .5 m, from the toe, on which it should be."""
    there = opened()
    own = there.contacts[0].interface
    closed = there.contacts[0].ways[:, 2] < 1e-9
    at = own.polygon[closed].mean(axis=0)
    at = at * (1.0 - 0.5 * off / np.linalg.norm(at))
    Q = np.array([[0.0, 0.0, -1.0, -at[1], at[0], 0.0]])  # e1 = -M2 / N, e2 = M1 / N
    assert len(across(there, Q, [0])) == named


def test_what_presses_no_more_than_an_answer_is_accurate_does_not_press():
    """Answers are accurate to 1e-8 of what acts; a hundred-thousandth of the largest force is one."""
    arch = assembly_of(lb.structures.arch(lb.PointContact(0.6), radius=5.0, thickness=1.0, voussoirs=2))
    Q = np.zeros((3, 6))
    Q[:, 2] = -1.0, -1e-8, -1e-5
    assert [own.pressed for own in pressed_in(arch, [0, 1, 2], Q).contacts] == [True, False, True]


@pytest.mark.parametrize("angle", [1e-6, 5e-5, 2e-4, 1.0])
def test_a_screw_turns_and_shifts_a_point_at_any_angle(angle):
    """About Z at 2 m from the axis: 2 sin t across, -2 (1 - cos t) towards it, and the pitch along."""
    arm, pitch = np.array([2.0, 0.0, 0.0]), 0.3
    velocity = np.cross([0.0, 0.0, angle], arm)
    (shift,) = _screw_shift(np.array([[*velocity[:2], pitch, 0.0, 0.0, angle]]))
    # 1 - cos t without cancellation
    assert shift == pytest.approx([-4.0 * np.sin(angle / 2) ** 2, 2.0 * np.sin(angle), pitch], rel=1e-14)


def test_pieces_of_an_opened_joint_do_not_overlap():
    """A U on a U, a from the toe and h / 2 high: tan(atan(2 a / h) - asin(d / h)), d that of its corner."""
    outline = [(0, 0), (1, 0), (1, 0.2), (0.2, 0.2), (0.2, 0.8), (1, 0.8), (1, 1), (0, 1)]
    a, h = 1 - (0.2 * 1.0 * 0.1 + 2 * 0.8 * 0.2 * 0.6) / (0.2 + 2 * 0.8 * 0.2), 4.0
    stones = [
        lb.Block.prism("foot", outline, (-1.0, 0.0), along="z"),
        lb.Block.prism("shaft", outline, (0.0, h), 20e3, along="z"),
    ]
    found = lb.find_interfaces(stones, lb.PointContact(0.6))
    assert len(found) == 3
    model = lb.Model(stones, ["foot"], found, lb.self_weight(), lb.mass_proportional((1, 0, 0)))
    curve = capacity_curve(model, control=("shaft", (1.0, 0.0, h)), steps=3)
    factors = [np.tan(np.arctan(2 * a / h) - np.arcsin(one.displacement / h)) for one in curve.points]
    assert [one.load_factor for one in curve.points] == pytest.approx(factors, abs=1e-8)
    assert curve.zero == pytest.approx(h * np.sin(np.arctan(2 * a / h)), abs=1e-6)
    assert curve.points[1].changes == ("foot|shaft opens",)  # once, not for each piece


def test_a_joint_in_two_pieces_snaps_as_one():
    """Points are in the hull of the corners: an arch whose joints are halved across moves as the whole one.

    A piece that was pressed before the arch snapped turned about its own edge, in the middle of its joint.
    """
    model = lb.structures.arch(lb.PointContact(0.7), radius=2.0, thickness=0.5, voussoirs=5)
    halves = []
    for own in model.interfaces:
        across = np.abs(own.axes @ (0.0, 1.0, 0.0)) < 0.5  # s1 or s2, not along the depth
        for sign in (-0.5, 0.5):
            off = sign * np.abs(own.polygon).max(axis=0) * across[:2]
            polygon = np.where(across[:2], 0.5, 1.0) * own.polygon
            halves.append(replace(own, centroid=own.centroid + off @ own.axes[:2], polygon=polygon))
    whole, divided = (capacity_curve(one, steps=2) for one in (model, replace(model, interfaces=halves)))
    assert any(point.snapped for point in whole.points)
    for one, other in zip(whole.points, divided.points, strict=True):
        assert [other.displacement, other.load_factor] == pytest.approx(
            [one.displacement, one.load_factor], abs=1e-5
        )
    assert divided.zero == pytest.approx(whole.zero, abs=1e-6)


def test_what_a_pressed_piece_opens_with_is_in_its_plane_and_no_tie():
    """Two pieces open at .2 and .1 m/s, a face across them at .05 and a tie, normal to them, not at all."""
    turned = np.eye(3)[[2, 0, 1]]
    kinds = ((0.2, np.eye(3), False), (0.1, np.eye(3), False), (0.05, turned, False), (0.0, np.eye(3), True))
    speeds, axes, tied = (np.array(of) for of in zip(*kinds, strict=True))
    ends, pressed = np.array([[0, 1]] * 4), np.ones(4, dtype=bool)
    own = SimpleNamespace(ends=ends, pressed=pressed, tied=tied, axes_i=axes)
    assert _last(own, speeds).tolist() == [0.1, 0.1, 0.05, 0.0]


def test_pieces_that_slide_and_turn_stay_on_the_face_of_the_first_block():
    """Half way of a turn by .4 about the axis they drew together by 1 - cos(.2), and overlapped."""
    model = model_of(shaft(), ["ground"], lb.PointContact(0.6))
    displacements = np.zeros((2, 6))
    displacements[1] = 0.1, 0.05, 0.0, 0.0, 0.0, 0.4
    found = moved(assembly_of(model), displacements).model.interfaces
    for one, other in zip(model.interfaces, found, strict=True):
        assert other.corners == pytest.approx(one.corners, abs=1e-12)


def test_a_dowel_is_half_way_across_its_opened_joint():
    model = model_of(shaft(), ["ground"], lb.PointContact(0.6))
    pin = dowel(model.interfaces[0], model.interfaces[0].centroid, diameter=0.02, capacity=1e3)
    displacements = np.zeros((2, 6))
    displacements[1, 2] = 0.2
    there = moved(assembly_of(reinforced(model, pin)), displacements).model.interfaces[-1]
    assert there.centroid == pytest.approx(pin.interface.centroid + displacements[1, :3] / 2)


def test_displaced_blocks_keep_what_a_drawing_says_of_them():
    model = lb.structures.block(lb.PointContact(0.6), width=B, height=H)
    words = {"layer": "pier", "material": "tuff", "groups": ("a", "b"), "colour": "#c08040"}
    model = replace(model, blocks=[block.labelled(**words) for block in model.blocks])
    there = moved(assembly_of(model), np.full((len(model.blocks), 6), 1e-3)).model
    assert [block.words for block in there.blocks] == [block.words for block in model.blocks]

"""Capacity curves: closed forms at finite displacement, what moves with the blocks, negative controls."""

from dataclasses import replace

import numpy as np
import pytest
from few_blocks import sliding_block, toe_corner
from scipy.optimize import brentq
from stones import model_of

import limitblocks as lb
from limitblocks.practice import capacity_curve, reinforced, tie, touching

JOINTS = [lb.PointContact(0.6), lb.OrdunaLourenco(0.6)]
B, H = 0.2, 1.0
PUSH = lb.mass_proportional((1, 0, 0))


@pytest.mark.parametrize("joint", JOINTS, ids=["point contact", "paper"])
def test_block_that_rocks_about_its_toe(joint):
    """alpha = tan(atan(b / h) - asin(d / h)), d of the corner above the toe; zero at h sin(atan(b / h))."""
    model = lb.structures.block(joint, width=B, height=H)
    curve = capacity_curve(model, control=("block 1", toe_corner(model)), steps=3)
    expected = np.tan(np.arctan(B / H) - np.arcsin(curve.displacements / H))
    assert curve.load_factors == pytest.approx(expected, abs=1e-9)
    assert curve.zero == pytest.approx(H * np.sin(np.arctan(B / H)), rel=1e-8)
    assert curve.zero == pytest.approx(0.196116, abs=5e-7)
    assert curve.proven_to == curve.points[-1].displacement
    assert curve.points[0].load_factor == pytest.approx(lb.nonassociated(model).load_factor, rel=1e-12)
    assert all(lb.check_mcp(point.model, point.result).passed for point in curve.points)
    assert curve.points[1].changes == ("base|block 1 opens",)


@pytest.mark.parametrize("joint", JOINTS, ids=["point contact", "paper"])
def test_block_pushed_askew_rocks_about_an_edge(joint):
    """The push t off the normal of the edge: alpha cos t = tan(atan(b / h) - asin(d / (h cos t)))."""
    askew = np.radians(25)
    push = (np.cos(askew), np.sin(askew), 0)
    model = lb.structures.block(joint, width=B, height=H, depth=B, direction=push)
    curve = capacity_curve(model, control=("block 1", toe_corner(model)), steps=3)
    expected = np.tan(np.arctan(B / H) - np.arcsin(curve.displacements / H / np.cos(askew))) / np.cos(askew)
    assert curve.load_factors == pytest.approx(expected, abs=1e-9)
    assert curve.zero == pytest.approx(H * np.sin(np.arctan(B / H)) * np.cos(askew), rel=1e-6)


def test_block_whose_toe_crushes():
    """Moments about the toe, from where the stress block W/(fc d) reaches: its width lies under a gap."""
    ratio, depth, weight = 0.2, 1.0, 20e3 * B * H
    joint = lb.OrdunaLourenco(0.6, compressive_strength=weight / (B * depth * ratio))
    stones = [
        lb.Block.box("floor", (3, 3, 0.2), (0, 0, -0.1)),
        lb.Block.box("block", (B, depth, H), (0, 0, H / 2), 20e3),
    ]
    model = lb.Model(stones, ["floor"], lb.find_interfaces(stones, joint), lb.self_weight(), PUSH)
    curve = capacity_curve(model, control=("block", (B / 2, 0, H)), steps=6)
    s = curve.displacements / H
    c = np.sqrt(1 - s**2)
    expected = (B * c - H * s - ratio * B) / (B * s + H * c)
    assert curve.load_factors == pytest.approx(expected, abs=1e-8)
    phi = np.arccos(ratio * B / np.hypot(B, H)) - np.arctan2(H, B)
    assert curve.zero == pytest.approx(H * np.sin(phi), rel=1e-8)
    assert curve.proven_to == 0.0
    (said,) = curve.points[1].across
    assert float(said.split()[-2]) == pytest.approx(1e3 * ratio * B / 2 * np.tan(np.arcsin(s[1])), rel=0.01)


def test_block_that_slides_keeps_its_load_factor_until_half_of_it_is_off():
    """Sliding on a base as wide as the block and 2 m longer; no change with displacement."""
    stones = [
        lb.Block.box("base", (5, 1, 0.2), (1.0, 0, -0.1)),
        lb.Block.box("block", (1, 1, 0.3), (0, 0, 0.15), 20e3),
    ]
    model = model_of(stones, ["base"], JOINTS[0])
    curve = capacity_curve(model, largest=0.5)
    assert curve.load_factors == pytest.approx(0.6, rel=1e-9)
    assert curve.ended == "the displacement 0.5 m is reached"
    shifted = curve.points[-1].model.interfaces[0]
    assert shifted.centroid == pytest.approx([0.5, 0, 0], abs=1e-9)


def test_block_that_slides_off_its_base_tips_over_the_edge():
    """The shared area shrinks: at mu until the weight is (mu h / 2) from the edge, then over the edge."""
    h, friction = 0.3, 0.6
    stones = [
        lb.Block.box("base", (1, 1, 0.2), (0, 0, -0.1)),
        lb.Block.box("block", (1, 1, h), (0, 0, h / 2), 20e3),
    ]
    model = model_of(stones, ["base"], lb.PointContact(friction))
    curve = capacity_curve(model, steps=8, control=("block", (0, 0, h)), largest=0.48)
    tips = 0.5 - friction * h / 2
    slid = curve.displacements < tips
    assert 3 <= slid.sum() < len(slid)
    assert curve.load_factors[slid] == pytest.approx(friction, rel=1e-9)
    for point in np.array(curve.points)[slid]:
        (own,) = point.model.interfaces
        assert np.ptp(own.polygon[:, 0]) * np.ptp(own.polygon[:, 1]) == pytest.approx(1 - point.displacement)
    first = curve.points[int(slid.sum())]
    assert first.load_factor == pytest.approx((0.5 - first.displacement) / (h / 2), rel=1e-6)


def test_hinges_of_an_arch_stay_together():
    arch = lb.structures.arch(JOINTS[0], radius=5.0, thickness=1.0, voussoirs=9)
    curve = capacity_curve(arch, steps=5, largest=0.2)
    assert curve.points[0].load_factor == pytest.approx(lb.nonassociated(arch).load_factor, rel=1e-12)
    assert np.all(np.diff(curve.load_factors) < 0)
    lengths = [np.linalg.norm(np.ptp(b.vertices, axis=0)) for b in curve.points[-1].model.blocks]
    assert len(lengths) == len(arch.blocks)
    volumes = [[b.volume for b in m.blocks] for m in (arch, curve.points[-1].model)]
    assert volumes[0] == pytest.approx(volumes[1], rel=1e-12)


def test_a_model_to_scale_has_the_curve_to_scale():
    """Dimensional analysis: displacements times the scale, load factors alike; metres are no radians."""
    scale = 1 / 50
    full, small = (
        capacity_curve(
            lb.structures.arch(JOINTS[0], radius=2.5 * k, thickness=0.7 * k, voussoirs=5, depth=k), steps=4
        )
        for k in (1.0, scale)
    )
    assert small.displacements == pytest.approx(scale * full.displacements, rel=1e-6)
    assert small.load_factors == pytest.approx(full.load_factors, abs=1e-6)


@pytest.mark.parametrize("push", [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0)], ids=["along", "out"])
@pytest.mark.parametrize("joint", JOINTS, ids=["point contact", "paper"])
def test_a_facade_of_37_blocks(joint, push):
    """The first point is the answer without dilatancy, each point has its own; no gap is pressed."""
    door = [(1.2, 0.0, 0.8, 1.2)]
    facade = lb.structures.facade(joint, length=3.2, courses=5, return_length=1.6, openings=door)
    assert len(facade.free_blocks) == 37
    facade = replace(facade, live=lb.mass_proportional(push))
    curve = capacity_curve(facade, steps=3, largest=0.05)
    assert curve.points[0].load_factor == pytest.approx(lb.nonassociated(facade).load_factor, rel=1e-8)
    assert all(lb.check_mcp(point.model, point.result).passed for point in curve.points)
    assert curve.proven_to == curve.displacements[-1] == pytest.approx(0.05, rel=1e-9)
    assert curve.load_factors[-1] < 0.96 * curve.load_factors[0]
    if joint is JOINTS[0]:  # with the paper's it may rise: the load factor is not unique
        assert (np.diff(curve.load_factors) < 3e-4 * curve.load_factors[0]).all()  # it is unique to some 1e-4
        assert curve.load_factors[-1] < (1 - 0.05 / 0.6) * curve.load_factors[0]  # straight to .6 m
    assert curve.points[1].changes


@pytest.mark.parametrize("uphill", [True, False])
@pytest.mark.parametrize("times", [1.0, 20.0, 0.05])
def test_dead_loads_that_fall_are_held_by_some_of_the_live_load(uphill, times):
    """A block on a slope beta steeper than friction: pushed up tan(beta + phi), down -tan(beta - phi)."""
    slope, friction = np.radians(30), 0.2
    turn = np.array([[np.cos(slope), 0, -np.sin(slope)], [0, 1, 0], [np.sin(slope), 0, np.cos(slope)]])
    flat = sliding_block().blocks
    stones = [lb.Block(own.name, own.vertices @ turn.T, own.faces, own.unit_weight) for own in flat]
    found = lb.find_interfaces(stones, lb.PointContact(friction))
    push = lb.mass_proportional((1 if uphill else -1, 0, 0))
    model = lb.Model(stones, ["base"], found, lb.self_weight(), times * push)
    shift, held, result = touching._answered(model)
    assert (shift < 0) == uphill
    assert lb.check_mcp(held, result).passed
    expected = np.tan(slope + np.arctan(friction)) if uphill else -np.tan(slope - np.arctan(friction))
    assert (result.load_factor - shift) * times == pytest.approx(expected, rel=1e-8)


@pytest.mark.parametrize("upside_down", [False, True])
def test_default_control_of_blocks_that_slide_as_one_is_on_the_highest(upside_down):
    """Three stones slide on the ground together; which is listed first does not matter."""
    stones = [lb.Block.box(name, (1, 1, 0.2), (0, 0, 0.2 * k + 0.1), 20e3) for k, name in enumerate("abc")]
    ground = lb.Block.box("ground", (4, 1, 1), (0, 0, -0.5))
    found = [
        replace(one, joint=lb.PointContact(0.1)) if "ground" in (one.block_i, one.block_j) else one
        for one in lb.find_interfaces([ground, *stones], lb.PointContact(0.6))
    ]
    blocks = [ground, *(stones[::-1] if upside_down else stones)]
    model = lb.Model(blocks, ["ground"], found, lb.self_weight(), lb.mass_proportional((1, 0, 0)))
    curve = capacity_curve(model, steps=2, largest=0.01)
    assert curve.control.block == "c"
    assert curve.control.point[[0, 2]] == pytest.approx([0.5, 0.6], abs=1e-9)


def test_a_wall_held_at_its_top_bends_outwards():
    """Two stones between a base and a smooth floor whose lower edge holds the face of the upper one.

    The lower stone turns by a about its toe (t, 0), the upper one by b about their common edge, so that its
    face slides along the floor's edge (t, e): load factor = power of lifting the weights / of pushing them.
    """
    t, h, e, top = 0.4, 2.2, 3.7, 4.0
    stones = [
        lb.Block.box("base", (4, 1, 1), (0, 0, -0.5)),
        lb.Block.box("low", (t, 1, h), (t / 2, 0, h / 2), 18e3),
        lb.Block.box("high", (t, 1, top - h), (t / 2, 0, (top + h) / 2), 18e3),
        lb.Block.box("floor", (1, 1, top - e), (t + 0.5, 0, (top + e) / 2)),
    ]
    found = [
        replace(one, joint=lb.PointContact(0.0)) if "floor" in one.name else one
        for one in lb.find_interfaces(stones, JOINTS[0])
    ]
    wall = lb.Model(stones, ["base", "floor"], found, lb.self_weight(), PUSH)

    def centres(a):  # of both stones and their common edge, as x + i z
        edge = t + (-t + 1j * h) * np.exp(-1j * a)
        b = brentq(lambda b: ((t + 1j * e - edge) * np.exp(-1j * b)).real - t, 0.0, 1.0)
        high = edge + (t + 1j * (top - h)) / 2 * np.exp(1j * b)
        return np.array([t + (-t + 1j * h) / 2 * np.exp(-1j * a), high, edge])

    def load_factor(a):
        speed = np.array([h, top - h]) @ (centres(a + 1e-6) - centres(a - 1e-6))[:2]
        return speed.imag / speed.real

    curve = capacity_curve(wall, control=("low", (0, 0, h)), steps=4, largest=0.3)
    turns = [brentq(lambda a, d=d: centres(a)[2].real - d, 1e-6, 0.3) for d in curve.displacements[1:]]
    assert curve.load_factors[1:] == pytest.approx([load_factor(a) for a in turns], abs=1e-7)
    assert len(turns) > 3


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_control_point_is_the_middle_of_the_foremost_corners_that_tie(side):
    """A stone held at one side turns as it slides: each corner alone goes another way."""
    ground = lb.Block.box("ground", (4.0, 4.0, 0.4), (0.0, 0.0, -0.2))
    anchor = lb.Block.box("anchor", (0.2, 0.2, 0.2), (-2.0, side * 0.4, 0.5))
    stone = lb.Block.box("stone", (1.0, 1.0, 1.0), (0.0, 0.0, 0.5), 20e3)
    seat = lb.find_interfaces([ground, stone], lb.PointContact(0.2))
    free = lb.Model(
        [ground, anchor, stone], ["ground", "anchor"], seat, lb.self_weight(), lb.mass_proportional((1, 0, 0))
    )
    held = tie("stone", (-0.5, side * 0.4, 0.5), "anchor", (-1.9, side * 0.4, 0.5), area=1e-4, strength=4e7)
    curve = capacity_curve(reinforced(free, held), steps=2, largest=0.2)
    assert curve.points[0].load_factor > 0.2  # of friction alone
    assert curve.control.point == pytest.approx((0.5, 0.0, 1.0))

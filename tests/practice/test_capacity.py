"""Capacity curves: closed forms at finite displacement, what moves with the blocks, negative controls."""

from dataclasses import replace

import numpy as np
import pytest
from few_blocks import sliding_block, toe_corner
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation
from stones import model_of

import limitblocks as lb
from limitblocks.loads import added_mass
from limitblocks.practice import (
    PartialFactors,
    adequacy,
    answered,
    capacity_curve,
    dowel,
    reinforced,
    strip,
    tie,
)

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


def test_mass_and_tie_move_with_the_block():
    """A mass on the block and an inclined tie: moments about the toe at finite rotation."""
    model = lb.structures.block(JOINTS[0], width=B, height=H)
    weight = model.free_blocks[0].weight
    heap = added_mass("block 1", (B / 2, 0, 1.2), weight=weight / 2)
    model = lb.Model(
        model.blocks, model.supports, model.interfaces,
        lb.self_weight([heap]), lb.mass_proportional((1, 0, 0), [heap]),
    )  # fmt: skip
    anchor, pull = np.array([-3.0, 0, 0.0]), 0.05 * weight
    held = reinforced(
        model, tie("block 1", (0, 0, H), "base", anchor, area=1e-4, strength=1e9, pull_out=pull)
    )
    curve = capacity_curve(held, control=("block 1", toe_corner(model)), steps=3, largest=0.1)
    for point in curve.points:
        turn = np.arcsin(point.displacement / H)
        cosine, sine = np.cos(turn), np.sin(turn)

        def at(x, z, cosine=cosine, sine=sine):  # from the toe
            return np.array([x * cosine + z * sine, -x * sine + z * cosine])

        own, top, hook = at(-B / 2, H / 2), at(-B / 2, 1.2), at(-B, H)
        along = np.array([anchor[0] - B, 0.0]) - hook
        along /= np.linalg.norm(along)
        moment = hook[1] * along[0] - hook[0] * along[1]  # clockwise
        stabilising = -weight * own[0] - weight / 2 * top[0] - pull * moment
        overturning = weight * own[1] + weight / 2 * top[1]
        assert point.load_factor == pytest.approx(stabilising / overturning, rel=1e-7)


def test_hinges_of_an_arch_stay_together():
    arch = lb.structures.arch(JOINTS[0], radius=5.0, thickness=1.0, voussoirs=9)
    curve = capacity_curve(arch, steps=5, largest=0.2)
    assert curve.points[0].load_factor == pytest.approx(lb.nonassociated(arch).load_factor, rel=1e-12)
    assert np.all(np.diff(curve.load_factors) < 0)
    lengths = [np.linalg.norm(np.ptp(b.vertices, axis=0)) for b in curve.points[-1].model.blocks]
    assert len(lengths) == len(arch.blocks)
    volumes = [[b.volume for b in m.blocks] for m in (arch, curve.points[-1].model)]
    assert volumes[0] == pytest.approx(volumes[1], rel=1e-12)


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


def test_a_tie_that_yields_on_the_way_to_zero():
    """The load factor falls ever faster, and the secant steps beyond its zero: few points all the same."""
    model = lb.structures.block(JOINTS[0], width=B, height=H)
    pull = 0.05 * model.free_blocks[0].weight
    rod = tie("block 1", (0, 0, H), "base", (-0.4, 0, H), area=1e-4, strength=1e9, pull_out=pull)
    curve = capacity_curve(reinforced(model, rod), control=("block 1", toe_corner(model)), steps=4)
    assert curve.zero is not None
    assert len(curve.points) < 12

    def moment(turn):  # of weight and tie about the toe, per weight
        at = np.array([-B * np.cos(turn) + H * np.sin(turn), B * np.sin(turn) + H * np.cos(turn)])
        way = np.array([-0.4 - B, H]) - at
        own = B / 2 * np.cos(turn) - H / 2 * np.sin(turn)
        return own - 0.05 * (at[1] * way[0] - at[0] * way[1]) / np.linalg.norm(way)

    turn = brentq(moment, 0.01, 1.0, xtol=1e-14)
    assert curve.zero == pytest.approx(H * np.sin(turn), rel=1e-7)


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
    shift, held, result = answered._answered(model)
    assert (shift < 0) == uphill
    assert lb.check_mcp(held, result).passed
    expected = np.tan(slope + np.arctan(friction)) if uphill else -np.tan(slope - np.arctan(friction))
    assert (result.load_factor - shift) * times == pytest.approx(expected, rel=1e-8)


@pytest.mark.parametrize(("away", "gamma"), [(1.0, 1.0), (9.0, 1.0), (9.0, 1.2)])
def test_prestress_stays_on_the_line_of_its_tie(away, gamma):
    """A tie that yields pulls with its strength whatever of it is prestress: moments about the toe."""
    model = lb.structures.block(JOINTS[0], width=B, height=H)
    block, toe = model.free_blocks[0], toe_corner(model) - [0, 0, H]
    head, foot = toe + np.array([[-B, 0, 0.8 * H], [-B - away, 0, 0.8 * H]])
    most = 0.1 * block.weight
    rod = tie("block 1", head, "base", foot, area=1e-4, strength=most / 1e-4, prestress=most / 2)
    factors = PartialFactors(gamma_G=gamma, gamma_Q=1.0, gamma_M=1.0, gamma_S=1.0)
    design = adequacy(reinforced(model, rod), factors, without_dilatancy=False).model
    curve = capacity_curve(design, control=("block 1", toe_corner(model)), steps=3)
    turned = np.arcsin(curve.displacements / H)
    middle, anchor = (
        toe
        + np.stack(
            [x * np.cos(turned) + z * np.sin(turned), 0 * turned, z * np.cos(turned) - x * np.sin(turned)], 1
        )
        for x, z in ((-B / 2, H / 2), (-B, 0.8 * H))
    )
    along = (foot - anchor) / np.linalg.norm(foot - anchor, axis=1, keepdims=True)
    arms = anchor - toe
    held = (
        most * (arms[:, 0] * along[:, 2] - arms[:, 2] * along[:, 0])
        + gamma * block.weight * (toe - middle)[:, 0]
    )
    assert curve.load_factors == pytest.approx(held / (block.weight * (middle - toe)[:, 2]), abs=1e-9)


@pytest.mark.parametrize(
    ("anchors", "feet"),
    [
        ([(-B, 0, 0.8 * H), (-B, 0, 0.4 * H)], [(-B - 9, 0, 0.4 * H), (-B - 9, 0, 0.8 * H)]),
        ([(-B / 2, 0, 0.8 * H), (-B, 0, 0.8 * H)], [(-1.5 * B - 1, 0, 0.8 * H), (-B - 1, 0, 0.8 * H)]),
    ],
    ids=["cross", "one in the other"],
)
def test_prestress_of_ties_that_share_their_middles_stays_on_their_lines(anchors, feet):
    """Each of two rods pulls with its strength along its own line: moments about the toe."""
    model = lb.structures.block(JOINTS[0], width=B, height=H)
    block, toe = model.free_blocks[0], toe_corner(model) - [0, 0, H]
    most, anchors, feet = 0.1 * block.weight, np.array(anchors), np.array(feet)
    rods = [
        tie("block 1", head, "base", foot, area=1e-4, strength=most / 1e-4, prestress=share * most)
        for head, foot, share in zip(toe + anchors, toe + feet, (0.5, 0.3), strict=True)
    ]
    curve = capacity_curve(reinforced(model, *rods), control=("block 1", toe_corner(model)), steps=3)
    for turned, found in zip(np.arcsin(curve.displacements / H), curve.load_factors, strict=True):
        turn = Rotation.from_rotvec([0, turned, 0])
        middle, arms = turn.apply([-B / 2, 0, H / 2]), turn.apply(anchors)
        along = (feet - arms) / np.linalg.norm(feet - arms, axis=1)[:, None]
        held = -most * np.cross(arms, along)[:, 1].sum() - block.weight * middle[0]
        assert found == pytest.approx(held / (block.weight * middle[2]), abs=1e-9)


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


@pytest.mark.parametrize(("across", "at", "arm"), [(0, -0.5, 0.0), (1, B / 2, 0.0), (1, -B / 2, B)])
def test_a_strip_stays_on_its_joint(across, at, arm):
    """F arm cos(phi / 2) about the toe, along the chord of its opening; none where the joint stays closed."""
    stones = [
        lb.Block.box("floor", (3, 3, 0.2), (0, 0, -0.1)),
        lb.Block.box("plinth", (1.0, 1, 0.2), (0, 0, 0.1), 20e3),
        lb.Block.box("block", (B, 1, H), (0, 0, 0.2 + H / 2), 20e3),
    ]
    found = lb.find_interfaces(stones, lb.PointContact(0.6))
    model = lb.Model(stones, ["floor"], found, lb.self_weight(), PUSH)
    weight, force = 20e3 * B * H, 500.0
    band = strip(found[across], (at, 0, 0.2 * across), width=0.1, capacity=force)
    curve = capacity_curve(reinforced(model, band), control=("block", (B / 2, 0, 0.2 + H)), steps=2)
    phi = np.arcsin(curve.displacements / H)
    lever = (H * np.cos(phi) + B * np.sin(phi)) / 2  # of the push about the toe
    held = force * arm * np.cos(phi / 2) / (weight * lever)
    assert curve.load_factors == pytest.approx(np.tan(np.arctan(B / H) - phi) + held, abs=1e-9)
    assert curve.zero is not None


@pytest.mark.parametrize("order", [1, -1])
def test_a_dowel_shears_off_as_its_joint_slides(order):
    """alpha = mu + F / W before, mu from then on."""
    model = lb.structures.block(lb.PointContact(0.2), width=1.0, height=0.4)
    pin = dowel(model.interfaces[0], model.interfaces[0].centroid, diameter=0.05, capacity=800.0)
    held = reinforced(model, pin)
    curve = capacity_curve(replace(held, interfaces=held.interfaces[::order]), steps=2, largest=0.05)
    assert curve.load_factors == pytest.approx([0.3] + [0.2] * (len(curve.points) - 1), rel=1e-6)
    assert curve.points[1].changes == (f"{pin.interface.name} shears off",)
    assert [own.joint for own in curve.points[-1].model.interfaces] == [lb.PointContact(0.2)]


@pytest.mark.parametrize(("at", "friction"), [(B / 2 - 0.02, 0.8), (B / 2, 0.1)])
def test_a_dowel_at_the_edge_about_which_its_joint_turns_keeps_nothing_from_closing(at, friction):
    """alpha = tan(atan(b / h) - phi): half of it lies beyond the edge; on the edge it goes on holding."""
    model = lb.structures.block(lb.PointContact(friction), width=B, height=H)
    joint, stone = model.interfaces[0], model.free_blocks[0]
    pin = dowel(joint, joint.centroid + np.array([at, 0, 0]), diameter=0.05, capacity=20e3 * B * H)
    top = stone.vertices.max(axis=0)
    curve = capacity_curve(
        reinforced(model, pin), control=(stone.name, (top[0], stone.centroid[1], top[2])), steps=2
    )
    phi = np.arcsin(np.minimum(curve.displacements / H, 1.0))
    assert curve.load_factors == pytest.approx(np.tan(np.arctan(B / H) - phi), abs=1e-9)
    assert len(curve.points) > 3
    assert (f"{pin.interface.name} opens" in curve.points[1].changes) == (at < B / 2)


def test_a_strip_across_a_joint_that_slides_does_not_bridge_the_way():
    """Normal to its joint it leaves mu to mu (1 + F / W), however far; along the way it would add F / W."""
    model = lb.structures.block(lb.PointContact(0.2), width=1.0, height=0.4)
    band = strip(model.interfaces[0], model.interfaces[0].centroid, width=0.1, capacity=2e3)
    found = capacity_curve(reinforced(model, band), steps=2, largest=0.05).load_factors
    assert ((found > 0.2 - 1e-9) & (found < 0.2 * (1 + 2e3 / 8e3) + 1e-9)).all()

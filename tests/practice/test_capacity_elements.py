"""Capacity curves of structures with ties, strips, dowels and added masses."""

from dataclasses import replace

import numpy as np
import pytest
from few_blocks import toe_corner
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

import limitblocks as lb
from limitblocks.loads import added_mass
from limitblocks.practice import PartialFactors, adequacy, capacity_curve, dowel, reinforced, strip, tie
from limitblocks.practice.carried_loads import carried_load

JOINTS = [lb.PointContact(0.6), lb.OrdunaLourenco(0.6)]


B, H = 0.2, 1.0


PUSH = lb.mass_proportional((1, 0, 0))


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


def test_a_force_at_the_middle_of_a_tie_is_no_prestress_unless_it_is_along_it():
    """Half a prestress, twice, turns with its tie, as a whole one; a force across keeps its direction."""
    before = lb.loads.force("wall", (1e3, 0, 0), (0, 0, 1))
    after = lb.loads.force("wall", (800, 600, 0), (0, 1, 1))
    across = lb.loads.force("wall", (300, 0, -400), (0, 0, 1))
    pulls = [(before.terms[0][1], after.terms[0][1])]
    load = 2.0 * lb.loads.force("wall", (500, 0, 0), (0, 0, 1)) + 3.0 * across + before
    moved = carried_load(load, lambda _, at: np.add(at, (0.1, 0, 0)), pulls)
    assert moved == after + 3.0 * lb.loads.force("wall", (300, 0, -400), (0.1, 0, 1)) + after

"""Contacts of a displaced structure: corners and faces that slide, open, close, and where they press."""

from dataclasses import replace

import numpy as np
import pytest
from few_blocks import moved, sliding_block, toe_corner
from stones import model_of

import limitblocks as lb
from limitblocks.arrays import read_only
from limitblocks.errors import NoEquilibrium
from limitblocks.practice import CapacityCurve, CapacityPoint, Control, capacity, capacity_curve, touching
from limitblocks.practice.advance import advanced, moved_until_contact
from limitblocks.practice.displaced import assembly_of
from limitblocks.practice.rejoined import closed_up
from limitblocks.practice.rejoined import slid as slid_on
from limitblocks.practice.touching import across, narrowed

JOINTS = [lb.PointContact(0.6), lb.OrdunaLourenco(0.6)]
B, H = 0.2, 1.0


def test_a_block_that_slides_goes_over_the_edge_and_no_farther():
    """At friction mu until its centre is mu h / 2 from the edge, then it rocks from where it slid to.

    One of few steps turned it over, back past its control point: it had its zero at infinity.
    """
    curve = capacity_curve(sliding_block(), steps=3)
    slid = curve.displacements < 0.5 - 0.1 * 0.15
    assert slid.sum() > 2
    assert curve.load_factors[slid] == pytest.approx(0.1, rel=1e-9)
    assert np.diff(curve.displacements).max() < 1.2 / 3
    assert curve.load_factors[~slid].max() < 0.1
    start = curve.displacements[~slid][0]
    turns = np.arctan((0.5 - start) / 0.15)  # about the edge of the base, until the centre is above it
    exact = start * np.cos(turns) + 0.3 * np.sin(turns)  # of the upper corner, that far and 0.3 off the edge
    assert curve.zero == pytest.approx(exact, abs=2e-6)


def test_a_block_beyond_the_edge_loses_its_contact():
    """It falls where it has no other; where it has one it is held by that."""
    way = np.zeros((3, 6))
    way[2, 0] = 1.5
    alone, held = sliding_block(), beside_a_wall()
    with pytest.raises(lb.SolveError, match=r"lost all that they rest on: .*'block'"):
        slid_on(moved(assembly_of(alone), way[1:]), [True])
    there, said = slid_on(moved(assembly_of(held), way), [True, True])
    assert said == ("base|block slides off",)
    assert (
        [own.interface.name for own in there.contacts]
        == ["wall|block"]
        == [own.name for own in there.model.interfaces]
    )


def beside_a_wall():
    """The flat block beside a long wall that it slides along."""
    base, block = sliding_block().blocks
    wall = lb.Block.box("wall", (5, 1, 1), (0, 1, 0.5))
    return model_of([base, wall, block], ["base", "wall"], lb.PointContact(0.1))


def test_a_block_that_slides_onto_another_rests_on_both():
    """Two bases of 1 m side by side, the second 1 mm lower or not: it bears, or does not touch."""
    for step, words in ((0.0, ("other|block touches",)), (1e-3, ())):
        stones = [
            lb.Block.box("base", (1, 1, 0.2), (0, 0, -0.1)),
            lb.Block.box("other", (1, 1, 0.2), (1, 0, -0.1 - step)),
            lb.Block.box("block", (1, 1, 0.3), (0, 0, 0.15), 20e3),
        ]
        model = lb.Model(
            stones, ["base", "other"], lb.find_interfaces([stones[0], stones[2]], lb.PointContact(0.1)),
            lb.self_weight(), lb.mass_proportional((1, 0, 0)),
        )  # fmt: skip
        way = np.zeros((3, 6))
        way[2, 0] = 0.3
        there, said = slid_on(moved(assembly_of(model), way), [True])
        areas = [np.ptp(own.interface.polygon, axis=0).prod() for own in there.contacts]
        assert said == words
        assert areas == pytest.approx([0.7, 0.3][: 1 + len(words)])


def test_a_block_slides_on_supports_that_touch():
    """What they share carries nothing, and no model has it: an IndexError, once a block slid on one."""
    stones = [
        lb.Block.box("floor", (6, 6, 1), (0, 0, -0.5)),
        lb.Block.box("low", (2, 2, 1), (0, 0, 0.5)),
        lb.Block.box("high", (2, 2, 1), (0, 0, 1.5), 20e3),
    ]
    curve = capacity_curve(model_of(stones, ["floor", "low"], lb.PointContact(0.3)), steps=3, largest=0.5)
    assert [point.load_factor for point in curve.points] == pytest.approx([0.3] * len(curve.points), abs=1e-6)
    assert not any(point.changes for point in curve.points)


def test_a_contact_in_two_parts_keeps_two_as_it_slides():
    """A table on two feet of 1 m x 1 m: each keeps its own area, and none counts twice."""
    outline = [(0, 0), (1, 0), (1, 1), (2, 1), (2, 0), (3, 0), (3, 2), (0, 2)]
    table = lb.Block.prism("table", outline, (0, 1), 20e3)
    stones = [lb.Block.box("base", (9, 3, 1), (1.5, 0.5, -0.5)), table]
    model = model_of(stones, ["base"], JOINTS[0])
    there, _ = slid_on(moved(assembly_of(model), np.array([[0.0] * 6, [0.5, 0, 0, 0, 0, 0]])), [True, True])
    centres = sorted(own.interface.centroid[0] for own in there.contacts)
    assert centres == pytest.approx([1.0, 3.0])


def test_a_corner_rests_on_the_face_off_which_it_is_farther():
    """A block turned by phi about its edge then slides by s: inwards its corner is on the ground, outwards
    the edge of the ground is on its face, s tan(phi) above that corner."""
    model = lb.structures.block(JOINTS[0], width=B, height=H)
    phi, s = 0.1, 0.03
    edge = model.interfaces[0].centroid[0] + B / 2
    for slide, level in ((-s, 0.0), (s, -s * np.tan(phi))):
        about = np.array([edge, 0.0, model.interfaces[0].centroid[2]])
        rates = np.zeros((len(model.blocks), 6))
        k = model.blocks.index(model.free_blocks[0])
        turn = np.array([[np.cos(phi), 0, np.sin(phi)], [0, 1, 0], [-np.sin(phi), 0, np.cos(phi)]])
        arm = model.blocks[k].centroid - about
        rates[k, 4] = phi
        start = moved(assembly_of(model), rates)
        off = about + np.array([slide, 0, level]) - (start.model.blocks[k].centroid + turn @ -arm)
        shift = np.zeros_like(rates)
        shift[k, :3] = off
        there = moved(start, shift).contacts[0]
        assert np.sort(np.abs(there.ways[:, 2]))[:2] == pytest.approx([0.0, 0.0], abs=1e-12)
        assert there.on_face_i.all() == (slide < 0)


@pytest.mark.parametrize("slide", [-0.03, 0.03])
def test_a_corner_inside_a_face_rests_on_that_face_whichever_way_it_slides(slide):
    """A block turned by .1 about its edge on a base that goes on beyond it, both 1 m deep: it stays level."""
    stones = [
        lb.Block.box("base", (3, 1, 1), (0, 0, -0.5)),
        lb.Block.box("block", (B, 1, H), (0, 0, H / 2), 20e3),
    ]
    model = model_of(stones, ["base"], JOINTS[0])
    there = moved(turned_about_its_toe(model, 0.1), np.array([[0.0] * 6, [slide, 0, 0, 0, 0, 0]]))
    assert np.sort(np.abs(there.contacts[0].ways[:, 2]))[:2] == pytest.approx([0.0, 0.0], abs=1e-12)


@pytest.mark.parametrize(
    ("slide", "rests_on"),
    [(-0.03, "base"), (0.03, "block"), (-4e-4, None), (4e-4, None), (-6e-4, "base"), (6e-4, "block")],
)
def test_an_opened_joint_has_the_normal_of_the_face_that_it_rests_on(slide, rests_on):
    """A block turned by phi about the common edge, then slid: by less than a thousandth of half the joint,
    .5 m, edges meet, the normal half way; inwards its edge is on the base, outwards its face on the rim."""
    model = lb.structures.block(JOINTS[0], width=B, height=H)
    phi = 0.1
    there = slid_on(moved(turned_about_its_toe(model, phi), sliding_at(phi, slide)), [True])[0]
    angle = {"base": 0.0, "block": phi, None: phi / 2}[rests_on]
    (own,) = there.contacts
    assert own.interface.axes[2] == pytest.approx([np.sin(angle), 0, np.cos(angle)], abs=1e-12)
    closed = own.interface.polygon[own.ways[:, 2] < 1e-9]
    corners = own.interface.centroid + closed @ own.interface.axes[:2]
    assert np.abs(corners - own.rest[own.ways[:, 2] < 1e-9]).max() < 1e-12


def turned_about_its_toe(model, phi):
    k = model.blocks.index(model.free_blocks[0])
    toe, rates = model.interfaces[0].centroid + np.array([B / 2, 0, 0]), np.zeros((len(model.blocks), 6))
    rates[k, 4] = phi
    rates[k, :3] = phi * np.cross([0, 1, 0], model.blocks[k].centroid - toe)  # a screw about the toe
    return moved(assembly_of(model), rates)


def sliding_at(phi, slide):
    """Of the base and the block: inwards its edge along the base, outwards its face along the rim."""
    way = np.zeros((2, 6))
    way[1, [0, 2]] = slide, -slide * np.tan(phi) * (slide > 0)
    return way


@pytest.mark.parametrize("across_by", [0.0, 0.4, 0.6])
def test_an_opened_joint_partly_off_keeps_what_both_faces_share(across_by):
    """A block on its toe slides along that edge of 1 m: it rocks at tan(atan(b / h) - phi) as long as its
    middle is above the edge that is left, and falls beside it beyond."""
    stones = [
        lb.Block.box("base", (1, 1, 0.2), (0, 0, -0.1)),
        lb.Block.box("block", (B, 1, H), (0, 0, H / 2), 20e3),
    ]
    model = model_of(stones, ["base"], JOINTS[0])
    way = np.zeros((2, 6))
    way[1, 1] = across_by
    there, said = slid_on(moved(turned_about_its_toe(model, phi := 0.1), way), [True])
    assert said == ()
    (own,) = there.contacts
    assert np.sort(np.ptp(own.interface.polygon, axis=0)) == pytest.approx(
        sorted([B, 1 - across_by]), rel=1e-9
    )
    assert np.abs(own.ways[own.ways[:, 2] < 1e-9]).max() < 1e-12
    ends = own.rest[own.ways[:, 2] < 1e-9][:, 1]
    assert np.sort(ends) == pytest.approx([across_by - 0.5, 0.5], abs=1e-12)
    if across_by > 0.5:
        with pytest.raises(NoEquilibrium):
            touching._answered(there.model)
    else:
        shift, _, result = touching._answered(there.model)
        assert result.load_factor - shift == pytest.approx(np.tan(np.arctan(B / H) - phi), rel=1e-8)


def test_what_opens_at_second_order_opens():
    """A column tilts by phi about its toe; beside it, off a step of its height h, the stone on it slides out
    and is h (1 - cos(phi)) off its edge: of the first order it only slides."""
    stones = [
        lb.Block.box("ground", (4, 4, 0.2), (0, 0, -0.1)),
        lb.Block.box("step", (1, 1, 0.4), (-0.5, -0.5, 0.2), 1.0),
        lb.Block.box("column", (1, 1, 0.4), (-0.5, 0.5, 0.2), 1.0),
        lb.Block.box("top", (1, 2, 0.4), (-0.5, 0, 0.6), 1.0),
    ]
    model = model_of(stones, ["ground"], JOINTS[0])
    phi, rates = 0.01, np.zeros((4, 6))
    for k in (2, 3):
        rates[k] = *np.cross((0, 1, 0), stones[k].centroid), 0, 1, 0
    there, changes = moved_until_contact(assembly_of(model), phi * rates)
    assert "step|top opens" in changes
    gap = next(own for own in there.contacts if own.interface.name == "step|top").ways[:, 2].min()
    assert gap == pytest.approx(0.4 * (1 - np.cos(phi)), rel=1e-6)
    moves = there.model.blocks[2].vertices - stones[2].vertices
    assert np.abs(moves).max() == pytest.approx(phi, rel=1e-2)  # it did not go back


def test_a_joint_narrowed_to_its_closed_corners():
    """A block turned about its edge keeps a strip of a hundredth of the half width there."""
    model = lb.structures.block(JOINTS[0], width=B, height=H)
    rates = lb.nonassociated(model).displacement_rates
    there = moved_until_contact(assembly_of(model), 0.01 * rates / np.abs(rates).max())[0]
    own, strip = there.contacts[0], narrowed(there.contacts[0], there.size)
    shut = own.ways[:, 2] < 1e-9
    width, depth = np.sort(np.ptp(strip.polygon, axis=0))
    assert (width, depth) == pytest.approx((0.01 * np.abs(own.interface.polygon).max(), 1.0), rel=1e-9)
    for corner in own.on_j[shut]:
        assert np.linalg.norm(strip.corners - corner, axis=1).min() < 1e-12
    assert abs(strip.polygon.mean(axis=0)).max() < 1e-12
    assert abs(strip.polygon[0] - strip.polygon[-1])[1] < 1e-12  # its longest side lies along the first axis


def test_gap_left_by_a_coarse_step_is_seen_and_closed():
    """Negative control: first-order motion opens or overlaps the corners that it holds; closing mends it."""
    arch = lb.structures.arch(JOINTS[0], radius=5.0, thickness=1.0, voussoirs=9)
    rates = lb.nonassociated(arch).displacement_rates
    step = rates * 0.1 / np.abs(rates[:, :3]).max()
    there = moved(assembly_of(arch), step)
    held = np.abs(there.contacts.ways[:, 2]) < 0.01
    assert np.abs(there.contacts.ways[held]).max() > 1e-4
    _, left = closed_up(there, held, np.zeros(len(there.contacts), dtype=bool))
    assert left < 1e-12


def test_a_gap_that_closes_is_not_stepped_over():
    """A block turned by hand, then moved back by more than its gap: the step ends at the gap."""
    model = lb.structures.block(JOINTS[0], width=B, height=H)
    result = lb.nonassociated(model)
    forth = result.displacement_rates * 0.01 / np.abs(result.displacement_rates).max()
    leaning = moved(assembly_of(model), forth)
    back = replace(result, displacement_rates=-forth)
    corner, along = toe_corner(leaning.model), read_only(np.array([-1.0, 0, 0]))
    control, point = Control("block 1", corner, along), CapacityPoint(0.0, 0.2, 0.0, leaning.model, back, ())
    goal, _, found = capacity._advanced(leaning, control, point, 1.5 * 0.01)
    assert 0.0 < found.displacement < 0.0101
    assert goal.contacts[0].ways[:, 2].min() > -1e-7


def test_a_joint_that_presses_across_its_gap_is_named():
    """Beyond where the hinges of an arch move, opened joints of its first mechanism are pressed."""
    arch = lb.structures.arch(JOINTS[0], radius=5.0, thickness=1.0, voussoirs=12)
    result = lb.nonassociated(arch)
    control = capacity._control(arch, result, None)
    there = advanced(assembly_of(arch), control, result.displacement_rates, 0.45)
    pressed = across(
        there.assembly, lb.nonassociated(there.assembly.model).stress_resultants, list(range(13))
    )
    pressed = tuple(pressed.values())
    assert "presses across a gap of" in pressed[0]
    points = [CapacityPoint(d, 0.2, 0.0, arch, result, (), words) for d, words in ((0.0, ()), (0.1, pressed))]
    curve = CapacityCurve(tuple(points), control, None, "")
    assert curve.proven_to == 0.0
    assert "joints press across their gaps" in str(curve)


@pytest.mark.parametrize("slide", [-0.03, 0.03])
def test_corners_that_slid_coincide(slide):
    """A block that tilts about its toe while it slides: the next step starts from corners that meet."""
    model = lb.structures.block(JOINTS[0], width=B, height=H)
    rates = lb.nonassociated(model).displacement_rates
    k = model.blocks.index(model.free_blocks[0])
    way = 0.1 / rates[k, 4] * rates
    way[k, 0] += slide
    own = moved_until_contact(assembly_of(model), way)[0].contacts[0]
    shut = own.ways[:, 2] < 1e-9
    assert shut.sum() == 2
    assert np.abs(own.ways[shut]).max() < 1e-12


def test_the_contacts_that_an_answer_presses_are_marked():
    model = lb.structures.arch(JOINTS[0], radius=5.0, thickness=1.0, voussoirs=3)
    assembly = assembly_of(model)
    assert not any(own.pressed for own in assembly.contacts)
    assert all(own.pressed for own in touching.answered(assembly)[0].contacts)


@pytest.mark.parametrize("floor_first", [True, False])
@pytest.mark.parametrize("turn", [0.002, 0.01, 0.05])
def test_a_corner_at_the_end_of_a_floor_that_goes_on_ahead_rests_on_it(turn, floor_first):
    """A block of depth b flush with the end of a floor turns about an axis at 45 degrees through its toe.

    The corner at the flush end is b (1 - cos turn) / 2 in the floor, as on one that goes on there.
    """
    b = 0.4
    block = lb.Block.box("block", (b, b, H), (-b / 2, b / 2, H / 2), 20e3)
    axis = np.array([0.0, 1.0, -1.0]) / np.sqrt(2.0)
    for beyond in (0.0, 0.3):
        floor = lb.Block.box("floor", (3, b + beyond, 1), (0, (b + beyond) / 2, -0.5))
        stones = [floor, block] if floor_first else [block, floor]
        found = lb.find_interfaces(stones, JOINTS[0])
        assert found[0].block_i == stones[0].name
        model = lb.Model(stones, ["floor"], found, lb.self_weight(), lb.mass_proportional((1, 0, 0)))
        rates = np.zeros((2, 6))
        rates[stones.index(block)] = [*np.cross(turn * axis, block.centroid), *(turn * axis)]
        own = moved(assembly_of(model), rates).contacts[0]
        on_floor = own.on_i if floor_first else own.on_j
        corner = np.flatnonzero(np.abs(on_floor - [0.0, b, 0.0]).max(axis=1) < 1e-12)
        sunk = -b / 2 * (1.0 - np.cos(turn))
        assert own.ways[corner, 2] == pytest.approx(sunk, rel=1e-9)

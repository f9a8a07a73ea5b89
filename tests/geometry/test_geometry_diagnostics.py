"""What contact detection reports beside the interfaces, and real walls: noise, units, far from the origin."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
from bodies import moved, triangulated
from scipy.spatial.transform import Rotation
from stones import portal_stones

import limitblocks as lb
from limitblocks.analysis.diagnosis import astray
from limitblocks.geometry import Block, find_contacts, find_interfaces, polygon

box = Block.box
UNIT = (1.0, 1.0, 1.0)


def wall(courses=4, length=4, x=0.2, y=0.1, z=0.1):
    return [
        box(f"{k}/{m}", (x, y, z), ((m + 0.5 * (k % 2)) * x, 0, k * z), 20e3)
        for k in range(courses)
        for m in range(length)
    ]


def ends(items):
    return {(one.block_i, one.block_j) for one in items}


def turned(blocks, tilt):
    """The last block turned by `tilt` about the edge at X = 0.5 of its bottom, at Z = 0.5."""
    c, s = np.cos(tilt), np.sin(tilt)
    turn, edge = np.array([(c, 0, s), (0, 1, 0), (-s, 0, c)]), np.array([0.5, 0, 0.5])
    return [*blocks[:-1], blocks[-1].moved(turn, edge - turn @ edge)]


def test_sound_wall_has_nothing_to_report():
    contacts = find_contacts(wall(), None)
    assert len(contacts.interfaces) == len(find_interfaces(wall(), None))
    assert (contacts.near_misses, contacts.overlaps, contacts.isolated, contacts.slivers) == ((), (), (), ())
    assert contacts.warnings == []


@pytest.mark.parametrize(("gap", "near"), [(0.9e-3, 0), (1.1e-3, 1), (9.9e-3, 1), (10.1e-3, 0)])
def test_gaps_beyond_the_tolerance(gap, near):
    contacts = find_contacts([box("low", UNIT, (0, 0, 0)), box("high", UNIT, (0.25, 0, 1 + gap))], None)
    assert len(contacts.near_misses) == near
    for miss in contacts.near_misses:
        assert (miss.block_i, miss.block_j) == ("low", "high")
        assert (miss.gap, miss.angle, miss.area) == pytest.approx((gap, 0, 0.75), abs=1e-9)
        assert contacts.isolated == ("low", "high")
        assert contacts.warnings[0] == f"no interface between blocks that nearly touch: {miss}"
        assert f"gap {gap:.3g} m" in str(miss)


@pytest.mark.parametrize(("tilt", "near"), [(0.9e-3, 0), (5e-3, 1), (9.9e-3, 1), (10.2e-3, 0)])
def test_gap_is_the_largest_over_the_area(tilt, near):
    # a wedge that is closed at one edge and open by sin(tilt) at the other: within the angle, not the gap
    blocks = turned([box("low", UNIT, (0, 0, 0)), box("high", UNIT, (0, 0, 1))], tilt)
    contacts = find_contacts(blocks, None)
    assert len(contacts.interfaces) == (tilt < 1e-3)
    assert len(contacts.near_misses) == near
    for miss in contacts.near_misses:
        assert miss.gap == pytest.approx(2 * np.tan(tilt / 2) * np.cos(tilt / 2), rel=1e-2)
        assert miss.angle == pytest.approx(tilt)


@pytest.mark.parametrize(("tilt", "near"), [(0.9e-2, 0), (2e-2, 1), (9.9e-2, 1), (10.1e-2, 0)])
def test_angles_beyond_the_tolerance(tilt, near):
    blocks = turned([box("low", UNIT, (0, 0, 0)), box("high", UNIT, (0, 0, 1))], tilt)
    contacts = find_contacts(blocks, None, gap=0.2)
    assert len(contacts.interfaces) == (tilt < 1e-2)
    assert [miss.angle for miss in contacts.near_misses] == pytest.approx([tilt] * near)


def test_overlaps_are_listed_and_are_no_near_misses():
    blocks = [box("low", UNIT, (0, 0, 0)), box("high", UNIT, (0, 0, 1 - 5e-3)), box("far", UNIT, (9, 9, 9))]
    contacts = find_contacts(blocks, None)
    (overlap,) = contacts.overlaps
    assert (overlap.block_i, overlap.block_j) == ("low", "high")
    assert (overlap.depth, overlap.volume, overlap.tolerance) == pytest.approx((5e-3, 5e-3, 1e-3))
    assert contacts.near_misses == ()
    assert contacts.isolated == ("low", "high", "far")
    assert contacts.warnings[0].startswith("blocks 'low' and 'high' overlap by 0.005 m3, 0.005 m deep")
    with pytest.raises(lb.errors.GeometryError, match=r"blocks 'low' and 'high' overlap by 0.005 m3"):
        find_interfaces(blocks, None)


@pytest.mark.parametrize(("overlap", "slivers"), [(1.1e-3, 0), (0.9e-3, 1), (1e-5, 1), (0.0, 0)])
def test_slivers(overlap, slivers):
    contacts = find_contacts([box("low", UNIT, (0, 0, 0)), box("high", UNIT, (1 - overlap, 0, 1))], None)
    assert len(contacts.slivers) == slivers
    for sliver in contacts.slivers:
        assert (sliver.area, sliver.width) == pytest.approx((overlap, overlap), rel=2e-3)
        assert "contacts left out because they are too small: low|high" in contacts.warnings[1]


def test_contacts_are_plain_data():
    blocks = [*wall(), box("near", UNIT, (0, 0, -0.55 - 1e-3)), box("in", UNIT, (0, 0, -0.7))]
    contacts = find_contacts(blocks, None)
    again = json.loads(json.dumps(contacts.to_dict()))
    assert len(again["interfaces"]) == len(contacts.interfaces)
    assert again["overlaps"][0]["depth"] == contacts.overlaps[0].depth
    assert [miss["gap"] for miss in again["near_misses"]] == [miss.gap for miss in contacts.near_misses]
    assert str(contacts).startswith(
        f"{len(contacts.interfaces)} interfaces, {len(contacts.near_misses)} near misses"
    )


def test_of_one_thing_no_plural_is_said():
    one = find_contacts([box("low", UNIT, (0, 0, -0.5)), box("high", UNIT, (0, 0, 0.5))], None)
    assert str(one).startswith("1 interface, 0 near misses, 0 overlaps, 0 isolated blocks")
    apart = find_contacts([box("low", UNIT, (0, 0, -0.5)), box("high", UNIT, (0, 0, 0.502))], None)
    assert str(apart).startswith("0 interfaces, 1 near miss, 0 overlaps, 2 isolated blocks")


def test_blocks_and_interfaces_are_short_lines_in_a_console():
    low, high = box("low", UNIT, (0, 0, -0.5)), box("high", (0.5, 0.5, 2.0), (0, 0, 1.0))
    (one,) = lb.find_interfaces([low, high], lb.PointContact(0.6))
    assert repr(high) == "<block 'high': size 2 m, volume 0.5 m3>"
    assert repr(one) == "<interface 'low|high': area 0.25 m2>"


def noisy(blocks, noise, seed):
    """Bricks as surveyed: in mm, turned at random, 500 km away, every vertex off by up to `noise`, m."""
    rng = np.random.default_rng(seed)
    blocks, _, _ = moved(blocks, seed)
    surveyed = []
    for block in blocks:
        error = noise * rng.uniform(-1.0, 1.0, block.vertices.shape)
        millimetres = np.round(1e3 * (block.vertices + error) + 5e8, 6)
        surveyed.append(Block(block.name, millimetres * 1e-3, block.faces))
    return surveyed


@pytest.mark.parametrize("form", [lambda block: block, triangulated])
@pytest.mark.parametrize("seed", range(6))
def test_noise_on_a_wall_500_km_away(seed, form):
    """A tenth of a millimetre on every vertex: what is lost is reported, and a wider gap finds all."""
    expected = find_interfaces(wall(), None)
    blocks = noisy([form(block) for block in wall()], 1e-4, seed)
    contacts = find_contacts(blocks, None)  # accepts gaps of 0.13 mm
    assert ends(contacts.interfaces) <= ends(expected)
    lost = ends(expected) - ends(contacts.interfaces)
    assert lost <= ends(contacts.near_misses) | ends(contacts.overlaps)
    wide = find_contacts(blocks, None, gap=5e-3)
    assert [(i.block_i, i.block_j) for i in wide.interfaces] == [(i.block_i, i.block_j) for i in expected]
    areas = [[float(polygon.areas(i.polygon)) for i in some] for some in (wide.interfaces, expected)]
    assert areas[0] == pytest.approx(areas[1], rel=1e-2)
    assert (wide.near_misses, wide.overlaps, wide.isolated) == ((), (), ())


@pytest.mark.parametrize("seed", range(3))
def test_without_noise_the_wall_500_km_away_is_the_same(seed):
    expected, interfaces = find_interfaces(wall(), None), find_contacts(noisy(wall(), 0.0, seed), None)
    assert [(i.block_i, i.block_j) for i in interfaces.interfaces] == [
        (i.block_i, i.block_j) for i in expected
    ]
    for old, new in zip(expected, interfaces.interfaces, strict=True):
        assert polygon.areas(new.polygon) == pytest.approx(polygon.areas(old.polygon), rel=1e-6)
    assert interfaces.warnings == []


# ---------------------------------------------------------------------------------------------- models


def model_of(blocks, interfaces, supports=("ground",)):
    live = lb.mass_proportional((1, 0, 0))
    return lb.Model(blocks, supports, interfaces, lb.self_weight(), live)


BLOCKS = [
    box("ground", (4, 1, 1), (0, 0, -0.5)),
    box("left", UNIT, (-0.5, 0, 0.5), 20e3),
    box("right", UNIT, (0.5, 0, 0.5), 20e3),
]


def test_model_with_all_its_interfaces_has_nothing_to_report():
    interfaces = lb.diagnose(model_of(BLOCKS, find_interfaces(BLOCKS, lb.PointContact(0.6))))
    assert (interfaces.interfaces, interfaces.warnings) == ((), [])


def test_contact_without_an_interface_in_the_model():
    interfaces = find_interfaces(BLOCKS, lb.PointContact(0.6))
    model = model_of(BLOCKS, [one for one in interfaces if one.block_i == "ground"])
    assert ends(lb.diagnose(model).interfaces) == {("left", "right")}
    assert lb.diagnose(model).warnings == ["no interface between blocks that touch: left|right"]


def test_a_leg_that_is_too_short_is_not_left_out_in_silence(caplog):
    """A leg of a portal 1.5 mm short of the lintel has no interface with it."""
    stones = portal_stones()
    short = box("middle", (0.5, 1, 1.9985), (0, 0, 0.99925), 20e3)
    assert len(find_interfaces(stones, lb.PointContact(0.6))) == 4
    assert caplog.messages == []
    find_interfaces([*stones, short], lb.PointContact(0.6))
    (said,) = caplog.messages
    assert "nearly touch: lintel|middle (gap 0.0015 m" in said


@pytest.mark.parametrize(("apart", "said"), [(1.5e-3, "left|top (gap 0.0015 m"), (0.1, "")])
def test_a_block_that_floats_for_a_narrow_gap_says_which(apart, said):
    top = box("top", UNIT, (-0.5, 0, 1.5 + apart), 20e3)
    with pytest.raises(lb.ModelError, match="ties 'top' to a support") as error:
        model_of([*BLOCKS, top], find_interfaces(BLOCKS, lb.PointContact(0.6)))
    assert ("nearly touching: left|top" in str(error.value)) is bool(said)
    assert said in str(error.value)
    assert "--angle" not in str(error.value)


@pytest.mark.parametrize("lift", [0.0, 1.5e-3])
def test_a_block_that_floats_for_a_tilt_says_which_angle_ties_it(lift):
    """A stone 0.04 m wide, tilted by 0.02 rad about an edge: 0.8 mm off, where 1 mm counts as touching."""
    turn = np.array([[np.cos(0.02), 0, np.sin(0.02)], [0, 1, 0], [-np.sin(0.02), 0, np.cos(0.02)]])
    corner = np.array([-0.5, 0.0, 1.0 + lift])
    stone = box("stone", (0.04, 0.04, 0.04), (-0.02, 0, 0.02), 20e3).moved(turn, corner)
    stones = [*BLOCKS, stone]
    with pytest.raises(lb.ModelError, match=r"left\|stone \(gap .* 0.02 rad.*--angle 0.022.* takes") as error:
        model_of(stones, find_interfaces(stones, lb.PointContact(0.6)))
    options = {name: float(value) for name, value in re.findall(r"--(\w+) (\S+)", str(error.value))}
    assert ("gap" in options) is (lift > 0.0)
    model_of(stones, find_interfaces(stones, lb.PointContact(0.6), **options))


def test_what_is_between_supports_is_left_out():
    blocks = [
        *BLOCKS,
        box("other", (4, 1, 1), (0, 0, -1.502)),  # a near miss of the ground
        box("third", (4, 1, 1), (0, 0.9, -0.5)),  # overlaps the ground
        box("alone", UNIT, (50, 0, 0)),
        box("beside", UNIT, (-0.5, -1.002, 0.5)),  # a near miss of the left block
    ]
    interfaces = find_interfaces(BLOCKS, lb.PointContact(0.6))
    values = lb.diagnose(model_of(blocks, interfaces, ["ground", "other", "third", "alone", "beside"]))
    assert ends(values.near_misses) == {("left", "beside")}
    assert values.overlaps == ()
    assert values.isolated == ("other", "alone", "beside")
    assert "blocks without any interface: other, alone, beside" in values.warnings
    assert str(values).startswith("beside the interfaces of the model: ")


def test_a_pair_of_blocks_that_nearly_touches_is_named_once():
    """An L around a box nearly touches it with two faces, 0.5 m2 and 1 m2; the larger is shown."""
    outline = [(0, 0), (2, 0), (2, 0.5), (1, 0.5), (1, 2), (0, 2)]
    corner = Block.prism("corner", outline, (0, 1))
    stone = box("stone", (0.5, 1, 1), (1.255, 0.5, 1.005))
    contacts = find_contacts([corner, stone], None)
    assert sorted(miss.area for miss in contacts.near_misses) == pytest.approx([0.5, 1.0])
    (line,) = [line for line in contacts.warnings if "nearly touch" in line]
    assert line.count("corner|stone") == 1
    assert "1 m2) and 1 more face" in line


@pytest.mark.parametrize(
    ("shift", "turn", "said"),
    [
        ((0, 0, 0), 0.0, ""),
        ((0, 0, 5e-4), 5e-4, ""),  # within gap and angle
        ((0, 0, 0.25), 0.0, "0.25 m and 0 rad off the faces of 'ground'"),
        ((0, 0, 0), 0.2, "99 mm and 0.2 rad off the faces of 'left'"),
        ((3, 0, 0), 0.0, "3 m and 0 rad off the faces of 'left'"),
    ],
)
def test_interface_off_the_faces_of_its_blocks_is_warned_of(shift, turn, said):
    on, other, beside = find_interfaces(BLOCKS, lb.PointContact(0.6))
    axes = on.axes @ Rotation.from_rotvec([0, turn, 0]).as_matrix()
    moved = replace(on, centroid=on.centroid + shift, axes=axes)
    model = model_of(BLOCKS, [moved, other, beside])
    lines = " ".join(lb.diagnose(model).warnings)
    assert said in lines
    assert bool(said) == bool(lines)
    assert bool(said) == bool(astray(model))

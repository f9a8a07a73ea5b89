"""Contacts at the accuracy of the data: noise, strips, sheets thinner than the gap, rough faces, healing."""

from dataclasses import replace

import numpy as np
import pytest
from bodies import triangulated
from manifold3d import Manifold, Mesh64

import limitblocks as lb
from limitblocks import structures
from limitblocks.geometry import accuracy, polygon

JOINT = lb.OrdunaLourenco(0.6)
UNIT = (1.0, 1.0, 1.0)
box = lb.Block.box
CORNER = structures.corner(JOINT, length=2.4, return_length=2.4, courses=5)
VAULT = structures.barrel_vault(JOINT, radius=1.5, thickness=0.4, length=1.8, courses=9, stones=3)
WALL = structures.wall(JOINT, length=2.0, courses=5)  # stones of 0.4 m x 0.2 m x 0.2 m
CLEAN = {"corner": CORNER, "vault": VAULT, "wall": WALL}


def noisy(blocks, noise, seed):
    rng = np.random.default_rng(seed)
    return [
        lb.Block(b.name, b.vertices + noise * rng.uniform(-1, 1, b.vertices.shape), b.faces, b.unit_weight)
        for b in map(triangulated, blocks)
    ]


def divided(block):
    """The triangles of a block, each in four."""
    corners = block.vertices[block.triangles]
    middles = (corners + np.roll(corners, -1, axis=1)) / 2
    (a, b, c), (d, e, f) = corners.swapaxes(0, 1), middles.swapaxes(0, 1)
    soup = np.concatenate([np.stack(one, axis=1) for one in ((a, d, f), (d, b, e), (f, e, c), (d, e, f))])
    points, number = np.unique(soup.reshape(-1, 3).round(9), axis=0, return_inverse=True)
    return lb.Block(block.name, points, number.reshape(-1, 3).tolist(), block.unit_weight)


def model_of(clean, blocks, contacts):
    return lb.Model(blocks, clean.supports, contacts.interfaces, clean.dead, clean.live)


def ends(items):
    return {(one.block_i, one.block_j) for one in items}


@pytest.mark.parametrize("name", structures.EXAMPLES)
def test_what_is_drawn_exactly_gets_the_tolerances_of_a_drawing(name):
    blocks = structures.EXAMPLES[name](lb.PointContact(0.7)).blocks
    used = lb.find_contacts(blocks, None).tolerances
    assert (used.gap, used.angle, used.width) == (1e-3, 1e-2, 1e-3)
    assert used.accuracy is None or used.accuracy < 1e-12


@pytest.mark.parametrize("name", CLEAN)
@pytest.mark.parametrize("noise", [1.5e-4, 1e-3])
def test_accuracy_is_the_standard_deviation_of_a_coordinate(name, noise):
    """n / sqrt(3) of uniform noise up to n, within a fifth."""
    found = lb.find_contacts(noisy(CLEAN[name].blocks, noise, 1), None)
    assert found.tolerances.accuracy * found.length == pytest.approx(noise / np.sqrt(3), rel=0.2)
    assert found.accuracy.startswith(
        f"the faces that touch are good to about {1e3 * found.tolerances.accuracy * found.length:.2g} mm; gap"
    )


@pytest.mark.parametrize("name", CLEAN)
@pytest.mark.parametrize(("noise", "seed"), [(1.5e-4, 0), (3e-4, 1), (1e-3, 2), (2e-3, 3)])
def test_noise_is_right_or_refused(name, noise, seed):
    """Within 1 % of the clean load factor, or a sentence with cause and remedy; never silent."""
    clean = CLEAN[name]
    contacts = lb.find_contacts(noisy(clean.blocks, noise, seed), JOINT)
    if contacts.faults:
        with pytest.raises(
            lb.errors.GeometryError, match=r"good to about .* mm only; beyond .*limitblocks\.heal"
        ):
            contacts.require()
        assert noise > 1e-3 or name == "wall"
        assert contacts.warnings[0] == contacts.faults[0]
        return
    assert ends(contacts.interfaces) == ends(clean.interfaces)
    found = lb.bounds(model_of(clean, noisy(clean.blocks, noise, seed), contacts)).lower
    assert found == pytest.approx(lb.bounds(clean).lower, rel=1e-2)


def test_given_tolerances_take_blocks_as_they_are_with_a_warning():
    blocks = noisy(CORNER.blocks, 3e-3, 0)
    taken = lb.find_contacts(blocks, JOINT, gap=2e-2, angle=0.1)
    taken.require()
    assert "good to about 1." in taken.warnings[0]


@pytest.mark.parametrize("width", [0.5e-3, 2e-3])
def test_strips_are_findings(width):
    """Stones that meet at an edge but for `width`: an interface would be a shear key."""
    blocks = [box("low", UNIT, (0, 0, 0)), box("high", (4.0, 4.0, 1.0), (2.5 - width, 0, 1))]
    found = lb.find_contacts(blocks, None, width=1e-3 / 1.6)
    assert len(found.interfaces) == (width > 1e-3)
    wide = lb.find_contacts(blocks, None, width=5e-3)
    (strip,) = wide.strips or wide.slivers
    assert strip.width == pytest.approx(width, rel=5e-3)
    assert wide.isolated == ("low", "high")


def test_an_angle_is_never_chosen_larger_than_faces_were_looked_at():
    """What counts as touching stays far below the 45 degrees that may be asked for."""
    assert accuracy.chosen(None, None, None, accuracy.Accuracy(1e-3, 0.5)).angle == accuracy._TURN < np.pi / 8


@pytest.mark.parametrize("share", [0.45, 0.55])
def test_a_sheet_that_is_covered_by_more_than_a_half_stands(share):
    """A sheet 4 mm thick whose lower edge is on the stone by `share` of its length."""
    blocks = [box("stone", UNIT, (0, 0, 0)), box("sheet", (1.0, 0.004, 1.0), (1.0 - share, 0, 1))]
    found = lb.find_contacts(blocks, None, width=0.01)
    assert len(found.interfaces) == (share > 0.5)
    assert len(found.strips) == (share < 0.5)


def test_narrow_faces_that_are_covered_are_no_strips():
    tile = box("tile", (2e-3, 1.0, 1.0), (0, 0, 0.5))
    (one,) = lb.find_interfaces([box("ground", UNIT, (0, 0, -0.5)), tile], None, width=0.1)
    assert polygon.areas(one.polygon) == pytest.approx(2e-3)


# -------------------------------------------------------------------------------------------- thin sheets


# ------------------------------------------------------------------------------------------------- facets


@pytest.mark.parametrize("name", ["corner", "vault"])
def test_rough_facets_are_refused_and_healed(name):
    clean = CLEAN[name]
    blocks = [divided(block) for block in clean.blocks]
    exact = lb.find_contacts(blocks, JOINT)
    assert exact.faults == ()
    assert ends(exact.interfaces) == ends(clean.interfaces)
    rough = noisy(blocks, 1e-3, 0)
    with pytest.raises(
        lb.errors.GeometryError, match=r"two blocks touch through \d+ facets, .*limitblocks\.heal"
    ):
        lb.find_interfaces(rough, JOINT)
    healed = lb.heal(rough)
    contacts = healed.contacts(JOINT)
    contacts.require()
    found = lb.bounds(model_of(clean, healed.blocks, contacts)).lower
    assert found == pytest.approx(lb.bounds(clean).lower, rel=1e-2)


# ------------------------------------------------------------------------------------------------ healing


@pytest.mark.parametrize("name", CLEAN)
@pytest.mark.parametrize("noise", [3e-4, 2e-3])
def test_healed_blocks_have_the_contacts_and_load_factor_of_the_clean_ones(name, noise):
    clean, rough = CLEAN[name], noisy(CLEAN[name].blocks, noise, 5)
    healed = lb.heal(rough)
    assert healed.notes == ()
    contacts = healed.contacts(JOINT)
    assert contacts.faults == ()
    assert ends(contacts.interfaces) == ends(clean.interfaces)
    found = lb.bounds(model_of(clean, healed.blocks, contacts)).lower
    assert found == pytest.approx(lb.bounds(clean).lower, rel=1e-2)
    for old, new in zip(rough, healed.blocks, strict=True):
        moved = np.linalg.norm(new.vertices[:, None] - old.vertices, axis=2).min(axis=1).max()
        assert moved <= healed.displacements[old.name] * (1 + 1e-9) <= healed.bound
        assert new.unit_weight == old.unit_weight


def test_what_is_drawn_exactly_is_healed_to_itself():
    healed = lb.heal(CORNER.blocks)
    assert healed.blocks == tuple(CORNER.blocks)
    assert set(healed.displacements.values()) == {0.0}


def test_small_gaps_are_closed_within_the_accuracy_given():
    blocks = [box("low", UNIT, (0, 0, -0.5)), box("high", UNIT, (0.25, 0, 0.5 + 4e-3))]
    healed = lb.heal(blocks, accuracy=1e-3)
    assert all(2e-3 <= moved < 2.5e-3 for moved in healed.displacements.values())
    (one,) = lb.find_interfaces(healed.blocks, None)
    assert (one.centroid[2], float(polygon.areas(one.polygon))) == pytest.approx((2e-3, 0.75), abs=2e-3 / 4)
    far = lb.heal([blocks[0], box("high", UNIT, (0.25, 0, 0.5 + 7e-3))], accuracy=1e-3)
    assert set(far.displacements.values()) == {0.0}


@pytest.mark.parametrize("over", [2e-3, 5e-3])
def test_stones_that_meet_in_a_strip_are_not_brought_into_one_plane(over):
    """A strip narrower than six accuracies is no joint, and its gap of four is not closed."""
    low, high = box("low", UNIT, (0, 0, -0.5)), box("high", UNIT, (1.0 - over, 0, 0.5 + 4e-3))
    assert set(lb.heal([low, high], accuracy=1e-3).displacements.values()) == {0.0}


def bed_of(thickness):
    """Three stones 0.3 m high with a sheet between each two and one on top, and their contacts."""
    tops = np.cumsum([0.3, thickness] * 3)
    heights = np.diff(tops, prepend=0.0)
    sizes = zip(tops - heights / 2, heights, strict=True)
    blocks = [box(f"s{k}", (1.0, 1.0, h), (0, 0, z), 20e3) for k, (z, h) in enumerate(sizes)]
    return blocks, {(f"s{k}", f"s{k + 1}") for k in range(5)}


@pytest.mark.parametrize("thickness", [1e-3, 2e-3, 5e-3])
def test_stones_do_not_move_into_the_sheet_between_them(thickness):
    """All gaps are none; the stones beside a sheet thinner than six accuracies met half way in it."""
    blocks, pairs = bed_of(thickness)
    healed = lb.heal(blocks, accuracy=1e-3)
    assert max(healed.displacements.values()) < 1e-12
    found = lb.find_contacts(healed.blocks, JOINT)
    assert ends(found.interfaces) == pairs
    assert found.overlaps == healed.notes == ()


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("thickness", [2e-3, 4e-3])
def test_a_rough_sheet_keeps_its_thickness(thickness, seed):
    """Off by up to 0.4 mm along each axis; made coarse within six accuracies, 2.4 mm, it was a wedge."""
    blocks, pairs = bed_of(thickness)
    healed = lb.heal(noisy([divided(one) for one in blocks], 4e-4, seed), accuracy=4e-4)
    found = healed.contacts(JOINT)
    assert ends(found.interfaces) == pairs
    assert found.overlaps == healed.notes == ()
    heights = [np.ptp(one.vertices[:, 2]) for one in healed.blocks[1::2]]
    assert heights == pytest.approx([thickness] * 3, abs=2 * 4e-4)


def wedge(slope):
    """A prism 2 m long on z = 0 whose upper face rises from its edge at x = 0 by `slope`, rad."""
    return lb.Block.prism("wedge", [(0, 0), (2, 0), (2, 2.0 * np.tan(slope))], (-0.5, 0.5), 20e3)


@pytest.mark.parametrize(
    ("slope", "moves"), [(12, False), (13.5, False), (14.5, True), (20, True), (30, True)]
)
def test_a_sharp_edge_moves_along_its_slope_and_twelve_times_the_accuracy_at_most(slope, moves):
    """Both faces go half of the gap h: the edge h / (2 sin slope), 12 mm of 12 accuracies at 14 degrees."""
    gap, slope = 5.8e-3, np.radians(slope)
    stone = wedge(slope)
    healed = lb.heal([box("ground", (2.0, 1.0, 1.0), (1.0, 0, -0.5 - gap)), stone], accuracy=1e-3)
    assert healed.bound == pytest.approx(12e-3)
    assert healed.displacements["ground"] == pytest.approx(gap / 2)
    moved = gap / 2 / np.sin(slope)
    assert healed.displacements["wedge"] == pytest.approx(moved if moves else 0.0)
    left = "block 'wedge' is left as it was: its faces are not plane within 0.001 m"
    assert healed.notes == (() if moves else (left,))
    assert moves or healed.blocks[1] is stone
    farthest = 1e3 * (moved if moves else gap / 2)
    said = f"2 blocks mended within 1 mm: vertices moved by up to {farthest:.2g} mm"
    assert str(healed) == f"{said}, at most 12 mm allowed{'' if moves else '; 1 left as they were'}"


def test_a_stone_whose_coarser_mesh_crosses_itself_keeps_its_own():
    """A rough prism, in mm; its mesh may change by a quarter of its thickness 2 V/A."""
    low = [(9, -15, 1), (-20, -2, 1), (0, 2, 2), (-1, 4, 1), (1, 1, -1), (3, -1, -1)]
    high = [(8, -15, 21), (-21, 1, 19), (-2, 3, 18), (0, 0, 19), (4, 3, 20), (4, 2, 19)]
    sides = [
        face for k in range(6) for face in ((k, k + 6, (k + 1) % 6 + 6), (k, (k + 1) % 6 + 6, (k + 1) % 6))
    ]
    ends = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (5, 0, 4), (8, 7, 6), (9, 8, 6), (10, 9, 6), (10, 6, 11)]
    stone = lb.Block("stone", 1e-3 * np.array(low + high), sides + ends, 20e3)
    solid = Manifold(Mesh64(stone.vertices.copy(), stone.triangles.astype(np.uint64)))
    mesh = solid.set_tolerance(solid.volume() / solid.surface_area() / 2).to_mesh64()
    with pytest.raises(lb.errors.GeometryError, match="crosses itself"):
        lb.Block("coarse", mesh.vert_properties[:, :3], mesh.tri_verts.tolist(), 20e3)
    assert lb.heal([stone], accuracy=1e-3).displacements["stone"] < 6e-3


def test_heal_without_an_accuracy_needs_joints_to_tell_it():
    blocks = [box("low", UNIT, (0, 0, -0.5)), box("high", UNIT, (0.25, 0, 0.5))]
    with pytest.raises(lb.ModelError, match="is not known, too few of them touch"):
        lb.heal(blocks)
    with pytest.raises(lb.ModelError, match=r"accuracy is -1\.0; a length"):
        lb.heal(blocks, accuracy=-1.0)


# --------------------------------------------------------------------------------------- models and files


def test_later_commands_judge_with_the_tolerances_of_the_model(tmp_path):
    """At the defaults `diagnose` missed 10 mm joints that the model was made of."""
    blocks = [box("low", UNIT, (0, 0, -0.5)), box("high", UNIT, (0, 0, 0.5 + 8e-3), 20e3)]
    contacts = lb.find_contacts(blocks, JOINT, gap=1e-2)
    given = {"dead": lb.self_weight(), "live": lb.mass_proportional((1, 0, 0))}
    model = lb.Model(blocks, ["low"], contacts.interfaces, **given, tolerances=contacts.tolerances)
    again = lb.read(model.save(tmp_path / "model.json"))
    assert again.tolerances == contacts.tolerances
    assert again.digest == model.digest == replace(model, tolerances=None).digest
    found = lb.diagnose(again)
    assert found.tolerances.gap == 1e-2
    assert found.warnings == []
    assert found.nothing == ["nothing found beside the interfaces with these tolerances"]
    assert lb.diagnose(again, gap=1e-3).tolerances.gap == 1e-3

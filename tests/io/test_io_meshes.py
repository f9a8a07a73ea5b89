"""Blocks in mesh files of this and of other programs: names, units, axes, cavities, and what is refused."""

import json
import logging
import struct

import numpy as np
import pytest
import trimesh

import limitblocks as lb
from limitblocks.geometry.polygon import areas

JOINT = lb.OrdunaLourenco(0.6)
ARCH = lb.structures.arch(JOINT, radius=5.0, thickness=0.8, voussoirs=11)
#: Relative tolerance of areas: GLB and binary STL hold numbers in single precision, by their standards.
PRECISION = {".obj": 1e-9, ".stl": 1e-9, ".ply": 1e-9, ".glb": 1e-6}
DIRECTION = lb.mass_proportional((1.0, 0.0, 0.0))
X = np.array([1.0, 0.0, 0.0])


@pytest.mark.parametrize("suffix", [".obj", ".stl", ".ply", ".glb"])
def test_another_reader_finds_the_same_volumes(suffix, tmp_path):
    path = lb.files.write_blocks(ARCH, tmp_path / f"arch{suffix}")
    scene = trimesh.load_scene(path)
    assert scene.volume == pytest.approx(sum(block.volume for block in ARCH.blocks), rel=1e-6)
    extents = np.ptp(np.concatenate([block.vertices for block in ARCH.blocks]), axis=0)
    wanted = extents[[0, 2, 1]] if suffix == ".glb" else extents  # Y up
    assert scene.extents == pytest.approx(wanted, rel=1e-6)


@pytest.mark.parametrize("suffix", [".obj", ".stl", ".ply", ".glb", ".gltf"])
def test_files_of_another_writer_are_read(suffix, tmp_path):
    shapes = {
        "drum": trimesh.creation.cylinder(0.5, 1.0, sections=12),
        "plinth": trimesh.creation.box((2, 2, 1)),
    }
    shapes["drum"].apply_translation((0, 0, 1))
    scene = trimesh.Scene()
    for name, shape in shapes.items():
        scene.add_geometry(shape, geom_name=name, node_name=name)
    path = tmp_path / f"two{suffix}"
    if suffix == ".gltf":
        for file, data in scene.export(file_type="gltf").items():
            (tmp_path / (path.name if file.endswith(".gltf") else file)).write_bytes(data)
    else:
        scene.export(path)
    imported = lb.files.read_blocks(path, up="z")
    faces = {len(block.faces): block.volume for block in imported.blocks}
    # a regular 12-gon of radius 1/2 has the area 12/2 sin(30 deg) / 4 = 3/4
    assert faces == pytest.approx({14: 0.75, 6: 4.0}, rel=1e-6)
    (interface,) = lb.find_interfaces(imported.blocks, JOINT)
    assert areas(interface.polygon) == pytest.approx(0.75, rel=1e-6)


@pytest.mark.parametrize(
    ("units", "metres"), [("m", 1), ("cm", 0.01), ("mm", 1e-3), ("in", 0.0254), ("ft", 0.3048)]
)
def test_units_scale_lengths(units, metres, tmp_path):
    path = lb.files.write_blocks([lb.Block.box("a", (1, 2, 3), (4, 5, 6))], tmp_path / "a.obj")
    (block,) = lb.files.read_blocks(path, units=units).blocks
    assert block.volume == pytest.approx(6.0 * metres**3)
    assert block.centroid == pytest.approx(np.array([4, 5, 6]) * metres)


def test_axis_up_turns_the_structure(tmp_path):
    path = lb.files.write_blocks([lb.Block.box("a", (1, 2, 3), (4, 5, 6))], tmp_path / "a.obj")
    (block,) = lb.files.read_blocks(path, up="y").blocks
    assert block.centroid == pytest.approx([4, -6, 5])
    path = lb.files.write_blocks([lb.Block.box("a", (1, 2, 3), (4, 5, 6))], tmp_path / "a.glb")
    assert lb.files.read_blocks(path).blocks[0].centroid == pytest.approx([4, 5, 6])
    assert lb.files.read_blocks(path, up="z").blocks[0].centroid == pytest.approx([4, 6, -5])


def test_obj_has_blocks_by_object_or_group_and_layers(tmp_path):
    cube = "".join(f"v {x} {y} {z}\n" for x in (0, 1) for y in (0, 1) for z in (0, 1))
    cube += "".join(f"v {x} {y} {z}\n" for x in (0, 1) for y in (0, 1) for z in (1, 2))
    quads = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)]
    low = "".join(f"f {' '.join(f'{v}/1/1' for v in quad)}\n" for quad in quads)
    high = "".join(f"f {' '.join(str(v - 9) for v in quad)}\n" for quad in quads)  # back from the last
    path = tmp_path / "two.obj"
    path.write_text(f"mtllib x.mtl\n{cube}g base\nusemtl granite\n{low}g shaft\nusemtl brick\n{high}")
    imported = lb.files.read_blocks(path, unit_weight={"brick": 18e3})
    assert dict(imported.layers) == {"base": "granite", "shaft": "brick"}
    assert [block.unit_weight for block in imported.blocks] == [None, 18e3]
    path.write_text(f"{cube}o stone\ng pier\n{low}o stone #2\ng pier\n{high}")
    assert dict(lb.files.read_blocks(path).layers) == {"stone": "pier", "stone #2": "pier"}
    path.write_text(f"{cube}{low}{high}")
    assert [block.name for block in lb.files.read_blocks(path).blocks] == ["two", "two 2"]


def test_gltf_nodes_are_placed_by_their_parents(tmp_path):
    path = lb.files.write_blocks([lb.Block.box("a", (1, 2, 3), (0, 0, 0), 1.0)], tmp_path / "a.glb")
    data = path.read_bytes()
    half = np.sqrt(0.5)
    length = struct.unpack("<I", data[12:16])[0]
    document = json.loads(data[20 : 20 + length])
    document["nodes"] = [
        {"name": "a", "mesh": 0, "rotation": [0, half, 0, half], "scale": [2, 2, 2]},
        {"children": [0], "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 10, 20, 30, 1]},
    ]
    document["scenes"][0]["nodes"] = [1]
    text = json.dumps(document)
    text += " " * (-len(text) % 4)
    body = struct.pack("<I", len(text)) + b"JSON" + text.encode() + data[20 + length :]
    path.write_bytes(data[:8] + struct.pack("<I", len(body) + 12) + body)
    (block,) = lb.files.read_blocks(path).blocks
    assert block.centroid == pytest.approx([10, -30, 20])
    assert block.volume == pytest.approx(8 * 6.0)
    assert np.ptp(block.vertices, axis=0) == pytest.approx([4, 2, 6])  # X and Y change places about Z


def test_names_become_unique_and_say_so(tmp_path):
    boxes = [lb.Block.box(name, (1, 1, 1), (2 * k, 0, 0)) for k, name in enumerate(["a", "a", "a 2", "a"])]
    imported = lb.files.read_blocks(lb.files.write_blocks(boxes, tmp_path / "a.stl"))
    assert [block.name for block in imported.blocks] == ["a", "a 3", "a 2", "a 4"]
    assert imported.notes == ("3 blocks are named 'a'; all but the first got a number",)


def test_cavity_belongs_to_the_block_around_it(tmp_path):
    outer, inner = trimesh.creation.box((3, 3, 3)), trimesh.creation.box((1, 1, 1))
    inner.invert()
    beside = trimesh.creation.box((3, 3, 3))
    beside.apply_translation((3, 0, 0))
    path = tmp_path / "hollow.stl"
    trimesh.util.concatenate([inner, outer, beside]).export(path)
    imported = lb.files.read_blocks(path)
    assert [block.volume for block in imported.blocks] == pytest.approx([26.0, 27.0])
    again = lb.files.read_blocks(lb.files.write_blocks(imported, tmp_path / "again.obj"))
    assert [block.volume for block in again.blocks] == pytest.approx([26.0, 27.0])


def test_a_hollow_block_inside_out_is_turned_as_a_whole(tmp_path):
    """Its cavity, the one surface that points outward, became a block within it."""
    outer, inner = trimesh.creation.box((3, 3, 3)), trimesh.creation.box((1, 1, 1))
    outer.invert()
    path = tmp_path / "inside-out.stl"
    trimesh.util.concatenate([inner, outer]).export(path)
    imported = lb.files.read_blocks(path)
    assert [block.volume for block in imported.blocks] == pytest.approx([26.0])
    assert imported.notes[-1].endswith("all faces pointed inward and are turned")


CONCAVE = lb.Block(
    "angle",
    [(x, y, z) for z in (0.0, 1.0) for x, y in ((0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2))],
    [(5, 4, 3, 2, 1, 0), (6, 7, 8, 9, 10, 11), *((k, (k + 1) % 6, (k + 1) % 6 + 6, k + 6) for k in range(6))],
)


@pytest.mark.parametrize("suffix", PRECISION)
def test_block_that_is_not_convex_keeps_its_shape(suffix, tmp_path):
    path = lb.files.write_blocks([CONCAVE], tmp_path / f"angle{suffix}")
    (block,) = lb.files.read_blocks(path).blocks
    assert block.volume == pytest.approx(3.0, rel=PRECISION[suffix])
    assert sorted(block.areas) == pytest.approx([1, 1, 1, 1, 2, 2, 3, 3], rel=PRECISION[suffix])
    assert not block.convex


def test_read_makes_a_model_and_logs_what_was_mended(tmp_path, caplog):
    path = tmp_path / "column.stl"
    lower, upper = (lb.Block.box(name, (1, 1, 2), (0, 0, z)) for name, z in (("base", -1), ("shaft", 1)))
    inside_out = lb.files.write_blocks([upper], tmp_path / "upper.stl").read_text().splitlines()
    for k, line in enumerate(inside_out):
        if "outer loop" in line:
            inside_out[k + 1], inside_out[k + 2] = inside_out[k + 2], inside_out[k + 1]
    path.write_text(
        lb.files.write_blocks([lower], tmp_path / "lower.stl").read_text() + "\n".join(inside_out)
    )
    with caplog.at_level(logging.WARNING, "limitblocks"):
        model = lb.read(
            path, joint=JOINT, supports=lambda b: b.centroid[2] < 0, live=DIRECTION, unit_weight=20e3
        )
    assert model.supports == ("base",)
    assert model.name == "column"
    assert [record.getMessage() for record in caplog.records] == [
        f"{path}: block 'shaft': all faces pointed inward and are turned"
    ]
    # a block twice as high as wide rocks at width / height
    assert lb.bounds(model).lower == pytest.approx(0.5, abs=1e-6)


REFUSED = {
    "no live load": ({"joint": JOINT, "supports": "base"}, "give live="),
    "nothing": ({}, "give joint=.*give supports=.*give live="),
    "support unknown": (
        {"joint": JOINT, "supports": ["bas"], "live": DIRECTION},
        "'bas' .*did you mean 'base'",
    ),
    "unit unknown": ({"joint": JOINT, "supports": "base", "live": DIRECTION, "units": "km"}, "'km'.*mm"),
    "axis unknown": ({"joint": JOINT, "supports": "base", "live": DIRECTION, "up": "x"}, "'x'.*'y'"),
    "layer unknown": (
        {"joint": JOINT, "supports": "base", "live": DIRECTION, "unit_weight": {"brik": 1.0}},
        "layer 'brik'",
    ),
    "no unit weight": ({"joint": JOINT, "supports": "base", "live": DIRECTION}, "has no unit weight"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_missing_or_unknown_is_said(name, tmp_path):
    arguments, said = REFUSED[name]
    boxes = [lb.Block.box("base", (1, 1, 1), (0, 0, 0)), lb.Block.box("top", (1, 1, 1), (0, 0, 1))]
    path = lb.files.write_blocks(boxes, tmp_path / "two.stl")
    with pytest.raises(lb.ModelError, match=said):
        lb.read(path, **arguments)


def test_model_file_takes_no_arguments(tmp_path):
    path = ARCH.save(tmp_path / "arch.json")
    assert lb.read(path).digest == ARCH.digest
    with pytest.raises(lb.ModelError, match="a model file says joint, units itself"):
        lb.read(path, joint=JOINT, units="mm")
    for name, given in {
        "live": DIRECTION,
        "dead": DIRECTION,
        "gap": 1e-3,
        "angle": 0.01,
        "width": 0.0,
    }.items():
        with pytest.raises(lb.ModelError, match=f"a model file says {name} itself; .*replace"):
            lb.read(path, **{name: given})


def test_nothing_is_overwritten_without_being_asked(tmp_path):
    box = [lb.Block.box("a", (1, 1, 1), (0, 0, 0))]
    for suffix in PRECISION:
        path = tmp_path / f"a{suffix}"
        path.write_text("mine")
        with pytest.raises(lb.LimitBlocksError, match="overwrite=True"):
            lb.files.write_blocks(box, path)
        assert path.read_text() == "mine"
        assert lb.files.write_blocks(box, path, overwrite=True) == path
    with pytest.raises(lb.LimitBlocksError, match="cannot write"):
        lb.files.write_blocks(box, tmp_path / "none" / "a.obj")
    with pytest.raises(lb.ModelError, match=r"\.obj"):
        lb.files.write_blocks(box, tmp_path / "a.doc")
    with pytest.raises(lb.ModelError, match="no blocks"):
        lb.files.write_blocks([], tmp_path / "b.obj")


def written_by_another(path, blocks, shift):
    """A binary STL file, single precision by its format, of blocks that far from the origin along X."""
    meshes = [trimesh.Trimesh(shift * X + one.vertices, one.triangles, process=False) for one in blocks]
    trimesh.util.concatenate(meshes).export(path)
    return path


@pytest.mark.parametrize(("shift", "step"), [(0.0, ""), (1e4, ""), (1e5, "7.8 mm"), (5e5, "31 mm")])
def test_single_precision_too_far_from_the_origin_is_warned_of(tmp_path, shift, step):
    """Between 2^k and 2^(k + 1) it goes in steps of 2^(k - 23): 1/128 m at 1e5 m, 1/32 m at 5e5 m."""
    stones = [lb.Block.box(f"{k}", (0.4, 0.2, 0.2), (0.37 * k, 0.0, 0.1)) for k in range(3)]
    found = lb.files.read_blocks(written_by_another(tmp_path / "a.stl", stones, shift))
    told = [line for line in found.guesses if "single precision" in line]
    assert bool(told) == bool(step)
    assert not step or f"in steps of {step} {shift:.3g} m from the origin" in told[0]


def test_coordinates_on_a_grid_far_from_the_origin_are_not_taken_as_rounded(tmp_path):
    """Multiples of 1/4 m have digits to spare in single precision 5e5 m from the origin."""
    stones = [lb.Block.box(f"{k}", (0.5, 0.25, 0.25), (5e5 + 0.5 * k, 0.0, 0.125)) for k in range(3)]
    found = lb.files.read_blocks(lb.files.write_blocks(stones, tmp_path / "a.obj"))
    assert not [line for line in found.guesses if "precision" in line]

"""Meshes of several parts: materials of faces, nodes of glTF that mirror, are elsewhere or draw nothing."""

import base64
import json

import ezdxf
import numpy as np
import pytest
import trimesh

import limitblocks as lb

BOX = lb.Block.box("a", (1.0, 2.0, 3.0), (0.5, 1.0, 1.5))
HOLLOW = lb.Block.box("h", (0.5, 0.5, 0.5), (0.5, 1.0, 1.5))
#: From Z up to Y up, as glTF has it.
Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])


def gltf(path, primitives, node, **more):
    """A file of one node whose mesh has primitives: corners (n, 3) of triangles, Z up, and a material."""
    data, views, accessors, parts = b"", [], [], []
    for k, (corners, material) in enumerate(primitives):
        values = np.asarray(corners @ Y_UP.T, dtype="<f4")
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": values.nbytes})
        accessors.append({"bufferView": k, "componentType": 5126, "count": len(values), "type": "VEC3"})
        parts.append({"attributes": {"POSITION": k}, "material": material})
        data += values.tobytes()
    uri = f"data:application/octet-stream;base64,{base64.b64encode(data).decode()}"
    document = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "one", "mesh": 0} | node],
        "meshes": [{"primitives": parts}],
        "materials": [{"name": "stone"}, {"name": "plaster"}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"uri": uri, "byteLength": len(data)}],
    }
    path.write_text(json.dumps(document | more))
    return path


def corners(block, faces=slice(None), inward=False):
    triangles = block.triangles[faces]
    return block.vertices[triangles[:, ::-1] if inward else triangles].reshape(-1, 3)


def test_a_mirrored_node_keeps_its_cavity_and_needs_no_mending(tmp_path):
    """A node of negative determinant turns its faces (glTF 2.0, 3.7.4), else the cavity were a block."""
    drawn = [(corners(BOX), 0), (corners(HOLLOW, inward=True), 0)]
    found = lb.files.read_blocks(gltf(tmp_path / "a.gltf", drawn, {"scale": [-2, 1, 1]}))
    (block,) = found.blocks
    assert block.volume == pytest.approx(2 * (6.0 - 0.125))
    assert block.centroid == pytest.approx([-1.0, 1.0, 1.5])
    assert found.notes == ()


def test_a_stone_inside_out_between_the_arms_of_another_is_no_cavity_of_it(tmp_path):
    """It is within the bounding box alone: it is turned, as it is anywhere else."""
    arms = [(0, 0), (3, 0), (3, 3), (2, 3), (2, 1), (1, 1), (1, 3), (0, 3)]
    sides = [(k, (k + 1) % 8, (k + 1) % 8 + 8, k + 8) for k in range(8)]
    stone = lb.Block("u", [(*p, z) for z in (0, 1) for p in arms], [range(7, -1, -1), range(8, 16), *sides])
    between = lb.Block.box("b", (0.5, 0.5, 0.5), (1.5, 2.0, 0.5))
    drawn = [(corners(stone), 0), (corners(between, inward=True), 0)]
    found = lb.files.read_blocks(gltf(tmp_path / "a.gltf", drawn, {}))
    assert [block.volume for block in found.blocks] == pytest.approx([7.0, 0.125])
    assert found.notes[-1].endswith("all faces pointed inward and are turned")


def test_each_solid_of_a_mesh_has_the_material_of_most_of_its_faces(tmp_path):
    other = lb.Block.box("b", (1.0, 1.0, 1.0), (5.0, 0.0, 0.5))
    face = slice(0, 2)
    drawn = [(corners(BOX, face), 1), (corners(BOX, slice(2, None)), 0), (corners(other), 1)]
    found = lb.files.read_blocks(
        gltf(tmp_path / "a.gltf", drawn, {}), unit_weight={"stone": 2e4, "plaster": 1e4}
    )
    assert [(b.layer, b.weight) for b in found.blocks] == [
        ("stone", pytest.approx(6 * 2e4)),
        ("plaster", pytest.approx(1e4)),
    ]


def test_what_gltf_does_not_show_or_draw_is_named(tmp_path):
    lines = {"primitives": [{"attributes": {"POSITION": 0}, "mode": 1}]}
    path = gltf(tmp_path / "a.gltf", [(corners(BOX), 0)], {})
    document = json.loads(path.read_text())
    document["meshes"].append(lines)
    document["nodes"] += [{"name": "wires", "mesh": 1}, {"name": "elsewhere", "mesh": 0}]
    document["scenes"][0]["nodes"] = [0, 1]
    path.write_text(json.dumps(document))
    found = lb.files.read_blocks(path)
    assert len(found.blocks) == 1
    assert found.notes == (
        "left out: node 'wires' has no triangles",
        "left out: 1 node outside the scene that is shown",
    )
    assert found.left_out == ("1 node outside the scene that is shown",)


@pytest.mark.parametrize(
    ("node", "said"),
    [
        ({"weights": [0.0, 0.5]}, "node 'one' has weights of morph targets; save it with them applied"),
        (
            {"matrix": [1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]},
            "node 'one': the last row of its matrix is [5.0, 0.0, 0.0, 1.0]; expected 0, 0, 0, 1",
        ),
    ],
)
def test_nodes_that_move_vertices_otherwise_are_refused(tmp_path, node, said):
    with pytest.raises(lb.ModelError) as error:
        lb.files.read_blocks(gltf(tmp_path / "a.gltf", [(corners(BOX), 0)], node))
    assert said in str(error.value)


@pytest.mark.parametrize("word", ["usemtl", "g"])
def test_an_obj_object_may_have_faces_of_several_materials_and_groups(tmp_path, word):
    """As painted stones from Blender: the object is the block, its layer that of most faces."""
    lines = [f"v {x} {y} {z}" for x, y, z in BOX.vertices.tolist()]
    faces = ["f " + " ".join(str(v + 1) for v in face) for face in BOX.faces]
    other = [f"v {x + 5} {y} {z}" for x, y, z in BOX.vertices.tolist()]
    beside = ["f " + " ".join(str(v + 9) for v in face) for face in BOX.faces]
    drawn = [f"{word} plaster", *faces[:2], f"{word} stone", *faces[2:], f"{word} brick", *beside]
    path = tmp_path / "a.obj"
    path.write_text("\n".join(["o one", *lines, *other, *drawn]))
    found = lb.files.read_blocks(path)
    assert [(b.name, b.layer, b.volume) for b in found.blocks] == [
        ("one", "stone", pytest.approx(6.0)),
        ("one 2", "brick", pytest.approx(6.0)),
    ]


def test_a_face_that_crosses_itself_is_told_as_such(tmp_path):
    points = [(x, y, z) for y in (0.0, 1.0) for x, z in ((0, 0), (1, 1), (1, 0), (0, 1))]
    faces = [(0, 1, 2, 3), (7, 6, 5, 4), *((k, k + 4, (k + 1) % 4 + 4, (k + 1) % 4) for k in range(4))]
    lines = [f"v {x} {y} {z}" for x, y, z in points]
    lines += ["f " + " ".join(str(v + 1) for v in face) for face in faces]
    path = tmp_path / "bow.obj"
    path.write_text("\n".join(lines))
    with pytest.raises(lb.ModelError) as error:
        lb.files.read_blocks(path)
    assert "a face crosses itself, and has no area: (0, 0, 0), (1, 0, 1), (1, 0, 0), (0, 0, 1)" in str(
        error.value
    )


def test_a_hollow_block_inside_out_keeps_its_cavity(tmp_path):
    meshes = [trimesh.Trimesh(one.vertices, one.triangles, process=False) for one in (BOX, HOLLOW)]
    meshes[0].faces = meshes[0].faces[:, ::-1]
    trimesh.util.concatenate(meshes).export(tmp_path / "a.ply")
    (block,) = lb.files.read_blocks(tmp_path / "a.ply").blocks
    assert block.volume == pytest.approx(6.0 - 0.125)


def test_a_cavity_is_of_the_nearest_solid_around_it(tmp_path):
    """A hollow box within the cavity of another, as of a reliquary in its shrine."""
    shells = [trimesh.creation.box((side,) * 3) for side in (4.0, 3.0, 2.0, 1.0)]
    for cavity in shells[1::2]:
        cavity.faces = cavity.faces[:, ::-1]
    trimesh.util.concatenate(shells).export(tmp_path / "a.ply")
    found = lb.files.read_blocks(tmp_path / "a.ply")
    assert [block.volume for block in found.blocks] == pytest.approx([64.0 - 27.0, 8.0 - 1.0])


#: Stones one on the other with equal faces, so that every joint has its edges twice.
STONES = [lb.Block.box(f"{k}", (1.0, 0.5, 0.5), (0.0, 0.0, 0.5 * k + 0.25)) for k in range(5)]


def repeated(vertices, faces):
    return vertices, [*faces, faces[0]]


def without_area(vertices, faces):
    return vertices, [faces[0], [faces[0][0], faces[0][0], faces[0][1]], *faces[1:]]


def cracked(vertices, faces):
    """A corner of one triangle is 0.05 mm off."""
    return [*vertices, vertices[faces[0][0]] + [0.0, 0.0, 5e-5]], [[len(vertices), *faces[0][1:]], *faces[1:]]


def with_a_vertex_on_a_side(vertices, faces):
    (a, b, c), new = faces[0], len(vertices)
    return [*vertices, (vertices[a] + vertices[b]) / 2], [[a, new, c], [new, b, c], *faces[1:]]


def opened(vertices, faces):
    return vertices, faces[1:]


def stones_in(path, flaw, which):
    """A file of triangles, stone after stone, `flaw` in some of them; its suffix says the format."""
    bodies = [(block.vertices, block.triangles.tolist()) for block in STONES]
    bodies = [flaw(*body) if k in which else body for k, body in enumerate(bodies)]
    meshes = [trimesh.Trimesh(vertices, faces, process=False) for vertices, faces in bodies]
    if path.suffix == ".dxf":
        drawing = ezdxf.new(units=6)
        for corners in np.concatenate([mesh.triangles for mesh in meshes]):
            drawing.modelspace().add_3dface(corners)
        drawing.saveas(path)
    else:
        trimesh.util.concatenate(meshes).export(path)
    return path


@pytest.mark.parametrize("suffix", [".ply", ".stl", ".dxf", ".obj"])
@pytest.mark.parametrize("flaw", [repeated, without_area, cracked, with_a_vertex_on_a_side])
@pytest.mark.parametrize("which", [(2,), (0, 2), (4,)])
def test_a_flaw_of_one_stone_leaves_those_that_touch_it_as_they_are(suffix, flaw, which, tmp_path):
    found = lb.files.read_blocks(stones_in(tmp_path / f"a{suffix}", flaw, which), up="z")
    middles = [block.centroid.tolist() for block in found.blocks]
    assert middles == [pytest.approx([0.0, 0.0, 0.5 * k + 0.25], abs=1e-5) for k in range(5)]
    assert [block.volume for block in found.blocks] == pytest.approx([0.25] * 5, rel=1e-4)
    named = [found.blocks[k].name for k in which]
    assert {note.split("'")[1] for note in found.notes if note.startswith("block '")} == set(named)


def test_stones_that_touch_may_all_have_a_face_without_area(tmp_path):
    found = lb.files.read_blocks(stones_in(tmp_path / "a.stl", without_area, range(5)), up="z")
    assert [block.volume for block in found.blocks] == pytest.approx([0.25] * 5)


def test_a_stone_inside_out_on_a_larger_one_is_no_cavity_of_it(tmp_path):
    """Its lowest corners are in a face of the other, round which it winds half."""
    small = lb.Block.box("small", (0.5, 0.5, 0.5), (0.5, 1.0, 3.25))
    meshes = [trimesh.Trimesh(one.vertices, one.triangles, process=False) for one in (BOX, small)]
    meshes[1].faces = meshes[1].faces[:, ::-1]
    trimesh.util.concatenate(meshes).export(tmp_path / "a.ply")
    found = lb.files.read_blocks(tmp_path / "a.ply", up="z")
    assert [block.volume for block in found.blocks] == pytest.approx([6.0, 0.125])


@pytest.mark.parametrize("suffix", [".ply", ".stl", ".dxf", ".obj"])
@pytest.mark.parametrize("which", [0, 2, 4])
def test_an_open_stone_is_named_by_itself(suffix, which, tmp_path):
    path = stones_in(tmp_path / f"a{suffix}", opened, [which])
    with pytest.raises(lb.ModelError) as error:
        lb.files.read_blocks(path, up="z")
    said, why = error.value.problems
    assert "1 of 5 blocks is bad" in said
    assert "the surface is open" in why
    found = lb.files.read_blocks(path, up="z", skip_bad=True)
    heights = [block.centroid[2] for block in found.blocks]
    assert heights == pytest.approx([0.5 * k + 0.25 for k in range(5) if k != which])


def alternating(*blocks):
    """One mesh of blocks with as many triangles each, a triangle of every block in turn."""
    meshes = [trimesh.Trimesh(block.vertices, block.triangles, process=False) for block in blocks]
    mesh = trimesh.util.concatenate(meshes)
    mesh.faces = mesh.faces.reshape(len(blocks), -1, 3).swapaxes(0, 1).reshape(-1, 3)
    return mesh


def rounded(mesh):
    """The triangles with corners of their own, off by up to 1e-7 m."""
    corners = mesh.triangles + 1e-7 * np.random.default_rng(0).uniform(-1.0, 1.0, mesh.triangles.shape)
    return trimesh.Trimesh(corners.reshape(-1, 3), np.arange(corners.size // 3).reshape(-1, 3), process=False)


def stone_at(z, side=1.0):
    return lb.Block.box("a", (side, side, side), (0.0, 0.0, z))


#: What tells the solids apart: vertices of their own, places, these but for rounding, the order of faces.
MERGED = {
    "own vertices, touching": ("ply", alternating(stone_at(0.5), stone_at(1.5))),
    "places, apart": ("stl", alternating(stone_at(0.5), stone_at(2.5))),
    "places but for rounding, apart": ("ply", rounded(alternating(stone_at(0.5), stone_at(2.5)))),
    "order, touching, rounded": ("ply", rounded(trimesh.util.concatenate([
        trimesh.Trimesh(stone_at(z).vertices, stone_at(z).triangles, process=False) for z in (0.5, 1.5)
    ]))),
}  # fmt: skip


@pytest.mark.parametrize("name", MERGED)
def test_two_solids_of_one_mesh_are_told_apart(name, tmp_path):
    suffix, mesh = MERGED[name]
    mesh.export(tmp_path / f"a.{suffix}")
    found = lb.files.read_blocks(tmp_path / f"a.{suffix}")
    assert [block.volume for block in found.blocks] == pytest.approx([1.0, 1.0], rel=1e-5)


def test_small_stones_on_a_large_ground_are_told_apart_before_vertices_are_merged(tmp_path):
    """Vertices within 1e-6 of the whole are one at last: 2 cm of a ground of 20 km."""
    blocks = [lb.Block.box("g", (2e4, 2e4, 1e3), (0, 0, -500)), stone_at(0.005, 0.01), stone_at(0.015, 0.01)]
    meshes = [trimesh.Trimesh(block.vertices, block.triangles, process=False) for block in blocks]
    trimesh.util.concatenate(meshes).export(tmp_path / "a.stl")
    found = lb.files.read_blocks(tmp_path / "a.stl", units="m", up="z")
    assert [block.volume for block in found.blocks] == pytest.approx([4e11, 1e-6, 1e-6])


@pytest.mark.parametrize("suffix", ["obj", "ply"])
def test_a_solid_whose_faces_are_all_drawn_twice_is_one(tmp_path, suffix):
    path = tmp_path / f"twice.{suffix}"
    corners, faces = BOX.vertices.tolist(), 2 * [list(face) for face in BOX.faces]
    if suffix == "obj":
        rows = [f"v {x} {y} {z}" for x, y, z in corners]
        rows += ["f " + " ".join(str(k + 1) for k in face) for face in faces]
    else:
        rows = ["ply", "format ascii 1.0", f"element vertex {len(corners)}"]
        rows += [f"property float {axis}" for axis in "xyz"]
        rows += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
        rows += [" ".join(map(str, corner)) for corner in corners]
        rows += [" ".join(map(str, (len(face), *face))) for face in faces]
    path.write_text("\n".join(rows) + "\n")
    read = lb.files.read_blocks(path)
    assert [block.volume for block in read.blocks] == pytest.approx([1.0 * 2.0 * 3.0])
    assert any("6 of 12 faces repeat another one" in note for note in read.notes)

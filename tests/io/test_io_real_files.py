"""Files as other programs write them, in their styles: each is read, or refused with a remedy that works."""

import json

import numpy as np
import pytest
import rhino3dm

import limitblocks as lb

BOX = lb.Block.box("a", (1.0, 2.0, 3.0), (0.0, 0.0, 1.5))


def curve(points):
    line = rhino3dm.Polyline()
    for x, y in [*points, points[0]]:
        line.Add(x, y, 0.0)
    return line.ToPolylineCurve()


def framed(holes, visible=True):
    """Return a Rhino model of a slab 4 x 2 x 0.5 m with square holes of 0.5 m: polysurfaces with holes."""
    slab = rhino3dm.Extrusion.Create(curve([(0, 0), (4, 0), (4, 2), (0, 2)]), 0.5, True)
    for x in holes:
        assert slab.AddInnerProfile(curve([(x, 0.5), (x, 1.0), (x + 0.5, 1.0), (x + 0.5, 0.5)]))
    model = rhino3dm.File3dm()
    model.Settings.ModelUnitSystem = rhino3dm.UnitSystem.Meters
    layer = rhino3dm.Layer()
    layer.Name, layer.Visible = "slabs", visible
    attributes = rhino3dm.ObjectAttributes()
    attributes.LayerIndex, attributes.Name = model.Layers.Add(layer), "slab"
    brep = slab.ToBrep(True)
    assert max(len(face.Loops) for face in brep.Faces) == 1 + len(holes)
    model.Objects.AddBrep(brep, attributes)
    return model


@pytest.mark.parametrize("holes", [(), (0.5,), (0.5, 2.0, 3.0)])
def test_rhino_faces_with_holes(tmp_path, holes):
    framed(holes).Write(str(tmp_path / "a.3dm"), 7)
    block = lb.files.read_blocks(tmp_path / "a.3dm").blocks[0]
    assert block.volume == pytest.approx(0.5 * (4.0 * 2.0 - 0.25 * len(holes)))


def test_what_is_hidden_in_rhino_is_read_when_switched_on(tmp_path):
    """The remedy that the error names works when it is followed."""
    model = framed((0.5,), visible=False)
    model.Write(str(tmp_path / "a.3dm"), 7)
    with pytest.raises(lb.ModelError, match=r"1 hidden objects.*switch on what is hidden"):
        lb.files.read_blocks(tmp_path / "a.3dm")
    model.Layers[0].Visible = True
    model.Write(str(tmp_path / "b.3dm"), 7)
    assert len(lb.files.read_blocks(tmp_path / "b.3dm").blocks) == 1


def test_blender_obj_with_y_up_groups_and_smoothing(tmp_path):
    """Comments, mtllib, vt, vn, s, y up; corners v/vt/vn, counted back from the last."""
    lines = ["# Blender v3.6.5", "mtllib wall.mtl"]
    for name, x in (("Cube.001", 0.0), ("Cube.002", 5.0)):
        lines += [f"o {name}", f"g {name}_stone"]
        lines += [f"v {px + x:.6f} {pz:.6f} {-py:.6f}" for px, py, pz in BOX.vertices.tolist()]
        lines += ["vt 0.0 0.0", "vn 0.0 1.0 0.0", "usemtl Stone", "s off"]
        lines += ["f " + " ".join(f"{v - 8}/-1/-1" for v in face) for face in BOX.faces]
        lines += ["s 1", "l -1 -2"]
    (tmp_path / "wall.obj").write_text("\n".join(lines))
    found = lb.files.read_blocks(tmp_path / "wall.obj", up="y")
    assert [block.name for block in found.blocks] == ["Cube.001", "Cube.002"]
    assert np.ptp(found.blocks[0].vertices, axis=0) == pytest.approx([1.0, 2.0, 3.0])
    assert found.blocks[1].volume == pytest.approx(6.0)


def test_a_scan_is_read_coarse_and_refused_fine(tmp_path):
    """Photogrammetry: one noisy surface in binary PLY with colours; the error says to make it coarser."""
    rng = np.random.default_rng(0)
    for n, most in ((3, 5000), (40, 0)):
        grid = [(i, j) for i in range(n) for j in range(n)]
        faces = []
        for axis in range(3):
            for side in (0, n):
                for i, j in grid:
                    quad = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                    places = [np.roll([side, u, v], axis) for u, v in (quad if side else quad[::-1])]
                    faces += [places[:3], [places[0], places[2], places[3]]]
        points, number = np.unique(np.reshape(faces, (-1, 3)), axis=0, return_inverse=True)
        table = np.zeros(len(points), [("p", "<f4", 3), ("colour", "u1", 3)])
        table["p"] = points / n + 0.1 / n * rng.uniform(-1.0, 1.0, points.shape)
        rows = np.zeros(len(faces), [("n", "u1"), ("v", "<i4", 3)])
        rows["n"], rows["v"] = 3, number.reshape(-1, 3)
        head = (
            f"ply\nformat binary_little_endian 1.0\ncomment VCGLIB generated\nelement vertex {len(points)}\n"
            "property float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
            f"property uchar blue\nelement face {len(faces)}\n"
            "property list uchar int vertex_indices\nend_header\n"
        )
        (tmp_path / "scan.ply").write_bytes(head.encode() + table.tobytes() + rows.tobytes())
        if most:
            assert lb.files.read_blocks(tmp_path / "scan.ply").blocks[0].volume == pytest.approx(1.0, abs=0.1)
        else:
            with pytest.raises(lb.ModelError, match="make the mesh coarser"):
                lb.files.read_blocks(tmp_path / "scan.ply")


def mesh(block):
    points = {str(k): dict(zip("xyz", v, strict=True)) for k, v in enumerate(block.vertices.tolist())}
    return {"vertex": points, "face": {str(k): list(face) for k, face in enumerate(block.faces)}}


def test_compas_meshes_wrapped_twice_and_problems_of_compas_dem(tmp_path):
    """COMPAS 0.18 wrapped the data of a mesh twice; a problem of compas_dem holds its model."""
    old = {
        "dtype": "compas.datastructures/Mesh",
        "value": {"data": mesh(BOX), "datatype": "Mesh", "compas": "0"},
    }
    file = tmp_path / "old.json"
    file.write_text(json.dumps([old, old]))
    assert [block.volume for block in lb.files.read_blocks(file).blocks] == pytest.approx([6.0, 6.0])
    shape = {"dtype": "compas.datastructures/Mesh", "data": mesh(BOX)}
    block = {
        "dtype": "compas_dem.elements/Block",
        "guid": "1",
        "data": {"geometry": shape, "is_support": True},
    }
    model = {"dtype": "compas_dem.models/BlockModel", "data": {"elements": {"1": block}, "tree": {}}}
    file.write_text(
        json.dumps({"dtype": "compas_dem.problem/Problem", "data": {"name": "p", "model": model}})
    )
    found = lb.files.read_blocks(file)
    assert (len(found.blocks), len(found.supports)) == (1, 1)


@pytest.mark.parametrize(
    ("suffix", "word"), [(".ifc", "IfcConvert"), (".dwg", "DXF"), (".skp", "OBJ"), (".blend", "OBJ")]
)
def test_formats_that_are_not_read_say_how_to_get_meshes(tmp_path, suffix, word):
    with pytest.raises(lb.ModelError, match=word):
        lb.files.read_blocks(tmp_path / f"house{suffix}")

"""Drawings in the styles of other programs: read, or refused with a remedy that works when it is followed."""

import re

import ezdxf
import numpy as np
import pytest
import rhino3dm
from ezdxf.render.forms import cube
from manifold3d import Manifold, Mesh
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks.cli import app

JOINT = lb.OrdunaLourenco(0.6)
LIVE = lb.mass_proportional((1.0, 0.0, 0.0))


def run(*words):
    """Run the command line; return exit code and all that it says."""
    done = CliRunner().invoke(app, [str(word) for word in words], env={"COLUMNS": "400"})
    return done.exit_code, done.output


def pillar(stones=4):
    """A base and a pillar of cubes: it turns over at width over height."""
    base = lb.Block.box("base", (2.0, 1.0, 0.5), (0.0, 0.0, -0.25))
    return [base, *(lb.Block.box(f"s{k}", (1.0, 1.0, 1.0), (0.0, 0.0, k + 0.5), 2e4) for k in range(stones))]


# Rhino


def slab(hole):
    """A slab 2 m x 1 m x .5 m with its corner at the origin and a square hole of .5 m: a face with a hole."""

    def profile(points):
        line = rhino3dm.Polyline()
        for x, y in [*points, points[0]]:
            line.Add(x, y, 0.0)
        return line.ToPolylineCurve()

    shape = rhino3dm.Extrusion.Create(profile([(0, 0), (2, 0), (2, 1), (0, 1)]), 0.5, True)
    if hole:
        assert shape.AddInnerProfile(profile([(0.2, 0.25), (0.2, 0.75), (0.7, 0.75), (0.7, 0.25)]))
    return shape.ToBrep(True)


class Rhino:
    """A file as Rhino users draw it: layers within layers, blocks in blocks."""

    def __init__(self):
        self.model = rhino3dm.File3dm()
        self.model.Settings.ModelUnitSystem = rhino3dm.UnitSystem.Centimeters

    def layer(self, name, visible=True, above=None):
        layer = rhino3dm.Layer()
        layer.Name, layer.Visible = name, visible
        if above is not None:
            layer.ParentLayerId = self.model.Layers[above].Id
        return self.model.Layers.Add(layer)

    def about(self, name, layer, visible=True):
        about = rhino3dm.ObjectAttributes()
        about.Name, about.LayerIndex, about.Visible = name, layer, visible
        return about

    def definition(self, name, shape, about):
        self.model.InstanceDefinitions.Add(name, "", "", "", rhino3dm.Point3d(0, 0, 0), (shape,), (about,))
        return next(one.Id for one in self.model.InstanceDefinitions if one.Name == name)

    def place(self, key, matrix, about):
        transform = rhino3dm.Transform.Identity()
        for i, j in np.ndindex(3, 4):
            setattr(transform, f"M{i}{j}", float(matrix[i][j]))
        self.model.Objects.Add(rhino3dm.InstanceReference(key, transform), about)


def test_rhino_blocks_in_blocks_mirrored_and_hidden(tmp_path):
    """Instances within an instance, mirrored and scaled; objects and layers that are hidden; in cm."""
    rhino = Rhino()
    walls = rhino.layer("walls")
    north, off = rhino.layer("north", above=walls), rhino.layer("off", visible=False)
    inner = rhino.definition("slab", slab(hole=True), rhino.about("inner", north))
    shift = rhino3dm.Transform.Translation(0.0, 0.0, 1.0)
    nested = rhino3dm.InstanceReference(inner, shift)
    outer = rhino.definition("raised", nested, rhino.about("", walls))
    mirror = [[-100, 0, 0, 0], [0, 100, 0, 0], [0, 0, 100, 0]]
    turned = [[0, -100, 0, 500], [100, 0, 0, 0], [0, 0, 200, 0]]
    rhino.place(outer, mirror, rhino.about("mirrored", walls))
    rhino.place(outer, turned, rhino.about("turned", walls))
    rhino.place(outer, mirror, rhino.about("no", off))
    rhino.place(inner, mirror, rhino.about("no", walls, visible=False))
    rhino.model.Objects.AddBrep(slab(hole=True), rhino.about("no", off))
    rhino.model.Write(str(tmp_path / "a.3dm"), 7)
    found = lb.files.read_blocks(tmp_path / "a.3dm")
    assert [(block.name, block.layer) for block in found.blocks] == [
        ("mirrored", "walls::north"),
        ("turned", "walls::north"),
    ]
    solid = 2.0 * 1.0 * 0.5 - 0.5**3
    assert [block.volume for block in found.blocks] == pytest.approx([solid, 2.0 * solid], rel=1e-9)
    lever = (
        2.0 * 1.0 * 0.5 * 1.0 - 0.5**3 * 0.45
    ) / solid  # of the slab from its end, with the hole off centre
    assert found.blocks[0].centroid == pytest.approx([-lever, 0.5, 1.25], rel=1e-9)
    assert found.blocks[1].centroid == pytest.approx([4.5, lever, 2.5], rel=1e-9)
    assert found.left_out == ("3 hidden objects",)


def test_a_rhino_pillar_without_its_hidden_stone_says_so_and_stands_when_shown(tmp_path):
    """The remedy of the error, to show what is hidden, is followed."""
    rhino = Rhino()
    stones = rhino.layer("stones")
    unit = rhino.definition("unit", slab(hole=False), rhino.about("", stones))
    abouts = [rhino.about(f"s{k}", stones, visible=k != 1) for k in range(3)]
    for k, about in enumerate(abouts):
        rhino.place(unit, [[100, 0, 0, 0], [0, 100, 0, 0], [0, 0, 100, 50 * k]], about)
    rhino.model.Write(str(tmp_path / "a.3dm"), 7)
    words = {"joint": JOINT, "supports": "s0", "unit_weight": 2e4, "live": LIVE}
    with pytest.raises(lb.ModelError, match=r"floating: .*'s2'.*left out .*: 1 hidden objects; .*show them"):
        lb.read(tmp_path / "a.3dm", **words)
    for item in rhino.model.Objects:
        if item.Attributes.Name == "s1":
            item.Attributes.Visible = True
    rhino.model.Write(str(tmp_path / "b.3dm"), 7)
    found = lb.bounds(lb.read(tmp_path / "b.3dm", **words))
    assert found.lower == pytest.approx(0.6, rel=1e-6)  # 2 m wide over 1 m high: it slides


# DXF


def test_dxf_inserts_of_polyfaces_nested_scaled_and_mirrored(tmp_path):
    """A pillar of polyface meshes in references within references; one is mirrored, one scaled."""
    drawing = ezdxf.new(units=4)
    unit = drawing.blocks.new("unit")
    mesh = cube()
    mesh.translate(0.5, 0.5, 0.5)
    mesh.render_polyface(unit, {"layer": "0"})
    two = drawing.blocks.new("two")
    two.add_blockref("unit", (0, 0, 0), {"layer": "0"})
    two.add_blockref("unit", (0, 0, 1), {"layer": "0", "xscale": -1}).translate(1, 0, 0)
    space = drawing.modelspace()
    size = {"xscale": 1000, "yscale": 1000, "zscale": 1000}
    space.add_blockref(
        "unit", (-500, 0, -500), {"layer": "BASE", "xscale": 2000, "yscale": 1000, "zscale": 500}
    )
    space.add_blockref("two", (0, 0, 0), {"layer": "STONES"} | size)
    space.add_blockref("two", (0, 1000, 2000), {"layer": "STONES"} | size | {"yscale": -1000})
    drawing.saveas(tmp_path / "a.dxf")
    found = lb.files.read_blocks(tmp_path / "a.dxf", unit_weight={"STONES": 2e4})
    assert sorted(found.layers.values()) == ["BASE", *["STONES"] * 4]
    assert [block.volume for block in found.blocks] == pytest.approx([1.0] * 5, rel=1e-9)
    model = lb.read(tmp_path / "a.dxf", joint=JOINT, supports="layer:BASE", unit_weight=2e4, live=LIVE)
    assert lb.bounds(model).lower == pytest.approx(1.0 / 4.0, rel=1e-6)


def test_a_3dsolid_that_is_refused_is_read_as_the_mesh_it_is_converted_to(tmp_path):
    """The error names handle and layer of the 3DSOLID and says MESHSMOOTH; here its mesh takes its place."""
    drawing = ezdxf.new("R2000", units=6)
    space = drawing.modelspace()
    cube().render_mesh(space, {"layer": "good"})
    solid = cube().render_3dsolid(space, {"layer": "ground"})
    solid.sat = [line.replace("plane-surface", "cone-surface", 1) for line in solid.sat]
    drawing.saveas(tmp_path / "a.dxf")
    with pytest.raises(lb.ModelError) as raised:
        lb.files.read_blocks(tmp_path / "a.dxf")
    said = str(raised.value)
    assert f"3DSOLID {solid.dxf.handle} on layer 'ground'" in said
    assert "convert it to a mesh (MESHSMOOTH" in said
    space.delete_entity(solid)
    mesh = cube()
    mesh.translate(0, 0, -1)
    mesh.render_mesh(space, {"layer": "ground"})
    drawing.saveas(tmp_path / "b.dxf")
    model = lb.read(tmp_path / "b.dxf", joint=JOINT, supports="ground", unit_weight=2e4, live=LIVE)
    assert lb.bounds(model).lower == pytest.approx(0.6, rel=1e-6)  # a cube slides before it turns


# OBJ of Blender


def test_a_wall_from_blender_lies_on_its_side_until_it_is_turned(tmp_path):
    """Y up, six digits, smoothing, normals, a material each: the guess is told, and the answer is right."""
    wall = lb.structures.wall(JOINT, length=2.4, courses=6)
    lines = ["# Blender 4.1.1", "# www.blender.org", "mtllib wall.mtl"]
    first = 1
    for k, block in enumerate(wall.blocks):
        lines += [f"o Cube.{k:03d}", *(f"v {x:.6f} {z:.6f} {-y:.6f}" for x, y, z in block.vertices.tolist())]
        lines += [f"vn {x:.4f} {z:.4f} {-y:.4f}" for x, y, z in block.normals.tolist()]
        lines += ["vt 0.625000 0.500000", f"g Wall_{k % 2}", "usemtl Stone", f"s {k % 2}"]
        lines += [" ".join(["f", *(f"{first + v}/1/1" for v in face)]) for face in block.faces]
        first += len(block.vertices)
    (tmp_path / "wall.obj").write_text("\n".join(lines))
    (tmp_path / "wall.mtl").write_text("newmtl Stone\nKd 0.501961 0.400000 0.301961\n")
    code, said = run("look", tmp_path / "wall.obj")
    assert code == 0
    assert "Y, guessed" in said
    names = {f"Cube.{k:03d}" for k, block in enumerate(wall.blocks) if block.name in wall.supports}
    model = lb.read(
        tmp_path / "wall.obj", joint=JOINT, supports=lambda block: block.name in names, unit_weight=20e3,
        live=LIVE, up="y",
    )  # fmt: skip
    assert {block.colour for block in model.blocks} == {"#80664d"}
    assert {block.layer for block in model.blocks} == {"Wall_0", "Wall_1"}
    clean = lb.Model(wall.blocks, wall.supports, wall.interfaces, wall.dead, LIVE)
    assert lb.bounds(model).lower == pytest.approx(lb.bounds(clean).lower, rel=1e-4)


# a scan


def scanned(block, n, noise, rng):
    """Return vertices and 12 n^2 triangles of a box, every coordinate off by up to `noise`."""
    low, high = block.vertices.min(axis=0), block.vertices.max(axis=0)
    u, v = np.divmod(np.arange(n * n), n)
    corners = np.stack([[u, v], [u + 1, v], [u + 1, v + 1], [u, v + 1]])  # (4, 2, n^2)
    faces = []
    for axis in range(3):
        for side in (0, n):
            quad = np.insert(corners if side else corners[::-1], 0, side, axis=1)
            quad = np.roll(quad, axis, axis=1).transpose(2, 0, 1)
            faces += [quad[:, :3], quad[:, [0, 2, 3]]]
    places = np.concatenate(faces)
    points, number = np.unique(places.reshape(-1, 3), axis=0, return_inverse=True)
    points = low + (high - low) * points / n
    return points + noise * rng.uniform(-1.0, 1.0, points.shape), number.reshape(-1, 3)


def write_scan(path, meshes):
    """Write meshes as MeshLab does: binary PLY in single precision, with colours of vertices."""
    first = np.cumsum([0, *(len(points) for points, _ in meshes)])
    points = np.concatenate([points for points, _ in meshes])
    faces = np.concatenate([faces + k for (_, faces), k in zip(meshes, first[:-1], strict=True)])
    table = np.zeros(len(points), [("p", "<f4", 3), ("colour", "u1", 4)])
    table["p"], table["colour"] = points, np.arange(len(points))[:, None] % 200
    rows = np.zeros(len(faces), [("n", "u1"), ("v", "<i4", 3)])
    rows["n"], rows["v"] = 3, faces
    kinds = "".join(f"property float {axis}\n" for axis in "xyz")
    kinds += "".join(f"property uchar {part}\n" for part in ("red", "green", "blue", "alpha"))
    path.write_bytes(
        b"ply\nformat binary_little_endian 1.0\ncomment VCGLIB generated\n"
        + f"element vertex {len(points)}\n{kinds}element face {len(faces)}\n".encode()
        + b"property list uchar int vertex_indices\nend_header\n"
        + table.tobytes()
        + rows.tobytes()
    )
    return len(faces)


def test_a_scan_of_a_hundred_thousand_triangles_is_decimated_healed_and_right(tmp_path):
    """Refused twice: too fine, then too rough; decimation (here by manifold3d) and --heal, as it says, do."""
    rng = np.random.default_rng(7)
    meshes = [scanned(block, 46, 2e-4, rng) for block in pillar(3)]
    assert write_scan(tmp_path / "scan.ply", meshes) > 100_000
    with pytest.raises(lb.ModelError, match=r"more than 5000 plane faces.*make the mesh coarser.*decimation"):
        lb.files.read_blocks(tmp_path / "scan.ply")
    coarse = []
    for points, faces in meshes:
        found = Manifold(Mesh(points.astype(np.float32), faces.astype(np.uint32))).simplify(1.2e-3).to_mesh()
        coarse.append((found.vert_properties[:, :3], found.tri_verts.astype(np.int64)))
    write_scan(tmp_path / "coarse.ply", coarse)
    words = ["--supports", "z<0.1", "--friction", "0.6", "--unit-weight", "20e3", "--live", "1,0,0"]
    code, said = run("import", tmp_path / "coarse.ply", *words)
    if code:
        assert "import --heal" in said
        code, said = run("import", tmp_path / "coarse.ply", *words, "--heal")
    assert code == 0, said
    assert lb.bounds(lb.read(tmp_path / "coarse.json")).lower == pytest.approx(1.0 / 3.0, rel=0.01)


# a vault with overlaps, after the pavilion vault of compas_dem


def test_a_vault_with_overlaps_is_taken_with_the_gap_that_the_error_names(tmp_path):
    """Joints that meet exactly but for stones a little too large: one line has the gap for all of them."""
    vault = lb.structures.barrel_vault(JOINT, radius=0.2, thickness=0.03, length=0.2, courses=11, stones=3)
    grown = []
    for k, block in enumerate(vault.blocks):
        by = 1.0 + 4e-3 * (k % 5 == 2 and block.name not in vault.supports)
        about = block.centroid
        grown.append(lb.Block(block.name, about + by * (block.vertices - about), block.faces))
    lb.files.write_blocks(grown, tmp_path / "vault.obj")
    supports = [part for name in vault.supports for part in ("--supports", f"name:{name}")]
    words = [*supports, "--friction", "0.6", "--unit-weight", "20e3", "--live", "1,0,0"]
    code, said = run("import", tmp_path / "vault.obj", *words)
    assert code == 2
    first = said.splitlines()[0]
    gap = re.search(r"\d+ pairs of blocks overlap, .*\(--gap ([0-9.e-]+), block lengths\)", first)[1]
    code, said = run("import", tmp_path / "vault.obj", *words, "--gap", gap)
    assert code == 0, said
    clean = lb.bounds(lb.Model(vault.blocks, vault.supports, vault.interfaces, vault.dead, LIVE)).lower
    assert lb.bounds(lb.read(tmp_path / "vault.json")).lower == pytest.approx(clean, rel=0.01)

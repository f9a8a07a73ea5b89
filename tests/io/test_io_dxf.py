import io
import random
import sys
from dataclasses import replace

import ezdxf
import numpy as np
import pytest
from dxf_files import STRUCTURES, drawn
from ezdxf.render.forms import cube, cylinder
from reading import fault, outcome

import limitblocks as lb


def test_written_file_is_sound_and_in_metres(tmp_path):
    drawing = ezdxf.readfile(lb.files.write_blocks(STRUCTURES["arch"], tmp_path / "a.dxf"))
    assert drawing.units == 6
    assert not drawing.audit().errors
    assert {mesh.dxf.layer for mesh in drawing.modelspace().query("MESH")} == {"support", "block"}


def test_names_and_layers_that_dxf_does_not_allow(tmp_path):
    box = lb.Block.box("a\nb  Ä", (1, 1, 1), (0, 0, 0))
    written = lb.files.ImportedBlocks((replace(box, layer="x|y:z"),))
    imported = lb.files.read_blocks(lb.files.write_blocks(written, tmp_path / "a.dxf"))
    assert [block.name for block in imported.blocks] == ["a b Ä"]
    assert set(imported.layers.values()) == {"x_y_z"}


def everything(space):
    for k, draw in enumerate(("render_mesh", "render_polyface", "render_3dfaces", "render_3dsolid")):
        for height in (0, 1):  # two that touch
            mesh = cube()
            mesh.translate(3 * k, 0, height)
            getattr(mesh, draw)(space, {"layer": draw})


@pytest.mark.parametrize("binary", [False, True])
@pytest.mark.parametrize("version", ["R2000", "R2010", "R2018"])
def test_every_kind_of_solid(tmp_path, version, binary):
    path = drawn(tmp_path / "a.dxf", everything, version=version)
    if binary:
        ezdxf.readfile(path).saveas(path, fmt="bin")
    imported = lb.files.read_blocks(path)
    assert len(imported.blocks) == 8
    assert [block.volume for block in imported.blocks] == pytest.approx([1.0] * 8, abs=1e-9)
    middles = sorted(np.round(block.centroid, 9).tolist() for block in imported.blocks)
    assert middles == [[3.0 * k, 0.0, float(z)] for k in range(4) for z in (0, 1)]


def test_units(tmp_path):
    path = drawn(tmp_path / "mm.dxf", lambda space: cube().render_mesh(space), units=4)
    assert lb.files.read_blocks(path).blocks[0].size == pytest.approx(1e-3, rel=1e-12)
    assert lb.files.read_blocks(path, units="cm").blocks[0].size == pytest.approx(1e-2, rel=1e-12)
    (said,) = lb.files.read_blocks(path, units="cm").guesses
    assert said.endswith(
        "says that its unit is mm: taken in cm, as asked, the structure is 0.01 m large, not 0.001 m"
    )
    assert lb.files.read_blocks(path, units="mm").guesses == ()
    yards = drawn(tmp_path / "yards.dxf", lambda space: cube().render_mesh(space), units=10)
    (said,) = lb.files.read_blocks(yards, units="m").guesses
    assert said.endswith(
        "its unit is 0.9144 m: taken in m, as asked, the structure is 1 m large, not 0.9144 m"
    )
    path = drawn(tmp_path / "none.dxf", lambda space: cube().render_mesh(space), units=0)
    imported = lb.files.read_blocks(path)
    assert imported.blocks[0].size == pytest.approx(1.0, rel=1e-12)
    assert any("states no unit" in note for note in imported.notes)
    drawing = ezdxf.readfile(path)
    drawing.header["$INSUNITS"] = 99
    drawing.saveas(path)
    assert "$INSUNITS is 99; expected 0 to 17 or 21 to 24" in fault(path)


@pytest.mark.parametrize(
    ("code", "metres"),  # NIST SP 811, Appendix B: 1 in = .0254 m, 1 US survey ft = 1200/3937 m, exactly
    [
        *[(1, 0.0254), (3, 5280 * 12 * 0.0254), (8, 0.0254e-6), (9, 0.0254e-3), (10, 36 * 0.0254), (17, 1e9)],
        *[(21, 1200 / 3937), (22, 100 / 3937), (23, 3600 / 3937), (24, 5280 * 1200 / 3937)],
    ],
)
def test_a_stone_of_half_a_metre_in_every_unit(tmp_path, code, metres):
    stone = cube()
    stone.scale_uniform(0.5 / metres)
    path = drawn(tmp_path / "stone.dxf", stone.render_mesh, units=code)
    (block,) = lb.files.read_blocks(path).blocks
    assert block.size == pytest.approx(0.5, rel=1e-15)


def test_block_references_take_scale_rotation_mirror_and_layer(tmp_path):
    drawing = ezdxf.new(units=6)
    stone = drawing.blocks.new("stone", base_point=(0.5, 0.5, 0.5))
    mesh = cube()
    mesh.translate(0.5, 0.5, 0.5)  # its corner at the origin, its base point in its middle
    mesh.render_mesh(stone)
    pair = drawing.blocks.new("pair")
    pair.add_blockref("stone", (0, 0, 0))
    pair.add_blockref("stone", (0, 0, 1), {"layer": "top"})
    drawing.modelspace().add_blockref(
        "pair", (10, 0, 0), {"layer": "wall", "xscale": -2, "yscale": 3, "zscale": 4, "rotation": 90}
    )
    grid = {"row_count": 2, "column_count": 3, "row_spacing": 5, "column_spacing": 5, "layer": "grid"}
    drawing.modelspace().add_blockref("stone", (0, 20, 0), grid)
    path = tmp_path / "a.dxf"
    drawing.saveas(path)
    imported = lb.files.read_blocks(path)
    assert sorted(imported.layers.values()) == ["grid"] * 6 + ["top", "wall"]
    low, top = (
        next(b for b in imported.blocks if imported.layers[b.name] == layer) for layer in ("wall", "top")
    )
    assert low.volume == pytest.approx(24.0, rel=1e-12)
    assert np.ptp(low.vertices, axis=0) == pytest.approx([3.0, 2.0, 4.0], rel=1e-9)
    assert top.centroid == pytest.approx([10.0, 0.0, 4.0], abs=1e-9)
    assert not any("turned" in note for note in imported.notes)


def test_hidden_is_left_out_with_a_note(tmp_path):
    def draw(space):
        for layer in ("seen", "off", "frozen"):
            mesh = cube()
            mesh.translate(0, 0, len(layer))
            mesh.render_mesh(space, {"layer": layer})
        space.doc.layers.add("off").off()
        space.doc.layers.add("frozen").freeze()
        space.add_line((0, 0), (1, 1))

    imported = lb.files.read_blocks(drawn(tmp_path / "a.dxf", draw))
    assert set(imported.layers.values()) == {"seen"}
    assert imported.notes == ("left out: 1 LINE, 2 hidden entities",)


@pytest.mark.parametrize(
    ("faces", "said"),
    [(6, "no plane faces with straight edges"), (1, "faces that are not plane or edges that")],
)
def test_body_that_is_no_polyhedron_is_named(tmp_path, faces, said):
    def draw(space):
        solid = cube().render_3dsolid(space, {"layer": "stone"})
        text = "\n".join(solid.sat)
        solid.sat = text.replace("plane-surface", "cone-surface", faces).split("\n")

    message = fault(drawn(tmp_path / "a.dxf", draw, version="R2000"))
    assert "3DSOLID" in message
    assert f"it has {said}" in message
    assert "'stone'" in message
    assert "mesh" in message


def recursive(drawing):
    block = drawing.blocks.new("a")
    block.add_blockref("a", (1, 0, 0))
    drawing.modelspace().add_blockref("a", (0, 0, 0))


def huge_grid(drawing):
    drawing.blocks.new("a").add_point((0, 0))
    grid = {"row_count": 30000, "column_count": 30000, "row_spacing": 1, "column_spacing": 1}
    drawing.modelspace().add_blockref("a", (0, 0, 0), grid)


def many_by_nesting(drawing):
    for k in range(1, 9):
        block = drawing.blocks.new(f"a{k}")
        for x in range(10):
            block.add_blockref(f"a{k - 1}", (x, 0, 0)) if k > 1 else block.add_point((x, 0))
    drawing.modelspace().add_blockref("a8", (0, 0, 0))


BAD = {
    "recursive": (recursive, "contains itself"),
    "huge grid": (huge_grid, "copies; at most"),
    "missing block": (lambda d: d.modelspace().add_blockref("gone", (0, 0)), "'gone' is missing"),
    "empty": (lambda d: None, "holds no solid"),
    "open": (lambda d: cylinder(caps=False).render_mesh(d.modelspace()), "open"),
    "faces": (lambda d: d.modelspace().add_3dface([(0, 0), (1, 0), (1, 1)]), "3 vertices"),
    "nan": (lambda d: with_vertex(d, float("nan")), "finite"),
    "huge": (lambda d: with_vertex(d, 1e300), "finite numbers up to 1e30"),
    "index": (lambda d: with_faces(d, [(0, 1, 99)]), "vertex indices run from 0"),
}


def with_vertex(drawing, value):
    mesh = cube()
    mesh.vertices[0] = ezdxf.math.Vec3(value, 0, 0)
    mesh.render_mesh(drawing.modelspace())


def with_faces(drawing, faces):
    mesh = drawing.modelspace().add_mesh()
    mesh.vertices, mesh.faces = cube().vertices, faces


@pytest.mark.parametrize("case", BAD)
def test_bad_drawings_are_one_clean_error(tmp_path, case):
    make, expected = BAD[case]
    drawing = ezdxf.new(units=6)
    make(drawing)
    stream = io.StringIO()
    drawing.write(stream)
    path = tmp_path / "a.dxf"
    path.write_text(stream.getvalue(), encoding="utf-8")
    assert expected in fault(path)


def test_bad_nesting_ends(tmp_path, monkeypatch):
    monkeypatch.setattr("limitblocks.io.formats.dxf.reader.MOST_FACES", 1000)
    drawing = ezdxf.new(units=6)
    many_by_nesting(drawing)
    drawing.saveas(tmp_path / "a.dxf")
    assert "more than 1000 entities" in fault(tmp_path / "a.dxf")


def test_files_that_are_no_dxf(tmp_path):
    good = lb.files.write_blocks(STRUCTURES["wall"], tmp_path / "good.dxf").read_bytes()
    for data, expected in (
        (b"", "is empty"),
        (b"AC1032\0\0\0", "DWG"),
        (b"garbage" * 100, "is not a DXF file: it does not begin as one"),
        (good[: len(good) // 2], "not sound DXF"),
        (good.replace(b"EOF\n", b""), "not sound DXF"),
        (bytes(range(256)) * 10, "is not a DXF file: it does not begin as one"),
    ):
        path = tmp_path / "a.dxf"
        path.write_bytes(data)
        assert expected in fault(path)
        assert expected in fault(path, lb.files.read_drawing, thickness=0.2)


def test_without_ezdxf(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "ezdxf", None)
    with pytest.raises(lb.errors.MissingDependency, match="pip install 'ezdxf>=1"):
        lb.files.write_blocks(STRUCTURES["wall"], tmp_path / "a.dxf")
    with pytest.raises(lb.errors.MissingDependency, match="pip install 'ezdxf>=1"):
        lb.files.read_blocks(tmp_path / "a.dxf")


WORDS = (b"nan", b"1e400", b"-1", b"99999999", b"0", b"", b"INSERT", b"1e308", b"\xff\xfe", b"x")


def damaged(data, chance):
    """`data` with some of its lines or bytes replaced, taken out or repeated."""
    lines = data.split(b"\n")
    first = next(k for k, line in enumerate(lines) if line.strip() == b"ENTITIES")
    for _ in range(chance.choice((1, 1, 3))):
        k = chance.randrange(first, len(lines))
        match chance.randrange(4):
            case 0:
                del lines[k]
            case 1:
                lines.insert(k, lines[chance.randrange(first, len(lines))])
            case 2:
                lines[k] = bytes(chance.randrange(256) for _ in range(3))
            case _:
                lines[k] = chance.choice(WORDS)
    return b"\n".join(lines)


def test_damaged_drawings_read_or_fail_cleanly(tmp_path):
    chance = random.Random(1)
    solids = drawn(tmp_path / "solids.dxf", everything, version="R2000").read_bytes()
    outline = [(0, 0, 0.2), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    flat = drawn(
        tmp_path / "flat.dxf",
        lambda space: (space.add_lwpolyline(outline, "xyb", close=True), space.add_mtext("a")),
        version="R2000",
    ).read_bytes()
    path = tmp_path / "a.dxf"
    ends = []
    for k in range(140):
        path.write_bytes(damaged(flat if k % 2 else solids, chance))
        ends.append(outcome(path, lb.files.read_drawing, thickness=0.2) if k % 2 else outcome(path))
    assert sum(isinstance(end, str) for end in ends) > 30


def test_groups_and_colours_come_through_block_references(tmp_path):
    """BYLAYER, BYBLOCK, an index and a true colour; a group of an INSERT is that of what is in it."""
    drawing = ezdxf.new(units=6)
    drawing.layers.add("red", color=1)
    stone = drawing.blocks.new("stone")
    cube().render_mesh(stone, {"layer": "0", "color": 0})  # BYBLOCK
    space = drawing.modelspace()
    inserts = [space.add_blockref("stone", (2 * k, 0, 0), {"layer": "red"}) for k in range(2)]
    inserts[0].dxf.color = 5
    own = cube()
    own.translate(6, 0, 0)
    own.render_mesh(space, {"layer": "red", "true_color": 0x102030})
    with drawing.groups.new("pair").edit_data() as pair:
        pair.extend(inserts)
    with drawing.groups.new().edit_data() as nameless:  # *A1
        nameless.extend(inserts)
    drawing.groups.new("empty")
    drawing.saveas(tmp_path / "a.dxf")
    found = lb.files.read_blocks(tmp_path / "a.dxf")
    assert [block.colour for block in found.blocks] == ["#0000ff", "#ff0000", "#102030"]
    assert [block.groups for block in found.blocks] == [("pair",), ("pair",), ()]
    assert not found.notes

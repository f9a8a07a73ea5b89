"""Elevations drawn in DXF: blocks of a thickness, arcs, outlines that are none, layers."""

import re

import numpy as np
import pytest
from dxf_files import JOINT, STRUCTURES, drawn, elevation, total_area
from ezdxf.render.forms import cube
from reading import fault
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks.cli import app


@pytest.mark.parametrize(("name", "thickness"), [("arch", 0.5), ("wall", 0.2)])
def test_elevation_gives_the_interfaces_of_the_generator(tmp_path, name, thickness):
    model = STRUCTURES[name]

    def draw(space):
        for title, corners in elevation(model, scale=1000.0).items():
            layer = "support" if title in model.supports else "stone"
            space.add_lwpolyline(corners, close=True, dxfattribs={"layer": layer})
            space.add_text(title, height=20).set_placement(corners.mean(axis=0))

    path = drawn(tmp_path / "a.dxf", draw, units=4)
    imported = lb.files.read_drawing(path, thickness=thickness, unit_weight={"stone": 20e3})
    assert [block.name for block in imported.blocks] == [block.name for block in model.blocks]
    assert imported.supports == model.supports
    assert not imported.notes
    for block, wanted in zip(imported.blocks, model.blocks, strict=True):
        assert block.volume == pytest.approx(wanted.volume, rel=1e-9)
        assert block.centroid == pytest.approx(wanted.centroid, abs=1e-9)
    interfaces = lb.find_interfaces(imported.blocks, JOINT)
    assert len(interfaces) == len(model.interfaces)
    assert total_area(interfaces) == pytest.approx(total_area(model.interfaces), rel=1e-9)
    again = lb.Model(imported.blocks, imported.supports, interfaces, lb.self_weight(), model.live)
    assert lb.bounds(again).upper == pytest.approx(lb.bounds(model).upper, rel=1e-6)


def test_import_of_an_elevation(tmp_path):
    """A block half as wide as high on a support that its layer marks rocks at half its weight."""

    def draw(space):
        for layer, low, high in (("Support", (0, -1), (2, 0)), ("stone", (0.5, 0), (1.5, 2))):
            corners = [low, (high[0], low[1]), high, (low[0], high[1])]
            space.add_lwpolyline(corners, close=True, dxfattribs={"layer": layer})

    path = drawn(tmp_path / "a.dxf", draw)
    options = ["--friction", "0.7", "--live", "1,0,0", "--unit-weight", "20e3", "--thickness", "0.5"]
    result = CliRunner().invoke(app, ["import", str(path), *options])
    assert (result.exit_code, "warning" in result.stderr) == (0, False)
    model = lb.read(tmp_path / "a.json")
    assert [block.volume for block in model.free_blocks] == pytest.approx([1.0 * 2.0 * 0.5])
    assert lb.bounds(model).lower == pytest.approx(0.5, abs=1e-6)


def test_a_drawing_without_a_header_states_no_unit_and_names_its_letters_by_number(tmp_path):
    """As scripts write it: ezdxf takes such a file to be in metres, and leaves \\U+00D3 as it is."""
    square = [(0, 0), (800, 0), (800, 600), (0, 600)]
    lines = ["0", "SECTION", "2", "ENTITIES"]
    for k in range(2):
        lines += ["0", "POLYLINE", "8", "CIMENTACI\\U+00D3N", "66", "1", "70", "1"]
        for x, y in square:
            lines += ["0", "VERTEX", "8", "0", "10", str(x), "20", str(y + 600 * k)]
        lines += ["0", "SEQEND", "0", "TEXT", "8", "0", "10", "400", "20", str(300 + 600 * k), "40", "50"]
        lines += ["1", f"pe\\U+00F1a {k}"]
    path = tmp_path / "bare.dxf"
    path.write_text("\r\n".join([*lines, "0", "ENDSEC", "0", "EOF", ""]), newline="")
    found = lb.files.read_drawing(path, thickness=0.5)
    assert found.layers == {"peña 0": "CIMENTACIÓN", "peña 1": "CIMENTACIÓN"}
    assert any("taken as mm" in line for line in found.guesses)
    assert found.blocks[0].volume == pytest.approx(0.8 * 0.6 * 0.5)


def test_elevation_drawn_by_hand(tmp_path):
    """Corners off by up to 0.1 mm, outlines not closed, polylines of every kind."""
    model = STRUCTURES["arch"]

    def draw(space):
        for k, corners in enumerate(elevation(model, jitter=1e-4).values()):
            loop = [*corners, corners[0] + 1e-4]
            (space.add_lwpolyline, space.add_polyline2d, space.add_polyline3d)[k % 3](
                [(x, y, 0.0) for x, y in loop] if k % 3 == 2 else [tuple(point) for point in loop]
            )

    imported = lb.files.read_drawing(drawn(tmp_path / "a.dxf", draw), thickness=0.5)
    interfaces = lb.find_interfaces(imported.blocks, JOINT)
    assert len(interfaces) == len(model.interfaces)
    assert total_area(interfaces) == pytest.approx(total_area(model.interfaces), rel=0.01)
    assert sum("closed over a gap" in note for note in imported.notes) == len(model.blocks)


@pytest.mark.parametrize("mirrored", [False, True])
def test_arcs_become_chords_of_5_degrees(tmp_path, mirrored):
    def draw(space):  # bulge 1: half a circle, of radius 1 here
        space.add_lwpolyline([(-1, 0, 0), (1, 0, 1)], format="xyb", close=True)
        if mirrored:
            space[0].dxf.extrusion = (0, 0, -1)

    block = lb.files.read_drawing(drawn(tmp_path / "a.dxf", draw), thickness=2.0).blocks[0]
    chords = 36  # half a circle in chords of 5 degrees
    assert block.volume == pytest.approx(2.0 * chords / 2 * np.sin(np.pi / chords), rel=1e-12)
    radii = np.hypot(block.vertices[:, 0], block.vertices[:, 2])
    assert radii == pytest.approx(np.ones(len(radii)), rel=1e-12)
    assert block.vertices[:, 2].min() == pytest.approx(0.0, abs=1e-12)


def test_an_outline_of_too_many_chords_is_refused(tmp_path):
    """Half circles of 36 chords each, one more than are taken."""
    halves = 1000 // 36 + 1

    def draw(space):
        space.add_lwpolyline([(k, 0, 1) for k in range(halves)], format="xyb", close=True)

    message = rf"LWPOLYLINE \w+ has {36 * halves} chords; at most 1000 are taken"
    with pytest.raises(lb.ModelError, match=message):
        lb.files.read_drawing(drawn(tmp_path / "a.dxf", draw), thickness=1.0)


def test_outlines_that_are_none(tmp_path):
    def draw(space):
        square = [(0, 0), (1, 0), (1, 1), (0, 1)]
        space.add_lwpolyline(square, close=True)
        space.add_lwpolyline(square)
        space.add_lwpolyline([(5, 0), (6, 0), (5, 0)], close=True)
        space.add_polyline3d([(0, 0, 0), (1, 0, 0), (1, 1, 1), (0, 1, 1)], close=True)
        space.add_circle((0, 0), 1)

    imported = lb.files.read_drawing(drawn(tmp_path / "a.dxf", draw), thickness=1.0)
    assert len(imported.blocks) == 1
    assert len(imported.left_out) == 3
    assert all(re.fullmatch("(LWPOLYLINE|POLYLINE) [0-9A-F]+", word) for word in imported.left_out)
    notes = "\n".join(imported.notes)
    for word in ("open by 1", "no area", "not parallel to the drawing", "1 CIRCLE"):
        assert word in notes


@pytest.mark.parametrize("spelled", ["STONES", "Stones", "stones"])
@pytest.mark.parametrize("listed", [True, False])
def test_a_layer_is_one_however_it_is_spelled(tmp_path, spelled, listed):
    """Names of layers have no capital letters of their own in DXF; the table's, else the first, is taken."""

    def draw(space):
        if listed:
            space.doc.layers.add("STONES")
        for k, layer in enumerate(("STONES", spelled)):
            corners = [(0, k), (1, k), (1, k + 1), (0, k + 1)]
            space.add_lwpolyline(corners, close=True, dxfattribs={"layer": layer})
            mesh = cube()
            mesh.translate(5, 0, k)
            mesh.render_mesh(space, {"layer": layer})

    path = drawn(tmp_path / "a.dxf", draw)
    flat = lb.files.read_drawing(path, thickness=0.5, layers="STONES", unit_weight={"STONES": 2e4})
    solids = lb.files.read_blocks(path, unit_weight={"STONES": 2e4})
    assert [(block.layer, block.weight) for block in flat.blocks] == [("STONES", 1e4)] * 2
    assert [(block.layer, block.weight) for block in solids.blocks] == [("STONES", pytest.approx(2e4))] * 2


def test_drawing_layers(tmp_path):
    def draw(space):
        for k, layer in enumerate(("stone", "frame")):
            square = np.array([(0, 0), (1, 0), (1, 1), (0, 1)]) + k * 0.1
            space.add_lwpolyline(square, close=True, dxfattribs={"layer": layer})

    path = drawn(tmp_path / "a.dxf", draw)
    assert len(lb.files.read_drawing(path, thickness=1.0).blocks) == 2
    assert set(lb.files.read_drawing(path, thickness=1.0, layers="stone").layers.values()) == {"stone"}
    block = lb.files.read_drawing(path, thickness=0.5, units="mm").blocks[0]
    assert block.volume == pytest.approx(1e-3 * 1e-3 * 0.5, rel=1e-12)  # the thickness is in m
    assert "did you mean 'stone'" in fault(path, lb.files.read_drawing, thickness=1.0, layers="stones")


def test_wrong_drawings(tmp_path):
    bow = [(0, 0), (1, 1), (1, 0), (0, 1)]
    path = drawn(tmp_path / "a.dxf", lambda space: space.add_lwpolyline(bow, close=True))
    assert "crosses or touches itself" in fault(path, lb.files.read_drawing, thickness=1.0)
    assert "read_drawing" in fault(path)
    for thickness in (0.0, -1.0, np.nan, np.inf):
        assert "thickness is" in fault(path, lb.files.read_drawing, thickness=thickness)
    path = drawn(tmp_path / "o.dxf", lambda space: space.add_lwpolyline([(0, 0), (1, 0), (1, 1)]))
    assert "open by 1.41" in fault(path, lb.files.read_drawing, thickness=1.0)
    path = drawn(tmp_path / "b.dxf", lambda space: space.add_line((0, 0), (1, 0)))
    assert "no closed outline but 1 LINE" in fault(path, lb.files.read_drawing, thickness=1.0)
    path = drawn(
        tmp_path / "c.dxf", lambda space: space.add_lwpolyline([(0, 0), (1e200, 0), (0, 1)], close=True)
    )
    assert "finite numbers" in fault(path, lb.files.read_drawing, thickness=1.0)


def test_outlines_that_retrace_an_edge_are_counted_once(tmp_path):
    square = [(0, 0), (1, 0), (1, 1), (0, 1)]

    def draw(space):
        space.add_lwpolyline([*square, (0, 0), (1, 0)])  # drawn on over its first side
        space.add_lwpolyline([(2, 0), (3, 0), (3, 1), (3, 2), (3, 1), (2, 1)], close=True)  # out and back

    imported = lb.files.read_drawing(drawn(tmp_path / "a.dxf", draw), thickness=1.0)
    assert [block.volume for block in imported.blocks] == pytest.approx([1.0, 1.0])
    assert sum("retraces itself" in note for note in imported.notes) == 2


def test_all_bad_outlines_are_listed_and_can_be_left_out(tmp_path):
    def draw(space):
        space.add_lwpolyline([(0, 0), (1, 0), (1, 1), (0, 1)], close=True)
        for x in (5, 8):
            space.add_lwpolyline([(x, 0), (x + 1, 1), (x + 1, 0), (x, 1)], close=True)

    file = drawn(tmp_path / "a.dxf", draw)
    with pytest.raises(lb.ModelError) as raised:
        lb.files.read_drawing(file, thickness=1.0)
    assert "2 of 3 blocks are bad" in raised.value.problems[0]
    assert sum("crosses or touches itself" in line for line in raised.value.problems) == 2
    imported = lb.files.read_drawing(file, thickness=1.0, skip_bad=True)
    assert (len(imported.blocks), len(imported.left_out)) == (1, 2)
    assert sum(note.startswith("left out: LWPOLYLINE") for note in imported.notes) == 2


def test_an_elevation_is_looked_at_before_it_is_imported(tmp_path):
    """Which way round an outline is drawn is no defect of it, and needs no note."""

    def draw(space):
        for layer, low, high in (("GROUND", (0, -1), (2, 0)), ("stone", (0.5, 0), (1.5, 2))):
            corners = [low, (low[0], high[1]), high, (high[0], low[1])]  # clockwise
            space.add_lwpolyline(corners, close=True, dxfattribs={"layer": layer})

    path = drawn(tmp_path / "a.dxf", draw)
    flat = CliRunner().invoke(app, ["look", str(path)])
    assert flat.exit_code == 2
    assert "an elevation needs the depth of its blocks: --thickness" in flat.stderr
    seen = lb.files.look(path, thickness=0.5)
    assert (seen.format, seen.volume) == ("DXF elevation", pytest.approx(2.0 * 0.5 + 2.0 * 0.5))
    assert not [note for note in seen.notes if "inward" in note]
    said = CliRunner().invoke(app, ["look", str(path), "--thickness", "0.5"], env={"COLUMNS": "200"}).stdout
    assert "--thickness 0.5 --supports layer:GROUND" in said
    with pytest.raises(lb.ModelError, match="thickness"):
        lb.files.look(path, thickness=-1.0)


def a_stone(tmp_path):
    """A stone of 800 x 400 mm; the drawing does not say that these are mm."""
    corners = [(0, 0), (800, 0), (800, 400), (0, 400)]
    return drawn(tmp_path / "a.dxf", lambda space: space.add_lwpolyline(corners, close=True), units=0)


def test_a_thickness_in_another_unit_than_m_is_asked_about(tmp_path):
    path = a_stone(tmp_path)
    for deep, asked in ((0.01, False), (0.6, False), (60.0, False), (600.0, True)):
        notes = lb.files.read_drawing(path, thickness=deep, units="mm").notes
        assert any("millimetres? thickness is in m: 0.6" in note for note in notes) is asked, deep


def test_a_drawing_in_another_unit_than_said_is_no_sheet_of_two_faces(tmp_path):
    wrong = r"thickness is 0.6 m and an outline 800 m long \(median\): say the unit .*--units mm"
    with pytest.raises(lb.ModelError, match=wrong):
        lb.files.read_drawing(a_stone(tmp_path), thickness=0.6, units="m")


@pytest.mark.parametrize("option", ["--up", "--twisted"])
def test_what_is_of_solids_is_refused_with_a_thickness_by_look_and_import_alike(tmp_path, option):
    given = ["--thickness", "0.6", option, "y" if option == "--up" else "fit"]
    made = ["--friction", "0.6", "--unit-weight", "20e3", "--live", "1,0,0", "--supports", "0"]
    for command in (["look"], ["import", *made]):
        said = CliRunner().invoke(app, [command[0], str(a_stone(tmp_path)), *command[1:], *given])
        assert said.exit_code == 2
        assert f"leave {option[2:]} ({option}) out" in said.stderr

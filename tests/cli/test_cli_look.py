"""`look`, supports and materials on the command line, and a stranger's way from a drawing to a report."""

import json
import shlex

import numpy as np
import pytest
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks.cli import app

OPTIONS = ("--friction", "0.6", "--live", "1,0,0", "--unit-weight", "20e3")
STONES = """
units = {force = "kN"}

[materials.granite]
blocks = ["layer:PIERS"]
unit_weight = 26
joint = {type = "OrdunaLourenco", friction = 0.7, compressive_strength = 20e3}

[materials.limestone]
blocks = ["layer:LINTEL"]
unit_weight = 22
joint = {type = "OrdunaLourenco", friction = 0.6}

[materials.ground]
blocks = ["layer:BASE"]
"""


def run(*arguments, code=0):
    result = CliRunner().invoke(app, [*map(str, arguments)], env={"COLUMNS": "200"})
    assert result.exit_code == code, result.output
    return result


@pytest.fixture
def drawing(tmp_path, monkeypatch):
    """A portal as ezdxf draws it, in mm, which the file does not say."""
    ezdxf = pytest.importorskip("ezdxf")
    from ezdxf.render.forms import cube

    file = ezdxf.new(units=0)
    stones = [("BASE", (4000, 1000, 200), (0, 0, -100)), ("LINTEL", (2500, 1000, 400), (0, 0, 2200))]
    stones += [("PIERS", (500, 1000, 500), (x, 0, 250 + 500 * k)) for x in (-1000, 1000) for k in range(4)]
    for layer, size, at in stones:
        shape = cube()
        shape.scale(*size)
        shape.translate(*at)
        shape.render_mesh(file.modelspace(), dxfattribs={"layer": layer})
    monkeypatch.chdir(tmp_path)
    file.saveas("portal.dxf")
    (tmp_path / "stones.toml").write_text(STONES)
    return "portal.dxf"


def test_look_tells_what_is_there(drawing):
    said = run("look", drawing).stdout
    for line in (
        "Layers           PIERS × 8, BASE × 1, LINTEL × 1",
        "Unit of length   mm, guessed: the file does not say",
        "Size             4 × 1 × 2.6 m",
        "Likely supports  'layer:BASE': 1 (",
        "taken as mm, 4 m large with blocks of 1 m",
        "Next: limitblocks import portal.dxf --units mm --supports layer:BASE --friction",
    ):
        assert line in said
    seen = json.loads(run("look", drawing, "--units", "mm", "--json").stdout)
    assert seen["units"] == "mm, as given"
    assert seen["volume"] == pytest.approx(4.0 * 0.2 + 2.5 * 0.4 + 8 * 0.25)
    assert seen["layers"] == {"PIERS": 8, "BASE": 1, "LINTEL": 1}
    assert not [line for line in seen["warnings"] if "mm" in line]


def test_supports_are_asked_for_in_words_of_the_shell(drawing):
    said = run("import", drawing, *OPTIONS, code=2).stderr
    assert "give --supports, perhaps --supports layer:BASE; there are layers 'PIERS' (8), 'BASE' (1)" in said
    said = run("import", drawing, *OPTIONS, "--supports", "layer:base", code=2).stderr
    assert "'layer:base' matches no layer; did you mean 'BASE'?; there are layers 'PIERS' (8)" in said
    said = run("import", drawing, "--live", "1,0,0", "--supports", "layer:BASE", code=2).stderr
    assert "give --friction" in said
    said = run("import", drawing, *OPTIONS[:4], "--supports", "layer:BASE", code=2).stderr
    assert "give --unit-weight" in said


@pytest.mark.parametrize("wanted", ["BASE", "layer:BASE", "name:BASE*", "BA*", "z<0.01"])
def test_supports_by_layer_pattern_and_height(drawing, wanted):
    run("import", drawing, *OPTIONS, "--supports", wanted)
    assert len(lb.read("portal.json").supports) == 1


def test_a_stranger_gets_to_a_report(drawing):
    """Five commands, as in docs/from-a-drawing.md."""
    run("look", drawing)
    said = run(
        "import", drawing, "--units", "mm", "--supports", "layer:BASE", "--materials", "stones.toml",
        "--live", "1,0,0",
    ).stderr  # fmt: skip
    assert "granite|limestone: the weaker of both, friction 0.6 (limestone), compressive strength" in said
    assert "warning" not in said
    info = json.loads(run("info", "portal.json", "--json").stdout)
    assert info["layers"] == {"PIERS": 8, "LINTEL": 1, "BASE": 1}
    assert info["weight"] == pytest.approx(8 * 0.25 * 26e3 + 2.5 * 0.4 * 22e3)
    assert [one["material"] for one in info["materials"]] == ["granite", "ground", "limestone"]
    run("bounds", "portal.json", "--output", "bounds.json")
    run("report", "portal.json", "--output", "portal.md")
    with open("portal.md", encoding="utf-8") as stream:
        report = stream.read()
    assert "8 × granite, 2 m³, 26 kN/m³" in report
    assert "2 × granite\\|limestone: friction coefficient 0.6 (31.0 degrees)" in report


def test_a_table_of_materials_and_a_joint_are_not_taken_together(drawing):
    tail = ("--materials", "stones.toml", "--supports", "BASE", "--live", "1,0,0")
    for option, value in (("--friction", 0.6), ("--joint", "point-contact"), ("--slip", "paper")):
        said = run("import", drawing, *tail, option, value, code=2).stderr
        assert f"{option} and --materials: the table has the joints" in said
    assert "leave one out" in run("import", drawing, *tail, "--unit-weight", "20e3", code=2).stderr


WRONG = {
    "blocks = [": ("blokcs = [", "materials.granite.blokcs: unknown key; did you mean 'blocks'?"),
    'type = "OrdunaLourenco", friction = 0.7': ('type = "Glue"', "type 'Glue' is unknown"),
    "unit_weight = 26": ("unit_weight = -1", "materials.granite.unit_weight"),
    "[materials.granite]": ("[materials.granite", "stones.toml: not TOML: "),
    '["layer:PIERS"]': (
        '"layer:PIERS"',
        "materials.granite.blocks: expected a list [...], not 'layer:PIERS'",
    ),
    '["layer:BASE"]': ('["layer:BASS"]', "no material of the table; among them layers 'BASE' (1)"),
    "friction = 0.6}": ("friction = -0.6}", "materials.limestone: friction is -0.6"),
}


@pytest.mark.parametrize("text", WRONG)
def test_wrong_tables_are_said_with_their_place(drawing, tmp_path, text):
    changed, said = WRONG[text]
    (tmp_path / "stones.toml").write_text(STONES.replace(text, changed, 1))
    tail = ("--materials", "stones.toml", "--supports", "BASE", "--live", "1,0,0")
    assert said in run("import", drawing, *tail, code=2).stderr


def test_look_lists_every_bad_block(tmp_path):
    """Two of four are open; the others are looked at."""
    boxes = [lb.Block.box(f"b{k}", (1, 1, 1), (0, 0, k)) for k in range(4)]
    file = lb.files.write_blocks(boxes, tmp_path / "four.obj")
    lines = file.read_text().splitlines()
    last = [k for k, line in enumerate(lines) if line.startswith("f ")][5::6]
    file.write_text("\n".join(line for k, line in enumerate(lines) if k not in last[1:3]) + "\n")
    seen = json.loads(run("look", file, "--json").stdout)
    assert [block["name"] for block in seen["blocks"]] == ["b0", "b3"]
    assert len(seen["faults"]) == 2
    said = run("look", file).stdout
    assert "'b1'" in said
    assert "'b2'" in said


def test_look_at_a_model_file(tmp_path):
    model = lb.structures.portal(lb.OrdunaLourenco(0.6), span=2.0, pier_width=0.6, pier_blocks=2)
    said = run("look", model.save(tmp_path / "portal.json")).stdout
    assert "limitblocks model" in said
    assert f"Next: limitblocks info {tmp_path / 'portal.json'}" in said
    refused = run("look", tmp_path / "portal.json", "--units", "mm", code=2).stderr
    assert "a model file says units, axes and faces itself" in refused


def test_a_springing_at_roundoff_is_at_zero(tmp_path):
    stone = lb.Block.box("V1", (1.0, 1.0, 1.0), (0.0, 0.0, 0.5 + 3e-16))
    said = run("look", lb.files.write_blocks([stone], tmp_path / "stone.obj")).stdout
    assert "e-16" not in said


def test_stones_drawn_into_one_another_are_not_joints_drawn_open(tmp_path):
    """Each 1 mm into the one below, where .6 mm counts as touching."""
    stones = [lb.Block.box("base", (3, 1, 0.2), (0, 0, -0.1))]
    stones += [lb.Block.box(f"{k}", (1, 0.5, 0.5), (0, 0, 0.25 - 0.001 + 0.499 * k)) for k in range(2)]
    said = run("look", lb.files.write_blocks(stones, tmp_path / "deep.obj")).stdout
    assert "the blocks typically overlap by 1 mm" in said
    assert "drawn open" not in said


@pytest.mark.parametrize("count", [1, 2])
def test_the_next_command_takes_as_touching_what_the_gap_told_does(tmp_path, count):
    """Stones 1 mm into the one below, where .6 mm counts as touching: the command works as it stands."""
    stones = [lb.Block.box("base", (3, 1, 0.2), (0, 0, -0.1))]
    stones += [lb.Block.box(f"{k}", (1, 0.5, 0.5), (0, 0, 0.25 - 0.001 + 0.499 * k)) for k in range(count)]
    assert sum("--gap" in one for one in lb.geometry.find_contacts(stones, None).faults) == 1
    said = run("look", lb.files.write_blocks(stones, tmp_path / "deep.obj")).stdout
    _, *words = shlex.split(said.rpartition("Next: ")[2])
    said = run(*words).stdout
    assert f"1 support, {count} interface" in said


def test_the_next_command_divides_twisted_faces_rather_than_leaving_stones_out(tmp_path):
    """One corner of 4 stones of 5 is 0.1 m out of its faces: all 5 are in the model, and not the 1 alone."""
    stones = [lb.Block.box(f"b{k}", (1.0, 1.0, 1.0), (2.0 * k, 0.0, 0.5)) for k in range(5)]
    rows = []
    for k, stone in enumerate(stones):
        corners = stone.vertices + 0.1 * (k > 0) * np.eye(8)[7][:, None] * [0.0, 0.0, 1.0]
        rows += [f"o b{k}", *(f"v {x} {y} {z}" for x, y, z in corners.tolist())]
        rows += ["f " + " ".join(str(8 * k + v + 1) for v in face) for face in stone.faces]
    file = tmp_path / "bent.obj"
    file.write_text("\n".join(rows))
    _, *words = shlex.split(run("look", file).stdout.rpartition("Next: ")[2])
    assert words[-2:] == ["--twisted", "triangulate"]
    said = run(*words).stdout
    assert len(json.loads(run(*words, "--json").stdout)["blocks"]) == 5
    assert "--skip-bad" not in said


def test_the_next_command_leaves_out_what_is_open_where_few_faces_are_twisted(tmp_path):
    """Two boxes of five lack a face, one has a corner 0.1 m out of its faces: to divide these mends one."""
    rows = []
    for k in range(5):
        stone = lb.Block.box(f"b{k}", (1.0, 1.0, 1.0), (2.0 * k, 0.0, 0.5))
        corners = stone.vertices + 0.1 * (k == 0) * np.eye(8)[7][:, None] * [0.0, 0.0, 1.0]
        rows += [f"o b{k}", *(f"v {x} {y} {z}" for x, y, z in corners.tolist())]
        faces = stone.faces[: 5 if k in (1, 2) else 6]
        rows += ["f " + " ".join(str(8 * k + v + 1) for v in face) for face in faces]
    file = tmp_path / "open.obj"
    file.write_text("\n".join(rows))
    _, *words = shlex.split(run("look", file).stdout.rpartition("Next: ")[2])
    assert words[0] == "import"
    assert "--skip-bad" in words


def test_healing_what_tells_no_accuracy_says_what_to_do(tmp_path):
    stones = [lb.Block.box("base", (2, 1, 1), (0, 0, -0.5)), lb.Block.box("top", (1, 1, 1), (0, 0, 0.5))]
    file = lb.files.write_blocks(stones, tmp_path / "two.obj")
    said = run("import", file, *OPTIONS, "--supports", "base", "--heal", code=2).stderr
    assert "how accurate the faces are is not known" in said
    assert "None" not in said


def test_joints_drawn_open_name_distance_and_gap(tmp_path):
    stones = [lb.Block.box("base", (2, 1, 1), (0, 0, -0.5))]
    stones += [lb.Block.box(f"{k}", (0.5, 0.5, 0.2), (0, 0, 0.11 + 0.21 * k)) for k in range(3)]
    file = lb.files.write_blocks(stones, tmp_path / "open.obj")
    for said in (
        run("look", file).stdout,
        run("import", file, *OPTIONS, "--supports", "base", code=2).stderr,
    ):
        assert "would touch with gap=0.05" in said
        assert "typically 10 mm wide" in said
    assert np.isfinite(lb.read(file, joint=lb.PointContact(0.6), supports="base", unit_weight=1.0,
        live=lb.mass_proportional((1, 0, 0)), gap=0.05).blocks[0].volume)  # fmt: skip

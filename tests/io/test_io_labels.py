"""Layers, materials, groups and colours of blocks, and what was left out of a file, go with the model."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks.cli import app
from limitblocks.io import colours
from limitblocks.reports.facts import facts
from limitblocks.reports.scene import scene

JOINT = lb.OrdunaLourenco(0.6)
LIVE = lb.mass_proportional((1.0, 0.0, 0.0))
BLOCKS = [
    lb.Block.box("base", (2, 1, 0.2), (0, 0, -0.1)).labelled(layer="BASE AREA", material="rock"),
    lb.Block.box("s1", (1, 1, 0.5), (0, 0, 0.25), 2e4).labelled(
        layer="WALL", material="granite", groups=["pier", "phase 2"], colour="#b08050"
    ),
    lb.Block.box("s2", (1, 1, 0.5), (0, 0, 0.75), 2e4).labelled(groups=["pier"], colour="#1020FF"),
]
MODEL = lb.Model(BLOCKS, ["base"], lb.find_interfaces(BLOCKS, JOINT), lb.self_weight(), LIVE)


def said_by(*words):
    done = CliRunner().invoke(app, [str(word) for word in words], env={"COLUMNS": "120"})
    assert done.exit_code == 0, done.output
    return done.output


def words(blocks):
    return [(block.groups, block.colour, block.material) for block in blocks]


WORDS = [((), "", "rock"), (("pier", "phase 2"), "#b08050", "granite"), (("pier",), "#1020ff", "")]


@pytest.mark.parametrize("suffix", [".obj", ".glb", ".dxf", ".3dm", ".json"])
def test_words_of_blocks_are_kept_by_every_format_that_has_them(tmp_path, suffix):
    found = lb.files.read_blocks(lb.files.write_blocks(MODEL, tmp_path / f"a{suffix}"))
    assert words(found.blocks) == WORDS
    assert [block.layer for block in found.blocks] == ["BASE AREA", "WALL", "block"]
    again = lb.files.read_blocks(lb.files.write_blocks(found, tmp_path / f"b{suffix}"))
    assert words(again.blocks) == WORDS
    bare = [block.labelled(groups=(), colour="", material="") for block in BLOCKS]
    plain = lb.files.read_blocks(lb.files.write_blocks(bare, tmp_path / f"c{suffix}"))
    assert words(plain.blocks) == [((), "", "")] * 3


@pytest.mark.parametrize("suffix", [".obj", ".glb", ".dxf", ".3dm", ".json"])
@pytest.mark.parametrize("names", [("a b", "a\nb"), ("a", "a")])
def test_blocks_whose_names_are_one_in_a_file_keep_their_layers(tmp_path, suffix, names):
    boxes = [lb.Block.box(name, (1, 1, 1), (2 * k, 0, 0)) for k, name in enumerate(names)]
    drawn = [box.labelled(layer=layer) for box, layer in zip(boxes, ("north", "south"), strict=True)]
    found = lb.files.read_blocks(lb.files.write_blocks(drawn, tmp_path / f"a{suffix}"))
    one = " ".join(names[0].split())
    assert [(block.name, block.layer) for block in found.blocks] == [(one, "north"), (f"{one} 2", "south")]


def test_a_block_whose_name_is_that_of_a_support_in_a_file_is_none(tmp_path):
    boxes = [lb.Block.box(name, (1, 1, 1), (0, 0, k), 2e4) for k, name in enumerate(["a b", "a\nb"])]
    model = lb.Model(boxes, ["a b"], lb.find_interfaces(boxes, JOINT), lb.self_weight(), LIVE)
    bounds = lb.bounds(model)
    for k, file in enumerate([
        lb.files.write_blocks(model, tmp_path / "0.json"),
        lb.files.write_forces(model, tmp_path / "1.json", bounds),
    ]):  # fmt: skip
        assert lb.files.read_blocks(file).supports == ("a b",), k


def test_names_that_begin_with_a_bracket_are_not_lost_in_rhino(tmp_path):
    words = {"layer": "[walls]::(north)", "material": "(a)", "groups": ["]g["]}
    block = lb.Block.box("{1} b", (1, 1, 1), (0, 0, 0)).labelled(**words)
    (found,) = lb.files.read_blocks(lb.files.write_blocks([block], tmp_path / "a.3dm")).blocks
    assert (found.name, found.layer, found.material) == ("_1} b", "_walls]::_north)", "_a)")
    assert found.groups == ("_g[",)


def test_ply_has_colours_alone(tmp_path):
    found = lb.files.read_blocks(lb.files.write_blocks(BLOCKS, tmp_path / "a.ply"))
    assert [block.colour for block in found.blocks] == ["", "#b08050", "#1020ff"]


def test_ply_of_a_scan_has_no_colour_of_its_blocks(tmp_path):
    path = lb.files.write_blocks(BLOCKS[1:2], tmp_path / "a.ply")
    data = path.read_bytes()
    start = data.index(b"end_header\n") + 11
    path.write_bytes(data[: start + 24] + b"\x00" + data[start + 25 :])  # red of the first vertex
    assert lb.files.read_blocks(path).blocks[0].colour == ""


def test_the_model_file_keeps_words_of_blocks_and_what_was_left_out(tmp_path):
    model = lb.Model(BLOCKS, ["base"], MODEL.interfaces, MODEL.dead, LIVE, left_out=["footing"])
    again = lb.read(model.save(tmp_path / "a.json"))
    assert words(again.blocks) == WORDS
    assert [block.layer for block in again.blocks] == ["BASE AREA", "WALL", ""]
    assert (again.left_out, again.digest) == (("footing",), MODEL.digest)
    document = MODEL.to_dict()
    assert "left_out" not in document
    assert {"groups", "colour"} & document["blocks"][0].keys() == set()
    assert {"layer", "material"} & document["blocks"][2].keys() == set()


def test_reports_info_and_paraview_have_the_words_of_blocks(tmp_path):
    known = facts(MODEL)
    assert known["groups"] == {"pier": 2, "phase 2": 1}
    assert known["colours"] == {"#b08050": 1, "#1020ff": 1}
    drawn = scene(MODEL, [], "")["blocks"]
    assert drawn["groups"] == ["", "pier, phase 2", "pier"]
    assert drawn["colour"] == ["", "#b08050", "#1020ff"]
    assert (drawn["layer"], drawn["material"]) == (["BASE AREA", "WALL", ""], ["rock", "granite", ""])
    said = said_by("info", MODEL.save(tmp_path / "a.json"))
    assert "2 × pier, 1 × phase 2" in said
    assert "1 × #b08050" in said
    meshio = pytest.importorskip("meshio")
    data = meshio.read(lb.files.write_vtu(MODEL, tmp_path / "a.vtu", None)[0]).cell_data
    assert np.concatenate(data["layer"]).tolist() == [1] * 6 + [2] * 6 + [0] * 6  # BASE AREA, WALL, none
    assert np.concatenate(data["material"]).tolist() == [2] * 6 + [1] * 6 + [0] * 6  # rock, granite, none
    assert np.concatenate(data["group"]).tolist() == [0] * 6 + [1] * 12  # none, pier
    assert np.concatenate(data["colour"])[[0, 6, 12]].tolist() == [[255] * 3, [176, 128, 80], [16, 32, 255]]


def test_look_tells_groups_and_colours_and_blocks_are_chosen_by_group(tmp_path):
    path = lb.files.write_blocks(MODEL, tmp_path / "a.dxf")
    said = said_by("look", path)
    assert "Groups" in said
    assert "pier × 2, phase 2 × 1" in said
    assert lb.files.select(BLOCKS, "group:p*") == ("s1", "s2")
    with pytest.raises(lb.ModelError, match=r"matches no group.*groups 'pier' \(2\)"):
        lb.files.select(BLOCKS, "group:wall")


def test_colours_of_materials_and_layers(tmp_path):
    cube = lb.files.write_blocks(BLOCKS[:1], tmp_path / "cube.obj").read_text().splitlines()
    lines = [line for line in cube if not line.startswith(("#", "g", "usemtl"))]
    (tmp_path / "a.mtl").write_text("newmtl Stone wall\nKa 0 0 0\nKd 0.5 0.25 1.0\nKd a b c\n")
    lines = ["mtllib a.mtl", lines[0], "usemtl Stone wall", *lines[1:]]
    (tmp_path / "a.obj").write_text("\n".join(lines))
    assert lb.files.read_blocks(tmp_path / "a.obj").blocks[0].colour == "#8040ff"
    (tmp_path / "a.mtl").unlink()
    assert lb.files.read_blocks(tmp_path / "a.obj").blocks[0].colour == ""


@pytest.mark.parametrize("colour", ["red", "#12345", "#12345g", 7])
def test_what_is_no_colour_is_refused(colour):
    with pytest.raises(lb.ModelError, match="block 'base': colour is"):
        BLOCKS[0].labelled(colour=colour)


@pytest.mark.parametrize("groups", ["pier", [""], [3]])
def test_what_are_no_groups_is_refused(groups):
    with pytest.raises(lb.ModelError, match="block 'base': groups are"):
        BLOCKS[0].labelled(groups=groups)


def test_linear_colours_are_those_of_the_standard():
    """IEC 61966-2-1: a half is .2140 linear; every colour comes back."""
    assert colours.linear_of("#808080")[0] == pytest.approx(((128 / 255 + 0.055) / 1.055) ** 2.4)
    for k in range(255):
        assert colours.of_linear(colours.linear_of(f"#{k:02x}{255 - k:02x}07")) == f"#{k:02x}{255 - k:02x}07"


def test_a_colour_in_a_file_that_is_none_is_passed_over(tmp_path):
    path = lb.files.write_blocks(BLOCKS, tmp_path / "a.json")
    document = json.loads(path.read_text())
    for node in document["data"]["graph"]["node"].values():
        node |= {"colour": "bricky", "groups": ["", 3, " a\n b "]}
    path.write_text(json.dumps(document))
    assert words(lb.files.read_blocks(path).blocks) == [
        (("3", "a b"), "", material) for material in ("rock", "granite", "")
    ]


def leaning(left_out=()):
    """A column whose second stone is held by friction that a slope of 45 degrees exceeds."""
    foot = lb.Block.prism("foot", [(0.0, 0.0), (1.0, 0.0), (1.0, 0.2), (0.0, 1.2)], (0.0, 1.0))
    stone = lb.Block.prism("stone", [(0.0, 1.2), (1.0, 0.2), (1.0, 1.2), (0.0, 2.2)], (0.0, 1.0), 2e4)
    blocks = [foot, stone]
    faces = lb.find_interfaces(blocks, JOINT)
    return lb.Model(blocks, ["foot"], faces, lb.self_weight(), LIVE, left_out=left_out)


def test_blocks_that_fall_name_what_was_left_out(tmp_path):
    with pytest.raises(lb.errors.NoEquilibrium) as raised:
        lb.bounds(leaning())
    assert "left out" not in str(raised.value)
    model = lb.read(leaning(["prop", "3 hidden objects"]).save(tmp_path / "a.json"))
    for analysis in (lb.bounds, lb.nonassociated):
        with pytest.raises(lb.errors.NoEquilibrium) as raised:
            analysis(model)
        assert raised.value.left_out == ("prop", "3 hidden objects")
        assert "left out when the file was read: prop, 3 hidden objects; if these" in str(raised.value)


def test_blocks_that_float_name_what_was_left_out():
    with pytest.raises(lb.ModelError, match=r"floating: .* 's1'.*; left out when the file was read: base"):
        lb.Model(
            [*BLOCKS[1:], lb.Block.box("far", (1, 1, 1), (9, 0, 0))],
            ["far"],
            MODEL.interfaces[1:],
            lb.self_weight(),
            LIVE,
            left_out=["base"],
        )


def test_a_block_without_words_has_none_of_the_block_before_it_in_obj(tmp_path):
    """`g` and `usemtl` last until others are said: what stands on the base was of its layer, a support."""
    size = (1.0, 1.0, 1.0)
    stack = [lb.Block.box(name, size, (0.0, 0.0, k + 0.5)) for k, name in enumerate(("base", "a", "b"))]
    words = ({"layer": "BASE", "material": "rock", "groups": ["pier"]}, {}, {"layer": "TOP"})
    labelled = [block.labelled(**given) for block, given in zip(stack, words, strict=True)]
    path = lb.files.write_blocks(labelled, tmp_path / "a.obj")
    found = lb.files.read_blocks(path, unit_weight=2e4)
    assert [(block.layer, block.material, block.groups) for block in found.blocks] == [
        ("BASE", "rock", ("pier",)), ("", "", ()), ("TOP", "", ())
    ]  # fmt: skip
    model = lb.read(path, joint=JOINT, supports="layer:BASE", unit_weight=2e4, live=LIVE)
    assert [block.name for block in model.free_blocks] == ["a", "b"]
    # both cubes turn about the edge of the base at 1/2 over 1; one alone slides at .6 before it turns
    assert lb.bounds(model).upper == pytest.approx(0.5, abs=1e-6)

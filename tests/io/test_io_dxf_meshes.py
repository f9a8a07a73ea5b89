"""DXF meshes that are smoothed, and units that a drawing states and is hardly in."""

import pytest
from dxf_files import drawn
from ezdxf.render.forms import cube
from reading import fault

import limitblocks as lb


@pytest.mark.parametrize(
    ("code", "length", "asked"),  # 750 inches are 19.05 m, 750 mm .75 m; 393 inches 9.98 m
    [(1, 750, "blocks are 19.05 m long (median), in mm 0.75 m: if it is in mm, say units='mm'"),
     (6, 45, "blocks are 45 m long (median), in cm 0.45 m: if it is in cm, say units='cm'"),
     (1, 393, None), (4, 750, None), (4, 15000, None)],
)  # fmt: skip
def test_a_stated_unit_that_makes_blocks_longer_than_10_m_is_asked_about(tmp_path, code, length, asked):
    def draw(space):
        for layer, height in (("BASE", 0), ("STONE", length)):
            stone = cube()
            stone.scale_uniform(length)
            stone.translate(0, 0, height)
            stone.render_mesh(space, {"layer": layer})

    path = drawn(tmp_path / "a.dxf", draw, units=code)
    guesses = lb.files.read_blocks(path).guesses
    assert [asked in said for said in guesses] == [True] if asked else guesses == ()
    stated = {1: "in", 4: "mm", 6: "m"}[code]
    assert lb.files.read_blocks(path, units=stated).guesses == ()


@pytest.mark.parametrize("level", [1, 3])
def test_a_smoothed_mesh_is_no_block_and_can_be_left_out(tmp_path, level):
    """Its faces are those of the cube that the CAD program smooths to a rounded body."""

    def draw(space):
        cube().render_mesh(space, {"layer": "ROUND", "subdivision_levels": level})
        cube().render_mesh(space, {"layer": "PLAIN", "subdivision_levels": 0})

    path = drawn(tmp_path / "a.dxf", draw)
    said = fault(path)
    assert "1 of 2 blocks is bad" in said
    assert "on layer 'ROUND': it is smoothed, without plane faces" in said
    assert "set its smoothness to none (0)" in said
    found = lb.files.read_blocks(path, skip_bad=True)
    assert [block.layer for block in found.blocks] == ["PLAIN"]
    assert [name.split()[0] for name in found.left_out] == ["ROUND"]
    assert any(note.startswith("left out: MESH") for note in found.notes)

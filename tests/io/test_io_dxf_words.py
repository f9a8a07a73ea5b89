"""Groups, colours and thicknesses of what is drawn in pieces: 3D faces and outlines."""

from dataclasses import replace

import ezdxf
import pytest
from dxf_files import JOINT
from ezdxf.render.forms import cube

import limitblocks as lb
from limitblocks.joints import Material, Materials

LIVE = lb.mass_proportional((1.0, 0.0, 0.0))


def test_3d_faces_have_the_words_of_the_solid_they_close(tmp_path):
    """Three cubes of 3D faces on one layer: their groups choose them, of which one is the support."""
    drawing = ezdxf.new(units=6)
    space = drawing.modelspace()
    for k, name in enumerate(("base", "low", "top")):
        shape = cube()
        shape.translate(0, 0, k + 0.5)
        words = {"layer": "STONES", "true_color": 0x100000 * (k + 1)}
        faces = [
            space.add_3dface([shape.vertices[v] for v in face], dxfattribs=words) for face in shape.faces
        ]
        with drawing.groups.new(name).edit_data() as group:
            group.extend(faces)
    drawing.saveas(tmp_path / "a.dxf")
    found = lb.files.read_blocks(tmp_path / "a.dxf").blocks
    assert [block.groups for block in found] == [("base",), ("low",), ("top",)]
    assert [block.colour for block in found] == ["#100000", "#200000", "#300000"]
    stone = {"low": 20e3, "top": 30e3}
    table = {name: Material(weight, JOINT, blocks=[f"group:{name}"]) for name, weight in stone.items()}
    table["ground"] = Material(blocks=["group:base"])
    made = {"materials": Materials(table), "supports": "group:base"}
    model = lb.read(tmp_path / "a.dxf", **made, live=LIVE)
    assert [block.weight for block in model.free_blocks] == pytest.approx([20e3, 30e3])
    # both turn about the edge of the base: 50 kN at 1/2, against 20 kN at 1/2 and 30 kN at 3/2
    assert lb.bounds(model).upper == pytest.approx(25.0 / 55.0, abs=1e-6)


def test_outlines_of_an_elevation_keep_their_groups_and_colours(tmp_path):
    """Two stones of 800 x 300 mm on a base, chosen by group; the mass of one is twice that of the other."""
    drawing = ezdxf.new(units=4)
    for k, name in enumerate(("base", "low", "top")):
        corners = [(0, 300 * k), (800, 300 * k), (800, 300 * k + 300), (0, 300 * k + 300)]
        line = drawing.modelspace().add_lwpolyline(corners, close=True, dxfattribs={"color": k + 1})
        with drawing.groups.new(name).edit_data() as group:
            group.append(line)
    drawing.saveas(tmp_path / "a.dxf")
    found = lb.files.read_drawing(tmp_path / "a.dxf", thickness=0.5)
    assert [block.groups for block in found.blocks] == [("base",), ("low",), ("top",)]
    assert [block.colour for block in found.blocks] == ["#ff0000", "#ffff00", "#00ff00"]
    assert lb.files.select(found.blocks, "group:base") == (found.blocks[0].name,)
    table = Materials(
        {name: Material(weight, JOINT, [f"group:{name}"]) for name, weight in (("low", 1e4), ("top", 2e4))}
        | {"ground": Material(blocks=["group:base"])}
    )
    weights = [block.weight for block in table.on(found.blocks)[0][1:]]
    assert weights == pytest.approx([0.8 * 0.3 * 0.5 * 1e4, 0.8 * 0.3 * 0.5 * 2e4])


@pytest.mark.parametrize("thickness", [0.4, 4.0])
def test_a_thickness_does_not_change_the_unit_that_is_guessed(tmp_path, thickness):
    """20 outlines of 20 x 20 in a drawing without a unit are taken in cm; the thickness is in m already."""
    drawing = ezdxf.new(units=0)
    for k in range(20):
        corners = [(0, 20 * k), (20, 20 * k), (20, 20 * k + 20), (0, 20 * k + 20)]
        drawing.modelspace().add_lwpolyline(corners, close=True)
    drawing.saveas(tmp_path / "a.dxf")
    found = lb.files.read_drawing(tmp_path / "a.dxf", thickness=thickness)
    assert [block.volume for block in found.blocks] == pytest.approx([0.2 * 0.2 * thickness] * 20)
    assert ["units='cm'" in said for said in found.guesses] == [True]
    seen = lb.files.look(tmp_path / "a.dxf", thickness=thickness)
    assert seen.size == pytest.approx((0.2, thickness, 4.0))
    assert seen.units.startswith("cm, guessed")


def test_a_vault_in_elevation_is_not_asked_about_its_unit(tmp_path):
    """Stones of .5 m in a drawing that states m, 12 m deep, were said to be 12 m long."""
    drawing = ezdxf.new(units=6)
    drawing.modelspace().add_lwpolyline([(0, 0), (0.5, 0), (0.5, 0.4), (0, 0.4)], close=True)
    drawing.saveas(tmp_path / "a.dxf")
    found = lb.files.read_drawing(tmp_path / "a.dxf", thickness=12.0)
    assert found.blocks[0].volume == pytest.approx(0.5 * 0.4 * 12.0)
    assert found.guesses == ()


@pytest.mark.parametrize("mirrored", [1, -1])
def test_a_cavity_of_3d_faces_stays_one_in_a_mirror_image(tmp_path, mirrored):
    """A cube of 2 m with a cavity of 1 m between two others; its faces pointed inward in the mirror image."""
    drawing = ezdxf.new(units=6)
    stones = drawing.blocks.new("stones")
    for size, z, inward in ((4, -3, False), (2, 0, False), (1, 0, True), (1, 1.5, False)):
        shape = cube()
        shape.scale_uniform(size)
        shape.translate(0, 0, z)
        for face in shape.faces:
            corners = [shape.vertices[v] for v in face]
            stones.add_3dface(corners[::-1] if inward else corners)
    drawing.modelspace().add_blockref("stones", (0, 0, 0), dxfattribs={"xscale": mirrored})
    drawing.saveas(tmp_path / "a.dxf")
    found = lb.files.read_blocks(tmp_path / "a.dxf").blocks
    assert [block.volume for block in found] == pytest.approx([64.0, 8.0 - 1.0, 1.0])
    model = lb.read(tmp_path / "a.dxf", joint=JOINT, supports="z<-0.9", unit_weight=2e4, live=LIVE)
    # the upper turns about its own edge at 1/2 over 1/2, both slide at .6, before they turn at 160 over 190
    assert lb.bounds(model).upper == pytest.approx(0.6, abs=1e-6)


def test_a_reference_on_a_layer_that_is_off_hides_what_takes_on_its_layer(tmp_path):
    """As CAD programs have it; one on a frozen layer hides all it holds."""
    drawing = ezdxf.new(units=6)
    drawing.layers.add("stone")
    drawing.layers.add("off").off()
    drawing.layers.add("frozen").freeze()
    pair = drawing.blocks.new("pair")
    for k, layer in enumerate(("stone", "0")):
        shape = cube()
        shape.translate(0, 0, k + 0.5)
        shape.render_mesh(pair, {"layer": layer})
    for k, layer in enumerate(("stone", "off", "frozen")):
        drawing.modelspace().add_blockref("pair", (5 * k, 0, 0), {"layer": layer})
    drawing.saveas(tmp_path / "a.dxf")
    found = lb.files.read_blocks(tmp_path / "a.dxf")
    places = [block.centroid.round(9).tolist() for block in found.blocks]
    assert places == [[0.0, 0.0, 0.5], [0.0, 0.0, 1.5], [5.0, 0.0, 0.5]]
    assert found.left_out == ("2 hidden entities",)


def test_every_bad_solid_of_a_reference_is_told(tmp_path):
    """Two smoothed meshes, and an open one beside a sound one, all of one name."""
    drawing = ezdxf.new(units=6)
    stones = drawing.blocks.new("stones")
    meshes = []
    for k in range(4):
        shape = cube()
        shape.translate(0, 0, k + 0.5)
        meshes.append(shape.render_mesh(stones))
    for mesh in meshes[:2]:
        mesh.dxf.subdivision_levels = 1
    with meshes[2].edit_data() as data:
        data.faces = [list(face) for face in list(data.faces)[:-1]]
    drawing.modelspace().add_blockref("stones", (0, 0, 0))
    drawing.saveas(tmp_path / "a.dxf")
    with pytest.raises(lb.ModelError) as error:
        lb.files.read_blocks(tmp_path / "a.dxf")
    found = lb.files.read_blocks(tmp_path / "a.dxf", skip_bad=True)
    assert [block.centroid[2] for block in found.blocks] == pytest.approx([3.5])
    for said in (error.value.problems, found.notes):
        assert [sum(word in line for line in said) for word in ("is smoothed", "is open:")] == [2, 1]


def test_layers_and_groups_that_differ_by_capitals_stay_apart(tmp_path):
    """DXF takes Granite and granite for one: the stones of both would have one unit weight."""
    words = {"base": "Ground", "low": "Granite", "top": "granite", "side": "granite"}
    places = {"base": (0, 0, 0.5), "low": (0, 0, 1.5), "top": (0, 0, 2.5), "side": (3, 0, 0.5)}
    blocks = [
        replace(lb.Block.box(name, (1, 1, 1), places[name], 20e3), layer=word, groups=(word,))
        for name, word in words.items()
    ]
    model = lb.Model(blocks, ["base", "side"], lb.find_interfaces(blocks, JOINT), lb.self_weight(), LIVE)
    lb.files.write_blocks(model, tmp_path / "a.dxf")
    found = lb.files.read_blocks(tmp_path / "a.dxf").blocks
    assert [block.layer for block in found] == ["Ground", "Granite", "granite 2", "granite 2"]
    assert [block.groups for block in found] == [("Ground",), ("Granite",), ("granite 2",), ("granite 2",)]

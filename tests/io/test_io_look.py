"""What a file does not say: units, the axis up, supports, materials."""

import logging
from dataclasses import replace

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.io import guesses, look
from limitblocks.io.supports import likely_supports
from limitblocks.joints import Material, Materials
from limitblocks.structures import EXAMPLES

JOINT = lb.OrdunaLourenco(0.7)
LIVE = lb.mass_proportional((1.0, 0.0, 0.0))
#: From axes with Z up to axes with Y up.
Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
#: Structures of too few blocks to tell, or that stand as well on their side.
UNTOLD = {
    "block", "wedge", "wedge, two unequal planes", "barrel_vault", "groin_vault", "pavilion_vault", "dome",
    "dome, oculus",
}  # fmt: skip


def plain(model):
    """The blocks under names that say nothing."""
    return [replace(block, name=f"b{k}") for k, block in enumerate(model.blocks)]


@pytest.mark.parametrize("name", EXAMPLES)
def test_the_axis_up_is_never_guessed_wrongly(name):
    """Z up stays so; Y up is found, or left alone where nothing tells."""
    blocks = EXAMPLES[name](JOINT).blocks
    words = [("", "")] * len(blocks)
    upright = guesses.Boxes.of([block.vertices for block in blocks], words)
    lying = guesses.Boxes.of([block.vertices @ Y_UP.T for block in blocks], words)
    assert (guesses.tilted(upright, "z"), guesses.tilted(lying, "y")) == ("", "")
    assert bool(guesses.tilted(lying, "z")) == bool(guesses.tilted(upright, "y")) == (name not in UNTOLD)


def test_a_pillar_of_many_slices_is_looked_at_in_part():
    """Each of 20 000 slices lies above all below it: all pairs would take gigabytes."""
    low = np.column_stack([np.zeros((20_000, 2)), 0.1 * np.arange(20_000)])
    pillar = guesses.Boxes(low, low + np.array([1.0, 1.0, 0.1]), np.zeros(20_000, dtype=bool))
    assert (guesses.tilted(pillar, "z"), bool(guesses.tilted(pillar, "y"))) == ("", True)


def test_a_file_that_lies_on_its_side_is_turned_with_a_warning(tmp_path):
    blocks = plain(EXAMPLES["wall"](JOINT))
    assert lb.files.read_blocks(lb.files.write_blocks(blocks, tmp_path / "z.obj")).guesses == ()
    lying = [block.moved(Y_UP, (0.0, 0.0, 0.0)) for block in blocks]
    found = lb.files.read_blocks(lb.files.write_blocks(lying, tmp_path / "y.obj"))
    assert found.guesses == (
        "does not say which axis points up; taken as Y: 58 of 58 blocks would lie on the ground with Z up, "
        "1 with Y up; say up='y' or 'z' (--up)",
    )
    for made, meant in ((found, blocks), (lb.files.read_blocks(tmp_path / "y.obj", up="z"), lying)):
        assert all(np.allclose(a.centroid, b.centroid) for a, b in zip(made.blocks, meant, strict=True))


def test_a_stepped_pyramid_on_its_side_hangs_over_nothing(tmp_path):
    """Eight slabs on one another, each smaller: on the side the largest lies on the ground alone."""
    slabs = [lb.Block.box(f"b{k}", (9 - k, 9 - k, 0.5), (0, 0, 0.5 * k)) for k in range(8)]
    lying = [slab.moved(Y_UP, (0.0, 0.0, 0.0)) for slab in slabs]
    (warning,) = lb.files.read_blocks(lb.files.write_blocks(lying, tmp_path / "y.obj")).guesses
    assert "taken as Y: 7 of 8 blocks would have nothing below with Z up, 0 with Y up" in warning


def test_supports_by_name_tell_the_axis_up_of_a_dome(tmp_path):
    blocks = EXAMPLES["dome"](JOINT).blocks
    named = [replace(b, name=f"base {k}" if b.unit_weight is None else f"b{k}") for k, b in enumerate(blocks)]
    lying = [block.moved(Y_UP, (0.0, 0.0, 0.0)) for block in named]
    (warning,) = lb.files.read_blocks(lb.files.write_blocks(lying, tmp_path / "y.obj")).guesses
    assert "the blocks whose names say support are at the bottom along Y, not along Z" in warning


@pytest.mark.parametrize("name", ["barrel_vault", "dome", "block"])
@pytest.mark.parametrize("said", ["support", "stone"])
def test_supports_as_long_as_a_vault_and_few_blocks_tell_the_axis_up(name, said, tmp_path, caplog):
    """The middle of supports along all of a vault along Y is half way up where that lies on its side."""
    model = EXAMPLES[name](JOINT)
    names = {own: f"{said} {k}" for k, own in enumerate(model.supports)}
    blocks = [replace(b, name=names.get(b.name, f"b{k}")) for k, b in enumerate(model.blocks)]
    files = [
        lb.files.write_blocks(made, tmp_path / file)
        for made, file in (
            (blocks, "z.obj"),
            ([block.moved(Y_UP, (0.0, 0.0, 0.0)) for block in blocks], "y.obj"),
        )
    ]
    assert lb.files.read_blocks(files[0]).guesses == ()
    guessed = lb.files.read_blocks(files[1]).guesses
    assert len(guessed) == (said == "support")
    given = {"joint": JOINT, "unit_weight": 20e3, "live": LIVE, "supports": list(names.values())}
    for file, up, asked in ((files[0], None, False), (files[1], None, not guessed), (files[1], "z", False)):
        caplog.clear()
        lb.read(file, **given, up=up)
        assert ("seems to lie on its side: the supports are at the bottom along Y" in caplog.text) == asked


def test_a_table_on_three_legs_stands_with_z_up(tmp_path):
    """Half of its stones, the legs in a row, are on the ground; with Y up the slab would hang in the air."""
    blocks = [lb.Block.box(f"b{k}", (1.0, 1.2, 1.0), (0.0, 1.22 * k, 0.5)) for k in range(3)]
    blocks += [lb.Block.box("b3", (1.0, 3.2, 0.5), (0.0, 1.22, 1.25))]
    blocks += [lb.Block.box(f"b{k}", (0.8, 0.5, 0.5), (0.0, k - 3.5, 1.75)) for k in (4, 5)]
    assert lb.files.read_blocks(lb.files.write_blocks(blocks, tmp_path / "table.obj")).guesses == ()


@pytest.mark.parametrize("layer", ["support", "springers"])
def test_a_flat_vault_on_marked_supports_along_all_its_length_has_z_up(layer, tmp_path):
    """Its voussoirs hang over nothing, and its rings would stand on each other with Y up."""
    size = (1.0, 0.5, 0.3)
    blocks = [
        lb.Block.box(f"b{k} {n}", size, (k, 0.5 * n, 0.1 * k * (4 - k))).labelled(
            layer="vault" if 0 < k < 4 else layer
        )
        for k in range(5)
        for n in range(4)
    ]
    guessed = lb.files.read_blocks(lb.files.write_blocks(blocks, tmp_path / "vault.obj")).guesses
    assert len(guessed) == (layer != "support")


@pytest.mark.parametrize("low", [[0.8], [2.0, 2.3]])
def test_stones_that_jut_out_of_a_wall_have_z_up(low, tmp_path, caplog):
    """Nothing is below the lowest of them, also where the wall is as high as all."""
    stones = [lb.Block.box(f"s{k}", (1.0, 1.2, 0.3), (0.5, 0.9, z + 0.15)) for k, z in enumerate(low)]
    wall = lb.Block.box("support", (1.0, 0.3, 3.0), (0.5, 0.15, 1.5))
    file = lb.files.write_blocks([wall, *stones], tmp_path / "bracket.obj")
    assert lb.files.read_blocks(file).guesses == ()
    lb.read(file, joint=JOINT, unit_weight=20e3, live=LIVE, supports=["support"])
    assert "lie on its side" not in caplog.text


def test_a_format_that_says_its_axis_is_believed_with_a_question(tmp_path):
    """A wall written with Z up into glTF, whose standard is Y up, lies on its back."""
    blocks = [block.moved(Y_UP.T, (0.0, 0.0, 0.0)) for block in plain(EXAMPLES["wall"](JOINT))]
    found = lb.files.read_blocks(lb.files.write_blocks(blocks, tmp_path / "wall.glb"))
    (warning,) = found.guesses
    assert warning.startswith("seems to lie on its side: ")
    assert warning.endswith("if so, say up='z' (--up z)")
    assert np.allclose(found.blocks[0].vertices.min(axis=0), blocks[0].vertices.min(axis=0), atol=1e-5)


@pytest.mark.parametrize(("scale", "unit"), [(1e3, "mm"), (1e2, "cm"), (1.0, "m"), (1 / 0.0254, "m")])
def test_the_unit_is_guessed_where_metres_are_implausible(tmp_path, scale, unit):
    """A wall 3.2 m long: 3200 and 320 are no metres; 126 (inches) might be, and are asked about."""
    blocks = [replace(b, vertices=scale * b.vertices) for b in plain(EXAMPLES["wall"](JOINT))]
    found = lb.files.read_blocks(lb.files.write_blocks(blocks, tmp_path / "wall.obj"))
    said = [line for line in found.guesses if "no unit of length" in line]
    assert len(said) == (scale != 1.0)
    large = "3.2 m large" if unit != "m" else "it is 126 m large with blocks of 15.75 m, in cm 1.26 m"
    assert all(f"taken as {unit}, {large}" in line for line in said)
    width = 3.2 if unit != "m" else 3.2 * scale
    assert np.ptp(np.concatenate([b.vertices for b in found.blocks]), axis=0)[0] == pytest.approx(width)
    assert lb.files.read_blocks(tmp_path / "wall.obj", units="m").guesses == ()


LABELLED = [
    lb.Block.box("base 1", (2, 1, 0.2), (0, 0, -0.1)).labelled(
        unit_weight=None, layer="BASE", material="rock"
    ),
    lb.Block.box("s1", (1, 1, 0.5), (0, 0, 0.25)).labelled(unit_weight=2e4, layer="WALL", material="granite"),
    lb.Block.box("s2", (1, 1, 0.5), (0, 0, 0.75)).labelled(unit_weight=2e4, layer="WALL", material=""),
]


def test_the_material_of_a_layer_in_rhino_is_that_of_its_objects(tmp_path):
    rhino3dm = pytest.importorskip("rhino3dm")
    model, material, layer = rhino3dm.File3dm(), rhino3dm.Material(), rhino3dm.Layer()
    material.Name, layer.Name = "Granite", "Wall"
    layer.RenderMaterialIndex = model.Materials.Add(material)
    attributes = rhino3dm.ObjectAttributes()
    attributes.Name, attributes.LayerIndex = "stone", model.Layers.Add(layer)
    corners = rhino3dm.BoundingBox(rhino3dm.Point3d(0, 0, 0), rhino3dm.Point3d(1, 2, 3))
    model.Objects.AddBrep(rhino3dm.Brep.CreateFromBox(rhino3dm.Box(corners)), attributes)
    assert model.Write(str(tmp_path / "a.3dm"), 7)
    (block,) = lb.files.read_blocks(tmp_path / "a.3dm").blocks
    assert (block.name, block.layer, block.material) == ("stone", "Wall", "Granite")


def test_healing_keeps_labels():
    rng = np.random.default_rng(2)
    wall = lb.structures.corner(JOINT, length=2.4, return_length=2.4, courses=3)
    rough = [
        lb.Block(b.name, b.vertices + rng.uniform(-1e-3, 1e-3, b.vertices.shape), b.triangles.tolist(),
                 layer=f"layer {k}", material="stone")
        for k, b in enumerate(wall.blocks)
    ]  # fmt: skip
    healed = lb.heal(rough)
    assert max(healed.displacements.values()) > 0.0
    assert [(b.layer, b.material) for b in healed.blocks] == [(b.layer, "stone") for b in rough]


def test_likely_supports():
    base, s1, s2 = (lb.Block.box(b.name, (1, 1, 0.5), (0, 0, 0.5 * k)) for k, b in enumerate(LABELLED))
    first = likely_supports(LABELLED)[0]
    assert (first.chosen_by, first.blocks) == (("layer:BASE",), ("base 1",))
    first = likely_supports([base, s1, s2])[0]
    assert (first.chosen_by, first.reason) == (("base 1",), "by name")
    (only,) = likely_supports([s1, s2])
    assert (only.chosen_by, only.blocks) == (("z<0.77",), ("s1",))
    four = [lb.Block.box(f"ground {k}", (1, 1, 1), (2 * k, 0, 0)) for k in range(4)]
    top = lb.Block.box("top", (9, 1, 1), (3, 0, 1))
    assert likely_supports([*four, top])[0].chosen_by == ("name:ground *",)
    assert likely_supports([top]) == ()


FOREIGN = (
    "Appoggi,FONDAZIONE,spalla_dx,apoyos,cimentación,ESTRIBO 2,suelo,apoio,Fundação,sapata1,appuis,culée,"
    "SOCLE,Auflager,Fundamente,Widerlager links,02_Boden"
)


@pytest.mark.parametrize("word", FOREIGN.split(","))
def test_supports_are_named_in_other_languages(word):
    (s1, s2), other = (lb.Block.box(f"s{k}", (1, 1, 0.5), (0, 0, 0.5 * k)) for k in range(2)), "spalletta"
    chosen = likely_supports([replace(s1, layer=other), replace(s2, layer=word)])[0]
    assert chosen.chosen_by == (f"layer:{word}",)


def test_look_warns_of_debris(tmp_path):
    blocks = [lb.Block.box(f"b{k}", (1, 1, 1), (0, 0, k)) for k in range(4)]
    blocks.append(lb.Block.box("crumb", (0.01, 0.01, 0.01), (3, 0, 0)))
    seen = look(lb.files.write_blocks(blocks, tmp_path / "a.obj"))
    assert any("'crumb', 1e-06 m3" in line for line in seen.warnings)
    assert str(seen) == f"{tmp_path / 'a.obj'}: 5 blocks, 3.505 x 1 x 4 m"


def document():
    """A model file with materials: granite by a pattern, rock by the name of the layer."""
    return {
        "schema_version": 1,
        "units": {"force": "kN"},
        "blocks": [
            {"name": "base", "layer": "rock", "box": {"size": [2, 1, 0.2], "at": [0, 0, -0.1]}},
            {"name": "a", "box": {"size": [1, 1, 1], "at": [0, 0, 0.5]}},
            {"name": "b", "box": {"size": [1, 1, 1], "at": [0, 0, 1.5]}, "material": "brick"},
        ],
        "supports": ["base"],
        "joints": {},
        "materials": {
            "rock": {},
            "granite": {
                "blocks": ["a"],
                "unit_weight": 26.0,
                "joint": {"type": "OrdunaLourenco", "friction": 0.7, "compressive_strength": 9e3},
            },
            "brick": {"unit_weight": 18.0, "joint": {"type": "OrdunaLourenco", "friction": 0.5}},
        },
        "interfaces": {"find": {"joint": None}},
        "live": [{"type": "MassProportional", "direction": [1, 0, 0]}],
    }


def saved(tmp_path, change):
    import json

    (tmp_path / "model.json").write_text(json.dumps(document() | change))
    return tmp_path / "model.json"


def test_a_model_file_with_materials(tmp_path):
    model = lb.read(saved(tmp_path, {}))
    assert [block.unit_weight for block in model.blocks] == [None, 26e3, 18e3]
    assert [interface.joint for interface in model.interfaces] == [
        lb.OrdunaLourenco(0.7, compressive_strength=9e6),
        lb.OrdunaLourenco(0.5, compressive_strength=9e6),
    ]
    pair = {"between": ["brick", "granite"], "joint": {"type": "PointContact", "friction": 0.3}}
    model = lb.read(saved(tmp_path, {"pairs": [pair]}))
    assert model.interfaces[1].joint == lb.PointContact(0.3)
    again = lb.read(model.save(tmp_path / "again.json"))
    assert again.digest == model.digest


WRONG = {
    "no joint": ({"materials": {"rock": {"blocks": ["*"], "unit_weight": 1.0}}},
                 "interface a|b: materials 'rock' and 'rock' have no joint; give one or the pair"),
    "nothing": ({"materials": {}}, "interfaces.find.joint is null, and there are no materials that have"),
    "pair": ({"pairs": [{"between": ["brick", "stone"], "joint": {"type": "PointContact", "friction": 1}}]},
             "pairs: pair names material 'stone', which is not there"),
    "bare": ({"materials": {"rock": {"blocks": ["base"]}}}, "materials: 2 blocks have no material"),
}  # fmt: skip


@pytest.mark.parametrize("name", WRONG)
def test_wrong_materials_of_a_model_file(tmp_path, name):
    change, said = WRONG[name]
    with pytest.raises(lb.ModelError) as caught:
        lb.read(saved(tmp_path, change))
    assert said in str(caught.value)


def test_read_with_materials(tmp_path, caplog):
    table = Materials(
        {
            "rock": Material(blocks=["layer:BASE"]),
            "granite": Material(26e3, JOINT, ["layer:WALL"]),
            "brick": Material(18e3, lb.OrdunaLourenco(0.5), ["layer:VAULT"]),
        }
    )
    file = lb.files.write_blocks(LABELLED, tmp_path / "a.3dm")
    with caplog.at_level(logging.WARNING):
        model = lb.read(file, materials=table, supports="layer:BASE", live=LIVE)
    assert "material 'brick': pattern 'layer:VAULT' matches no layer; there are layers" in caplog.text
    assert [block.material for block in model.blocks] == ["rock", "granite", "granite"]
    assert model.free_blocks[0].unit_weight == 26e3
    with pytest.raises(lb.ModelError, match="joint and materials are both given"):
        lb.read(file, joint=JOINT, materials=table, supports="layer:BASE", live=LIVE)
    with pytest.raises(
        lb.ModelError, match=r"give supports=... to read a model, such as 'layer:BASE'; there are"
    ):
        lb.read(file, joint=JOINT, live=LIVE)


def test_a_drawing_too_large_for_metres_keeps_its_thickness(tmp_path):
    """An elevation in mm that does not say so: thickness is in m all the same."""
    ezdxf = pytest.importorskip("ezdxf")
    drawing = ezdxf.new(units=0)
    for k in range(3):
        z = 300 * k
        drawing.modelspace().add_lwpolyline([(0, z), (800, z), (800, z + 300), (0, z + 300)], close=True)
    drawing.saveas(tmp_path / "pillar.dxf")
    pillar = lb.files.read_drawing(tmp_path / "pillar.dxf", thickness=0.4)
    assert "taken as mm" in pillar.guesses[0]
    assert pillar.blocks[0].volume == pytest.approx(0.8 * 0.3 * 0.4)

import random
import sys

import numpy as np
import pytest
from dxf_files import STRUCTURES
from reading import fault, outcome

import limitblocks as lb
from limitblocks.io.formats.rhino import chunks

rhino3dm = pytest.importorskip("rhino3dm")

L_SHAPE = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]


@pytest.fixture(autouse=True)
def trials(request, monkeypatch):
    """Sound files are read without a trial, which takes a new process."""
    if not request.node.name.startswith(("test_endless", "test_damaged", "test_old")):
        monkeypatch.setattr("limitblocks.io.formats.rhino.trial.fault", lambda path: "")


class Drawing:
    """A Rhino file to be."""

    def __init__(self, units="Meters"):
        self.model = rhino3dm.File3dm()
        self.model.Settings.ModelUnitSystem = getattr(rhino3dm.UnitSystem, units)

    def layer(self, name, above=None, visible=True):
        layer = rhino3dm.Layer()
        layer.Name, layer.Visible = name, visible
        if above is not None:
            layer.ParentLayerId = self.model.Layers[above].Id
        return self.model.Layers.Add(layer)

    @staticmethod
    def attributes(name="", layer=0, visible=True):
        attributes = rhino3dm.ObjectAttributes()
        attributes.Name, attributes.LayerIndex, attributes.Visible = name, layer, visible
        return attributes

    def add(self, geometry, *about, **more):
        self.model.Objects.Add(geometry, self.attributes(*about, **more))

    def saved(self, path, version=7):
        assert self.model.Write(str(path), version)
        return path


def box(low=(0, 0, 0), high=(1, 1, 1)):
    span = rhino3dm.BoundingBox(rhino3dm.Point3d(*low), rhino3dm.Point3d(*high))
    return rhino3dm.Brep.CreateFromBox(rhino3dm.Box(span))


def extrusion(outline, height):
    line = rhino3dm.Polyline()
    for x, y in [*outline, outline[0]]:
        line.Add(x, y, 0)
    return rhino3dm.Extrusion.Create(line.ToPolylineCurve(), height, True)


def test_every_digit_survives_far_from_the_origin(tmp_path):
    blocks = [lb.Block.box("a", (1 / 3, 1 / 7, 1.1), (123456.7, -765432.1, 1 / 3))]
    imported = lb.files.read_blocks(lb.files.write_blocks(blocks, tmp_path / "a.3dm"))
    assert {*map(tuple, imported.blocks[0].vertices.tolist())} == {*map(tuple, blocks[0].vertices.tolist())}


def test_block_that_is_not_convex(tmp_path):
    drawing = Drawing()
    drawing.add(extrusion(L_SHAPE, 2.0), "L")
    imported = lb.files.read_blocks(drawing.saved(tmp_path / "a.3dm"))
    assert imported.blocks[0].volume == pytest.approx(3.0 * 2.0, rel=1e-12)
    again = lb.files.read_blocks(lb.files.write_blocks(imported, tmp_path / "b.3dm"))
    assert again.blocks[0].volume == pytest.approx(3.0 * 2.0, rel=1e-12)


def test_polysurfaces_extrusions_layers_and_what_is_hidden(tmp_path):
    drawing = Drawing("Millimeters")
    support = drawing.layer("Support")
    stone = drawing.layer("stone")
    hidden = drawing.layer("x", visible=False)
    north, below = drawing.layer("north", above=stone), drawing.layer("below", above=hidden)
    drawing.add(box((0, 0, -100), (1000, 1000, 0)), "ground", support)
    drawing.add(extrusion([(0, 0), (1000, 0), (500, 1000)], 500), "wedge", north)
    drawing.add(box(), "no", stone, visible=False)
    drawing.add(box(), "no", hidden)
    drawing.add(box(), "no", below)
    drawing.model.Objects.AddLine(rhino3dm.Point3d(0, 0, 0), rhino3dm.Point3d(1, 1, 1))
    imported = lb.files.read_blocks(drawing.saved(tmp_path / "a.3dm"))
    assert [block.name for block in imported.blocks] == ["ground", "wedge"]
    assert [block.volume for block in imported.blocks] == pytest.approx([0.1, 0.25], rel=1e-12)
    assert dict(imported.layers) == {"ground": "Support", "wedge": "stone::north"}
    assert imported.supports == ("ground",)
    assert imported.notes == ("left out: 1 LineCurve, 3 hidden objects",)
    again = lb.files.read_blocks(lb.files.write_blocks(imported, tmp_path / "b.3dm"))
    assert (again.layers, again.supports) == (imported.layers, ("ground",))


def test_groups_and_colours_come_through_instances(tmp_path):
    """Colours of the object, the layer and the instance; a group of an instance is that of what is in it."""
    drawing = Drawing()
    for name in ("left", "empty"):
        group = rhino3dm.Group()
        group.Name = name
        drawing.model.Groups.Add(group)
    sources, red, plain = rhino3dm.ObjectColorSource, drawing.layer("red"), drawing.layer("plain")
    drawing.model.Layers[red].Color = (255, 0, 0, 255)
    own, inner, outer = (drawing.attributes(name, plain) for name in ("own", "inner", "outer"))
    own.ObjectColor, own.ColorSource = (1, 2, 3, 255), sources.ColorFromObject
    inner.ColorSource = sources.ColorFromParent
    drawing.model.InstanceDefinitions.Add("one", "", "", "", rhino3dm.Point3d(0, 0, 0), (box(),), (inner,))
    key = next(iter(drawing.model.InstanceDefinitions)).Id
    outer.ObjectColor, outer.ColorSource = (4, 5, 6, 255), sources.ColorFromObject
    outer.AddToGroup(0)
    drawing.model.Objects.Add(box((2, 0, 0), (3, 1, 1)), own)
    drawing.model.Objects.Add(rhino3dm.InstanceReference(key, rhino3dm.Transform.Identity()), outer)
    drawing.add(box((4, 0, 0), (5, 1, 1)), "by layer", red)
    drawing.add(box((6, 0, 0), (7, 1, 1)), "none", plain)
    found = lb.files.read_blocks(drawing.saved(tmp_path / "a.3dm"))
    assert {block.name: block.colour for block in found.blocks} == {
        "own": "#010203",
        "outer": "#040506",
        "by layer": "#ff0000",
        "none": "",
    }
    assert {block.name for block in found.blocks if block.groups == ("left",)} == {"outer"}
    assert not found.notes


@pytest.mark.parametrize(("units", "metres"), [("Centimeters", 0.01), ("Feet", 0.3048), ("Inches", 0.0254)])
def test_units(tmp_path, units, metres):
    drawing = Drawing(units)
    drawing.add(box())
    path = drawing.saved(tmp_path / "a.3dm")
    assert lb.files.read_blocks(path).blocks[0].size == pytest.approx(metres, rel=1e-12)
    assert lb.files.read_blocks(path, units="mm").blocks[0].size == pytest.approx(1e-3, rel=1e-12)


def test_no_unit_and_a_strange_unit(tmp_path):
    for units, expected in (("None", "states no unit"), ("LightYears", "LightYears")):
        drawing = Drawing(units)
        drawing.add(box())
        path = drawing.saved(tmp_path / f"{units}.3dm")
        said = "".join(lb.files.read_blocks(path).notes) if units == "None" else fault(path)
        assert expected in said


def test_instances(tmp_path):
    drawing = Drawing()
    layer = drawing.layer("stone")
    shape, about = (box(high=(1, 2, 3)),), (drawing.attributes("inner", layer),)
    drawing.model.InstanceDefinitions.Add("stone", "", "", "", rhino3dm.Point3d(0, 0, 0), shape, about)
    key = next(iter(drawing.model.InstanceDefinitions)).Id
    turn = rhino3dm.Transform.Rotation(np.pi / 2, rhino3dm.Vector3d(0, 0, 1), rhino3dm.Point3d(0, 0, 0))
    for k, scale in enumerate((1.0, 2.0, -1.0)):
        place = rhino3dm.Transform.Translation(10.0 * k, 1 / 3, 1e6 + 0.1)
        place.M22 = scale
        drawing.add(rhino3dm.InstanceReference(key, place), f"i{k}", layer)
    drawing.add(rhino3dm.InstanceReference(key, turn), "turned", layer)
    imported = lb.files.read_blocks(drawing.saved(tmp_path / "a.3dm"))
    assert [block.name for block in imported.blocks] == ["i0", "i1", "i2", "turned"]
    assert [block.volume for block in imported.blocks] == pytest.approx([6.0, 12.0, 6.0, 6.0], rel=1e-9)
    heights = (1.5, 3.0, -1.5)
    for k in range(3):
        middle = [10.0 * k + 0.5, 1 / 3 + 1.0, 1e6 + 0.1 + heights[k]]
        assert imported.blocks[k].centroid == pytest.approx(middle, rel=1e-12)
    assert imported.blocks[3].centroid == pytest.approx([-1.0, 0.5, 1.5], rel=1e-12)
    assert not imported.notes


def curved():
    return rhino3dm.Sphere(rhino3dm.Point3d(0, 0, 0), 1.0).ToBrep()


def open_box():
    plane = rhino3dm.Plane(rhino3dm.Point3d(0, 0, 0), rhino3dm.Vector3d(0, 0, 1))
    return rhino3dm.Brep.CreateTrimmedPlane(plane, rhino3dm.Circle(1.0).ToNurbsCurve())


def triangle():
    mesh = rhino3dm.Mesh()
    for x, y in ((0, 0), (1, 0), (0, 1)):
        mesh.Vertices.AddPoint3d(x, y, 0)
    mesh.Faces.AddFace(0, 1, 2)
    return mesh


@pytest.mark.parametrize(
    ("make", "expected"),
    [(curved, "curved faces or edges"), (open_box, "is open; join and cap"), (triangle, "3 vertices")],
)
def test_solids_that_cannot_be_read_are_named(tmp_path, make, expected):
    drawing = Drawing()
    drawing.add(box(), "good")
    drawing.add(make(), "bad one")
    message = fault(drawing.saved(tmp_path / "a.3dm"))
    assert expected in message
    assert "'bad one'" in message


def test_nothing_in_it(tmp_path):
    drawing = Drawing()
    drawing.model.Objects.AddPoint(rhino3dm.Point3d(0, 0, 0))
    assert "holds no solid but 1 Point" in fault(drawing.saved(tmp_path / "a.3dm"))


def test_old_versions(tmp_path):
    drawing = Drawing()
    drawing.add(box())
    assert len(lb.files.read_blocks(drawing.saved(tmp_path / "5.3dm", version=5)).blocks) == 1
    assert "Rhino 5 or later" in fault(drawing.saved(tmp_path / "4.3dm", version=4))


def test_files_that_are_no_3dm(tmp_path):
    good = lb.files.write_blocks(STRUCTURES["wall"], tmp_path / "good.3dm").read_bytes()
    cases = [(b"", "is empty"), (b"garbage" * 100, "does not begin as one"), (good[:40], "not a whole 3dm")]
    cases += [(good[:cut], "not a whole 3dm") for cut in (len(good) // 2, len(good) - 1, len(good) - 20)]
    for data, expected in cases:
        path = tmp_path / "a.3dm"
        path.write_bytes(data)
        assert expected in fault(path)


def test_endless_search_of_rhino3dm_is_cut_off(tmp_path, monkeypatch):
    """A length within the data of a mesh that reaches far beyond the file; rhino3dm 8.35 does not return."""
    monkeypatch.setattr("limitblocks.io.formats.rhino.trial.SECONDS", 1.0)
    data = bytearray(lb.files.write_blocks(STRUCTURES["wall"], tmp_path / "a.3dm").read_bytes())
    objects = data.find((0x20008070).to_bytes(4, "little"))
    nested = data.find((0x40008000).to_bytes(4, "little"), objects)
    data[nested + 11] = 0x31
    assert not chunks.fault(bytes(data))
    (tmp_path / "a.3dm").write_bytes(data)
    assert "3dm" in fault(tmp_path / "a.3dm")


def test_damaged_files_read_or_fail_cleanly(tmp_path):
    chance = random.Random(1)
    data = lb.files.write_blocks(STRUCTURES["wall"].blocks[:2], tmp_path / "good.3dm").read_bytes()
    path = tmp_path / "a.3dm"
    ends = []
    for _ in range(25):
        bad = bytearray(data)
        k = chance.randrange(len(bad) - 20)
        match chance.randrange(4):
            case 0:
                bad[k] = chance.randrange(256)
            case 1:
                del bad[k : k + chance.randrange(1, 100)]
            case 2:
                bad[k:k] = bad[: chance.randrange(1, 100)]
            case _:
                bad[k : k + 8] = np.float64(chance.choice((np.nan, np.inf, 1e300))).tobytes()
        bad[-8:] = len(bad).to_bytes(8, "little")
        path.write_bytes(bad)
        ends.append(outcome(path))
    assert sum(isinstance(end, str) for end in ends) > 10


def test_without_rhino3dm(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "rhino3dm", None)
    with pytest.raises(lb.errors.MissingDependency, match="pip install 'rhino3dm>="):
        lb.files.write_blocks(STRUCTURES["wall"], tmp_path / "a.3dm")
    with pytest.raises(lb.errors.MissingDependency, match="pip install 'rhino3dm>="):
        lb.files.read_blocks(tmp_path / "a.3dm")


def test_layers_named_support_within_other_layers_are_of_supports(tmp_path):
    """A beam of 3 m on two stones, of which one is on a layer within another; it slides at its friction."""
    stones = [
        lb.Block.box("left", (1.0, 1.0, 1.0), (0.0, 0.0, 0.5)).labelled(layer="Support"),
        lb.Block.box("right", (1.0, 1.0, 1.0), (2.0, 0.0, 0.5)).labelled(layer="annex::support"),
        lb.Block.box("beam", (3.0, 1.0, 0.5), (1.0, 0.0, 1.25)).labelled(layer="annex"),
    ]
    path = lb.files.write_blocks(stones, tmp_path / "a.3dm")
    model = lb.read(path, joint=lb.OrdunaLourenco(0.6), unit_weight=2e4, live=lb.mass_proportional((1, 0, 0)))
    assert model.supports == ("left", "right")
    assert lb.bounds(model).upper == pytest.approx(0.6, abs=1e-6)

"""Blocks and results as a Rhino 3dm file: meshes in double precision, with names, on layers, in metres."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from types import ModuleType
from typing import Any

from limitblocks.drawing.arrows import Picture
from limitblocks.errors import LimitBlocksError
from limitblocks.geometry import Block
from limitblocks.io.colours import parts_of
from limitblocks.io.packages import package

_VERSION = 7  # of Rhino, that can open the file
#: Colours of the layers, red, green, blue, opacity.
_COLOURS = {"blocks": (150, 140, 120, 255), "displaced": (213, 94, 0, 255), "forces": (0, 114, 178, 255)}


def encoded(blocks: Sequence[Block], fixed: Sequence[bool]) -> bytes:
    """Return the file; faces of more than four sides, or of blocks that are not convex, become triangles."""
    drawing = _Drawing()
    for block in blocks:
        drawing.block(block, block.layer or "block")
    return drawing.encoded()


def with_forces(shown: Picture) -> bytes:
    """Return the file; each arrow has its force, moment and scale as user text, in N, N m and m/N."""
    drawing = _Drawing()
    for layer in _COLOURS:
        drawing.layer(layer)
    for block in shown.blocks:
        drawing.block(block, "blocks")
    for block in shown.displaced:
        drawing.block(block, "displaced")
    for k in shown.drawn:
        _arrow(drawing, shown, k)
    _key(drawing, shown)
    for layer, colour in _COLOURS.items():
        drawing.model.Layers[drawing.layer(layer)].Color = colour
    return drawing.encoded()


def _arrow(drawing: _Drawing, shown: Picture, k: int) -> None:
    attributes = drawing.attributes(shown.names[k], "forces")
    attributes.ObjectDecoration = drawing.rhino3dm.ObjectDecoration.EndArrowhead
    i, j = shown.pairs[k]
    said = {
        "force, N": _numbers(shown.force[k]),
        "moment, N m": _numbers(shown.moment[k]),
        "from block": shown.blocks[i].name,
        "on block": shown.blocks[j].name,
        "scale, m/N": repr(shown.scale),
    }
    for key, text in said.items():
        attributes.SetUserString(key, text)
    tail, tip = (drawing.rhino3dm.Point3d(*end.tolist()) for end in (shown.at[k], shown.tips[k]))
    drawing.model.Objects.AddLine(tail, tip, attributes)


def _key(drawing: _Drawing, shown: Picture) -> None:
    """Add a text that says the scales, at the lowest corner of the structure."""
    low = min(tuple(block.vertices.min(axis=0).tolist()) for block in shown.blocks)
    text = f"load factor {shown.load_factor:.6g}; arrows: 1 m is {1.0 / shown.scale:g} N"
    if shown.displaced:
        text += f"; displacement rates times {shown.magnification:.4g}"
    attributes = drawing.attributes("scale", "forces")
    drawing.model.Objects.AddTextDot(text, drawing.rhino3dm.Point3d(*low), attributes)


def _numbers(values: Any) -> str:
    return ", ".join(map(repr, values.tolist()))


class _Drawing:
    """A Rhino file to be."""

    def __init__(self) -> None:
        self.rhino3dm = package("rhino3dm", "3dm")
        self.model = self.rhino3dm.File3dm()
        self.model.Settings.ModelUnitSystem = self.rhino3dm.UnitSystem.Meters
        self.layers: dict[str, int] = {}
        self.materials: dict[str, int] = {}
        self.groups: dict[str, int] = {}

    def encoded(self) -> bytes:
        """Return the file."""
        with TemporaryDirectory() as folder:  # rhino3dm writes to files only
            file = Path(folder) / "blocks.3dm"
            if not self.model.Write(str(file), _VERSION):
                raise LimitBlocksError("rhino3dm could not write the blocks")
            return file.read_bytes()

    def attributes(self, name: str, layer: str) -> Any:
        """Return the attributes of an object with a name on a layer."""
        attributes = self.rhino3dm.ObjectAttributes()
        attributes.Name = _valid(name)
        attributes.LayerIndex = self.layer(layer)
        return attributes

    def block(self, block: Block, layer: str) -> None:
        """Add a block as a mesh."""
        attributes = self.attributes(block.name, layer)
        if block.material:
            attributes.MaterialIndex = self.material(block.material)
            attributes.MaterialSource = self.rhino3dm.ObjectMaterialSource.MaterialFromObject
        if block.colour:
            attributes.ObjectColor = (*parts_of(block.colour), 255)
            attributes.ColorSource = self.rhino3dm.ObjectColorSource.ColorFromObject
        for name in block.groups:
            attributes.AddToGroup(self.group(name))
        self.model.Objects.AddMesh(_mesh(self.rhino3dm, block), attributes)

    def layer(self, path: str) -> int:
        """Return the number of the layer with a path such as "walls::north", made where there is none."""
        if path not in self.layers:
            above, _, name = path.rpartition("::")
            layer = self.rhino3dm.Layer()
            layer.Name = _valid(name)
            if above:
                layer.ParentLayerId = self.model.Layers[self.layer(above)].Id
            self.layers[path] = self.model.Layers.Add(layer)
        return self.layers[path]

    def group(self, name: str) -> int:
        """Return the number of the group with this name, made where there is none."""
        if name not in self.groups:
            group = self.rhino3dm.Group()
            group.Name = _valid(name)
            self.groups[name] = len(self.groups)
            self.model.Groups.Add(group)
        return self.groups[name]

    def material(self, name: str) -> int:
        """Return the number of the material with this name, made where there is none."""
        if name not in self.materials:
            material = self.rhino3dm.Material()
            material.Name = _valid(name)
            self.materials[name] = self.model.Materials.Add(material)
        return self.materials[name]


def _valid(name: str) -> str:
    """Return a name without a bracket as its first letter: rhino3dm drops such names without a word."""
    return re.sub(r"^[][(){}]", "_", name)


def _mesh(rhino3dm: ModuleType, block: Block) -> Any:
    mesh = rhino3dm.Mesh()
    for x, y, z in block.vertices.tolist():
        mesh.Vertices.AddPoint3d(x, y, z)  # in double precision, unlike Add
    quads = block.convex and max(map(len, block.faces)) <= 4
    for loop in block.faces if quads else block.triangles.tolist():
        mesh.Faces.AddFace(*loop)
    mesh.Normals.ComputeNormals()
    return mesh

"""Blocks as a Rhino 3dm file: meshes in double precision, with names, on layers, in metres."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from types import ModuleType
from typing import Any

from limitblocks.errors import LimitBlocksError
from limitblocks.geometry import Block
from limitblocks.io.colours import parts_of
from limitblocks.io.packages import package

_VERSION = 7  # of Rhino, that can open the file


def encoded(blocks: Sequence[Block], layers: Mapping[str, str], supports: Container[str]) -> bytes:
    """Return the file; faces of more than four sides, or of blocks that are not convex, become triangles."""
    drawing = Drawing()
    for block in blocks:
        drawing.block(block, layers.get(block.name, "") or "block")
    return drawing.encoded()


class Drawing:
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
        attributes.Name = name
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
            layer.Name = name
            if above:
                layer.ParentLayerId = self.model.Layers[self.layer(above)].Id
            self.layers[path] = self.model.Layers.Add(layer)
        return self.layers[path]

    def group(self, name: str) -> int:
        """Return the number of the group with this name, made where there is none."""
        if name not in self.groups:
            group = self.rhino3dm.Group()
            group.Name = name
            self.groups[name] = len(self.groups)
            self.model.Groups.Add(group)
        return self.groups[name]

    def material(self, name: str) -> int:
        """Return the number of the material with this name, made where there is none."""
        if name not in self.materials:
            material = self.rhino3dm.Material()
            material.Name = name
            self.materials[name] = self.model.Materials.Add(material)
        return self.materials[name]


def _mesh(rhino3dm: ModuleType, block: Block) -> Any:
    mesh = rhino3dm.Mesh()
    for x, y, z in block.vertices.tolist():
        mesh.Vertices.AddPoint3d(x, y, z)  # in double precision, unlike Add
    quads = block.convex and max(map(len, block.faces)) <= 4
    for loop in block.faces if quads else block.triangles.tolist():
        mesh.Faces.AddFace(*loop)
    mesh.Normals.ComputeNormals()
    return mesh

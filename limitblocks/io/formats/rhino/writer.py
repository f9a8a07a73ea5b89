"""Blocks as a Rhino 3dm file: meshes in double precision, with names, on layers, in metres."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from types import ModuleType
from typing import Any

from limitblocks.errors import LimitBlocksError
from limitblocks.geometry import Block
from limitblocks.io.packages import package

_VERSION = 7  # of Rhino, that can open the file


def encoded(blocks: Sequence[Block], layers: Mapping[str, str], supports: Container[str]) -> bytes:
    """Return the file; faces of more than four sides, or of blocks that are not convex, become triangles."""
    rhino3dm = package("rhino3dm", "3dm")
    model = rhino3dm.File3dm()
    model.Settings.ModelUnitSystem = rhino3dm.UnitSystem.Meters
    numbers: dict[str, int] = {}
    materials: dict[str, int] = {}
    for block in blocks:
        attributes = rhino3dm.ObjectAttributes()
        attributes.Name = block.name
        attributes.LayerIndex = _layer(rhino3dm, model, numbers, layers.get(block.name, "") or "block")
        if block.material:
            attributes.MaterialIndex = _material(rhino3dm, model, materials, block.material)
            attributes.MaterialSource = rhino3dm.ObjectMaterialSource.MaterialFromObject
        model.Objects.AddMesh(_mesh(rhino3dm, block), attributes)
    with TemporaryDirectory() as folder:  # rhino3dm writes to files only
        file = Path(folder) / "blocks.3dm"
        if not model.Write(str(file), _VERSION):
            raise LimitBlocksError("rhino3dm could not write the blocks")
        return file.read_bytes()


def _layer(rhino3dm: ModuleType, model: Any, numbers: dict[str, int], path: str) -> int:
    """Return the number of the layer with a path such as "walls::north", made where there is none."""
    if path not in numbers:
        above, _, name = path.rpartition("::")
        layer = rhino3dm.Layer()
        layer.Name = name
        if above:
            layer.ParentLayerId = model.Layers[_layer(rhino3dm, model, numbers, above)].Id
        numbers[path] = model.Layers.Add(layer)
    return numbers[path]


def _material(rhino3dm: ModuleType, model: Any, numbers: dict[str, int], name: str) -> int:
    """Return the number of the material with this name, made where there is none."""
    if name not in numbers:
        material = rhino3dm.Material()
        material.Name = name
        numbers[name] = model.Materials.Add(material)
    return numbers[name]


def _mesh(rhino3dm: ModuleType, block: Block) -> Any:
    mesh = rhino3dm.Mesh()
    for x, y, z in block.vertices.tolist():
        mesh.Vertices.AddPoint3d(x, y, z)  # in double precision, unlike Add
    quads = block.convex and max(map(len, block.faces)) <= 4
    for loop in block.faces if quads else block.triangles.tolist():
        mesh.Faces.AddFace(*loop)
    mesh.Normals.ComputeNormals()
    return mesh

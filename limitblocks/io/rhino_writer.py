"""Blocks as a Rhino 3dm file: meshes in double precision, with names, on layers, in metres."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from types import ModuleType
from typing import Any

from limitblocks.errors import LimitBlocksError
from limitblocks.geometry import Block
from limitblocks.io.rhino import rhino3dm

_VERSION = 7  # of Rhino, that can open the file


def rhino(blocks: Sequence[Block], layers: Mapping[str, str]) -> bytes:
    """Return the file; faces of more than four sides, or of blocks that are not convex, become triangles."""
    package = rhino3dm()
    model = package.File3dm()
    model.Settings.ModelUnitSystem = package.UnitSystem.Meters
    numbers: dict[str, int] = {}
    for block in blocks:
        attributes = package.ObjectAttributes()
        attributes.Name = block.name
        attributes.LayerIndex = _layer(package, model, numbers, layers.get(block.name, "") or "block")
        model.Objects.AddMesh(_mesh(package, block), attributes)
    with TemporaryDirectory() as folder:  # rhino3dm writes to files only
        file = Path(folder) / "blocks.3dm"
        if not model.Write(str(file), _VERSION):
            raise LimitBlocksError("rhino3dm could not write the blocks")
        return file.read_bytes()


def _layer(package: ModuleType, model: Any, numbers: dict[str, int], path: str) -> int:
    """Return the number of the layer with a path such as "walls::north", made where there is none."""
    if path not in numbers:
        above, _, name = path.rpartition("::")
        layer = package.Layer()
        layer.Name = name
        if above:
            layer.ParentLayerId = model.Layers[_layer(package, model, numbers, above)].Id
        numbers[path] = model.Layers.Add(layer)
    return numbers[path]


def _mesh(package: ModuleType, block: Block) -> Any:
    mesh = package.Mesh()
    for x, y, z in block.vertices.tolist():
        mesh.Vertices.AddPoint3d(x, y, z)  # in double precision, unlike Add
    quads = block.convex and max(map(len, block.faces)) <= 4
    for loop in block.faces if quads else block.triangles.tolist():
        mesh.Faces.AddFace(*loop)
    mesh.Normals.ComputeNormals()
    return mesh

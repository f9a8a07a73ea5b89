"""Formats of other programs, a module each: `contents(path)` reads, `encoded(blocks, fixed)` writes.

Those in FORCES have `with_forces(picture)`, too.
"""

from importlib import import_module
from typing import Any

_MODULES = {
    ".obj": "obj",
    ".stl": "stl",
    ".ply": "ply",
    ".glb": "gltf",
    ".gltf": "gltf",
    ".dxf": "dxf",
    ".3dm": "rhino",
    ".json": "compas",
}
#: Suffixes of files that blocks are read from, and written to.
READ = tuple(_MODULES)
#: What to do with files of other formats.
INSTEAD = {
    ".ifc": "export meshes, an object an element, as by IfcConvert house.ifc house.obj --use-element-guids",
    ".dwg": "save it as DXF",
    ".skp": "export OBJ or DXF, a group a stone",
    ".blend": "export OBJ, with the option Objects as OBJ Objects",
    ".step": "export meshes, as OBJ or STL, a solid a stone",
    ".stp": "export meshes, as OBJ or STL, a solid a stone",
}
WRITTEN = tuple(suffix for suffix in _MODULES if suffix != ".gltf")
#: Suffixes of files that results are written to beside the blocks.
FORCES = (".3dm", ".json", ".glb")


def module(suffix: str) -> Any:
    """Return the module of the format with this suffix, imported when it is first asked for."""
    return import_module(f"limitblocks.io.formats.{_MODULES[suffix.lower()]}")

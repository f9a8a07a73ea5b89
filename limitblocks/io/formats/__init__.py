"""Formats of other programs, a module each: `contents(path)` reads, `encoded(blocks, layers)` writes."""

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
WRITTEN = tuple(suffix for suffix in _MODULES if suffix != ".gltf")


def module(suffix: str) -> Any:
    """Return the module of the format with this suffix, imported when it is first asked for."""
    return import_module(f"limitblocks.io.formats.{_MODULES[suffix.lower()]}")

"""Packages that are installed with an extra: `pip install limitblocks[meshes]`."""

from __future__ import annotations

from importlib import import_module
from types import ModuleType

from limitblocks.errors import MissingDependency

_EXTRAS = {"ezdxf": "dxf", "meshio": "meshes", "rhino3dm": "rhino", "trimesh": "meshes"}


def package(name: str, files: str) -> ModuleType:
    """Return the package `name`, or a module in it; `files` are what it is for.

    Raises
    ------
    MissingDependency
        It is not installed.
    """
    try:
        return import_module(name)
    except ImportError:
        root = name.partition(".")[0]
        raise MissingDependency(
            f"{files} files need {root}: pip install limitblocks[{_EXTRAS[root]}]"
        ) from None

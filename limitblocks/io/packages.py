"""Packages that are installed with an extra: `pip install limitblocks[meshes]`."""

from __future__ import annotations

from importlib import import_module
from types import ModuleType

from limitblocks.errors import MissingDependency


def package(name: str, files: str) -> ModuleType:
    """Return the package `name`, or a module in it, of the extra `meshes`; `files` are what it is for.

    Raises
    ------
    MissingDependency
        It is not installed.
    """
    try:
        return import_module(name)
    except ImportError:
        raise MissingDependency(
            f"{files} files need {name.partition('.')[0]}: pip install limitblocks[meshes]"
        ) from None

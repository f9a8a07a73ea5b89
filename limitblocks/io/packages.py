"""Packages of the extras: found when they are needed, and what to install where they are not."""

from __future__ import annotations

import re
from importlib import import_module, metadata
from types import ModuleType

from limitblocks.errors import MissingDependency


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
        raise missing(name, files if files.endswith("()") else f"{files} files") from None


def missing(name: str, user: str) -> MissingDependency:
    """Return the error that says what `user` needs and how to install it, however limitblocks itself was."""
    top = name.partition(".")[0]
    return MissingDependency(
        f"{user}: the package {top} is missing; install it by: pip install '{required(top)}'"
    )


def required(name: str) -> str:
    """Return the requirement that the extras of limitblocks state for the package `name`."""
    for line in metadata.requires("limitblocks") or ():
        requirement = line.partition(";")[0].strip()
        if re.match(r"[\w.-]+", requirement)[0].lower() == name.lower():  # type: ignore[index] # it has a name
            return requirement
    return name

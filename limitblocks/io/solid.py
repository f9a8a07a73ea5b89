"""A solid as a reader of a file finds it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

#: What a solid and a block say of themselves beside their shape.
WORDS = ("layer", "material", "groups", "colour")


class Solid(NamedTuple):
    """One solid as a reader finds it: polygons over vertices (n, 3) in the units of the file.

    `support` says whether the file marks it so; None: its layer says it.
    """

    name: str
    layer: str
    vertices: Any
    faces: Sequence[Sequence[int]]
    support: bool | None = None
    material: str = ""
    groups: tuple[str, ...] = ()
    colour: str = ""

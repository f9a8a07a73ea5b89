"""An entity of a DXF drawing."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from limitblocks.arrays import Array
from limitblocks.io.solid import placed

#: Application under whose name the name of a block is kept beside an entity.
APPLICATION = "LIMITBLOCKS"


class Part(NamedTuple):
    """An entity of a drawing, out of its block references.

    `matrix` (4, 4) takes its coordinates to those of the drawing; `layer` and `name` are what a solid made
    of it has, as `groups` and `colour`, `handle` is where the drawing holds it and `reference` a number for
    the block reference.
    """

    entity: Any
    matrix: Array
    layer: str
    name: str
    reference: int
    groups: tuple[str, ...] = ()
    colour: str = ""

    @property
    def kind(self) -> str:
        """Type of the entity, such as "LWPOLYLINE"."""
        return str(self.entity.dxftype())

    @property
    def handle(self) -> str:
        """What the drawing calls the entity."""
        return str(self.entity.dxf.handle)

    @property
    def words(self) -> dict[str, Any]:
        """Material, as this library wrote it, groups and colour of a solid made of it."""
        return {"material": written(self.entity, 1), "groups": self.groups, "colour": self.colour}

    def placed(self, points: Any) -> Array:
        """Return points (n, 3) of the entity in the coordinates of the drawing."""
        rows = np.array([tuple(point) for point in points], dtype=np.float64).reshape(-1, 3)
        return placed(rows, self.matrix)


def decoded(text: str) -> str:
    r"""Return text as it was typed: drawings before 2007 write letters beyond the code page as \U+00F1."""
    from ezdxf.lldxf.encoding import decode_dxf_unicode

    return decode_dxf_unicode(text)


def written(entity: Any, place: int) -> str:
    """Return the name (place 0) or the material (1) that this library wrote beside an entity."""
    if not entity.has_xdata(APPLICATION):
        return ""
    words = [str(tag.value) for tag in entity.get_xdata(APPLICATION) if tag.code == 1000]
    return words[place] if place < len(words) else ""

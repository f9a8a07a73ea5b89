"""Blocks as a DXF drawing: MESH entities in double precision, on layers, in metres."""

from __future__ import annotations

import io
import re
from collections.abc import Iterable, Sequence
from typing import Any

from limitblocks.geometry import Block
from limitblocks.io.colours import parts_of
from limitblocks.io.formats.dxf.part import APPLICATION
from limitblocks.io.packages import package

_METRES = 6  # $INSUNITS
_LONGEST = 255  # of names
_COLOURS = (7, 1, 3, 5, 4, 6, 2, 30)  # of layers, in the colour index; blocks have none of it


def encoded(blocks: Sequence[Block], fixed: Sequence[bool]) -> bytes:
    """Return the drawing; the name of each block is kept beside its mesh, for the reader of this library."""
    drawing = package("ezdxf", "DXF").new("R2010", units=_METRES)
    drawing.appids.add(APPLICATION)
    layer_of = _distinct(block.layer for block in blocks)
    group_of = _distinct(name for block in blocks for name in block.groups)
    for k, layer in enumerate(layer_of.values()):
        if layer not in drawing.layers:
            drawing.layers.add(layer, color=_COLOURS[k % len(_COLOURS)])
    space, groups = drawing.modelspace(), dict[str, list[Any]]()
    for block in blocks:
        mesh = space.add_mesh({"layer": layer_of[block.layer]})
        mesh.vertices = block.vertices.tolist()
        mesh.faces = block.faces
        if block.colour:
            mesh.rgb = parts_of(block.colour)
        mesh.set_xdata(
            APPLICATION,
            [(1000, " ".join(word.split())[:_LONGEST]) for word in (block.name, block.material) if word],
        )
        for name in block.groups:
            groups.setdefault(group_of[name], []).append(mesh)
    for name, meshes in groups.items():
        with drawing.groups.new(name).edit_data() as members:
            members.extend(meshes)
    stream = io.StringIO()
    drawing.write(stream)
    return bytes(drawing.encode(stream.getvalue()))


def _distinct(names: Iterable[str]) -> dict[str, str]:
    """Return what each name is in DXF, where capitals tell no two apart."""
    made: dict[str, str] = {}
    taken: set[str] = set()
    for name in dict.fromkeys(names):
        word, k = _layer(name), 1
        while word.lower() in taken:
            k += 1
            word = f"{_layer(name)[: _LONGEST - 8]} {k}"
        taken.add(word.lower())
        made[name] = word
    return made


def _layer(name: str) -> str:
    """Return `name` without what DXF does not allow in the name of a layer; without one, layer 0."""
    return re.sub(r'[<>/\\":;?*|=,`\x00-\x1f]', "_", name.strip())[:_LONGEST] or "0"

"""A result as a Rhino 3dm file: layers "blocks", "displaced" and "forces", arrows as lines."""

from __future__ import annotations

from typing import Any

from limitblocks.drawing.arrows import Picture
from limitblocks.io.formats.rhino.writer import Drawing

#: Colours of the layers, red, green, blue, opacity.
_COLOURS = {"blocks": (150, 140, 120, 255), "displaced": (213, 94, 0, 255), "forces": (0, 114, 178, 255)}


def with_forces(shown: Picture) -> bytes:
    """Return the file; each arrow has its force, moment and scale as user text, in N, N m and m/N."""
    drawing = Drawing()
    for layer in _COLOURS:
        drawing.layer(layer)
    for block in shown.blocks:
        drawing.block(block, "blocks")
    for block in shown.displaced:
        drawing.block(block, "displaced")
    for k in shown.drawn:
        _arrow(drawing, shown, k)
    _key(drawing, shown)
    for layer, colour in _COLOURS.items():
        drawing.model.Layers[drawing.layer(layer)].Color = colour
    return drawing.encoded()


def _arrow(drawing: Drawing, shown: Picture, k: int) -> None:
    attributes = drawing.attributes(shown.names[k], "forces")
    attributes.ObjectDecoration = drawing.rhino3dm.ObjectDecoration.EndArrowhead
    i, j = shown.pairs[k]
    said = {
        "force, N": _numbers(shown.force[k]),
        "moment, N m": _numbers(shown.moment[k]),
        "from block": shown.blocks[i].name,
        "on block": shown.blocks[j].name,
        "scale, m/N": repr(shown.scale),
    }
    for key, text in said.items():
        attributes.SetUserString(key, text)
    tail, tip = (drawing.rhino3dm.Point3d(*end.tolist()) for end in (shown.at[k], shown.tips[k]))
    drawing.model.Objects.AddLine(tail, tip, attributes)


def _key(drawing: Drawing, shown: Picture) -> None:
    """Add a text that says the scales, at the lowest corner of the structure."""
    low = min(tuple(block.vertices.min(axis=0).tolist()) for block in shown.blocks)
    text = f"load factor {shown.load_factor:.6g}; arrows: 1 m is {1.0 / shown.scale:g} N"
    if shown.displaced:
        text += f"; displacement rates times {shown.magnification:.4g}"
    attributes = drawing.attributes("scale", "forces")
    drawing.model.Objects.AddTextDot(text, drawing.rhino3dm.Point3d(*low), attributes)


def _numbers(values: Any) -> str:
    return ", ".join(map(repr, values.tolist()))

"""Colours of entities and layers of a DXF drawing."""

from __future__ import annotations

from typing import Any

from limitblocks.io.colours import hex_of

_BY_BLOCK, _BY_LAYER, _PLAIN = 0, 256, 7  # of the colour index


def of_layer(layer: Any) -> str:
    """Return the colour of a layer; empty for that of new layers."""
    if layer.rgb is not None:
        return hex_of(*layer.rgb)
    return _indexed(layer.color)


def of_entity(entity: Any, layer: str, reference: str) -> str:
    """Return the colour of an entity: its own, or that of its layer or block reference."""
    if entity.rgb is not None:
        return hex_of(*entity.rgb)
    index = entity.dxf.get("color", _BY_LAYER)
    if index == _BY_LAYER:
        return layer
    return reference if index == _BY_BLOCK else _indexed(index)


def _indexed(index: int) -> str:
    from ezdxf.colors import aci2rgb

    return hex_of(*aci2rgb(index)) if 0 < index < _BY_LAYER and index != _PLAIN else ""

"""Blocks and results as COMPAS JSON: an assembly that compas.json_load reads without any other package."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any
from uuid import NAMESPACE_URL, uuid5

from limitblocks.arrays import Array
from limitblocks.drawing.arrows import Picture
from limitblocks.geometry import Block

_FRAME = {"point": [0.0, 0.0, 0.0], "xaxis": [1.0, 0.0, 0.0], "yaxis": [0.0, 1.0, 0.0]}


def encoded(blocks: Sequence[Block], fixed: Sequence[bool]) -> bytes:
    """Return a compas.datastructures.Assembly whose graph has "block", a mesh, and "is_support" at each node.

    The graph is that of an assembly of compas_assembly, with a part beside each block.
    """
    return _assembly(_graph(blocks, fixed))


def with_forces(shown: Picture) -> bytes:
    """Return the assembly of `write_blocks`, with "displaced" at nodes and "interfaces" at edges.

    The edge from block i to block j has a list, an entry an interface between them: "name", "point",
    "force" and "moment" (vectors, N and N m, of i on j) and "line", the arrow.
    """
    graph = _graph(shown.blocks, shown.fixed)
    graph["attributes"] |= {
        "load_factor": shown.load_factor,
        "scale": shown.scale,
        "magnification": shown.magnification,
    }
    graph["default_node_attributes"]["displaced"] = None
    graph["default_edge_attributes"]["interfaces"] = None
    for k, block in enumerate(shown.displaced):
        graph["node"][str(k)]["displaced"] = _thing(
            "datastructures/Mesh", mesh(block), block.name, f"displaced {k}"
        )
    for k, (i, j) in enumerate(shown.pairs):
        edge = graph["edge"][str(i)].setdefault(str(j), {"interfaces": []})
        edge["interfaces"].append(_interface(shown, k))
    return _assembly(graph)


def _interface(shown: Picture, k: int) -> dict[str, Any]:
    def geometry(word: str, kind: str, data: Any) -> dict[str, Any]:
        return {word: _thing(f"geometry/{kind}", data, word, f"{word} {k}")}

    def listed(values: Array) -> list[float]:
        return [float(value) for value in values[k]]

    ends = {"start": listed(shown.at), "end": listed(shown.tips)}
    return (
        {"name": shown.names[k]}
        | geometry("point", "Point", listed(shown.at))
        | geometry("force", "Vector", listed(shown.force))
        | geometry("moment", "Vector", listed(shown.moment))
        | geometry("line", "Line", ends)
    )


def _graph(blocks: Sequence[Block], fixed: Sequence[bool]) -> dict[str, Any]:
    """Return the data of the graph: a node a block, no edges."""
    nodes = {
        str(k): _node(k, block, support) for k, (block, support) in enumerate(zip(blocks, fixed, strict=True))
    }
    return {
        "attributes": {},
        "default_node_attributes": {"part": None, "block": None, "is_support": False},
        "default_edge_attributes": {},
        "node": nodes,
        "edge": {key: {} for key in nodes},
        "max_node": len(blocks) - 1,
    }


def _assembly(graph: dict[str, Any]) -> bytes:
    """Return the file of an assembly with this graph."""
    data = {"graph": graph, "attributes": {}}
    return json.dumps(
        _thing("datastructures/Assembly", data, "limitblocks", "assembly"), allow_nan=False
    ).encode()


def _node(k: int, block: Block, support: bool) -> dict[str, Any]:
    part = {"attributes": {"name": block.name}, "key": k, "frame": _FRAME, "features": []}
    x, y, z = block.centroid.tolist()
    return {
        "part": _thing("datastructures/Part", part, block.name, f"part {k}"),
        "block": _thing("datastructures/Mesh", mesh(block), block.name, f"block {k}"),
        "is_support": support,
        "layer": block.layer,
        "material": block.material,
        "groups": list(block.groups),
        "colour": block.colour,
        "x": x,
        "y": y,
        "z": z,
    }


def mesh(block: Block) -> dict[str, Any]:
    """Return the data of a mesh."""
    points = enumerate(block.vertices.tolist())
    return {
        "attributes": {},
        "default_vertex_attributes": {"x": 0.0, "y": 0.0, "z": 0.0},
        "default_edge_attributes": {},
        "default_face_attributes": {},
        "vertex": {str(k): {"x": x, "y": y, "z": z} for k, (x, y, z) in points},
        "face": {str(k): list(face) for k, face in enumerate(block.faces)},
        "facedata": {str(k): {} for k in range(len(block.faces))},
        "edgedata": {},
        "max_vertex": len(block.vertices) - 1,
        "max_face": len(block.faces) - 1,
    }


def _thing(dtype: str, data: Any, name: str, key: str) -> dict[str, Any]:
    """Return an object of COMPAS; `key` tells it from the others of the file."""
    guid = str(uuid5(NAMESPACE_URL, f"limitblocks {key}"))  # the same blocks give the same file
    return {"dtype": f"compas.{dtype}", "data": data, "name": name, "guid": guid}

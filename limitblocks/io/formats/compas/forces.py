"""A result as COMPAS JSON: the assembly of the blocks with displaced blocks and contact forces."""

from __future__ import annotations

from typing import Any

from limitblocks.arrays import Array
from limitblocks.drawing.arrows import Picture
from limitblocks.io.formats.compas.writer import assembly, graph_of, mesh, thing
from limitblocks.io.imported import labels


def with_forces(shown: Picture) -> bytes:
    """Return the assembly of `write_blocks`, with "displaced" at nodes and "interfaces" at edges.

    The edge from block i to block j has a list, an entry an interface between them: "name", "point",
    "force" and "moment" (vectors, N and N m, of i on j) and "line", the arrow.
    """
    graph = graph_of(shown.blocks, labels(shown.blocks, shown.supports), shown.supports)
    graph["attributes"] |= {
        "load_factor": shown.load_factor,
        "scale": shown.scale,
        "magnification": shown.magnification,
    }
    graph["default_node_attributes"]["displaced"] = None
    graph["default_edge_attributes"]["interfaces"] = None
    for k, block in enumerate(shown.displaced):
        graph["node"][str(k)]["displaced"] = thing(
            "datastructures/Mesh", mesh(block), block.name, f"displaced {k}"
        )
    for k, (i, j) in enumerate(shown.pairs):
        edge = graph["edge"][str(i)].setdefault(str(j), {"interfaces": []})
        edge["interfaces"].append(_interface(shown, k))
    return assembly(graph)


def _interface(shown: Picture, k: int) -> dict[str, Any]:
    def geometry(word: str, kind: str, data: Any) -> dict[str, Any]:
        return {word: thing(f"geometry/{kind}", data, word, f"{word} {k}")}

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

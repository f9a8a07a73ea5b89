"""Blocks from COMPAS JSON: assemblies, models, meshes. Needs nothing of COMPAS.

An object of COMPAS is {"dtype": "package.module/Class", "data": {...}, "name": ..., "guid": ...}; COMPAS 1
says "value" for "data". The layouts read, told apart by their keys and not by class names, so that derived
classes are read as well:

- mesh: "vertex" {key: {x, y, z}} and "face" {key: [vertex keys]}; polyhedron: "vertices" and "faces"; box:
  "xsize", "ysize", "zsize" and "frame" (compas 2.15, datastructures/mesh, geometry);
- graph with a block at each node: "node" {key: {"block": mesh, "is_support": ...}} (compas_assembly 0.7.1),
  or "part" (compas.datastructures.Assembly);
- model: "elements" with "geometry", "transformation", "is_support", under a "tree" of elements
  (compas_model 0.9.3, compas_dem 0.6.0); before, a list of elements with "shape";
- {"assembly": network, "blocks": {key: mesh}} (compas_assembly before 2019);
- lists and dictionaries of these.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.io import strict_json
from limitblocks.io.formats.compas.geometry import frame, polygons, transformation
from limitblocks.io.imported import SUPPORT_LAYERS, foreign, one_line
from limitblocks.io.placed import Contents
from limitblocks.io.solid import Solid, placed

_GEOMETRY = ("block", "geometry", "shape", "mesh")
_HOLDERS = {"graph", "model"}  # keys of what holds blocks: assemblies, problems of compas_dem
_SUPPORT = ("is_support", "is_fixed", "fixed", "is_boundary")


class Thing(NamedTuple):
    """An object of COMPAS: name of its class (empty for plain JSON), data, name and guid."""

    kind: str
    data: Any
    name: str
    guid: str


def contents(path: Path) -> Contents:
    """Return the solids in a file of COMPAS JSON; lengths are in the unit of whoever wrote it."""
    document = strict_json.parse(strict_json.read_text(path))
    if isinstance(document, dict) and "schema_version" in document:
        raise ModelError(
            "is a model file of limitblocks, not COMPAS JSON; limitblocks.read(file).blocks are its blocks"
        )
    left_out: Counter[str] = Counter()
    with foreign("COMPAS JSON"):
        solids = list(_walk(document, np.eye(4), "", False, left_out))
    if not solids:
        raise ModelError(
            "holds no COMPAS assembly, model or mesh; expected blocks as compas.json_dump writes"
        )
    return Contents(solids, None, [f"left out: {number} {kind}" for kind, number in left_out.items()])


def holds_blocks(document: Any) -> bool:
    """Return whether a document of JSON has blocks in a layout of COMPAS, sound or not."""
    try:
        with foreign("COMPAS JSON"):
            return any(True for _ in _walk(document, np.eye(4), "", False, Counter()))
    except ModelError:
        return True


def thing(value: Any) -> Thing:
    """Return `value` taken out of its wrapping."""
    if not isinstance(value, dict):
        return Thing("", value, "", "")
    dtype = value.get("dtype", value.get("datatype"))
    if not isinstance(dtype, str):
        return Thing("", value, "", "")
    data = value.get("data", value.get("value"))
    if isinstance(data, dict) and "datatype" in data and isinstance(data.get("data"), dict):
        data = data["data"]  # wrapped twice, as COMPAS 0.18 did
    inner = data if isinstance(data, dict) else {}
    kind = dtype.rpartition("/")[2]
    attributes = inner.get("attributes")
    attributes = attributes if isinstance(attributes, dict) else {}
    names = (value.get("name"), inner.get("name"), attributes.get("name"))
    # a class name is what COMPAS gives what nobody named
    name = next((n for n in names if isinstance(n, str) and n and n not in {kind, *_CLASSES}), "")
    return Thing(kind, data, name, str(value.get("guid", "")))


_CLASSES = ("Assembly", "Block", "BlockElement", "Box", "Element", "Mesh", "Part", "Polyhedron")


def _walk(value: Any, place: Array, key: str, support: bool, left_out: Counter[str]) -> Iterator[Solid]:
    """Yield the solids in `value`, put in `place` (4, 4), which stands under `key` of what holds it."""
    kind, data, name, _ = thing(value)
    if isinstance(data, dict) and (solid := polygons(data)) is not None:
        yield _solid(solid, place, name or _numbered(key), support)
    elif isinstance(data, dict) and (within := _known(data, place, left_out)) is not None:
        yield from map(_as_support, within) if support else within
    elif isinstance(data, dict) and kind and not _HOLDERS & data.keys():
        left_out[kind] += 1
    else:
        for word, part in _parts(data, key, bool(kind)):
            yield from _walk(part, place, word, support or word.lower() in SUPPORT_LAYERS, left_out)


def _known(data: Mapping[str, Any], place: Array, left_out: Counter[str]) -> Iterator[Solid] | None:
    """Return the solids of a layout that holds several; None where `data` is none."""
    if "elements" in data:
        return _model(data, place, left_out)
    if "node" in data:
        return _nodes(data, place, left_out)
    return _network(data, place) if "assembly" in data and "blocks" in data else None


def _parts(data: Any, key: str, holders_only: bool) -> Iterator[tuple[str, Any]]:
    """Yield what a list, a dictionary or an assembly holds, each with the key it stands under."""
    if isinstance(data, list):
        yield from ((f"{key} {k}".strip(), part) for k, part in enumerate(data))
    elif isinstance(data, dict):
        yield from ((k, part) for k, part in data.items() if k in _HOLDERS or not holders_only)


def _as_support(solid: Solid) -> Solid:
    """Return a solid of what stands under a key that says support."""
    return solid._replace(support=True, layer="support" if solid.layer == "block" else solid.layer)


def _numbered(key: str) -> str:
    return f"block {key}" if key.isdigit() else key


def _solid(shape: Any, place: Array, name: str, support: bool, layer: str = "", material: str = "") -> Solid:
    vertices, faces = shape
    vertices = placed(vertices, place)
    layer = layer or material or ("support" if support else "block")
    return Solid(name, layer, vertices, faces, support, material)


def _nodes(graph: Mapping[str, Any], place: Array, left_out: Counter[str]) -> Iterator[Solid]:
    """Blocks at the nodes of a graph."""
    defaults = graph.get("default_node_attributes") or graph.get("dna") or {}
    for key, given in graph["node"].items():
        node = {**defaults, **given}
        support = any(bool(node.get(word)) for word in _SUPPORT)
        part = thing(node.get("part"))
        held, where = node, place
        if not any(_shape(node.get(word)) for word in _GEOMETRY) and isinstance(part.data, dict):
            held = part.data.get("attributes") or {}
            where = place @ frame(part.data.get("frame"))
        shape = next((s for word in _GEOMETRY if (s := _shape(held.get(word)))), None)
        if shape is not None:
            name = shape[1] or part.name or _numbered(str(key))
            layer, material = (str(node.get(word) or "") for word in ("layer", "material"))
            solid = _solid(shape[0], where, name, support, layer, material)
            groups, colour = node.get("groups"), node.get("colour")
            yield solid._replace(
                groups=tuple(one_line(str(one)) for one in groups) if isinstance(groups, list) else (),
                colour=colour if isinstance(colour, str) else "",
            )
        elif part.kind:
            left_out[f"{part.kind} without geometry"] += 1


def _shape(value: Any) -> tuple[Any, str] | None:
    """Polygons and name of a geometry; None where `value` is none."""
    item = thing(value)
    shape = polygons(item.data) if isinstance(item.data, dict) else None
    return None if shape is None else (shape, item.name)


def _network(data: Mapping[str, Any], place: Array) -> Iterator[Solid]:
    """Blocks beside the network of an assembly."""
    network = data["assembly"]
    nodes = network.get("vertex") or network.get("node") or {}
    for key, block in data["blocks"].items():
        shape = _shape(block)
        if shape is None:
            raise ModelError(f"blocks.{key} is not a mesh")
        support = any(bool(nodes.get(key, {}).get(word)) for word in _SUPPORT)
        yield _solid(shape[0], place, shape[1] or _numbered(key), support)


def _model(data: Mapping[str, Any], place: Array, left_out: Counter[str]) -> Iterator[Solid]:
    """Elements of a model, each placed by its own, its parents' and the model's transformations."""
    parents = dict(_parents(data.get("tree") or {}))
    elements = _elements(data["elements"], parents)
    materials = data.get("materials")
    materials = materials if isinstance(materials, dict) else {}
    top = place @ transformation(data.get("transformation"))
    for k, (guid, item) in enumerate(elements.items()):
        shape = next((s for word in _GEOMETRY if (s := _shape(item.data.get(word)))), None)
        if shape is None:
            if item.kind != "Group":
                left_out[f"{item.kind} without a mesh"] += 1
            continue
        name = item.name or shape[1] or f"block {k}"
        where = _placed(elements, parents, guid, name)
        material = thing(materials.get(item.data.get("material"))).name
        if item.data.get("features"):
            left_out[f"features of block {name!r}"] += len(item.data["features"])
        solid = _solid(shape[0], top @ where, name, bool(item.data.get("is_support")), material=material)
        yield solid._replace(groups=_groups(elements, parents, guid))


def _elements(given: Any, parents: Mapping[str, str]) -> dict[str, Thing]:
    """Return the elements of a model by guid; by their key or number where a file is without guids.

    Raises
    ------
    ModelError
        Two have one guid, or none has one and the tree has groups.
    """
    pairs = given.items() if isinstance(given, dict) else enumerate(given)
    elements: dict[str, Thing] = {}
    for key, element in pairs:
        item = thing(element)
        guid = item.guid or str(key)
        if guid in elements:
            raise ModelError(f"two elements have the guid {guid!r}")
        if not item.guid and not isinstance(given, dict) and any(parents.values()):
            raise ModelError("elements have no guid, so the groups they are in are not known; "
                             "save the model without minimal=True")  # fmt: skip
        elements[guid] = item
    return elements


def _groups(elements: Mapping[str, Thing], parents: Mapping[str, str], guid: str) -> tuple[str, ...]:
    """Return the names of the groups above an element in the tree, the nearest first."""
    names = []
    while guid := parents.get(guid, ""):
        names += [elements[guid].name] if elements[guid].kind == "Group" and elements[guid].name else []
    return tuple(names)


def _parents(tree: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Guid of each element in the tree and of the one above it."""
    stack = [("", thing(tree.get("root")).data or {})]
    while stack:
        above, node = stack.pop()
        guid = node.get("element", above)
        if guid != above:
            yield guid, above
        stack += [(guid, child) for child in node.get("children") or ()]


def _placed(elements: Mapping[str, Thing], parents: Mapping[str, str], guid: str, name: str) -> Array:
    """Return the product (4, 4) of the transformations of an element and all above it."""
    where, seen = np.eye(4), set()
    while guid:
        if guid in seen:
            raise ModelError(f"block {name!r}: the tree of elements runs in a circle")
        seen.add(guid)
        data = elements[guid].data
        if data.get("frame") is not None:
            raise ModelError(
                f"block {name!r} has a frame, as compas_model before 0.5 wrote; save it with a later one"
            )
        where = transformation(data.get("transformation")) @ where
        guid = parents.get(guid, "")
    return where

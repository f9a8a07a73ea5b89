"""glTF 2.0 and its binary form GLB: each node with a mesh a block, in metres, with Y up."""

# trimesh takes skins, sparse data, two parents and fans without an error, but wrongly.
from __future__ import annotations

import base64
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.io import strict_json
from limitblocks.io.colours import of_linear
from limitblocks.io.imported import foreign, one_line, read_bytes, refuse_many
from limitblocks.io.placed import Contents
from limitblocks.io.shells import worded
from limitblocks.io.solid import Solid, placed, turned
from limitblocks.shown import many

JSON_CHUNK, BINARY_CHUNK = 0x4E4F534A, 0x004E4942
TYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_COLUMNS = {"SCALAR": 1, "VEC3": 3}
_TRIANGLES, _STRIP, _FAN = 4, 5, 6
#: Beginnings of the names of extensions that leave places alone.
_HARMLESS = ("KHR_materials_", "KHR_texture_", "KHR_lights_", "EXT_texture_", "KHR_mesh_quantization")


def contents(path: Path) -> Contents:
    """Return the solids of a glTF or GLB file; the layer of a solid is the material of most of its triangles.

    Raises
    ------
    ModelError
        The file is not as the format wants it, or uses compressed or sparse geometry.
    """
    data = read_bytes(path)
    with foreign("glTF"):
        document, binary = _parts(data)
        buffers = _buffers(document, binary, path)
        bodies: list[Solid] = []
        notes: list[str] = []
        faces = corners = 0
        shown = [(node, placement) for node, placement in _nodes(document) if "mesh" in node]
        for node, placement in shown:
            mesh = document["meshes"][node["mesh"]]
            _refuse_moved(node, mesh)
            name = str(node.get("name") or mesh.get("name") or path.stem)
            points, triangles, owner = _geometry(document, buffers, mesh)
            if not triangles:
                notes.append(f"left out: node {name!r} has no triangles")
            refuse_many(len(bodies), faces := faces + len(triangles))
            refuse_many(faces=(corners := corners + len(points)) // 3)  # of soup
            words = [_words(document, node, one) for one in mesh["primitives"]]
            bodies += worded(name, placed(points, placement), turned(triangles, placement), owner, words)
        outside = sum("mesh" in node for node in document.get("nodes", [])) - len(shown)
    hidden = [f"{many(outside, 'node')} outside the scene that is shown"] if outside else []
    return Contents(bodies, 1.0, [*notes, *(f"left out: {one}" for one in hidden)], "y", left_out=hidden)


def _parts(data: bytes) -> tuple[dict[str, Any], bytes]:
    """Return the JSON document and the binary chunk, empty where there is none."""
    binary = b""
    if data[:4] == b"glTF":
        chunks = dict(_chunks(data))
        data, binary = chunks.get(JSON_CHUNK, b""), chunks.get(BINARY_CHUNK, b"")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = ""
    if not text.lstrip().startswith(("{", "[")):
        raise ModelError("is neither glTF (JSON) nor GLB")
    document = strict_json.parse(text)
    version = document.get("asset", {}).get("version") if isinstance(document, dict) else None
    if not str(version).startswith("2."):
        raise ModelError(f"glTF version is {version!r}; 2.0 is read")
    for name in document.get("extensionsRequired", []):
        if not str(name).startswith(_HARMLESS):
            raise ModelError(f"its geometry needs the extension {name!r}; save it without compression")
    return document, binary


def _chunks(data: bytes) -> Iterator[tuple[int, bytes]]:
    """Yield type and content of each chunk of a GLB file."""
    size = int.from_bytes(data[8:12], "little")
    if len(data) < 20 or size != len(data):
        raise ModelError(f"claims {size} bytes, but has {len(data)}; the GLB file is not whole")
    place = 12
    while place + 8 <= len(data):
        length, kind = (int.from_bytes(data[place + k : place + k + 4], "little") for k in (0, 4))
        if place + 8 + length > len(data):
            raise ModelError(f"a chunk claims {length} bytes, but {len(data) - place - 8} follow")
        yield kind, data[place + 8 : place + 8 + length]
        place += 8 + length


def _buffers(document: dict[str, Any], binary: bytes, path: Path) -> list[bytes]:
    """Return the buffers; what several say is read once."""
    read: dict[str | None, bytes] = {None: binary}
    uris = [one.get("uri") for one in document.get("buffers", [])]
    for uri in uris:
        if uri not in read:
            read[uri] = _buffer(uri, path)
            if sum(map(len, read.values())) > strict_json.LARGEST_FILE:
                raise ModelError(f"its buffers are larger than {strict_json.LARGEST_FILE / 1e6:.0f} MB")
    return [read[uri] for uri in uris]


def _buffer(uri: str, path: Path) -> bytes:
    if uri.startswith("data:"):
        return base64.b64decode(uri.partition(",")[2], validate=True)
    if Path(uri).name != uri:
        raise ModelError(f"names the buffer {uri[:40]!r}; a file in the same folder is read")
    return read_bytes(path.with_name(uri))


def _nodes(document: dict[str, Any]) -> Iterator[tuple[dict[str, Any], Array]]:
    """Yield each node of the scene with its placement (4, 4)."""
    nodes = document.get("nodes", [])
    children = {child for node in nodes for child in node.get("children", [])}
    scenes = document.get("scenes")
    roots = scenes[document.get("scene", 0)].get("nodes", []) if scenes else set(range(len(nodes))) - children
    waiting = [(k, np.eye(4)) for k in reversed(list(roots))]
    seen = set()
    while waiting:
        k, above = waiting.pop()
        if k in seen or k < 0:
            raise ModelError(f"node {k} has two parents or is its own; nodes are a tree")
        seen.add(k)
        placement = above @ _local(nodes[k])
        yield nodes[k], placement
        waiting += [(child, placement) for child in reversed(nodes[k].get("children", []))]


def _refuse_moved(node: dict[str, Any], mesh: dict[str, Any]) -> None:
    """Refuse a mesh whose places are not those of its vertices and nodes alone."""
    morphed = any(node.get("weights", mesh.get("weights", ())))
    if morphed or "skin" in node or "EXT_mesh_gpu_instancing" in node.get("extensions", {}):
        what = "weights of morph targets" if morphed else "a skin or instances"
        raise ModelError(f"node {node.get('name', '')!r} has {what}; save it with them applied")


def _local(node: dict[str, Any]) -> Array:
    """Return the placement (4, 4) of a node in its parent."""
    if "matrix" in node:
        matrix = np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
        if np.abs(matrix[3] - (0.0, 0.0, 0.0, 1.0)).max() > 1e-6:
            raise ModelError(
                f"node {node.get('name', '')!r}: the last row of its matrix is {matrix[3].tolist()}; "
                "expected 0, 0, 0, 1 (glTF writes a matrix column by column)"
            )
        return matrix
    placement = np.eye(4)
    turn = Rotation.from_quat(node.get("rotation", (0, 0, 0, 1))).as_matrix()
    placement[:3, :3] = turn * np.array(node.get("scale", (1, 1, 1)), dtype=np.float64)
    placement[:3, 3] = node.get("translation", (0, 0, 0))
    return placement


def _geometry(
    document: dict[str, Any], buffers: list[bytes], mesh: dict[str, Any]
) -> tuple[Array, list[list[int]], list[int]]:
    """Return vertices (n, 3) and triangles of all primitives of a mesh, and the primitive of each."""
    points, triangles, owner = [np.zeros((0, 3))], list[list[int]](), list[int]()
    for k, one in enumerate(mesh["primitives"]):
        mode = one.get("mode", _TRIANGLES)
        if "KHR_draco_mesh_compression" in one.get("extensions", {}):
            raise ModelError("its geometry is compressed (Draco); save it without compression")
        if mode not in (_TRIANGLES, _STRIP, _FAN):  # points and lines
            continue
        base = sum(map(len, points))
        points.append(_accessor(document, buffers, one["attributes"]["POSITION"], "VEC3").astype(np.float64))
        count = len(points[-1])
        order = (
            _accessor(document, buffers, one["indices"], "SCALAR") if "indices" in one else np.arange(count)
        )
        if len(order) and not 0 <= order.min() <= order.max() < count:
            raise ModelError(f"a face names vertex {order.max()} of {count}")
        triangles += (_triangles(order.astype(np.int64).ravel(), mode) + base).tolist()
        owner += [k] * (len(triangles) - len(owner))
    return np.concatenate(points), triangles, owner


def _triangles(order: npt.NDArray[np.int64], mode: int) -> npt.NDArray[np.int64]:
    if mode == _TRIANGLES:
        return order.reshape(-1, 3)
    k = np.arange(max(len(order) - 2, 0))
    if mode == _FAN:
        return np.column_stack([np.zeros_like(k) + order[:1].sum(), order[k + 1], order[k + 2]])
    return np.column_stack([order[k], order[k + 1 + k % 2], order[k + 2 - k % 2]])


def _accessor(document: dict[str, Any], buffers: list[bytes], k: int, kind: str) -> npt.NDArray[Any]:
    """Return the values (n, columns) of accessor `k`, which must be of the given kind."""
    accessor = document["accessors"][k]
    if "sparse" in accessor or "bufferView" not in accessor:
        raise ModelError("its geometry is sparse; save it in full")
    if accessor.get("normalized"):
        raise ModelError("its geometry is in normalised integers; save it in floating-point numbers")
    if accessor["type"] != kind:
        raise ModelError(f"accessor {k} is {accessor['type']!r}; {kind!r} is needed")
    view = document["bufferViews"][accessor["bufferView"]]
    item, columns = np.dtype(TYPES[accessor["componentType"]]), _COLUMNS[kind]
    count, row = accessor["count"], columns * item.itemsize
    stride = view.get("byteStride", row)
    first = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    data = buffers[view["buffer"]]
    if min(count, first) < 0 or stride < row or first + (count - 1) * stride + row > len(data):
        raise ModelError(f"accessor {k} claims {count} values beyond its buffer of {len(data)} bytes")
    return np.ndarray((count, columns), item, data, first, (stride, item.itemsize))


def _words(document: dict[str, Any], node: dict[str, Any], primitive: dict[str, Any]) -> dict[str, Any]:
    """Return layer, material, groups and colour of what a primitive of the mesh of a node draws.

    Its material is its layer unless the extras of the node, as this library writes them, name one.
    """
    made = document["materials"][primitive["material"]] if "material" in primitive else {}
    material, extras = str(made.get("name", "")), node.get("extras")
    extras = extras if isinstance(extras, dict) else {}
    layer, colour, groups = (extras.get(key) for key in ("layer", "colour", "groups"))
    if not isinstance(colour, str):
        factor = made.get("pbrMetallicRoughness", {}).get("baseColorFactor")
        colour = "" if factor is None else of_linear(factor)
    groups = tuple(one_line(str(one)) for one in groups) if isinstance(groups, list) else ()
    own = isinstance(layer, str)
    return {
        "layer": layer if own else material,
        "material": material if own else "",
        "groups": groups,
        "colour": colour,
    }

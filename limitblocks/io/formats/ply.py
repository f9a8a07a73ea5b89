"""PLY, as text or binary: each closed surface a block, faces as they are drawn."""

# trimesh reads no binary polygons of mixed sizes and writes single precision; meshio reads no face data.
from __future__ import annotations

from collections.abc import Callable, Container, Mapping, Sequence
from io import BytesIO
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from limitblocks.errors import ModelError
from limitblocks.geometry import Block
from limitblocks.io.imported import Contents, read_bytes, refuse_many
from limitblocks.io.shells import solids

_TYPES = {
    **{"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"},
    **{"int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4"},
    **{"float": "f4", "float32": "f4", "double": "f8", "float64": "f8"},
}
_FORMATS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_LOOPS = ("vertex_indices", "vertex_index")
_Take = Callable[[str, int], npt.NDArray[Any]]  # the next so many values of a type


class _Property(NamedTuple):
    """Name and type of a property; a list has the type of its length, too."""

    name: str
    kind: str
    length: str = ""


class _Element(NamedTuple):
    name: str
    number: int
    properties: list[_Property]


def contents(path: Path) -> Contents:
    """Return the solids of a PLY file.

    Raises
    ------
    ModelError
        The file is not as the format wants it.
    """
    data = read_bytes(path)
    order, elements, start = _header(data)
    take = _binary(data[start:], order) if order else _text(data[start:])
    try:
        values = {element.name: _values(element, take) for element in elements}
        vertices, faces = values.get("vertex", {}), values.get("face", {})
        loops = next(
            ([[int(v) for v in loop] for loop in faces[key]] for key in _LOOPS if key in faces), None
        )
    except (ValueError, IndexError, OverflowError, TypeError) as error:
        raise ModelError(f"values end early or are not as the header says: {error}") from None
    if loops is None or not {"x", "y", "z"} <= vertices.keys():
        raise ModelError("has no faces over vertices x, y, z; is it a point cloud?")
    points = np.column_stack([vertices[axis] for axis in "xyz"])
    return Contents(solids(path.stem, "", points, loops))


def _header(data: bytes) -> tuple[str, list[_Element], int]:
    """Return the byte order (empty: text), the elements, and where the values start."""
    end = data.find(b"end_header")
    start = data.find(b"\n", end) + 1
    if data[:3] != b"ply" or end < 0 or not start:
        raise ModelError("has no PLY header from 'ply' to 'end_header'")
    order, elements = None, list[_Element]()
    for line in data[:end].decode("latin-1").splitlines()[1:]:
        match line.split():
            case [] | ["comment" | "obj_info", *_]:
                pass
            case ["format", word, _] if word in _FORMATS:
                order = _FORMATS[word]
            case ["element", name, count] if count.isascii() and count.isdigit() and len(count) < 16:
                elements.append(_Element(name, int(count), []))
            case ["property", "list", length, kind, name] if elements and {length, kind} <= _TYPES.keys():
                elements[-1].properties.append(_Property(name, _TYPES[kind], _TYPES[length]))
            case ["property", kind, name] if elements and kind in _TYPES:
                elements[-1].properties.append(_Property(name, _TYPES[kind]))
            case _:
                raise ModelError(f"header line {line[:80]!r} is not PLY")
    if order is None:
        raise ModelError("the header does not say the format: ascii or binary")
    _refuse_claims(elements, len(data) - start)
    return order, elements, start


def _refuse_claims(elements: list[_Element], left: int) -> None:
    """Refuse numbers of elements that cannot be in the bytes left: a value takes a byte at least."""
    for element in elements:
        if element.number > left or not element.properties:
            raise ModelError(
                f"claims {element.number} of {element.name!r}, but {left} bytes follow the header"
            )
        refuse_many(faces=element.number if element.name == "face" else 0)


def _text(data: bytes) -> _Take:
    words = iter(data.decode("latin-1").split())
    return lambda kind, count: np.array(list(islice(words, count)), dtype=np.float64)


def _binary(data: bytes, order: str) -> _Take:
    stream = BytesIO(data)

    def take(kind: str, count: int) -> npt.NDArray[Any]:
        dtype = np.dtype(order + kind)
        return np.frombuffer(stream.read(count * dtype.itemsize), dtype)

    return take


def _values(element: _Element, take: _Take) -> dict[str, Any]:
    """Return the values of each property of an element: a number or a list of numbers per item."""
    names = [one.name for one in element.properties]
    kinds = {one.kind for one in element.properties}
    if len(kinds) == 1 and not any(one.length for one in element.properties):
        table = take(kinds.pop(), element.number * len(names)).reshape(element.number, len(names))
        return dict(zip(names, table.T, strict=True))
    values: dict[str, list[Any]] = {name: [] for name in names}
    for _ in range(element.number):
        for one in element.properties:
            count = int(take(one.length, 1)[0]) if one.length else 1
            part = take(one.kind, count)
            if len(part) != count:
                raise ValueError("the values end early")
            values[one.name].append(part if one.length else part[0])
    return values


def encoded(blocks: Sequence[Block], layers: Mapping[str, str], supports: Container[str]) -> bytes:  # none
    """Return the binary PLY file of blocks: faces and every digit, no names."""
    points = np.concatenate([block.vertices for block in blocks])
    starts = np.cumsum([0, *(len(block.vertices) for block in blocks)])
    faces = [
        np.add(face, start)
        for block, start in zip(blocks, starts.tolist()[:-1], strict=True)
        for face in block.faces
    ]
    header = (
        "ply\nformat binary_little_endian 1.0\ncomment limitblocks; m, Z up\n"
        f"element vertex {len(points)}\nproperty double x\nproperty double y\nproperty double z\n"
        f"element face {len(faces)}\nproperty list int int vertex_indices\nend_header\n"
    )
    rows = np.concatenate([[len(face), *face] for face in faces])
    return header.encode() + points.astype("<f8").tobytes() + rows.astype("<i4").tobytes()

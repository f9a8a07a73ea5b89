"""PLY, as text or binary: each closed surface a block, faces as they are drawn."""

# trimesh reads no binary polygons of mixed sizes and writes single precision; meshio reads no face data.
from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from limitblocks.errors import ModelError
from limitblocks.geometry import Block
from limitblocks.io.colours import common, parts_of
from limitblocks.io.imported import read_bytes, refuse_many
from limitblocks.io.placed import Contents
from limitblocks.io.shells import surfaces
from limitblocks.io.solid import Solid

_TYPES = {
    **{"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"},
    **{"int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4"},
    **{"float": "f4", "float32": "f4", "double": "f8", "float64": "f8"},
}
_FORMATS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_TINTS = {"red", "green", "blue"}
_LOOPS = ("vertex_indices", "vertex_index")
_Columns = list[npt.NDArray[Any]]
_LONGEST = 64  # lists that are taken for all items at once


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
    try:
        source = _Binary(data[start:], order) if order else _Text(data[start:])
        values = {element.name: _values(element, source) for element in elements}
        vertices, faces = values.get("vertex", {}), values.get("face", {})
        loops = next((_whole(faces[key]) for key in _LOOPS if key in faces), None)
    except (ValueError, IndexError, OverflowError, TypeError) as error:
        raise ModelError(f"values end early or are not as the header says: {error}") from None
    if loops is None or not {"x", "y", "z"} <= vertices.keys():
        raise ModelError("has no faces over vertices x, y, z; is it a point cloud?")
    points = np.column_stack([vertices[axis] for axis in "xyz"])
    found = surfaces(path.stem, points, loops)
    tints = _tints(vertices) if vertices.keys() >= _TINTS else None
    return Contents([
        Solid(path.stem, "", points[used], faces, colour="" if tints is None else common(tints[used]))
        for used, faces, _ in found
    ])  # fmt: skip


def _tints(vertices: dict[str, Any]) -> Any:
    """Return the colours (n, 3) of vertices, of 255; a file may have them as parts of one."""
    parts = np.column_stack([vertices["red"], vertices["green"], vertices["blue"]])
    most = 255.0 if parts.dtype.kind != "f" or parts.max(initial=0.0) > 1.0 else 1.0
    return np.round(np.clip(np.nan_to_num(parts) / most, 0.0, 1.0) * 255.0).astype(np.uint8)


def _whole(loops: Any) -> list[list[int]]:
    """Return the faces as whole numbers, which those of a text were not yet."""
    if isinstance(loops, np.ndarray):
        return [list(map(int, loop)) for loop in loops.tolist()]
    return [list(map(int, loop.tolist())) for loop in loops]


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


class _Text:
    """Numbers in text, taken one after the other from `place` on."""

    def __init__(self, data: bytes) -> None:
        self.numbers, self.place = np.fromstring(data.decode("latin-1"), dtype=np.float64, sep=" "), 0

    def take(self, kinds: Sequence[str], count: int) -> _Columns:
        """Return columns of the next `count` rows of values of these types, shorter where they end."""
        end = self.place + count * len(kinds)
        table = self.numbers[self.place : end]
        self.place = end
        return list(table[: len(table) // len(kinds) * len(kinds)].reshape(-1, len(kinds)).T)


class _Binary:
    """Binary numbers, taken one after the other from `place` on."""

    def __init__(self, data: bytes, order: str) -> None:
        self.data, self.order, self.place = data, order, 0

    def take(self, kinds: Sequence[str], count: int) -> _Columns:
        """Return columns of the next `count` rows of values of these types, shorter where they end."""
        row = np.dtype([(str(k), self.order + kind) for k, kind in enumerate(kinds)])
        whole = max(min(count, (len(self.data) - self.place) // row.itemsize), 0)
        table = np.frombuffer(self.data, row, whole, self.place)
        self.place += count * row.itemsize
        return [table[str(k)] for k in range(len(kinds))]


def _values(element: _Element, source: _Text | _Binary) -> dict[str, Any]:
    """Return the values of each property of an element: a number or a list of numbers per item."""
    if not element.number:
        return {one.name: [] for one in element.properties}
    alike = _alike(element, source)
    if alike is not None:
        return alike
    values: dict[str, list[Any]] = {one.name: [] for one in element.properties}
    for _ in range(element.number):
        for one in element.properties:
            count = int(source.take([one.length], 1)[0][0]) if one.length else 1
            part = source.take([one.kind], max(count, 0))[0]
            if len(part) != count:
                raise ValueError("the values end early")
            values[one.name].append(part if one.length else part[0])
    return values


def _alike(element: _Element, source: _Text | _Binary) -> dict[str, Any] | None:
    """Return the values where the lists of all items are as long as those of the first; None elsewhere."""
    start, lengths, kinds = source.place, dict[int, int](), list[str]()
    for one in element.properties:
        if one.length:
            lengths[len(kinds)] = max(int(source.take([one.length], 1)[0][0]), 0)
        count = lengths[len(kinds)] if one.length else 1
        source.take([one.kind], count)
        kinds += [one.length] * bool(one.length) + [one.kind] * min(count, _LONGEST + 1)
        if count > _LONGEST:
            break
    source.place = start
    columns = source.take(kinds, element.number)
    uniform = all((columns[k] == count).all() for k, count in lengths.items())
    if max(lengths.values(), default=0) > _LONGEST or len(columns[0]) < element.number or not uniform:
        source.place = start
        return None
    values, place = dict[str, Any](), 0
    for one in element.properties:
        if one.length:
            count = lengths[place]
            values[one.name] = (
                np.column_stack(columns[place + 1 : place + 1 + count])
                if count
                else np.zeros((element.number, 0))
            )
            place += 1 + count
        else:
            values[one.name] = columns[place]
            place += 1
    return values


def encoded(blocks: Sequence[Block], fixed: Sequence[bool]) -> bytes:
    """Return the binary PLY file of blocks: faces, every digit, colours of vertices if any, no names."""
    points = np.concatenate([block.vertices for block in blocks])
    starts = np.cumsum([0, *(len(block.vertices) for block in blocks)])
    faces = [
        np.add(face, start)
        for block, start in zip(blocks, starts.tolist()[:-1], strict=True)
        for face in block.faces
    ]
    tints, kinds = "", [("at", "<f8", 3)]
    if any(block.colour for block in blocks):
        tints = "property uchar red\nproperty uchar green\nproperty uchar blue\n"
        kinds.append(("tint", "u1", 3))
    table = np.zeros(len(points), dtype=kinds)
    table["at"] = points
    if tints:
        number = [len(block.vertices) for block in blocks]
        table["tint"] = np.repeat([parts_of(block.colour) for block in blocks], number, axis=0)
    header = (
        "ply\nformat binary_little_endian 1.0\ncomment limitblocks; m, Z up\n"
        f"element vertex {len(points)}\nproperty double x\nproperty double y\nproperty double z\n{tints}"
        f"element face {len(faces)}\nproperty list int int vertex_indices\nend_header\n"
    )
    rows = np.concatenate([[len(face), *face] for face in faces])
    return header.encode() + table.tobytes() + rows.astype("<i4").tobytes()

"""STL, as text or binary: each named solid, or each closed surface, a block."""

# trimesh renames repeated names, confuses names with words of the format, and passes over solids cut short.
from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.geometry import Block
from limitblocks.io.imported import read_bytes, refuse_many
from limitblocks.io.placed import Contents
from limitblocks.io.shells import solids
from limitblocks.io.solid import Solid

_HEADER = 84  # bytes: 80 of text, 4 for the number of triangles
_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def contents(path: Path) -> Contents:
    """Return the solids of an STL file.

    Raises
    ------
    ModelError
        The file is not as the format wants it.
    """
    data = read_bytes(path)
    count = int.from_bytes(data[_HEADER - 4 : _HEADER], "little")
    # binary headers may begin with "solid", too: the length decides
    if len(data) >= _HEADER and len(data) == _HEADER + count * _RECORD.itemsize:
        refuse_many(faces=count)
        records = np.frombuffer(data, _RECORD, offset=_HEADER)
        return Contents(_solids(path.stem, records["corners"].astype(np.float64)))
    text = data.decode("utf-8-sig", "replace")  # editors on Windows write a byte order mark
    if text.lstrip()[:5].lower() != "solid" or "\0" in text:
        raise ModelError(
            f"is no sound STL: {len(data)} bytes for {count} triangles, expected "
            f"{_HEADER + count * _RECORD.itemsize}; or text that begins with 'solid'"
        )
    return Contents(_text(text, path.stem))


def _solids(name: str, corners: Array) -> list[Solid]:
    """Return the solids of triangles of corners (n, 3, 3)."""
    return solids(name, "", corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3).tolist())


def _text(text: str, stem: str) -> list[Solid]:
    bodies: list[Solid] = []
    parts = re.split(r"^[ \t]*(endsolid|solid)\b[ \t]*([^\r\n]*)", text, flags=re.IGNORECASE | re.MULTILINE)
    if len(parts) < 4 or parts[-3].lower() != "endsolid" or parts[-1].strip():
        raise ModelError("the text ends before 'endsolid'; the file is not whole")
    for word, name, body in zip(parts[1::3], parts[2::3], parts[3::3], strict=True):
        if word.lower() == "solid":
            bodies += _solids(name.strip() or stem, _corners(body, name))
    return bodies


def _corners(body: str, name: str) -> Array:
    """Return the corners (n, 3, 3) of the triangles of one solid in text."""
    rows = re.findall(r"\bvertex[ \t]+(\S+)[ \t]+(\S+)[ \t]+(\S+)", body, flags=re.IGNORECASE)
    triangles, loops = (
        len(re.findall(rf"\b{word}\b", body, re.IGNORECASE)) for word in ("endfacet", "vertex")
    )
    refuse_many(faces=triangles)
    if not len(rows) == loops == 3 * triangles:
        raise ModelError(
            f"solid {name!r}: {loops} vertices for {triangles} triangles; each has 3 of 3 numbers"
        )
    try:
        return np.array(rows, dtype=np.float64).reshape(-1, 3, 3)
    except ValueError as error:
        raise ModelError(f"solid {name!r}: {error}") from None


def encoded(blocks: Sequence[Block], fixed: Sequence[bool]) -> bytes:
    """Return the STL file of blocks in text: triangles, names and every digit."""
    lines: list[str] = []
    for block in blocks:
        lines.append(f"solid {block.name}")
        trios = block.vertices[block.triangles]
        normals = np.cross(trios[:, 1] - trios[:, 0], trios[:, 2] - trios[:, 0])
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.finfo(float).tiny)
        for corners, normal in zip(trios.tolist(), normals.tolist(), strict=True):
            lines.append(f" facet normal {_digits(normal)}\n  outer loop")
            lines += [f"   vertex {_digits(corner)}" for corner in corners]
            lines.append("  endloop\n endfacet")
        lines.append(f"endsolid {block.name}")
    return ("\n".join(lines) + "\n").encode()


def _digits(vector: Sequence[float]) -> str:
    return " ".join(map(repr, vector))

"""Wavefront OBJ: each object a block, or each group where there are no objects; faces as they are drawn."""

# trimesh reads triangles alone: it would lose quads, and objects that groups or materials divide.
from __future__ import annotations

import re
from array import array
from collections.abc import Container, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from limitblocks.errors import ModelError
from limitblocks.geometry import Block
from limitblocks.io.imported import Contents, one_line, read_bytes, refuse_many
from limitblocks.io.shells import solids
from limitblocks.io.solid import Solid

_Section = tuple[str, str, str]  # name, layer and material of what is drawn
_Face = tuple[int, ...]
_MOST_LINES, _LONGEST_LINE = 6_000_000, 1_000_000


def contents(path: Path) -> Contents:
    """Return the solids of an OBJ file; an object's layer is its group, else its material.

    Raises
    ------
    ModelError
        A line cannot be read.
    """
    vertices = array("d")
    drawn: dict[_Section, list[_Face]] = {}
    state = {"o": "", "g": "", "usemtl": ""}
    for number, (word, *rest) in _lines(read_bytes(path)):
        try:
            if word == "v":
                x, y, z = map(float, rest[:3])
                vertices.extend((x, y, z))
            elif word == "f":
                drawn.setdefault(_section(state, path), []).append(_face(rest, len(vertices) // 3))
            elif word in state:
                state[word] = " ".join(rest)
        except ValueError as error:
            raise ModelError(
                f"line {number}: {' '.join([word, *rest])[:80]!r} cannot be read: {error}"
            ) from None
    refuse_many(faces=sum(map(len, drawn.values())))
    points = np.array(vertices).reshape(-1, 3)
    bodies: list[Solid] = []
    for (name, layer, material), faces in drawn.items():
        used = sorted({vertex for face in faces for vertex in face})
        place = {vertex: k for k, vertex in enumerate(used)}
        loops = [tuple(place[vertex] for vertex in face) for face in faces]
        found = solids(name, layer, points[used], loops)
        bodies += [solid._replace(material=material) for solid in found]
    return Contents(bodies)


def _lines(data: bytes) -> Iterator[tuple[int, list[str]]]:
    """Yield number and words of each line that says something."""
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    if "\0" in text:
        raise ModelError("is not text; an OBJ file is")
    if text.count("\n") > _MOST_LINES:
        raise ModelError(f"has {text.count(chr(10))} lines; at most {_MOST_LINES} are read, split the file")
    # a line goes on after a backslash, but in a name it is a letter
    whole = re.sub(r"(?m)^[ \t]*[vf][^\n]*\\\r?\n(?:[^\n]*\\\r?\n)*", lambda m: _joined(m.group()), text)
    for number, line in enumerate(whole.splitlines(), 1):
        if len(line) > _LONGEST_LINE:
            raise ModelError(f"line {number} has {len(line)} letters; at most {_LONGEST_LINE} are read")
        words = line.split()
        if words and not words[0].startswith("#"):
            yield number, words


def _joined(lines: str) -> str:
    return re.sub(r"\\\r?\n", " ", lines)


def _section(state: dict[str, str], path: Path) -> _Section:
    if state["o"]:
        layer, material = state["g"] or state["usemtl"], state["usemtl"]
        return state["o"], layer, "" if material == layer else material
    return state["g"] or path.stem, state["usemtl"], ""


def _face(corners: list[str], known: int) -> _Face:
    """Return the vertices of a face from 0; an OBJ file counts from 1, or back from the last with -1."""
    indices = [int(corner.partition("/")[0]) for corner in " ".join(corners).partition("#")[0].split()]
    for index in indices:
        if not (1 <= index <= known or -known <= index <= -1):
            raise ValueError(f"vertex {index} is not one of the {known} vertices before it")
    return tuple(index - 1 if index > 0 else known + index for index in indices)


def encoded(blocks: Sequence[Block], layers: Mapping[str, str], supports: Container[str]) -> bytes:
    """Return the OBJ file of blocks: faces, names, every digit; layers as materials or groups."""
    lines = ["# limitblocks; m, Z up"]
    first, made = 1, any(block.material for block in blocks)
    for block in blocks:
        lines.append(f"o {one_line(block.name)}")
        lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in block.vertices.tolist()]
        layer, material = (one_line(word) for word in (layers.get(block.name, ""), block.material))
        lines += [f"g {layer}"] if layer and made else []
        lines += [f"usemtl {material or layer}"] if material or layer else []
        lines += ["f " + " ".join(str(first + vertex) for vertex in face) for face in block.faces]
        first += len(block.vertices)
    return ("\n".join(lines) + "\n").encode()

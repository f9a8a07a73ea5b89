"""Wavefront OBJ: each object a block, or each group where there are no objects; faces as they are drawn."""

# trimesh reads triangles alone: it would lose quads, and objects that groups or materials divide.
from __future__ import annotations

import re
from array import array
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.geometry import Block
from limitblocks.geometry.cracks import open_sides, renumbered
from limitblocks.io.colours import common, parts_of
from limitblocks.io.imported import one_line, read_bytes, refuse_many
from limitblocks.io.placed import Contents
from limitblocks.io.shells import worded
from limitblocks.io.solid import Solid

_Section = tuple[str, str, str, tuple[str, ...]]  # name, layer, material and groups of what is drawn
_OWN = "# limitblocks"  # in such files the words after g are a layer and groups, each without blanks
_BLANK = "\N{NO-BREAK SPACE}"
_Face = tuple[int, ...]
_MOST_LINES, _LONGEST_LINE = 6_000_000, 1_000_000


def contents(path: Path) -> Contents:
    """Return the solids of an OBJ file; a layer is the group, else the material, of most faces of a solid.

    Raises
    ------
    ModelError
        A line cannot be read.
    """
    vertices, tints = array("d"), dict[int, tuple[float, ...]]()
    drawn: dict[_Section, list[_Face]] = {}
    state, colours = {"o": "", "g": "", "usemtl": ""}, dict[str, str]()
    data = read_bytes(path)
    own = data.startswith(_OWN.encode())
    for number, (word, *rest) in _lines(data):
        try:
            if word == "v":
                if len(rest) < 3:
                    raise ValueError("a vertex has three numbers")
                x, y, z = map(float, rest[:3])
                vertices.extend((x, y, z))
                if len(rest) == 6:  # x y z and red green blue, as many programs write
                    tints[len(vertices) // 3 - 1] = tuple(map(float, rest[3:]))
            elif word == "mtllib":
                colours |= _materials(path, " ".join(rest))
            elif word == "f":
                drawn.setdefault(_section(state, path, own), []).append(_face(rest, len(vertices) // 3))
            elif word in state:
                state[word] = " ".join(rest)
        except ValueError as error:
            comma = word == "v" and any("," in part for part in rest)
            why = "a number has a comma; write 0.5, not 0,5" if comma else error
            raise ModelError(
                f"line {number}: {' '.join([word, *rest])[:80]!r} cannot be read: {why}"
            ) from None
    refuse_many(faces=sum(map(len, drawn.values())))
    points = np.array(vertices).reshape(-1, 3)
    bodies: list[Solid] = []
    for sections in _objects(drawn, points):
        faces = [face for section in sections for face in drawn[section]]
        owner = [k for k, section in enumerate(sections) for _ in drawn[section]]
        used = sorted({vertex for face in faces for vertex in face})
        place = {vertex: k for k, vertex in enumerate(used)}
        loops = [tuple(place[vertex] for vertex in face) for face in faces]
        tint = _tint([tints.get(vertex) for vertex in used])
        words = [
            {
                "layer": layer,
                "material": material,
                "groups": groups,
                "colour": tint or colours.get(material or layer, ""),
            }
            for _, layer, material, groups in sections
        ]
        bodies += worded(sections[0][0], points[used], loops, owner, words)
    return Contents(bodies)


def _objects(drawn: Mapping[_Section, Sequence[_Face]], points: Array) -> Iterator[list[_Section]]:
    """Yield the sections of each object: together where one is open without the others, else one by one."""
    named: dict[str, list[_Section]] = {}
    for section in drawn:
        named.setdefault(section[0], []).append(section)
    same = np.unique(points, axis=0, return_inverse=True)[1].reshape(-1)
    for sections in named.values():
        alone = len(sections) == 1 or all(
            not open_sides(renumbered(tuple(drawn[one]), same)).size for one in sections
        )
        yield from ([one] for one in sections) if alone else [sections]


def _tint(rows: Sequence[tuple[float, ...] | None]) -> str:
    """Return the colour of vertices with these parts of one; empty where some have none or they differ."""
    parts = [row for row in rows if row is not None]
    whole = len(parts) == len(rows) and bool(np.isfinite(parts).all())
    return common(np.round(255.0 * np.clip(parts, 0.0, 1.0)).astype(np.uint8)) if whole else ""


def _materials(path: Path, name: str) -> dict[str, str]:
    """Return the diffuse colours of the materials in a file beside the OBJ file; none where it is missing."""
    if not name or Path(name).name != name or not path.with_name(name).is_file():
        return {}
    found, material = dict[str, str](), ""
    for _, (word, *rest) in _lines(read_bytes(path.with_name(name))):
        if word == "newmtl":
            material = " ".join(rest)
        elif word == "Kd" and len(rest) == 3:
            with suppress(ValueError):
                found[material] = _tint([tuple(map(float, rest))])
    return found


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
    lines = r"(?m)^[ \t]*[vf][^\n]*\\\r?\n(?:[^\n]*\\\r?\n)*"
    whole = re.sub(lines, lambda found: re.sub(r"\\\r?\n", " ", found.group()), text)
    for number, line in enumerate(whole.splitlines(), 1):
        if len(line) > _LONGEST_LINE:
            raise ModelError(f"line {number} has {len(line)} letters; at most {_LONGEST_LINE} are read")
        words = line.split(None if _BLANK not in line else " ")
        if words and not words[0].startswith("#"):
            yield number, words


def _section(state: dict[str, str], path: Path, own: bool) -> _Section:
    if state["o"]:
        group, *groups = state["g"].split(" ") if own else (state["g"],)
        layer, material = one_line(group) or state["usemtl"], state["usemtl"]
        return state["o"], layer, "" if material == layer else material, tuple(map(one_line, groups))
    return state["g"] or path.stem, state["usemtl"], "", ()


def _face(corners: list[str], known: int) -> _Face:
    """Return the vertices of a face from 0; an OBJ file counts from 1, or back from the last with -1."""
    indices = [int(corner.partition("/")[0]) for corner in " ".join(corners).partition("#")[0].split()]
    for index in indices:
        if not (1 <= index <= known or -known <= index <= -1):
            raise ValueError(f"vertex {index} is not one of the {known} vertices before it")
    return tuple(index - 1 if index > 0 else known + index for index in indices)


def encoded(blocks: Sequence[Block], fixed: Sequence[bool]) -> bytes:
    """Return the OBJ file of blocks: faces, names, every digit; layers as materials or groups."""
    lines = [f"{_OWN}; m, Z up"]
    first, made = 1, any(block.material or block.groups for block in blocks)
    group, paint = "", ""  # of the block before: they last until others are said
    for block in blocks:
        lines.append(f"o {block.name}")
        tint = "".join(f" {part / 255.0:.6g}" for part in parts_of(block.colour)) if block.colour else ""
        lines += [f"v {x!r} {y!r} {z!r}{tint}" for x, y, z in block.vertices.tolist()]
        words = [word.replace(" ", _BLANK) for word in (block.layer or "block", *block.groups)]
        before = group, paint
        group, paint = (
            " ".join(words) if (block.layer or block.groups) and made else "",
            block.material or block.layer,
        )
        lines += [f"g {group}".rstrip()] if group or before[0] else []
        lines += [f"usemtl {paint}".rstrip()] if paint or before[1] else []
        lines += ["f " + " ".join(str(first + vertex) for vertex in face) for face in block.faces]
        first += len(block.vertices)
    return ("\n".join(lines) + "\n").encode()

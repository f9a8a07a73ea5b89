"""Blocks from DXF drawings: solids in space. See elevation for drawings in the plane."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.io.formats.dxf import colours
from limitblocks.io.formats.dxf.part import APPLICATION, Part, decoded, written
from limitblocks.io.imported import MOST_FACES, foreign, one_line, read_bytes
from limitblocks.io.packages import package
from limitblocks.io.placed import Contents
from limitblocks.io.solid import Solid, turned

_DEEPEST = 32  # block references within block references
#: Metres per unit by $INSUNITS, exact; ezdxf has ten digits, and no mils and US survey feet (1200/3937 m).
_METRES = {
    1: 0.0254, 2: 0.3048, 3: 1609.344, 4: 1e-3, 5: 1e-2, 6: 1.0, 7: 1e3, 8: 2.54e-8, 9: 2.54e-5, 10: 0.9144,
    11: 1e-10, 12: 1e-9, 13: 1e-6, 14: 0.1, 15: 10.0, 16: 100.0, 17: 1e9,
    21: 1200 / 3937, 22: 100 / 3937, 23: 3600 / 3937, 24: 6336000 / 3937,
}  # fmt: skip
_NO_UNIT = "states no unit of length ($INSUNITS is 0 or missing)"


def contents(path: Path) -> Contents:
    """Return the solids in a DXF drawing: meshes, polyfaces, 3D faces, bodies with plane faces."""
    from limitblocks.io import shells
    from limitblocks.io.formats.dxf import solids as bodies

    drawing = opened(path)
    left_out: Counter[str] = Counter()
    faces: list[Part] = []
    solids: list[Solid] = []
    wrong: dict[str, list[str]] = {}
    with foreign("DXF"):
        for part in parts(drawing, left_out):
            if part.kind == "3DFACE":
                faces.append(part)
                continue
            try:
                shape = bodies.polygons(part)
            except ModelError as error:
                wrong.setdefault(part.name, []).extend(error.problems)
                continue
            if shape is None:
                left_out[part.kind] += 1
                continue
            for points, loops in shape:
                made = shells.solids(part.name, part.layer, points, turned(loops, part.matrix))
                solids += [solid._replace(**part.words) for solid in made]
        solids += bodies.from_3d_faces(faces)
    if not solids and not wrong:
        raise ModelError(f"holds no solid{_instead(left_out)}")
    notes = [*unit_notes(drawing), *notes_on(left_out)]
    return Contents(solids, metres_per_unit(drawing), notes, "z", wrong, hidden_of(left_out))


def _instead(left_out: Counter[str]) -> str:
    drawn = left_out["LWPOLYLINE"] + left_out["POLYLINE"]
    if drawn:
        return (
            f" but {drawn} polylines; an elevation needs the depth of its blocks: --thickness in the shell, "
            "limitblocks.files.read_drawing in Python"
        )
    return f" but {listed(left_out)}" if left_out else ""


def opened(path: Path) -> Any:
    """Return the drawing in a DXF file, text or binary."""
    ezdxf = package("ezdxf", "DXF")
    written_there = read_bytes(path)
    if written_there.startswith(b"AC10"):
        raise ModelError("is a DWG, not a DXF; save it as DXF")
    with foreign("DXF"):
        try:
            drawing = ezdxf.readfile(path)
        except OSError:
            raise ModelError("is not a DXF file: it does not begin as one") from None
        if b"$INSUNITS" not in written_there:
            drawing.header["$INSUNITS"] = 0  # ezdxf says metres for a file without a header
    return drawing


def metres_per_unit(drawing: Any) -> float | None:
    """Return metres per unit of the drawing; None where it states none.

    Raises
    ------
    ModelError
        The code of the unit is unknown.
    """
    code = drawing.header.get("$INSUNITS", 0)
    if code and code not in _METRES:
        raise ModelError(f"unit of length $INSUNITS is {code!r}; expected 0 to 17 or 21 to 24")
    return _METRES.get(code)


def unit_notes(drawing: Any) -> list[str]:
    """Return a note where the drawing states no unit."""
    return [] if drawing.header.get("$INSUNITS", 0) else [_NO_UNIT]


def notes_on(left_out: Counter[str]) -> list[str]:
    """Return a note on what was left out."""
    return [f"left out: {listed(left_out)}"] if left_out else []


def hidden_of(left_out: Counter[str]) -> tuple[str, ...]:
    """Return what is left out since it is hidden, and may be meant as blocks."""
    return (f"{left_out['hidden entities']} hidden entities",) if left_out["hidden entities"] else ()


def listed(counts: Counter[str]) -> str:
    """Return counts in words."""
    return ", ".join(f"{number} {word}" for word, number in sorted(counts.items()))


def parts(drawing: Any, left_out: Counter[str]) -> Iterator[Part]:
    """Yield what the model space shows, block references taken apart; count what is hidden.

    Raises
    ------
    ModelError
        A block is missing or contains itself, or the drawing has too many entities.
    """
    return _Expansion(drawing, left_out).parts(drawing.modelspace(), _Above(np.eye(4)), 0)


class _Above(NamedTuple):
    """What entities have of the block reference they are in: placement, layer, name, groups, colour."""

    matrix: Array
    layer: str = ""
    name: str = ""
    groups: tuple[str, ...] = ()
    colour: str = ""


class _Expansion:
    """State of taking a drawing apart: entities met and block references met so far."""

    def __init__(self, drawing: Any, left_out: Counter[str]) -> None:
        layers = {decoded(one.dxf.name): one for one in drawing.layers}
        #: capital and small letters are the same in DXF: a layer is spelled as in the table of layers
        self.spelled = {name.lower(): name for name in layers}
        self.frozen = {name for name, one in layers.items() if one.is_frozen()}
        self.hidden = self.frozen | {name for name, one in layers.items() if one.is_off()}
        self.colours = {name: colours.of_layer(one) for name, one in layers.items()}
        self.groups, self.left_out = _groups(drawing), left_out
        self.met = self.references = 0

    def parts(self, entities: Iterable[Any], above: _Above, depth: int) -> Iterator[Part]:
        reference = self.references
        for entity in entities:
            self.met += 1
            if self.met > MOST_FACES:
                raise ModelError(f"has more than {MOST_FACES} entities, the most that are read")
            # what is on layer 0 of a block takes on the layer of the reference
            own = above.layer if above.layer and entity.dxf.layer == "0" else decoded(entity.dxf.layer)
            own = self.spelled.setdefault(own.lower(), own)
            # a reference on a layer that is off shows what of it is on other layers, on a frozen one nothing
            hidden = self.frozen if entity.dxftype() == "INSERT" else self.hidden
            if own in hidden or entity.dxf.get("invisible", 0):
                self.left_out["hidden entities"] += 1
                continue
            groups = tuple(dict.fromkeys((*above.groups, *self.groups.get(entity.dxf.handle, ()))))
            by_layer = "" if entity.has_xdata(APPLICATION) else self.colours.get(own, "")
            colour = colours.of_entity(entity, by_layer, above.colour)
            if entity.dxftype() == "INSERT":
                where = above._replace(layer=own, groups=groups, colour=colour)
                yield from self.inserted(entity, where, depth)
            else:
                # the name that was written, else a name by which the entity is found in the drawing
                given = written(entity, 0) or above.name or f"{own} {entity.dxf.handle}"
                yield Part(entity, above.matrix, own, given, reference, groups, colour)

    def inserted(self, insert: Any, above: _Above, depth: int) -> Iterator[Part]:
        title, handle = insert.dxf.name, insert.dxf.handle
        block = insert.block()
        if block is None:
            raise ModelError(f"block reference {handle}: block {title!r} is missing")
        if depth == _DEEPEST:
            raise ModelError(f"block {title!r} contains itself, or blocks nest deeper than {_DEEPEST}")
        if insert.mcount > MOST_FACES:
            raise ModelError(
                f"block reference {handle}: {insert.mcount} copies; at most {MOST_FACES} are read"
            )
        for one in insert.multi_insert() if insert.mcount > 1 else (insert,):
            self.references += 1
            # ezdxf writes points as rows
            where = above.matrix @ np.array(list(one.matrix44())).reshape(4, 4).T
            yield from self.parts(
                block, above._replace(matrix=where, name=f"{decoded(title)} {handle}"), depth + 1
            )
            for label in one.attribs:
                yield Part(label, above.matrix, above.layer, "", self.references)


def _groups(drawing: Any) -> dict[str, list[str]]:
    """Return the names of the groups of each entity by its handle; groups without a name are none."""
    groups: dict[str, list[str]] = {}
    for name, group in drawing.groups:
        for entity in group if not name.startswith("*") else ():
            groups.setdefault(entity.dxf.handle, []).append(one_line(name))
    return groups

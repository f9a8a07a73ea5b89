"""Blocks from drawings in the plane: closed outlines of an elevation, made prisms of a given thickness."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from limitblocks.arrays import real
from limitblocks.errors import ModelError, path_of, sequence_of
from limitblocks.geometry.polyhedron import prism
from limitblocks.io import faults
from limitblocks.io.formats.dxf import reader as dxf
from limitblocks.io.formats.dxf.outlines import Outline, outline_of
from limitblocks.io.formats.dxf.part import Part, decoded
from limitblocks.io.imported import ImportedBlocks, UnitWeight, foreign, imported
from limitblocks.io.placed import Contents, frame
from limitblocks.io.solid import Solid

#: Thickness over the length of an outline below which a prism is a sheet, and beyond which it may be in mm.
_LEAF, _DEEP = 1e-3, 1e2


def read_drawing(
    file: str | Path,
    *,
    thickness: float,
    layers: str | Sequence[str] | None = None,
    units: str | None = None,
    unit_weight: UnitWeight = None,
    skip_bad: bool = False,
) -> ImportedBlocks:
    """Return the blocks in a DXF drawing of an elevation: prisms over its closed outlines.

    x of the drawing becomes X, y becomes Z; the prisms extend along Y, from -thickness / 2 to thickness / 2.
    An outline is a polyline that is closed, or ends within 1 % of its size from its start. Arcs become chords
    of at most 5 degrees, whose distance from the arc is at most 0.1 % of its radius. A text inside an outline
    names the block. Neighbours need not share corners; gaps are left to :func:`limitblocks.find_interfaces`.

    Parameters
    ----------
    file : str or Path
        A DXF file, text or binary.
    thickness : float
        m.
    layers : str or sequence of str, optional
        Layers to take outlines from; all that are visible if left out.
    units : str, optional
        Unit of length of the file, one of "m", "cm", "mm", "in", "ft"; left out, what the file says, and
        metres where it says nothing, or mm or cm where it would be larger than 300 m: `guesses` says so.
    unit_weight : float or mapping of str to float, optional
        N/m3, of all blocks or by layer.
    skip_bad : bool
        Leave out outlines that are no blocks, with a note each, instead of refusing the file.

    Raises
    ------
    ModelError
        The file cannot be read, or outlines in it are no blocks; `problems` has a line per fault.
    MissingDependency
        ezdxf is not installed.
    """
    path = path_of(file)
    with faults.named(path):
        contents = elevation(path, thickness, units, layers)
        return imported(contents, units, unit_weight, "z", skip_bad=skip_bad)


def elevation(
    path: Path, thickness: float, units: str | None = None, layers: str | Sequence[str] | None = None
) -> Contents:
    """Return the prisms, `thickness` m deep, over the closed outlines of the drawing at `path`."""
    if not 0.0 < real(thickness) < np.inf:
        raise ModelError(f"thickness is {thickness!r}; expected a number > 0 in m")
    given = (layers,) if isinstance(layers, str) else layers
    wanted = None if given is None else sequence_of("layers", given, str)
    drawing = dxf.opened(path)
    with foreign("DXF"):
        found = _contents(drawing, wanted)
    notes = [*dxf.unit_notes(drawing), *found.notes]
    stated = dxf.metres_per_unit(drawing)
    contents = found._replace(metres=stated, notes=notes, up="z", drawn=found.solids)
    metres = frame(contents, units, "z").metres
    lengths = [metres * _length(solid) for solid in found.solids]
    asked = _of_thickness(thickness, float(np.median(lengths))) if lengths else []
    depth = np.array([1.0, thickness / metres, 1.0])
    solids = [solid._replace(vertices=solid.vertices * depth) for solid in found.solids]
    return contents._replace(solids=solids, notes=[*notes, *asked])


def refuse_with_thickness(**given: str | None) -> None:
    """Raise ModelError for what solids may be told and an elevation, upright with plane faces, may not."""
    for name, value in given.items():
        if value:
            raise ModelError(
                f"{name} is {value!r}, of an elevation x is X, y is Z and faces are plane: "
                f"leave {name} (--{name}) out"
            )


def _length(solid: Solid) -> float:
    """Return the longest side of an outline, in the unit of the drawing."""
    return float(np.ptp(solid.vertices[:, [0, 2]], axis=0).max())


def _of_thickness(thickness: float, length: float) -> list[str]:
    """Return the question for a thickness that is hardly in m, of outlines `length` m long; refuse sheets."""
    off = f"thickness is {thickness:g} m and an outline {length:.3g} m long (median)"
    if thickness < _LEAF * length:
        raise ModelError(f"{off}: say the unit of the drawing, units='mm' (--units mm), or a thickness in m")
    return (
        [f"{off}: millimetres? thickness is in m: {thickness / 1e3:g}"] if thickness > _DEEP * length else []
    )


def _contents(drawing: Any, layers: Sequence[str] | None) -> Contents:
    left_out: Counter[str] = Counter()
    everything = list(dxf.parts(drawing, left_out))
    labels = [part for part in everything if part.kind in ("TEXT", "MTEXT", "ATTRIB")]
    known = {part.layer for part in everything}
    unknown = [layer for layer in layers or () if layer not in known]
    if unknown:
        raise ModelError(
            *(f"layer {layer!r} is empty or missing{faults.near(layer, known)}" for layer in unknown)
        )
    notes: list[str] = []
    wrong: dict[str, tuple[str, ...]] = {}
    outlines, dropped = list[Outline](), list[str]()
    for part in everything:
        if part.kind in ("TEXT", "MTEXT", "ATTRIB"):
            continue
        said = len(notes)
        try:
            outline = outline_of(part, notes) if layers is None or part.layer in layers else None
        except ModelError as error:
            wrong[f"{part.kind} {part.handle}"] = error.problems
            continue
        if outline is None:
            left_out[part.kind] += 1
            if any(note.startswith("left out") for note in notes[said:]):
                dropped.append(f"{part.kind} {part.handle}")
        else:
            outlines.append(outline)
    if not outlines and not wrong:
        raise ModelError(
            f"holds no closed outline{f' but {dxf.listed(left_out)}' if left_out else ''}", *notes
        )
    names = _labelled(outlines, labels)
    solids = [
        Solid(name, outline.part.layer, *prism(outline.corners, -0.5, 0.5, 1), **outline.part.words)
        for name, outline in zip(names, outlines, strict=True)
    ]
    gone = (*dropped, *dxf.hidden_of(left_out))
    return Contents(solids, notes=[*notes, *dxf.notes_on(left_out)], wrong=wrong, left_out=gone)


def _labelled(outlines: Sequence[Outline], labels: Sequence[Part]) -> list[str]:
    """Return the names of outlines: the only text inside and in no smaller outline, or the usual one."""
    places = [part.placed([_text_place(part.entity)])[0, :2] for part in labels]
    tree = shapely.STRtree([shapely.Polygon(outline.corners) for outline in outlines])
    inside: dict[int, list[str]] = {}
    for part, place in zip(labels, places, strict=True):
        around = tree.query(shapely.Point(place), predicate="within") if np.isfinite(place).all() else []
        text = " ".join(decoded(part.entity.plain_text()).split())
        if len(around) and text:
            smallest = min(around, key=lambda k: tree.geometries[k].area)
            inside.setdefault(int(smallest), []).append(text)
    return [
        inside[k][0] if len(inside.get(k, [])) == 1 else outline.part.name
        for k, outline in enumerate(outlines)
    ]


def _text_place(entity: Any) -> tuple[float, float, float]:
    """Return where a text is anchored."""
    if entity.dxftype() == "MTEXT":
        return tuple(entity.dxf.insert)
    place = entity.dxf.align_point if entity.dxf.get("halign", 0) or entity.dxf.get("valign", 0) else None
    return tuple(entity.ocs().to_wcs(place or entity.dxf.insert))

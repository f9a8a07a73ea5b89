"""Blocks from drawings in the plane: closed outlines of an elevation, made prisms of a given thickness."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import shapely

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.io import faults
from limitblocks.io.formats.dxf import reader as dxf
from limitblocks.io.formats.dxf.part import Part
from limitblocks.io.imported import ImportedBlocks, UnitWeight, foreign, imported
from limitblocks.io.placed import Contents, frame
from limitblocks.io.solid import Solid

#: Distance from end to start, over the size of the outline, up to which it counts as closed.
CLOSING = 1e-2
#: Angle of one chord of an arc, rad. It depends on the arc alone, so that neighbours get the same chords.
CHORD = np.radians(5.0)
_MOST_CHORDS = 1000  # of one outline
_FLAT = 1e-6  # height differences, over the size of the outline, of a drawing in the plane


class Outline(NamedTuple):
    """A closed polyline: corners (n, 2) in the drawing, its entity."""

    corners: Array
    part: Part


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
        metres where it says nothing.
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
    path = Path(file)
    with faults.named(path):
        if not 0.0 < thickness < np.inf:
            raise ModelError(f"thickness is {thickness!r}; expected a number > 0 in m")
        drawing = dxf.opened(path)
        stated = dxf.metres_per_unit(drawing)
        with foreign("DXF"):
            found = _contents(drawing, [layers] if isinstance(layers, str) else layers)
        notes = [*dxf.unit_notes(drawing), *found.notes]
        contents = found._replace(metres=stated, notes=notes, up="z")
        depth = np.array([1.0, thickness / frame(contents, units, "z").metres, 1.0])
        solids = [solid._replace(vertices=solid.vertices * depth) for solid in found.solids]
        return imported(contents._replace(solids=solids), units, unit_weight, "z", skip_bad=skip_bad)


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
    outlines = []
    for part in everything:
        if part.kind in ("TEXT", "MTEXT", "ATTRIB"):
            continue
        try:
            outline = _outline(part, notes) if layers is None or part.layer in layers else None
        except ModelError as error:
            wrong[f"{part.kind} {part.handle}"] = error.problems
            continue
        if outline is None:
            left_out[part.kind] += 1
        else:
            outlines.append(outline)
    if not outlines and not wrong:
        raise ModelError(
            f"holds no closed outline{f' but {dxf.listed(left_out)}' if left_out else ''}", *notes
        )
    names = _labelled(outlines, labels)
    solids = [
        Solid(name, outline.part.layer, *_prism(outline.corners, 1.0))
        for name, outline in zip(names, outlines, strict=True)
    ]
    return Contents(solids, notes=[*notes, *dxf.notes_on(left_out)], wrong=wrong)


def _prism(corners: Array, depth: float) -> tuple[Array, list[tuple[int, ...]]]:
    n = len(corners)
    x, z = np.tile(corners, (2, 1)).T
    y = np.repeat([-depth / 2, depth / 2], n)
    sides = [(k, k + n, (k + 1) % n + n, (k + 1) % n) for k in range(n)]
    return np.column_stack([x, y, z]), [tuple(range(n)), tuple(range(2 * n - 1, n - 1, -1)), *sides]


def _outline(part: Part, notes: list[str]) -> Outline | None:
    """Return the outline that an entity is; None where it is no polyline with an area.

    Raises
    ------
    ModelError
        It is one, but no simple closed loop in the plane of the drawing.
    """
    line = _polyline(part)
    if line is None or len(line[0]) < 3:
        return None
    points, closed = line
    word = f"{part.kind} {part.handle} on layer {part.layer!r}"
    if not (np.abs(points) <= 1e30).all():
        raise ModelError(f"{word}: corners are not finite numbers up to 1e30")
    size = float(np.ptp(points, axis=0).max())
    slim, again = _once(points, CLOSING * size if not closed else 0.0)
    notes += [f"{word}: retraces itself over {again} of {len(points)} corners; counted once"] * (again > 0)
    if len(slim) < 3:
        notes.append(f"left out: {word}: it has no area")
        return None
    points = slim
    gap = float(np.linalg.norm(points[-1] - points[0]))
    if gap <= CLOSING * size and not closed:
        notes += [f"{word}: closed over a gap of {gap:.2g} drawing units"] if gap > 0.0 else []
        closed, points = True, points[:-1]
    elif gap == 0.0:
        points = points[:-1]
    return _sound(part, word, points, closed, gap, size, notes)


def _sound(
    part: Part, word: str, points: Array, closed: bool, gap: float, size: float, notes: list[str]
) -> Outline | None:
    """Return the outline of corners that are counted once; None and a note where it is left out."""
    corners = points[:, :2]
    ring = shapely.Polygon(corners) if len(corners) >= 3 else None
    for wrong, why in (
        (np.ptp(points[:, 2]) > _FLAT * size, "it is not parallel to the drawing"),
        (not closed, f"it is open by {gap:.3g} for a size of {size:.3g}"),
        (ring is None or not ring.convex_hull.area > 1e-9 * size**2, "it has no area"),
    ):
        if wrong:
            notes.append(f"left out: {word}: {why}")
            return None
    if not shapely.is_valid(ring):
        near = f"{corners[0, 0]:.6g}, {corners[0, 1]:.6g}"
        raise ModelError(f"{word} near ({near}) crosses or touches itself; an outline is one simple loop")
    return Outline(corners, part)


def _once(points: Array, closing: float) -> tuple[Array, int]:
    """Return the corners (n, 3) of a polyline without what it draws twice, and how many these are.

    Spikes go, which it runs out and back, and what follows where it is back at its start, within `closing`,
    if that runs along its first sides again.
    """
    rows, n = points.tolist(), len(points)
    kept: list[list[float]] = []
    for row in rows:
        kept.append(row)
        while len(kept) > 2 and kept[-1] == kept[-3]:
            del kept[-2:]
        if len(kept) > 1 and kept[-1] == kept[-2]:
            kept.pop()
    left = np.array(kept)
    for j in range(3, len(left) - 1) if closing else ():
        tail = left[j:]
        if len(tail) <= j and len(tail) and np.abs(tail - left[: len(tail)]).max() <= closing:
            return left[: j + 1], n - j - 1
    return left, n - len(left)


def _polyline(part: Part) -> tuple[Array, bool] | None:
    """Return the corners (n, 3) of a polyline in the drawing, and whether it says that it is closed."""
    entity = part.entity
    if part.kind == "LWPOLYLINE":
        height = entity.dxf.elevation
        rows, closed = np.array(entity.get_points("xyb"), dtype=np.float64).reshape(-1, 3), entity.closed
    elif part.kind == "POLYLINE" and entity.is_2d_polyline:
        height = entity.dxf.elevation.z
        # 16: a control point of a spline, which is not on it
        shown = [v.dxf for v in entity.vertices if not v.dxf.flags & 16]
        rows = np.array([(v.location.x, v.location.y, v.get("bulge", 0.0)) for v in shown]).reshape(-1, 3)
        closed = entity.is_closed
    elif part.kind == "POLYLINE" and entity.is_3d_polyline:
        return part.placed(entity.points()), bool(entity.is_closed)
    else:
        return None
    flat = _with_arcs(part, rows, closed)
    points = [(x, y, height) for x, y in flat.tolist()]
    return part.placed(entity.ocs().points_to_wcs(points)), bool(closed)


def _with_arcs(part: Part, rows: Array, closed: bool) -> Array:
    """Return corners (n, 2) of sides (x, y, bulge); bulge is the tangent of a quarter of the arc's angle."""
    chords = np.ceil(4.0 * np.arctan(np.abs(rows[:, 2])) / CHORD - 1e-9)
    if chords.sum() > _MOST_CHORDS:
        raise ModelError(
            f"{part.kind} {part.handle} has {chords.sum():.0f} chords; at most {_MOST_CHORDS} are taken"
        )
    corners = []
    for k, (x, y, bulge) in enumerate(rows.tolist()):
        corners.append((x, y))
        if bulge == 0.0 or (k == len(rows) - 1 and not closed):
            continue
        a, b = complex(x, y), complex(*rows[(k + 1) % len(rows), :2])
        centre = (a + b) / 2 + (b - a) * 1j * (1.0 - bulge**2) / (4.0 * bulge)
        turns = 4.0 * np.arctan(bulge) * np.arange(1, int(chords[k])) / chords[k]
        arc = centre + (a - centre) * np.exp(1j * turns)
        corners += list(zip(arc.real.tolist(), arc.imag.tolist(), strict=True))
    return np.array(corners).reshape(-1, 2)


def _labelled(outlines: Sequence[Outline], labels: Sequence[Part]) -> list[str]:
    """Return the names of outlines: the only text inside and in no smaller outline, or the usual one."""
    places = [part.placed([_text_place(part.entity)])[0, :2] for part in labels]
    tree = shapely.STRtree([shapely.Polygon(outline.corners) for outline in outlines])
    inside: dict[int, list[str]] = {}
    for part, place in zip(labels, places, strict=True):
        around = tree.query(shapely.Point(place), predicate="within") if np.isfinite(place).all() else []
        text = " ".join(part.entity.plain_text().split())
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

"""Closed outlines in a DXF drawing of an elevation: polylines, with chords for their arcs."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import shapely

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.io.formats.dxf.part import Part

#: Distance from end to start, over the size of the outline, up to which it counts as closed.
CLOSING = 1e-2
#: Angle of one chord of an arc, rad. Neighbours get the same chords where their arcs have the same ends.
CHORD = np.radians(5.0)
_MOST_CHORDS = 1000  # of one outline
_FLAT = 1e-6  # height differences, over the size of the outline, of a drawing in the plane


class Outline(NamedTuple):
    """A closed polyline: corners (n, 2) in the drawing, counter-clockwise, and its entity."""

    corners: Array
    part: Part


def outline_of(part: Part, notes: list[str]) -> Outline | None:
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
    return Outline(corners if shapely.LinearRing(corners).is_ccw else corners[::-1], part)


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

"""Convex pieces of plane areas that are not convex."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import shapely

from limitblocks.arrays import Array, Indices
from limitblocks.geometry import polygon
from limitblocks.geometry.rectangles import rectangles

#: Area by which the convex hull may exceed an area that counts as convex, relative to it.
_CONVEX = 1e-12
#: Grid on which an area is divided, relative to the root of the area; no round number, see `_canonical`.
_GRID = 1e-7 * np.pi / 3.0

Point = tuple[float, float]


def convex_pieces(shapes: Any, x_axis: Array, mirrored: Any, tolerance: float) -> tuple[Any, Indices]:
    """Divide plane areas into convex pieces; convex ones stay as they are.

    Corners within `tolerance` of the line through their neighbours are left out of an area that is not
    convex, and count as straight in its pieces. Areas with perpendicular sides are divided into rectangles,
    others along diagonals: those of the constrained Delaunay triangulation, less all that can be left out,
    longest first (Hertel & Mehlhorn 1983: at most four times the least number of pieces).

    Parameters
    ----------
    shapes : array of shapely polygons, shape (m,)
    x_axis : Array, shape (m, 2)
        Direction that moves with each area, of any length: it settles ties, so that the pieces do, too.
    mirrored : array of bool, shape (m,)
        Whether ties are settled as seen from behind.
    tolerance : float
        m.

    Returns
    -------
    pieces : array of shapely polygons, shape (p,)
    owner : Indices, shape (p,)
        The area that each is part of, ascending.
    """
    excess = shapely.area(shapely.convex_hull(shapes)) / shapely.area(shapes) - 1.0
    pieces = [[shape] for shape in shapes]
    for k in np.flatnonzero((excess > _CONVEX) | (shapely.get_num_interior_rings(shapes) > 0)):
        pieces[k] = _divided(shapes[k], x_axis[k], bool(mirrored[k]), tolerance)
    owner = np.repeat(np.arange(len(pieces)), [len(each) for each in pieces])
    return np.array([one for each in pieces for one in each], dtype=object), owner


def _divided(shape: Any, x_axis: Array, mirrored: bool, tolerance: float) -> list[Any]:
    root = float(np.sqrt(shapely.area(shape)))
    clean = _cleaned(shape, 1e-6 * root)
    if _is_convex(clean):
        return [shape]
    clean = _cleaned(clean, tolerance)
    if _is_convex(clean):
        return [shapely.convex_hull(clean)]
    x = x_axis / np.hypot(*x_axis)
    turn = np.column_stack([x, np.array([-x[1], x[0]]) * (-1.0 if mirrored else 1.0)])
    if found := rectangles(clean, turn, tolerance):
        return found
    flat, origin = _canonical(clean, turn, root * _GRID)
    loops = _merged(delaunay(flat), tolerance / (root * _GRID))
    hulls = shapely.convex_hull([shapely.multipoints([origin[point] for point in loop]) for loop in loops])
    return list(hulls[shapely.area(hulls) > 1e-9 * root**2])


def _is_convex(shape: Any) -> bool:
    excess = shapely.area(shapely.convex_hull(shape)) - shapely.area(shape)
    return bool(excess <= 1e-9 * shapely.area(shape)) and not shapely.get_num_interior_rings(shape)


def _cleaned(shape: Any, tolerance: float) -> Any:
    """Return a polygon less its needless corners, and less holes that have no others."""
    rings = shapely.get_rings(shape)
    points, owner = shapely.get_coordinates(rings, return_index=True)
    keep = np.diff(owner, append=-1) == 0  # the last vertex of a ring repeats its first
    points, owner = polygon.clean(points[keep], owner[keep], np.full(len(rings), tolerance))
    loops = [points[owner == k] for k in range(len(rings))]
    if len(loops[0]) < 3:
        return shape
    clean = shapely.Polygon(loops[0], [loop for loop in loops[1:] if len(loop) > 2])
    return clean if clean.is_valid else shape


def _canonical(shape: Any, turn: Array, grid: float) -> tuple[Any, dict[Point, Point]]:
    """Return a polygon in its own axes, columns of `turn`, on a grid, and the place of each of its vertices.

    Roundoff thus leaves no trace, and a polygon that was moved is divided as before. The origin is the
    centroid; the grid is such that plain numbers do not lie half way between its points.
    """
    middle = shapely.get_coordinates(shapely.centroid(shape))[0]
    points = shapely.get_coordinates(shape)
    units = np.round((points - middle) @ turn / grid) + 0.0
    flat = shapely.set_coordinates(shape, units)
    # a strip narrower than the grid is left out, as where a hole meets the rim
    if not shapely.is_valid(flat):
        flat = shapely.make_valid(flat, method="structure", keep_collapsed=False)
        met = shapely.get_coordinates(flat)
        units, points = np.concatenate([met, units]), np.concatenate([middle + grid * met @ turn.T, points])
    places = dict(zip(map(tuple, units.tolist()), map(tuple, points.tolist()), strict=True))
    return shapely.normalize(flat), places


def delaunay(shape: Any) -> list[list[Point]]:
    """Return the constrained Delaunay triangles of a polygon, counter-clockwise."""
    parts = shapely.get_parts(shapely.constrained_delaunay_triangles(shape))
    corners = [[tuple(point) for point in shapely.get_coordinates(part)[:3].tolist()] for part in parts]
    return [loop if _cross(*loop) > 0.0 else loop[::-1] for loop in corners]


def _merged(loops: list[list[Point]], straight: float) -> list[list[Point]]:
    """Merge neighbouring loops as long as they stay convex within `straight`, across long sides first."""
    sides = {side: k for k, loop in enumerate(loops) for side in pairwise([*loop, loop[0]])}
    common = [(u, v) for u, v in sides if u < v and (v, u) in sides]
    for u, v in sorted(common, key=lambda ends: (-_squared(*ends), ends)):
        k, other = sides[u, v], sides[v, u]
        left, right = _from(loops[k], v), _from(loops[other], u)
        # left runs from v to u, right from u to v
        if min(_turn(left[-2], u, right[1]), _turn(right[-2], v, left[1])) < -straight:
            continue
        loops[k], loops[other] = left + right[1:-1], []
        sides.update((side, k) for side in pairwise(right))
    return [loop for loop in loops if loop]


def _from(loop: list[Point], first: Point) -> list[Point]:
    k = loop.index(first)
    return loop[k:] + loop[:k]


def _cross(a: Point, b: Point, c: Point) -> float:
    return (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])


def _squared(a: Point, b: Point) -> float:
    return (b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2


def _turn(a: Point, b: Point, c: Point) -> float:
    """Return the distance of corner b from the line through a and c; negative at a reflex corner."""
    return _cross(a, b, c) / math.sqrt(max(_squared(a, c), 1.0))

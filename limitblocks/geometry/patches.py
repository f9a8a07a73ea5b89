"""Patches: the plane areas common to two faces, with the gap and the angle between their planes."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce
from typing import Any, NamedTuple

import numpy as np
import shapely

from limitblocks.arrays import Array, Indices
from limitblocks.geometry.faces import FaceTable, projected
from limitblocks.geometry.pieces import convex_pieces
from limitblocks.geometry.polygon import axes_of

#: Least area of an interface, relative to the block length squared and to the smaller of the two faces.
SLIVER = 1e-3
#: Least area that is seen at all, relative to the least area of an interface.
_SEEN = 1e-6
#: Grid on which doubtful intersections are made again, relative to the block length.
_GRID = 1e-9


class Patches(NamedTuple):
    """Contact areas in the plane midway between their faces: m pairs of plane regions `a`, `b`.

    `origin` (m, 3) and `frame` (m, 3, 3), rows t1, t2 and the normal out of the first block, place the plane
    coordinates of `shape` (m,), shapely polygons. `least` (m,) is the area below which a patch is a sliver,
    m2, `gap` (m,) the largest distance between the two faces over the patch, m, negative where they
    interpenetrate, `angle` (m,) that between the faces, rad, and `spread` (m,) half the variation of the
    distance over the patch, m.
    """

    a: Indices
    b: Indices
    origin: Array
    frame: Array
    shape: Any
    least: Array
    gap: Array
    angle: Array
    spread: Array

    def of(self, keep: Any) -> Patches:
        """Return the patches at `keep`, a mask or indices."""
        return Patches(*(field[keep] for field in self))


def patches(faces: FaceTable, a: Indices, b: Indices, length: float) -> Patches:
    """Return the areas common to regions `a` and `b`, projected on the plane midway between them."""
    normal = faces.normal[a] - faces.normal[b]
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    frame, origin = axes_of(normal), faces.middle[a]
    first, second = (projected(faces, face, origin, frame) for face in (a, b))
    least = SLIVER * np.minimum(length**2, np.minimum(faces.area[a], faces.area[b]))
    bounds = np.stack([shapely.bounds(first), shapely.bounds(second)])
    extent = np.maximum(bounds[..., 2:].min(axis=0) - bounds[..., :2].max(axis=0), 0.0)
    near = np.flatnonzero(extent.prod(axis=1) > _SEEN * least)  # spares clipping faces that meet at an edge
    # a common part that is not one polygon (a line, a point, nothing) has no area
    common = common_areas(first[near], second[near], _SEEN * least[near], _GRID * length)
    parts, pair = shapely.get_parts(common, return_index=True)
    keep = shapely.area(parts) > _SEEN * least[near[pair]]
    pair = near[pair[keep]]
    shape = parts[keep]
    heights, spread = _heights(faces, a[pair], b[pair], origin[pair], frame[pair], shape)
    away = np.linalg.norm(faces.normal[a[pair]] + faces.normal[b[pair]], axis=1)
    return Patches(
        a[pair],
        b[pair],
        origin[pair] + _middle_heights(faces, a[pair], b[pair], origin[pair], frame[pair], shape),
        frame[pair],
        shape,
        least[pair],
        heights,
        2.0 * np.arcsin(np.minimum(away / 2.0, 1.0)),
        spread,
    )


def mean_width(shapes: Any) -> Array:
    """Return the area over half the perimeter (m,) of polygons, m."""
    return np.asarray(2.0 * shapely.area(shapes) / shapely.length(shapes))


def covering(faces: FaceTable, patches: Patches) -> Any:
    """Tell which patches cover more than half of the smaller of their faces, (m,): no strips at an edge."""
    smaller = np.minimum(faces.area[patches.a], faces.area[patches.b])
    return shapely.area(patches.shape) > 0.5 * smaller


def common_areas(first: Any, second: Any, least: Array, grid: float) -> Any:
    """Return the intersections (m,) of polygons, right to the area `least` (m,).

    GEOS 3.14 can return the whole of a polygon for its intersection with one that it only shares a side
    with, or points alone for polygons that share sides but for rounding errors. Where a point within is not
    in both polygons, or nothing is left of polygons that overlap by exact predicates, all is done again on a
    grid.
    """
    common = shapely.intersection(first, second)
    within = shapely.point_on_surface(common)
    outside = ~(shapely.intersects(within, first) & shapely.intersects(within, second))
    some = shapely.area(common) > least
    doubtful = np.where(some, outside, shapely.relate_pattern(first, second, "T********"))
    common[doubtful] = shapely.intersection(first[doubtful], second[doubtful], grid_size=grid)
    return common


def common_part(shapes: Sequence[Any], grid: float) -> Any:
    """Return the area common to all of some polygons, on a grid; see :func:`common_areas`."""

    def both(one: Any, other: Any) -> Any:
        parts = shapely.get_parts(shapely.intersection(one, other, grid_size=grid))
        return shapely.MultiPolygon([part for part in parts if part.geom_type == "Polygon"])

    return reduce(both, shapes) if shapes else shapely.Polygon()


def _above(faces: FaceTable, face: Indices, place: Array, normal: Array) -> Array:
    """Return the distances (k,) along `normal` from places to the planes of `face`, m."""
    rise = np.einsum("ij,ij->i", faces.middle[face] - place, faces.normal[face])
    return np.asarray(rise / np.einsum("ij,ij->i", normal, faces.normal[face]))


def _middle_heights(
    faces: FaceTable, a: Indices, b: Indices, origin: Array, frame: Array, shape: Any
) -> Array:
    """Return the vectors (m, 3) that bring patches midway between their planes at their centroids."""
    middle = shapely.get_coordinates(shapely.centroid(shape))
    normal = frame[:, 2]
    place = origin + np.einsum("ki,kij->kj", middle, frame[:, :2])
    height = _above(faces, a, place, normal) + _above(faces, b, place, normal)
    return np.asarray(height[:, None] / 2.0 * normal)


def _heights(
    faces: FaceTable, a: Indices, b: Indices, origin: Array, frame: Array, shape: Any
) -> tuple[Array, Array]:
    """Return the gap (m,) of largest size at a corner of each patch, and half its variation (m,), m."""
    points, owner = shapely.get_coordinates(shape, return_index=True)
    normal = frame[owner, 2]
    place = origin[owner] + np.einsum("ki,kij->kj", points, frame[owner, :2])
    gap = _above(faces, b[owner], place, normal) - _above(faces, a[owner], place, normal)
    first = np.flatnonzero(np.diff(owner, prepend=-1))
    if not len(first):
        return np.empty(0), np.empty(0)
    least, most = np.minimum.reduceat(gap, first), np.maximum.reduceat(gap, first)
    return np.where(-least > most, least, most), (most - least) / 2.0


def pieces_of(faces: FaceTable, patches: Patches, names: Any, tolerance: float) -> Patches:
    """Return the patches, those that are not convex divided into convex ones."""
    # of the two blocks the one whose name comes first settles ties, whatever their order
    first = names[faces.block[patches.a]] < names[faces.block[patches.b]]
    arm = faces.arm[np.where(first, patches.a, patches.b)]
    x_axis = np.einsum("kj,kij->ki", arm, patches.frame[:, :2])
    shape, owner = convex_pieces(patches.shape, x_axis, ~first, tolerance)
    return patches.of(owner)._replace(shape=shape)

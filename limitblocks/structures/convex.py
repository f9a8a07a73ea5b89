"""Convex stones from their corners or from the planes that cut them."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.spatial import ConvexHull, HalfspaceIntersection, QhullError

from limitblocks.arrays import Array
from limitblocks.errors import GeometryError
from limitblocks.geometry import Block

SAME = 1e-9  # of the size of a stone: points and planes closer than this are one


def hull(name: str, corners: npt.ArrayLike, unit_weight: float | None = None) -> Block:
    """Return the convex hull of `corners` (n, 3), m, as a block with one face to a plane."""
    points = np.asarray(corners, dtype=float)
    size = float(np.ptp(points, axis=0).max())
    tolerance = SAME * size
    points = points[_first_of_each(points, tolerance)]
    middle = points.mean(axis=0)
    flat = GeometryError(f"block {name!r}: it has no volume beside its size of {size:.3g} m")
    try:
        planes = ConvexHull(points - middle).equations
    except QhullError:
        raise flat from None
    # Qhull gives one plane to a triangle
    planes = planes[_first_of_each(planes / (1.0, 1.0, 1.0, size), 1e-7)]
    on = np.abs(planes[:, :3] @ (points - middle).T + planes[:, 3:]) <= 10 * tolerance
    extreme = on.sum(axis=0) >= 3  # the others lie on an edge or within a face
    points, on = points[extreme], on[:, extreme]
    if (on.sum(axis=1) < 3).any():
        raise flat
    faces = [_turn(points, np.flatnonzero(row), plane[:3]) for row, plane in zip(on, planes, strict=True)]
    return Block(name, points, tuple(faces), unit_weight)


def cut(
    name: str, normals: npt.ArrayLike, offsets: npt.ArrayLike, inside: Array, unit_weight: float | None = None
) -> Block:
    """Return the body of points x with `normals` (m, 3) @ x <= `offsets` (m,); `inside` is one of them."""
    rows = np.column_stack([np.asarray(normals, dtype=float), -np.asarray(offsets, dtype=float)])
    return hull(name, HalfspaceIntersection(rows, inside).intersections, unit_weight)


def _first_of_each(rows: Array, tolerance: float) -> npt.NDArray[np.bool_]:
    """Return a mask (n,) of the rows that equal no row before them."""
    near = np.abs(rows[:, None] - rows[None]).max(axis=2) <= tolerance
    return np.asarray(~np.tril(near, -1).any(axis=1))


def _turn(points: Array, face: npt.NDArray[np.int64], normal: Array) -> tuple[int, ...]:
    """Return the corners `face` counter-clockwise about `normal`."""
    arms = points[face] - points[face].mean(axis=0)
    side = np.cross(normal, arms[0])
    return tuple(face[np.argsort(np.arctan2(arms @ side, arms @ arms[0]))].tolist())

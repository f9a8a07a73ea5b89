"""Faces whose corners lie in no plane: told, divided into triangles, or made plane by moving vertices."""

from __future__ import annotations

from typing import Literal

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array, Indices, sums
from limitblocks.geometry.coplanar import area_vectors, warp_of
from limitblocks.geometry.polyhedron import Faces

Twisted = Literal["refuse", "triangulate", "fit"]

#: Farthest that a vertex moves when faces are made plane, in sizes of the block.
_FARTHEST = 0.02
#: Largest step of rounded coordinates, in sizes of the block.
_STEP = 1e-2
_ROUNDS = 100


def warps(points: Array, loops: Faces) -> Array:
    """Return how far a corner of each face lies out of its plane, (m,), m."""
    return np.array([warp_of(points, loop, loop) if len(loop) > 3 else 0.0 for loop in loops])


def rounding(points: Array) -> float:
    """Return the step of the digits that coordinates (n, 3) are rounded to; 0 where none shows.

    Steps are powers of ten or of two, or those of half precision, 2^-10 of a number (IEEE 754-2019, Table
    3.5). A step that is no small part of the body is how it was drawn.
    """
    most = _STEP * float(np.ptp(points, axis=0).max())
    largest = float(np.abs(points).max())
    steps = [10.0**-k for k in range(9)] + [2.0**-k for k in range(25)]
    fine = [step for step in steps if step > 1e-12 * largest]  # else every number is a multiple
    told = [step for step in fine if np.abs(points / step - np.round(points / step)).max() < 1e-6]
    coarsest, half = max(told, default=0.0), largest * 2.0**-10
    if coarsest <= half <= most and largest < 6e4 and (points.astype(np.float16) == points).all():
        return half
    return coarsest if coarsest <= most else 0.0


def triangulated(points: Array, loops: Faces, which: Indices) -> Faces:
    """Return the faces, those at `which` divided into triangles.

    The division follows from the places of the corners alone, so that a face that two blocks have in common
    is divided alike in both.
    """
    chosen = set(which.tolist())
    parts: list[tuple[int, ...]] = []
    for k, loop in enumerate(loops):
        parts += _divided(points, loop) if k in chosen else [loop]
    return tuple(parts)


def _divided(points: Array, loop: tuple[int, ...]) -> list[tuple[int, ...]]:
    """Cut off the corner with the shortest diagonal first, among those that turn the way the face does."""
    left, parts = list(loop), []
    normal = area_vectors(points, (loop,))[0]
    while len(left) > 3:
        k = min(range(len(left)), key=lambda k: _order(points, left, k, normal))
        parts.append((left[k - 1], left[k], left[(k + 1) % len(left)]))
        left.pop(k)
    return [*parts, (left[0], left[1], left[2])]


def _order(points: Array, left: list[int], k: int, normal: Array) -> tuple[bool, float, list[float]]:
    """Return what sorts the corner `k` of a loop: whether it is no ear, its diagonal, its place."""
    a, b, c = points[[left[k - 1], left[k], left[(k + 1) % len(left)]]]
    turn = np.cross(b - a, c - b) @ normal
    others = points[[v for v in left if v not in (left[k - 1], left[k], left[(k + 1) % len(left)])]]
    sides = [np.cross(q - p, others - p) @ normal for p, q in ((a, b), (b, c), (c, a))]
    inside = bool((np.min(sides, axis=0) > 0.0).any())
    # rounded, so that the same face of two blocks is divided alike whatever the last digit says
    diagonal = float(f"{np.linalg.norm(c - a):.9g}")
    return bool(turn <= 0.0) or inside, diagonal, b.tolist()


def fitted(points: Array, loops: Faces, tolerance: float) -> Array | None:
    """Return the vertices (n, 3) moved into planes that fit the corners of their faces; None if they resist.

    In rounds, each face gets the plane through its mean corner, square to its area vector, and each vertex
    goes to the nearest point in the planes of its faces (least squares of the smallest norm), until all
    corners are within a tenth of `tolerance`, m. A vertex moves 2 % of the block's size at most.
    """
    corner = np.concatenate([np.asarray(loop) for loop in loops])
    face = np.repeat(np.arange(len(loops)), [len(loop) for loop in loops])
    mean = sparse.csr_array((1.0 / np.bincount(face)[face], (face, np.arange(len(face)))))
    size, placed = float(np.ptp(points, axis=0).max()), points.copy()
    for _ in range(_ROUNDS):
        vectors = area_vectors(placed, loops)
        normal = vectors / np.maximum(np.linalg.norm(vectors, axis=1), np.finfo(float).tiny)[:, None]
        height = ((mean @ placed[corner])[face] - placed[corner]) * normal[face]
        off = height.sum(axis=1)
        if np.abs(off).max() <= tolerance / 10.0:
            moved = np.linalg.norm(placed - points, axis=1).max()
            return placed if moved <= _FARTHEST * size else None
        placed = placed + _steps(corner, normal[face], off, len(points))
    return None


def _steps(corner: Indices, normal: Array, off: Array, n: int) -> Array:
    """Return the smallest steps (n, 3) that bring corners, each `off` along the `normal` of a face, there."""
    square = sums(corner, (normal[:, :, None] * normal[:, None]).reshape(-1, 9), n).reshape(-1, 3, 3)
    right = sums(corner, off[:, None] * normal, n)
    return np.asarray(np.einsum("nij,nj->ni", np.linalg.pinv(square, rcond=1e-3, hermitian=True), right))

"""A solid as a reader of a file finds it."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain
from typing import Any, NamedTuple

import numpy as np

from limitblocks.arrays import Array

Polygons = tuple[Array, Sequence[Sequence[int]]]  # vertices (n, 3), and those of each face


class Solid(NamedTuple):
    """One solid as a reader finds it: polygons over vertices (n, 3) in the units of the file.

    `support` says whether the file marks it so; None: its layer says it.
    """

    name: str
    layer: str
    vertices: Any
    faces: Sequence[Sequence[int]]
    support: bool | None = None
    material: str = ""
    groups: tuple[str, ...] = ()
    colour: str = ""


def corners(solid: Solid) -> Array:
    """Return the vertices (n, 3) that faces of a solid have; all of them where a face is not sound."""
    points = np.asarray(solid.vertices, dtype=np.float64).reshape(-1, 3)
    try:
        used = np.unique(np.fromiter(chain.from_iterable(solid.faces), np.int64))
    except (TypeError, ValueError, OverflowError):  # for the block to say
        return points
    return points[used] if len(used) and 0 <= used[0] <= used[-1] < len(points) else points


def placed(points: Any, matrix: Array) -> Array:
    """Return points (n, 3) where a matrix (4, 4) takes them."""
    return np.asarray(points @ matrix[:3, :3].T + matrix[:3, 3])


def turned(faces: Sequence[Sequence[int]], matrix: Array) -> Sequence[Sequence[int]]:
    """Return faces in the sense they have where a matrix (4, 4) takes them: a mirror image turns them."""
    return [face[::-1] for face in faces] if np.linalg.det(matrix[:3, :3]) < 0.0 else faces

"""Faces of blocks that loads act on: which one is meant, which part counts, integrals over it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from limitblocks.arrays import Array, Indices
from limitblocks.errors import ModelError
from limitblocks.geometry import Block
from limitblocks.geometry.distance import beside
from limitblocks.geometry.faces import surfaces_of
from limitblocks.geometry.regions import regions

_TIE = 1e-6
_WIDEST = np.cos(np.pi / 4) - _TIE  # a face farther off than 45 degrees is not meant
_FLAT = 0.05  # rad: faces that share edges and lie within it of their mean plane are one face in parts
_MOST = 2 / 3  # of what looks within 45 degrees of a direction, seen along it: a lesser face is not it
_NEAR = 1e-4  # of the block's size: how far a point may be off its face


def faces_towards(block: Block, direction: Sequence[float]) -> Indices:
    """Return the faces of `block`, one flat face in parts, whose outward normal is closest to a unit vector.

    Raises
    ------
    ModelError
        If none is within 45 degrees, two are equally close, or what is meant is less than 2/3 of what looks
        within 45 degrees of the direction, as a facet of a rough or round face.
    """
    along = block.normals @ np.asarray(direction)
    best = int(along.argmax())
    if along[best] < _WIDEST:
        off = float(np.degrees(np.arccos(along[best])))
        raise ModelError(
            f"block {block.name!r} has no face towards {tuple(direction)}: the closest is {off:.0f} degrees "
            "off, expected at most 45"
        )
    plane = _planes(block)
    ties = np.flatnonzero(along > along[best] - _TIE)
    if (plane[ties] != plane[best]).any():
        raise ModelError(
            f"block {block.name!r}: faces {_listed(ties)} are equally close to direction {tuple(direction)}; "
            "give a point of the face instead"
        )
    faces = np.flatnonzero(plane == plane[best])
    seen = np.where(along >= _WIDEST, along * block.areas, 0.0)
    if (own := float(seen[faces].sum())) < _MOST * (whole := float(seen.sum())):
        raise ModelError(
            f"block {block.name!r}: the face closest to direction {tuple(direction)} has {own:.3g} of the "
            f"{whole:.3g} m2 that look within 45 degrees of it; give points of the faces, a pressure on each"
        )
    return faces


def faces_through(block: Block, point: Sequence[float]) -> Indices:
    """Return the faces of `block`, one flat face in parts, on which `point` (m) lies within 1e-4 of its size.

    Raises
    ------
    ModelError
        If no face does, or more than one, as at an edge.
    """
    at, near = np.asarray(point, dtype=float), _NEAR * block.size
    level = np.flatnonzero(np.abs(block.normals @ at - block.offsets) <= near)
    faces = np.array([k for k in level.tolist() if beside(block, k, at) <= near], dtype=int)
    plane = _planes(block)
    if len(faces) and (plane[faces] == plane[faces[0]]).all():
        return np.flatnonzero(plane == plane[faces[0]])
    where = "on no face" if not len(faces) else f"on an edge of faces {_listed(faces)}"
    raise ModelError(f"block {block.name!r}: point {tuple(point)} is {where}, expected a point inside a face")


def _planes(block: Block) -> Indices:
    """Number the faces in parts, shape (m,): those that share edges and are flat together are one."""
    surfaces = surfaces_of([block], [block.vertices - block.centroid])
    return regions(surfaces, block.size, _FLAT)


def part_where(corners: Array, values: Array) -> tuple[Array, Array]:
    """Return the part of a convex polygon where a linear function is positive, and its values there.

    Parameters
    ----------
    corners : Array, shape (n, 3)
        Vertices in order around the polygon.
    values : Array, shape (n,)
        The function at the vertices.

    Returns
    -------
    corners, values
        Shapes (k, 3) and (k,); k is 0 where it is positive nowhere.
    """
    if values.max() <= 0.0:
        return np.zeros((0, 3)), np.zeros(0)
    points, at_points = [], []
    after = np.roll(corners, -1, axis=0), np.roll(values, -1)
    for p, a, q, b in zip(corners, values, *after, strict=True):
        if a >= 0.0:
            points.append(p)
            at_points.append(a)
        if a * b < 0.0:
            points.append(p + (q - p) * (a / (a - b)))
            at_points.append(0.0)
    return np.array(points), np.array(at_points)


def integrals(ring: Array, values: Array, normal: Array) -> tuple[float, Array]:
    """Return the integrals of a linear function p and of p x over a plane polygon, exactly.

    Triangles between the first vertex and each side, each by the rule of its three side midpoints, which
    is exact for polynomials of degree two. Triangles have the sign of their turn about `normal`, so the
    polygon need not be convex, and holes, listed the other way round, count as negative.

    Parameters
    ----------
    ring : Array, shape (n, 3)
        Vertices x, m.
    values : Array, shape (n,)
        p at the vertices.
    normal : Array, shape (3,)
        Unit vector; areas are those seen along it.

    Returns
    -------
    float, Array of shape (3,)
        Integrals of p dA and of p x dA.
    """
    k = np.arange(1, len(ring) - 1)
    triangles = np.stack([np.zeros_like(k), k, k + 1], axis=1)
    x, p = ring[triangles], values[triangles]
    area = np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]) @ normal / 2.0
    x_mid, p_mid = (x + np.roll(x, -1, axis=1)) / 2.0, (p + np.roll(p, -1, axis=1)) / 2.0
    share = area[:, None] * p_mid / 3.0
    return float(share.sum()), np.einsum("tk,tki->i", share, x_mid)


def _listed(faces: Array | np.typing.NDArray[np.int64]) -> str:
    return " and ".join(str(k) for k in faces.tolist())

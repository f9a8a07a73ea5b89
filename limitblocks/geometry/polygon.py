"""Plane polygons, many at a time: stacks of shape (..., n, 2), vertices in order around the polygon."""

from __future__ import annotations

from typing import Any

import numpy as np

from limitblocks.arrays import Array, Indices
from limitblocks.errors import GeometryError

#: Lengths of sides, and components of their directions, closer than this count as equal.
TIE = 1e-6


def following(polygons: Array) -> Array:
    """Return the next vertex of each vertex, (..., n, 2)."""
    return np.roll(polygons, -1, axis=-2)


def cross(p: Array, q: Array) -> Array:
    """Return the normal component of the vector product of plane vectors (..., 2)."""
    return np.asarray(p[..., 0] * q[..., 1] - p[..., 1] * q[..., 0])


def _swept(polygons: Array) -> Array:
    """Return twice the signed areas of the triangles (origin, vertex, next vertex), shape (..., n)."""
    return cross(polygons, following(polygons))


def stacked(polygons: Any) -> Array:
    """Return polygons as an array (..., n, 2); GeometryError where they are none."""
    try:
        array = np.asarray(polygons, dtype=np.float64)
    except (TypeError, ValueError):  # rows of different lengths, or text
        array = np.empty(0)
    if array.ndim < 2 or array.shape[-1] != 2 or array.shape[-2] < 3:
        raise GeometryError(
            "polygons are not vertices (x1, x2), three or more a polygon and as many of each; expected an "
            "array of shape (..., n, 2): repeat a vertex of one that has fewer"
        )
    return array


def areas(polygons: Any) -> Array:
    """Return signed areas (...,), m2, of `polygons` (..., n, 2), m; positive when counter-clockwise.

    Raises
    ------
    GeometryError
        They are no such array, or lists of as many vertices each.
    """
    polygons = stacked(polygons)
    return np.asarray(_swept(polygons - polygons[..., :1, :]).sum(axis=-1) / 2.0)


def centroids(polygons: Array) -> Array:
    """Return centroids (..., 2), m, of polygons (..., n, 2) with area."""
    corner = polygons[..., :1, :]
    local = polygons - corner
    swept = _swept(local)
    moments = np.einsum("...n,...ni->...i", swept, local + following(local)) / 3.0
    return np.asarray(corner[..., 0, :] + moments / swept.sum(axis=-1)[..., None])


def second_moments(polygons: Array) -> Array:
    """Return the integrals (..., 3) of x1^2, x2^2, x1 x2 about the centroid, m4; counter-clockwise."""
    p = polygons - centroids(polygons)[..., None, :]
    q = following(p)
    x, y = np.moveaxis(np.stack([p, q, p + q]), -1, 0)
    terms = np.stack([x * x, y * y, x * y]).sum(axis=1)
    return np.moveaxis((_swept(p) * terms).sum(axis=-1) / 24.0, 0, -1)


def clean(points: Array, owner: Indices, tolerance: Array) -> tuple[Array, Indices]:
    """Remove duplicate and collinear vertices, those nearest to the line through their neighbours first.

    Parameters
    ----------
    points : Array, shape (k, 2)
        Vertices of m polygons one after the other, without repetition of the first.
    owner : Indices, shape (k,)
        Polygon of each vertex, ascending, each of 0..m-1 present.
    tolerance : Array, shape (m,)
        Distance from the line through the two neighbours that counts as nothing.

    Returns
    -------
    points, owner
        As given, less the removed vertices.
    """
    while True:
        before, after = _neighbours(owner)
        chord, arm = points[after] - points[before], points - points[before]
        distance = np.abs(cross(chord, arm)) / np.maximum(np.hypot(*chord.T), np.finfo(float).tiny)
        # never two neighbours at once: a corner beside its near-duplicate must stay
        drop = (distance <= distance[before]) & (distance < distance[after]) & (distance <= tolerance[owner])
        if not drop.any():
            return points, owner
        points, owner = points[~drop], owner[~drop]


def _neighbours(owner: Indices) -> tuple[Indices, Indices]:
    """Return the index of the previous and of the next vertex around each vertex's own polygon."""
    place = np.arange(len(owner))
    heads = np.flatnonzero(np.diff(owner, prepend=-1))
    tails = np.append(heads[1:], len(owner))[: len(heads)] - 1
    before, after = place - 1, place + 1
    before[heads], after[tails] = tails, heads
    return before, after


def axes_of(normals: Array) -> Array:
    """Return right-handed axes s1, s2, n, rows (..., 3, 3), of unit normals (..., 3)."""
    s1 = np.cross(np.eye(3)[np.abs(normals).argmin(axis=-1)], normals)
    s1 /= np.linalg.norm(s1, axis=-1, keepdims=True)
    return np.stack([s1, np.cross(normals, s1), normals], axis=-2)


def along_longest_side(polygons: Array, planes: Array) -> tuple[Indices, Array]:
    """Return the first vertex (m,) after the longest side of each polygon, and the turn (m, 2, 2) along it.

    Sides within 1e-6 of the longest tie; among them the one whose unit direction has the largest component
    along global X counts, then Y, then Z, each with the same tolerance. The axes lie along the mean of the
    lines that tie, if they have one: the legs of an isosceles trapezoid, but not the sides of a square.

    Parameters
    ----------
    polygons : Array, shape (m, n, 2)
    planes : Array, shape (m, 2, 3)
        Global unit vectors along the two coordinates of each polygon.
    """
    sides = following(polygons) - polygons
    lengths = np.hypot(sides[..., 0], sides[..., 1])
    tied = best = lengths >= lengths.max(axis=1, keepdims=True) * (1.0 - TIE)
    directions = sides / lengths[..., None]
    for component in np.moveaxis(np.einsum("mni,mij->mnj", directions, planes), 2, 0):
        best = best & (component >= np.where(best, component, -np.inf).max(axis=1, keepdims=True) - TIE)
    last = best.argmax(axis=1)
    units = directions @ (1.0, 1.0j)
    s1 = units[np.arange(len(units)), last]
    # a line turned by pi is the same, so twice the angles: those of what nearly is a square cancel
    mean = np.where(tied, (units / s1[:, None]) ** 2, 0.0).sum(axis=1) / tied.sum(axis=1)
    angle = np.where(np.abs(mean) > 0.5, np.angle(mean) / 2.0, 0.0)
    s1 = np.where(np.abs(angle) > TIE, s1 * np.exp(1.0j * angle), s1)
    turn = np.stack([s1.real, s1.imag, -s1.imag, s1.real], axis=1).reshape(-1, 2, 2)
    return (last + 1) % polygons.shape[1], turn

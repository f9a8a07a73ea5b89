"""Faces of one solid that lie in one plane, made one face."""

from __future__ import annotations

from collections import Counter

import numpy as np

from limitblocks.arrays import Array
from limitblocks.geometry.polyhedron import PLANE_TOLERANCE, Faces

#: Angle between the normals of faces that count as coplanar, rad.
ANGLE = 1e-2
#: Distance from the line through its neighbours, relative to the block's size, of a needless vertex.
COLLINEAR = 1e-6


def merged(points: Array, faces: Faces, size: float) -> tuple[Faces, float]:
    """Return the faces of a closed surface with coplanar neighbours merged, and how far those are from flat.

    A face that would have a hole, or touch itself, stays in pieces. Vertices between two edges in one line
    go where no third face meets them.

    Parameters
    ----------
    points : Array, shape (n, 3)
        Vertices, m.
    faces : Faces
        Closed surface, each edge used once in each direction.
    size : float
        Of the block, m.
    """
    limit = PLANE_TOLERANCE * size / 2.0
    found: list[tuple[int, ...]] = []
    warp = 0.0
    for members in _regions(points, faces, limit):
        ring = _ring([faces[k] for k in members]) if len(members) > 1 else ()
        off = _warp(points[list(ring)]) if ring else 0.0
        if ring and off <= 2.0 * limit:
            warp = max(warp, off)
            found.append(ring)
        else:
            found += [faces[k] for k in members]
    return _without_needless(points, tuple(found), COLLINEAR * size), warp


def area_vector(corners: Array) -> Array:
    """Return the area vector (3,) of a polygon of corners (n, 3), m2."""
    arms = corners - corners[0]
    return np.asarray(np.cross(arms[1:-1], arms[2:]).sum(axis=0) / 2.0)


def _regions(points: Array, faces: Faces, limit: float) -> list[list[int]]:
    """Return groups of adjacent faces, each within `limit` of the plane of its largest face."""
    vectors = np.array([area_vector(points[list(face)]) for face in faces])
    areas = np.linalg.norm(vectors, axis=1)
    normals = vectors / np.maximum(areas, np.finfo(float).tiny)[:, None]
    owner = {(face[k - 1], face[k]): f for f, face in enumerate(faces) for k in range(len(face))}
    longest = [_longest_side(points, face) for face in faces]
    slim = areas <= limit * np.array([np.linalg.norm(points[a] - points[b]) for a, b in longest])
    free = np.ones(len(faces), dtype=bool)
    regions = []
    for seed in np.argsort(-areas, kind="stable").tolist():
        if not free[seed]:
            continue
        free[seed] = False
        region = [seed]
        for f in region:  # grows while it is walked
            for k in range(len(faces[f])):
                back = faces[f][k], faces[f][k - 1]
                g = owner[back]
                # the normal of a slim face is noise; across a short side it would make a spike
                opens = longest[g] == back if slim[g] else normals[g] @ normals[seed] >= np.cos(ANGLE)
                arms = points[list(faces[g])] - points[faces[seed][0]]
                if free[g] and opens and np.abs(arms @ normals[seed]).max() <= limit:
                    free[g] = False
                    region.append(g)
        regions.append(region)
    return regions


def _longest_side(points: Array, face: tuple[int, ...]) -> tuple[int, int]:
    corners = points[list(face)]
    k = int(np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1).argmax())
    return face[k - 1], face[k]


def _ring(faces: list[tuple[int, ...]]) -> tuple[int, ...]:
    """Return the outline of adjacent faces; nothing where it is not one loop through different vertices."""
    sides = {(face[k - 1], face[k]) for face in faces for k in range(len(face))}
    outline = [(a, b) for a, b in sides if (b, a) not in sides]
    after = dict(outline)
    if len(after) < len(outline) or not outline:
        return ()
    ring = [min(after)]
    while after[ring[-1]] != ring[0]:
        ring.append(after[ring[-1]])
    return tuple(ring) if len(ring) == len(after) else ()


def _warp(corners: Array) -> float:
    """Return the largest distance of corners (n, 3) from their mean plane, m."""
    vector = area_vector(corners)
    length = np.linalg.norm(vector)
    heights = (corners - corners.mean(axis=0)) @ vector
    return float(np.abs(heights).max() / length) if length > 0.0 else np.inf


def _without_needless(points: Array, faces: Faces, tolerance: float) -> Faces:
    """Return the faces without vertices of two faces only that lie on the line through their neighbours."""
    uses = Counter(vertex for face in faces for vertex in face)
    beside = {
        face[k - 1]: (face[k - 2], face[k])
        for face in faces
        for k in range(len(face))
        if uses[face[k - 1]] == 2
    }
    gone: set[int] = set()
    for vertex in sorted(beside):
        before, after = beside[vertex]
        if before != after and _off_line(points[[before, vertex, after]]) <= tolerance:
            gone.add(vertex)
            for one, other in ((before, after), (after, before)):
                if one in beside:
                    beside[one] = tuple(other if v == vertex else v for v in beside[one])  # type: ignore[assignment]
    slim = [tuple(v for v in face if v not in gone) for face in faces]
    return tuple(slim) if min(map(len, slim)) >= 3 else faces


def _off_line(corners: Array) -> float:
    """Return the distance of the second of three points from the segment between the others, m."""
    a, p, b = corners
    along = b - a
    t = np.clip((p - a) @ along / max(float(along @ along), np.finfo(float).tiny), 0.0, 1.0)
    return float(np.linalg.norm(p - a - t * along))

"""Faces of one solid that lie in one plane, made one face."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

import numpy as np

from limitblocks.arrays import Array
from limitblocks.geometry.cracks import sides_of
from limitblocks.geometry.polyhedron import Faces

#: Angle between the normals of faces that count as coplanar, rad.
ANGLE = 1e-2
#: Distance from one plane, relative to the block's size, that counts as coplanar.
FLAT = 1e-4
#: Distance from the line through its neighbours, relative to the block's size, of a needless vertex.
COLLINEAR = 1e-6


def merged(points: Array, faces: Faces, size: float, most: int) -> tuple[Faces, float]:
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
    most : int
        Faces after which no more are looked for; more than these are returned then.
    """
    limit = FLAT * size
    rings: list[tuple[int, ...]] = []
    warp = 0.0
    for members in _regions(points, faces, limit, most):
        ring = _ring([faces[k] for k in members]) if len(members) > 1 else ()
        off = warp_of(points, ring, {v for k in members for v in faces[k]}) if ring else 0.0
        if ring and off <= 2.0 * limit:
            warp = max(warp, off)
            rings.append(ring)
        else:
            rings += [faces[k] for k in members]
    return _without_needless(points, tuple(rings), COLLINEAR * size), warp


def divided(points: Array, faces: Faces) -> Faces:
    """Return the faces; those that meet a vertex twice, as an outline bridged to a hole, in triangles."""
    from manifold3d import triangulate

    planar: list[tuple[int, ...]] = []
    for face in faces:
        if len(set(face)) == len(face):
            planar.append(face)
            continue
        corners = points[list(face)]
        normal = area_vectors(corners, (tuple(range(len(face))),))[0]
        trios = triangulate([corners[:, axes_along(normal)]])
        planar += [tuple(face[v] for v in trio) for trio in trios.tolist()]
    return tuple(planar)


def axes_along(normal: Array) -> list[int]:
    """Return the two axes nearest to the plane of a normal, in the order that keeps the sense of rotation."""
    k = int(np.abs(normal).argmax())
    return [(k + 1) % 3, (k + 2) % 3][:: 1 if normal[k] > 0.0 else -1]


def area_vectors(points: Array, faces: Faces) -> Array:
    """Return the area vectors (m, 3) of faces over points (n, 3), m2."""
    sides, owner = sides_of(faces)
    first = np.array([face[0] for face in faces])[owner]
    swept = np.cross(points[sides[:, 0]] - points[first], points[sides[:, 1]] - points[first])
    return np.asarray(np.add.reduceat(swept, np.flatnonzero(np.diff(owner, prepend=-1))) / 2.0)


def _regions(points: Array, faces: Faces, limit: float, most: int) -> list[list[int]]:
    """Return groups of adjacent faces, each within `limit` of the plane of its largest face."""
    vectors = area_vectors(points, faces)
    areas = np.linalg.norm(vectors, axis=1)
    normals = vectors / np.maximum(areas, np.finfo(float).tiny)[:, None]
    owner = {(face[k - 1], face[k]): f for f, face in enumerate(faces) for k in range(len(face))}
    longest, length = _longest_sides(points, faces)
    slim = areas <= limit * length
    least = np.cos(ANGLE)
    free = np.ones(len(faces), dtype=bool)
    regions: list[list[int]] = []
    for seed in np.argsort(-areas, kind="stable").tolist():
        if len(regions) > most:
            break
        if not free[seed]:
            continue
        free[seed] = False
        region = [seed]
        for f in region:  # grows while it is walked
            for k in range(len(faces[f])):
                back = faces[f][k], faces[f][k - 1]
                g = owner[back]
                # the normal of a slim face is noise; across a short side it would make a spike
                opens = longest[g] == back if slim[g] else normals[g] @ normals[seed] >= least
                if free[g] and opens and _height(points, faces[g], faces[seed], normals[seed]) <= limit:
                    free[g] = False
                    region.append(g)
        regions.append(region)
    return regions


def _height(points: Array, face: tuple[int, ...], base: tuple[int, ...], normal: Array) -> float:
    """Return the largest distance of a face from the plane of `normal` through a corner of `base`, m."""
    return float(np.abs((points[list(face)] - points[base[0]]) @ normal).max())


def _longest_sides(points: Array, faces: Faces) -> tuple[list[tuple[int, int]], Array]:
    """Return the longest side of each face, from vertex to vertex, and the length (m,) of it, m."""
    sides, owner = sides_of(faces)
    lengths = np.linalg.norm(points[sides[:, 1]] - points[sides[:, 0]], axis=1)
    last = np.lexsort((lengths, owner))[np.flatnonzero(np.diff(owner, append=-1))]
    return [(a, b) for a, b in sides[last].tolist()], lengths[last]


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


def warp_of(points: Array, ring: tuple[int, ...], vertices: Iterable[int]) -> float:
    """Return the largest distance of `vertices` from the mean plane of a ring, m."""
    corners = points[list(ring)]
    arms = corners - corners[0]
    vector = np.cross(arms[1:-1], arms[2:]).sum(axis=0)
    length = np.linalg.norm(vector)
    heights = (points[list(vertices)] - corners.mean(axis=0)) @ vector
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
        if _off_line(points[[before, vertex, after]]) <= tolerance:
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

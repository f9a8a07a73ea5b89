"""Polyhedra with planar faces, convex or not: closedness, face planes, volume, centroid, convexity.

Points are taken about a place near the body (its mean vertex): results stay exact far from the origin.
"""

from __future__ import annotations

from collections import Counter
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from limitblocks.arrays import Array, Indices

Faces = tuple[tuple[int, ...], ...]

#: Distance from a plane, relative to the block's size, that still counts as in the plane.
PLANE_TOLERANCE = 1e-3
#: Height of a vertex above a face of a convex block, relative to its size.
CONVEX_TOLERANCE = 1e-4
#: Length, area and volume, relative to powers of the block's size, that count as nothing.
ZERO_TOLERANCE = 1e-9
#: Distance from the others, over theirs, that makes one vertex a slip; from the origin, over the size, far.
_STRAY, _FAR = 1e3, 1e6
_CHUNK = 2_000_000  # heights held in memory at once


class Mesh(NamedTuple):
    """Half-edges of a polyhedron, face after face: e half-edges, m faces.

    `start`, `end` and `after` (e,) are a half-edge's vertices and the next one around its face, `face` (e,)
    is its face, `beyond` (e,) the face on the other side and `first` (m,) the first half-edge of each face.
    """

    start: Indices
    end: Indices
    after: Indices
    face: Indices
    beyond: Indices
    first: Indices


class Shape(NamedTuple):
    """Signed volume, centroid (3,), area vectors (m, 3) pointing out of the body, second moment (3, 3).

    The second moment is that of the volume about the centroid, over the volume.
    """

    volume: float
    centroid: Array
    area_vectors: Array
    second: Array


def prism(outline: Array, low: float, high: float, axis: int) -> tuple[Array, Faces]:
    """Return vertices and faces of the prism of an outline (n, 2), turning either way, along an axis.

    The outline is in the other two axes in their order.
    """
    u, v = outline.T
    turn = float(u @ np.roll(v, -1) - v @ np.roll(u, -1)) * (-1.0 if axis == 1 else 1.0)
    points, n = outline[::-1] if turn > 0.0 else outline, len(outline)
    sides = ((k, k + n, (k + 1) % n + n, (k + 1) % n) for k in range(n))
    vertices = np.insert(np.tile(points, (2, 1)), axis, np.repeat([low, high], n), axis=1)
    return vertices, (tuple(range(n)), tuple(reversed(range(n, 2 * n))), *sides)


def compacted(loops: Faces) -> tuple[Indices, Faces]:
    """Return the vertices that faces use, in order, and the faces over these alone."""
    used, place = np.unique(np.concatenate(loops), return_inverse=True)
    ends = np.cumsum([len(loop) for loop in loops])[:-1]
    return used, tuple(tuple(part.tolist()) for part in np.split(place.reshape(-1), ends))


@lru_cache(maxsize=1024)
def mesh(faces: Faces) -> Mesh:
    """Return the half-edges of `faces` (vertex indices, counter-clockwise seen from outside)."""
    counts = np.array([len(face) for face in faces])
    start, end, after = (
        np.array([v for f in faces for v in f[k:] + f[:k]], dtype=np.int64) for k in range(3)
    )
    face = np.repeat(np.arange(len(faces)), counts)
    # each edge is used once in each direction: sorted either way, a half-edge meets its twin
    beyond = np.empty_like(face)
    beyond[np.lexsort((start, end))] = face[np.lexsort((end, start))]
    return Mesh(start, end, after, face, beyond, np.cumsum(counts) - counts)


@lru_cache(maxsize=1024)
def mesh_fault(faces: Faces, vertices: int) -> str:
    """Say what keeps `faces` over so many vertices from being a closed surface; empty when sound."""
    if len(faces) < 4:
        return f"{len(faces)} faces given; a polyhedron has at least 4"
    for k, face in enumerate(faces):
        if len(face) < 3:
            return f"face {k} has {len(face)} vertices; a face has at least 3"
        if len(set(face)) < len(face):
            return f"face {k} = {face} repeats a vertex; list each vertex of a face once"
        if min(face) < 0 or max(face) >= vertices:
            return f"face {k} = {face} has a vertex index out of range; indices run from 0 to {vertices - 1}"
    unused = set(range(vertices)).difference(*faces)
    if unused:
        return f"vertex {min(unused)} belongs to no face; remove it or add the missing face"
    edges = Counter((face[k - 1], face[k]) for face in faces for k in range(len(face)))
    for (a, b), times in edges.items():
        if times != 1 or edges[b, a] != 1:
            return (
                f"the faces are not a closed surface: uses of edge {a}-{b}: {times} from {a} to {b}, "
                f"{edges[b, a]} back; each edge must be used once in each direction"
            )
    return ""


def shape(points: Array, edges: Mesh) -> Shape:
    """Return volume (m3), centroid (m), area vectors (m2) and second moment (m2) of a closed polyhedron.

    The integral of x x^T over a tetrahedron from the origin is V / 20 times the sum of v v^T over its other
    vertices and their sum.

    Parameters
    ----------
    points : Array, shape (n, 3)
        Vertices about a place near the body, m.
    edges : Mesh
        Half-edges over the vertices.
    """
    swept = np.cross(points[edges.start], points[edges.end])
    apex = points[edges.start[edges.first]][edges.face]
    # signed tetrahedra (origin, first vertex of the face, half-edge)
    volumes = np.einsum("ij,ij->i", apex, swept) / 6.0
    corners = np.stack([apex, points[edges.start], points[edges.end]])
    corners = np.concatenate([corners, corners.sum(axis=0, keepdims=True)])
    volume = float(volumes.sum())
    centroid = volumes @ corners[3] / 4.0 / (volume or np.nan)
    second = np.einsum("e,kei,kej->ij", volumes / 20.0, corners, corners) / (volume or np.nan)
    vectors = np.add.reduceat(swept, edges.first) / 2.0
    return Shape(volume, centroid, vectors, second - np.outer(centroid, centroid))


def face_planes(points: Array, edges: Mesh, area_vectors: Array) -> tuple[Array, Array]:
    """Return unit normals (m, 3) and offsets (m,) of the face planes `normals @ x = offsets`.

    The plane is square to the area vector, which makes the projected area of the face largest, and passes
    through the mean corner, which makes the sum of squared heights of the corners least.
    """
    normals = area_vectors / np.sqrt(np.einsum("ij,ij->i", area_vectors, area_vectors))[:, None]
    counts = np.diff(edges.first, append=len(edges.start))
    middles = np.add.reduceat(points[edges.start], edges.first) / counts[:, None]
    return normals, np.einsum("ij,ij->i", normals, middles)


def is_convex(points: Array, edges: Mesh, size: float, planes: tuple[Array, Array]) -> bool:
    """Tell whether no vertex of a sound polyhedron lies above a face by more than 1e-4 of its size."""
    if len(points) - len(edges.start) // 2 + len(edges.first) != 2:  # several shells, or a hole through it
        return False
    normals, offsets = planes
    rows = max(1, _CHUNK // len(points))
    parts = (slice(k, k + rows) for k in range(0, len(normals), rows))
    limit = CONVEX_TOLERANCE * size
    return all(((normals[part] @ points.T).max(axis=1) - offsets[part]).max() <= limit for part in parts)


def shape_fault(points: Array, edges: Mesh, body: Shape) -> str:
    """Say what keeps a closed surface from bounding a volume; empty when sound."""
    size = float(np.ptp(points, axis=0).max())
    sides = points[edges.end] - points[edges.start]
    lengths2 = np.einsum("ij,ij->i", sides, sides)
    if lengths2.min() <= (ZERO_TOLERANCE * size) ** 2:
        k = lengths2.argmin()
        ends = f"vertices {edges.start[k]} and"
        if lengths2[k] > 0.0:
            apart = f"{np.sqrt(lengths2[k]):.3g} m apart, which is nothing beside a size of {size:.3g} m"
            return f"{ends} {edges.end[k]} are {apart}"
        return f"{ends} {edges.end[k]} coincide; keep one of them"
    if abs(body.volume) <= ZERO_TOLERANCE * size**3:
        return f"the volume is zero ({body.volume:.3g} m3 for a size of {size:.3g} m); a block has a volume"
    if body.volume < 0.0:
        return (
            f"the volume is negative ({body.volume:.3g} m3): the faces point inward, or a vertex is out of "
            "place; list the vertices of each face counter-clockwise seen from outside"
        )
    areas = np.sqrt(np.einsum("ij,ij->i", body.area_vectors, body.area_vectors))
    if areas.min() <= ZERO_TOLERANCE * size**2:
        return f"face {areas.argmin()} has no area; its vertices must span a plane"
    return ""


def odd_places(vertices: Array) -> str:
    """Say what in the places of vertices (n, 3), m, may make a shape impossible; empty for nothing."""
    away = np.abs(vertices - np.median(vertices, axis=0)).max(axis=1)
    k, size = int(away.argmax()), float(np.ptp(vertices, axis=0).max())
    place, largest = ", ".join(f"{x:.6g}" for x in vertices[k]), float(np.abs(vertices).max())
    if len(away) > 4 and away[k] > _STRAY * np.partition(away, -2)[-2]:
        return f"; vertex {k} at ({place}) m is far from all others: a slip?"
    if largest > _FAR * size:
        return (
            f"; at {largest:.3g} m from the origin coordinates may have too few digits for it: move the "
            "structure to the origin in the program that wrote it"
        )
    return ""


def plane_fault(points: Array, edges: Mesh, size: float, planes: tuple[Array, Array]) -> str:
    """Say which vertex lies out of the plane of its face; empty when none does."""
    normals, offsets = planes
    limit = PLANE_TOLERANCE * size
    warp = np.abs(np.einsum("ij,ij->i", normals[edges.face], points[edges.start]) - offsets[edges.face])
    if warp.max() > limit:
        k = warp.argmax()
        return (
            f"face {edges.face[k]} is not planar: vertex {edges.start[k]} is {warp[k]:.3g} m out of its "
            f"plane; at most {limit:.3g} m is allowed, split the face or move the vertex"
        )
    return ""

"""Faces of one solid as lists of vertices: welded at their vertices, closed at their open sides."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from limitblocks.arrays import Array, Indices, first_tied
from limitblocks.errors import GeometryError
from limitblocks.geometry.polyhedron import Faces

_MOST_OPEN = 1000  # open edges: more of them are no crack
_MOST_NEIGHBOURS = 50  # vertices within the tolerance of one vertex, on average


def closed(name: str, points: Array, loops: Faces, tolerance: float, notes: list[str]) -> tuple[Array, Faces]:
    """Close cracks: weld vertices on open sides, and give open sides the vertices that lie on them."""
    rim = np.unique(open_sides(loops))
    target = np.arange(len(points))
    target[rim] = rim[clusters(name, points[rim], tolerance)]
    width = np.linalg.norm(points - points[target], axis=1).max()
    if 0.0 < width <= 2.0 * tolerance:  # a longer chain of vertices is an edge, not a crack
        loops = tidy(renumbered(loops, target), notes)
        notes.append(f"a crack up to {width:.2g} m wide closed")
    sides = open_sides(loops)
    if 0 < len(sides) <= _MOST_OPEN:
        between, off = _on_sides(points, sides, tolerance)
        if between:
            notes.append("vertices inserted where they lie on the edge of another face, within "
                         f"{off:.2g} m: {sum(map(len, between.values()))}")  # fmt: skip
            loops = tuple(
                tuple(
                    v for k in range(len(loop)) for v in (*between.get((loop[k - 1], loop[k]), ()), loop[k])
                )
                for loop in loops
            )
    return points, loops


def _on_sides(
    points: Array, sides: Indices, tolerance: float
) -> tuple[dict[tuple[int, int], tuple[int, ...]], float]:
    """Return the vertices of open sides that lie on other open sides, in order along them; how far off."""
    rim = np.unique(sides)
    start, along = points[sides[:, 0]], points[sides[:, 1]] - points[sides[:, 0]]
    length = np.linalg.norm(along, axis=1)
    arm = points[rim] - start[:, None]
    place = np.einsum("qri,qi->qr", arm, along) / length[:, None]
    off = np.linalg.norm(arm - (place / length[:, None])[..., None] * along[:, None], axis=2)
    on = (off <= tolerance) & (place > tolerance) & (place < length[:, None] - tolerance)
    between = {
        (int(a), int(b)): tuple(rim[row][np.argsort(place[k, row])].tolist())
        for k, ((a, b), row) in enumerate(zip(sides, on, strict=True))
        if row.any()
    }
    return between, float(off[on].max(initial=0.0))


def clusters(name: str, points: Array, tolerance: float) -> Indices:
    """Return for each point the first of those that a chain of distances within `tolerance` ties to it."""
    n = len(points)
    tree = cKDTree(points)
    if tree.count_neighbors(tree, tolerance) > _MOST_NEIGHBOURS * n:
        raise GeometryError(
            f"block {name!r}: its {n} vertices lie within {tolerance:.2g} m of one another; "
            "a coarser mesh is needed"
        )
    return first_tied(tree.query_pairs(tolerance, output_type="ndarray"), n)


def renumbered(loops: Faces, number: Indices) -> Faces:
    """Return the faces with vertex k called number[k]."""
    return tuple(tuple(number[list(loop)].tolist()) for loop in loops)


def tidy(loops: Faces, notes: list[str]) -> Faces:
    """Return the faces without repeated vertices next to one another, without lines and repeated faces."""
    clean = [tuple(v for k, v in enumerate(loop) if v != loop[k - 1]) for loop in loops]
    solid = [loop for loop in clean if len(set(loop)) >= 3]
    distinct = {frozenset(loop): loop for loop in reversed(solid)}
    if len(solid) < len(loops):
        notes.append(f"{len(loops) - len(solid)} of {len(loops)} faces without area left out")
    if len(distinct) < len(solid):
        notes.append(
            f"{len(solid) - len(distinct)} of {len(solid)} faces repeat another one and are left out"
        )
    return tuple(reversed(distinct.values()))


def sides_of(loops: Faces) -> tuple[Indices, Indices]:
    """Return the sides (e, 2), vertex to vertex, of all faces, and the face (e,) of each."""
    sides = [(loop[k - 1], loop[k]) for loop in loops for k in range(len(loop))]
    owner = np.repeat(np.arange(len(loops)), [len(loop) for loop in loops])
    return np.array(sides, dtype=np.int64).reshape(-1, 2), owner


def edges_of(sides: Indices) -> tuple[Indices, Indices, Indices]:
    """Return the edges (q, 2), the edge (e,) of each of the sides (e, 2), and how many sides (q,) it has."""
    edges, edge, uses = np.unique(np.sort(sides, axis=1), axis=0, return_inverse=True, return_counts=True)
    return edges, edge.reshape(-1), uses


def open_sides(loops: Faces) -> Indices:
    """Return the sides (q, 2) that belong to one face only."""
    sides, _ = sides_of(loops)
    _, edge, uses = edges_of(sides)
    return np.asarray(sides[uses[edge] == 1])

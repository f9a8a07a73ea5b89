"""Surfaces of polyhedra that are not convex: triangles, loops that cross, shells, self-intersection."""

from __future__ import annotations

import numpy as np
import shapely

from limitblocks.arrays import Array, Indices, tied
from limitblocks.geometry.neighbours import overlapping_boxes
from limitblocks.geometry.pieces import delaunay
from limitblocks.geometry.polygon import axes_of
from limitblocks.geometry.polyhedron import Mesh

#: Sine of the turn at a corner, and height over size, that count as nothing.
_NOTHING = 1e-9


def loop_fault(points: Array, edges: Mesh, normals: Array) -> str:
    """Say which face of planar loops crosses or touches itself; empty when none does."""
    for k in _bent(points, edges, normals):
        ring = _flat(points[_loop(edges, k)], normals[k])
        if not shapely.is_valid(shapely.polygons(ring)):
            reason = shapely.is_valid_reason(shapely.polygons(ring))
            place = np.fromstring(reason[reason.find("[") + 1 : -1], sep=" ") if "[" in reason else ring[0]
            vertex = _loop(edges, k)[np.linalg.norm(ring - place, axis=1).argmin()]
            return f"face {k} crosses itself near vertex {vertex}; list its corners in order around it"
    return ""


def surface_fault(points: Array, edges: Mesh, normals: Array, size: float) -> str:
    """Say what keeps the surface of a body that is not convex from bounding one piece; empty when sound.

    Told are edges that pierce a face, cavities outside the body or with faces that point into it, and
    separate pieces. Faces that overlap in their own plane are not told from sound ones.
    """
    sides = triangles(points, edges, normals)
    fault = _piercing(points, edges, sides, size)
    return fault or _shell_fault(points, edges, sides)


def triangles(points: Array, edges: Mesh, normals: Array) -> tuple[Indices, Indices]:
    """Return triangles of the faces: vertices (t, 3), counter-clockwise from outside, and their face (t,).

    Fans for faces without reflex corners, constrained Delaunay triangles for the others, and where a fan
    would have one without area, as next to a corner on a straight side: what makes solids takes it for
    something to mend. No vertices are added.
    """
    bent = _bent(points, edges, normals)
    apex = edges.start[edges.first][edges.face]
    inner = (edges.start != apex) & (edges.end != apex)
    fans, owner = np.column_stack([apex, edges.start, edges.end])[inner], edges.face[inner]
    others = np.union1d(bent, owner[_breadth(points[fans]) <= _NOTHING])
    kept = ~np.isin(owner, others)
    divided, owners = [fans[kept]], [owner[kept]]
    for k in others:
        loop = _loop(edges, k)
        flat = _flat(points[loop], normals[k])
        vertex = dict(zip(map(tuple, flat.tolist()), loop.tolist(), strict=True))
        trios = [[vertex[place] for place in trio] for trio in delaunay(shapely.polygons(flat))]
        divided.append(np.array(trios))
        owners.append(np.full(len(trios), k))
    return np.concatenate(divided), np.concatenate(owners)


def _breadth(corners: Array) -> Array:
    """Heights of triangles (t, 3, 3) over their longest sides, over these, shape (t,)."""
    sides = corners - np.roll(corners, 1, axis=1)
    longest = np.linalg.norm(sides, axis=2).max(axis=1)
    areas = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    return np.asarray(areas / np.maximum(longest**2, np.finfo(float).tiny))


def _bent(points: Array, edges: Mesh, normals: Array) -> Indices:
    """Return the faces with a reflex corner, or that turn more than once."""
    before = points[edges.end] - points[edges.start]
    after = points[edges.after] - points[edges.end]
    cross = np.einsum("ij,ij->i", np.cross(before, after), normals[edges.face])
    turns = np.arctan2(cross, np.einsum("ij,ij->i", before, after))
    reflex = np.minimum.reduceat(turns, edges.first) < -_NOTHING
    return np.flatnonzero(reflex | (np.add.reduceat(turns, edges.first) > 3.0 * np.pi))


def _loop(edges: Mesh, face: int) -> Indices:
    return np.asarray(edges.start[edges.face == face])


def _flat(points: Array, normal: Array) -> Array:
    """Return points (n, 3) in a right-handed frame of the plane square to `normal`, (n, 2)."""
    return np.asarray((points - points[0]) @ axes_of(normal)[:2].T)


def _piercing(points: Array, edges: Mesh, sides: tuple[Indices, Indices], size: float) -> str:
    """Say which edge passes through the inside of which face; empty when none does."""
    corners, face = sides
    once = edges.start < edges.end
    ends = np.column_stack([edges.start[once], edges.end[once]])
    low = np.concatenate([points[each].min(axis=1) for each in (ends, corners)])
    high = np.concatenate([points[each].max(axis=1) for each in (ends, corners)])
    pairs = overlapping_boxes(low, np.maximum(high, low + _NOTHING * size))
    e, t = pairs[(pairs[:, 0] < len(ends)) & (pairs[:, 1] >= len(ends))].T
    t = t - len(ends)
    apart = (ends[e][:, :, None] != corners[t][:, None, :]).all(axis=(1, 2))
    e, t = e[apart], t[apart]
    start, end = points[ends[e]].swapaxes(0, 1)
    a, b, c = points[corners[t]].swapaxes(0, 1)
    normal = np.cross(b - a, c - a)
    # heights of both ends over the triangle, and volumes with its sides, all in terms of the block's size
    heights = [np.einsum("ij,ij->i", x - a, normal) for x in (start, end)]
    scale = _NOTHING * size * np.linalg.norm(normal, axis=1)
    through = (np.minimum(*heights) < -scale) & (np.maximum(*heights) > scale)
    ray = end - start
    volumes = np.array(
        [np.einsum("ij,ij->i", ray, np.cross(p - start, q - start)) for p, q in ((a, b), (b, c), (c, a))]
    )
    through &= (volumes > _NOTHING * size**3).all(axis=0) | (volumes < -_NOTHING * size**3).all(axis=0)
    if not through.any():
        return ""
    k = int(through.argmax())
    return (
        f"the surface crosses itself: edge {ends[e[k], 0]}-{ends[e[k], 1]} passes through face "
        f"{face[t[k]]}; a block bounds one volume"
    )


def _shell_fault(points: Array, edges: Mesh, sides: tuple[Indices, Indices]) -> str:
    """Say which shell is no cavity of the outer one; empty when all others are."""
    corners, face = sides
    shell = tied(np.column_stack([edges.face, edges.beyond]), len(edges.first))
    count = int(shell.max()) + 1
    if count == 1:
        return ""
    a, b, c = points[corners].swapaxes(0, 1)
    volumes = np.bincount(shell[face], np.einsum("ij,ij->i", a, np.cross(b, c)) / 6.0)
    outer = int(volumes.argmax())
    for k in np.flatnonzero(np.arange(count) != outer):
        first = int(np.flatnonzero(shell == k)[0])
        if volumes[k] > 0.0:
            return (
                f"face {first} belongs to a second piece, or to a cavity whose faces point out of it; a "
                "block is one piece, and the faces of a cavity point into the cavity"
            )
        others = shell[face] != k
        if winding(points[corners[~others][0, 0]], points[corners[others]]) != 1:
            return f"face {first} belongs to a cavity that is not inside the block alone"
    return ""


def winding(place: Array, corners: Array) -> int:
    """Return how often closed triangles (t, 3, 3) wind round a place: their solid angles over 4 pi.

    Van Oosterom & Strackee (1983), IEEE Transactions on Biomedical Engineering 30, 125-126, Eq. (8).
    """
    a, b, c = (corners - place).swapaxes(0, 1)
    la, lb, lc = (np.linalg.norm(each, axis=1) for each in (a, b, c))
    above = np.einsum("ij,ij->i", a, np.cross(b, c))
    below = la * lb * lc + lc * (a * b).sum(axis=1) + la * (b * c).sum(axis=1) + lb * (c * a).sum(axis=1)
    return round(float(np.arctan2(above, below).sum()) / (2.0 * np.pi))

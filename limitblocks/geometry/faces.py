"""The plane regions of many blocks in flat arrays, and the pairs of them that may touch."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import shapely

from limitblocks.arrays import Array, Indices, repeated, sums
from limitblocks.geometry.block import Block
from limitblocks.geometry.regions import Surfaces, in_turn, regions

_CHUNK = 500_000  # face pairs held in memory at once


class FaceTable(NamedTuple):
    """All plane regions of all blocks, one after the other: m regions, e half-edges around them.

    A region is a face, or several faces in one plane. `corners` and `ends` (e, 3), with `first` and `sides`
    (m,), are where its half-edges start and end; those of a region with one loop around it (`ring`, (m,))
    follow each other.
    `middle`, `normal`, `low`, `high`, `arm` (m, 3) are its mean corner, unit normal, bounds and a direction
    that moves with the block; `area` and `block` (m,) its area and block. `start` and `number` (blocks,) say
    where each block's regions are.
    """

    corners: Array
    ends: Array
    first: Indices
    sides: Indices
    ring: Any
    middle: Array
    normal: Array
    area: Array
    low: Array
    high: Array
    arm: Array
    block: Indices
    start: Indices
    number: Indices


def all_faces(blocks: Sequence[Block], points: Sequence[Array], flat: float, angle: float) -> FaceTable:
    """Return the plane regions of `blocks`, whose vertices are `points` (n, 3) each, m.

    Corners of a region lie within `flat`, m, of its plane, its faces within `angle`, rad.
    """
    surfaces = surfaces_of(blocks, points)
    return face_table(blocks, points, surfaces, regions(surfaces, flat, angle))


def surfaces_of(blocks: Sequence[Block], points: Sequence[Array]) -> Surfaces:
    """Return the half-edges of all faces of `blocks`, whose vertices are `points` (n, 3) each, m."""
    meshes = [block.mesh for block in blocks]
    number = np.array([len(mesh.first) for mesh in meshes])
    before = np.repeat(np.cumsum(number) - number, [len(mesh.face) for mesh in meshes])
    return Surfaces(
        corner=np.concatenate([body[mesh.start] for body, mesh in zip(points, meshes, strict=True)]),
        face=np.concatenate([mesh.face for mesh in meshes]) + before,
        beyond=np.concatenate([mesh.beyond for mesh in meshes]) + before,
        area_vector=np.concatenate([block.normals * block.areas[:, None] for block in blocks]),
    )


def face_table(
    blocks: Sequence[Block], points: Sequence[Array], surfaces: Surfaces, label: Indices
) -> FaceTable:
    """Return the table of regions: faces with the same `label` (m,) are one."""
    meshes = [block.mesh for block in blocks]
    corners, face, beyond, area_vector = surfaces
    start, end = np.concatenate([(mesh.start, mesh.end) for mesh in meshes], axis=1)
    ends = np.concatenate([body[mesh.end] for body, mesh in zip(points, meshes, strict=True)])
    normal = np.concatenate([block.normals for block in blocks])
    area = np.concatenate([block.areas for block in blocks])
    block = np.repeat(np.arange(len(blocks)), [len(mesh.first) for mesh in meshes])
    heads, region = np.unique(label, return_inverse=True)
    single = np.bincount(region) == 1
    # around each region, face after face: the half-edges with another region beyond
    order = np.flatnonzero(region[face] != region[beyond])
    order = order[np.argsort(region[face[order]], kind="stable")]
    own = region[face[order]]
    sides = np.bincount(own, minlength=len(heads))
    first = np.cumsum(sides) - sides
    rings, turn = in_turn(own, first, sides, start[order], end[order])
    order = order[turn]
    vectors = sums(region, area_vector, len(heads))
    areas = np.linalg.norm(vectors, axis=1)
    table = corners[order]
    return FaceTable(
        corners=table,
        ends=ends[order],
        first=first,
        sides=sides,
        ring=rings,
        middle=np.add.reduceat(table, first) / sides[:, None],
        normal=np.where(single[:, None], normal[heads], vectors / areas[:, None]),
        area=np.where(single, area[heads], areas),
        low=np.minimum.reduceat(table, first),
        high=np.maximum.reduceat(table, first),
        arm=_arms(table, start[order], own, first),
        block=block[heads],
        start=np.searchsorted(block[heads], np.arange(len(blocks))),
        number=np.bincount(block[heads], minlength=len(blocks)),
    )


def _arms(corners: Array, vertex: Indices, own: Indices, first: Indices) -> Array:
    """Return the vector (m, 3) from the first to the second vertex of each region, in the block's order."""
    order = np.lexsort((vertex, own))
    # a vertex where a region touches itself counts twice
    later = np.minimum(first + 1, len(order) - 1)
    again = vertex[order[first]] == vertex[order[later]]
    return np.asarray(corners[order[later + again]] - corners[order[first]])


def projected(faces: FaceTable, face: Indices, origin: Array, frame: Array) -> Any:
    """Return regions `face` (m,) as shapely polygons in the first two axes of `frame` about `origin`."""
    owner, k = repeated(faces.sides[face])
    place = faces.first[face][owner] + k
    points = np.einsum("kij,kj->ki", frame[owner, :2], faces.corners[place] - origin[owner])
    rings = faces.ring[face]
    shapes = np.empty(len(face), dtype=object)
    number = np.cumsum(rings) - 1
    of_ring = rings[owner]
    shapes[rings] = shapely.polygons(shapely.linearrings(points[of_ring], indices=number[owner[of_ring]]))
    if not rings.all():
        number = np.cumsum(~rings) - 1
        # sums in one order, so that a corner is the same number in all half-edges that meet there
        frames, about = frame[owner[~of_ring], :2], origin[owner[~of_ring]]
        segments = np.stack([
            (frames * (ends[place[~of_ring]] - about)[:, None]).cumsum(axis=2)[..., 2]
            for ends in (faces.corners, faces.ends)
        ], axis=1)  # fmt: skip
        lines = shapely.multilinestrings(shapely.linestrings(segments), indices=number[owner[~of_ring]])
        shapes[~rings] = shapely.build_area(lines)
    odd = np.flatnonzero(~shapely.is_valid(shapes))
    shapes[odd] = shapely.make_valid(shapes[odd], method="structure", keep_collapsed=False)
    return shapes


def opposed(faces: FaceTable, pairs: Indices, tolerance: float, angle: float) -> tuple[Indices, Indices]:
    """Return the face pairs of `pairs` of blocks that may touch: opposed, close, with overlapping bounds."""
    rows = faces.number[pairs].prod(axis=1).sum()
    parts = np.array_split(pairs, 1 + rows // _CHUNK)
    a, b = zip(*(_opposed(faces, part, tolerance, angle) for part in parts), strict=True)
    return np.concatenate(a), np.concatenate(b)


def _opposed(faces: FaceTable, pairs: Indices, tolerance: float, angle: float) -> tuple[Indices, Indices]:
    a, b = _facing(faces, pairs, tolerance)
    away = faces.normal[a] + faces.normal[b]
    keep = np.einsum("ij,ij->i", away, away) <= (2.0 * np.sin(angle / 2.0)) ** 2
    a, b = a[keep], b[keep]
    keep = (faces.low[a] <= faces.high[b] + tolerance).all(axis=1)
    keep &= (faces.low[b] <= faces.high[a] + tolerance).all(axis=1)
    a, b = a[keep], b[keep]
    # within the angle, no part of face b is nearer to plane a than this
    slack = tolerance + angle * np.linalg.norm(faces.high[b] - faces.low[b], axis=1)
    keep = np.abs(np.einsum("ij,ij->i", faces.middle[b] - faces.middle[a], faces.normal[a])) <= slack
    return a[keep], b[keep]


def _facing(faces: FaceTable, pairs: Indices, tolerance: float) -> tuple[Indices, Indices]:
    """Return the pairs of regions of `pairs` of blocks, each within the bounds of the other block."""
    low = np.minimum.reduceat(faces.low, faces.start)
    high = np.maximum.reduceat(faces.high, faces.start)
    near, count = [], []
    for own, other in (pairs.T, pairs.T[::-1]):
        pair, k = repeated(faces.number[own])
        face = faces.start[own][pair] + k
        touching = (faces.low[face] <= high[other][pair] + tolerance).all(axis=1)
        touching &= (low[other][pair] <= faces.high[face] + tolerance).all(axis=1)
        near.append(face[touching])
        count.append(np.bincount(pair[touching], minlength=len(pairs)))
    pair, k = repeated(count[0] * count[1])
    first, second = (np.cumsum(each) - each for each in count)
    width = count[1][pair]
    return near[0][first[pair] + k // width], near[1][second[pair] + k % width]

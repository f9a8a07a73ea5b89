"""All faces of many blocks in flat arrays, and the pairs of them that may touch."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from limitblocks.arrays import Array, Indices
from limitblocks.geometry.block import Block

_CHUNK = 500_000  # face pairs held in memory at once


class FaceTable(NamedTuple):
    """All faces of all blocks, one after the other: m faces, e face corners.

    `corners` (e, 3) with `first` and `sides` (m,) are each face's corners; `middle`, `normal`, `low`,
    `high` (m, 3) its mean corner, unit normal and bounds; `area` and `block` (m,) its area and block. `start`
    and `number` (blocks,) say where each block's faces are.
    """

    corners: Array
    first: Indices
    sides: Indices
    middle: Array
    normal: Array
    area: Array
    low: Array
    high: Array
    block: Indices
    start: Indices
    number: Indices


def all_faces(blocks: Sequence[Block], points: Sequence[Array]) -> FaceTable:
    """Return the faces of `blocks`, whose vertices are `points` (n, 3) each, m."""
    corners = np.concatenate([body[block.mesh.start] for body, block in zip(points, blocks, strict=True)])
    sides = np.array([len(face) for block in blocks for face in block.faces])
    first = np.cumsum(sides) - sides
    number = np.array([len(block.faces) for block in blocks])
    return FaceTable(
        corners=corners,
        first=first,
        sides=sides,
        middle=np.add.reduceat(corners, first) / sides[:, None],
        normal=np.concatenate([block.normals for block in blocks]),
        area=np.concatenate([block.areas for block in blocks]),
        low=np.minimum.reduceat(corners, first),
        high=np.maximum.reduceat(corners, first),
        block=np.repeat(np.arange(len(blocks)), number),
        start=np.cumsum(number) - number,
        number=number,
    )


def ranges(counts: Indices) -> tuple[Indices, Indices]:
    """Return for each count k its position, k times, and the numbers 0..k-1."""
    owner = np.repeat(np.arange(len(counts)), counts)
    return owner, np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)


def opposed(faces: FaceTable, pairs: Indices, tolerance: float, angle: float) -> tuple[Indices, Indices]:
    """Return the face pairs of `pairs` of blocks that may touch: opposed, close, with overlapping bounds."""
    rows = faces.number[pairs].prod(axis=1).sum()
    parts = np.array_split(pairs, 1 + rows // _CHUNK)
    a, b = zip(*(_opposed(faces, part, tolerance, angle) for part in parts), strict=True)
    return np.concatenate(a), np.concatenate(b)


def _opposed(faces: FaceTable, pairs: Indices, tolerance: float, angle: float) -> tuple[Indices, Indices]:
    i, j = pairs.T
    pair, k = ranges(faces.number[i] * faces.number[j])
    a = faces.start[i][pair] + k // faces.number[j][pair]
    b = faces.start[j][pair] + k % faces.number[j][pair]
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

"""Interpenetration of blocks: separating axes, depth and common volume."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from limitblocks.arrays import Array, Indices
from limitblocks.geometry.block import Block
from limitblocks.geometry.findings import Overlap
from limitblocks.geometry.neighbours import bounds_of

_CHUNK = 2_000_000  # distances held in memory at once
_FEW = 1000  # pairs of edges that are tried before a common part is made
_THIN = 0.5  # of the mean thickness of the thinner block: no overlap deeper than this is tolerated
_ASIDE = 1e-4 * np.array([0.5318, 0.6771, 0.5089])  # of the tolerance, in no direction that faces have


def find_overlaps(
    blocks: Sequence[Block], points: Sequence[Array], pairs: Indices, tolerance: float
) -> tuple[Overlap, ...]:
    """Return every pair of blocks that interpenetrate deeper than `tolerance`, in the order of `pairs`.

    Depth is the least translation that separates the two blocks, or their convex hulls, by the
    separating-axis theorem: face normals settle nearly all pairs, cross products of edges the rest. Where a
    block is not convex and the hulls do overlap, depth is the mean thickness of the common part (see
    :class:`Overlap`). No more is tolerated than half the mean thickness, 2 volume / surface, of the thinner
    block.

    Parameters
    ----------
    blocks : sequence of Block
    points : sequence of Array, each (n, 3)
        Vertices of each block about the centre of the model, m.
    pairs : Indices, shape (p, 2)
        Blocks that may overlap, those with overlapping bounds at least.
    tolerance : float
        m.
    """
    thickness = np.array([2.0 * block.volume / block.areas.sum() for block in blocks])
    limits = np.minimum(tolerance, _THIN * thickness[pairs].min(axis=1))
    deep = _bounds_depths(points, pairs) > limits
    pairs, limits = pairs[deep], limits[deep]
    if len(pairs) == 0:
        return ()
    bodies = {k: _Body.of(blocks[k], points[k]) for k in np.unique(pairs).tolist()}
    depths = np.minimum(_face_depths(bodies, pairs), _face_depths(bodies, pairs[:, ::-1]))
    solid = cache(lambda k: solid_of(blocks[k], points[k]))
    overlaps = []
    deep = depths > limits
    for (i, j), face_depth, limit in zip(
        pairs[deep].tolist(), depths[deep], limits[deep].tolist(), strict=True
    ):
        first, second = bodies[i], bodies[j]
        convex = blocks[i].convex and blocks[j].convex
        depth = float(face_depth)
        if convex or len(first.edges) * len(second.edges) < _FEW:
            depth = min(depth, _edge_depth(first, second, limit))
        if depth <= limit:
            continue
        common = solid(i) ^ solid(j)
        depth = depth if convex else _thickness(common, limit)
        if depth > limit:
            volume = float(common.volume())
            share = volume / min(blocks[i].volume, blocks[j].volume)
            overlaps.append(Overlap(blocks[i].name, blocks[j].name, depth, volume, limit, share))
    return tuple(overlaps)


def solid_of(block: Block, points: Array) -> Any:
    """Return a block with its vertices at `points` as a solid of manifold3d."""
    from manifold3d import Manifold, Mesh64

    return Manifold(Mesh64(np.array(points), block.triangles.astype(np.uint64)))


def _thickness(common: Any, limit: float) -> float:
    """Return the largest mean thickness of the pieces of a solid, m.

    Faces that touch leave sheets without volume, which tie pieces together and count in their surface; what
    a solid has in common with itself a little aside has none.
    """
    parts = (common ^ common.translate((_ASIDE * limit).tolist())).decompose()
    return max(
        (2.0 * part.volume() / part.surface_area() for part in parts if part.volume() > 0.0), default=0.0
    )


def _bounds_depths(points: Sequence[Array], pairs: Indices) -> Array:
    """Return how deep the bounds of pairs of blocks overlap, (p,), m."""
    low, high = bounds_of(points)
    i, j = pairs.T
    return np.asarray(np.minimum(high[i] - low[j], high[j] - low[i]).min(axis=1))


class _Body(NamedTuple):
    """Vertices (n, 3), face normals (m, 3), offsets (m,) and unit edges (e, 3) of a convex block."""

    points: Array
    normals: Array
    offsets: Array
    edges: Array

    @classmethod
    def of(cls, block: Block, points: Array) -> _Body:
        # the greatest height, not the mean of the face: a face may be warped within its tolerance
        rows = max(1, _CHUNK // len(points))
        parts = (block.normals[k : k + rows] for k in range(0, len(block.normals), rows))
        offsets = np.concatenate([(part @ points.T).max(axis=1) for part in parts])
        once = block.mesh.start < block.mesh.end
        edges = points[block.mesh.end[once]] - points[block.mesh.start[once]]
        return cls(points, block.normals, offsets, edges)


def _face_depths(bodies: dict[int, _Body], pairs: Indices) -> Array:
    """Return the least depth (p,) of each second body of a pair behind a face of the first, m."""
    depths = np.empty(len(pairs))
    shapes = np.array([(len(bodies[i].normals), len(bodies[j].points)) for i, j in pairs])
    kinds, kind, count = np.unique(shapes, axis=0, return_inverse=True, return_counts=True)
    groups = np.split(kind.ravel().argsort(kind="stable"), count.cumsum()[:-1])
    for (faces, vertices), group in zip(kinds, groups, strict=True):
        number = min(group.size, 1 + group.size * faces * vertices // _CHUNK)
        for part in np.array_split(group, number):
            normals = np.array([bodies[i].normals for i in pairs[part, 0]])
            offsets = np.array([bodies[i].offsets for i in pairs[part, 0]])
            others = np.array([bodies[j].points for j in pairs[part, 1]]).swapaxes(1, 2)
            rows = max(1, _CHUNK // vertices)  # a large body, face after face
            lowest = [(normals[:, k : k + rows] @ others).min(axis=2) for k in range(0, faces, rows)]
            depths[part] = (offsets - np.concatenate(lowest, axis=1)).min(axis=1)
    return depths


def _edge_depth(first: _Body, second: _Body, enough: float) -> float:
    """Return the least depth along the cross products of an edge of each body, m; or one below `enough`."""
    least = np.inf
    rows = max(1, _CHUNK // max(1, len(second.edges) * (len(first.points) + len(second.points))))
    for k in range(0, len(first.edges), rows):
        axes = np.cross(first.edges[k : k + rows, None], second.edges[None]).reshape(-1, 3)
        lengths = np.linalg.norm(axes, axis=1)
        keep = lengths > 1e-6 * lengths.max(initial=0.0)  # parallel edges give no axis
        axes = axes[keep] / lengths[keep, None]
        heights, others = first.points @ axes.T, second.points @ axes.T
        depths = np.minimum(
            heights.max(axis=0) - others.min(axis=0), others.max(axis=0) - heights.min(axis=0)
        )
        least = min(least, float(depths.min(initial=np.inf)))
        if least <= enough:
            break
    return least

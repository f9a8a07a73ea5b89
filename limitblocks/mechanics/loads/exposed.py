"""The part of a face that no block covers up to a level, seen from above."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial, reduce

import numpy as np
import shapely
from shapely.geometry.polygon import orient

from limitblocks.arrays import Array
from limitblocks.geometry import Block
from limitblocks.mechanics.loads.faces import part_where

_CLEAR = 1e-6  # of a block's size: what reaches less far above a face does not cover it
_GRID = 1e-13  # of the coordinates: the places of an overlay
_IN_PLANE = 1e-9  # of a block's size: rounding errors of vertices on the face


def open_to_the_sky(
    corners: Array,
    block: Block,
    face: int,
    level: float,
    blocks: Sequence[Block],
    bounds: tuple[Array, Array],
) -> Iterator[Array]:
    """Yield rings (n, 3) on an upward face, outer ones counter-clockwise from above, holes clockwise.

    Parameters
    ----------
    corners : Array, shape (k, 3)
        Convex part of the face to look at.
    block, face
        The block and the number of its face.
    level : float
        Z, m: what is above it covers nothing.
    blocks : sequence of Block
        What may cover it: the part of each above the plane of the face; of its own block if not convex.
    bounds : tuple of Array
        Least and greatest corners of these blocks.
    """
    if len(corners) < 3:
        return
    normal, offset = block.normals[face], float(block.offsets[face])
    left = shapely.Polygon(corners[:, :2])
    low, high = corners.min(axis=0), corners.max(axis=0)
    over = (bounds[1] > low).all(axis=1) & (bounds[0] < [*high[:2], level]).all(axis=1)
    for other in (blocks[k] for k in np.flatnonzero(over).tolist()):
        if not left.is_empty and not (other is block and block.convex):
            left = left.difference(_shadow(other, other.vertices @ normal - offset, level))
    for part in shapely.get_parts(left):
        if part.geom_type == "Polygon" and not part.is_empty:
            ccw = orient(part)
            for ring in (ccw.exterior, *ccw.interiors):
                plan = shapely.get_coordinates(ring)[:-1]
                yield np.column_stack([plan, (offset - plan @ normal[:2]) / normal[2]])


def _shadow(block: Block, above: Array, level: float) -> shapely.Geometry:
    """Plan of the part of `block` above a plane, by how far its vertices are `above`, and below a level."""
    if above.max() <= _CLEAR * block.size:
        return shapely.Polygon()
    near = _IN_PLANE * block.size
    level -= near  # what begins at the level is not below it
    if block.vertices[:, 2].max() > level or not block.convex:
        sides = block.triangles[above[block.triangles].max(axis=1) > _CLEAR * block.size]
        parts = [_between(block.vertices[side], above[side] + near, level) for side in sides]
        if block.convex:
            return shapely.convex_hull(shapely.multipoints(np.concatenate([low for low, _ in parts])))
        # a vertical line leaves what is below the level through a face that looks up, or passes the level
        tops = [own for own in map(shapely.Polygon, (low for low, _ in parts)) if own.exterior.is_ccw]
        grid = _GRID * float(np.abs(block.vertices[:, :2]).max())
        section = reduce(partial(_either, grid=grid), (shapely.Polygon(high) for _, high in parts))
        return shapely.union_all([*tops, section], grid_size=grid)
    above = above + near
    start, end = block.mesh.start, block.mesh.end
    a, b = above[start], above[end]
    crossing = a * b < 0.0
    share = (a[crossing] / (a[crossing] - b[crossing]))[:, None]
    crossings = block.vertices[start[crossing]] * (1.0 - share) + block.vertices[end[crossing]] * share
    points = np.concatenate([block.vertices[above >= 0.0], crossings])
    return shapely.convex_hull(shapely.multipoints(points[:, :2]))


def _either(one: shapely.Geometry, other: shapely.Geometry, grid: float) -> shapely.Geometry:
    """What is in one of both areas only, points on a grid: rounding crosses edges next to their ends."""
    found = shapely.get_parts(shapely.symmetric_difference(one, other, grid_size=grid))
    return shapely.MultiPolygon([part for part in found if part.geom_type == "Polygon"])


def _between(corners: Array, above: Array, level: float) -> tuple[Array, Array]:
    """Plan of the parts of a triangle above a plane, below and above a level."""
    part, _ = part_where(corners, above)
    height = part[:, 2] - level
    return part_where(part, -height)[0][:, :2], part_where(part, height)[0][:, :2]

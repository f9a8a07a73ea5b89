"""The part of a face that no other block covers, seen from above."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import shapely
from shapely.geometry.polygon import orient

from limitblocks.arrays import Array
from limitblocks.geometry import Block
from limitblocks.mechanics.loads.faces import part_where

_CLEAR = 1e-6  # of a block's size: what reaches less far above a face does not cover it
_IN_PLANE = 1e-9  # of a block's size: rounding errors of vertices on the face


def boxes(blocks: Sequence[Block]) -> tuple[Array, Array]:
    """Return the lowest and the highest coordinates of each block, shapes (n, 3)."""
    points = [block.vertices for block in blocks]
    return np.array([p.min(axis=0) for p in points]), np.array([p.max(axis=0) for p in points])


def open_to_the_sky(
    corners: Array, block: Block, face: int, blocks: Sequence[Block], bounds: tuple[Array, Array]
) -> Iterator[Array]:
    """Yield rings (n, 3) on an upward face, outer ones counter-clockwise from above, holes clockwise.

    Parameters
    ----------
    corners : Array, shape (k, 3)
        Convex part of the face to look at.
    block, face
        The block and the number of its face.
    blocks : sequence of Block
        What may cover it: the part of each above the plane of the face; of its own block if not convex.
    bounds : tuple of Array
        :func:`boxes` of these blocks.
    """
    if len(corners) < 3:
        return
    normal, offset = block.normals[face], float(block.offsets[face])
    left = shapely.Polygon(corners[:, :2])
    low, high = corners.min(axis=0), corners.max(axis=0)
    over = (bounds[1] > low).all(axis=1) & (bounds[0][:, :2] < high[:2]).all(axis=1)
    for other in (blocks[k] for k in np.flatnonzero(over).tolist()):
        if not left.is_empty and not (other is block and block.convex):
            left = left.difference(_shadow(other, other.vertices @ normal - offset))
    for part in shapely.get_parts(left):
        if part.geom_type == "Polygon" and not part.is_empty:
            ccw = orient(part)
            for ring in (ccw.exterior, *ccw.interiors):
                plan = shapely.get_coordinates(ring)[:-1]
                yield np.column_stack([plan, (offset - plan @ normal[:2]) / normal[2]])


def _shadow(block: Block, above: Array) -> shapely.Geometry:
    """Plan of the part of `block` above a plane; `above` are the distances of its vertices from the plane."""
    if above.max() <= _CLEAR * block.size:
        return shapely.Polygon()
    near = _IN_PLANE * block.size
    if not block.convex:  # a vertical line leaves the body through a face that looks up
        sides = block.triangles[above[block.triangles].max(axis=1) > _CLEAR * block.size]
        parts = (part_where(block.vertices[side], above[side] + near)[0][:, :2] for side in sides)
        return shapely.union_all([own for own in map(shapely.Polygon, parts) if own.exterior.is_ccw])
    above = above + near
    start, end = block.mesh.start, block.mesh.end
    a, b = above[start], above[end]
    cut = a * b < 0.0
    share = (a[cut] / (a[cut] - b[cut]))[:, None]
    crossings = block.vertices[start[cut]] * (1.0 - share) + block.vertices[end[cut]] * share
    points = np.concatenate([block.vertices[above >= 0.0], crossings])
    return shapely.convex_hull(shapely.multipoints(points[:, :2]))

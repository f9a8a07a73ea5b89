"""How far points are from blocks."""

from __future__ import annotations

import numpy as np
import shapely

from limitblocks.arrays import Array
from limitblocks.geometry.block import Block
from limitblocks.geometry.polygon import axes_of
from limitblocks.geometry.surface import winding


def distance(block: Block, point: Array) -> float:
    """Distance of a point from a block, m; zero within it."""
    if winding(point, block.vertices[block.triangles]):
        return 0.0
    flat = (beside(block, k, point) for k in range(len(block.faces)))
    return float(np.hypot(block.normals @ point - block.offsets, list(flat)).min())


def beside(block: Block, face: int, point: Array) -> float:
    """Distance of a point from a face, convex or not, along its plane, m; zero above and below it."""
    plane = axes_of(block.normals[face])[:2]
    outline = shapely.Polygon(block.vertices[list(block.faces[face])] @ plane.T)
    return float(shapely.distance(outline, shapely.Point(plane @ point)))

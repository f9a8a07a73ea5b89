"""Where a point of an opened joint lies on the faces of both blocks: the normal of the contact."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely
from scipy.spatial.transform import Rotation
from shapely.geometry import polygon

from limitblocks.arrays import Array
from limitblocks.geometry import Block
from limitblocks.geometry.accuracy import GAP

NEAR = GAP  # of the size of a block: contacts are found across gaps up to it
PARALLEL = 1e-6  # cosine from one of faces that slide on one another all over
AT_RIM = 1e-3  # of the size of a joint: closed corners as near to the rim of a face are at its edge


def half_way(axes_i: Array, axes_j: Array) -> Array:
    """Return the axes half way between two sets of axes (..., 3, 3), rows."""
    turn = Rotation.from_matrix(axes_j.swapaxes(-1, -2) @ axes_i).as_rotvec()
    return np.asarray(axes_i @ Rotation.from_rotvec(turn / 2.0).as_matrix().swapaxes(-1, -2))


def tilted(axes: Array, normal: Array) -> Array:
    """Return axes (3, 3), rows, turned by the least angle that takes the last one to a normal (3,)."""
    return np.asarray(Rotation.align_vectors(normal, axes[2])[0].apply(axes))


def face_at(block: Block, out: Array, point: Array, plane: Array) -> shapely.Geometry:
    """Return the faces of a block at a point with outward normal `out`, seen along two axes (2, 3)."""
    along = block.normals @ out > 1.0 - PARALLEL
    level = np.abs(block.offsets - float(point @ out)) < NEAR * block.size
    faces = (block.vertices[list(block.faces[face])] @ plane.T for face in np.flatnonzero(along & level))
    return shapely.union_all([shapely.Polygon(face) for face in faces])


def rims_at(block: Block, out: Array, points: Array, axes: Array, least: float) -> Array:
    """Return the outward normals in its plane of the rims of a face at points (k, 3), shape (k, s, 2).

    They are zero where a point is farther than `least`, m, from the rim, and NaN off the face.
    """
    face, at = face_at(block, out, points[0], axes[:2]), shapely.points(points @ axes[:2].T)
    parts = np.array([polygon.orient(part) for part in shapely.get_parts(face)], dtype=object)
    rings = (shapely.get_coordinates(ring) for ring in shapely.get_rings(parts))
    sides = np.concatenate([np.zeros((0, 2, 2)), *(np.stack([c[:-1], c[1:]], axis=1) for c in rings)])
    way = sides[:, 1] - sides[:, 0]
    normals = np.stack([way[:, 1], -way[:, 0]], axis=1) / np.linalg.norm(way, axis=1, keepdims=True)
    near = shapely.distance(at[:, None], shapely.linestrings(sides)) <= least
    on = shapely.dwithin(face, at, least)[:, None, None]
    return np.where(on, np.insert(near[..., None] * normals, 0, 0.0, axis=1), np.nan)


def resting_axes(blocks: Sequence[Block], axes_i: Array, axes_j: Array, point: Array, size: float) -> Array:
    """Return the axes of an opened joint, shape (3, 3): normal to the face in whose interior `point` lies.

    An edge or a corner on the interior of a face has the normal of that face. Where two edges meet the normal
    is anywhere between those of both faces; half way is taken. `point`, shape (3,), is the middle of the
    closed corners, `size` that of the joint, m.
    """
    middle = half_way(axes_i, axes_j)
    inside = [
        _within(block, out, point, axes) > AT_RIM * size
        for block, out, axes in zip(blocks, (axes_i[2], -axes_j[2]), (axes_i, axes_j), strict=True)
    ]
    return middle if inside[0] == inside[1] else tilted(middle, (axes_i if inside[0] else axes_j)[2])


def _within(block: Block, out: Array, point: Array, axes: Array) -> float:
    """Distance of a point on a face from its rim, m; zero off the face."""
    face, at = face_at(block, out, point, axes[:2]), shapely.Point(axes[:2] @ point)
    return float(shapely.distance(face.boundary, at)) if shapely.covers(face, at) else 0.0

"""Plane regions: the faces of a block that share edges and lie in one plane count as one."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from limitblocks.arrays import Array, Indices
from limitblocks.geometry.polyhedron import PLANE_TOLERANCE

#: Distances from a common plane, relative to the block's size, that make faces one region; tried in turn.
_FLAT = (1e-6, PLANE_TOLERANCE)
#: Cosine of the angle between faces of one region, at least: a chamfer is no part of the face beside it.
_LEVEL = 0.98


class Surfaces(NamedTuple):
    """Half-edges of all faces of many blocks, face after face: e half-edges, m faces.

    `corner` (e, 3) is where a half-edge starts, `face` and `beyond` (e,) are the faces on both sides of it.
    `area_vector` (m, 3), m2, and `size` (m,), that of the block, m, are of faces.
    """

    corner: Array
    face: Indices
    beyond: Indices
    area_vector: Array
    size: Array


def regions(surfaces: Surfaces) -> Indices:
    """Return the region (m,) of each face: the number of its first face.

    Faces across an edge are tried for one plane where the corners of each lie in the plane of the other. All
    that is linked so is one region where all its corners lie in its mean plane; otherwise, as on a finely
    faceted cylinder, it stays apart. The tolerance is 1e-6 of the block's size, then that of a face.
    """
    region = np.arange(len(surfaces.size))
    near = _level_pairs(surfaces)
    if not len(near):
        return region
    for tolerance in _FLAT:
        flat = tolerance * surfaces.size
        normal, middle = _planes(surfaces, region)
        a, b = region[near].T
        links = near[(a != b) & _in_plane(surfaces, region, a, b, normal, middle, flat)]
        tried = _linked(region, links)
        normal, middle = _planes(surfaces, tried)
        own = tried[surfaces.face]
        high = np.abs(np.einsum("ij,ij->i", surfaces.corner - middle[own], normal[own])) > flat[own]
        uneven = np.zeros(len(region), dtype=bool)
        uneven[own[high]] = True
        region = np.where(uneven[tried], region, tried)
    return region


def _level_pairs(surfaces: Surfaces) -> Indices:
    """Return the pairs (p, 2) of faces on both sides of an edge whose normals are nearly the same."""
    normal = surfaces.area_vector / np.linalg.norm(surfaces.area_vector, axis=1)[:, None]
    once = surfaces.face < surfaces.beyond
    pairs = np.column_stack([surfaces.face[once], surfaces.beyond[once]])
    return pairs[np.einsum("ij,ij->i", *normal[pairs].swapaxes(0, 1)) > _LEVEL]


def _planes(surfaces: Surfaces, region: Indices) -> tuple[Array, Array]:
    """Return unit normals and mean corners (m, 3) of regions, each at the number of its first face."""
    m = len(region)
    own = region[surfaces.face]
    count = np.maximum(np.bincount(own, minlength=m), 1)[:, None]
    middle = np.column_stack([np.bincount(own, x, m) for x in surfaces.corner.T]) / count
    vector = np.column_stack([np.bincount(region, x, m) for x in surfaces.area_vector.T])
    length = np.linalg.norm(vector, axis=1)[:, None]
    return vector / np.maximum(length, np.finfo(float).tiny), middle


def _in_plane(
    surfaces: Surfaces, region: Indices, a: Indices, b: Indices, normal: Array, middle: Array, flat: Array
) -> Any:
    """Tell of pairs of regions whether the corners of each lie in the plane of the other, shape (p,)."""
    own = region[surfaces.face]
    order = np.argsort(own, kind="stable")
    number = np.bincount(own, minlength=len(region))
    start = np.cumsum(number) - number
    sound = np.ones(len(a), dtype=bool)
    for plane, other in ((a, b), (b, a)):
        pair = np.repeat(np.arange(len(other)), number[other])
        place = np.arange(len(pair)) - np.repeat(np.cumsum(number[other]) - number[other], number[other])
        corner = surfaces.corner[order[start[other][pair] + place]]
        arms = corner - middle[plane[pair]]
        high = np.abs(np.einsum("ij,ij->i", arms, normal[plane[pair]])) > flat[plane[pair]]
        sound[pair[high]] = False
    return sound


def _linked(region: Indices, links: Indices) -> Indices:
    """Return the first face (m,) of all that is linked with each face by its region or by `links` (p, 2)."""
    m = len(region)
    ends = np.concatenate([np.column_stack([np.arange(m), region]), links])
    graph = sparse.coo_array((np.ones(len(ends)), ends.T), shape=(m, m))
    _, part = connected_components(graph, directed=False)
    _, first = np.unique(part, return_index=True)
    return np.asarray(first[part])

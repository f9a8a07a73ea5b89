"""Plane regions: the faces of a block that share edges and lie in one plane count as one."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from limitblocks.arrays import Array, Indices, first_tied, repeated, sums

#: Parts of the tolerance within which faces are linked, in turn: those in one plane but for roundoff first.
_STEPS = (1e-3, 1.0)
#: Area of a face relative to its region below which its normal tells nothing.
_NEEDLE = 1e-3


class Surfaces(NamedTuple):
    """Half-edges of all faces of many blocks, face after face: e half-edges, m faces.

    `corner` (e, 3) is where a half-edge starts, `face` and `beyond` (e,) are the faces on both sides of it,
    `area_vector` (m, 3), m2, is of faces.
    """

    corner: Array
    face: Indices
    beyond: Indices
    area_vector: Array


def regions(surfaces: Surfaces, flat: float, angle: float) -> Indices:
    """Return the region (m,) of each face: the number of its first face.

    Faces on both sides of an edge are linked where their corners lie within `flat`, m, of a common plane. All
    that is linked so is one region where all its corners lie so near its mean plane, and its faces within
    `angle`, rad; otherwise, as on a finely faceted cylinder, it stays apart. With half the tolerances of
    contacts, surfaces that match touch whether their faces are linked or not.
    """
    region = np.arange(len(surfaces.area_vector))
    near = _level_pairs(surfaces, 2.0 * angle)
    if not len(near):
        return region
    for step in _STEPS:
        ends = region[near]
        ends = ends[ends[:, 0] != ends[:, 1]]
        tried = _linked(region, ends[_even(surfaces, region, ends, step * flat)])
        uneven = _uneven(surfaces, tried, step * flat, angle)
        region = np.where(uneven[tried], region, tried)
    return region


def _level_pairs(surfaces: Surfaces, angle: float) -> Indices:
    """Return the pairs (p, 2) of faces on both sides of an edge whose normals lie within `angle`, rad."""
    normal = surfaces.area_vector / np.linalg.norm(surfaces.area_vector, axis=1)[:, None]
    once = surfaces.face < surfaces.beyond
    pairs = np.column_stack([surfaces.face[once], surfaces.beyond[once]])
    return np.asarray(pairs[np.einsum("ij,ij->i", *normal[pairs].swapaxes(0, 1)) > np.cos(angle)])


def _even(surfaces: Surfaces, region: Indices, pairs: Indices, flat: float) -> Any:
    """Tell of pairs (p, 2) of regions whether their corners lie in a common plane, shape (p,)."""
    own = region[surfaces.face]
    order = np.argsort(own, kind="stable")
    number = np.bincount(own, minlength=len(region))
    start = np.cumsum(number) - number
    each = pairs.ravel()
    owner, place = repeated(number[each])
    vectors = sums(region, surfaces.area_vector, len(region))
    corners, pair = surfaces.corner[order[start[each][owner] + place]], owner // 2
    return ~_off_plane(corners, pair, vectors[pairs].sum(axis=1), flat)


def _uneven(surfaces: Surfaces, region: Indices, flat: float, angle: float) -> Any:
    """Tell of regions, each at the number of its first face, whether a corner or a face is off, (m,)."""
    m = len(region)
    vectors = sums(region, surfaces.area_vector, m)
    off = _off_plane(surfaces.corner, region[surfaces.face], vectors, flat)
    whole, area = np.linalg.norm(vectors, axis=1)[region], np.linalg.norm(surfaces.area_vector, axis=1)
    along = np.einsum("ij,ij->i", surfaces.area_vector, vectors[region])
    tilted = (along < np.cos(angle) * area * whole) & (area > _NEEDLE * whole)
    return off | (np.bincount(region[tilted], minlength=m) > 0)


def _off_plane(corners: Array, owner: Indices, vectors: Array, flat: float) -> Any:
    """Tell of m groups of corners (k, 3) whether one is off the plane square to the area vector, (m,)."""
    m = len(vectors)
    count = np.maximum(np.bincount(owner, minlength=m), 1)[:, None]
    middle = sums(owner, corners, m) / count
    normal = vectors / np.maximum(np.linalg.norm(vectors, axis=1), np.finfo(float).tiny)[:, None]
    height = np.einsum("ij,ij->i", corners - middle[owner], normal[owner])
    return np.bincount(owner[np.abs(height) > flat], minlength=m) > 0


def _linked(region: Indices, links: Indices) -> Indices:
    """Return the first face (m,) of all that is linked with each face by its region or by `links` (p, 2)."""
    ends = np.concatenate([np.column_stack([np.arange(len(region)), region]), links])
    return first_tied(ends, len(region))


def in_turn(
    own: Indices, first: Indices, sides: Indices, start: Indices, end: Indices
) -> tuple[Any, Indices]:
    """Tell which regions have one loop around them, (m,), and put their half-edges in turn, (e,).

    Half-edges lie region after region, `own` (e,), at `first` and as many as `sides` (m,); `start` and `end`
    (e,) are their vertices, numbered by block. Those of other regions, with holes or touching themselves at
    a vertex, stay where they are.
    """
    leaving, arriving = np.lexsort((start, own)), np.lexsort((end, own))
    again = np.flatnonzero((np.diff(own[leaving]) == 0) & (np.diff(start[leaving]) == 0))
    ring = np.ones(len(sides), dtype=bool)
    ring[own[leaving[again]]] = False
    after = np.empty_like(leaving)
    after[arriving] = leaving  # each vertex of a region is left as often as it is reached
    turn, here, going = np.arange(len(own)), first.copy(), np.flatnonzero(ring)
    for k in range(1, int(sides.max(initial=0)) + 1):
        here[going] = after[here[going]]
        back = here[going] == first[going]
        ring[going[back & (k < sides[going])]] = False
        going = going[~back]
        turn[first[going] + k] = here[going]
    return ring, np.where(ring[own], turn, np.arange(len(own)))

"""Patches by what they are: contacts, near misses, slivers, strips, faces held apart by a third block."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import shapely

from limitblocks.arrays import Array, Indices, repeated
from limitblocks.geometry.accuracy import Tolerances
from limitblocks.geometry.faces import FaceTable
from limitblocks.geometry.patches import Patches, common_part, covering, mean_width


class Kinds(NamedTuple):
    """Patches that are contacts, near misses, slivers, strips, and held apart by a block, `third` (m,)."""

    meant: Patches
    apart: Patches
    small: Patches
    narrow: Patches
    held: Patches
    third: Indices


def sorted_by_kind(faces: FaceTable, seen: Patches, used: Tolerances, length: float, reach: float) -> Kinds:
    """Return patches by what they are, with the tolerances `used`; near misses within a `reach`, m."""
    size = np.abs(seen.gap)
    touching = (size <= used.gap * length) & (seen.angle <= used.angle)
    whole = shapely.area(seen.shape) > seen.least
    wide = whole & ((mean_width(seen.shape) > used.width * length) | covering(faces, seen))
    near = whole & (touching | (size <= reach))
    third = np.full(len(near), -1)
    third[near] = between(faces, seen.of(near), seen.of(touching & whole))
    held = touching & wide & (third >= 0)
    return Kinds(
        meant=seen.of(touching & wide & (third < 0)),
        apart=seen.of(~touching & near & (third < 0)),
        small=seen.of(touching & ~whole),
        narrow=seen.of(touching & whole & ~wide),
        held=seen.of(held),
        third=third[held],
    )


#: Grid on which common parts are made, relative to the root of the least area.
_GRID = 1e-6


def between(faces: FaceTable, tried: Patches, touching: Patches) -> Indices:
    """Return for each patch the block between its two faces, shape (m,); -1 where there is none.

    A block lies between faces a and b where it touches a as well as b, and both contacts cover a common part
    of the patch that is no sliver. It holds the two faces apart, so that they do not touch beside it either.

    Parameters
    ----------
    faces : FaceTable
    tried : Patches
    touching : Patches
        Those within the tolerances.
    """
    third = np.full(len(tried.a), -1)
    for k, first, second in zip(*_sandwiches(faces, tried, touching), strict=True):
        if third[k] < 0:
            covered = [_in_plane_of(tried, k, touching, other) for other in (first, second)]
            grid = _GRID * float(np.sqrt(tried.least[k]))
            if common_part([tried.shape[k], *covered], grid).area > tried.least[k]:
                ends = faces.block[[touching.a[first], touching.b[first]]]
                third[k] = ends[1] if ends[0] in faces.block[[tried.a[k], tried.b[k]]] else ends[0]
    return third


def _sandwiches(faces: FaceTable, tried: Patches, touching: Patches) -> tuple[list[int], ...]:
    """Return patches tried, and with each two touching ones that tie its faces to one third block."""
    n, m = len(touching.a), int(faces.block.max(initial=0)) + 1
    region = np.concatenate([touching.a, touching.b])
    other = faces.block[np.concatenate([touching.b, touching.a])]
    order = np.argsort(region * m + other, kind="stable")
    key, patch = (region * m + other)[order], (order % n if n else order)
    # from the face with fewer contacts: a large support has thousands
    count = np.bincount(region, minlength=len(faces.block))
    swap = count[tried.a] > count[tried.b]
    near, far = np.where(swap, tried.b, tried.a), np.where(swap, tried.a, tried.b)
    start = np.searchsorted(key, near * m)
    k, place = repeated(count[near])
    row = start[k] + place
    third = key[row] % m
    third_region = far[k] * m + third
    hit = np.searchsorted(key, third_region)
    stop = np.searchsorted(key, third_region, side="right")
    inner = (third != faces.block[tried.a[k]]) & (third != faces.block[tried.b[k]])
    k, row, hit, times = k[inner], row[inner], hit[inner], (stop - hit)[inner]
    each, step = repeated(times)
    return k[each].tolist(), patch[row[each]].tolist(), patch[hit[each] + step].tolist()


def _in_plane_of(tried: Patches, k: int, touching: Patches, other: int) -> shapely.Geometry:
    """Return the shape of a touching patch in the plane coordinates of a patch tried."""

    def moved(points: Array) -> Array:
        place = touching.origin[other] + points @ touching.frame[other, :2]
        return np.asarray((place - tried.origin[k]) @ tried.frame[k, :2].T)

    return shapely.transform(touching.shape[other], moved)

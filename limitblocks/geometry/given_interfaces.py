"""What the numbers of interfaces must be; those given by hand or in a file need not be sound."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from itertools import combinations

import numpy as np
import shapely

from limitblocks.arrays import Array
from limitblocks.geometry.interface import Interface
from limitblocks.geometry.patches import common_areas
from limitblocks.geometry.polygon import centroids, cross, following

AXES_TOLERANCE = 1e-9
CENTROID_TOLERANCE = 1e-6  # of the size of a polygon: distance from its origin to its centroid
SHARED = 1e-2  # of the smaller of two areas: what may be common to them


def interface_faults(interfaces: Sequence[Interface]) -> list[str]:
    """Say what is wrong with the numbers of interfaces, and which areas are given twice; empty when sound."""
    faults, alike = {}, defaultdict(list)
    for k, one in enumerate(interfaces):
        shape = np.shape(one.polygon)
        if not _hashable(one.joint):
            kind = type(one.joint).__name__
            faults[k] = f"joint {kind} cannot be hashed; expected a frozen dataclass, or Materials.between"
        elif np.shape(one.centroid) == (3,) and np.shape(one.axes) == (3, 3) and shape[1:] == (2,):
            alike[shape[0]].append(k)
        else:
            faults[k] = "centroid, axes and polygon have shapes (3,), (3, 3) and (n, 2)"
    for places in alike.values():
        some = [interfaces[k] for k in places]
        numbers = (np.array([getattr(one, key) for one in some], dtype=float) for key in ("axes", "polygon"))
        faults |= {k: fault for k, fault in zip(places, _faults(*numbers), strict=True) if fault}
    said = [f"interface {interfaces[k].name}: {faults[k]}" for k in sorted(faults)]
    return said or _given_twice(interfaces)


def _hashable(joint: object) -> bool:
    try:  # a frozen dataclass has a hash, unless it holds a dictionary
        hash(joint)
    except TypeError:
        return False
    return True


def _faults(axes: Array, polygon: Array) -> list[str]:
    """What is wrong with each of m interfaces with axes (m, 3, 3) and polygons (m, n, 2); the first fault."""
    with np.errstate(all="ignore"):
        skew = np.abs(axes @ axes.swapaxes(1, 2) - np.eye(3)).max(axis=(1, 2))
        side, swept = following(polygon) - polygon, cross(polygon, following(polygon))
        size2 = np.abs(polygon).max(axis=(1, 2)) ** 2
        turned = np.arctan2(swept, (polygon * following(polygon)).sum(axis=2)).sum(axis=1)
        off = np.abs(centroids(polygon)).max(axis=1)
        sound = (
            (skew <= AXES_TOLERANCE, "axes are off orthonormal by {:.1e}; at most 1e-09 is allowed", skew),
            (np.linalg.det(axes) > 0.0, "axes are left-handed; n = s1 x s2 is needed", skew),
            (
                swept.sum(axis=1) > 1e-12 * size2,
                "polygon is not counter-clockwise: its area is {:.3g} m2",
                swept.sum(axis=1) / 2,
            ),
            (cross(side, following(side)).min(axis=1) >= -1e-9 * size2, "polygon is not convex", skew),
            (
                swept.min(axis=1) > 1e-12 * size2,
                "the centroid is not strictly inside the polygon",
                skew,
            ),
            # a polygon that winds round the origin twice has only left turns, too
            (turned <= 3.0 * np.pi, "polygon crosses itself", skew),
            (
                off <= CENTROID_TOLERANCE * np.sqrt(size2),
                "the centroid of the polygon is {:.3g} m from its origin; give vertices about the centroid",
                off,
            ),
        )
    faults = [""] * len(axes)
    for good, said, value in sound[::-1]:
        for k in np.flatnonzero(~good).tolist():
            faults[k] = said.format(value[k])
    return faults


def _given_twice(interfaces: Sequence[Interface]) -> list[str]:
    """Areas of one joint between the same blocks that overlap: strength counts twice there."""
    between = defaultdict(list)
    for one in interfaces:
        if not getattr(one.joint, "word", ""):  # ties and dowels lie on the joint that they cross
            between[frozenset((one.block_i, one.block_j)), one.joint].append(one)
    pairs = (pair for some in between.values() if len(some) > 1 for pair in combinations(some, 2))
    return [
        f"interfaces {a.name} and {b.name} overlap: one contact area is given twice"
        for a, b in pairs
        if _overlap(a, b)
    ]


def _overlap(a: Interface, b: Interface) -> bool:
    reach = max(np.abs(a.polygon).max(), np.abs(b.polygon).max())
    x, y, z = a.axes @ (b.centroid - a.centroid)
    if abs(z) > 1e-6 * reach or abs(x) + abs(y) > 4.0 * reach or abs(a.axes[2] @ b.axes[2]) < 1.0 - 1e-9:
        return False
    there = b.polygon @ b.axes[:2] @ a.axes[:2].T + (x, y)
    both = np.array([shapely.Polygon(a.polygon), shapely.Polygon(there)])
    least = SHARED * shapely.area(both).min(keepdims=True)
    return bool((shapely.area(common_areas(both[:1], both[1:], least, 1e-9 * reach)) > least).any())

"""Torsion under bending of polygons that Orduña & Lourenço (2005), Part I ("the paper"), leave open."""

from __future__ import annotations

import numpy as np
from scipy.spatial import ConvexHull

from limitblocks.arrays import Array
from limitblocks.geometry.polygon import following
from limitblocks.joints.torsion import torsion_constants

VERTICAL = 1e-6  # upward component of the normal of a facet that stands on a side


def key_state_rows(polygons: Array) -> Array:
    """Return rows (m, 2 k, 6) of torsion under bending of convex polygons (m, n, 2), per mu in N, M1 and M2.

    In the place of Eq. (30): each plane |T| <= mu |N| (a + b1 e1 + b2 e2) over a, where e1 |N| = M2 and
    e2 |N| = -M1.
    """
    a, b1, b2 = np.moveaxis(key_state_planes(polygons), 2, 0)
    zero, one = np.zeros_like(a), np.ones_like(a)
    return np.concatenate([np.stack([zero, zero, one, b2 / a, -b1 / a, s / a], axis=2) for s in (1, -1)], 1)


def key_state_planes(polygons: Array) -> Array:
    """Return planes (m, k, 3) on convex polygons (m, n, 2): |T| <= mu |N| plane . (1, e1, e2); m, 1, 1.

    The states of Table 4 for any number of sides, in a unit of mu |N|: pressure in a corner, no torsion;
    along a side, Eq. (22), a fourth of its length; on the whole area, Eq. (16), c_T. The planes are the upper
    facets of their convex hull, whatever the axes. A polygon with fewer than the others has |T| <= mu |N| c_T
    in place of what it lacks.
    """
    m, n, _ = polygons.shape
    sides = following(polygons) - polygons
    constants = torsion_constants(polygons)
    states = np.zeros((m, 2 * n + 1, 3))
    states[:, :n, :2], states[:, n:-1, :2] = polygons, polygons + sides / 2.0
    states[:, n:-1, 2], states[:, -1, 2] = np.hypot(sides[..., 0], sides[..., 1]) / 4.0, constants
    size = np.abs(polygons).max(axis=(1, 2))
    found = [_upper_facets(one) for one in states / size[:, None, None]]
    planes = np.zeros((m, max(map(len, found), default=0), 3))
    planes[..., 0] = (constants / size)[:, None]
    for table, facets in zip(planes, found, strict=True):
        table[: len(facets)] = facets
    planes[..., 0] *= size[:, None]
    return planes


def _upper_facets(points: Array) -> Array:
    """Heights at the origin and slopes (k, 3) of the upper facets of the convex hull of points (p, 3)."""
    facets = np.unique(ConvexHull(points).equations, axis=0)  # Qhull repeats one with more than three corners
    facets = facets[facets[:, 2] > VERTICAL]
    return np.asarray(-facets[:, [3, 0, 1]] / facets[:, 2:3])

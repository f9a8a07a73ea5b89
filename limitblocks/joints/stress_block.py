"""The exact stress block of a joint that crushes, beside which Eq. (39) is an approximation.

At N = -n A fcef the block covers a part n of the area, all to one side of a line, at fcef. The centres of
these parts bound where N may act; Eq. (39) has 1 - n times the polygon. Along any direction that is up to
1 + sqrt(n) times as far: the root of the area cut off is a concave function of the depth (Brunn and
Minkowski), and a triangle, where it is linear, reaches that at its corners.
"""

from __future__ import annotations

import numpy as np

from limitblocks.arrays import Array
from limitblocks.geometry.polygon import areas, cross, following

CHORDS = 64  # cuts that start from each side
LEAST = 1e-9  # share of the area: less does not crush

CRUSHING = (
    "Crushing reduces the moment that a joint carries, Eq. (39), not its shear or torsion. The equation is "
    "the exact stress block for bending about one axis of a rectangle; elsewhere it overestimates the moment "
    "by at most sqrt(-N / (A fcef)): along the diagonal of a rectangle by 28 % at a tenth of the crushing "
    "force and up to half, towards a corner of a triangle by 32 % and up to all of it. Bounds, solutions and "
    "checks say where it does."
)


def stress_block_centres(polygon: Array, share: float) -> Array:
    """Return the centres (k, 2), m, in order, of the parts of area `share` that chords cut off a polygon.

    `polygon` (n, 2), m, is convex and counter-clockwise. Each part is a fan of triangles from the start of
    its chord on, the last of them cut so that the area is met.
    """
    n = len(polygon)
    along = (1.0 - np.cos(np.pi * np.arange(CHORDS) / CHORDS)) / 2.0  # closer at the corners
    starts = polygon[:, None] + along[:, None] * (following(polygon) - polygon)[:, None]
    around = polygon[(np.arange(n)[:, None] + np.arange(1, n + 1)) % n]  # (n, n, 2), from each side on
    arms = around[:, None] - starts[:, :, None]  # (n, CHORDS, n, 2)
    first, last = arms[:, :, :-1], arms[:, :, 1:]
    swept = cross(first, last) / 2.0
    before = np.cumsum(swept, axis=2) - swept
    kept = np.clip((share * areas(polygon) - before) / np.maximum(swept, 1e-300), 0.0, 1.0)[..., None]
    middles = (2.0 * first + kept * (last - first)) / 3.0
    moments = (kept * swept[..., None] * middles).sum(axis=2)
    return np.asarray((starts + moments / (kept[..., 0] * swept).sum(axis=2)[..., None]).reshape(-1, 2))


def over_stress_block(polygon: Array, strength: float, Q: Array, tension: float = 0.0) -> float:
    """Return how many times as large the moments of Q are as those of the exact stress block along them.

    Parameters
    ----------
    polygon : Array, shape (n, 2)
        Convex, about its centroid, m.
    strength, tension : float
        Compressive and tensile strength, Pa.
    Q : Array, shape (6,)
        Stress resultants (V1, V2, N, M1, M2, T), N and N m; N held.

    Returns
    -------
    float
        At most 1 where the joint does not crush; at most 5e-4 too large. 0 without bending, infinite at or
        beyond N = -A strength with it.
    """
    area = float(areas(polygon))
    force = tension * area - Q[2]
    share = force / ((strength + tension) * area)
    if share < LEAST or not Q[3:5].any():
        return 0.0
    if share > 1.0 - LEAST:
        return np.inf
    e = np.array([-Q[4], Q[3]]) / -force  # where N acts
    centres = stress_block_centres(polygon, share)
    side = following(centres) - centres
    return float((cross(e, side) / cross(centres, side)).max())

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

CHORDS = 8, 64  # cuts that start from each side; the fewer, the larger a moment seems
LEAST = 1e-9  # share of the area: less does not crush
CENTRAL = 1e-6  # of the way to the edge, the tolerance of bounds: N off the centroid by less does not bend

CRUSHING = (
    "Crushing reduces the moment that a joint carries, Eq. (39), not its shear or torsion. The equation is "
    "the exact stress block for bending about one axis of a rectangle; elsewhere it overestimates the moment "
    "by at most sqrt(-N / (A fcef)): along the diagonal of a rectangle by 28 % at a tenth of the crushing "
    "force and up to half, towards a corner of a triangle by 32 % and up to all of it. Bounds, solutions and "
    "checks say where it does."
)


def stress_block_centres(polygons: Array, shares: Array, chords: int) -> Array:
    """Return the centres (m, k, 2), m, in order, of the parts of area `shares` (m,) that chords cut off.

    `polygons` (m, n, 2), m, are convex and counter-clockwise. Each part is a fan of triangles from the start
    of its chord on, the last of them cut so that the area is met.
    """
    m, n = polygons.shape[:2]
    along = (1.0 - np.cos(np.pi * np.arange(chords) / chords)) / 2.0  # closer at the corners
    sides = following(polygons) - polygons
    starts = polygons[:, :, None] + along[:, None] * sides[:, :, None]
    around = polygons[:, (np.arange(n)[:, None] + np.arange(1, n + 1)) % n]  # (m, n, n, 2), from each side on
    arms = around[:, :, None] - starts[:, :, :, None]  # (m, n, chords, n, 2)
    first, last = arms[..., :-1, :], arms[..., 1:, :]
    swept = cross(first, last) / 2.0
    before = np.cumsum(swept, axis=-1) - swept
    cut = (shares * areas(polygons))[:, None, None, None]
    kept = np.clip((cut - before) / np.maximum(swept, 1e-300), 0.0, 1.0)[..., None]
    middles = (2.0 * first + kept * (last - first)) / 3.0
    moments = (kept * swept[..., None] * middles).sum(axis=-2)
    return np.asarray(
        (starts + moments / (kept[..., 0] * swept).sum(axis=-1)[..., None]).reshape(m, n * chords, 2)
    )


def over_stress_block(
    polygons: Array, strengths: Array, Q: Array, tensions: Array, least: float = 0.0
) -> Array:
    """Return how many times as large the moments of Q are as those of the exact stress block along them.

    Parameters
    ----------
    polygons : Array, shape (m, n, 2)
        Convex, about their centroids, m.
    strengths, tensions : Array, shape (m,)
        Compressive and tensile strengths, Pa.
    Q : Array, shape (m, 6)
        Stress resultants (V1, V2, N, M1, M2, T), N and N m; N held.
    least : float
        What is certainly less is not worked out further.

    Returns
    -------
    Array, shape (m,)
        At most 1 where the joint does not crush; at most 5e-4 too large. 0 without bending beyond rounding,
        infinite at or beyond N = -A strength with it.
    """
    area = areas(polygons)
    forces = tensions * area - Q[:, 2]
    shares = forces / ((strengths + tensions) * area)
    over = np.zeros(len(Q))
    some = np.flatnonzero(shares >= LEAST)
    e = np.stack([Q[some, 4], -Q[some, 3]], axis=1) / forces[some, None]  # where N acts
    bent = _times_as_far(e, polygons[some]) > CENTRAL
    e, some = e[bent], some[bent]
    over[some] = np.inf
    e, some = e[shares[some] <= 1.0 - LEAST], some[shares[some] <= 1.0 - LEAST]
    for chords in CHORDS:
        over[some] = _times_as_far(e, stress_block_centres(polygons[some], shares[some], chords))
        e, some = e[over[some] >= least], some[over[some] >= least]
    return over


def _times_as_far(e: Array, polygons: Array) -> Array:
    """Return how many times as far from the origin points (m, 2) are as the sides (m, n, 2) behind them."""
    sides = following(polygons) - polygons
    return np.asarray((cross(e[:, None], sides) / cross(polygons, sides)).max(axis=1))

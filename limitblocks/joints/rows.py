"""Groups of conic rows that joints are put together from: frictional rows, hinging, and their assembly.

Source: Orduña & Lourenço (2005), Part I, Section 4 ("the paper").
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from limitblocks.arrays import Array
from limitblocks.geometry.polygon import areas
from limitblocks.joints.base import YieldRows
from limitblocks.problem import Mode


@dataclass(frozen=True, eq=False)
class Rows:
    """Rows F Q + g of one failure mode for m interfaces, with their plastic potential G and pivot.

    F and G have shape (m, r, 6), g and pivot (m, r). With `size` 0 the rows are linear; otherwise they are
    second-order cones of that size, one after the other.
    """

    mode: Mode
    F: Array
    G: Array
    g: Array
    pivot: Array
    size: int = 0


def frictional(mode: str, F: Array, g: Array, size: int = 0) -> Rows:
    """Rows whose flow is F without its components dn, dth1, dth2 (zero dilatancy, Tables 3 and 5).

    Table 3 as we have it is shifted in its rows V-T; they are the gradients of Eqs (27)-(29). Rows with
    bending moments turn about the point of action (e1, e2), Table 5.
    """
    G = F.copy()
    G[..., 2:5] = 0.0
    bent = F[..., 3:5].any(axis=-1)
    return Rows(Mode(mode), F, G, np.broadcast_to(g, F.shape[:2]), np.where(bent, -F[..., 5], 0.0), size)


def hinging(
    polygons: Array,
    compressive_strength: float | None = None,
    tensile_strength: float = 0.0,
    stress_unit: float = 1.0,
) -> Rows:
    """Hinging about each side of convex polygons (m, n, 2), Eqs (36)-(40); associated flow, Table 6.

    Without a limit of compression: n linear rows. With it: n second-order cones of size 3. With
    s = -(c1 M1 + c2 M2 + N) and a = A fcef in units of force, Eq. (39) is N^2 <= a s, or

        ||(1 - s, 2 N / sqrt(a))|| <= 1 + s,

    whose 1 is a unit of force. A tensile strength ft puts N - A ft for N and fcef + ft for fcef, which is
    the stress block between both strengths.
    """
    h = hinge_gradients(polygons)
    m, n, _ = h.shape
    area = areas(polygons)[:, None] / stress_unit
    pull = np.broadcast_to(tensile_strength * area, (m, n))
    if compressive_strength is None:
        return Rows(Mode.HINGE, -h, -h, pull, np.zeros((m, n)))
    root = 2.0 / np.sqrt((compressive_strength + tensile_strength) * area)
    across = np.zeros_like(h)
    across[..., 2] = root
    F = np.stack([-h, h, across], axis=2).reshape(m, 3 * n, 6)
    g = np.stack([1.0 + pull, 1.0 - pull, -root * pull], axis=2).reshape(m, 3 * n)
    return Rows(Mode.CRUSH, F, F, g, np.zeros((m, 3 * n)), size=3)


def hinge_gradients(polygons: Array) -> Array:
    """Gradients (m, n, 6) of the hinging functions, Eqs (36)-(38), one a side of each polygon."""
    start, end = polygons, np.roll(polygons, -1, axis=1)
    edge = end - start
    cross = start[..., 0] * end[..., 1] - end[..., 0] * start[..., 1]
    zero, one = np.zeros_like(cross), np.ones_like(cross)
    return np.stack([zero, zero, one, edge[..., 0] / cross, edge[..., 1] / cross, zero], axis=2)


def shear_directions(slip: str, sides: int) -> Array:
    """Vectors d (sides, 2) of a polygon that stands for the Coulomb circle: max d.V in place of ||V||.

    "outer" (and "paper") is drawn around the circle: too strong by up to 1/cos(pi/sides) - 1, exact in the
    directions d, the first of which is V1. "inner" is drawn within it: too weak by up to 1 - cos(pi/sides),
    exact at its corners, the first of which is in the direction V1.
    """
    half = 0.5 if slip == "inner" else 0.0
    angles = 2.0 * np.pi * (np.arange(sides) + half) / sides
    length = 1.0 / np.cos(np.pi / sides) if slip == "inner" else 1.0
    d = length * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    d[np.abs(d) < 1e-14] = 0.0
    return d


def stacked(groups: Sequence[Rows], half_sides: Array, friction: float, shear: bool = True) -> YieldRows:
    """Put groups of rows together, linear ones first; without `shear` the stresses are N, M1, M2 only."""
    groups = sorted(groups, key=lambda group: group.size > 0)
    stresses = slice(None) if shear else slice(2, 5)
    m = len(half_sides)

    def joined(name: str) -> Array:
        return np.concatenate([getattr(group, name) for group in groups], axis=1)

    counts = [group.g.shape[1] for group in groups]
    return YieldRows(
        F=joined("F")[:, :, stresses],
        g=joined("g"),
        G=joined("G")[:, :, stresses],
        pivot=joined("pivot"),
        half_sides=half_sides,
        resultants=np.broadcast_to(np.eye(6), (m, 6, 6))[:, :, stresses],
        linear=sum(count for count, group in zip(counts, groups, strict=True) if group.size == 0),
        cones=tuple(
            group.size
            for count, group in zip(counts, groups, strict=True)
            if group.size
            for _ in range(count // group.size)
        ),
        modes=tuple(group.mode for count, group in zip(counts, groups, strict=True) for _ in range(count)),
        friction=friction,
    )

"""The paper's piecewise-linear yield surface (Orduña & Lourenço 2005, Section 4)."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np

from limitblocks.arrays import Array
from limitblocks.geometry.polygon import areas, second_moments
from limitblocks.joints.base import YieldRows, checked_friction
from limitblocks.joints.torsion import rectangle_torsion_constant, torsion_constants

SIGNS = (1.0, -1.0)
HALF = np.sqrt(0.5)

# Signs of (V1, V2, N, M1, M2, T) in each row; N, M and T are scaled per mode in `_frictional_rows`.
TWIST = [(0, 0, 1, 0, 0, t) for t in SIGNS]  # Eq. (23)
SLIP = (
    [(s, 0, 1, 0, 0, 0) for s in SIGNS]  # Eq. (24)
    + [(0, s, 1, 0, 0, 0) for s in SIGNS]  # Eq. (25)
    + [(a * HALF, b * HALF, 1, 0, 0, 0) for a, b in product(SIGNS, SIGNS)]  # Eq. (26)
)
SHEAR_TORSION = [(v1, v2, 1, 0, 0, t) for (v1, v2, *_), t in product(SLIP, SIGNS)]  # Eqs (27)-(29)
MOMENT_TORSION = [(0, 0, 1, a, b, t) for a, b, t in product(SIGNS, SIGNS, SIGNS)]  # Eq. (30)

MODES = (
    ("twist",) * len(TWIST)
    + ("slip",) * len(SLIP)
    + ("slip-twist",) * len(SHEAR_TORSION)
    + ("moment-twist",) * len(MOMENT_TORSION)
)


@dataclass(frozen=True)
class OrdunaLourenco:
    """Yield surface of Orduña & Lourenço (2005): Eqs (23)-(30) and (36) on a convex polygon.

    Planes for twist (2), slip (8), shear with torsion (16), bending with torsion (8) and hinging (one
    a side): 38 on a quadrilateral. An engineering approximation:

    - the slip octagon, Eqs (24)-(26), is drawn around the Coulomb circle: it overestimates the shear
      strength by up to 1/cos(22.5 deg) - 1 = 8.2 % between its eight contact directions;
    - Eqs (27)-(29) neglect the aspect ratio of the interface;
    - Eq. (30) overestimates torsion under bending except when a hinge forms.

    Parameters
    ----------
    friction : float
        Friction coefficient mu >= 0. With zero friction the interface carries N, M1, M2 only.

    Raises
    ------
    ModelError
        If the friction is not a finite number >= 0.
    """

    friction: float

    def __post_init__(self) -> None:
        checked_friction(self.friction)

    def yield_rows(self, polygons: Array, stress_unit: float = 1.0) -> YieldRows:
        """Return the rows for polygons of shape (m, n, 2); see :class:`~limitblocks.joints.base.Joint`."""
        m, n, _ = polygons.shape
        half_sides = equivalent_half_sides(polygons)
        hinge = hinge_gradients(polygons)
        resultants = np.broadcast_to(np.eye(6), (m, 6, 6))
        if self.friction == 0.0:
            resultants, gradient = resultants[:, :, 2:5], hinge[:, :, 2:5]
            flow, pivot, modes = gradient, np.zeros((m, n)), ("hinge",) * n
        else:
            frictional, frictional_flow, frictional_pivot = _frictional_rows(polygons, half_sides, self.friction)
            gradient = np.concatenate([frictional, hinge], axis=1)
            flow = np.concatenate([frictional_flow, hinge], axis=1)
            pivot = np.concatenate([frictional_pivot, np.zeros((m, n))], axis=1)
            modes = MODES + ("hinge",) * n
        return YieldRows(
            F=-gradient,
            g=np.zeros(gradient.shape[:2]),
            G=-flow,
            pivot=pivot,
            reach=half_sides,
            resultants=resultants,
            linear=gradient.shape[1],
            cones=(),
            modes=modes,
            friction=self.friction,
        )


def _frictional_rows(polygons: Array, half_sides: Array, friction: float) -> tuple[Array, Array, Array]:
    """Gradients (m, 34, 6) of Eqs (23)-(30), flow directions of Tables 3 and 5, and their pivots."""
    m = len(polygons)
    per_torsion = 1.0 / _paper_torsion_constants(polygons, half_sides)[:, None]
    per_moment = 1.0 / half_sides.sum(axis=1)[:, None]
    scales = {
        "twist": (friction, 0.0, per_torsion),
        "slip": (friction, 0.0, 0.0),
        "slip-twist": (1.3 * friction, 0.0, per_torsion),
        "moment-twist": (friction / 2, per_moment * friction / 2, per_moment),
    }
    table = np.array(TWIST + SLIP + SHEAR_TORSION + MOMENT_TORSION, dtype=float)
    gradient = np.broadcast_to(table, (m, *table.shape)).copy()
    modes = np.array(MODES)
    for mode, (normal, moment, torsion) in scales.items():
        rows = modes == mode
        gradient[:, rows, 2] *= normal
        gradient[:, rows, 5] *= torsion
        for column in (3, 4):
            gradient[:, rows, column] *= moment
    flow = gradient.copy()
    flow[:, :, 2:5] = 0.0  # zero dilatancy, and Table 5 has no bending rotation
    pivot = np.where(modes == "moment-twist", gradient[:, :, 5], 0.0)
    return gradient, flow, pivot


def hinge_gradients(polygons: Array) -> Array:
    """Gradients (m, n, 6) of the hinging functions, Eqs (36)-(38), one a side of each polygon."""
    start, end = polygons, np.roll(polygons, -1, axis=1)
    edge = end - start
    cross = start[..., 0] * end[..., 1] - end[..., 0] * start[..., 1]
    zero, one = np.zeros_like(cross), np.ones_like(cross)
    return np.stack([zero, zero, one, edge[..., 0] / cross, edge[..., 1] / cross, zero], axis=2)


def equivalent_half_sides(polygons: Array) -> Array:
    """Half sides (m, 2) of the equivalent rectangle.

    Quadrilaterals: Eqs (31)-(32), vertices in the order (+,-), (+,+), (-,+), (-,-). Other polygons, which
    the paper leaves open: the rectangle with the same radii of gyration about x1 and x2, which agrees
    with Eqs (31)-(32) on rectangles.
    """
    x1, x2 = polygons[..., 0], polygons[..., 1]
    if polygons.shape[1] == 4:
        l1 = (x1[:, 0] + x1[:, 1] - x1[:, 2] - x1[:, 3]) / 4
        l2 = (x2[:, 1] + x2[:, 2] - x2[:, 0] - x2[:, 3]) / 4
        return np.stack([l1, l2], axis=1)
    second = second_moments(polygons)  # columns: integrals of x1^2, x2^2, x1 x2
    return np.sqrt(3.0 * second[:, :2] / areas(polygons)[:, None])


def _paper_torsion_constants(polygons: Array, half_sides: Array) -> Array:
    """Eq. (17) on the equivalent rectangle of a quadrilateral; Eqs (11)-(16) on other polygons."""
    if polygons.shape[1] == 4:
        return rectangle_torsion_constant(half_sides[:, 0], half_sides[:, 1])
    return torsion_constants(polygons)

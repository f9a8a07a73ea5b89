"""Point contacts at the corners of an interface (Livesley 1978), with exact Coulomb cones."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from limitblocks.arrays import Array
from limitblocks.joints.base import YieldRows, checked_friction


@dataclass(frozen=True)
class PointContact:
    """Forces at the polygon's corners, each within its Coulomb cone ||(V1, V2)|| <= -mu N.

    Livesley's model, used by most rigid-block codes. Shear and hinging are exact. Torsion is
    overestimated, because the pressure is free to gather at the corners: mu |N| d/2 on a rectangle of
    diagonal d, 1.85 to 1.94 times the strength under uniform pressure for aspect ratios 1 to 4.

    Parameters
    ----------
    friction : float
        Friction coefficient mu >= 0. With zero friction the points carry N only.

    Raises
    ------
    ModelError
        If the friction is not a finite number >= 0.
    """

    friction: float

    def __post_init__(self) -> None:
        checked_friction(self.friction)

    def yield_rows(self, polygons: Array, stress_unit: float = 1.0) -> YieldRows:
        """Return the rows for polygons of shape (m, n, 2); see :class:`~limitblocks.joints.base.Joint`.

        The generalised stresses are (V1, V2, N) of point 1, of point 2, and so on.
        """
        m, n, _ = polygons.shape
        points = point_resultants(polygons)
        opening = np.kron(np.eye(n), [[0.0, 0.0, -1.0]])
        cone = np.kron(np.eye(n), [[0.0, 0.0, -self.friction], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
        modes: tuple[str, ...] = ("open",) * n + ("slip",) * (3 * n)
        rows, flow = np.vstack([opening, cone]), np.vstack([opening, cone])
        flow[n:, 2::3] = 0.0  # zero dilatancy: sliding does not open the point
        if self.friction == 0.0:
            points = points[:, :, 2::3]
            rows = flow = -np.eye(n)
            modes = ("open",) * n
        return YieldRows(
            F=np.broadcast_to(rows, (m, *rows.shape)),
            g=np.zeros((m, len(rows))),
            G=np.broadcast_to(flow, (m, *flow.shape)),
            pivot=np.zeros((m, len(rows))),
            reach=np.abs(polygons).max(axis=1),
            resultants=points,
            linear=n,
            cones=(3,) * ((len(rows) - n) // 3),
            modes=modes,
            friction=self.friction,
        )


def point_resultants(polygons: Array) -> Array:
    """Matrices (m, 6, 3 n) that turn point forces into Q: r x f about the centroid, r = (x1, x2, 0)."""
    m, n, _ = polygons.shape
    x1, x2 = polygons[..., 0], polygons[..., 1]
    matrix = np.zeros((m, 6, n, 3))
    matrix[:, 0, :, 0] = matrix[:, 1, :, 1] = matrix[:, 2, :, 2] = 1.0
    matrix[:, 3, :, 2] = x2
    matrix[:, 4, :, 2] = -x1
    matrix[:, 5, :, 0] = -x2
    matrix[:, 5, :, 1] = x1
    return matrix.reshape(m, 6, 3 * n)

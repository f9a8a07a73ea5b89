"""What elastic contact points carry: Coulomb friction without dilatancy, its corners rounded.

The normal force comes first, as sliding does not change it; then the shear force, brought within the circle
of radius c = -mu N. With the elastic forces n and v, and eps for the rounding,

    N = (n - sqrt(n^2 + 4 eps^2)) / 2,  |V| = (sqrt((v + c)^2 + 4 eps^2) - sqrt((v - c)^2 + 4 eps^2)) / 2

(min(n, 0) and min(v, c), smoothed: Chen & Harker 1993, SIAM J. Matrix Anal. Appl. 14). As N < 0 and |V| < c
such forces are within yield.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from limitblocks.arrays import Array
from limitblocks.problem import Flow

TINY = float(np.finfo(float).tiny)


@dataclass(frozen=True, eq=False)
class ContactPoints:
    """Contact points of a limit problem, k of them; forces are (V1, V2, N), dimensionless.

    Attributes
    ----------
    friction : Array, shape (k,)
        Friction coefficient mu.
    stiffness : Array, shape (k, 3)
        Force per strain, the same along V1 and V2.
    x0 : Array, shape (k, 3)
        Forces without strains.
    rounding : float
        eps, of the unit of force of an interface.
    """

    friction: Array
    stiffness: Array
    x0: Array
    rounding: float

    def forces(self, strains: Array) -> tuple[Array, Array]:
        """Return the forces at strains (k, 3), and their derivatives (k, 3, 3)."""
        soft = 2.0 * self.rounding
        V1, V2, n = elastic = np.ascontiguousarray((self.x0 + strains * self.stiffness).T)
        root = np.hypot(n, soft)
        N = np.minimum(n, 0.0) - soft**2 / (np.abs(n) + root) / 2.0  # the same, without cancellation
        dN = -N / root
        v, c = np.hypot(V1, V2), -self.friction * N
        out, off = np.hypot(v + c, soft), np.hypot(v - c, soft)
        by_v = ((v + c) / out - (v - c) / off) / 2.0
        by_c = ((v + c) / out + (v - c) / off) / 2.0
        share = 2.0 * c / (out + off)  # |V| / v
        d = elastic[:2] / np.maximum(v, TINY)
        slope = np.zeros((len(v), 3, 3))
        slope[:, :2, :2] = ((by_v - share) * d * d[:, None]).T
        slope[:, 0, 0] += share
        slope[:, 1, 1] += share
        slope[:, :2, 2] = (-(self.friction * by_c * dN) * d).T
        slope[:, 2, 2] = dN
        return np.column_stack([share * V1, share * V2, N]), slope * self.stiffness[:, None, :]


def contact_points(flow: Flow, x0: Array, rounding: float) -> ContactPoints | None:
    """Return the contact points of a problem that has nothing else and slides without dilatancy, else None.

    Parameters
    ----------
    flow : Flow
        The limit problem and its flow rule.
    x0 : Array, shape (s,)
        Stresses without strains, dimensionless.
    rounding : float
        eps, of the unit of force of an interface.
    """
    p, k = flow.problem, flow.problem.cones.linear
    F, G = p.F.copy(), flow.matrix(x0).copy()
    F.eliminate_zeros()
    G.eliminate_zeros()
    alone = (np.diff(F.indptr) == 1).all()
    if not alone or p.g.any() or p.cones.second_order != ((k, 3),) or len(x0) != 3 * k:
        return None
    slip, opening = p.cones.groups[0], F.indices[:k]
    points = F.indices[slip]  # the stress in each row: N, V1, V2
    same = (points == points[:, 1:2] + [2, 0, 1]).all() and not (points[:, 1] % 3).any()
    apart = np.array_equal(np.sort(opening), np.arange(2, 3 * k, 3)) and len(np.unique(points[:, 0])) == k
    sliding = np.zeros(len(p.g), dtype=int)
    sliding[slip[:, 0]] = 1  # without dilatancy: shear alone
    if not (same and apart and np.array_equal(np.diff(G.indptr), 1 - sliding)):
        return None
    friction = np.empty(k)
    friction[points[:, 0] // 3] = -F.data[slip[:, 0]] / np.abs(F.data[slip[:, 1]])
    return ContactPoints(friction, 1.0 / p.compliance.reshape(k, 3), x0.reshape(k, 3), rounding)

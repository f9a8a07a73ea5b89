"""Derivative of a path's equations at a point: one factorisation, any number of right-hand sides."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.sparse import linalg

from limitblocks.analysis.nonassociated.path_equations import Equations, Path, Point
from limitblocks.arrays import Array, Indices
from limitblocks.problem.barrier import slope

REFINED = 1e-4  # theta below which directions are refined: without it paths stall near 1e-8


class Newton:
    """Derivative J by (x, u, a, s, y), factorised: s and y go first, then x by interfaces.

    What is left, [[-C^T H^-1 C, live], [live^T, 0]], couples the rates and the load factor.
    """

    def __init__(self, path: Path, z: Point) -> None:
        self.path, self.z = path, z
        p, layout = path.flow.problem, path.layout
        self.GT = layout.potential(z.x)
        self.fall = slope(p.cones, z.s, z.y)
        self.slopes = layout.by_interface(self.fall(layout.yield_rows))
        H = layout.padding + layout.potential_parts(z.x) @ self.slopes
        diagonal = np.arange(H.shape[1])
        self.elastic = path.rho(z.theta) * path.elastic
        H[:, diagonal, diagonal] += layout.per_interface(self.elastic)
        self.turning = None if path.flow.constant else path.flow.derivative(z.x, z.y)
        if self.turning is not None:
            t = self.turning.tocoo()
            places = p.stress_interface[t.row], layout.stress_place[t.row], layout.stress_place[t.col]
            np.add.at(H, places, t.data)
        self.stiffness, self.flexibility = H, np.linalg.inv(H)
        C = layout.compatibility
        self.lu = layout.factors(np.swapaxes(C, 1, 2) @ (self.flexibility @ C))

    @property
    def sign(self) -> float:
        """Sign of det J, but for a factor that is the same all along the path."""
        return float(np.prod(np.sign(np.linalg.det(self.stiffness)))) * _sign(self.lu)

    def solve(self, q: Equations) -> Point:
        """Return the direction d with J d = q, refined once far down the path.

        Before, the corrector mends what elimination loses; there it is as large as what the path allows.
        """
        d = self._eliminated(q)
        return d.moved(1.0, self._eliminated(self._left(q, d))) if self.z.theta < REFINED else d

    def _eliminated(self, q: Equations) -> Point:
        p, layout = self.path.flow.problem, self.path.layout
        multiplier = q.multiplier + self.fall(q.slack)
        free = self._flexed(q.flow + self.GT @ multiplier)
        w = layout.solved(self.lu, np.append(q.balance + layout.balance @ free, q.work))
        dx = free + self._flexed(p.C @ w[:-1])
        fall = layout.per_row(_times(self.slopes, layout.per_interface(dx)))
        return Point(dx, w[:-1], float(w[-1]), p.F @ dx - q.slack, multiplier - fall, 0.0)

    def _left(self, q: Equations, d: Point) -> Equations:
        """What a direction leaves of q; slacks and products are exact."""
        p, layout = self.path.flow.problem, self.path.layout
        flow = q.flow - self.elastic * d.x + p.C @ d.u + self.GT @ d.y
        if self.turning is not None:
            flow -= self.turning @ d.x
        balance = q.balance + layout.balance @ d.x - d.load_factor * p.live
        none = np.zeros_like(q.slack)
        return Equations(flow, balance, q.work - float(p.live @ d.u), none, none)

    def _flexed(self, v: Array) -> Array:
        layout = self.path.layout
        return layout.per_stress(_times(self.flexibility, layout.per_interface(v)))


def _times(blocks: Any, x: Array) -> Array:
    """Products of matrices (m, r, k) and vectors (m, k)."""
    return np.asarray((blocks @ x[:, :, None])[:, :, 0])


def _sign(lu: linalg.SuperLU) -> float:
    """Sign of a determinant: of the pivots and of the two permutations."""
    pivots = float(np.prod(np.sign(lu.U.diagonal())))
    same = np.array_equal(lu.perm_r, lu.perm_c)
    return pivots if same else pivots * _parity(lu.perm_r) * _parity(lu.perm_c)


def _parity(permutation: Indices) -> float:
    """1 for an even permutation, -1 for an odd one: a cycle of k places takes k - 1 exchanges."""
    n = len(permutation)
    least, ahead = np.arange(n), permutation
    for _ in range(n.bit_length()):  # least place of each cycle, by jumps twice as long each time
        least, ahead = np.minimum(least, least[ahead]), ahead[ahead]
    return -1.0 if (n - np.count_nonzero(least == np.arange(n))) % 2 else 1.0

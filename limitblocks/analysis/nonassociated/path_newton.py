"""Derivative of a path's equations at a point: one factorisation, any number of right-hand sides."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from limitblocks.analysis.nonassociated.path_equations import Equations, Path, Point
from limitblocks.arrays import Array, Indices
from limitblocks.problem.barrier import quotient, slope


class _Columns(NamedTuple):
    """Right-hand sides of the five equations as columns; products divided by s."""

    flow: Array
    balance: Array
    work: Array
    slack: Array
    product: Array


class Newton:
    """Derivative J by (x, u, a, s, y), factorised: s and y go first, then x by interfaces.

    What is left, [[-C^T H^-1 C, live], [live^T, 0]], couples the rates and the load factor. `sign` is that of
    det J, but for a factor that is the same all along the path.
    """

    def __init__(self, path: Path, z: Point) -> None:
        self.path, self.z = path, z
        p, layout = path.flow.problem, path.layout
        self.GT = layout.potential(z.x)
        stiff = layout.by_interface(slope(p.cones, z.s, z.y, layout.yield_rows))
        H = layout.padding + layout.potential_parts(z.x) @ stiff
        diagonal = np.arange(H.shape[1])
        H[:, diagonal, diagonal] += layout.per_interface(path.rho(z.theta) * path.elastic)
        if not path.flow.constant:
            t = path.flow.derivative(z.x, z.y).tocoo()
            places = p.stress_interface[t.row], layout.stress_place[t.row], layout.stress_place[t.col]
            np.add.at(H, places, t.data)
        self.flexibility = np.linalg.inv(H)
        C = layout.compatibility
        self.lu = layout.factors(np.swapaxes(C, 1, 2) @ (self.flexibility @ C))
        self.sign = float(np.prod(np.sign(np.linalg.det(H)))) * _sign(self.lu)

    def solve(self, *right: Equations) -> tuple[Point, ...]:
        """Return the directions d with J d = q for each q.

        They are not refined: the corrector mends what is left, and refinement doubles what a step costs.
        """
        q = self._columns(right)
        p, z, layout = self.path.flow.problem, self.z, self.path.layout
        cones = p.cones
        free = self._flexed(q.flow + self.GT @ (q.product + slope(cones, z.s, z.y, q.slack)))
        w = layout.solved(self.lu, np.vstack([q.balance + layout.balance @ free, q.work]))
        dx = free + self._flexed(p.C @ w[:-1])
        ds = p.F @ dx - q.slack
        dy = q.product - slope(cones, z.s, z.y, ds)
        return tuple(
            Point(dx[:, k], w[:-1, k], float(w[-1, k]), ds[:, k], dy[:, k], 0.0) for k in range(len(right))
        )

    def _columns(self, right: tuple[Equations, ...]) -> _Columns:
        products = [quotient(self.path.cones, self.z.s, q.product) for q in right]
        parts = [[q.flow for q in right], [q.balance for q in right], [[q.work] for q in right]]
        return _Columns(*(np.stack(part, axis=1) for part in [*parts, [q.slack for q in right], products]))

    def _flexed(self, v: Array) -> Array:
        layout = self.path.layout
        return layout.per_stress(self.flexibility @ layout.per_interface(v))


def _sign(lu: linalg.SuperLU) -> float:
    """Sign of a determinant: of the pivots and of the two permutations."""
    pivots = float(np.prod(np.sign(lu.U.diagonal())))
    same = np.array_equal(lu.perm_r, lu.perm_c)
    return pivots if same else pivots * _parity(lu.perm_r) * _parity(lu.perm_c)


def _parity(permutation: Indices) -> float:
    """1 for an even permutation, -1 for an odd one: a cycle of k places takes k - 1 exchanges."""
    n = len(permutation)
    links = sparse.csr_array((np.ones(n), (np.arange(n), permutation)), shape=(n, n))
    cycles = int(sparse.csgraph.connected_components(links, directed=False)[0])
    return -1.0 if (n - cycles) % 2 else 1.0

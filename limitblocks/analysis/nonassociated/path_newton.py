"""Derivative of a path's equations at a point: one factorisation, any number of right-hand sides."""

from __future__ import annotations

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from limitblocks.analysis.nonassociated.path_equations import Equations, Path, Point
from limitblocks.arrays import Array, Indices
from limitblocks.problem.barrier import quotient, slope


class Newton:
    """Derivative J by (x, u, a, s, y), factorised: s and y go first, then x by interfaces.

    What is left, [[-C^T H^-1 C, live], [live^T, 0]], couples the rates and the load factor. `sign` is that of
    det J, but for a factor that is the same all along the path.
    """

    def __init__(self, path: Path, z: Point) -> None:
        self.path, self.z = path, z
        p, layout = path.flow.problem, path.layout
        G = path.flow.matrix(z.x)
        self.GT = G.T.tocsr()
        self.elastic = path.rho(z.theta) * path.elastic
        self.turn = None if path.flow.constant else path.flow.derivative(z.x, z.y)
        potential = layout.by_interface(layout.rows(G))
        stiff = layout.by_interface(slope(p.cones, z.s, z.y, layout.yield_rows))
        H = layout.padding + np.swapaxes(potential, 1, 2) @ stiff
        diagonal = np.arange(H.shape[1])
        H[:, diagonal, diagonal] += layout.per_interface(self.elastic)
        if self.turn is not None:
            t = self.turn.tocoo()
            places = p.stress_interface[t.row], layout.stress_place[t.row], layout.stress_place[t.col]
            np.add.at(H, places, t.data)
        self.flexibility = np.linalg.inv(H)
        C = layout.compatibility
        self.lu = linalg.splu(
            layout.condensed(np.swapaxes(C, 1, 2) @ self.flexibility @ C),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.001,
            options={"SymmetricMode": True},
        )
        self.sign = float(np.prod(np.linalg.slogdet(H)[0])) * _sign(self.lu)

    def solve(self, q: Equations) -> Point:
        """Return the direction d with J d = q, refined once on the full equations."""
        d = self._eliminated(q)
        return d.moved(1.0, self._eliminated(self._left(q, d)))

    def _left(self, q: Equations, d: Point) -> Equations:
        """What a direction leaves of q."""
        p, z = self.path.flow.problem, self.z
        elastic = self.elastic * d.x if self.turn is None else self.elastic * d.x + self.turn @ d.x
        return Equations(
            q.flow - elastic + p.C @ d.u + self.GT @ d.y,
            q.balance + p.C.T @ d.x - d.load_factor * p.live,
            q.work - float(p.live @ d.u),
            q.slack - p.F @ d.x + d.s,
            q.product - p.cones.product(z.y, d.s) - p.cones.product(z.s, d.y),
        )

    def _eliminated(self, q: Equations) -> Point:
        p, z = self.path.flow.problem, self.z
        h = q.flow + self.GT @ quotient(p.cones, z.s, q.product + p.cones.product(z.y, q.slack))
        free = self._flexed(h)
        w = self.lu.solve(np.append(q.balance + p.C.T @ free, q.work))
        dx = free + self._flexed(p.C @ w[:-1])
        ds = p.F @ dx - q.slack
        dy = quotient(p.cones, z.s, q.product - p.cones.product(z.y, ds))
        return Point(dx, w[:-1], float(w[-1]), ds, dy, 0.0)

    def _flexed(self, v: Array) -> Array:
        layout = self.path.layout
        return layout.per_stress((self.flexibility @ layout.per_interface(v)[:, :, None])[:, :, 0])


def _sign(lu: linalg.SuperLU) -> float:
    """Sign of a determinant: of the pivots and of the two permutations."""
    pivots = float(np.prod(np.sign(lu.U.diagonal())))
    return pivots * _parity(lu.perm_r) * _parity(lu.perm_c)


def _parity(permutation: Indices) -> float:
    """1 for an even permutation, -1 for an odd one: a cycle of k places takes k - 1 exchanges."""
    n = len(permutation)
    links = sparse.csr_array((np.ones(n), (np.arange(n), permutation)), shape=(n, n))
    cycles = int(sparse.csgraph.connected_components(links, directed=False)[0])
    return -1.0 if (n - cycles) % 2 else 1.0

"""Derivative of a path's equations at a point: one factorisation, any number of right-hand sides."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from limitblocks.analysis.nonassociated.path_equations import Equations, Path, Point
from limitblocks.arrays import Array, Indices
from limitblocks.problem.barrier import quotient, slope

REFINED = 1e-4  # theta below which directions are refined: without it paths stall near 1e-8


class _Columns(NamedTuple):
    """Right-hand sides of the five equations, or directions by x, u, a, s, y: columns."""

    flow: Array
    balance: Array
    work: Array
    slack: Array
    product: Array


class Newton:
    """Derivative J by (x, u, a, s, y), factorised: s and y go first, then x by interfaces.

    What is left, [[-C^T H^-1 C, live], [live^T, 0]], couples the rates and the load factor.
    """

    def __init__(self, path: Path, z: Point) -> None:
        self.path, self.z = path, z
        p, layout = path.flow.problem, path.layout
        self.GT = layout.potential(z.x)
        self.slopes = layout.by_interface(slope(p.cones, z.s, z.y, layout.yield_rows))
        H = layout.padding + layout.potential_parts(z.x) @ self.slopes
        diagonal = np.arange(H.shape[1])
        self.elastic = (path.rho(z.theta) * path.elastic)[:, None]
        H[:, diagonal, diagonal] += layout.per_interface(self.elastic[:, 0])
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

    def solve(self, *right: Equations) -> tuple[Point, ...]:
        """Return the directions d with J d = q for each q, refined once far down the path.

        Before, the corrector mends what elimination loses; there it is as large as what the path allows.
        """
        q = self._columns(right)
        d = self._eliminated(q)
        if self.z.theta < REFINED:
            d = _Columns(*(a + b for a, b in zip(d, self._eliminated(self._left(q, d)), strict=True)))
        return tuple(
            Point(d.flow[:, k], d.balance[:, k], float(d.work[0, k]), d.slack[:, k], d.product[:, k], 0.0)
            for k in range(len(right))
        )

    def _eliminated(self, q: _Columns) -> _Columns:
        """Directions by x, u, a, s, y as columns."""
        p, layout = self.path.flow.problem, self.path.layout
        free = self._flexed(q.flow + self.GT @ q.product)
        w = layout.solved(self.lu, np.vstack([q.balance + layout.balance @ free, q.work]))
        dx = free + self._flexed(p.C @ w[:-1])
        fall = layout.per_row(self.slopes @ layout.per_interface(dx))
        return _Columns(dx, w[:-1], w[-1:], p.F @ dx - q.slack, q.product - fall)

    def _left(self, q: _Columns, d: _Columns) -> _Columns:
        """What directions leave of q; slacks and products are exact."""
        p, layout = self.path.flow.problem, self.path.layout
        flow = q.flow - self.elastic * d.flow + p.C @ d.balance + self.GT @ d.product
        if self.turning is not None:
            flow -= self.turning @ d.flow
        balance = q.balance + layout.balance @ d.flow - p.live[:, None] * d.work
        none = np.zeros_like(q.slack)
        return _Columns(flow, balance, q.work - p.live @ d.balance, none, none)

    def _columns(self, right: tuple[Equations, ...]) -> _Columns:
        """Right-hand sides as columns; multipliers that products and slacks ask for in place of products."""
        cones, z, slack = self.path.cones, self.z, np.column_stack([q.slack for q in right])
        product = quotient(cones, z.s, np.column_stack([q.product for q in right]))
        if slack.any():
            product += slope(cones, z.s, z.y, slack)
        return _Columns(
            np.column_stack([q.flow for q in right]),
            np.column_stack([q.balance for q in right]),
            np.array([[q.work for q in right]]),
            slack,
            product,
        )

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

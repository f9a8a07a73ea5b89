"""Derivative of a path's equations at a point: one factorisation, any number of right-hand sides."""

from __future__ import annotations

import numpy as np
from scipy.sparse import linalg

from limitblocks.analysis.nonassociated.path_equations import Equations, Path, Point
from limitblocks.arrays import Array, Indices, tied
from limitblocks.problem.barrier import slope

# Of what a pivot was, where rounding left nothing of it: else a facade of 160 (friction .4, out) stalls.
ROUNDED = 4.0 * float(np.finfo(float).eps)
REFINED = 1e-4  # theta below which directions are refined: without it paths stall near 1e-8
# Flow that a direction may leave over its largest multiplier, and the most refinements. Elimination loses all
# of it where joints that flow carry 1e9 times their slacks and others 1e-9: two to six mend it.
ACCURATE, MOST = 1e-4, 12


class Newton:
    """Derivative J by (x, u, a, s, y), factorised: s and y go first, then x by interfaces.

    What is left, [[-C^T H^-1 C, live], [live^T, 0]], couples the rates and the load factor.
    """

    def __init__(self, path: Path, z: Point) -> None:
        self.path, self.z = path, z
        p, layout = path.flow.problem, path.layout
        self.GT = layout.potential(z.x)
        self.fall = slope(p.cones, z.s, z.y)
        slopes = layout.by_cell(self.fall(layout.yield_rows))
        H = layout.padding + layout.potential_parts(z.x) @ slopes
        self.elastic = path.rho(z.theta) * path.elastic
        np.einsum("cii->ci", H)[:] += layout.per_cell(self.elastic)
        self.turning = None if path.flow.constant else path.flow.derivative(z.x, z.y)
        if self.turning is None:
            flexibility, self.determinants = inverses(H)
        else:  # pivots of Table 5 may be small
            t = self.turning.tocoo()
            places = p.stress_interface[t.row], layout.stress_place[t.row], layout.stress_place[t.col]
            np.add.at(H, places, t.data)
            flexibility, self.determinants = np.asarray(np.linalg.inv(H)), np.asarray(np.linalg.det(H))
        self.flexibility, C = layout.by_interface(flexibility), layout.compatibility
        self.lu = layout.factors(np.swapaxes(C, 1, 2) @ (self.flexibility @ C))

    @property
    def sign(self) -> float:
        """Sign of det J, but for a factor that is the same all along the path."""
        return float(np.prod(np.sign(self.determinants))) * sign_of(self.lu.factors)

    def solve(self, *sides: Equations) -> list[Point]:
        """Return the direction d with J d = -q for each q, refined far down the path.

        Before, the corrector mends what elimination loses; there it is as large as what the path allows.
        """
        n, height, count = len(self.elastic), len(self.path.cones.member), len(sides)
        right, rows = np.empty((self._ends[1], count)), np.empty((height, count))
        y = np.empty_like(rows)
        for k, q in enumerate(sides):
            right[:n, k], right[n:-1, k], right[-1, k] = q.flow, q.balance, q.work
            rows[:, k], y[:, k] = q.slack, q.multiplier
        for part in (right, rows, y):
            np.negative(part, out=part)
        y += self.fall(rows)
        loads = right.copy()
        loads[:n] += self.GT @ y
        d, s = self._eliminated(loads)
        x, w, multipliers = np.split(d, self._ends)  # which are views
        multipliers += y
        if self.z.theta < REFINED:
            self._refine(d, right)
            s = self.path.flow.problem.F @ x
        parts = x, w[:-1], w[-1], s - rows, multipliers
        own = zip(*(np.ascontiguousarray(part.T) for part in parts), strict=True)
        return [Point(x, u, float(load_factor), s, y, 0.0) for x, u, load_factor, s, y in own]

    def _refine(self, d: Array, right: Array) -> None:
        """Take from directions, in place, what they leave of the right-hand sides.

        By generalised conjugate residuals (Eisenstat, Elman & Schultz 1983, SIAM J. Numer. Analysis 20), in
        all unknowns: multipliers that are taken from the stresses again have their rounding.
        """
        n, tried = len(self.elastic), list[tuple[Array, Array]]()
        y, left = d[self._ends[-1] :], right - self._taken(d)
        measures = self.path.measures
        stress, slack = measures.stress[:, None], measures.slack[:, None]
        for _ in range(MOST):
            if (_largest(stress * left[:n]) <= ACCURATE * _largest(slack * y)).all():
                return
            step, _ = self._eliminated(left)
            takes = self._taken(step)
            for earlier, took in tried:
                share = np.einsum("kc,kc->c", takes, took)
                step -= share * earlier
                takes -= share * took
            size = np.sqrt(np.einsum("kc,kc->c", takes, takes))
            size[size == 0.0] = 1.0
            tried.append((step / size, takes / size))
            share = np.einsum("kc,kc->c", left, tried[-1][1])
            d += share * tried[-1][0]
            left -= share * tried[-1][1]

    @property
    def _ends(self) -> list[int]:
        """Where stresses, and rates with the load factor, end in a direction."""
        n, rates = self.path.flow.problem.C.shape
        return [n, n + rates + 1]

    def _eliminated(self, right: Array) -> tuple[Array, Array]:
        """Directions (x, u, a, y) for right-hand sides of flow, balance and work, and F x."""
        p, layout = self.path.flow.problem, self.path.layout
        n = len(self.elastic)
        free, loads = self._flexed(right[:n]), right[n:].copy()
        loads[:-1] += layout.balance @ free
        w = self.lu.solve(loads)
        x = free + self._flexed(p.C @ w[:-1])
        rows = p.F @ x
        return np.concatenate([x, w, -self.fall(rows)]), rows

    def _taken(self, d: Array) -> Array:
        """What directions take of flow, balance and work; slacks and products are exact."""
        p = self.path.flow.problem
        x, w, y = np.split(d, self._ends)
        flow = self.elastic[:, None] * x - p.C @ w[:-1] - self.GT @ y
        if self.turning is not None:
            flow += self.turning @ x
        balance = p.live[:, None] * w[-1] - self.path.layout.balance @ x
        return np.concatenate([flow, balance, (p.live @ w[:-1])[None]])

    def _flexed(self, v: Array) -> Array:
        layout = self.path.layout
        return layout.per_stress(self.flexibility @ layout.per_interface(v))


def inverses(matrices: Array) -> tuple[Array, Array]:
    """Return the inverses of many small matrices (..., k, k), and the signs of their determinants (...).

    By Gauss and Jordan without row exchanges, all at once, in a third of the time of LAPACK or less. It suits
    flows of constant direction: what opens, closes and bends depends on no slip, and both are definite.
    A pivot that rounding took whole is one of rounding.
    """
    a = np.ascontiguousarray(np.moveaxis(matrices, (-2, -1), (0, 1)))
    least = ROUNDED * np.abs(np.einsum("ii...->i...", a))
    pivots = np.empty(a.shape[1:])
    for i in range(len(a)):
        pivots[i] = a[i, i] = np.where(a[i, i] == 0.0, least[i], a[i, i])
        row = a[i] / pivots[i]
        row[i] = 1.0 / pivots[i]
        column = a[:, i].copy()
        column[i] = a[:, i] = a[i] = 0.0
        a -= column[:, None] * row
        a[i] = row
    return np.moveaxis(a, (0, 1), (-2, -1)), np.prod(np.sign(pivots), axis=0)


def _largest(columns: Array) -> Array:
    """Largest size in each of a few long columns: one by one, as numpy takes 100 times as long for all."""
    return np.array([np.abs(column).max() for column in columns.T])


def sign_of(lu: linalg.SuperLU) -> float:
    """Sign of a determinant: of the pivots and of the two permutations."""
    pivots = float(np.prod(np.sign(lu.U.diagonal())))
    same = np.array_equal(lu.perm_r, lu.perm_c)
    return pivots if same else pivots * _parity(lu.perm_r) * _parity(lu.perm_c)


def _parity(permutation: Indices) -> float:
    """1 for an even permutation, -1 for an odd one: a cycle of k places takes k - 1 exchanges."""
    n = len(permutation)
    cycles = int(tied(np.column_stack([np.arange(n), permutation]), n).max(initial=-1)) + 1
    return -1.0 if (n - cycles) % 2 else 1.0

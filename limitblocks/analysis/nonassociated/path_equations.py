"""Equations of a tracked path and their derivative at a point; one factorisation, any number of right-hand sides.

    rho(theta) W (x - x0) = C u + G(x)^T y + theta r,   dead + a live = C^T x,   live . u = 1,
    F x + g = s,   s o y = mu(theta) w,   s, y in int K

with rho = rho0 max(theta^p, floor), mu = mu0 theta; w weighs the rows and cones. x0 is moved on where rho
has reached its floor, and r carries the jump that this would make: the path stays continuous.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import linalg

from limitblocks.analysis.nonassociated.path_layout import Layout
from limitblocks.arrays import Array
from limitblocks.problem import Cones, Flow


@dataclass(frozen=True)
class Barrier:
    """How compliance and barrier fade along a path: mu = size theta, rho = rho0 max(theta^power, floor).

    A small barrier follows the loading of joints of compliance W; a large one leads to another solution, with
    fewer folds.
    """

    size: float = 0.1
    power: float = 1.0
    floor: float = 1e-6


@dataclass(frozen=True, eq=False)
class Point:
    """Variables of a path, or a direction in them."""

    x: Array
    u: Array
    load_factor: float
    s: Array
    y: Array
    theta: float

    def moved(self, t: float, d: Point) -> Point:
        """Return this point moved by t along the direction d."""
        return Point(
            self.x + t * d.x,
            self.u + t * d.u,
            self.load_factor + t * d.load_factor,
            self.s + t * d.s,
            self.y + t * d.y,
            self.theta + t * d.theta,
        )


@dataclass(frozen=True, eq=False)
class Path:
    """What fixes a path: flow, barrier, weights w of rows and cones (R,), rho0 W, and x0 with its residual r."""

    flow: Flow
    layout: Layout
    barrier: Barrier
    weights: Array
    elastic: Array
    x0: Array
    carried: Array

    def rho(self, theta: float) -> float:
        """Share of the elastic compliance at theta."""
        return max(theta**self.barrier.power, self.barrier.floor)

    def rho_slope(self, theta: float) -> float:
        """Derivative of `rho` by theta."""
        power = self.barrier.power
        return power * theta ** (power - 1.0) if theta**power > self.barrier.floor else 0.0

    def target(self, theta: float) -> Array:
        """Products s o y of the path at theta, shape (R,)."""
        return self.barrier.size * theta * self.weights


@dataclass(frozen=True, eq=False)
class Equations:
    """Residuals of the five equations of a path, in their order."""

    flow: Array
    balance: Array
    work: float
    slack: Array
    product: Array


def residuals(path: Path, z: Point) -> Equations:
    """Residuals at a point: of flow, equilibrium, normalisation, slacks and complementarity."""
    p = path.flow.problem
    elastic = path.rho(z.theta) * path.elastic * (z.x - path.x0)
    return Equations(
        elastic - p.C @ z.u - path.flow.matrix(z.x).T @ z.y - z.theta * path.carried,
        p.dead + z.load_factor * p.live - p.C.T @ z.x,
        float(p.live @ z.u - 1.0),
        p.F @ z.x + p.g - z.s,
        p.cones.product(z.s, z.y) - path.target(z.theta),
    )


class Linear:
    """Derivative of the equations by (x, u, a, s, y) at a point, factorised by interfaces."""

    def __init__(self, path: Path, z: Point) -> None:
        self.path, self.z = path, z
        p, layout = path.flow.problem, path.layout
        self.G = path.flow.matrix(z.x)
        self.GT = self.G.T.tocsr()
        slope = _slope_times(p.cones, z.s, z.y, layout.yield_rows)
        G = layout.by_interface(layout.rows(self.G))
        H = layout.padding + np.swapaxes(G, 1, 2) @ layout.by_interface(slope)
        k = np.arange(H.shape[1])
        self.elastic = path.rho(z.theta) * path.elastic
        H[:, k, k] += layout.per_interface(self.elastic)
        self.turn = None if path.flow.constant else path.flow.derivative(z.x, z.y)
        if self.turn is not None:
            t = self.turn.tocoo()
            places = p.stress_interface[t.row], layout.stress_place[t.row], layout.stress_place[t.col]
            np.add.at(H, places, t.data)
        self.flexibility = np.linalg.inv(H)
        C = layout.compatibility
        matrix = layout.condensed(np.swapaxes(C, 1, 2) @ self.flexibility @ C)
        self.lu = linalg.splu(
            matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.001, options={"SymmetricMode": True}
        )
        self.sign = float(np.prod(np.linalg.slogdet(H)[0])) * _sign(self.lu)

    def solve(self, q: Equations) -> Point:
        """Direction whose image is q, refined once."""
        d = self._solve(q)
        return d.moved(1.0, self._solve(self._left(q, d)))

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

    def _solve(self, q: Equations) -> Point:
        p, z, layout = self.path.flow.problem, self.z, self.path.layout
        inner = _divided(p.cones, z.s, q.product + p.cones.product(z.y, q.slack))
        h = self._flexed(q.flow + self.GT @ inner)
        w = self.lu.solve(np.append(q.balance + p.C.T @ h, q.work))
        dx = h + self._flexed(p.C @ w[:-1])
        ds = p.F @ dx - q.slack
        dy = _divided(p.cones, z.s, q.product - p.cones.product(z.y, ds))
        return Point(dx, w[:-1], float(w[-1]), ds, dy, 0.0)

    def _flexed(self, v: Array) -> Array:
        layout = self.path.layout
        return layout.per_stress((self.flexibility @ layout.per_interface(v)[:, :, None])[:, :, 0])


def theta_slope(path: Path, z: Point) -> Equations:
    """Derivative of the equations by theta."""
    p = path.flow.problem
    elastic = path.rho_slope(z.theta) * path.elastic * (z.x - path.x0)
    zero = np.zeros_like
    return Equations(elastic - path.carried, zero(p.dead), 0.0, zero(z.s), -path.target(1.0))


def negative(q: Equations) -> Equations:
    """The equations with the other sign."""
    return Equations(-q.flow, -q.balance, -q.work, -q.slack, -q.product)


def _determinant(v: Array) -> Array:
    return np.asarray(v[:, 0] ** 2 - (v[:, 1:] ** 2).sum(axis=1))


def _divided(cones: Cones, s: Array, q: Array) -> Array:
    """L(s)^-1 q, Alizadeh & Goldfarb (2003), Section 4."""
    found = q / np.where(s == 0.0, 1.0, s)
    for index in cones.groups:
        v, w = s[index], q[index]
        first = (v[:, 0] * w[:, 0] - (v[:, 1:] * w[:, 1:]).sum(axis=1)) / _determinant(v)
        found[index[:, 0]] = first
        found[index[:, 1:]] = (w[:, 1:] - first[:, None] * v[:, 1:]) / v[:, :1]
    return found


def _slope_times(cones: Cones, s: Array, y: Array, rows: Array) -> Array:
    """L(s)^-1 L(y) applied to rows (R, k)."""
    found = rows * (y / np.where(s == 0.0, 1.0, s))[:, None]
    for index in cones.groups:
        v, w, F = s[index][:, :, None], y[index][:, :, None], rows[index]
        head = (w * F).sum(axis=1, keepdims=True)
        tail = w[:, :1] * F[:, 1:] + w[:, 1:] * F[:, :1]
        first = (v[:, :1] * head - (v[:, 1:] * tail).sum(axis=1, keepdims=True)) / _determinant(s[index])[:, None, None]
        found[index] = np.concatenate([first, (tail - first * v[:, 1:]) / v[:, :1]], axis=1)
    return found


def _sign(lu: linalg.SuperLU) -> float:
    """Sign of the determinant: of the pivots and of the two permutations."""
    return float(np.prod(np.sign(lu.U.diagonal()))) * _parity(lu.perm_r) * _parity(lu.perm_c)


def _parity(permutation: Array) -> float:
    """1 for an even permutation, -1 for an odd one: by the number of its cycles."""
    n = len(permutation)
    graph = sparse_cycles(permutation)
    return -1.0 if (n - graph) % 2 else 1.0


def sparse_cycles(permutation: Array) -> int:
    """Number of cycles of a permutation."""
    from scipy import sparse

    n = len(permutation)
    links = sparse.csr_array((np.ones(n), (np.arange(n), permutation)), shape=(n, n))
    return int(sparse.csgraph.connected_components(links, directed=False)[0])

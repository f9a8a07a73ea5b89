"""One implicit step of loading, solved by an interior-point method with numpy and scipy.

From the stresses x0 a step of size 1/rho finds x, u, y and the load factor a with

    rho W (x - x0) = C u + G(x)^T y,   dead + a live = C^T x,   live . u = 1,
    F x + g = s in K,   y in K*,   s o y = 0.

It is a quasi-static step of rigid blocks on joints of compliance W. The flow is not associated, so the
central path can fold, and the step may have no solution near by.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from limitblocks.analysis.interface_blocks import InterfaceBlocks
from limitblocks.analysis.nonassociated.path_equations import Point
from limitblocks.arrays import Array
from limitblocks.problem import Flow, LimitProblem

ACCURACY = 2e-9  # of the linear equations and the flow, dimensionless
CENTRED = 1e-13  # mean of s o y at the end: products that vanish in both factors are found to its root
ACCEPTED = 1e-7  # of the equations, and a hundredth of the sum of s o y
REGULAR = 1e-9  # keeps an interface block regular where nothing resists
JAMMED = 0.08  # mean length of six steps below which the central path has folded


@dataclass(frozen=True, eq=False)
class Loading:
    """What a step starts from and how large it is; `weights` is the compliance W of the joints."""

    flow: Flow
    blocks: InterfaceBlocks
    weights: Array
    x0: Array
    rho: float

    @property
    def problem(self) -> LimitProblem:
        """The structure."""
        return self.flow.problem


@dataclass(frozen=True, eq=False)
class StepResult:
    """The most accurate point met, whether it solves the step, and the iterations used."""

    point: Point
    accepted: bool
    iterations: int


class Newton:
    """Newton's equations of a step at one point: one factorisation, any number of right-hand sides."""

    def __init__(self, loading: Loading, z: Point) -> None:
        self.loading, self.z = loading, z
        p = loading.problem
        G = loading.flow.matrix(z.x)
        self.GT = sparse.csr_array(G.T)
        self.defect = (
            loading.rho * loading.weights * (z.x - loading.x0) - self.GT @ z.y - p.C @ z.u,
            p.dead + z.load_factor * p.live - p.C.T @ z.x,
            float(p.live @ z.u - 1.0),
            p.F @ z.x + p.g - z.s,
        )
        self.mu = float(z.s @ z.y) / p.cones.degree
        self.size = max(float(np.abs(d).max()) for d in self.defect)

    def factorise(self) -> None:
        """Eliminate s and y, then x by interfaces; what is left couples the rates and the load factor."""
        step, p, z = self.loading, self.loading.problem, self.z
        self.scaling = p.cones.inverse_arrow(z.s)
        self.slope = sparse.csr_array(self.scaling @ p.cones.arrow(z.y))
        self.turn = step.flow.derivative(z.x, z.y)
        H = self.GT @ (self.slope @ p.F) + sparse.diags_array(step.rho * step.weights + REGULAR) + self.turn
        self.flexibility = step.blocks.inverse(H)
        K = p.C.T @ (self.flexibility @ p.C) + 1e-13 * sparse.eye_array(p.C.shape[1])
        live = sparse.csr_array(p.live[:, None])
        matrix = sparse.csc_array(sparse.block_array([[-K, live], [live.T, None]]))
        self.lu = linalg.splu(
            matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.001, options={"SymmetricMode": True}
        )

    def direction(self, target: Array) -> Point:
        """Direction to s o y = target, refined on the full equations, else accuracy is lost at small mu."""
        step, p, z = self.loading, self.loading.problem, self.z
        q1, q2, q3, q4 = self.defect
        q5 = target - p.cones.product(z.s, z.y)
        d = self._solve(-q1, -q2, -q3, -q4, q5)
        for _ in range(2):
            elastic = step.rho * step.weights * d.x + self.turn @ d.x
            correction = self._solve(
                -q1 - (elastic - self.GT @ d.y - p.C @ d.u),
                -q2 + p.C.T @ d.x - p.live * d.load_factor,
                -q3 - float(p.live @ d.u),
                -q4 - (p.F @ d.x - d.s),
                q5 - p.cones.product(z.s, d.y) - p.cones.product(z.y, d.s),
            )
            d = d.moved(1.0, correction)
        return d

    def _solve(self, q1: Array, q2: Array, q3: float, q4: Array, q5: Array) -> Point:
        p = self.loading.problem
        h = self.flexibility @ (q1 + self.GT @ (self.scaling @ q5 + self.slope @ q4))
        w = self.lu.solve(np.append(q2 + p.C.T @ h, q3))
        dx = h + self.flexibility @ (p.C @ w[:-1])
        ds = p.F @ dx - q4
        dy = self.scaling @ (q5 - p.cones.product(self.z.y, ds))
        return Point(dx, w[:-1], float(w[-1]), ds, dy)

    def best_step(self) -> tuple[float, Point]:
        """Length and direction: Mehrotra's, or with more and more centring until it is long enough."""
        cones, z = self.loading.problem.cones, self.z
        probe = self.direction(np.zeros_like(z.s))
        t = min(1.0, cones.longest(z.s, probe.s), cones.longest(z.y, probe.y))
        reached = float((z.s + t * probe.s) @ (z.y + t * probe.y)) / cones.degree
        sigma = min(max((reached / self.mu) ** 3 if reached > 0.0 else 1e-3, 1e-4), 1.0)
        # mu must not run ahead of the flow: an inadmissible point on the boundary cannot recover
        sigma = max(sigma, min(1.0, 1e-3 * float(np.abs(self.defect[0]).max()) / self.mu))
        second_order = cones.product(probe.s, probe.y)
        best, best_length = probe, -1.0
        for centring, correction in ((sigma, 1.0), (max(0.3, sigma), 0.0), (0.8, 0.0), (1.0, 0.0)):
            d = self.direction(centring * self.mu * cones.identity - correction * second_order)
            length = self._length(d)
            if length > best_length:
                best, best_length = d, length
            if best_length > 0.2:
                break
        return best_length, best

    def _length(self, d: Point) -> float:
        """Longest step that keeps every product above a thousandth of their mean."""
        cones, z = self.loading.problem.cones, self.z
        t = min(1.0, 0.95 * min(cones.longest(z.s, d.s), cones.longest(z.y, d.y)))
        for _ in range(25):
            s, y = z.s + t * d.s, z.y + t * d.y
            if cones.least_product(s, y) >= 1e-3 * float(s @ y) / cones.degree:
                return t
            t *= 0.8
        return 0.0


@np.errstate(over="ignore", invalid="ignore", divide="ignore")  # a point that ran away is not accepted
def implicit_step(loading: Loading, iterations: int) -> StepResult:
    """Solve one step by the interior-point method from a cold start."""
    p = loading.problem
    rows = p.F @ loading.x0 + p.g
    inside = rows + p.cones.identity * max(1.0, 1.0 - float(p.cones.margin(rows).min()))
    z = Point(loading.x0, np.zeros(p.C.shape[1]), 0.0, inside, p.cones.identity)
    best, point = (np.inf, np.inf), z
    lengths: list[float] = []
    count = 0
    for count in range(iterations + 1):
        newton = Newton(loading, z)
        merit, best_merit = max(newton.size, 100 * newton.mu), max(best[0], 100 * best[1])
        if not np.isfinite(merit):
            break
        if merit < best_merit:
            best, point = (newton.size, newton.mu), z
        done = newton.size < ACCURACY and newton.mu < CENTRED
        worse = best_merit < ACCEPTED and merit > 100 * best_merit
        jammed = len(lengths) >= 8 and np.mean(lengths[-6:]) < JAMMED
        if done or worse or jammed or count == iterations:
            break
        try:
            newton.factorise()
        except (RuntimeError, np.linalg.LinAlgError):
            break
        t, d = newton.best_step()
        lengths.append(t)
        z = z.moved(t, d)
    accepted = best[0] < ACCEPTED and best[1] * p.cones.degree < 100 * ACCEPTED
    return StepResult(point, accepted, count)

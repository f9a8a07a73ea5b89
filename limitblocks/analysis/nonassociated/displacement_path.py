"""A path in displacements: rigid blocks on elastic contact points are pushed until they collapse.

    dead + a live = C^T x(C u),   live . u = tau

x(e) are the forces of contact points at strains e, x0 at the permanent loads, with rounded corners of yield
(:mod:`limitblocks.analysis.nonassociated.contact_points`). Where tau grows without limit and x stands still,
u / tau is the mechanism of Eqs (54)-(59) for rounded yield, and rounds of the fixed point lead to that of
yield itself. The curve folds where the structure snaps, and is followed by arclength as the tracked path is,
in the energy of the joints. There is neither slack nor multiplier: points that open or carry next to nothing,
whose rows start and stop to yield all the time, do not shorten its steps, as they do those of the tracked
path.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from limitblocks.analysis.nonassociated.contact_points import ContactPoints, contact_points
from limitblocks.analysis.nonassociated.path_layout import Layout
from limitblocks.analysis.nonassociated.path_newton import sign_of
from limitblocks.analysis.polish import defect
from limitblocks.arrays import Array
from limitblocks.evidence.elimination import Factors
from limitblocks.evidence.residuals import TOLERANCE
from limitblocks.evidence.results import Iteration
from limitblocks.problem import Flow, State

ROUNDED = 0.01  # of the unit of force of an interface: sharper corners have more folds, rounder ones, too
FIRST, LEAST, LONGEST = 0.1, 1e-7, 1.0  # lengths of steps, of the displacements so far
CUT = 0.35  # of the length after a failure
PACE = (2.0, 2.0, 2.0, 1.4, 1.0, 1.0, 0.7)  # of the length after so many corrections
FARTHEST = 3.0  # lengths that a correction may have
CLOSE = 1e-3  # of the length of a step: a correction shorter than this is the last
AHEAD, STILL = 10.0, 1e-3  # times tau in which the load factor of a collapse changes by no more than this
DRIFT = 5e-3  # of the load factor: farther off a solution is not where the path leads
BUDGET = 900  # factorisations: facades and houses of 160 to 508 blocks that arrive take 116 to 875


class Move(NamedTuple):
    """Displacements (6 n,), load factor and tau of a point, or of a direction."""

    u: Array
    load_factor: float
    tau: float

    def plus(self, t: float, other: Move) -> Move:
        """Return the sum with t times another."""
        return Move(self.u + t * other.u, self.load_factor + t * other.load_factor, self.tau + t * other.tau)


class Met(NamedTuple):
    """A point of the path; tangent, sign of the determinant and corrections before the last one."""

    point: Move
    tangent: Move
    sign: float
    corrections: int


class DisplacementPath:
    """The path of a problem with contact points on the way: its last point, and what is worth telling."""

    def __init__(self, flow: Flow, points: ContactPoints, scale: float) -> None:
        self.flow, self.points, self.layout = flow, points, Layout(flow)
        p, k = flow.problem, len(points.friction)
        self.cell = np.minimum(self.layout.cell_stresses[:, 0] // 3, k)  # the last one is empty
        self.factorisations = 0
        factors = self._factors(points.forces(np.zeros((k, 3)))[1])
        elastic, _ = self._directions(factors, np.zeros_like(p.dead), 0.0)
        work = elastic.load_factor  # per tau**2
        if not work > 0.0:
            raise ValueError("the live load does no work on the elastic structure")
        self.unit = scale, scale / work
        self.energy = scale**2 / work
        self.at = Move(np.zeros_like(p.dead), 0.0, 0.0)
        self.start = Met(self.at, elastic, sign_of(factors.factors), 0)

    def state(self, at: Move) -> State:
        """Return a point as a state of rates; that of the permanent loads has none."""
        x = self._forces(at)[0]
        return State(at.load_factor, x, at.u / (at.tau or 1.0), np.zeros_like(self.flow.problem.g))

    def _forces(self, at: Move) -> tuple[Array, Array]:
        forces, slope = self.points.forces((self.flow.problem.C @ at.u).reshape(-1, 3))
        return forces.ravel(), slope

    def _factors(self, slope: Array) -> Factors:
        """Factors of [[-K, live], [live^T, 0]], K = C^T dx/de C."""
        C = self.layout.compatibility
        cells = np.concatenate([slope, np.zeros_like(slope[:1])])[self.cell]
        self.factorisations += 1
        return self.layout.factors(np.swapaxes(C, 1, 2) @ (self.layout.by_interface(cells) @ C))

    def _directions(self, factors: Factors, left: Array, short: float) -> list[Move]:
        """The tangent, and the correction of loads (6 n,) that are left and of what tau is short of."""
        right = np.zeros((len(left) + 1, 2))
        right[-1, 0], right[:-1, 1], right[-1, 1] = 1.0, left, short
        found = np.ascontiguousarray(factors.solve(right).T)
        return [Move(d[:-1], float(d[-1]), tau) for d, tau in zip(found, (1.0, 0.0), strict=True)]

    def points_met(self, record: Callable[[Iteration], None]) -> Iterator[Move]:
        """Follow the path from the permanent loads, and give each of its points, until no step succeeds."""
        at, first, length, failures = self.start, self.start.sign, FIRST, 0
        at = self.corrected(at.point, at.tangent, CLOSE, np.inf) or at  # rounded corners carry less
        while self.factorisations < BUDGET and length > LEAST:
            size = length * max(1.0, self.product(at.point, at.point) ** 0.5)
            step = at.sign * first * size / self.product(at.tangent, at.tangent) ** 0.5
            found = self.corrected(at.point.plus(step, at.tangent), at.tangent, CLOSE * size, FARTHEST * size)
            if found is None:
                length, failures = CUT * length, failures + 1
                continue
            at, self.at = found, found.point
            length = min(PACE[min(at.corrections, len(PACE) - 1)] * length, LONGEST)
            theta = self.unit[1] / max(abs(self.at.tau), self.unit[1])
            load_factor = float(self.at.load_factor / self.flow.problem.units.live)
            record(Iteration(load_factor, "path", theta, {"theta": theta}, self.factorisations, failures))
            yield self.at

    def product(self, a: Move, b: Move) -> float:
        """Return the product of two directions: the energy of elastic joints, and of load factors."""
        C, stiffness = self.flow.problem.C, self.points.stiffness.ravel()
        energy = (C @ a.u) @ (stiffness * (C @ b.u)) / self.energy
        return np.float64(energy + a.load_factor * b.load_factor / self.unit[0] ** 2)  # infinite over zero

    def corrected(self, z: Move, along: Move, near: float, longest: float) -> Met | None:
        """Return the point of the path in the plane through z normal to a direction, None if none is met.

        Corrections end with one shorter than `near`; none may be as long as `longest`.
        """
        p, first = self.flow.problem, z
        for k in range(len(PACE) + 2):
            x, slope = self._forces(z)
            try:
                factors = self._factors(slope)
            except (RuntimeError, ValueError):  # SuperLU: singular, or not finite
                return None
            left = p.balance @ x - p.dead - z.load_factor * p.live
            turn, step = self._directions(factors, left, float(z.tau - p.live @ z.u))
            off = self.product(along, z.plus(-1.0, first).plus(1.0, step))
            step = step.plus(-off / self.product(along, turn), turn)
            size = self.product(step, step) ** 0.5
            if not size < longest:  # or not a number
                return None
            z = z.plus(1.0, step)
            if size < near:
                return Met(z, turn, sign_of(factors.factors), k)
        return None


@np.errstate(all="ignore")  # a point that ran away is not accepted
def pushed_over(
    flow: Flow,
    x0: Array,
    scale: float,
    closing: Callable[[State], State],
    record: Callable[[Iteration], None],
) -> tuple[State, bool] | None:
    """Follow the path to a collapse and close it there; None if the problem is not one of contact points.

    Parameters
    ----------
    flow : Flow
        The limit problem and its flow rule, without dilatancy.
    x0 : Array, shape (s,)
        Stresses under the permanent loads, dimensionless.
    scale : float
        Load factor that steps are measured by, dimensionless.
    closing : callable
        Leads from a state near a solution to it.
    record : callable
        Told of each point.

    Returns
    -------
    State, bool
        The solution or the state that rounds from the end lead to, and whether the user stopped it.
    """
    points = contact_points(flow, x0, ROUNDED)
    if points is None:
        return None
    try:
        path, met = DisplacementPath(flow, points, scale), list[Move]()
    except (RuntimeError, ValueError):  # SuperLU: singular
        return None
    solution = None
    try:
        for at in path.points_met(record):
            met.append(at)
            if _collapses(met):
                found = closing(path.state(at))
                if defect(flow, found) <= TOLERANCE:
                    solution = found
                    if abs(found.load_factor - at.load_factor) <= DRIFT * abs(at.load_factor):
                        break
                met.clear()
        return solution or closing(path.state(path.at)), False
    except KeyboardInterrupt:
        return solution or path.state(path.at), True


def _collapses(met: list[Move]) -> bool:
    """Whether the load factor stood still while tau grew to a multiple."""
    now = met[-1]
    before = [at for at in met if 0.0 < at.tau <= now.tau / AHEAD]
    return bool(before) and abs(now.load_factor - before[-1].load_factor) <= STILL * abs(now.load_factor)

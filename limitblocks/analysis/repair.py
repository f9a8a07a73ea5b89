"""States brought into exact equilibrium and flow, and mechanisms that open every joint: what a proof mixes.

Reduced by the mirror of the problem, if there is one: lifted they are what they would be in the whole one,
whose proof judges them.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse

from limitblocks.analysis.compiled import Programs
from limitblocks.analysis.forms import form_of
from limitblocks.analysis.programs import NEARLY, ROUGH, Solver, solvers
from limitblocks.analysis.scales import Projection, Scaled, compatible, compatible_with, scaled
from limitblocks.arrays import Array, Indices
from limitblocks.problem import LimitProblem, State
from limitblocks.problem.plane import Planar


@dataclass(frozen=True, eq=False)
class Repair:
    """Repairs in the whole problem, given in units of its own."""

    p: Scaled
    problem: LimitProblem | None = None
    programs: Programs | None = None  # of that problem, compiled already
    quick: bool = True  # a mechanism that opens all joints about alike is found in few iterations
    everywhere: float = 0.1  # of the joint that lacks most: the least that a joint is opened

    @cached_property
    def projection(self) -> Projection:
        """Onto equilibrium."""
        return Projection(self.p.C)

    def balanced(self, load_factor: float, x: Array) -> Array:
        """Return the nearest stresses that balance the loads, to rounding."""
        p = self.p
        return p.stress * self.projection.onto(p.dead + load_factor / p.load_factor * p.live, x / p.stress)

    def following(self, u: Array, y: Array) -> Array:
        """Return the nearest multipliers that satisfy the flow rule with the rates, to rounding."""
        return following(self.p, u, y)

    def opened(self, amount: Array) -> tuple[Array, Array]:
        """Return rates and multipliers of a mechanism that opens every joint by about `amount` (R,)."""
        first = (ROUGH,) if self.quick else ()
        if self.problem is not None and self.programs is not None:
            there = self._there(self.problem, self.programs.form.problem, amount)
            for solver in first or (NEARLY,):
                found = self._at_once(self.problem, self.programs, there, solver)
                if found is not None:
                    return found
        return opening(self.p, amount * self.p.row / self.p.load_factor, first)

    def _there(self, problem: LimitProblem, q: Scaled, amount: Array) -> Array:
        """The amount in units of the programs at hand: at least `everywhere` of the most, as units differ."""
        own, nothing = self.p.problem, np.zeros(len(self.p.stress))
        given = problem.dimensionless(own.in_si(State(0.0, nothing, np.zeros(len(own.dead)), amount)))
        there, heads = given.y * q.row / q.load_factor, q.cones.heads
        there[heads] = np.maximum(there[heads] / there.max(), self.everywhere)
        return there

    def _at_once(
        self, problem: LimitProblem, programs: Programs, there: Array, solver: Solver
    ) -> tuple[Array, Array] | None:
        """The mechanism by the programs at hand; None where it opens not every joint."""
        own, nothing = self.p.problem, np.zeros(len(self.p.stress))
        _, u, y = programs.opening(there, solver)
        found = own.dimensionless(problem.in_si(programs.form.problem.in_problem(State(0.0, nothing, u, y))))
        y = following(self.p, found.u, found.y)
        return (found.u, y) if own.cones.margin(y).min() > 0.0 else None


@dataclass(frozen=True, eq=False)
class PlanarRepair:
    """The same in the plane of a problem or in one half, for states that its mirror leaves as they are."""

    whole: LimitProblem
    plane: Planar
    half: Repair

    @property
    def everywhere(self) -> float:
        """Of the joint that lacks most: the least that a joint is opened."""
        return self.half.everywhere

    def balanced(self, load_factor: float, x: Array) -> Array:
        """Return the nearest stresses that balance the loads, to rounding."""
        plane = self.plane
        return np.asarray(plane.stresses @ self.half.balanced(load_factor / plane.live, plane.stresses_of(x)))

    def following(self, u: Array, y: Array) -> Array:
        """Return the nearest multipliers that satisfy the flow rule with the rates, to rounding."""
        plane = self.plane
        state = plane.averaged(State(0.0, np.zeros(self.whole.C.shape[0]), u, y))
        return np.asarray(plane.live * (plane.multipliers @ self.half.following(state.u, state.y)))

    def opened(self, amount: Array) -> tuple[Array, Array]:
        """Return rates and multipliers of a mechanism that opens every joint by about `amount` (R,).

        Where one exists, a symmetric one does.
        """
        plane, problem = self.plane, self.plane.problem
        M = sparse.csc_array(abs(plane.multipliers))
        least = np.asarray(M.multiply(amount[:, None]).max(axis=0).toarray()).ravel()
        left_out = np.diff(sparse.csr_array(M).indptr) == 0
        theirs = np.zeros(len(problem.interfaces))
        np.maximum.at(theirs, self.interface[left_out], amount[left_out])
        least = np.maximum(least, theirs[problem.row_interface])
        u, y = self.half.opened(least * problem.cones.identity)
        return plane.live * (plane.rates @ u), plane.live * self._everywhere(y, left_out.any())

    @cached_property
    def interface(self) -> Indices:
        """Interface of the reduced problem that each row of the whole one belongs to, shape (R,)."""
        M, m = self.plane.multipliers.tocoo(), len(self.whole.interfaces)
        reduced = np.zeros(m, dtype=np.int64)
        reduced[self.whole.row_interface[M.row]] = self.plane.problem.row_interface[M.col]
        return np.asarray(reduced[self.whole.row_interface])

    def _everywhere(self, y: Array, needed: bool) -> Array:
        """Multipliers of the whole problem, rows that were left out as implied among them.

        At each interface a share of one for every row replaces what reduced rows do the same with.
        """
        plane, p = self.plane, self.plane.problem
        if not needed:
            return np.asarray(plane.multipliers @ y)
        one = self.whole.cones.identity
        same = compatible_with(p.F, plane.stresses.T @ (self.whole.F.T @ one))
        takes = same[p.cones.heads] + p.cones.norm(same * (1.0 - p.cones.identity))
        room = np.where(takes > 0.0, p.cones.margin(y) / np.where(takes > 0.0, takes, 1.0), np.inf)
        share = np.full(len(p.interfaces), np.inf)
        np.minimum.at(share, p.member_interface, room / 2.0)
        share = np.where(np.isfinite(share), share, 0.0)
        kept = plane.multipliers @ (y - share[p.row_interface] * same)
        return np.asarray(kept + share[self.interface] * one)


def planar_repair(whole: LimitProblem, plane: Planar, programs: Programs | None) -> PlanarRepair:
    """Return the repairs in the plane or in one half, in units of the whole problem."""
    measured = plane.measured(whole)
    how = (False, 1e-2) if plane.flat else (True, Repair.everywhere)
    return PlanarRepair(whole, measured, Repair(scaled(measured.problem), plane.problem, programs, *how))


def following(p: Scaled, u: Array, y: Array) -> Array:
    """The nearest multipliers that satisfy the flow rule with the rates, to rounding."""
    rates, multipliers = u * p.equation / p.load_factor, y * p.row / p.load_factor
    if not (np.isfinite(rates).all() and np.isfinite(multipliers).all()):
        return np.full_like(y, np.nan)
    return np.asarray(compatible(p, rates, multipliers) * p.load_factor / p.row)


def opening(p: Scaled, amount: Array, first: tuple[Solver, ...] = ()) -> tuple[Array, Array]:
    """Rates and multipliers of a mechanism that opens the joints by about `amount` (R,) at the least power.

    Not finite where there is none, exactly where the structure can be wedged: where C^T x = 0 with F x in K,
    F x not zero (theorem of alternatives; Boyd & Vandenberghe 2004, Section 5.8).
    """
    programs = Programs(form_of(p))
    for solver in (*first, NEARLY, solvers(bool(p.cones.second_order))[0]):
        _, u, y = programs.opening(amount, solver)
        state = p.in_problem(State(0.0, np.zeros(len(p.stress)), u, y))
        y = following(p, state.u, state.y)
        if p.cones.margin(y).min() > 0.0:  # not where it is NaN
            return state.u, y
    return np.full(p.C.shape[1], np.nan), np.full(p.F.shape[0], np.nan)

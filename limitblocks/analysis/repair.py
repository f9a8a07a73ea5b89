"""States brought into exact equilibrium and flow, and mechanisms that open every joint: what a proof mixes.

Reduced by the mirror of the problem, if there is one: lifted they are what they would be in the whole one,
whose proof judges them.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from limitblocks.analysis.interior import opening_where_it_can
from limitblocks.analysis.scales import Projection, compatible_with
from limitblocks.analysis.splitting import Splitting
from limitblocks.arrays import Array, Flags, Indices
from limitblocks.problem import LimitProblem
from limitblocks.problem.plane import Planar

EVERYWHERE = 1e-2  # of the joint that lacks most: the least that a joint is opened


@dataclass(frozen=True, eq=False)
class Repair:
    """Repairs of states in units of the problem; joints where the stresses do not `carry` (s,) have none."""

    splitting: Splitting
    carry: Flags

    def balanced(self, load_factor: float, x: Array) -> Array:
        """Return the nearest stresses that balance the loads, to rounding."""
        p = self.splitting.p
        loads = p.dead + load_factor / p.load_factor * p.live
        return p.stress * self._onto.onto(loads, self.carry * x / p.stress)

    @cached_property
    def _onto(self) -> Projection:
        return self.splitting.at(self.carry)

    def following(self, u: Array, y: Array) -> Array:
        """Return the nearest multipliers that satisfy the flow rule with the rates, to rounding."""
        p = self.splitting.p
        return self.splitting.following(u / p.rate, y / p.multiplier) * p.multiplier

    def opened(self, amount: Array) -> tuple[Array, Array]:
        """Return rates and multipliers of a mechanism that opens every joint by about `amount` (R,).

        NaN where none was found, as where the structure can be wedged: where C^T x = 0 with F x in K, F x not
        zero (theorem of alternatives; Boyd & Vandenberghe 2004, Section 5.8).
        """
        p = self.splitting.p
        there = amount / p.multiplier
        there[p.cones.heads] = np.maximum(there[p.cones.heads] / there.max(), EVERYWHERE)
        found = self.splitting.mechanism(there) or opening_where_it_can(self.splitting, there)
        if found is None:
            return np.full_like(p.dead, np.nan), np.full_like(amount, np.nan)
        u, y = found
        return u * p.rate, self.splitting.following(u, y) * p.multiplier


@dataclass(frozen=True, eq=False)
class PlanarRepair:
    """The same in the plane of a problem or in one half, for states that its mirror leaves as they are."""

    whole: LimitProblem
    plane: Planar
    half: Repair

    def balanced(self, load_factor: float, x: Array) -> Array:
        """Return the nearest stresses that balance the loads, to rounding."""
        plane = self.plane
        return np.asarray(plane.stresses @ self.half.balanced(load_factor / plane.live, plane.stresses_of(x)))

    def following(self, u: Array, y: Array) -> Array:
        """Return the nearest multipliers that satisfy the flow rule with the rates, to rounding."""
        plane = self.plane
        found = self.half.following(plane.rates_of(u), plane.multipliers_of(y))
        return np.asarray(plane.live * (plane.multipliers @ found))

    def opened(self, amount: Array) -> tuple[Array, Array]:
        """Return rates and multipliers of a mechanism that opens every joint by about `amount` (R,).

        Where one exists, a symmetric one does.
        """
        plane, problem = self.plane, self.plane.problem
        M, least = plane.multipliers, np.zeros(len(problem.g))
        np.maximum.at(least, M.indices, np.abs(M.data) * np.repeat(amount, np.diff(M.indptr)))
        left_out = np.diff(M.indptr) == 0
        theirs = np.zeros(len(problem.interfaces))
        np.maximum.at(theirs, self.interface[left_out], amount[left_out])
        least = np.maximum(least, theirs[problem.row_interface])
        u, y = self.half.opened(least * problem.cones.identity)
        return plane.live * (plane.rates @ u), plane.live * self._everywhere(y, left_out.any())

    @cached_property
    def interface(self) -> Indices:
        """Interface of the reduced problem that each row of the whole one belongs to, shape (R,)."""
        M, reduced = self.plane.multipliers, np.zeros(len(self.whole.interfaces), dtype=np.int64)
        whole = np.repeat(self.whole.row_interface, np.diff(M.indptr))
        reduced[whole] = self.plane.problem.row_interface[M.indices]
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

"""How far each row of a state is from its limit, as a relative change of what the row can carry.

A row F x + g = strength - demand. Its strength is what scales with friction, the part of F that the flow
drops, F - G; of a row that flows along its gradient (hinging, opening) it is the normal force, which scales
with the distance of the edge. To scale the strength of the rows Eqs (23)-(30) by 1 + e is to scale friction
and cohesion in them; that of Eq. (36) or (39) is to put the edge at 1 + e of its distance.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array, Flags
from limitblocks.problem import LimitProblem, in_units

ROUNDING = 4 * np.finfo(float).eps  # of the terms of a row: no change of strength makes up for it


@dataclass(frozen=True, eq=False)
class Limits:
    """The strength of the rows of a problem, F x + g = strength x + constant - demand.

    Attributes
    ----------
    problem : LimitProblem
        The problem.
    """

    problem: LimitProblem

    @cached_property
    def parabolic(self) -> tuple[Flags, ...]:
        """Of each group of cones: second row minus the first, as in Eq. (39), N^2 <= a s."""
        p = self.problem
        flags = []
        for places in p.cones.groups:
            head = p.F[places[:, 0]]
            against = p.F[places[:, min(1, places.shape[1] - 1)]]
            flags.append(np.asarray(abs(head + against).sum(axis=1)).ravel() == 0.0)
        return tuple(flags)

    @cached_property
    def sign(self) -> Array:
        """1 for linear rows and first rows of cones, -1 for the second ones of parabolas, else 0, (R,)."""
        sign = self.problem.cones.identity.copy()
        for places, parabola in zip(self.problem.cones.groups, self.parabolic, strict=True):
            sign[places[parabola, 1:2]] = -1.0
        return sign

    @cached_property
    def strength(self) -> sparse.csr_array:
        """The part of F that is strength, shape (R, s); zero for rows that only name a demand."""
        p = self.problem
        dropped = sparse.csr_array(p.F - p.G)  # scipy leaves zeros out
        drops = np.diff(dropped.indptr) > 0
        normal = np.zeros(p.F.shape[1])
        normal[p.resultants[2::6].indices] = 1.0
        rubbing, along = (1.0 * (these & (self.sign != 0.0)) for these in (drops, ~drops))
        return sparse.csr_array(in_units(dropped, rubbing, normal) + in_units(p.F, along, normal))

    @cached_property
    def constant(self) -> Array:
        """The part of g that is strength, shape (R,); the unit of force in Eq. (39) as a cone is none."""
        g = np.where(self.sign > 0.0, self.problem.g, 0.0)
        for places, parabola in zip(self.problem.cones.groups, self.parabolic, strict=True):
            first, second = places[parabola, 0], places[parabola, 1:2].ravel()
            g[first] = (self.problem.g[first] - self.problem.g[second]) / 2.0
            g[second] = -g[first]
        return g

    @cached_property
    def _sizes(self) -> sparse.csr_array:
        return abs(self.problem.F)

    def changes(self, x: Array) -> Array:
        """Return the relative change of strength that takes each linear row and cone to yield, (degree,).

        Negative where the row holds back more than it needs to; infinite where there is no strength to scale,
        or no strength would be little enough.
        """
        p = self.problem
        heads = p.cones.heads
        s, strength = p.F @ x + p.g, (self.strength @ x + self.constant)[heads]
        lacking = -p.cones.margin(s)
        first = p.cones.linear
        for places, parabola in zip(p.cones.groups, self.parabolic, strict=True):
            v = s[places]
            gap = v[:, 0] - v[:, 1] if v.shape[1] > 1 else v[:, 0]
            total = np.where(parabola, v[:, 0] + v[:, min(1, v.shape[1] - 1)], 1.0)  # a constant
            bent = ((v[:, 2:] ** 2).sum(axis=1) / total - gap) / 2.0
            at = slice(first, first + len(v))
            lacking[at] = np.where(parabola, bent, lacking[at])
            first += len(v)
        terms = (self._sizes @ np.abs(x) + np.abs(p.g))[heads]
        lacking = np.where(np.abs(lacking) <= ROUNDING * terms, 0.0, lacking)
        change = np.where(lacking == 0.0, 0.0, np.copysign(np.inf, lacking))
        np.divide(lacking, strength, out=change, where=(strength > 0.0) & (lacking != 0.0))
        return np.where(change < -1.0, -np.inf, change)

    def rows(self, x: Array, change: Array) -> Array:
        """Return F x + g of the problem that `scaled` makes, shape (R,)."""
        p = self.problem
        return np.asarray(p.F @ x + p.g + change[p.cones.member] * (self.strength @ x + self.constant))

    def scaled(self, change: Array) -> LimitProblem:
        """Return the problem with the strength of each linear row and cone scaled by 1 + change (degree,)."""
        p = self.problem
        by = change[p.cones.member]
        F = sparse.csr_array(p.F + sparse.diags_array(by) @ self.strength)
        return replace(p, F=F, g=np.asarray(p.g + by * self.constant))

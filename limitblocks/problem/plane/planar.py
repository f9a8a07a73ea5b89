"""What lifts states of a problem reduced by its mirror plane back to the whole one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from limitblocks.arrays import Array, Indices
from limitblocks.problem.cones import Cones
from limitblocks.problem.limit_problem import LimitProblem, State, Units, in_units
from limitblocks.problem.plane.rounding import EXACT

SYMMETRIC = 1e-9  # of the largest stress: stresses farther from their mirror image are not symmetric


@dataclass(frozen=True, eq=False)
class Planar:
    """A limit problem in its plane, or one half of it, and what lifts its states back.

    Attributes
    ----------
    problem : LimitProblem
        The reduced problem.
    stresses : csr_array, shape (s, s')
        x of the whole problem = stresses x'.
    rates : csr_array, shape (6 n, 6 n')
        u = rates u'.
    multipliers : csr_array, shape (R, R')
        y = multipliers y'.
    blocks : Indices, shape (n',)
        The blocks of the reduced problem among all.
    flat : bool
        Whether everything acts parallel to the plane.
    units : Units
        Of the whole problem.
    live : float
        Unit of the live load of the whole problem over that of the reduced one.
    """

    problem: LimitProblem
    stresses: sparse.csr_array
    rates: sparse.csr_array
    multipliers: sparse.csr_array
    blocks: Indices
    flat: bool
    units: Units
    live: float = 1.0

    def lifted(self, state: State) -> State:
        """Return a state of the reduced problem as one of the whole."""
        return State(
            self.live * state.load_factor,
            self.stresses @ state.x,
            self.live * (self.rates @ state.u),
            self.live * (self.multipliers @ state.y),
        )

    def averaged(self, state: State) -> State:
        """Return the mean of a state of the whole problem and its mirror image as a reduced one."""
        return State(
            state.load_factor / self.live,
            self.stresses_of(state.x),
            self.rates_of(state.u),
            self.multipliers_of(state.y),
        )

    def measured(self, whole: LimitProblem) -> Planar:
        """Return the same for the whole problem in other units of force."""
        old, problem = self.problem, self.problem.measured(whole.units.block_force[self.blocks])

        def changed(
            matrix: sparse.csr_array, unit: Callable[[LimitProblem, Units], Array]
        ) -> sparse.csr_array:
            rows = unit(whole, self.units) / unit(whole, whole.units)
            columns = unit(problem, problem.units) / unit(problem, old.units)
            return in_units(matrix, rows, columns)

        return replace(
            self,
            problem=problem,
            stresses=changed(self.stresses, lambda p, units: units.interface_force[p.stress_interface]),
            rates=changed(self.rates, lambda _, units: 1.0 / units.loads),
            multipliers=changed(
                self.multipliers, lambda p, units: 1.0 / units.interface_force[p.row_interface]
            ),
            units=whole.units,
            live=whole.units.live / problem.units.live,
        )

    def barrier_of(self, cones: Cones) -> Array:
        """Return how many logarithms of the cone K of the whole problem each reduced row stands for, (R',).

        Rows merged in their mean stand for as many as they are. A cone of which z keeps one direction is two
        rows, t + z > 0 and t - z > 0, and log(t^2 - z^2) / 2 the sum of half their logarithms. One of which z
        vanishes is the row t > 0.
        """
        weights = abs(self.multipliers)
        count = np.asarray((weights[cones.heads] > 0.0).sum(axis=0)).ravel().astype(float)
        tails = np.setdiff1d(np.arange(cones.height), cones.heads)
        directed = np.asarray((weights[tails] > 0.0).sum(axis=0)).ravel() > 0
        line = np.arange(len(count)) < self.problem.cones.linear
        return np.where(directed & line, count / 2.0, count)

    def compliance_of(self, weights: Array) -> Array | None:
        """Return the compliance of reduced stresses from that of all, (s,); None where it is not symmetric.

        Only then elastic strains of symmetric stresses are symmetric, too.
        """
        S = self.stresses
        own = S.power(2).T @ weights
        off = sparse.diags_array(weights) @ S - S @ sparse.diags_array(own / self._lengths)
        return None if abs(off).max() > EXACT * weights.max() else own

    def stresses_of(self, x: Array) -> Array:
        """Return stresses of the whole problem, averaged with their mirror image, as reduced ones."""
        return np.asarray(self.stresses.T @ x / self._lengths)

    def symmetric(self, x: Array) -> bool:
        """Whether stresses of the whole problem are their own mirror image."""
        off = np.abs(self.stresses @ self.stresses_of(x) - x).max(initial=0.0)
        return bool(off <= SYMMETRIC * np.abs(x).max(initial=0.0))

    @cached_property
    def _lengths(self) -> Array:
        return _lengths(self.stresses)

    def rates_of(self, u: Array) -> Array:
        """Return rates of the whole problem, averaged with their mirror image, as reduced ones."""
        return np.asarray(self.rates.T @ u / _lengths(self.rates) / self.live)

    def multipliers_of(self, y: Array) -> Array:
        """Return the reduced multipliers nearest to those of the whole problem.

        So go those of rows that others imply.
        """
        M = self.multipliers
        if np.diff(M.indptr).max(initial=0) <= 1:  # no row is part of two
            return np.asarray(M.T @ y / _lengths(M) / self.live)
        return np.asarray(linalg.splu(sparse.csc_array(M.T @ M)).solve(M.T @ y) / self.live)


def _lengths(matrix: sparse.csr_array) -> Array:
    """Squared lengths of the columns, one for nothing."""
    found = matrix.power(2).sum(axis=0)
    return np.where(found > 0.0, found, 1.0)

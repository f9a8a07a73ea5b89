"""What a state is measured by: every block by what acts on it, every rate by what it is worth.

Nothing is measured by a mean. What acts on a block is the sum of the sizes of its loads and of its
interfaces' forces, as far as loads can be behind them: a block wedged between others may be under any
self-stress, and an imbalance must not hide behind it. An interface is measured by what acts on the lesser of
its blocks; a rate by the power that this force does on it, over the power of the live load: by what it is
worth in the load factor. Nor may a drift that costs nothing make that power large.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from limitblocks.arrays import Array
from limitblocks.problem import LimitProblem, State

# Of the power of all forces on the mechanism: smaller load factors are known to it times the tolerance.
SMALL_POWER = 1e-7
FASTEST = 1e3  # rate of a block over that at which the live loads do their work: more counts as this
# Of the loads of all that it is tied to: within 1e-8 of less, on a block without loads, is rounding of these.
FAINT = np.finfo(float).eps / 1e-8
ROUNDING = 1e-9  # of that power over the tolerance: load factors smaller than rounding errors


@dataclass(frozen=True, eq=False)
class Measure:
    """What a state is measured by; see the module."""

    problem: LimitProblem
    state: State

    @cached_property
    def slack(self) -> Array:
        """F x + g, shape (R,)."""
        return np.asarray(self.problem.F @ self.state.x + self.problem.g)

    @cached_property
    def unbalanced(self) -> Array:
        """Loads that the stresses leave, shape (6 n,)."""
        p, z = self.problem, self.state
        return np.asarray(p.dead + z.load_factor * p.live - p.balance @ z.x)

    @cached_property
    def broken(self) -> Array:
        """Strain rates C u + F^T y that break the associated flow rule, shape (s,)."""
        p, z = self.problem, self.state
        return np.asarray(p.C @ z.u + p.F.T @ z.y)

    @cached_property
    def loads(self) -> Array:
        """Sizes of the loads, shape (6 n,)."""
        p = self.problem
        return np.asarray(np.abs(p.dead) + np.abs(self.state.load_factor * p.live))

    @cached_property
    def together(self) -> Array:
        """Loads of all that each block is tied to, in its unit of force, shape (n,)."""
        p = self.problem
        own = self.loads.reshape(-1, 6).sum(axis=1) * p.units.block_force
        return np.asarray(np.bincount(p.parts, weights=own)[p.parts] / p.units.block_force)

    @cached_property
    def block(self) -> Array:
        """What acts on each block, in its unit, (n,); at least FAINT of all loads where none does."""
        acting = (self.problem.acting @ np.abs(self.state.x) + self.loads).reshape(-1, 6).max(axis=1)
        loaded = self.loads.reshape(-1, 6).any(axis=1)
        return np.asarray(np.where(loaded, acting, np.maximum(acting, FAINT * self.together)))

    @cached_property
    def loaded(self) -> Array:
        """What acts on each block, at most the loads of all it is tied to; its unit without any, (n,)."""
        return np.where(self.together == 0.0, 1.0, np.minimum(self.block, self.together))

    @cached_property
    def interface(self) -> Array:
        """What acts on the lesser of the free blocks of each interface, in its unit of force, (m,)."""
        p, force = self.problem, self.loaded * self.problem.units.block_force
        least = np.where(p.ends >= 0, force[p.ends], np.inf).min(axis=1)
        return np.asarray(least / p.units.interface_force)

    @cached_property
    def pressed(self) -> Array:
        """The most that acts on a block tied to those of each interface, in its unit of force, (m,).

        A light stone between heavy ones stops them: moving into it is no small error of the mechanism.
        """
        p, force = self.problem, self.loaded * self.problem.units.block_force
        most = np.zeros(p.parts.max() + 1)
        np.maximum.at(most, p.parts, force)
        return np.asarray(most[p.parts[p.ends.max(axis=1)]] / p.units.interface_force)

    @cached_property
    def everything(self) -> float:
        """Power of all forces on the mechanism."""
        rates = np.abs(self.state.u.reshape(-1, 6)).max(axis=1)
        return float(self.loaded @ np.minimum(rates, FASTEST))

    @cached_property
    def power(self) -> float:
        """Power of the live load, or SMALL_POWER of that of all forces where it is less."""
        return max(abs(self.state.load_factor), SMALL_POWER * self.everything)

    @property
    def load_factor(self) -> float:
        """Size of the load factor, or rounding errors of the power of all forces where it is less."""
        return max(abs(self.state.load_factor), ROUNDING * self.everything)


def without_rounding(problem: LimitProblem, state: State, upper: float = 0.0) -> tuple[State, float]:
    """Return a state and an upper load factor, zero where rounding of the power of all forces is as large."""
    rounding = np.finfo(float).eps * Measure(problem, state).everything
    lower, upper = (a if abs(a) > rounding else 0.0 for a in (state.load_factor, upper))
    return replace(state, load_factor=lower), upper

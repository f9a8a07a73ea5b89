"""Units in which the programs of limit analysis are solved: every number near one in the solution.

Friction 1e-6 leaves shears, level forces and vertical rates a millionth of all others: absolute tolerances
of a solver take them for zero, and the load factor with them. Shears are therefore measured in friction times
the force of their interface; and, once a state is known, each interface by its own force, each equation of
equilibrium by what acts in it, the load factor by itself. The rates are dual to that.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse

from limitblocks.analysis.definite import solver_of
from limitblocks.arrays import Array
from limitblocks.evidence.measure import ROUNDING, Measure
from limitblocks.problem import Cones, LimitProblem, State, in_units, power_of_two

UNLOADED = 1e-3  # of what acts on the lesser block: the least unit of force of an interface
IDLE = 1e-6  # of what acts on a block: the least unit of one of its equations
COARSER = 16.0  # a unit off by more is changed, and the programs solved again


@dataclass(frozen=True, eq=False)
class Scaled:
    """The numbers of a limit problem with x, equations and load factor in units of their own.

    Attributes
    ----------
    problem : LimitProblem
        In its own units, in which states are given and returned.
    force : Array, shape (m,)
        Unit of force of each interface.
    equation : Array, shape (6 n,)
        Unit of each equation of equilibrium.
    load_factor : float
        Unit of the load factor.
    """

    problem: LimitProblem
    force: Array
    equation: Array
    load_factor: float

    @cached_property
    def stress(self) -> Array:
        """Unit of each generalised stress, shape (s,)."""
        return self.force[self.problem.stress_interface] * frictional(self.problem)

    @cached_property
    def row(self) -> Array:
        """Powers of two that bring the largest entry of each linear row and each cone near one, (R,)."""
        p = self.problem
        member, largest = np.repeat(p.cones.member, np.diff(p.F.indptr)), np.zeros(p.cones.degree)
        np.maximum.at(largest, member, np.abs(p.F.data) * self.stress[p.F.indices])
        return unit(largest)[p.cones.member]

    @cached_property
    def rate(self) -> Array:
        """Unit of each displacement rate, shape (6 n,)."""
        return self.load_factor / self.equation

    @cached_property
    def multiplier(self) -> Array:
        """Unit of each flow multiplier, shape (R,)."""
        return self.load_factor / self.row

    @cached_property
    def C(self) -> sparse.csr_array:
        """Compatibility matrix, shape (s, 6 n)."""
        return in_units(self.problem.C, self.stress, 1.0 / self.equation)

    @cached_property
    def F(self) -> sparse.csr_array:
        """Yield rows, shape (R, s)."""
        return in_units(self.problem.F, 1.0 / self.row, self.stress)

    @cached_property
    def g(self) -> Array:
        """Constant terms of the yield rows, shape (R,)."""
        return self.problem.g / self.row

    @cached_property
    def dead(self) -> Array:
        """Dead loads, shape (6 n,)."""
        return self.problem.dead / self.equation

    @cached_property
    def live(self) -> Array:
        """Live loads, shape (6 n,)."""
        return self.problem.live * self.load_factor / self.equation

    @property
    def cones(self) -> Cones:
        """The cone K, the same in all units."""
        return self.problem.cones

    @cached_property
    def margin(self) -> Array:
        """One in the unit of force of each interface, at the centre of the cone, shape (R,)."""
        p = self.problem
        return p.cones.identity * self.force[p.row_interface] / (p.units.row * self.row)

    def in_problem(self, state: State) -> State:
        """Return a state of these numbers in the units of the problem."""
        return State(
            state.load_factor * self.load_factor,
            state.x * self.stress,
            state.u * self.rate,
            state.y * self.multiplier,
        )

    def raised(self, y: Array) -> Array:
        """Return multipliers brought into K by their heads.

        The head of a cone of friction opens the joint friction times as much as it bounds the slip: raising
        it disturbs the flow least.
        """
        y = y.copy()
        y[self.cones.heads] -= np.minimum(self.cones.margin(y), 0.0)
        return y

    def measured(self, state: State) -> Scaled | None:
        """Return the problem in the units of a state; None where its units are so already."""
        p, measure = self.problem, Measure(self.problem, state)
        acting = p.acting @ np.abs(state.x) + np.abs(p.dead) + np.abs(state.load_factor * p.live)
        least = IDLE * np.repeat(measure.block, 6)
        carried = np.zeros(len(p.interfaces))
        np.maximum.at(carried, p.stress_interface, np.abs(state.x) / frictional(p))
        scaled = Scaled(
            p,
            unit(np.maximum(carried, UNLOADED * measure.interface)),
            unit(np.maximum(acting, least)),
            float(unit(np.array([measure.load_factor]))[0]),
        )
        pairs = ((scaled.force, self.force), (scaled.equation, self.equation))
        off = [np.abs(np.log2(a / b)).max() for a, b in pairs]
        off.append(abs(np.log2(scaled.load_factor / self.load_factor)))
        return scaled if max(off) > np.log2(COARSER) else None


def unmoved(problem: LimitProblem, load_factor: float, x: Array) -> State:
    """Return stresses as a state without a mechanism."""
    return State(load_factor, x, np.zeros(problem.C.shape[1]), np.zeros(problem.F.shape[0]))


def unit(sizes: Array) -> Array:
    """Return the nearest powers of two; one for nothing."""
    return np.asarray(power_of_two(np.where(sizes > 0.0, sizes, 1.0)))


def scaled(problem: LimitProblem, load_factor: float = 1.0) -> Scaled:
    """Return the problem in the units known before any solution: shears by friction."""
    return Scaled(problem, np.ones(len(problem.interfaces)), np.ones(problem.C.shape[1]), load_factor)


def with_rates_near_one(problem: LimitProblem) -> Scaled:
    """Return the same with rates near one, not over the number of blocks: they lose fewer digits."""
    return scaled(problem, float(power_of_two(1.0 / len(problem.blocks))))


def frictional(problem: LimitProblem) -> Array:
    """Return the friction where it limits a stress that has no part in N, M1, M2, and is below one; (s,)."""
    pressing = np.tile([0.0, 0.0, 1.0, 1.0, 1.0, 0.0], len(problem.interfaces))
    tangential = abs(problem.resultants).T @ pressing == 0.0
    friction = unit(np.clip(problem.friction, ROUNDING, 1.0))
    tangential &= (problem.friction > 0.0)[problem.stress_interface]  # not that of dowels and guides
    return np.where(tangential, friction[problem.stress_interface], 1.0)


class Projection:
    """Onto the stresses in equilibrium, C^T x = loads; the distance is that of the inverse of `weights`."""

    def __init__(self, C: sparse.csr_array, weights: sparse.csr_array | None = None) -> None:
        self.weights = sparse.eye_array(C.shape[0]) if weights is None else weights
        self.spread, self.balance = self.weights @ C, C.T
        self.solve = solver_of(self.balance @ self.spread)

    def nearest(self, loads: Array, x: Array) -> tuple[Array, Array]:
        """Return the nearest stresses in equilibrium, and the rates that are the multipliers of it."""
        v = self.solve(loads - self.balance @ x)
        return np.asarray(x + self.spread @ v), np.asarray(v)

    def onto(self, loads: Array, x: Array) -> Array:
        """Return the nearest stresses in equilibrium, refined; the residuals judge them."""
        for _ in range(2):
            x, _ = self.nearest(loads, x)
        return x


def balanced(p: Scaled, loads: Array, x: Array) -> Array:
    """Return the nearest stresses in equilibrium, every one in its own unit; the residuals judge them."""
    return Projection(p.C).onto(loads, x)


def unpressed(p: Scaled, loads: Array, x: Array) -> Array | None:
    """Return the nearest stresses in equilibrium that leave blocks without loads alone; None without such."""
    bare = np.append(~np.any(loads.reshape(-1, 6), axis=1), False)  # the last one is any support
    if not bare.any():
        return None
    carries = ~np.any(bare[p.problem.ends], axis=1)[p.problem.stress_interface]
    weights = sparse.csr_array(sparse.diags_array(1.0 * carries))
    return Projection(p.C, weights).onto(loads, np.where(carries, x, 0.0))


def compatible(p: Scaled, u: Array, y: Array, solve: Callable[[Array], Array] | None = None) -> Array:
    """Return the nearest multipliers that follow the rates, brought into K; `solve` is for F^T F."""
    across, strain = p.F.T, p.C @ u
    solve = solve or solver_of(across @ p.F)
    for _ in range(2):
        y = y - p.F @ solve(strain + across @ y)
    return p.raised(y)


def compatible_with(F: sparse.csr_array, strain: Array) -> Array:
    """Return the smallest y with F^T y = strain, where there is one."""
    across = F.T
    solve = solver_of(across @ F)
    y = F @ solve(strain)
    return np.asarray(y + F @ solve(strain - across @ y))


def repaired(p: Scaled, state: State) -> State:
    """Return the state with stresses in equilibrium and multipliers that follow the rates."""
    a = state.load_factor
    return State(a, balanced(p, p.dead + a * p.live, state.x), state.u, compatible(p, state.u, state.y))

"""Bounds on the associated load factor that are theorems, rounding errors included; numpy and scipy only."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from limitblocks.arrays import Array
from limitblocks.evidence.measure import Measure
from limitblocks.evidence.reach import Kinematic, Reach, Static
from limitblocks.evidence.rounding import EPS, TINY, UP, scalar_product
from limitblocks.evidence.spanning_tree import spanning_tree
from limitblocks.problem import LimitProblem, State, power_of_two


@dataclass(frozen=True)
class Proof:
    """What is proven of the associated load factor of a limit problem in floating-point numbers.

    Attributes
    ----------
    lower, upper : float
        ``lower <= load factor <= upper`` is a theorem about the numbers of the limit problem; infinite where
        nothing is proven.
    static, kinematic : str
        Why a side is not proven; empty where it is.
    """

    lower: float
    upper: float
    static: str = ""
    kinematic: str = ""

    @property
    def complete(self) -> bool:
        """True if both sides are proven."""
        return not (self.static or self.kinematic)

    @property
    def width(self) -> float:
        """Distance of the bounds over the load factor; infinite where a side is not proven."""
        size = max(abs(self.lower), abs(self.upper))
        return (self.upper - self.lower) / size if np.isfinite(size) and size > 0.0 else np.inf

    def to_dict(self) -> dict[str, Any]:
        """Return the proof as numbers (None where there is none) and text."""
        sides = {"lower": self.lower, "upper": self.upper}
        numbers = {name: value if np.isfinite(value) else None for name, value in sides.items()}
        return {**numbers, "static": self.static, "kinematic": self.kinematic}

    def __str__(self) -> str:
        if self.complete:
            return f"proven: {self.lower!r} <= load factor <= {self.upper!r}"
        sides = [self.static or f"proven: load factor >= {self.lower!r}"]
        sides += [self.kinematic or f"proven: load factor <= {self.upper!r}"]
        return "; ".join(sides)


def proof_of(problem: LimitProblem, si: State, dead: Array, reserve: float = 1.0) -> Proof:
    """Prove what a static and a kinematic solution show of the associated load factor.

    Parameters
    ----------
    problem : LimitProblem
        ``model.problem``. Its units are powers of two: measured in others, no digit changes.
    si : State
        Load factor and generalised stresses of the static solution, displacement rates and multipliers of
        the kinematic one, in SI units.
    dead : Array, shape (s,)
        Any generalised stresses, N and N m, such as those of the dead loads: where they are far within yield
        is the way on which what is unbalanced is carried to the supports.
    reserve : float
        How many times the room must exceed the need: more than 1 so that a machine which sums in another
        order proves the same.

    Notes
    -----
    Static theorem: stresses x + dx that balance dead + a live exactly and with F (x + dx) + g in K prove
    that the load factor is at least a. Kinematic theorem: with C u + F^T (y + dy) = 0 exactly and y + dy in
    K, every state in equilibrium within yield has a (live.u) <= g.(y + dy) - dead.u. For dx and dy see
    :mod:`limitblocks.evidence.reach`.
    """
    state = problem.dimensionless(si)
    return Prover(problem, dead / problem.stress_units, acting_at(problem, state)).proof(state, reserve)


@dataclass(frozen=True, eq=False)
class Prover:
    """Proofs of states of one problem, dimensionless; `dead` (s,) as in :func:`proof_of`.

    `acting` (m,) is what acts at each interface: its room is measured by it.
    """

    problem: LimitProblem
    dead: Array
    acting: Array

    def at(self, state: State) -> Prover:
        """The same for another state."""
        acting = acting_at(self.problem, state)
        return self if np.array_equal(acting, self.acting) else replace(self, acting=acting)

    @cached_property
    def static(self) -> Static:
        """The reach of stresses."""
        room = np.full(len(self.problem.interfaces), np.inf)
        np.minimum.at(room, self.problem.member_interface, self.margin)
        return Static(self.problem, spanning_tree(self.problem, room / self.acting))

    @cached_property
    def margin(self) -> Array:
        """Distance of `dead` to yield, of each linear row and each cone."""
        p = self.problem
        return p.cones.margin(p.F @ self.dead + p.g)

    @cached_property
    def kinematic(self) -> Kinematic:
        """The reach of multipliers."""
        return Kinematic(self.problem)

    @np.errstate(over="ignore", invalid="ignore", divide="ignore")  # what is undefined proves nothing
    def proof(self, state: State, reserve: float = 1.0) -> Proof:
        """Prove what the state shows."""
        (lower, static), (upper, kinematic) = self.lower(state, reserve), self.upper(state, reserve)
        return Proof(lower, upper, static, kinematic)

    def lower(self, state: State, reserve: float) -> tuple[float, str]:
        """The lower bound that the stresses prove, and why there is none."""
        reach = self.static.reach(state.load_factor, state.x).times(reserve)
        p, ways = self.problem, self.static
        if reach.proven:
            return float(state.load_factor / p.units.live), ""
        if len(ways.poor) and np.isinf(reach.change).any():
            name, block = p.interfaces[ways.tree.interface[ways.poor[0]]], p.blocks[ways.poor[0]]
            why = f"{name}, such as a joint without friction, does not carry all that rounding leaves at"
            return -np.inf, f"no lower bound proven: {why} {block}"
        dead = self.margin[_worst(reach)] <= 0.0
        at_yield = ", where the stresses under the dead loads are at yield, too" if dead else ""
        return -np.inf, _why("lower bound", "stresses", p, reach) + at_yield

    def upper(self, state: State, reserve: float) -> tuple[float, str]:
        """The upper bound that the mechanism proves, and why there is none."""
        p, reach = self.problem, self.kinematic.reach(state.u, state.y).times(reserve)
        bound = float(_upper(p, state, reach, reserve) / p.units.live) if reach.proven else np.inf
        why = "" if np.isfinite(bound) else "no upper bound proven: the live load does no work on the rates"
        return bound, _why("upper bound", "multipliers", p, reach) or why


def acting_at(problem: LimitProblem, state: State) -> Array:
    """Return what acts on the lesser block of each interface in the state, to a power of two, (m,)."""
    acting = Measure(problem, state).block
    usable = np.isfinite(acting) & (acting > TINY)
    force = power_of_two(np.where(usable, acting, 1.0) * problem.units.block_force)
    least = np.where(problem.ends >= 0, force[problem.ends], np.inf).min(axis=1)
    return np.asarray(least / problem.units.interface_force)


def _upper(problem: LimitProblem, state: State, reach: Reach, reserve: float) -> float:
    """(g.(y + dy) - dead.u) / (live.u), rounded up; infinite where the live load does no work on u."""
    work, off = scalar_product(problem.live, state.u)
    power, more = scalar_product(
        np.concatenate([problem.g, problem.dead]), np.concatenate([state.y, -state.u])
    )
    off, more = reserve * off * UP, reserve * more
    power += (more + float(np.abs(problem.g) @ reach.change)) * UP
    power += EPS * abs(power)
    least = work - off if power > 0.0 else work + off
    if not work - off > 0.0:
        return np.inf
    ratio = power / (least - np.copysign(EPS * abs(least), power))
    return float(ratio + EPS * abs(ratio) + TINY)


def _why(bound: str, what: str, problem: LimitProblem, reach: Reach) -> str:
    """Why a bound is not proven: the interface that lacks most."""
    if reach.proven:
        return ""
    name = problem.interfaces[problem.member_interface[_worst(reach)]]
    return f"no {bound} proven: exact {what} may lie outside the cone at {name}"


def _worst(reach: Reach) -> int:
    """The linear row or cone that lacks most."""
    return int(np.nan_to_num(reach.need - reach.room, nan=np.inf).argmax())

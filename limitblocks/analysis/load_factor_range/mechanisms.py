"""Search for solutions from mechanisms drawn at random, by two linear programs in turn.

The set of solutions is {(a, x) admissible, (u, y) a mechanism, y . (F x + g) = 0}: a bilinear condition
between two convex sets. From a mechanism of a few blocks, the stresses of least load factor (or greatest)
and gap, then the mechanism of least gap, and so on, with a gap that counts for more and more; where it ends
at zero there is a solution, whose face has the extremes. Alternating programs of a bilinear one: Bennett &
Mangasarian (1993), Computational Optimization and Applications 2, 207-227. It finds much, and proves
nothing about what it does not find.
"""

from __future__ import annotations

import cvxpy as cp
import numpy as np

from limitblocks.analysis.load_factor_range.faces import kinematics, statics
from limitblocks.analysis.polish import defect, polish
from limitblocks.analysis.programs import TIGHT, Program, Solver, in_cone, solved
from limitblocks.arrays import Array, Indices
from limitblocks.evidence.residuals import TOLERANCE
from limitblocks.problem import Flow, State

ROUNDS = 10
WORTH = 3.0  # times what a gap of the round before was worth in load factor
CLOSED = 1e-7  # gap that is taken for zero; the face that follows and its residuals decide
ALONE = 0.5  # share of the draws in which one block moves


class Mechanisms:
    """Draws mechanisms at random and closes their gaps."""

    def __init__(self, flow: Flow, limits: tuple[float, float], seed: int) -> None:
        self.flow, self.random = flow, np.random.default_rng(seed)
        self.limits = limits
        n = len(flow.problem.blocks)
        inner = flow.problem.ends[(flow.problem.ends >= 0).all(axis=1)]
        self.neighbours = [np.unique(inner[(inner == k).any(axis=1)]) for k in range(n)]

    def solution(self) -> State | None:
        """Return a certified solution from a new draw, or None."""
        mechanism, sense = self._drawn(), self.random.choice([-1.0, 1.0])
        return self.beyond(mechanism, sense) if mechanism else None

    def beyond(self, mechanism: tuple[Array, Array], sense: float) -> State | None:
        """Return a certified solution of lower (sense 1) or higher (-1) load factor, from a mechanism."""
        p = self.flow.problem
        for k in range(ROUNDS):
            state = self._round(mechanism, sense, WORTH**k)
            if state is None:
                return None
            mechanism = state.u, state.y
            if (p.F @ state.x + p.g) @ state.y < CLOSED:
                break
        # away from the end: interior points find what is strictly complementary, which the polish needs
        state = self._round(mechanism, 0.0, 1.0)
        state = polish(self.flow, state) if state else None
        return state if state and defect(self.flow, state) <= TOLERANCE else None

    def _round(self, mechanism: tuple[Array, Array], sense: float, worth: float) -> State | None:
        """The stresses for a mechanism, and the mechanism for these stresses."""
        static = self._stresses(mechanism[1], sense, worth)
        if static is None:
            return None
        p = self.flow.problem
        kinematic = self._mechanism(p.F @ static[1] + p.g, np.zeros(0, dtype=int))
        return State(*static, *kinematic) if kinematic else None

    def _drawn(self) -> tuple[Array, Array] | None:
        """A mechanism in which a random chain of neighbours moves, of random least multipliers."""
        p = self.flow.problem
        cost = np.zeros(p.cones.height)
        cost[p.cones.heads] = self.random.exponential(size=p.cones.degree) ** 2  # some rows dear, most cheap
        return self._mechanism(cost, np.setdiff1d(np.arange(len(p.blocks)), self._chain()))

    def _chain(self) -> Indices:
        """Blocks that hang together: one, or any number."""
        n = len(self.neighbours)
        count = 1 if self.random.random() < ALONE else self.random.integers(1, n + 1)
        chain = np.array([self.random.integers(n)])
        while len(chain) < count:
            around = np.setdiff1d(np.concatenate([self.neighbours[k] for k in chain]), chain)
            if not len(around):
                break
            chain = np.append(chain, self.random.choice(around))
        return np.asarray(chain)

    def _mechanism(self, cost: Array, still: Indices) -> tuple[Array, Array] | None:
        """The mechanism (u, y) of least cost . y that leaves some blocks where they are."""
        p = self.flow.problem
        u, y = cp.Variable(p.C.shape[1]), cp.Variable(len(p.g))
        constraints = [*kinematics(self.flow, u, y), *in_cone(y, p.cones)]
        constraints += [u[(6 * still[:, None] + np.arange(6)).ravel()] == 0] if len(still) else []
        values = _minimised(cost @ y, constraints, u, y)
        return None if values is None else (values[0], values[1])

    def _stresses(self, y: Array, sense: float, worth: float) -> tuple[float, Array] | None:
        """The admissible state of least sense * load factor + worth * gap."""
        static = statics(self.flow.problem, self.limits)
        inside = in_cone(static.rows, self.flow.problem.cones)
        aim = sense * static.load_factor + worth * (y @ static.rows)
        values = _minimised(aim, [*static.constraints, *inside], static.load_factor, static.x)
        return None if values is None else (float(values[0]), values[1])


def _minimised(
    aim: cp.Expression, constraints: list[cp.Constraint], *variables: cp.Variable
) -> tuple[Array, ...] | None:
    """Values at the minimum as one solver has them; their gap judges them."""
    program = Program(cp.Problem(cp.Minimize(aim), constraints), variables)
    values = solved(program, Solver("CLARABEL", dict(TIGHT), conic=True)).values
    return values if all(np.isfinite(v).all() for v in values) else None

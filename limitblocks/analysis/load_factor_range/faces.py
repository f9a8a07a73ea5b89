"""Convex pieces of the set of all solutions, as programs of cvxpy.

Where G does not depend on the stresses, the static conditions on (a, x) and the kinematic ones on (u, y) meet
in complementarity alone. The solutions that share a mechanism are a face of the convex set of admissible
states, y . (F x + g) = 0; those that share stresses are a face of the set of mechanisms. So the least and the
greatest load factor of a mechanism are one convex program each, and every value between them is a solution.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import cvxpy as cp
import numpy as np

from limitblocks.analysis.polish import defect, polish
from limitblocks.analysis.programs import Program, answers, solved, solvers
from limitblocks.arrays import Array, Indices
from limitblocks.evidence.residuals import TOLERANCE
from limitblocks.problem import Cones, Flow, LimitProblem, State

HELD = 1e-7  # of the largest: a smaller multiplier or slack counts as zero
RAY = 1e-9  # largest residual of a stress state that balances the live load alone


@dataclass(frozen=True, eq=False)
class Statics:
    """Admissible states: load factor and stresses, with their constraints; load factors within `limits`."""

    problem: LimitProblem
    load_factor: cp.Variable
    x: cp.Variable
    constraints: list[cp.Constraint]

    @property
    def rows(self) -> cp.Expression:
        """F x + g."""
        return self.problem.F @ self.x + self.problem.g


def statics(problem: LimitProblem, limits: tuple[float, float]) -> Statics:
    """Return the admissible states; an infinite limit is left out."""
    a, x = cp.Variable(), cp.Variable(problem.C.shape[0])
    low, high = limits
    constraints = [problem.C.T @ x - problem.live * a == problem.dead]
    constraints += [a >= low] if np.isfinite(low) else []
    constraints += [a <= high] if np.isfinite(high) else []
    return Statics(problem, a, x, constraints)


def in_face(rows: cp.Expression, held: Array, cones: Cones) -> list[cp.Constraint]:
    """Return `rows` in K and orthogonal to `held`, which is in K."""
    held = held / max(1.0, float(np.abs(held).max(initial=0.0)))
    k = cones.linear
    constraints = []
    for places, zero in ((np.flatnonzero(held[:k] > HELD), True), (np.flatnonzero(held[:k] <= HELD), False)):
        if len(places):
            constraints.append(rows[places] == 0 if zero else rows[places] >= 0)
    for group in cones.groups:
        constraints += _in_cone_faces(rows, held, group)
    return constraints


def _in_cone_faces(rows: cp.Expression, held: Array, group: Indices) -> list[cp.Constraint]:
    """The same of second-order cones: all of it, the ray opposite on the boundary, or nothing but zero."""
    v = held[group]
    across = np.linalg.norm(v[:, 1:], axis=1)
    none, inside = v[:, 0] <= HELD, v[:, 0] - across > HELD
    edge = ~none & ~inside
    constraints: list[cp.Constraint] = []
    if none.any():
        places = group[none]
        stack = cp.reshape(rows[places.ravel()], (places.shape[1], len(places)), order="F")
        constraints.append(cp.SOC(stack[0], stack[1:], axis=0))
    if inside.any():
        constraints.append(rows[group[inside].ravel()] == 0)
    if edge.any():
        places, opposite = group[edge], -v[edge, 1:] / across[edge, None]
        constraints.append(rows[places[:, 0]] >= 0)
        constraints += [
            rows[places[:, k + 1]] == cp.multiply(opposite[:, k], rows[places[:, 0]])
            for k in range(opposite.shape[1])
        ]
    return constraints


def extremes(flow: Flow, state: State, limits: tuple[float, float]) -> tuple[State | None, State | None]:
    """Return the solutions of least and of greatest load factor of the mechanism of `state`.

    None where no solver's word passes the residuals.
    """
    static = statics(flow.problem, limits)
    face = [*static.constraints, *in_face(static.rows, state.y, flow.problem.cones)]

    def end(sense: float) -> State | None:
        program = cp.Problem(cp.Minimize(sense * static.load_factor), face)
        return proven(
            flow, Program(program, (static.load_factor, static.x)), lambda a, x: (a, x, state.u, state.y)
        )

    return end(1.0), end(-1.0)


def kinematics(flow: Flow, u: cp.Variable, y: cp.Variable) -> list[cp.Constraint]:
    """Return the constraints of flow and normalisation, Eqs (54) and (55); not y in K."""
    p = flow.problem
    G = flow.matrix(np.zeros(p.C.shape[0]))
    return [p.C @ u + G.T @ y == 0, p.live @ u == 1]


def ray(flow: Flow, state: State) -> Array | None:
    """Return stresses that balance the live load alone and may be added to the state without limit."""
    p = flow.problem
    x = cp.Variable(p.C.shape[0])
    face = [p.C.T @ x == p.live, *in_face(p.F @ x, state.y, p.cones)]
    program = Program(cp.Problem(cp.Minimize(cp.sum_squares(x)), face), (x,))
    for solver in solvers(conic=True):
        (stresses,) = solved(program, solver).values
        rows = p.F @ stresses
        worst = max(
            np.abs(p.C.T @ stresses - p.live).max(),
            -p.cones.margin(rows).min(),
            np.abs(p.cones.product(rows, state.y)).max() / max(1.0, np.abs(state.y).max()),
        )
        if worst <= RAY:  # not where there are none: then it is no number
            return np.asarray(stresses)
    return None


def proven(
    flow: Flow, program: Program, state_of: Callable[..., tuple[float, Array, Array, Array]]
) -> State | None:
    """Return the first solver's solution that passes the residuals, polished if it has to be, or None."""
    for found in answers(program, flow.problem.cones):
        a, x, u, y = state_of(*found.values)
        state = State(float(a), x, u, y)
        if defect(flow, state) > TOLERANCE:
            state = polish(flow, state)
        if defect(flow, state) <= TOLERANCE:
            return state
    return None

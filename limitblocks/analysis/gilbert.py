"""Gilbert-type fixed point: a convex program with every flowing row frozen at the last state.

Gilbert, Casapulla & Ahmed (2006) freeze the normal force in the friction rows, so that sliding has no
dilatancy in the convex program; at a fixed point friction holds with the normal force found. Here every row
is frozen in its flow direction, G (x - x_k) + (F x_k + g) in K, which covers slip, twist, shear with
torsion and Table 5 alike: at a fixed point x = x_k the optimality conditions *are* Eqs (54)-(59).
"""

from __future__ import annotations

from dataclasses import dataclass

import cvxpy as cp
import numpy as np

from limitblocks.analysis.programs import in_cone
from limitblocks.analysis.states import State
from limitblocks.arrays import Array
from limitblocks.mechanics import LimitProblem
from limitblocks.mechanics.flow import plastic_potential

PENALTY = 1e3  # block lengths: rows frozen outside the yield set may be infeasible; the slack ends at zero
SETTINGS = {
    "tol_gap_abs": 1e-10,
    "tol_gap_rel": 1e-10,
    "tol_feas": 1e-10,
    "direct_solve_method": "qdldl",
}


@dataclass(frozen=True, eq=False)
class Frozen:
    """Answer of a frozen program: the next state and the slack that it needed."""

    state: State
    slack: float


def frozen_step(
    problem: LimitProblem, x: Array, weights: Array, rho: float, dilatancy: float
) -> Frozen | None:
    """Solve the program frozen at the stresses `x`; None if the solver gives nothing.

    Its objective is the load factor less rho/2 (x - x_k)^T W (x - x_k), W the compliance of the joints:
    stresses that do not matter for collapse stay, which makes the answer unique.
    """
    G = plastic_potential(problem, x, dilatancy)
    load_factor, new, slack = cp.Variable(), cp.Variable(len(x)), cp.Variable(nonneg=True)
    balance = problem.C.T @ new - problem.live * load_factor == problem.dead
    rows = G @ (new - x) + (problem.F @ x + problem.g) + problem.cones.identity * slack
    inside = in_cone(rows, problem.cones)
    change = cp.sum_squares(cp.multiply(np.sqrt(weights), new - x))
    objective = load_factor - 0.5 * rho * change - PENALTY * slack
    program = cp.Problem(cp.Maximize(objective), [balance, *inside])
    try:
        program.solve(solver=cp.CLARABEL, **SETTINGS)
    except cp.SolverError:
        return None
    if new.value is None or balance.dual_value is None:
        return None
    u, y = np.asarray(balance.dual_value), _multipliers(problem, inside)
    work = problem.live @ u  # the dual's sign and scale depend on the solver: Eq. (55) sets both
    if not abs(work) > 0.0:
        return None
    state = State(float(load_factor.value), np.asarray(new.value), u / work, y / abs(work))
    return Frozen(state, float(slack.value))


def _multipliers(problem: LimitProblem, inside: list[cp.Constraint]) -> Array:
    """Dual variables of the cone constraints in the order of the rows."""
    cones = problem.cones
    y = np.zeros(len(problem.g))
    duals = [constraint.dual_value for constraint in inside]
    if cones.linear:
        y[: cones.linear] = duals.pop(0)
    for (first, count, size), (t, z) in zip(cones.blocks, duals, strict=True):
        stack = np.concatenate([np.reshape(t, (1, count)), np.reshape(z, (size - 1, count), order="C")])
        y[first : first + count * size] = stack.T.ravel()
    return y

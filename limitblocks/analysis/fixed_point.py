"""Fixed point of two convex programs with the flow frozen at the last state, built by cvxpy.

Gilbert, Casapulla & Ahmed (2006) freeze the normal force in the friction rows, solve a convex program without
dilatancy, and repeat. Here the flow G(x_k) of every row is frozen at the last stresses, which covers slip,
twist, shear with torsion and Table 5 alike, and the rounds alternate: the mechanism of that flow whose gap
y . (F x_k + g) is least, then the stresses nearest to x_k that leave no gap. At a fixed point both are
exact and Eqs (54)-(59) hold.
"""

from __future__ import annotations

import warnings

import cvxpy as cp
import numpy as np

from limitblocks.analysis.mcp import mcp_residuals
from limitblocks.analysis.programs import in_cone
from limitblocks.analysis.states import State
from limitblocks.arrays import Array
from limitblocks.mechanics import LimitProblem
from limitblocks.mechanics.flow import plastic_potential

PENALTY = 1e5  # of a remaining gap against the change of stresses
PROGRESS = 0.5  # a round must bring the worst residual below this part of the best
SETTINGS = {
    "tol_gap_abs": 1e-10,
    "tol_gap_rel": 1e-10,
    "tol_feas": 1e-10,
    "direct_solve_method": "qdldl",
}


def permanent_state(problem: LimitProblem, weights: Array) -> Array | None:
    """Stresses under the dead loads alone of least norm x^T W x; None if the solver finds none."""
    x = cp.Variable(problem.C.shape[0])
    norm = cp.sum_squares(cp.multiply(np.sqrt(weights), x))
    constraints = [problem.C.T @ x == problem.dead, *in_cone(problem.F @ x + problem.g, problem.cones)]
    found = _values(norm, constraints, x)
    return None if found is None else found[0]


def frozen_mechanism(problem: LimitProblem, x: Array, dilatancy: float) -> tuple[Array, Array] | None:
    """Rates and multipliers (u, y) of the flow frozen at x with the least gap y . (F x + g)."""
    u, y = cp.Variable(problem.C.shape[1]), cp.Variable(len(problem.g))
    flow = problem.C @ u + plastic_potential(problem, x, dilatancy).T @ y == 0
    constraints = [flow, problem.live @ u == 1, *in_cone(y, problem.cones)]
    found = _values((problem.F @ x + problem.g) @ y, constraints, u, y)
    return None if found is None else (found[0], found[1])


def nearest_stresses(problem: LimitProblem, x: Array, y: Array, weights: Array) -> tuple[float, Array] | None:
    """Load factor and stresses in equilibrium within yield, nearest to x, that leave no gap to y."""
    z, load_factor = cp.Variable(len(x)), cp.Variable()
    away = 0.5 * cp.sum_squares(cp.multiply(np.sqrt(weights), z - x))
    balance = problem.C.T @ z == problem.dead + load_factor * problem.live
    gap = (problem.F.T @ y) @ z
    constraints = [balance, *in_cone(problem.F @ z + problem.g, problem.cones)]
    found = _values(away + PENALTY * gap, constraints, z, load_factor)
    return None if found is None else (float(found[1]), found[0])


def fixed_point(
    problem: LimitProblem, start: State, weights: Array, dilatancy: float, tolerance: float, rounds: int
) -> tuple[State | None, int]:
    """Iterate from `start`; return a state within the tolerance, or None, and the number of rounds."""
    load_factor, x, y = start.load_factor, start.x, start.y
    best = np.inf
    adjusted = _admissible(problem, start)
    for k in range(1, rounds + 1):
        if not adjusted:
            stresses = nearest_stresses(problem, x, y, weights)
            if stresses is None:
                return None, k
            load_factor, x = stresses
        adjusted = False
        mechanism = frozen_mechanism(problem, x, dilatancy)
        if mechanism is None:
            return None, k
        u, y = mechanism
        worst = mcp_residuals(problem, load_factor, x, u, y, dilatancy).worst.value
        if worst <= tolerance:
            return State(load_factor, x, u, y), k
        if worst > PROGRESS * best:
            return None, k
        best = min(best, worst)
    return None, rounds


def _admissible(problem: LimitProblem, state: State) -> bool:
    """True where equilibrium and yield hold already, so that the stresses can stay."""
    unbalanced = problem.dead + state.load_factor * problem.live - problem.C.T @ state.x
    inside = problem.cones.margin(problem.F @ state.x + problem.g).min()
    return bool(np.abs(unbalanced).max() <= 1e-9 and inside >= -1e-9)


def _values(
    objective: cp.Expression, constraints: list[cp.Constraint], *variables: cp.Variable
) -> tuple[Array, ...] | None:
    """Values at the minimum, None if the solver leaves none; residuals judge their accuracy."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            cp.Problem(cp.Minimize(objective), constraints).solve(solver=cp.CLARABEL, **SETTINGS)
        except (cp.SolverError, ValueError, ArithmeticError):
            return None
    values = [variable.value for variable in variables]
    return None if any(value is None for value in values) else tuple(np.asarray(v, float) for v in values)

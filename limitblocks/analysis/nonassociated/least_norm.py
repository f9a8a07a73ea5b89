"""State of the permanent loads: of all stresses within yield that carry them, those of least norm.

The norm x^T W x is the elastic energy of joints of compliance W. Matrices and solvers are called as they are:
cvxpy took longer over this program than they do.
"""

from __future__ import annotations

import clarabel
import numpy as np
import osqp
from scipy import sparse

from limitblocks.analysis.direct import FIXED, solution
from limitblocks.analysis.programs import Conic
from limitblocks.arrays import Array
from limitblocks.problem import LimitProblem

# Polishing solves the equations of the active rows: after 50 to 225 steps if at all, to rounding.
OSQP = {"eps_abs": 1e-5, "eps_rel": 1e-5, "max_iter": 500, "polishing": True, "verbose": False}
# The norm leaves no pivot of a stress without size: little is added to any, and nothing to refine.
CLARABEL = FIXED | {
    "tol_gap_abs": 1e-10,
    "tol_gap_rel": 1e-10,
    "tol_feas": 1e-10,
    "static_regularization_constant": 1e-12,
    "iterative_refinement_enable": False,
}
ACCURATE = 1e-8  # largest violation of the conditions of a minimum that is believed
SOLVED = (clarabel.SolverStatus.Solved, clarabel.SolverStatus.AlmostSolved)


def permanent_state(problem: LimitProblem, weights: Array) -> Array | None:
    """Stresses under the dead loads alone of least norm x^T W x; None if no solver finds them.

    Where all rows are planes, OSQP finds them fastest and to rounding; what it says is believed if the
    conditions of the minimum hold, recomputed. Otherwise, and for cones, Clarabel.
    """
    x = None if problem.cones.second_order else by_planes(problem, weights)
    return by_cones(problem, weights) if x is None else x


def by_planes(problem: LimitProblem, weights: Array) -> Array | None:
    """Stresses of least norm x^T W x by OSQP; None where they are not within ACCURATE of the conditions.

    Equilibrium C^T x = dead, yield F x + g >= 0, W x = C u + F^T y with y >= 0, and y.(F x + g) = 0.
    """
    n = problem.C.shape[1]
    A = sparse.csc_matrix(sparse.vstack([problem.C.T, problem.F]))
    least = np.append(problem.dead, -problem.g)
    most = np.append(problem.dead, np.full(len(problem.g), np.inf))
    W = sparse.csc_matrix(sparse.diags_array(weights))
    solver = osqp.OSQP()
    solver.setup(P=W, q=np.zeros(len(weights)), A=A, l=least, u=most, **OSQP)
    found = solver.solve(raise_error=False)
    x, u, y = found.x, -found.y[:n], -found.y[n:]
    return x if violation(problem, weights, x, u, y) <= ACCURATE else None


def violation(problem: LimitProblem, weights: Array, x: Array, u: Array, y: Array) -> float:
    """Largest violation of the conditions of the least norm, over the size of what is compared."""
    s, force, strain = problem.F @ x + problem.g, np.abs(x).max(), np.abs(weights * x).max()
    violations = (
        np.abs(problem.dead - problem.C.T @ x).max() / force,
        np.maximum(-s, 0.0).max() / force,
        np.abs(weights * x - problem.C @ u - problem.F.T @ y).max() / strain,
        np.maximum(-y, 0.0).max() / strain,
        abs(y @ s) / abs(x @ (weights * x)),
    )
    worst = float(np.max(violations))
    return worst if np.isfinite(worst) else np.inf


def by_cones(problem: LimitProblem, weights: Array) -> Array | None:
    """Stresses of least norm x^T W x by Clarabel; None if it finds none."""
    A = sparse.csc_array(sparse.vstack([problem.C.T, -problem.F]))
    program = Conic(np.zeros(len(weights)), A, np.append(problem.dead, problem.g), problem.cones, weights)
    try:
        found = solution(program, CLARABEL)
    except (ValueError, ArithmeticError):
        return None
    return np.array(found.x) if found.status in SOLVED else None

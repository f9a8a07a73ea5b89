"""Of all stresses within yield that carry the dead loads, those of least norm.

The norm x^T W x is the elastic energy of joints of compliance W. Matrices and solvers are called as they are:
cvxpy took longer over this program than they do.
"""

from __future__ import annotations

import signal

import numpy as np
import osqp
from scipy import sparse

from limitblocks.analysis.conic import Conic
from limitblocks.analysis.direct import FIXED, solution
from limitblocks.arrays import Array
from limitblocks.problem import LimitProblem, State

# Polishing solves the equations of the active rows: after 50 to 225 steps if at all, to rounding.
OSQP = {"eps_abs": 1e-5, "eps_rel": 1e-5, "max_iter": 500, "polishing": True, "verbose": False}
CLARABEL = FIXED | {"tol_gap_abs": 1e-10, "tol_gap_rel": 1e-10, "tol_feas": 1e-10}
# Largest violation of the conditions of a minimum that is believed; rough ones are off by 1e-5.
ACCURATE = 1e-7


def least_state(problem: LimitProblem, weights: Array) -> State | None:
    """Stresses of least norm x^T W x under the dead loads alone, and their multipliers; None if not found.

    They fulfil W x = C u + F^T y. Where all rows are planes, OSQP finds them fastest and to rounding;
    otherwise, and for cones, Clarabel. What a solver says is believed if the conditions of the minimum hold,
    recomputed.
    """
    if not problem.dead.any() and problem.cones.margin(problem.g).min(initial=0.0) >= 0.0:
        return State(0.0, *(np.zeros(size) for size in (*problem.C.shape, len(problem.g))))
    found = None if problem.cones.second_order else by_planes(problem, weights)
    return by_cones(problem, weights) if found is None else found


def by_planes(problem: LimitProblem, weights: Array) -> State | None:
    """The state of least norm x^T W x by OSQP; None where it does not meet the conditions."""
    A = sparse.csc_matrix(sparse.vstack([problem.C.T, problem.F]))
    least = np.append(problem.dead, -problem.g)
    most = np.append(problem.dead, np.full(len(problem.g), np.inf))
    W = sparse.csc_matrix(sparse.diags_array(weights))
    solver = osqp.OSQP()
    solver.setup(P=W, q=np.zeros(len(weights)), A=A, l=least, u=most, **OSQP)
    found = solver.solve(raise_error=False)
    if (
        found.info.status_val == osqp.SolverStatus.OSQP_SIGINT
    ):  # it kept Ctrl-C to itself; one after its last step is lost
        signal.raise_signal(signal.SIGINT)
    return _believed(problem, weights, found.x, found.y)


def by_cones(problem: LimitProblem, weights: Array) -> State | None:
    """The state of least norm x^T W x by Clarabel; None where it does not meet the conditions."""
    A = sparse.csc_array(sparse.vstack([problem.C.T, -problem.F]))
    program = Conic(np.zeros(len(weights)), A, np.append(problem.dead, problem.g), problem.cones, weights)
    found = solution(program, CLARABEL)
    n, dual = problem.C.shape[1], np.array(found.z)
    return _believed(problem, weights, np.array(found.x), np.append(dual[:n], -dual[n:]))


def _believed(problem: LimitProblem, weights: Array, x: Array, dual: Array) -> State | None:
    n = problem.C.shape[1]
    state = State(0.0, x, -dual[:n], -dual[n:])
    return state if violation(problem, weights, x, state.u, state.y) <= ACCURATE else None


@np.errstate(all="ignore")  # a state that ran away is not believed
def violation(problem: LimitProblem, weights: Array, x: Array, u: Array, y: Array) -> float:
    """Largest violation of the conditions of the least norm, over the size of what is compared.

    Equilibrium C^T x = dead, yield F x + g in K, W x = C u + F^T y with y in K, and y.(F x + g) = 0.
    """
    s, force, strain = problem.F @ x + problem.g, np.abs(x).max(), np.abs(weights * x).max()
    violations = (
        np.abs(problem.dead - problem.C.T @ x).max() / force,
        np.maximum(-problem.cones.margin(s), 0.0).max() / force,
        np.abs(weights * x - problem.C @ u - problem.F.T @ y).max() / strain,
        np.maximum(-problem.cones.margin(y), 0.0).max() / strain,
        abs(y @ s) / abs(x @ (weights * x)),
    )
    worst = float(np.max(violations))
    return worst if np.isfinite(worst) else np.inf

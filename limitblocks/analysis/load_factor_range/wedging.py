"""Whether the structure can be wedged: a stress state without any load within yield."""

from __future__ import annotations

import cvxpy as cp
import numpy as np

from limitblocks.analysis.programs import Program, in_cone, solved, solvers
from limitblocks.errors import SolverFailure
from limitblocks.evidence.range_result import Wedging
from limitblocks.evidence.residuals import largest_of
from limitblocks.problem import LimitProblem

CERTIFIED = 1e-8  # largest residual of a self-stress, over its largest stress
STRESSED = 1e-3  # of the largest: an interface with less is not named


def wedging(problem: LimitProblem) -> Wedging:
    """Look for a self-stress C^T x = 0, F x in K, x not zero, by one convex program.

    The greatest e . F x of at most one, e within K: it is one if there is a self-stress, zero if none.
    (F x = 0 only for x = 0: no joint carries a stress of both signs without limit.)

    Raises
    ------
    SolverFailure
        If no solver gives an answer.
    """
    x = cp.Variable(problem.C.shape[0])
    size = problem.cones.identity @ (problem.F @ x)
    constraints = [problem.C.T @ x == 0, *in_cone(problem.F @ x, problem.cones), size <= 1]
    program = Program(cp.Problem(cp.Maximize(size), constraints), (x,))
    for solver in solvers(bool(problem.cones.second_order)):
        (self_stress,) = solved(program, solver).values
        rows, largest = problem.F @ self_stress, float(np.abs(self_stress).max(initial=0.0))
        if problem.cones.identity @ rows < 0.5:  # neither nearly one nor nearly zero never came up
            return Wedging(False, (), float(problem.cones.identity @ rows))
        residual = max(np.abs(problem.C.T @ self_stress).max(), -problem.cones.margin(rows).min()) / largest
        if residual <= CERTIFIED:  # not where there are no stresses: then it is no number
            stress = largest_of(problem, self_stress)
            named = np.array(problem.interfaces)[stress > STRESSED * stress.max()]
            return Wedging(True, tuple(named.tolist()), float(residual))
    raise SolverFailure("whether the structure can be wedged is undecided: no solver gave a certified answer")

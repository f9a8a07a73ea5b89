"""How safely a model stands under given loads: a continuous measure, negative where they fall."""

from __future__ import annotations

from dataclasses import replace

import cvxpy as cp
import numpy as np

from limitblocks.analysis.bounds import TOLERANCE, refuse_falling
from limitblocks.analysis.programs import Program, attempts, in_cone
from limitblocks.arrays import Array
from limitblocks.errors import NoEquilibrium, SolverFailure
from limitblocks.model import Model
from limitblocks.problem import LimitProblem

MOST = 1.0  # mean block weights: a structure that can be wedged at will has no largest margin


def standing_margin(model: Model, load_factor: float = 0.0) -> float:
    """Return the largest least distance to yield of all states in equilibrium, in mean block weights.

    Over all stresses x in equilibrium with dead + load_factor live, the largest t such that each row of
    F x + g is at least t inside the cone K, t <= 1. A state within the yield surface exists, and the loads
    stand (static theorem), exactly where t >= 0; below, -t is how much every yield function would have to be
    widened. As the optimum of a convex program that is always feasible, t varies continuously with geometry
    and loads, which yes and no do not: what a root finder needs. Joints without friction carry no shear;
    where therefore no stresses at all balance the loads, the margin is -1.

    Parameters
    ----------
    model : Model
        The structure.
    load_factor : float
        Of the live load.

    Raises
    ------
    SolverFailure
        If no solver finds a state whose recomputed equilibrium residual is at most 1e-6.
    """
    problem = model.problem
    loads = problem.dead + load_factor / problem.scales.load_factor * problem.live
    said = []
    for found in attempts(_program(problem, loads), bool(problem.cones.second_order)):
        x = found.values[1]
        unbalanced = float(np.abs(problem.C.T @ x - loads).max())
        if unbalanced <= TOLERANCE:
            return min(MOST, float(problem.cones.margin(problem.F @ x + problem.g).min()))
        said.append(f"{found.solver} {found.status}, equilibrium residual {unbalanced:.1e}")
    try:
        refuse_falling(replace(problem, dead=loads))
    except NoEquilibrium:
        return -MOST
    raise SolverFailure("how safely the loads stand is undecided: " + "; ".join(said))


def _program(problem: LimitProblem, loads: Array) -> Program:
    t, x = cp.Variable(), cp.Variable(problem.C.shape[0])
    balance = problem.C.T @ x == loads
    inside = in_cone(problem.F @ x + problem.g - t * problem.cones.identity, problem.cones)
    return Program(cp.Problem(cp.Maximize(t), [balance, t <= MOST, *inside]), (t, x))

"""Fixed point of two convex programs with the flow frozen at the last state, built by cvxpy.

Gilbert, Casapulla & Ahmed (2006) freeze the normal force in the friction rows, solve a convex program without
dilatancy, and repeat. Here the flow G(x_k) of every row is frozen at the last stresses, which covers slip,
twist, shear with torsion and Table 5 alike, and the rounds alternate: the mechanism of that flow whose gap
y . (F x_k + g) is least, which is the kinematic program of the frozen problem
(:mod:`limitblocks.analysis.nonassociated.frozen_flow`) less the load factor, then the stresses nearest to x_k
that leave no gap. At a fixed point both are exact and Eqs (54)-(59) hold.
"""

from __future__ import annotations

import warnings
from functools import cached_property
from typing import Any

import cvxpy as cp
import numpy as np

from limitblocks.analysis.direct import Programs
from limitblocks.analysis.forms import Stresses
from limitblocks.analysis.nonassociated.frozen_flow import frozen
from limitblocks.analysis.programs import DIRECT, in_cone
from limitblocks.analysis.scales import scaled
from limitblocks.arrays import Array
from limitblocks.evidence.residuals import mcp_residuals
from limitblocks.problem import Flow, LimitProblem, State

PENALTY = 1e5  # of a remaining gap against the change of stresses
SETTINGS = {
    "tol_gap_abs": 1e-10,
    "tol_gap_rel": 1e-10,
    "tol_feas": 1e-10,
    "direct_solve_method": "qdldl",
    "iterative_refinement_enable": False,
}


def frozen_mechanism(flow: Flow, x: Array) -> tuple[Array, Array] | None:
    """Rates and multipliers (u, y) of the flow frozen at x with the least gap y . (F x + g).

    They are the duals of the static program of the frozen problem. Beyond yield the slack counts as that of
    the nearest admissible one, or the gap would have no minimum.
    """
    form = Stresses(scaled(frozen(flow, x)))
    state = form.problem.in_problem(Programs(form).limit_state(DIRECT))
    return (state.u, state.y) if np.isfinite(state.u).all() and np.isfinite(state.y).all() else None


class NearestStresses:
    """Stresses in equilibrium within yield, nearest to given ones; compiled once, then vectors change."""

    def __init__(self, problem: LimitProblem) -> None:
        self.problem = problem

    @cached_property
    def _compiled(self) -> tuple[Any, ...]:
        p = self.problem
        x, load_factor = cp.Variable(p.C.shape[0]), cp.Variable()
        norm = 0.5 * cp.sum_squares(cp.multiply(np.sqrt(p.compliance), x))
        balance = p.C.T @ x == p.dead + load_factor * p.live
        aim = cp.Minimize(norm + cp.sum(x))  # ones where the slope will be
        program = cp.Problem(aim, [balance, *in_cone(p.F @ x + p.g, p.cones)])
        data, chain, inverse = program.get_problem_data(cp.CLARABEL, solver_opts=dict(SETTINGS))
        first = data["param_prob"].var_id_to_col[x.id]
        return x, load_factor, program, data, chain, inverse, slice(first, first + x.size)

    def find(self, x: Array, y: Array) -> tuple[float, Array] | None:
        """Load factor and stresses nearest to x that leave no gap to y; None if the solver finds none."""
        nearest, load_factor, program, data, chain, inverse, places = self._compiled
        slopes = data["c"].copy()  # of the distance from x and of the gap to y
        slopes[places] = PENALTY * (self.problem.F.T @ y) - self.problem.compliance * x
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # residuals judge the accuracy
                solved = chain.solve_via_data(
                    program, data | {"c": slopes}, warm_start=False, verbose=False, solver_opts=dict(SETTINGS)
                )
                program.unpack_results(solved, chain, inverse)
        except (cp.SolverError, ValueError, ArithmeticError):
            return None
        return None if nearest.value is None else (float(load_factor.value), np.asarray(nearest.value))


def fixed_point(
    nearest: NearestStresses, start: State, flow: Flow, tolerance: float, rounds: int
) -> State | None:
    """Iterate from `start`; return a state within the tolerance, or None."""
    state = start
    for _ in range(rounds):
        found = nearest.find(state.x, state.y)
        mechanism = frozen_mechanism(flow, found[1]) if found else None
        if found is None or mechanism is None:
            return None
        state = State(*found, *mechanism)
        if mcp_residuals(flow, state).worst.value <= tolerance:
            return state
    return None

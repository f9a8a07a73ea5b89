"""The convex programs of limit analysis, built by cvxpy: one matrix expression per constraint kind."""

from __future__ import annotations

import logging
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import cvxpy as cp
import numpy as np
from scipy import sparse

from limitblocks.analysis.scales import Scaled
from limitblocks.arrays import Array, Indices
from limitblocks.evidence.measure import Measure
from limitblocks.problem import Cones, LimitProblem, State

log = logging.getLogger(__name__)

# QDLDL by name: by itself Clarabel changes to faer from about 500 blocks, less accurate and up to ten
# times slower.
TIGHT = {
    "tol_gap_abs": 1e-9,
    "tol_gap_rel": 1e-9,
    "tol_feas": 1e-9,
    "max_iter": 200,
    "direct_solve_method": "qdldl",
}
# As close as Clarabel comes, its last iterate if it stalls: small violations add up over large forces.
CLOSE = TIGHT | {"tol_gap_abs": 1e-12, "tol_gap_rel": 1e-12, "tol_feas": 1e-12, "accept_unknown": True}
# Without equilibration Clarabel takes other iterates: a second opinion from the same package.
PLAIN = TIGHT | {"equilibrate_enable": False}
# Its presolve, up to 1.15, corrupts memory where columns are parallel and their sizes 1e8 and more apart.
HIGHS = {
    "method": "highs",
    "primal_feasibility_tolerance": 1e-10,
    "dual_feasibility_tolerance": 1e-10,
    "presolve": False,
}

ROUNDS = 4  # of changing the units; each finds some eight digits more of what is light
LEAST = 2.0**-200  # times the unit of force of a block: the least other one, whose square is a number
COARSER = 4.0  # times what acts on a block: a unit off by more is changed, and the programs solved again


@dataclass(frozen=True)
class Solver:
    """A solver that cvxpy calls, with its settings; `conic` tells whether it takes second-order cones."""

    name: str
    settings: dict[str, object]
    conic: bool

    def having(self, settings: Mapping[str, object]) -> Solver:
        """The same solver with other settings."""
        return replace(self, settings=self.settings | dict(settings))


SOLVERS = (
    Solver("CLARABEL", dict(CLOSE), conic=True),
    Solver("CLARABEL", dict(TIGHT), conic=True),
    Solver("CLARABEL", dict(PLAIN), conic=True),
    Solver("SCIPY", {"scipy_options": HIGHS}, conic=False),
)
# The first solve, to be proven; its form says how the linear equations are solved.
DIRECT = Solver(
    "CLARABEL",
    TIGHT | {"tol_gap_abs": 1e-11, "tol_gap_rel": 1e-11, "tol_feas": 1e-11, "accept_unknown": True},
    conic=True,
)
# In the plane all rows are linear: four iterations more than to 1e-11 prove ten times closer bounds.
PLANAR = DIRECT.having({"tol_gap_abs": 1e-12, "tol_gap_rel": 1e-12, "tol_feas": 1e-12})


@dataclass(frozen=True, eq=False)
class Solution:
    """What a solver claims: its word, values of the variables and duals of the constraints; no evidence."""

    solver: str
    status: str
    values: tuple[Array, ...]
    duals: tuple[Array, ...]


@dataclass(frozen=True)
class Program:
    """A cvxpy problem with the variables that answer it."""

    problem: cp.Problem
    variables: tuple[cp.Variable, ...]


def static_program(problem: Scaled) -> Program:
    """Largest load factor in equilibrium within the yield set, Eqs (56)-(57). Variables: load factor, x.

    Its duals solve the kinematic program: u and y with C u = -F^T y, y in K*, live.u = 1, whose load factor
    g.y - dead.u is least.
    """
    load_factor, x = cp.Variable(), cp.Variable(problem.C.shape[0])
    balance = problem.live * load_factor + problem.dead == problem.C.T @ x
    inside = in_cone(problem.F @ x + problem.g, problem.cones)
    return Program(cp.Problem(cp.Minimize(-load_factor), [balance, *inside]), (load_factor, x))


def kinematic_program(problem: Scaled) -> Program:
    """Least load factor g.y - dead.u over all mechanisms of the associated flow. Variables: u, y."""
    u, y = cp.Variable(problem.C.shape[1]), cp.Variable(problem.F.shape[0])
    flow = problem.C @ u + problem.F.T @ y == 0
    power = problem.g @ y - problem.dead @ u
    constraints = [flow, problem.live @ u == 1, *in_cone(y, problem.cones)]
    return Program(cp.Problem(cp.Minimize(power), constraints), (u, y))


def falling_program(problem: LimitProblem, loads: Array) -> Program:
    """Mechanism of unit size on which the loads do most work beyond the dissipation. Variables: u, y.

    Its value is zero exactly where the loads stand; otherwise the blocks that move in it fall.
    """
    u, y = cp.Variable(problem.C.shape[1]), cp.Variable(problem.F.shape[0])
    flow = problem.C @ u + problem.F.T @ y == 0
    surplus = loads @ u - problem.g @ y
    constraints = [flow, u <= 1, u >= -1, *in_cone(y, problem.cones)]
    return Program(cp.Problem(cp.Maximize(surplus), constraints), (u, y))


def jamming_program(problem: Scaled) -> Program:
    """Stress state that balances the dead load and can grow without yielding. Variable: x."""
    x = cp.Variable(problem.C.shape[0])
    unbalanced = cp.norm(problem.C.T @ x - problem.dead, "inf")
    return Program(cp.Problem(cp.Minimize(unbalanced), in_cone(problem.F @ x, problem.cones)), (x,))


def in_cone(rows: cp.Expression, cones: Cones) -> list[cp.Constraint]:
    """`rows` in K: one constraint for the orthant, one for each size of second-order cone."""
    constraints: list[cp.Constraint] = []
    if cones.linear:
        constraints.append(rows[: cones.linear] >= 0)
    for places in cones.groups:
        count, size = places.shape
        stack = cp.reshape(rows[places[0, 0] : places[-1, -1] + 1], (size, count), order="F")
        constraints.append(cp.SOC(stack[0], stack[1:], axis=0))
    return constraints


def map_in_cone(
    A: sparse.csr_array, v: cp.Variable, cones: Cones, b: Array | None = None
) -> list[cp.Constraint]:
    """`A v + b` in K, b zero if left out: cvxpy compiles rows taken from numbers a third faster."""

    def taken(rows: slice | Indices) -> cp.Expression:
        product = (A[rows] if cones.second_order else A) @ v
        return product if b is None else product + b[rows]

    constraints: list[cp.Constraint] = [taken(slice(cones.linear)) >= 0] if cones.linear else []
    for places in cones.groups:
        tails = cp.reshape(taken(places[:, 1:].ravel()), places[:, 1:].T.shape, order="F")
        constraints.append(cp.SOC(taken(places[:, 0]), tails))
    return constraints


def solvers(conic: bool) -> tuple[Solver, ...]:
    """Solvers to try in turn; those of linear programs only where there are no cones."""
    return tuple(solver for solver in SOLVERS if solver.conic or not conic)


def solved(program: Program, solver: Solver) -> Solution:
    """Return what `solver` says of the program; NaN where it says nothing."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # accuracy is judged by recomputed residuals, not by a warning
        try:
            # a warm start would keep the settings of the attempt before
            program.problem.solve(solver=solver.name, warm_start=False, **solver.settings)
            status = str(program.problem.status)
        except (cp.SolverError, ValueError, ArithmeticError) as error:
            status = "failed"
            log.info("%s: %s", type(error).__name__, error)
    log.info("%s: %s", solver.name, status)
    values = tuple(_number(variable.value, variable.shape) for variable in program.variables)
    return Solution(solver.name, status, values, tuple(map(_dual, program.problem.constraints)))


def answers(program: Program, cones: Cones) -> Iterator[Solution]:
    """Yield what one solver after the other says of the program, where its values are numbers."""
    for solver in solvers(bool(cones.second_order)):
        found = solved(program, solver)
        if all(np.isfinite(value).all() for value in found.values):
            yield found


def _dual(constraint: cp.Constraint) -> Array:
    """Dual of a constraint in the order of its rows: (t, z) of each cone."""
    if not isinstance(constraint, cp.SOC):
        return _number(constraint.dual_value, constraint.shape).ravel()
    t, z = constraint.dual_value
    return np.full(constraint.size, np.nan) if t is None else np.vstack([t, z]).T.ravel()


def _number(value: Array | None, shape: tuple[int, ...]) -> Array:
    """What a solver left, NaN where it left nothing."""
    return np.full(shape, np.nan) if value is None else np.asarray(value, dtype=float)


def remeasured(problem: LimitProblem, state: State) -> LimitProblem | None:
    """The problem in units of what acts on its blocks in `state`; None where its units are so already."""
    acting = Measure(problem, state).block
    acting = np.where(acting == 0.0, 1.0, np.maximum(acting, LEAST))  # nothing is measured by nothing
    if acting.max() <= COARSER**2 and acting.min() >= 1 / COARSER:
        return None
    return problem.measured(acting * problem.units.block_force)

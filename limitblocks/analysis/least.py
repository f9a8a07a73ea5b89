"""The least forces of ties, or the least added loads, with which given loads stand: the static theorem."""

from __future__ import annotations

import cvxpy as cp
import numpy as np

from limitblocks.analysis.programs import Program, in_cone, solved, solvers
from limitblocks.analysis.scales import Scaled, scaled
from limitblocks.arrays import Array
from limitblocks.errors import ModelError, SolverFailure
from limitblocks.problem import LimitProblem


def least_stresses(problem: LimitProblem, load_factor: float, weights: Array) -> Array:
    """Return stresses that carry dead + load_factor live within yield and of which ``weights . x`` is least.

    Parameters
    ----------
    problem : LimitProblem
        The structure.
    load_factor : float
        Dimensionless.
    weights : Array, shape (s,)
        Of each generalised stress, >= 0, not all zero.

    Returns
    -------
    Array, shape (s,)
        Dimensionless; to be judged by bounds of the structure made of it.

    Raises
    ------
    ModelError
        If no stresses within yield carry the loads.
    SolverFailure
        If no solver has an answer.
    """
    p = scaled(problem)
    x = cp.Variable(problem.C.shape[0])
    cost = weights * p.stress
    balance = p.C.T @ x == _loads(p, load_factor)
    least = cp.Problem(cp.Minimize((cost / cost.max()) @ x), [balance, *in_cone(p.F @ x + p.g, p.cones)])
    return np.asarray(p.stress * _solved(Program(least, (x,)), problem, "ties", load_factor))


def least_loads(problem: LimitProblem, load_factor: float, columns: Array) -> Array:
    """Return amounts m >= 0 of least sum with which dead + load_factor live + columns m stand.

    `columns` (6 n, k) are loads per unit amount, dimensionless; returns and errors as of `least_stresses`.
    """
    p = scaled(problem)
    own = columns / p.equation[:, None]
    unit = float(np.abs(own).max())
    x, m = cp.Variable(problem.C.shape[0]), cp.Variable(columns.shape[1], nonneg=True)
    balance = p.C.T @ x == _loads(p, load_factor) + (own / unit) @ m
    least = cp.Problem(cp.Minimize(cp.sum(m)), [balance, *in_cone(p.F @ x + p.g, p.cones)])
    return np.maximum(_solved(Program(least, (m,)), problem, "masses", load_factor) / unit, 0.0)


def _loads(p: Scaled, load_factor: float) -> Array:
    return p.dead + load_factor / p.load_factor * p.live


def _solved(program: Program, problem: LimitProblem, word: str, load_factor: float) -> Array:
    """The first finite answer of a solver; the bounds of the reinforced structure judge it."""
    said = []
    for solver in solvers(bool(problem.cones.second_order)):
        found = solved(program, solver)
        if np.isfinite(found.values[0]).all() and "infeasible" not in found.status:
            return found.values[0]
        said.append(f"{solver.name} {found.status}")
    if any("infeasible" in one for one in said):
        required = load_factor / problem.units.live
        raise ModelError(f"the {word} cannot bring the structure to the load factor {required:g}")
    raise SolverFailure(f"no least {word} found: " + "; ".join(said))

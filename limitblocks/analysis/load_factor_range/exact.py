"""The least and the greatest load factor of all solutions of a small model, by a mixed-integer program.

With binary z for each yield row, and limits M of the slacks and Y of the multipliers,

    min or max a,   dead + a live = C^T x,   0 <= F x + g <= M (1 - z),   0 <= y <= Y z,
    C u + G^T y = 0,   live . u = 1.

M is exact where the admissible slack has a greatest value (a linear program a row); where it has none,
because the structure can be wedged, it is a cap that the result states. Y is a normalisation: mechanisms
are left out on which the live load works less than 1 / Y of the largest multiplier. It cannot be derived
from linear programs: mechanisms on which the live load does no work may be added to any other.
"""

from __future__ import annotations

import os
import sys
import time
from functools import cache
from typing import NamedTuple

import cvxpy as cp
import numpy as np

from limitblocks.analysis.load_factor_range.faces import Statics, kinematics, proven, statics
from limitblocks.analysis.programs import Program, Solver, solved
from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.problem import Flow, State

MULTIPLIERS = (
    10.0  # Y over the number of blocks, live load of unit work: one block alone has about their number
)
STRESSES = 10.0  # cap of M where it has no limit, over the sum of the dead loads
FEASIBLE = {"primal_feasibility_tolerance": 1e-9, "dual_feasibility_tolerance": 1e-9}
LINEAR = Solver("HIGHS", {"presolve": "off", **FEASIBLE}, conic=False)
MIXED = {"mip_feasibility_tolerance": 1e-9, "mip_rel_gap": 1e-7, **FEASIBLE}
AGREES = 1e-4  # of the bracket: answer and bound that are nearer prove each other


class Found(NamedTuple):
    """What the program found: the solution in its pieces, its bound, and the limits it worked under."""

    state: State | None
    bound: float
    stress_limit: float
    multiplier_limit: float
    seconds: float


def exact_extreme(flow: Flow, limits: tuple[float, float], sense: float, time_limit: float) -> Found:
    """Return the least (sense 1) or the greatest (sense -1) load factor of all solutions, dimensionless.

    See :func:`refuse` for what it cannot take.
    """
    begun, p = time.monotonic(), flow.problem
    _without_banner()
    static = statics(p, limits)
    inside = [*static.constraints, static.rows >= 0]
    largest = np.array([_greatest(static.rows[r], inside) for r in range(len(p.g))])
    cap = STRESSES * float(np.abs(p.dead).sum())
    capped = not bool(np.isfinite(largest).all())
    Y = MULTIPLIERS * len(p.blocks)
    u, y, z = cp.Variable(p.C.shape[1]), cp.Variable(len(p.g)), cp.Variable(len(p.g), boolean=True)
    program = cp.Problem(
        cp.Minimize(sense * static.load_factor),
        [
            *inside,
            *kinematics(flow, u, y),
            static.rows <= cp.multiply(np.minimum(largest, cap), 1 - z),
            y >= 0,
            y <= Y * z,
        ],
    )
    bound = sense * _solve(program, time_limit)
    state = None if z.value is None else _piece(flow, static, np.asarray(z.value, dtype=float), sense)
    return Found(state, bound, STRESSES if capped else np.inf, Y, time.monotonic() - begun)


@cache
def _without_banner() -> None:
    """Make the first HiGHS of the process while nothing it prints is seen: options come after its banner."""
    import highspy

    if sys.stdout is None:  # a program with windows alone shows nothing
        return
    sys.stdout.flush()
    seen, unseen = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(unseen, 1)
        highspy.Highs()  # type: ignore[no-untyped-call]
    finally:
        os.dup2(seen, 1)
        os.close(seen)
        os.close(unseen)


def refuse(flow: Flow) -> None:
    """Raise ModelError where no mixed-integer linear program says what the solutions are."""
    if flow.problem.cones.second_order:
        raise ModelError(
            "exact=True needs joints of planes, and this model has round friction, crushing or dowels; use "
            "PointContact(friction, cone='outer', sides=4), or 'inner', and no dowels: a polygon of friction "
            "has other solutions without dilatancy, so that the answer is an approximation"
        )
    if not flow.constant:
        raise ModelError("exact=True needs turning 'centroid': Table 5 depends on the stresses")


def _greatest(value: cp.Expression, constraints: list[cp.Constraint]) -> float:
    """Greatest value, infinite without a limit."""
    program = cp.Problem(cp.Maximize(value), constraints)
    solved(Program(program, ()), LINEAR)
    return float(program.value) if program.status == cp.OPTIMAL else np.inf


def _solve(program: cp.Problem, time_limit: float) -> float:
    """Solve by HiGHS and return the bound that it claims of the objective, infinite where it has none."""
    solved(Program(program, ()), Solver("HIGHS", {"time_limit": time_limit, **MIXED}, conic=False))
    statistics = getattr(program.solver_stats, "extra_stats", None)
    return float(getattr(statistics, "mip_dual_bound", -np.inf))


def _piece(flow: Flow, static: Statics, yields: Array, sense: float) -> State | None:
    """The certified solution of the piece in which these rows yield: stresses and mechanism by themselves."""
    p = flow.problem
    y, u = cp.Variable(len(p.g)), cp.Variable(p.C.shape[1])
    tight, free = np.flatnonzero(yields > 0.5), np.flatnonzero(yields <= 0.5)
    statically = [*static.constraints, static.rows >= 0, static.rows[tight] == 0]
    moving = [*kinematics(flow, u, y), y >= 0, y[free] == 0]
    aim = sense * static.load_factor + cp.sum(y)
    program = Program(
        cp.Problem(cp.Minimize(aim), [*statically, *moving]), (static.load_factor, static.x, u, y)
    )
    return proven(flow, program, lambda a, x, u, y: (a, x, u, y))

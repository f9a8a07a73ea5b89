"""Does it stand under its dead loads: with a margin, only by self-stress, or not at all."""

from __future__ import annotations

from collections.abc import Iterator

import cvxpy as cp
import numpy as np

from limitblocks.analysis.programs import Program, falling_program, in_cone, solved, solvers
from limitblocks.arrays import Array
from limitblocks.errors import NoEquilibrium, SolverFailure
from limitblocks.evidence.residuals import TOLERANCE, Residual, Residuals, static_residuals
from limitblocks.model import Model
from limitblocks.problem import LimitProblem

MOST = 1.0  # of the force of each interface: a structure that can be wedged at will has no largest margin
MOVING = 1e-3  # of the largest displacement rate: less counts as standing still
FALLING = 1e-6  # of the work of the weights on their blocks' lengths: surplus work below it counts as balance
CERTIFIED = 1e-7  # largest residual of a mechanism that proves that a structure falls


def standing_margin(model: Model, load_factor: float = 0.0) -> float:
    """Return the largest least distance to yield of all states in equilibrium, over the interfaces' forces.

    Over all stresses x in equilibrium with dead + load_factor live, the largest t such that each row of
    F x + g is at least t inside the cone K, t <= 1, every interface in its own unit of force. A state within
    the yield surface exists, and the loads stand (static theorem), exactly where t >= 0; below, -t is how much
    every yield function would have to be widened: what a root finder needs, and yes and no do not give. Joints
    without friction carry no shear; where therefore no stresses at all balance the loads, the margin is -1.

    Parameters
    ----------
    model : Model
        The structure.
    load_factor : float
        Of the live load.

    Raises
    ------
    SolverFailure
        If no solver finds a state whose recomputed equilibrium residual is within 1e-8.
    """
    problem = model.problem
    said = []
    for t, x, worst in _states(problem, load_factor * problem.units.live):
        if worst.value <= TOLERANCE or worst.name == "yield":
            return min(MOST, t, float(problem.cones.margin(problem.F @ x + problem.g).min()))
        said.append(f"{worst.name} residual {worst.value:.1e} at {worst.where}")
    if falls(problem, problem.dead + load_factor * problem.units.live * problem.live):
        return -MOST
    raise SolverFailure("how safely the loads stand is undecided: " + "; ".join(said))


def dead_load_state(problem: LimitProblem) -> Array:
    """Return stresses that carry the dead loads alone, as far within yield as they can be.

    Raises
    ------
    NoEquilibrium
        If a mechanism proves that they fall; it names the blocks.
    SolverFailure
        If neither is proven.
    """
    said = []
    for _, x, worst in _states(problem, 0.0):
        if worst.value <= TOLERANCE:
            return x
        said.append(f"{worst.name} residual {worst.value:.1e} at {worst.where}")
        fallen = falls(problem, problem.dead)
        if fallen:
            raise NoEquilibrium(fallen)
    raise SolverFailure("whether the dead loads stand is undecided: " + "; ".join(said))


def _states(problem: LimitProblem, load_factor: float) -> Iterator[tuple[float, Array, Residual]]:
    """Margins and states of one solver after the other, with the worst of their residuals."""
    loads = problem.dead + load_factor * problem.live
    for solver in solvers(bool(problem.cones.second_order)):
        t, x = solved(_standing_program(problem, loads), solver).values
        yield float(t), x, Residuals(static_residuals(problem, load_factor, x)).worst


def _standing_program(problem: LimitProblem, loads: Array) -> Program:
    """The largest margin t and its stresses. Variables: t, x."""
    t, x = cp.Variable(), cp.Variable(problem.C.shape[0])
    balance = problem.C.T @ x == loads
    inside = in_cone(problem.F @ x + problem.g - t * problem.cones.identity, problem.cones)
    return Program(cp.Problem(cp.Maximize(t), [balance, t <= MOST, *inside]), (t, x))


def falls(problem: LimitProblem, loads: Array) -> tuple[str, ...]:
    """Return the blocks that move in a mechanism which proves that the loads fall; none where none does."""
    for solver in solvers(bool(problem.cones.second_order)):
        u, y = solved(falling_program(problem, loads), solver).values
        flow = np.abs(problem.C @ u + problem.F.T @ y).max()
        surplus = loads @ u - problem.g @ y
        if flow < CERTIFIED and problem.cones.margin(y).min() > -CERTIFIED:
            speed = np.abs(u).reshape(-1, 6).max(axis=1) / problem.units.block_force
            moving = np.array(problem.blocks)[speed > MOVING * speed.max()]
            return tuple(moving.tolist()) if surplus > FALLING else ()
    return ()

"""From approximate static and kinematic solutions to proven ones: a little of a strictly admissible state.

A convex combination of a state at yield with one strictly within yield has room for the errors of both:
stresses with those of the dead loads of largest margin, a mechanism with one that opens every joint.
"""

from __future__ import annotations

import cvxpy as cp
import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from limitblocks.analysis.programs import Program, in_cone, solved, solvers
from limitblocks.analysis.stability import balanced
from limitblocks.arrays import Array
from limitblocks.evidence.proof import Proof, proof_of, room_of
from limitblocks.evidence.reach import Reach, kinematic_reach, static_reach
from limitblocks.evidence.spanning_tree import spanning_tree
from limitblocks.problem import LimitProblem, State

MOST = 0.1  # of the strictly admissible state
ROUNDS = 4  # of taking MORE of it, where the estimate of the least part was short
MORE = 4.0
LEAST = 1e-15


def certified(problem: LimitProblem, own: LimitProblem, state: State, dead: Array) -> tuple[State, Proof]:
    """Return static and kinematic solutions near those of `state` that prove their bounds, in SI units.

    A side for which no proof succeeds comes back as it was, and the proof says so.

    Parameters
    ----------
    problem : LimitProblem
        The model's.
    own : LimitProblem
        The same in the units of `state`.
    state : State
        A pair of bounds, dimensionless.
    dead : Array, shape (s,)
        Stresses strictly within yield that carry the dead loads, in the units of `own`.
    """
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        static = _static(problem, own, state, dead)
        moving = _kinematic(problem, own, state, dead)
        both = State(static.load_factor, static.x, moving.u, moving.y)
        return both, proof_of(problem, both, dead * own.stress_units)


def _static(problem: LimitProblem, own: LimitProblem, state: State, dead: Array) -> State:
    """Stresses that prove a load factor hardly below that of the state, in SI units."""
    x, inner = balanced(own, state.load_factor, state.x), balanced(own, 0.0, dead)
    tree = spanning_tree(own, room_of(own, inner))
    part = _part(static_reach(own, state.load_factor, x, tree), static_reach(own, 0.0, inner, tree))
    for _ in range(ROUNDS):
        if not part <= MOST:
            break
        mixed = State((1.0 - part) * state.load_factor, x + part * (inner - x), state.u, state.y)
        si = own.in_si(mixed)
        if not proof_of(problem, si, inner * own.stress_units).static:
            return si
        part = max(MORE * part, LEAST)
    return own.in_si(state)


def _kinematic(problem: LimitProblem, own: LimitProblem, state: State, dead: Array) -> State:
    """A mechanism that proves a load factor hardly above that of the state, in SI units."""
    solver = solvers(bool(own.cones.second_order))[0]
    inner = solved(opening_program(own), solver).values
    if not all(np.isfinite(part).all() for part in inner):
        return own.in_si(state)
    u, y = state.u, compatible(own, state.u, state.y)
    v, z = inner[0], compatible(own, *inner)
    part = _part(kinematic_reach(own, u, y), kinematic_reach(own, v, z))
    for _ in range(ROUNDS):
        if not part <= MOST:
            break
        si = own.in_si(State(state.load_factor, state.x, u + part * v, y + part * z))
        if not proof_of(problem, si, dead * own.stress_units).kinematic:
            return si
        part = max(MORE * part, LEAST)
    return own.in_si(state)


def _part(reach: Reach, inner: Reach) -> float:
    """Least part of the inner state whose room pays for what both need; infinite where it has none."""
    need = reach.need + inner.need
    short = ~(reach.room >= need)
    gain = inner.room[short] - reach.room[short]
    parts = np.where(gain > 0.0, (need - reach.room)[short] / gain, np.inf)
    return float(parts.max(initial=0.0))


def opening_program(problem: LimitProblem) -> Program:
    """The mechanism that opens every joint by at least one at the least power. Variables: u, y.

    Infeasible exactly where the structure can be wedged: where C^T x = 0 with F x in K, F x not zero
    (theorem of alternatives; Boyd & Vandenberghe 2004, Section 5.8).
    """
    u, y = cp.Variable(problem.C.shape[1]), cp.Variable(problem.F.shape[0])
    flow = problem.C @ u + problem.F.T @ y == 0
    power = problem.g @ y - problem.dead @ u
    return Program(
        cp.Problem(cp.Minimize(power), [flow, *in_cone(y - problem.cones.identity, problem.cones)]), (u, y)
    )


def compatible(problem: LimitProblem, u: Array, y: Array) -> Array:
    """Return the multipliers nearest to y that satisfy the flow rule with u, to rounding."""
    lu = linalg.splu(sparse.csc_array(problem.F.T @ problem.F))
    for _ in range(2):
        y = y - problem.F @ lu.solve(problem.C @ u + problem.F.T @ y)
    return np.asarray(y)

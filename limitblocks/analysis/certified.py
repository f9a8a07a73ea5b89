"""From approximate static and kinematic solutions to proven ones: a little of a strictly admissible state.

A convex combination of a state at yield with one strictly within yield has room for the errors of both:
stresses with those of the dead loads of largest margin, a mechanism with one that opens every joint.
"""

from __future__ import annotations

import cvxpy as cp
import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from limitblocks.analysis.polish import polish
from limitblocks.analysis.programs import Program, in_cone, solved, solvers
from limitblocks.analysis.stability import balanced
from limitblocks.arrays import Array
from limitblocks.evidence.proof import Proof, proof_of, room_of
from limitblocks.evidence.reach import Reach, kinematic_reach, static_reach
from limitblocks.evidence.spanning_tree import spanning_tree
from limitblocks.problem import ASSOCIATED, Flow, LimitProblem, State

CLOSE = 1e-8  # width of an interval that needs no polish
MOST = 0.1  # of the strictly admissible state
ROUNDS = 4  # of taking MORE of it, where the estimate of the least part was short
MORE = 4.0
LEAST = 1e-15
RESERVE = 2.0  # times the room that the proof needs here, for machines that sum in another order


def certified(problem: LimitProblem, own: LimitProblem, state: State, dead: Array) -> tuple[State, Proof]:
    """Return static and kinematic solutions near those of `state` that prove their bounds, in units of `own`.

    Where they leave more than CLOSE between them, those of the polished state are taken if closer.

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
    inner = State(0.0, dead, *opening(own))
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        first = _certified(problem, own, state, inner)
        if first[1].width <= CLOSE:
            return first
        polished = polish(Flow(own, ASSOCIATED), state)
        if polished is state:
            return first
        return min(first, _certified(problem, own, polished, inner), key=lambda one: one[1].width)


def _certified(problem: LimitProblem, own: LimitProblem, state: State, inner: State) -> tuple[State, Proof]:
    """Both sides proven with a little of the inner state; its stresses carry the dead loads."""
    static, moving = _static(problem, own, state, inner), _kinematic(problem, own, state, inner)
    both = State(static.load_factor, static.x, moving.u, moving.y)
    return both, _proof(problem, own, both, inner)


def _proof(problem: LimitProblem, own: LimitProblem, state: State, inner: State) -> Proof:
    return proof_of(problem, own.in_si(state), inner.x * own.stress_units, RESERVE)


def _static(problem: LimitProblem, own: LimitProblem, state: State, strict: State) -> State:
    """Stresses that prove a load factor hardly below that of the state; the state itself if none do."""
    x, inner = balanced(own, state.load_factor, state.x), balanced(own, 0.0, strict.x)
    tree = spanning_tree(own, room_of(own, inner))
    part = _part(static_reach(own, state.load_factor, x, tree), static_reach(own, 0.0, inner, tree))
    for _ in range(ROUNDS):
        if not part <= MOST:
            break
        mixed = State((1.0 - part) * state.load_factor, x + part * (inner - x), state.u, state.y)
        if not _proof(problem, own, mixed, strict).static:
            return mixed
        part = max(MORE * part, LEAST)
    return state


def _kinematic(problem: LimitProblem, own: LimitProblem, state: State, strict: State) -> State:
    """A mechanism that proves a load factor hardly above that of the state; the state itself if none does."""
    if not (np.isfinite(strict.u).all() and np.isfinite(strict.y).all()):
        return state
    u, y = state.u, compatible(own, state.u, state.y)
    v, z = strict.u, compatible(own, strict.u, strict.y)
    part = _part(kinematic_reach(own, u, y), kinematic_reach(own, v, z))
    for _ in range(ROUNDS):
        if not part <= MOST:
            break
        work = 1.0 + part * float(own.live @ v)  # of the live load, Eq. (55)
        mixed = State(state.load_factor, state.x, (u + part * v) / work, (y + part * z) / work)
        if not _proof(problem, own, mixed, strict).kinematic:
            return mixed
        part = max(MORE * part, LEAST)
    return state


def _part(reach: Reach, inner: Reach) -> float:
    """Least part of the inner state whose room pays for what both need; infinite where it has none."""
    need = reach.need + inner.need
    short = ~(reach.room >= need)
    gain = inner.room[short] - reach.room[short]
    parts = np.where(gain > 0.0, (need - reach.room)[short] / gain, np.inf)
    return float(parts.max(initial=0.0))


def opening(problem: LimitProblem) -> tuple[Array, Array]:
    """Rates and multipliers of a mechanism that opens every joint; not finite where there is none."""
    u, y = solved(opening_program(problem), solvers(bool(problem.cones.second_order))[0]).values
    return u, y


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

"""From approximate static and kinematic solutions to proven ones: a little of a strictly admissible state.

A convex combination of a state at yield with one strictly within yield has room for the errors of both:
stresses with those of the dead loads of largest margin, a mechanism with one that opens every joint.
"""

from __future__ import annotations

import cvxpy as cp
import numpy as np

from limitblocks.analysis.in_plane import in_plane
from limitblocks.analysis.polish import polish
from limitblocks.analysis.programs import Program, in_cone, solved, solvers
from limitblocks.analysis.scales import Scaled, balanced, compatible, scaled
from limitblocks.arrays import Array
from limitblocks.evidence.proof import Proof, own_units, proof_of, room_of
from limitblocks.evidence.reach import Reach, kinematic_reach, static_reach
from limitblocks.evidence.spanning_tree import spanning_tree
from limitblocks.problem import ASSOCIATED, Flow, LimitProblem, State

CLOSE = 1e-8  # width of an interval that needs no polish
MOST = 0.1  # of the strictly admissible state
ROUNDS = 4  # of taking MORE of it, where the estimate of the least part was short
MORE = 4.0
LEAST = 1e-15
RESERVE = 2.0  # times the room that the proof needs here, for machines that sum in another order


def certified(problem: LimitProblem, state: State, dead: Array) -> tuple[State, Proof]:
    """Return static and kinematic solutions near those of `state` that prove their bounds.

    Where they leave more than CLOSE between them, those of the polished state are taken if closer. A side
    for which no proof succeeds comes back as it was, and the proof says so.

    Parameters
    ----------
    problem : LimitProblem
        The model's, ``model.problem``.
    state : State
        A pair of bounds, dimensionless.
    dead : Array, shape (s,)
        Stresses strictly within yield that carry the dead loads, dimensionless.
    """
    own = own_units(problem, state)
    given = own.dimensionless(problem.in_si(state))
    p = scaled(own)
    strict = State(0.0, dead * problem.stress_units / own.stress_units, *_opened(problem, p))
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        found, proof = _certified(problem, p, given, strict)
        if proof.width > CLOSE:
            polished = _polished(problem, own, given)
            closer, better = _certified(problem, p, polished, strict)
            found, proof = (closer, better) if better.width < proof.width else (found, proof)
    return problem.dimensionless(own.in_si(found)), proof


def _certified(problem: LimitProblem, p: Scaled, state: State, strict: State) -> tuple[State, Proof]:
    """Both sides proven with a little of the strictly admissible state."""
    static, moving = _static(problem, p, state, strict), _kinematic(problem, p, state, strict)
    both = State(static.load_factor, static.x, moving.u, moving.y)
    return both, _proof(problem, p, both, strict)


def _opened(problem: LimitProblem, p: Scaled) -> tuple[Array, Array]:
    """A mechanism that opens every joint, in the plane if there is one: where one exists, one does there."""
    plane = in_plane(problem, every_row=True)
    if plane is None:
        return opening(p)
    plane = plane.measured(p.problem)
    u, y = opening(scaled(plane.problem))
    found = plane.lifted(State(0.0, np.zeros(plane.problem.C.shape[0]), u, y))
    return found.u, found.y


def _polished(problem: LimitProblem, own: LimitProblem, state: State) -> State:
    """The state polished, in the plane if there is one."""
    plane = in_plane(problem)
    if plane is None:
        return polish(Flow(own, ASSOCIATED), state)
    plane = plane.measured(own)
    return plane.lifted(polish(Flow(plane.problem, ASSOCIATED), plane.averaged(state)))


def _proof(problem: LimitProblem, p: Scaled, state: State, strict: State) -> Proof:
    return proof_of(problem, p.problem.in_si(state), strict.x * p.problem.stress_units, RESERVE)


def _static(problem: LimitProblem, p: Scaled, state: State, strict: State) -> State:
    """Stresses that prove a load factor hardly below that of the state; the state itself if none do."""
    own, a = p.problem, state.load_factor
    x, inner = _in_equilibrium(p, a, state.x), _in_equilibrium(p, 0.0, strict.x)
    tree = spanning_tree(own, room_of(own, inner))
    part = _part(static_reach(own, a, x, tree), static_reach(own, 0.0, inner, tree))
    for _ in range(ROUNDS):
        if not part <= MOST:
            break
        mixed = State((1.0 - part) * a, x + part * (inner - x), state.u, state.y)
        if not _proof(problem, p, mixed, strict).static:
            return mixed
        part = max(MORE * part, LEAST)
    return state


def _kinematic(problem: LimitProblem, p: Scaled, state: State, strict: State) -> State:
    """A mechanism that proves a load factor hardly above that of the state; the state itself if none does."""
    if not (np.isfinite(strict.u).all() and np.isfinite(strict.y).all()):
        return state
    own, u, v = p.problem, state.u, strict.u
    y, z = _following(p, u, state.y), _following(p, v, strict.y)
    part = _part(kinematic_reach(own, u, y), kinematic_reach(own, v, z))
    for _ in range(ROUNDS):
        if not part <= MOST:
            break
        work = 1.0 + part * float(own.live @ v)  # of the live load, Eq. (55)
        mixed = State(state.load_factor, state.x, (u + part * v) / work, (y + part * z) / work)
        if not _proof(problem, p, mixed, strict).kinematic:
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


def _in_equilibrium(p: Scaled, load_factor: float, x: Array) -> Array:
    """The nearest stresses that balance the loads, to rounding."""
    loads = p.dead + load_factor / p.load_factor * p.live
    return np.asarray(p.stress * balanced(p, loads, x / p.stress))


def _following(p: Scaled, u: Array, y: Array) -> Array:
    """The nearest multipliers that satisfy the flow rule with the rates, to rounding."""
    rates, multipliers = u * p.equation / p.load_factor, y * p.row / p.load_factor
    return np.asarray(compatible(p, rates, multipliers) * p.load_factor / p.row)


def opening(p: Scaled) -> tuple[Array, Array]:
    """Rates and multipliers of a mechanism that opens every joint; not finite where there is none."""
    u, y = solved(opening_program(p), solvers(bool(p.cones.second_order))[0]).values
    state = p.in_problem(State(0.0, np.zeros(len(p.stress)), u, y))
    return state.u, state.y


def opening_program(problem: Scaled) -> Program:
    """The mechanism that opens every joint by at least one at the least power. Variables: u, y.

    Infeasible exactly where the structure can be wedged: where C^T x = 0 with F x in K, F x not zero
    (theorem of alternatives; Boyd & Vandenberghe 2004, Section 5.8).
    """
    u, y = cp.Variable(problem.C.shape[1]), cp.Variable(problem.F.shape[0])
    flow = problem.C @ u + problem.F.T @ y == 0
    power = problem.g @ y - problem.dead @ u
    opened = in_cone(y - problem.cones.identity, problem.cones)
    return Program(cp.Problem(cp.Minimize(power), [flow, *opened]), (u, y))

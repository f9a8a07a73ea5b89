"""The outer loop alone: one associated limit analysis after the other, each with the friction of the last.

Gilbert, Casapulla & Ahmed (2006), Computers & Structures 84, 873-887, freeze the friction of every contact at
the normal force N_k of the last analysis, solve the associated problem that this gives, and repeat until the
load factor stands still. Here every row whose flow is not its gradient is frozen, as in
:mod:`limitblocks.analysis.nonassociated.frozen_flow`. Three things keep the rounds from wandering, the first
two theirs:

- the envelope is rotated about the point of N_k a little beyond zero dilatancy, so that a joint under more
  pressure than N_k carries less: rows F_k = G - r (F - G), for Coulomb |V| <= (1 + r) mu |N_k| - r mu |N|,
  with a rotation r that fades;
- under-relaxation, x_k+1 = beta x + (1 - beta) x_k;
- a little cohesion, in proportion to r, where frozen friction would be nothing: without it contacts with
  N_k = 0 leave the next analysis without a solution.

No proof says that the rounds converge, or where to. A load factor that stands still is no solution yet:
friction may be off by 1e-2 then. The two programs of :mod:`limitblocks.analysis.nonassociated.fixed_point`,
which change the stresses no more than they must, close it, and the residuals of Eqs (54)-(59) decide.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import cvxpy as cp
import numpy as np

from limitblocks.analysis.nonassociated.fixed_point import NearestStresses, fixed_point
from limitblocks.analysis.nonassociated.path_record import FROZEN, INTERRUPTED
from limitblocks.analysis.polish import polish
from limitblocks.analysis.programs import Program, answers, in_cone
from limitblocks.arrays import Array
from limitblocks.evidence.residuals import mcp_residuals
from limitblocks.evidence.results import Iteration
from limitblocks.problem import Flow, State
from limitblocks.shown import many


@dataclass(frozen=True)
class Rounds:
    """How the loop goes on; rotation and relaxation are those of Gilbert et al. (2006).

    Of 20 models (the four walls of Ferris & Tin-Loi, a corner and a lintel pushed three ways, both joints) 19
    are solved; 12 without cohesion, 18 without relaxation, 19 without rotation, but then wall 3 ends 8 % and
    wall 4 17 % above the published value.

    Attributes
    ----------
    rotation, fading : float
        First rotation r of the envelopes over the friction coefficient, and its factor from round to round.
    relaxation : float
        Part beta of the new stresses in those that friction is frozen at.
    cohesion : float
        Friction where there is none, over r times the largest frozen one.
    still : float
        Relative change of the load factor from which on the round is closed.
    drift : float
        Relative change of the load factor up to which what closes a round belongs to it; farther solutions
        are kept in case no round does better.
    near : float
        Residual from which on Newton's method takes over from the two programs.
    most, closing : int
        Rounds, and those of the two programs that close one.
    """

    rotation: float = 0.3
    fading: float = 0.7
    relaxation: float = 0.6
    cohesion: float = 0.1
    still: float = 1e-4
    drift: float = 1e-3
    near: float = 1e-6
    most: int = 60
    closing: int = 5


def frozen_limit(flow: Flow, x: Array, rotation: float, cohesion: float) -> State | None:
    """Limit load, stresses (its dual) and mechanism with the flow frozen at x; None if none is found."""
    p, G = flow.problem, flow.matrix(x)
    lost = p.F - G
    held = lost @ x
    frictional = np.bincount(p.cones.member, abs(lost).sum(axis=1), p.cones.degree) > 0.0
    slack = cohesion * rotation * np.abs(held).max() * p.cones.identity * frictional[p.cones.member]
    u, y, h = cp.Variable(p.C.shape[1]), cp.Variable(len(p.g)), p.g + (1.0 + rotation) * held + slack
    follows = p.C @ u + (G - rotation * lost).T @ y == 0
    constraints = [follows, p.live @ u == 1, *in_cone(y, p.cones)]
    program = Program(cp.Problem(cp.Minimize(h @ y - p.dead @ u), constraints), (u, y))
    for found in answers(program, p.cones):
        (u, y), stresses = found.values, found.duals[0]
        if np.isfinite(stresses).all():
            return State(float(h @ y - p.dead @ u), stresses, u, y)
    return None


def outer_loop(
    flow: Flow,
    x: Array,
    tolerance: float,
    record: Callable[[State, float, int], None],
    rounds: Rounds = Rounds(),
) -> tuple[State, str]:
    """Return the solution that the rounds lead to, or their state of least residual, and how it was found.

    Where the user stops it these are of the rounds until then.

    Parameters
    ----------
    flow : Flow
        The limit problem and its flow rule.
    x : Array, shape (s,)
        Stresses that friction is first frozen at: those of the associated limit load.
    tolerance : float
        Largest residual of a solution.
    record : callable
        Called with the state, the rotation and the number of each round.
    rounds : Rounds
        Settings.
    """
    problem = flow.problem
    nearest = NearestStresses(problem)
    rotation, last = rounds.rotation, np.inf
    met = [State(0.0, x, np.zeros(problem.C.shape[1]), np.zeros(len(problem.g)))]
    closed: list[tuple[float, State, int]] = []  # drift of the load factor, solution, round
    stopped = ""
    try:
        for k in range(1, rounds.most + 1):
            frozen = frozen_limit(flow, x, rotation, rounds.cohesion)
            if frozen is None:
                break
            met.append(frozen)
            record(frozen, rotation, k)
            size = abs(frozen.load_factor)
            if abs(frozen.load_factor - last) <= rounds.still * size:
                state = _closed(nearest, frozen, flow, tolerance, rounds)
                if state is not None:
                    drift = abs(state.load_factor - frozen.load_factor)
                    closed.append((drift, state, k))
                    if drift <= rounds.drift * size:
                        break
            last, rotation = frozen.load_factor, rotation * rounds.fading
            x = rounds.relaxation * frozen.x + (1.0 - rounds.relaxation) * x
    except KeyboardInterrupt:
        stopped = f", {INTERRUPTED}"
    if closed:
        _, state, k = min(closed, key=lambda one: one[0])
        return state, f"{FROZEN}, {many(k, 'round')}{stopped}"
    best = min(met, key=lambda state: mcp_residuals(flow, state).worst.value)
    return best, f"{FROZEN}, not closed in {many(len(met) - 1, 'round')}{stopped}"


def _closed(
    nearest: NearestStresses, frozen: State, flow: Flow, tolerance: float, rounds: Rounds
) -> State | None:
    """The solution that the two programs and Newton's method make of a round, None if it is none."""
    near = fixed_point(nearest, frozen, flow, max(tolerance, rounds.near), rounds.closing)
    state = polish(flow, frozen if near is None else near)
    return state if mcp_residuals(flow, state).worst.value <= tolerance else None


def told(flow: Flow, state: State, rotation: float, number: int) -> Iteration:
    """What a round of the outer loop tells the user."""
    load_factor = float(state.load_factor / flow.problem.units.live)
    residuals = mcp_residuals(flow, state).to_dict()
    return Iteration(load_factor, FROZEN, rotation, residuals, number, 0)

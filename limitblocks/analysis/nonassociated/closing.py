"""From the end of a path that winds to a solution, by rounds of the two convex programs of the fixed point.

The mechanism of least gap y . (F x + g) for the stresses x, then the stresses nearest to x that leave no
gap: the gap falls from round to round, by a factor that stands still where the rows that yield are known,
and is near one where they are not. So the next round starts from stresses extrapolated from the last ones
(Anderson 1965, Journal of the ACM 12, with one round of memory), and the factor tells whether to go on.
Complementary pivots close what is left near a solution.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from limitblocks.analysis.nonassociated.fixed_point import NearestStresses, frozen_mechanism
from limitblocks.analysis.nonassociated.path_record import ROUNDS
from limitblocks.analysis.pivot import pivoted
from limitblocks.analysis.polish import defect
from limitblocks.arrays import Array
from limitblocks.problem import Flow, State
from limitblocks.shown import many

# With .3 a facade of 508 blocks (point contacts, out) stays open, with .4 it closes in two minutes.
FALLS = 0.4  # a round: where the gap falls less, on average since the first, rounds are given up
EPSILON = float(np.finfo(float).eps)
NEAR = 1e-5  # residual where pivots are tried: from 1e-4 on they change nothing

Round = tuple[Array, Array]  # stresses after a round, and what it changed


@dataclass
class Closing:
    """Rounds from a state; how many they were the last time, and the solution they led to."""

    flow: Flow
    tolerance: float
    rounds: int = 0
    solution: State | None = None

    def __post_init__(self) -> None:
        self.nearest = NearestStresses(self.flow.problem)

    def __call__(self, state: State) -> State:
        """Return the best state met."""
        best, self.rounds = closed(self.flow, self.nearest, state, self.tolerance)
        self.solution = best if defect(self.flow, best) <= self.tolerance else None
        return best

    @property
    def how(self) -> str:
        """How many rounds they were, in words that follow those of a path."""
        return f", {many(self.rounds, 'round')} {ROUNDS}"


def closed(flow: Flow, nearest: NearestStresses, start: State, tolerance: float) -> tuple[State, int]:
    """Return the best state met from `start` on, and the number of rounds.

    Parameters
    ----------
    flow : Flow
        The limit problem and its flow rule.
    nearest : NearestStresses
        Its second program.
    start : State
        The end of a path, dimensionless.
    tolerance : float
        Residual of Eqs (54)-(59) at which the rounds end.
    """
    best, least = start, defect(flow, start)
    x, allowed, last, k = start.x, np.inf, None, 0
    while True:
        k += 1
        mechanism = frozen_mechanism(flow, x)
        found = nearest.find(x, mechanism[1]) if mechanism else None
        if mechanism is None or found is None:
            return best, k
        state = State(*found, *mechanism)
        round_ = found[1], found[1] - x
        gap = abs(float((flow.problem.F @ state.x + flow.problem.g) @ state.y))
        worst = defect(flow, state)
        if tolerance < worst <= NEAR:
            state = pivoted(flow, state)
            worst = defect(flow, state)
        if worst < least:
            best, least = state, worst
        allowed = gap if k == 1 else FALLS * allowed
        if least <= tolerance or gap > max(allowed, tolerance) or allowed < EPSILON:
            return best, k
        x, last = ahead(round_, last, flow.problem.compliance), round_


def ahead(now: Round, last: Round | None, weights: Array) -> Array:
    """Return the stresses where the rounds would stand still, were they linear on the line of the last two.

    Parameters
    ----------
    now, last : tuple of Array, shape (s,) each
        Stresses after a round, and what it changed; dimensionless.
    weights : Array, shape (s,)
        Compliance, which measures changes.
    """
    x, change = now
    if last is None:
        return x
    turn = weights * (change - last[1])
    size = float(turn @ (change - last[1]))
    return x - (float(turn @ change) / size if size else 0.0) * (x - last[0])

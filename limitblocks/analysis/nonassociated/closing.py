"""From the end of a path that winds to a solution, by rounds of the two convex programs of the fixed point.

The mechanism of least gap y . (F x + g) for the stresses x, then the stresses nearest to x that leave no
gap: the gap falls from round to round, by a factor that is a third or less where the rows that yield are
known, and near one where they are not. So the factor tells whether to go on. Complementary pivots close what
is left near a solution.
"""

from __future__ import annotations

import numpy as np

from limitblocks.analysis.nonassociated.fixed_point import NearestStresses, frozen_mechanism
from limitblocks.analysis.pivot import pivoted
from limitblocks.analysis.polish import defect
from limitblocks.problem import Flow, State

ROUNDS = 30
AHEAD = 10  # rounds: where the gap would take more at its last factor they are given up
NEAR = 1e-5  # residual where pivots are tried: from 1e-4 on they change nothing


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
    problem, x, last = flow.problem, start.x, np.inf
    for k in range(1, ROUNDS + 1):
        mechanism = frozen_mechanism(flow, x)
        found = nearest.find(x, mechanism[1]) if mechanism else None
        if mechanism is None or found is None:
            return best, k
        x = found[1]
        state = State(found[0], x, *mechanism)
        worst = defect(flow, state)
        if tolerance < worst <= NEAR:
            state = pivoted(flow, state)
            worst = defect(flow, state)
        if worst < least:
            best, least = state, worst
        gap = float((problem.F @ x + problem.g) @ mechanism[1])
        if least <= tolerance or gap * min(gap / last, 1.0) ** AHEAD > tolerance:
            return best, k
        last = gap
    return best, ROUNDS

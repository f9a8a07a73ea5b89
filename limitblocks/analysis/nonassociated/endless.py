"""Where increments end short of collapse: one more without end, by a path from the stresses that they left.

On it the compliance fades as the displacement grows without limit, as on that of `nonassociated` from the
permanent loads. Rounds of the fixed point come first: from a collapse that hardly changes they end nearest.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from limitblocks.analysis.nonassociated.closing import Closing
from limitblocks.analysis.nonassociated.each_way import Given, Way
from limitblocks.analysis.nonassociated.loading import near
from limitblocks.analysis.nonassociated.path_record import INTERRUPTED, UNSETTLED
from limitblocks.analysis.nonassociated.ways import means_of
from limitblocks.analysis.polish import defect
from limitblocks.evidence.residuals import mcp_residuals
from limitblocks.problem import State

FAR = 0.1  # of the load factor: a solution farther from where the increments end is not where they lead


def endless(given: Given, last: State, began: bool = True) -> Way | None:
    """Return the solution that the last state of increments leads to, and which way; None if it is far.

    The first with the load factor of that state, else the nearest; the first of all where none `began`.
    """
    nearest: Way | None = None
    least = FAR * abs(last.load_factor) if began else np.inf
    for state, how in _ways(given, last):
        if how.endswith(INTERRUPTED):
            if nearest is None:
                raise KeyboardInterrupt
            break
        solved = UNSETTLED not in how and mcp_residuals(given.flow, state).worst.value <= given.tolerance
        off = abs(state.load_factor - last.load_factor)
        if solved and off <= least:
            nearest, least = (state, how), off
            if not began or near(state, last.load_factor):
                break
    return nearest


def _ways(given: Given, last: State) -> Iterator[Way]:
    """Ends of rounds, and of paths and rounds from their ends, and which they were."""
    closing = Closing(given.flow, given.tolerance)
    state, how = given.closed_in_rounds(last, "", closing)
    yield state, how.removeprefix(", ")
    for one in means_of(given.flow):
        state, how = given.polished(*given.tracked(one))
        yield state, how
        if defect(given.flow, state) > given.tolerance:
            yield given.closed_in_rounds(state, how, closing)

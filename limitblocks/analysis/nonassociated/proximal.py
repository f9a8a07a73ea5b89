"""From the end of a path in a plane, which leaves 1e-9 of flow in thousands of joints, to an exact solution.

The stresses at such an end admit no mechanism: the rows near yield fit together only as far as compliance is
left. Proximal steps (Rockafellar 1976, SIAM J. Control 14), each a linear complementarity problem solved by
pivots, leave delta (z - z_k) of the equations: stresses creep, and rows start and stop to yield, until they
stand still. As in the proximal method delta falls where a step succeeds; where
pivots find no end it grows.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from limitblocks.analysis.pivot import step
from limitblocks.analysis.polish import defect, polished
from limitblocks.evidence.residuals import TOLERANCE
from limitblocks.problem import Flow, State

FIRST, FALL, RISE, LEAST = 1e-3, 0.6, 4.0, 1e-10  # delta
FIRM = 1e-6  # delta of the last steps: rounding counts for little
STEPS, FAILURES = 100, 4  # failures in turn count as one: else a wall ends at 1.5e-4, not 1.4e-9
OPEN = 1500  # pairs that may be unsure in a step: the first has some hundreds in walls of 1,000 blocks
STANDS = 1e-6  # change of stresses in a step, over the largest: they stand still


@dataclass
class Still:
    """Proximal steps from a state near a solution: once on a path, they take as long as half of it."""

    flow: Flow
    tried: bool = False

    def __call__(self, state: State) -> State:
        """Return the better of the state and that at which proximal steps end."""
        if self.tried or not self.flow.constant:
            return state
        self.tried = True
        return standing_still(self.flow, state)


@np.errstate(all="ignore")  # a state that ran away is not kept
def standing_still(flow: Flow, state: State) -> State:
    """Return the state at which proximal steps end, polished, or that given where its residual is less.

    Parameters
    ----------
    flow : Flow
        The limit problem and its flow rule, that of twists about the centroid.
    state : State
        The end of a path, dimensionless.
    """
    now, delta, failures, failed = state, FIRST, 0, False
    for _ in range(STEPS):
        found = step(flow, now, delta, OPEN)
        if found is None:
            delta, failures, failed = RISE * delta, failures + (not failed), True
            if failures == FAILURES:
                break
            continue
        change, now, failed = np.abs(found.x - now.x).max(), found, False
        delta = max(FALL * delta, LEAST)
        if change <= STANDS * np.abs(now.x).max():
            break
    for _ in range(3):
        now = step(flow, now, FIRM, OPEN) or now
    end, left = polished(flow, now, defect(flow, now), until=1e-3 * TOLERANCE, patience=3)
    return end if left < defect(flow, state) else state

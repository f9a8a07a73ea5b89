"""Whether the load factor of a path stands still where its residuals are within the tolerance.

Residuals within 1e-8 leave a row a thousandth from yield and flowing at 1e-5. Near a geometry where blocks
jam, joints turned by 1e-6, the path folds below that: the load factor falls by a quarter on the rest of it.
So a state within the tolerance ends a path if it is exact for a model nearby, or if the load factor stands
still; else the path is followed on.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from limitblocks.analysis.polish import defect
from limitblocks.evidence.backward_error import LARGE, backward_error
from limitblocks.evidence.measure import Measure
from limitblocks.evidence.residuals import TOLERANCE
from limitblocks.problem import Flow, State

EXACT = 1e-10  # residual that only a polish reaches: none of 278 rows has then a large backward error
LESS = 0.1  # of the residual, from EXACT on, where it is asked for again: it costs 100 factorisations
STILL = 1e-4  # change of the load factor
# Factorisations beyond the tolerance: at most; without a change from the first one on; and after a change.
# A corner of 30 blocks moved by 1e-6 to 1e-5 m ends 26 to 1,080 beyond it, and changes all 16 of them; a
# facade of 160 (friction .4, out) all 65, and does not end.
FURTHER, SOON, LATER = 1100, 60, 240
DRIFT = 0.01  # of the load factor, from the point to its polish: farther it is another path's solution


def exact_nearby(flow: Flow, state: State) -> bool:
    """Whether a state is exact for a model nearby."""
    return backward_error(flow, state, LARGE).value <= LARGE


@dataclass
class Settling:
    """The best state of a path, where that came within the tolerance, and how the load factor changed since.

    `left` is the worst residual of the best state; changes are measured by `unit`, the size of the load
    factor. The backward error is asked for where the residual is at most `judged`. The path came within the
    tolerance after `within` factorisations, and the load factor is `last` since as many as `since`.
    """

    flow: Flow
    best: State | None = None
    left: float = np.inf
    last: float | None = None
    unit: float = 1.0
    within: int = 0
    since: int = 0
    changes: bool = False
    judged: float = TOLERANCE

    def keep(self, state: State, reached: State, residual: float | None = None) -> None:
        """Keep a state as the best one met, unless it belongs to another path than the point reached."""
        residual = defect(self.flow, state) if residual is None else residual
        apart = abs(state.load_factor - reached.load_factor)
        if apart <= DRIFT * abs(reached.load_factor) and residual < self.left:
            self.best, self.left = state, residual

    def ends(self) -> bool:
        """Whether the best state is exact for a model nearby."""
        if self.best is None or self.left > self.judged:
            return False
        if self.left <= EXACT and self.last is None:
            return True
        self.judged = min(LESS * self.left, EXACT)
        return exact_nearby(self.flow, self.best)

    def stands_still(self, reached: State, factorisations: int) -> bool:
        """Whether the load factor of a path within the tolerance has not changed for a while."""
        if self.last is None:
            self.unit, self.within = Measure(self.flow.problem, reached).power, factorisations
        if self.last is None or self._apart(reached):
            self.changes = self.last is not None
            self.last, self.since = reached.load_factor, factorisations
        soon = LATER if self.changes else SOON
        if factorisations < self.since + soon or self._apart(self.best or reached):
            return False
        self.changes = False
        return True

    def _apart(self, state: State) -> bool:
        return self.last is not None and abs(state.load_factor - self.last) > STILL * self.unit

    @property
    def unsettled(self) -> bool:
        """Whether the end of a path is within the tolerance and yet no answer: exact for no model nearby."""
        return self.changes and self.best is not None and not exact_nearby(self.flow, self.best)

"""Whether the load factor of a path stands still where its residuals are within the tolerance.

Residuals within 1e-8 leave a row a thousandth from yield and flowing at 1e-5. Near a geometry where blocks
jam, joints turned by 1e-6, the path folds below that: the load factor falls by a quarter on the rest of it.
So a state within the tolerance ends a path if it is exact for a model nearby, or if the load factor stands
still; else the path is followed on.
"""

from __future__ import annotations

from dataclasses import dataclass

from limitblocks.evidence.backward_error import LARGE, backward_error
from limitblocks.evidence.measure import Measure
from limitblocks.evidence.residuals import TOLERANCE
from limitblocks.problem import Flow, State

EXACT = 1e-10  # residual that only a polish reaches: none of 278 rows has then a large backward error
LEFT, LESS = (
    1e-11,
    0.1,
)  # residual at which it is asked for again, and of that then: it costs 100 factorisations
STILL = 1e-4  # change of the load factor
# A corner of 30 blocks moved by 1e-6 to 1e-5 m ends 26 to 1,080 factorisations beyond the tolerance.
FURTHER, SOON = (
    1100,
    60,
)  # factorisations beyond it: at most, and until the load factor is one that stands still


@dataclass
class Settling:
    """Where a path came within the tolerance, and by how much the load factor changed since, over its size.

    The backward error is asked for where the residual is at most `judged`.
    """

    first: float | None = None
    unit: float = 1.0
    since: int = 0
    change: float = 0.0
    judged: float = TOLERANCE

    def ends(self, flow: Flow, best: State | None, left: float) -> bool:
        """Whether the best state, of residual `left`, is exact for a model nearby."""
        if best is None or left > self.judged:
            return False
        if left <= EXACT and self.first is None:
            return True
        self.judged = min(LESS * left, LEFT)
        return backward_error(flow, best, LARGE).value <= LARGE

    def stands_still(self, flow: Flow, reached: State, factorisations: int) -> bool:
        """Whether the load factor is the one at which the path came within the tolerance."""
        if self.first is None:
            self.first, self.since = reached.load_factor, factorisations
            self.unit = Measure(flow.problem, reached).power
        self.change = max(self.change, abs(reached.load_factor - self.first) / self.unit)
        return factorisations >= self.since + SOON and not self.changes

    def unsettled(self, flow: Flow, best: State | None) -> bool:
        """Whether the end of a path is within the tolerance and yet no answer: exact for no model nearby."""
        return self.changes and best is not None and backward_error(flow, best, LARGE).value > LARGE

    @property
    def changes(self) -> bool:
        """Whether the load factor changed since."""
        return self.change > STILL

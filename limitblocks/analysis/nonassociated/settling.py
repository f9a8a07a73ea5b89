"""Whether the load factor of a path stands still where its residuals are within the tolerance.

Residuals within 1e-8 leave a row a thousandth from yield and flowing at 1e-5. Near a geometry where blocks
jam, joints turned by 1e-6, the path folds below that: the load factor falls by a quarter on the rest of it.
So a state within the tolerance ends a path if it is exact for a model nearby, or if the load factor stands
still; else the path is followed on.
"""

from __future__ import annotations

from dataclasses import dataclass

from limitblocks.evidence.backward_error import LARGE, backward_error
from limitblocks.evidence.residuals import TOLERANCE
from limitblocks.problem import Flow, State

EXACT = 1e-10  # residual that only the polish reaches: of 278 rows none has then a large backward error
LEFT, LESS = 1e-11, 0.1  # residual where it is asked for again, and of that then: it takes 100 factorisations
STILL = 1e-4  # change of the load factor over it
# A corner of 30 blocks moved by 1e-6 to 1e-5 m ends 26 to 1,050 factorisations beyond the tolerance.
FURTHER, SOON = 1100, 60  # factorisations beyond the tolerance: at most, and where it has not changed


@dataclass
class Settling:
    """Where a path came within the tolerance, and the residual of which the backward error is known."""

    load_factor: float | None = None
    since: int = 0
    judged: float = TOLERANCE
    change: float = 0.0

    def ends(self, flow: Flow, best: State | None, left: float) -> bool:
        """Whether the best state, of residual `left`, ends the path."""
        if best is None or left > self.judged:
            return False
        if left <= EXACT and self.load_factor is None:
            return True
        self.judged = min(LESS * left, LEFT)
        return backward_error(flow, best, LARGE).value <= LARGE

    def stands_still(self, load_factor: float, factorisations: int) -> bool:
        """Whether the load factor has not changed since the path came within the tolerance."""
        if self.load_factor is None:
            self.load_factor, self.since = load_factor, factorisations
        self.change = max(self.change, abs(load_factor - self.load_factor) / abs(self.load_factor))
        return factorisations >= self.since + SOON and not self.changes

    @property
    def changes(self) -> bool:
        """Whether the load factor changed beyond the tolerance."""
        return self.change > STILL

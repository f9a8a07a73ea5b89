"""One certified load factor of a range: how it was found, what moves, and its evidence."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Any

from limitblocks.errors import few
from limitblocks.evidence.check import Check
from limitblocks.evidence.results import Nonassociated
from limitblocks.shown import Viewed, kept

FEW = 0.1  # of the weight of all free blocks: a mechanism that moves less is local
LIGHTLY = 0.5  # of the thrust under the permanent loads: less is low
SHOWN = 4  # names in a line


class Origin(Enum):
    """How an answer was found; the text is for the user."""

    LOAD_PATH = "load path from the permanent loads"
    REACHED = "path from an admissible state of the permanent loads"
    SEARCHED = "found by search, which need not be a way that loading goes"


@dataclass(frozen=True, eq=False, repr=False)
class RangeAnswer(Viewed):
    """One certified load factor.

    Attributes
    ----------
    solution : Nonassociated
        The solution of Eqs (54)-(59).
    check : Check
        Its residuals, recomputed.
    origin : Origin
        Whether a load path reached it; `solution.how` says how it was found.
    moving : tuple of str
        Blocks that move in its mechanism.
    share : float
        Weight of those blocks over that of all free blocks; volumes where none has a weight.
    thrust : float
        Power that its slipping joints take up, over that which they would take up under the stresses of the
        permanent loads: the normal forces at work, over the permanent ones; 1 where nothing slips.
    """

    solution: Nonassociated
    check: Check
    origin: Origin
    moving: tuple[str, ...]
    share: float
    thrust: float

    @property
    def load_factor(self) -> float:
        """Load factor."""
        return self.solution.load_factor

    @property
    def collapse(self) -> Nonassociated:
        """The state at collapse."""
        return self.solution

    @property
    def digest(self) -> str:
        """SHA-256 of the model."""
        return self.solution.digest

    def __str__(self) -> str:
        return f"load factor {self.load_factor:.6g}, {self.origin.value}; moves {self.mechanism}"

    @property
    def local(self) -> bool:
        """Whether few blocks move, at a low thrust: they slip out because hardly anything presses them."""
        return self.share <= FEW and self.thrust <= LIGHTLY

    @property
    def mechanism(self) -> str:
        """What moves, in words."""
        word = "few blocks at low thrust, " if self.local else ""
        return (
            f"{word}{few(self.moving, SHOWN)}: {100 * self.share:.3g} % of the weight, "
            f"{self.thrust:.2f} of the thrust of the permanent loads"
        )

    def to_dict(self) -> dict[str, Any]:
        """Return the answer as plain numbers, lists and text."""
        return {
            "load_factor": self.load_factor,
            "origin": self.origin.name.lower().replace("_", " "),
            **kept(self, "moving", "share", "thrust", "local", "check", "solution"),
        }

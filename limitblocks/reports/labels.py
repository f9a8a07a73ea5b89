"""What a report is asked to carry beside the model and its results."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

from limitblocks.errors import LimitBlocksError


@dataclass(frozen=True)
class Labels:
    """Title, author, project and notes of a report, the load factor required, what was asked in vain.

    Raises
    ------
    LimitBlocksError
        The demand is no finite number > 0.
    """

    title: str = ""
    author: str = ""
    project: str = ""
    notes: str = ""
    demand: float | None = None
    failed: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.demand is not None and not (isfinite(self.demand) and self.demand > 0.0):
            raise LimitBlocksError(f"demand is {self.demand!r}, expected a load factor > 0")

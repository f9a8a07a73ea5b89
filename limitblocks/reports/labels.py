"""What a report is asked to carry beside the model and its results."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from numbers import Real

from limitblocks.errors import LimitBlocksError, refuse_kind


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
        for word in ("title", "author", "project", "notes"):
            refuse_kind(getattr(self, word), str, word)
        real = isinstance(self.demand, Real)
        if self.demand is not None and not (real and isfinite(self.demand) and self.demand > 0.0):
            raise LimitBlocksError(f"demand is {self.demand!r}, expected a load factor > 0")

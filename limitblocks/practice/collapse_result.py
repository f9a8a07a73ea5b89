"""Supports that settle until the structure falls: the reaction at each point, and where it falls."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from limitblocks.arrays import Array, read_only
from limitblocks.model import Model
from limitblocks.practice.kept import refuse_empty, sound_to
from limitblocks.practice.settlement import Settlement
from limitblocks.shown import Result, kept


@dataclass(frozen=True, eq=False)
class SettlementPoint:
    """One point of the way of what settles.

    Attributes
    ----------
    displacement : float
        Of the supports along the direction, m.
    found : Settlement
        Least reaction of the structure as it then is, with its evidence and mechanism.
    changes : tuple of str
        Contacts that opened, closed or lost their bond on the way from the point before.
    across : tuple of str
        Joints that press across a gap; the structure is then one whose gaps are filled.
    """

    displacement: float
    found: Settlement
    changes: tuple[str, ...]
    across: tuple[str, ...] = ()

    @property
    def reaction(self) -> float:
        """Least reaction, N: without dilatancy if that was asked for, else of the associated mechanism."""
        found = self.found
        return found.lower if found.nonassociated is None else found.nonassociated

    @property
    def model(self) -> Model:
        """The displaced structure, whose supports that settle can move along the direction."""
        return self.found.settling.model

    def to_dict(self) -> dict[str, Any]:
        """Return the point with its evidence as numbers and text."""
        return kept(self, "displacement", "found", "changes", "across")


@dataclass(frozen=True, eq=False, repr=False)
class SettlementCurve(Result):
    """Reaction against the settlement of supports, until the structure falls.

    Attributes
    ----------
    points : tuple of SettlementPoint
        The first is the structure as it is.
    falls : float or None
        Least settlement at which it is proven that the structure cannot stand, m; None where the way ends
        otherwise.
    ended : str
        Why it ends.
    """

    points: tuple[SettlementPoint, ...]
    falls: float | None
    ended: str

    def __post_init__(self) -> None:
        refuse_empty(self.points, "settlement until collapse")

    @property
    def supports(self) -> tuple[str, ...]:
        """Names of the supports that settle, as one body."""
        return self.points[0].found.settling.supports

    @property
    def direction(self) -> Array:
        """Unit vector of its motion, shape (3,)."""
        return self.points[0].found.settling.direction

    @property
    def stands_to(self) -> float:
        """Settlement up to which the structure stands and no joint presses across a gap, m."""
        return sound_to(self.points)

    @property
    def filled(self) -> tuple[str, ...]:
        """From where on joints press across gaps, and why, in words; empty if none does."""
        if self.points[-1].displacement <= self.stands_to:
            return ()
        why = ", as slip of associated flow opens them" if self.points[-1].found.result is None else ""
        return (f"beyond {self.stands_to:.4g} m joints press across their gaps{why}",)

    @property
    def remarks(self) -> tuple[str, ...]:
        """What to know of the answers that the first and the last reaction are of."""
        first, last = (self.points[k].found.remarks for k in (0, -1))
        return tuple(dict.fromkeys(first + last))

    @property
    def digest(self) -> str:
        """SHA-256 of the model that was given."""
        return self.points[0].found.digest

    @property
    def displacements(self) -> Array:
        """Settlements of the points, m, shape (p,)."""
        return read_only(np.array([point.displacement for point in self.points]))

    @property
    def reactions(self) -> Array:
        """Least reactions of the points, N, shape (p,)."""
        return read_only(np.array([point.reaction for point in self.points]))

    def rows(self) -> list[dict[str, Any]]:
        """Return a row for each point."""
        return [
            {
                "displacement": point.displacement,
                "reaction": point.reaction,
                "lower": point.found.lower,
                "upper": point.found.upper,
                "changes": ", ".join(point.changes),
                "across": ", ".join(point.across),
            }
            for point in self.points
        ]

    def to_dict(self) -> dict[str, Any]:
        """Return the curve as numbers and text."""
        names = ("digest", "supports", "direction", "points", "stands_to", "falls", "ended")
        return {"analysis": "settlement until collapse"} | kept(self, *names)

    def __str__(self) -> str:
        first, last = self.reactions[[0, -1]].tolist()
        settles = "settles" if len(self.supports) == 1 else "settle"
        said = f"{self.points[0].found.settling.named} {settles}"
        said += f" from a reaction of {first:.6g} N to {last:.6g} N"
        return self._line(f"{said}: {self.ended}", *self.filled, *self.remarks)

"""A capacity curve: its points, each with a checked answer, and why it ends."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from limitblocks.arrays import Array, read_only
from limitblocks.evidence.results import Nonassociated
from limitblocks.model import Model
from limitblocks.practice.kept import refuse_empty, sound_to
from limitblocks.shown import Result, kept, many

FLAT = 1e-8  # of the load factor: a smaller fall is within its accuracy, and its secant leads anywhere


@dataclass(frozen=True, eq=False)
class Control:
    """A point of a block and the direction in which its displacement is measured.

    Attributes
    ----------
    block : str
        Name of the block.
    point : Array, shape (3,)
        Material point of the block, global axes, m.
    direction : Array, shape (3,)
        Unit vector.
    """

    block: str
    point: Array
    direction: Array


@dataclass(frozen=True, eq=False)
class CapacityPoint:
    """One point of the curve.

    Attributes
    ----------
    displacement : float
        Of the control point along its direction, m.
    load_factor : float
        At which the mechanism goes on, equal to that of `result` less `shift`.
    shift : float
        Part of the live load taken from the dead loads, so that they stand by themselves.
    model : Model
        The displaced structure with the loads that were analysed.
    result : Nonassociated
        Its checked answer without dilatancy.
    changes : tuple of str
        Contacts that opened, closed or lost their bond on the way from the point before.
    across : tuple of str
        Joints that press across a gap: a hinge that has moved elsewhere leaves an opened joint behind, and
        nothing but a motion that closes it could press there. The load factor is then one of a structure
        whose gap is filled.
    snapped : bool
        Whether no load factor held the structure beyond the point before, and it snapped to this one: some
        contacts closed and others opened while the live load rested. Its load factor may be below zero.
    """

    displacement: float
    load_factor: float
    shift: float
    model: Model
    result: Nonassociated
    changes: tuple[str, ...]
    across: tuple[str, ...] = ()
    snapped: bool = False

    def to_dict(self) -> dict[str, Any]:
        """Return the point with its model and its answer as numbers and text."""
        names = ("displacement", "load_factor", "shift", "changes", "across", "snapped", "model", "result")
        return kept(self, *names)


@dataclass(frozen=True, eq=False, repr=False)
class CapacityCurve(Result):
    """Load factor against displacement, every point with its evidence.

    Attributes
    ----------
    points : tuple of CapacityPoint
        The first is the structure as it is.
    control : Control
        What the displacement is of.
    zero : float or None
        Displacement at which the load factor is zero, or where it snaps through zero, m; None where the
        curve ends before.
    ended : str
        Why the curve ends.
    """

    points: tuple[CapacityPoint, ...]
    control: Control
    zero: float | None
    ended: str

    def __post_init__(self) -> None:
        refuse_empty(self.points, "capacity curve")

    @property
    def proven_to(self) -> float:
        """Displacement up to which no joint presses across a gap, m."""
        return sound_to(self.points)

    @property
    def remarks(self) -> tuple[str, ...]:
        """What to know of the first point."""
        return self.points[0].result.remarks

    @property
    def digest(self) -> str:
        """SHA-256 of the model, the structure as it is."""
        return self.points[0].result.digest

    @property
    def displacements(self) -> Array:
        """Displacements of the points, m, shape (p,)."""
        return read_only(np.array([point.displacement for point in self.points]))

    @property
    def load_factors(self) -> Array:
        """Load factors of the points, shape (p,)."""
        return read_only(np.array([point.load_factor for point in self.points]))

    def rows(self) -> list[dict[str, Any]]:
        """Return a row for each point."""
        return [
            {
                "displacement": point.displacement,
                "load_factor": point.load_factor,
                "changes": ", ".join(point.changes),
                "across": ", ".join(point.across),
                "worst_residual": point.result.residuals.worst.value,
            }
            for point in self.points
        ]

    def to_dict(self) -> dict[str, Any]:
        """Return the curve as numbers and text."""
        return {"analysis": "capacity curve"} | kept(self, "digest", "control", "points", "zero", "ended")

    def __str__(self) -> str:
        first = self.points[0].load_factor
        filled = self.points[-1].displacement > self.proven_to
        beyond = f"; beyond {self.proven_to:.4g} m joints press across their gaps" if filled else ""
        return self._line(
            f"capacity curve of {many(len(self.points), 'point')} from load factor {first:.6g}: "
            f"{self.ended}{beyond}",
            *self.remarks,
        )


def zero_of(points: Sequence[CapacityPoint]) -> float:
    """Return the displacement of the zero, m: where it is met, before a snap, or the secant's behind it."""
    last = points[-1]
    if last.snapped:
        return points[-2].displacement
    ahead = to_zero(points[-2], last) if last.load_factor < 0.0 else 0.0
    return last.displacement + (ahead if np.isfinite(ahead) else 0.0)  # it may fall on the way back


def to_zero(before: CapacityPoint | None, point: CapacityPoint) -> float:
    """Return how far ahead the secant of two points is zero, m; infinite where they do not fall to it."""
    if before is None or point.snapped:
        return np.inf
    fall, step = before.load_factor - point.load_factor, point.displacement - before.displacement
    flat = abs(fall) <= FLAT * max(abs(before.load_factor), abs(point.load_factor))
    slope = fall / step
    return np.inf if flat or not slope > 0.0 else point.load_factor / slope

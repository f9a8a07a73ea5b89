"""Result of the load path: its steps, its snaps and its collapse."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from limitblocks.arrays import Array
from limitblocks.evidence.results import Nonassociated
from limitblocks.shown import Result, Shown, kept, many

AGREE = 1e-6  # relative difference of two load factors that agree


@dataclass(frozen=True, eq=False, repr=False)
class PathStep(Shown):
    """One state of the load path, in equilibrium and within the yield set.

    Attributes
    ----------
    load_factor : float
        Load factor.
    stress_resultants : Array, shape (m, 6)
        (V1, V2, N, M1, M2, T) of each interface, N and N m.
    displacements : Array, shape (n, 6)
        Of each block since the first state, m and rad; their size is relative to the joints' compliance.
    active : tuple of tuple
        (interface, mode) pairs that flow in this step and did not in the one before.
    residuals : dict
        Equilibrium and yield violation, over what acts on the blocks.
    kind : str
        "permanent loads", or "start" where the path was told to start from a state with live load; "step"
        (the end of an increment), "before snap", "unstable" (between the two ends of a snap), "after snap" or
        "polish" (collapse, at the displacements where the increments end).
    """

    load_factor: float
    stress_resultants: Array
    displacements: Array
    active: tuple[tuple[str, str], ...]
    residuals: dict[str, float]
    kind: str

    def __str__(self) -> str:
        begins = (
            f", {many(len(self.active), 'mode')} {'begins' if len(self.active) == 1 else 'begin'} to flow"
            if self.active
            else ""
        )
        return f"{self.kind}: load factor {self.load_factor:.6g}{begins}"


@dataclass(frozen=True, eq=False, repr=False)
class Snap(Shown):
    """A fold of the load path: the displacement would have to fall before it can grow again.

    Both states have the same displacement in the mean of the live load (the work of the live load at load
    factor one). An experiment under control of that displacement jumps from one to the other.

    Attributes
    ----------
    before, after : PathStep
        The last state before the fold, and the first one on the path beyond it at that displacement.
    """

    before: PathStep
    after: PathStep

    @property
    def drop(self) -> float:
        """By how much the load factor falls."""
        return self.before.load_factor - self.after.load_factor

    def __str__(self) -> str:
        return f"snap from load factor {self.before.load_factor:.6g} to {self.after.load_factor:.6g}"


@dataclass(frozen=True, eq=False, repr=False)
class LoadPath(Result):
    """States from the permanent loads to `collapse`, which is a solution of Eqs (54)-(59).

    Attributes
    ----------
    steps : tuple of PathStep
        States in the order in which they are met.
    collapse : Nonassociated
        The end.
    snaps : tuple of Snap
        Folds in the displacement, in their order.
    trace : Array, shape (k, 3)
        Every point that arclength met: arclength (mean relative change of slacks and multipliers), work of
        the live load at load factor one (N m; relative to the compliance), load factor. Increments follow
        one another; at the end of each the barrier fades, which may move the load factor a little.
    tracked : float
        What the first path of :func:`limitblocks.nonassociated`, from the same `start`, ends at; NaN where it
        does not end at a solution.
    remarks : tuple of str
        Whether the two agree, and why if they do not.
    """

    steps: tuple[PathStep, ...]
    collapse: Nonassociated
    snaps: tuple[Snap, ...] = ()
    trace: Array = field(default_factory=lambda: np.zeros((0, 3)), repr=False)
    tracked: float = np.nan
    remarks: tuple[str, ...] = ()

    title: ClassVar[str] = "Load path"

    @property
    def load_factor(self) -> float:
        """Load factor at collapse."""
        return self.collapse.load_factor

    @property
    def digest(self) -> str:
        """SHA-256 of the model."""
        return self.collapse.digest

    @property
    def peak(self) -> float:
        """Largest load factor along the path."""
        return max(step.load_factor for step in self.steps)

    def curve(self, block: int, component: int) -> tuple[Array, Array]:
        """Return displacements of one block (position in the model, component 0 to 5) and load factors."""
        moved = np.array([step.displacements[block, component] for step in self.steps])
        return moved, np.array([step.load_factor for step in self.steps])

    def rows(self) -> list[dict[str, Any]]:
        """One row a step: load factor, residuals and what began to flow."""
        return [
            {"step": k, "kind": step.kind, "load_factor": step.load_factor}
            | step.residuals
            | {"newly_active": list(step.active)}
            for k, step in enumerate(self.steps)
        ]

    def __str__(self) -> str:
        snaps = f", {many(len(self.snaps), 'snap')}" if self.snaps else ""
        own = [remark for remark in self.remarks if remark not in self.collapse.remarks]
        return "; ".join((f"load path of {many(len(self.steps), 'step')}{snaps}: {self.collapse}", *own))

    def to_dict(self) -> dict[str, Any]:
        """Return the path as plain numbers, lists and text."""
        steps = [
            row | kept(step, "displacements", "stress_resultants")
            for row, step in zip(self.rows(), self.steps, strict=True)
        ]
        places = {id(step): k for k, step in enumerate(self.steps)}
        return {
            "analysis": "path",
            "steps": steps,
            "snaps": [[places[id(snap.before)], places[id(snap.after)]] for snap in self.snaps],
            **kept(self, "trace", "tracked", "remarks", "collapse"),
        }


def compared(load_factor: float, tracked: float, ended: bool) -> tuple[str, ...]:
    """Whether the end agrees with that of the tracked path, in words; that of a path that `ended`."""
    if np.isnan(tracked):
        return ("the tracked path of nonassociated with a small barrier ends at no solution here",)
    if not ended:
        return (f"the tracked path of nonassociated ends at {tracked:.6g}; this path has no end to compare",)
    off = abs(tracked - load_factor)
    if off <= AGREE * abs(load_factor):
        return (f"the tracked path of nonassociated ends at the same load factor, within {AGREE:g}",)
    share = 100.0 * off / max(abs(load_factor), abs(tracked))
    return (
        f"the tracked path of nonassociated ends at {tracked:.6g}, {share:.2g} % off: it pushes "
        "once for all, so that slip may go back, and its barrier rounds the corners of yield",
    )

"""What a tracked path leaves behind: its points, and how it ended."""

from __future__ import annotations

import logging
from bisect import bisect_right
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from limitblocks.analysis.nonassociated.path_equations import Barrier
from limitblocks.errors import refuse_no_progress
from limitblocks.evidence.results import ITERATIONS, Iteration

CLOSED, INTERRUPTED = "closed", "interrupted"
UNSETTLED = "its load factor still changing"
CLIMBING = "climbing without limit"
LARGE, ROUNDS, IN_HALF = "large barrier", "of the fixed point", "in one half"
FROZEN, INCREMENTS = "fixed point", "increments of the load path"
DISPLACED = "path in displacements, rounded corners of yield"
RETURNS = "springs back"
EARLY, FADED = "compliance faded first", "barrier faded first"
BORNE = "% of the load factor on its barrier"

#: What is said of an answer that a way led to which is not the load path, the first that is in its words.
LED_BY = {
    LARGE: "a large barrier led to this solution: it is not that of the load path, and is mostly higher",
    EARLY: "a path on which compliance fades before the barrier led to this solution: it need not be that "
    "of the load path, which load_path follows",
    DISPLACED: "loading with rounded corners of yield, and rounds of the fixed point from there, led to this "
    "solution: it need not be that of the load path",
    ROUNDS: "rounds of the fixed point led to this solution from a path that did not end: it need not be "
    "that of the load path",
    FROZEN: "limit analyses with frozen friction, one after the other, led to this solution: it need not be "
    "that of the load path",
}

log = logging.getLogger(ITERATIONS)


def recorder(
    progress: Callable[[Iteration], None] | None,
) -> tuple[list[Iteration], Callable[[Iteration], None]]:
    """Return the history of a search, and what adds to it and tells the user."""
    refuse_no_progress(progress)
    history: list[Iteration] = []

    def record(iteration: Iteration) -> None:
        history.append(iteration)
        log.debug(iteration)
        if progress is not None:
            progress(iteration)

    return history, record


def off_load_path(how: str) -> tuple[str, ...]:
    """What a reader should know of an answer that a large barrier, rounds or one half led to."""
    symmetric = (
        "one half of the structure led to this solution: that the blocks leave symmetry on the way, as an "
        "asymmetric mechanism may, was not looked for",
    ) * (IN_HALF in how)
    if BORNE in how:
        (share,) = (part.removesuffix(BORNE) for part in how.split(", ") if part.endswith(BORNE))
        return (
            *symmetric,
            f"the barrier of the path presses joints together that may bear nothing, and {share}% of this "
            "load factor, by an estimate, is friction at them; load_path goes without",
        )
    if how.startswith(INCREMENTS):
        return symmetric
    led = next((said for way, said in LED_BY.items() if way in how), "")
    return (*symmetric, f"{led}; load_factor_range shows others") if led else symmetric


class Progress(NamedTuple):
    """A point of a path: theta, load factor, sign of det J, factorisations and least theta so far."""

    theta: float
    load_factor: float
    sign: float
    factorisations: int
    least: float

    def told(self, unit: float) -> Iteration:
        """Return what it tells the user; `unit` is that of the live load."""
        load_factor, theta = float(self.load_factor / unit), float(self.theta)
        return Iteration(load_factor, "path", theta, {"theta": theta}, self.factorisations, 0)


def winds(points: Sequence[Progress], factorisations: int, patience: int | None) -> bool:
    """Whether theta did not fall to a third in as many of the factorisations as there is patience for."""
    since = factorisations - (patience or factorisations)
    before = bisect_right(points, since, key=lambda point: point.factorisations)
    return before > 0 and points[-1].least > points[before - 1].least / 3.0


@dataclass(frozen=True, eq=False)
class Tracked:
    """How a path went.

    `end` is "closed", or why it ended without a solution; `points` holds every accepted point; `residual` the
    worst one of Eqs (54)-(59); `said` what else is to say of the way.
    """

    barrier: Barrier
    seed: int
    end: str
    residual: float
    factorisations: int
    failures: int
    points: tuple[Progress, ...]
    said: str = ""

    @property
    def closed(self) -> bool:
        """Whether the path ended at a solution."""
        return self.end == CLOSED

    @property
    def interrupted(self) -> bool:
        """Whether the user stopped it."""
        return self.end == INTERRUPTED

    @property
    def how(self) -> str:
        """What path it was, in words."""
        size = "small barrier" if self.barrier == Barrier() else f"barrier {self.barrier.size:g}"
        large = f" ({LARGE})" if self.barrier.size > Barrier().size else ""
        early = f", {EARLY}" * (self.barrier.power > 1.0 and not large)
        return (
            f"tracked path, {size}{large}, power {self.barrier.power:g}, seed {self.seed}{early}{self.said}"
        )

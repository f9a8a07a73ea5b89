"""The ways from the permanent loads, each by itself: paths, rounds, increments, the outer loop."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from limitblocks.analysis.nonassociated.closing import NEAR, Closing
from limitblocks.analysis.nonassociated.displacement_path import pushed_over
from limitblocks.analysis.nonassociated.loading import CLIMBS, Pushed, pushed
from limitblocks.analysis.nonassociated.means import SOFTENING, Means
from limitblocks.analysis.nonassociated.outer_loop import outer_loop, told
from limitblocks.analysis.nonassociated.path_equations import Barrier
from limitblocks.analysis.nonassociated.path_record import (
    CLIMBING,
    DISPLACED,
    INCREMENTS,
    INTERRUPTED,
    UNSETTLED,
)
from limitblocks.analysis.nonassociated.settings import Settings
from limitblocks.analysis.nonassociated.tracking import track
from limitblocks.analysis.nonassociated.without_barrier import without_barrier
from limitblocks.analysis.pivot import pivoted
from limitblocks.analysis.polish import defect, polish, polished
from limitblocks.arrays import Array
from limitblocks.evidence.results import Iteration
from limitblocks.problem import Flow, State

SMALL = Barrier().size
Record = Callable[[Iteration], None]  # tells the user
Way = tuple[State, str]  # the state it leads to, and which it was
STEPS = Settings(growth=2.0, left=1e-5, budget=2500)  # the load path in larger and coarser increments


@dataclass(frozen=True, eq=False)
class Given:
    """What all ways start from, and how near to a solution they have to end."""

    flow: Flow
    x0: Array  # stresses under the permanent loads, dimensionless
    scale: float  # load factor that barriers are measured by, dimensionless
    tolerance: float
    record: Record

    @property
    def start(self) -> State:
        """The permanent loads alone."""
        problem = self.flow.problem
        return State(0.0, self.x0, np.zeros(problem.C.shape[1]), np.zeros(len(problem.g)))

    def tracked(self, one: Means, softening: float = SOFTENING, closing: Closing | None = None) -> Way:
        """Return the end of one path, and which path it was."""
        problem = self.flow.problem
        loading = one.barrier.size <= SMALL and one.barrier.power <= 1.0
        state, info = track(
            replace(self.flow, softening=softening),
            self.x0,
            problem.compliance,
            **one._asdict(),
            power=self.scale / len(problem.blocks),
            progress=lambda at: self.record(at.told(problem.units.live)),
            closing=closing,
            further=without_barrier if loading else None,
        )
        how = f"{info.how}{closing.how}" if closing and state is closing.solution else info.how
        return state, f"{how}, {info.end}" if info.end in (INTERRUPTED, UNSETTLED) else how

    def polished(self, state: State, how: str) -> Way:
        """Return the end of a path polished, or by pivots where it is near, unless the user stopped it.

        A path of this very flow has tried the polish of an end that is farther off; what it leaves of one
        that is near enough takes steps of least norm, which may cost as much as the path.
        """
        flow, left = self.flow, defect(self.flow, state)
        if how.endswith(INTERRUPTED) or left <= self.tolerance / 10 or (flow.constant and left > NEAR):
            return state, how
        try:
            if flow.constant and left > self.tolerance:
                return polish(flow, pivoted(flow, state)), how
            return polished(flow, state, left)[0], how
        except KeyboardInterrupt:
            return state, f"{how}, {INTERRUPTED}"

    def closed_in_rounds(self, state: State, how: str, closing: Closing | None = None) -> Way:
        """Return the end of a path closed by rounds; the path's own where the user stops it."""
        closing = closing or Closing(self.flow, self.tolerance)
        try:
            return closing(state), how + closing.how
        except KeyboardInterrupt:
            return state, f"{how}, {INTERRUPTED}"

    def displaced(self, closing: Closing) -> Iterator[Way]:
        """Give the end of a path in displacements, closed by rounds, where the problem has one."""
        found = pushed_over(self.flow, self.x0, self.scale, closing, self.record)
        if found is not None:
            state, stopped = found
            yield state, DISPLACED + (f", {INTERRUPTED}" if stopped else closing.how)

    def increments(self) -> Way:
        """Return the end of the load path, pushed by increments; the last one where the user stops it."""
        problem, how = self.flow.problem, INCREMENTS
        met = [self.start]

        def tell(one: Pushed) -> None:
            met.append(one.state)
            self.record(one.told(problem.units.live))

        start = self.flow, self.x0, problem.compliance
        try:
            _, last, why = pushed(*start, self.tolerance, STEPS, self.scale, tell)
            return last, f"{how}, {CLIMBING}" if why == CLIMBS else how
        except KeyboardInterrupt:
            return met[-1], f"{how}, {INTERRUPTED}"

    def frozen(self) -> Way:
        """Return what one analysis after the other leads to, each with the friction of the last."""
        flow = self.flow
        return outer_loop(flow, self.x0, self.tolerance, lambda *one: self.record(told(flow, *one)))

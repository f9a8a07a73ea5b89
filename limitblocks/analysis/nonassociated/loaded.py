"""Increments as `load_path` has them: pushed in a plane or in space, to where the user stops them.

Where they end short of collapse one more without end follows, by a path from the stresses that they left. On
it the compliance fades as the displacement grows without limit, as on that of `nonassociated` from the
permanent loads. Rounds of the fixed point come first: from a collapse that hardly changes they end nearest.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from limitblocks.analysis.nonassociated.closing import Closing
from limitblocks.analysis.nonassociated.each_way import Given, Way
from limitblocks.analysis.nonassociated.in_the_plane import InPlane, admissible, way_in_plane
from limitblocks.analysis.nonassociated.loading import CLIMBS, Pushed, near, pushed
from limitblocks.analysis.nonassociated.path_record import INCREMENTS, INTERRUPTED, UNSETTLED
from limitblocks.analysis.nonassociated.settings import Settings
from limitblocks.analysis.nonassociated.start import Bracket, solving_state, start_stresses
from limitblocks.analysis.nonassociated.ways import means_of
from limitblocks.analysis.polish import defect
from limitblocks.arrays import Array
from limitblocks.evidence.residuals import mcp_residuals
from limitblocks.evidence.results import Iteration
from limitblocks.model import Model
from limitblocks.problem import Flow, State

FAR = 0.1  # of the load factor: a solution farther from where the increments end is not where they lead
AT_ONCE = "the bounds: any live load moves the structure"
BEYOND = "{}; they end at load factor {:.6g}, and one push without end, {}, led from there to this collapse"


class Loaded(NamedTuple):
    """Stresses at the start, increments, the last state, how they were found, why increments ended before."""

    x0: Array
    pushes: tuple[Pushed, ...]
    last: State
    how: str
    why: str

    @property
    def beyond(self) -> bool:
        """Whether a push without end led from the last increment to the collapse."""
        return self.how.startswith(f"{INCREMENTS}, then ")


def loaded(
    flow: Flow,
    x0: Array,
    weights: Array,
    tolerance: float,
    settings: Settings,
    scale: float,
    record: Callable[[Iteration], None],
    share: Array | float,
) -> Loaded:
    """Push from x0 to collapse, or to where the user stops it."""
    met: list[Pushed] = []

    def push(one: Pushed) -> None:
        while met and met[-1].start is one.start:  # taken back and pushed once more, farther
            met.pop()
        met.append(one)
        record(one.told(flow.problem.units.live))

    try:
        pushes, last, why = pushed(flow, x0, weights, tolerance, settings, scale, push, share)
        if why not in ("", CLIMBS):
            own = replace(flow, problem=replace(flow.problem, compliance=weights))
            found = endless(Given(own, last.x, scale, tolerance, record), last, bool(pushes))
            if found is not None:
                end, way = last.load_factor / flow.problem.units.live, f"{INCREMENTS}, then {found[1]}"
                return Loaded(x0, pushes, found[0], way, BEYOND.format(why, end, found[1]))
    except KeyboardInterrupt:
        if not met:
            raise
        return Loaded(x0, tuple(met), met[-1].state, f"{INCREMENTS}, {INTERRUPTED}", "")
    return Loaded(x0, pushes, last, INCREMENTS, why)


def endless(given: Given, last: State, began: bool = True) -> Way | None:
    """Return the solution that the last state of increments leads to, and which way; None if it is far.

    The first with the load factor of that state, else the nearest; the first of all where none `began`.
    """
    nearest: Way | None = None
    least = FAR * abs(last.load_factor) if began else np.inf
    for state, how in _ways(given, last):
        if how.endswith(INTERRUPTED):
            if nearest is None:
                raise KeyboardInterrupt
            break
        solved = UNSETTLED not in how and mcp_residuals(given.flow, state).worst.value <= given.tolerance
        off = abs(state.load_factor - last.load_factor)
        if solved and off <= least:
            nearest, least = (state, how), off
            if not began or near(state, last.load_factor):
                break
    return nearest


def _ways(given: Given, last: State) -> Iterator[Way]:
    """Ends of rounds, and of paths and rounds from their ends, and which they were."""
    closing = Closing(given.flow, given.tolerance)
    state, how = given.closed_in_rounds(last, "", closing)
    yield state, how.removeprefix(", ")
    for one in means_of(given.flow):
        state, how = given.polished(*given.tracked(one))
        yield state, how
        if defect(given.flow, state) > given.tolerance:
            yield given.closed_in_rounds(state, how, closing)


def at_once(model: Model, flow: Flow, enclosing: Bracket, weights: Array, tolerance: float) -> Loaded | None:
    """The mechanism of the bounds, without increments, where any live load moves the structure."""
    last = solving_state(model, flow, enclosing, None, tolerance) if enclosing.nothing else None
    if last is None:
        return None
    x0 = start_stresses(model, flow, weights, None)
    return Loaded(x0, (), last, AT_ONCE, "")


def lifted(planar: InPlane, found: Loaded, tolerance: float) -> Loaded | None:
    """A load path of the plane as one of the whole problem; None where that does not accept it."""
    interrupted = found.how.endswith(INTERRUPTED)
    last = planar.plane.lifted(found.last) if interrupted else planar.accepted(found.last, tolerance)
    pushes = tuple(planar.pushed(one) for one in found.pushes)
    if last is None or not admissible(pushes):
        return None
    return Loaded(planar.plane.stresses @ found.x0, pushes, last, way_in_plane(found.how), found.why)

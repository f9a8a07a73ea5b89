"""Increments as `load_path` has them: pushed in a plane or in space, to where the user stops them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

from limitblocks.analysis.nonassociated.each_way import Given
from limitblocks.analysis.nonassociated.endless import endless
from limitblocks.analysis.nonassociated.in_the_plane import InPlane, admissible, way_in_plane
from limitblocks.analysis.nonassociated.loading import CLIMBS, Pushed, pushed
from limitblocks.analysis.nonassociated.path_record import INCREMENTS, INTERRUPTED
from limitblocks.analysis.nonassociated.settings import Settings
from limitblocks.analysis.nonassociated.start import Bracket, solving_state, start_stresses
from limitblocks.arrays import Array
from limitblocks.evidence.results import Iteration
from limitblocks.model import Model
from limitblocks.problem import Flow, State

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

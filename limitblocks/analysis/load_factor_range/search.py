"""Load paths, mechanisms and exact programs of one structure, and what they find."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from itertools import islice, product
from typing import NamedTuple

import numpy as np

from limitblocks.analysis.load_factor_range.answers import Collected, answer, of_result
from limitblocks.analysis.load_factor_range.exact import AGREES, exact_extreme
from limitblocks.analysis.load_factor_range.mechanisms import Mechanisms
from limitblocks.analysis.load_factor_range.sampling import Sampler, Way
from limitblocks.analysis.nonassociated.in_the_plane import flow_in_plane, way_in_plane
from limitblocks.analysis.nonassociated.loop import nonassociated
from limitblocks.analysis.nonassociated.path_record import off_load_path
from limitblocks.analysis.nonassociated.start import Bracket, load_scale, state_of
from limitblocks.arrays import Array
from limitblocks.errors import UnlimitedLoad
from limitblocks.evidence.ending import Status
from limitblocks.evidence.range_answer import Origin, RangeAnswer
from limitblocks.evidence.range_result import Extreme
from limitblocks.evidence.residuals import TOLERANCE
from limitblocks.model import Model
from limitblocks.problem import Flow, State


class _TimeUp(Exception):
    """The time limit has come."""


class Task(NamedTuple):
    """What stays the same: model, flow rule, bracket, permanent-load stresses, what is collected."""

    model: Model
    flow: Flow
    enclosing: Bracket
    permanent: Array
    scale: float
    collected: Collected
    tell: Callable[..., None]


def walked(
    task: Task, paths: int, seed: int, deadline: float
) -> tuple[RangeAnswer | None, tuple[int, int], bool]:
    """Follow the load path and `paths` - 1 other ways; its answer, how many were tried, how many arrived.

    Last whether the user stopped it, which keeps what was found until then.
    """

    def watch(_: object) -> None:
        if time.monotonic() > deadline:
            raise _TimeUp

    first, tried, arrived, stopped = None, 0, 0, False
    try:
        tried += 1
        first = _first(task, watch)
        arrived += first is not None
        if first is not None:
            task.tell(None, first.solution.how, first.load_factor)
        for way in islice(_ways(task, seed, watch), paths - 1):
            tried += 1
            state = way.go()
            task.tell(state, way.how)
            arrived += task.collected.add(state, way.how, way.origin, keep=True)
            watch(None)
    except _TimeUp:
        pass
    except KeyboardInterrupt:
        if first is None and not list(task.collected.all()):
            raise
        stopped = True
    return first, (tried, arrived), stopped


def _first(task: Task, watch: Callable[[object], None]) -> RangeAnswer | None:
    """The answer of `nonassociated`, collected."""
    flow = task.flow
    try:
        result = nonassociated(
            task.model, dilatancy=flow.dilatancy, turning=flow.turning, progress=watch, throw=False
        )
    except UnlimitedLoad:  # along the load path; other ways may end
        return None
    if result.status is Status.INTERRUPTED:
        raise KeyboardInterrupt
    if not result.converged:
        return None
    origin = Origin.REACHED if off_load_path(result.how) else Origin.LOAD_PATH
    task.collected.add(state_of(task.model, flow.problem, result), result.how, origin, keep=False)
    return of_result(task.model, flow, task.permanent, result, origin)


def _ways(task: Task, seed: int, watch: Callable[[object], None]) -> Iterator[Way]:
    """Ways of a sampler: those of a planar model in its plane, and lifted from it."""
    p, bounds = task.flow.problem, task.enclosing.bounds
    associated = bounds.generalised_stresses / p.stress_units if bounds else None
    planar = flow_in_plane(task.model, task.flow, p.compliance, None)
    if planar is None:
        yield from Sampler(task.flow, task.permanent, associated, task.scale, watch).ways(seed)
        return
    own = None if associated is None else planar.plane.stresses_of(associated)
    scale = load_scale(planar.flow.problem, task.enclosing.associated)
    for way in Sampler(planar.flow, planar.x0, own, scale, watch).ways(seed):

        def lifted(go: Callable[[], State | None] = way.go) -> State | None:
            state = go()
            return state and planar.accepted(state, TOLERANCE)

        yield way._replace(how=way_in_plane(way.how), go=lifted)


def drawn(task: Task, count: int, seed: int, deadline: float) -> tuple[int, int]:
    """Draw mechanisms; how many were tried, and how many ended at a solution."""
    high = task.collected.limits[1]
    draw = Mechanisms(task.flow, (0.0, high), seed)
    tried = arrived = 0
    ends = (*task.collected.found, task.collected.least, task.collected.greatest) if count else ()
    try:
        for one, sense in product(ends, (1.0, -1.0)):
            if one is not None and time.monotonic() < deadline:
                state = draw.beyond((one.state.u, one.state.y), sense)
                task.collected.add(state, f"descent or ascent; {one.how}", Origin.SEARCHED, keep=False)
        while tried < count and time.monotonic() < deadline:
            tried += 1
            state, how = draw.solution(), f"mechanism drawn at random, seed {seed}, number {tried}"
            task.tell(state, how)
            arrived += task.collected.add(state, how, Origin.SEARCHED, keep=False)
    except KeyboardInterrupt:  # what was found is kept
        tried = max(tried - 1, 0)
    return tried, arrived


def extreme(task: Task, sense: float, time_limit: float) -> Extreme:
    """Return the least (sense 1) or the greatest (-1) load factor of all solutions, and collect it.

    Where nothing limits the associated load the greatest is looked for up to a limit only: what is found
    there proves nothing, and without a ray no bound is known.
    """
    beyond, endless = task.collected.beyond, sense < 0.0 and task.collected.endless
    if endless and beyond is not None:
        far = answer(task.model, task.flow, task.enclosing, task.permanent, beyond)
        return Extreme(far, np.inf, True, np.inf, np.inf, 0.0)
    live = task.flow.problem.units.live
    low, high = task.enclosing.frictionless * live, task.enclosing.associated * live
    room = 1e-6 * task.scale  # the bracket is known to a tolerance
    low = max(0.0, low - room) if np.isfinite(low) else 0.0
    high = high + room if np.isfinite(high) else task.collected.limits[1]
    state, bound, stresses, multipliers, seconds = exact_extreme(task.flow, (low, high), sense, time_limit)
    task.collected.add(state, "mixed-integer program", Origin.SEARCHED, keep=False)
    one = task.collected.least_within  # none: all are below zero, the greatest too
    if one is not None and sense < 0.0:
        one = task.collected.greatest
    best = answer(task.model, task.flow, task.enclosing, task.permanent, one) if one else None
    if sense > 0.0:
        bound = max(bound, low)  # where time ran out first
    elif endless:
        bound = np.inf
    near = one is not None and abs(one.state.load_factor - bound) <= AGREES * task.scale
    return Extreme(best, float(bound / live), near, stresses, multipliers, seconds)

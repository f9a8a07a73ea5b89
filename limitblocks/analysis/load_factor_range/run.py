"""The set of certified load factors of a structure: paths, faces, mechanisms, and exact programs."""

from __future__ import annotations

import time
from collections.abc import Callable
from itertools import islice, product
from typing import NamedTuple

import numpy as np

from limitblocks.analysis.load_factor_range.answers import (
    Certified,
    Collected,
    answer,
    of_result,
    remarks,
    state_of,
)
from limitblocks.analysis.load_factor_range.exact import AGREES, exact_extreme, refuse
from limitblocks.analysis.load_factor_range.mechanisms import Mechanisms
from limitblocks.analysis.load_factor_range.sampling import Sampler
from limitblocks.analysis.load_factor_range.wedging import wedging
from limitblocks.analysis.nonassociated.loop import nonassociated
from limitblocks.analysis.nonassociated.start import (
    Bracket,
    bracket,
    load_scale,
    own_units,
    refuse_jammed,
    refuse_unlimited,
    start_stresses,
)
from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.evidence.ending import Status
from limitblocks.evidence.range_answer import Origin, RangeAnswer
from limitblocks.evidence.range_result import Extreme, LoadFactorRange
from limitblocks.evidence.residuals import TOLERANCE
from limitblocks.evidence.results import Iteration
from limitblocks.model import Model
from limitblocks.problem import Flow, State, Turning, checked_dilatancy, turning_of

BEYOND = 10.0  # times the load scale: load factors looked at where nothing limits them
LOADING = ("small barrier", "barrier 0.02,")  # ways of `nonassociated` that follow the loading
Progress = Callable[[Iteration], None]


class _TimeUp(Exception):
    """The time limit has come."""


class _Task(NamedTuple):
    """What stays the same: model, flow rule, bracket, permanent-load stresses, what is collected."""

    model: Model
    flow: Flow
    enclosing: Bracket
    permanent: Array
    scale: float
    collected: Collected
    tell: Callable[..., None]


def load_factor_range(
    model: Model,
    *,
    dilatancy: float = 0.0,
    turning: Turning | str = Turning.CENTROID,
    paths: int = 15,
    mechanisms: int = 100,
    seed: int = 0,
    time_limit: float = 120.0,
    exact: bool = False,
    progress: Progress | None = None,
) -> LoadFactorRange:
    """Return certified load factors without dilatancy, and how far they reach.

    A non-associated load factor is not unique. Load paths lead from many admissible states of the permanent
    loads to solutions; from each, two convex programs give the least and the greatest load factor of its
    mechanism, and prove every value between; more mechanisms are drawn at random. Every answer is checked at
    1e-8. What is found is certified; what is not found may exist, unless `exact`.

    Parameters
    ----------
    model : Model
        The structure.
    dilatancy, turning
        As for :func:`limitblocks.nonassociated`. With turning about the centre of pressure the set has no
        convex pieces, and there are paths alone.
    paths : int
        Load paths and other ways to a solution, at least 1; the first is :func:`limitblocks.nonassociated`.
    mechanisms : int
        Mechanisms drawn at random, after a descent and an ascent from every answer of the paths; 0: none.
    seed : int
        Of all that is random.
    time_limit : float
        Seconds of wall time: half of it for paths, the rest for mechanisms; that of each exact program, too.
    exact : bool
        Also the least and the greatest of all solutions, by mixed-integer programs; for models of a few
        blocks with joints of planes.
    progress : callable, optional
        Called with an Iteration for every point of a path, and for every way and mechanism when it has ended.

    Raises
    ------
    ModelError
        A number is out of range, or `exact` is asked for joints with round friction.
    NoEquilibrium, UnlimitedLoad
        As for :func:`limitblocks.nonassociated`.
    """
    flow_rule = checked_dilatancy(model.problem, dilatancy), turning_of(turning)
    if paths < 1 or mechanisms < 0 or not time_limit > 0.0:
        raise ModelError(
            f"paths is {paths}, mechanisms {mechanisms}, time_limit {time_limit}; expected at least "
            "1, at least 0 and more than 0 s"
        )
    enclosing = bracket(model)
    problem = own_units(model, enclosing)
    flow = Flow(problem, *flow_rule)
    refuse_jammed(enclosing)
    refuse_unlimited(flow, enclosing.associated)
    if exact:
        refuse(flow)
    task = _task(model, flow, enclosing, progress)
    begun = time.monotonic()
    first, walked, stopped = _walked(task, paths, seed, begun + time_limit / 2)
    wanted = mechanisms if flow.constant else 0
    drawn = (0, 0) if stopped else _drawn(task, wanted, seed, begun + time_limit)
    asked = exact and not stopped
    ends = [_extreme(task, sense, time_limit) if asked else None for sense in (1.0, -1.0)]
    return _result(task, first, walked, drawn, ends, (paths, wanted))


def _task(model: Model, flow: Flow, enclosing: Bracket, progress: Progress | None) -> _Task:
    problem = flow.problem
    scale, endless = load_scale(problem, enclosing.associated), bool(np.isinf(enclosing.associated))
    limits = (0.0, BEYOND * scale if endless else np.inf)  # a load that grows never comes below zero

    def tell(state: State | None, how: str, known: float = float("nan")) -> None:
        if progress is not None:
            factor = state.load_factor / problem.units.live if state else known
            progress(Iteration(factor, how, 0.0, {}, 0, 0))

    x0 = start_stresses(model, problem, problem.compliance, None)
    return _Task(model, flow, enclosing, x0, scale, Collected(flow, limits, scale, endless), tell)


def _walked(
    task: _Task, paths: int, seed: int, deadline: float
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
        bounds, units = task.enclosing.bounds, task.flow.problem.stress_units
        associated = bounds.generalised_stresses / units if bounds else None
        sampler = Sampler(task.flow, task.permanent, associated, task.scale, watch)
        for way in islice(sampler.ways(seed), paths - 1):
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


def _first(task: _Task, watch: Callable[[object], None]) -> RangeAnswer | None:
    """The answer of `nonassociated`, collected."""
    flow = task.flow
    result = nonassociated(
        task.model, dilatancy=flow.dilatancy, turning=flow.turning, progress=watch, throw=False
    )
    if result.status is Status.INTERRUPTED:
        raise KeyboardInterrupt
    if not result.converged:
        return None
    loaded = any(word in result.how for word in LOADING)
    origin = Origin.LOAD_PATH if loaded else Origin.SEARCHED
    state = state_of(task.model, flow.problem, result)
    task.collected.add(state, result.how, origin, keep=False)
    return of_result(task.model, flow, task.permanent, result, origin)


def _drawn(task: _Task, count: int, seed: int, deadline: float) -> tuple[int, int]:
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


def _extreme(task: _Task, sense: float, time_limit: float) -> Extreme:
    """The least or the greatest load factor of all solutions."""
    live = task.flow.problem.units.live
    low, high = task.enclosing.frictionless * live, task.enclosing.associated * live
    room = 1e-6 * task.scale  # the bracket is known to a tolerance
    low = max(0.0, low - room) if np.isfinite(low) else 0.0
    high = high + room if np.isfinite(high) else task.collected.limits[1]
    state, bound, stresses, multipliers, seconds = exact_extreme(task.flow, (low, high), sense, time_limit)
    one = state and Certified(state, "mixed-integer program", Origin.SEARCHED)
    best = answer(task.model, task.flow, task.enclosing, task.permanent, one) if one else None
    near = state is not None and abs(state.load_factor - bound) <= AGREES * task.scale
    return Extreme(best, bound / live, near, stresses, multipliers, seconds)


def _result(
    task: _Task,
    first: RangeAnswer | None,
    walked: tuple[int, int],
    drawn: tuple[int, int],
    ends: list[Extreme | None],
    asked: tuple[int, int],
) -> LoadFactorRange:
    collected, flow, live = task.collected, task.flow, task.flow.problem.units.live
    answers = [answer(task.model, flow, task.enclosing, task.permanent, one) for one in collected.all()]
    answers = sorted([*answers, *([first] if first else [])], key=lambda one: one.load_factor)
    return LoadFactorRange(
        load_path=first,
        answers=tuple(answers),
        intervals=tuple((low / live, high / live) for low, high in collected.intervals),
        unlimited=collected.beyond is not None,
        frictionless=task.enclosing.frictionless,
        associated=task.enclosing.associated,
        wedging=wedging(flow.problem),
        least=ends[0],
        greatest=ends[1],
        paths=walked,
        mechanisms=drawn,
        complete=(walked[0], drawn[0]) == asked,
        remarks=remarks(flow, first, answers),
        dilatancy=flow.dilatancy,
        turning=flow.turning,
        tolerance=TOLERANCE,
        digest=task.model.digest,
    )

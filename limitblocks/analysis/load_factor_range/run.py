"""The set of certified load factors of a structure: paths, faces, mechanisms, and exact programs."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from limitblocks.analysis.load_factor_range.answers import Collected, answer, remarks
from limitblocks.analysis.load_factor_range.exact import refuse
from limitblocks.analysis.load_factor_range.search import Task, drawn, extreme, walked
from limitblocks.analysis.load_factor_range.wedging import wedging
from limitblocks.analysis.nonassociated.start import (
    Bracket,
    flow_of,
    load_scale,
    refuse_jammed,
    refuse_unlimited,
    start_stresses,
)
from limitblocks.analysis.one_thread import one_thread
from limitblocks.arrays import real
from limitblocks.errors import ModelError, refuse_no_progress
from limitblocks.evidence.range_answer import RangeAnswer
from limitblocks.evidence.range_result import Extreme, LoadFactorRange
from limitblocks.evidence.residuals import TOLERANCE
from limitblocks.evidence.results import Iteration
from limitblocks.joints.base import checked_count
from limitblocks.model import Model
from limitblocks.problem import Flow, State, Turning

BEYOND = 10.0  # times the load scale: load factors looked at where nothing limits them
Progress = Callable[[Iteration], None]


@one_thread
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
        Also the least and the greatest of all solutions with a load factor of at least zero, by mixed-integer
        programs; for models of a few blocks with joints of planes.
    progress : callable, optional
        Called with an Iteration for every point of a path, and for every way and mechanism when it has ended.

    Raises
    ------
    ModelError
        A number is out of range, or `exact` is asked for joints with round friction.
    NoEquilibrium, UnlimitedLoad
        As for :func:`limitblocks.nonassociated`.
    """
    checked_count("paths", paths, 1)
    checked_count("mechanisms", mechanisms, 0)
    checked_count("seed", seed, 0)
    refuse_no_progress(progress)
    if not real(time_limit) > 0.0:
        raise ModelError(f"time_limit is {time_limit!r}, expected more than 0 s")
    flow, enclosing = flow_of(model, dilatancy, turning)
    refuse_jammed(enclosing)
    refuse_unlimited(flow, enclosing.associated)
    if exact:
        refuse(flow)
    task = _task(model, flow, enclosing, progress)
    begun = time.monotonic()
    first, ways, stopped = walked(task, paths, seed, begun + time_limit / 2)
    wanted = mechanisms if flow.constant else 0
    found = (0, 0) if stopped else drawn(task, wanted, seed, begun + time_limit)
    asked = exact and not stopped
    ends = [extreme(task, sense, time_limit) if asked else None for sense in (1.0, -1.0)]
    return _result(task, first, ways, found, ends, (paths, wanted))


def _task(model: Model, flow: Flow, enclosing: Bracket, progress: Progress | None) -> Task:
    problem = flow.problem
    scale, endless = load_scale(problem, enclosing.associated), bool(np.isinf(enclosing.associated))
    limits = (0.0, BEYOND * scale if endless else np.inf)  # a load that grows never comes below zero

    def tell(state: State | None, how: str, known: float = float("nan")) -> None:
        if progress is not None:
            factor = float(state.load_factor / problem.units.live) if state else known
            progress(Iteration(factor, how, 0.0, {}, 0, 0))

    x0 = start_stresses(model, flow, problem.compliance, None)
    return Task(model, flow, enclosing, x0, scale, Collected(flow, limits, scale, endless), tell)


def _result(
    task: Task,
    first: RangeAnswer | None,
    ways: tuple[int, int],
    mechanisms: tuple[int, int],
    ends: list[Extreme | None],
    asked: tuple[int, int],
) -> LoadFactorRange:
    collected, flow, live = task.collected, task.flow, task.flow.problem.units.live
    states = collected.all(first.load_factor * live if first else np.nan)
    answers = [answer(task.model, flow, task.enclosing, task.permanent, one) for one in states]
    answers = sorted([*answers, *([first] if first else [])], key=lambda one: one.load_factor)
    return LoadFactorRange(
        load_path=first,
        answers=tuple(answers),
        intervals=tuple((float(low / live), float(high / live)) for low, high in collected.intervals),
        unlimited=collected.beyond is not None,
        frictionless=task.enclosing.frictionless,
        associated=task.enclosing.associated,
        wedging=wedging(flow.problem),
        least=ends[0],
        greatest=ends[1],
        paths=ways,
        mechanisms=mechanisms,
        complete=(ways[0], mechanisms[0]) == asked,
        remarks=remarks(flow, first, answers),
        dilatancy=flow.dilatancy,
        turning=flow.turning,
        tolerance=TOLERANCE,
        digest=task.model.digest,
    )

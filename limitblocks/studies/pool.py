"""Analyses of many models in a pool of processes, in the order given; a failure costs its own row only."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass
from inspect import Signature, signature
from multiprocessing import resource_tracker
from typing import Any, Literal

import numpy as np

from limitblocks.analysis.bounds import bounds
from limitblocks.analysis.nonassociated.loop import nonassociated
from limitblocks.analysis.nonassociated.means import checked_means
from limitblocks.analysis.nonassociated.start import stresses_given
from limitblocks.choices import method_of, turning_of
from limitblocks.errors import LimitBlocksError, ModelError, NotConverged, SolveError, UnlimitedLoad
from limitblocks.evidence.associated import Bounds
from limitblocks.evidence.backward_error import checked_limit
from limitblocks.evidence.ending import Status
from limitblocks.evidence.results import Nonassociated
from limitblocks.joints.base import checked_count
from limitblocks.mechanics.loads.load import number
from limitblocks.model import Model

Analysis = Literal["bounds", "nonassociated"]
Result = Bounds | Nonassociated
Progress = Callable[[int, int], None]
INTERRUPTED = "interrupted before this one was done"
#: What costs its own row only: errors of this package, and those of numbers in a maker or a solver.
FAILURES = (LimitBlocksError, ArithmeticError, ValueError, MemoryError)
ANALYSES: dict[str, Callable[..., Result]] = {"bounds": bounds, "nonassociated": nonassociated}
#: What a setting must be whatever the model, as the analyses check it.
SETTINGS: dict[str, Callable[[Any], object]] = {
    "tolerance": lambda value: number(value, "tolerance", "", above=0.0),
    "dilatancy": lambda value: number(value, "dilatancy", "", least=0.0),
    "turning": turning_of,
    "method": method_of,
    "backward_error": checked_limit,
    "start": lambda value: value is None or stresses_given(value),
    "means": lambda value: value is None or checked_means(value),
}


@dataclass(frozen=True, eq=False)
class Outcome:
    """What became of one analysis.

    Attributes
    ----------
    load_factor : float
        Static bound, or non-associated load factor; infinite where the load is unlimited, NaN where there is
        no answer.
    result : Bounds or Nonassociated or None
        The result; of an analysis that did not converge the best state, whose status says so.
    error : str
        Class and message of the error, empty where there is none.
    """

    load_factor: float
    result: Result | None
    error: str


def failed(error: Exception) -> Outcome:
    """Return the outcome of an analysis that raised `error`."""
    best = error.result if isinstance(error, NotConverged) else None
    load_factor = np.inf if isinstance(error, UnlimitedLoad) else np.nan
    return Outcome(load_factor, best, f"{type(error).__name__}: {' '.join(str(error).split())}")


def analyse(model: Model, analysis: Analysis, settings: dict[str, Any]) -> Outcome:
    """Analyse one model; an error becomes an outcome, and so does a state that is no solution."""
    try:
        result = ANALYSES[analysis](model, **settings)
        if isinstance(result, Nonassociated) and not result.accepted:  # throw=False
            raise NotConverged(result.status.value, result)
    except FAILURES as error:
        if getattr(getattr(error, "result", None), "status", None) is Status.INTERRUPTED:
            raise KeyboardInterrupt from None  # the user means the study
        return failed(error)
    return Outcome(result.lower if isinstance(result, Bounds) else result.load_factor, result, "")


def analyse_all(
    models: Sequence[Model | Outcome],
    analysis: Analysis,
    settings: dict[str, Any],
    workers: int | None,
    progress: Progress | None,
) -> list[Outcome]:
    """Return what became of each model, in order; where the user interrupts it, what there is until then.

    Parameters
    ----------
    models : sequence of Model or Outcome
        An outcome, of a model that could not be made, stays as it is.
    analysis : str
        Key of ANALYSES.
    settings : dict
        Further arguments of the analysis.
    workers : int or None
        Processes; 1 stays in this one, None takes one for each core.
    progress : callable, optional
        Called with the number of analyses done and of all.

    Raises
    ------
    ModelError
        If the analysis is unknown, a setting is not one of it or wrong, or `workers` is not at least 1.
    SolveError
        If a process of the pool was ended from outside, as where memory runs out.
    """
    checked_settings(analysis, settings)
    checked_workers(workers)
    outcomes: dict[int, Outcome] = {k: made for k, made in enumerate(models) if isinstance(made, Outcome)}
    places = [k for k in range(len(models)) if k not in outcomes]
    tasks = [(models[k], analysis, settings) for k in places]
    try:
        for k, outcome in zip(places, in_order(analyse, tasks, workers), strict=True):
            outcomes[k] = outcome
            if progress is not None:
                progress(len(outcomes), len(models))
    except KeyboardInterrupt:
        if not any(k in outcomes for k in places):
            raise
    return [outcomes.get(k, Outcome(np.nan, None, INTERRUPTED)) for k in range(len(models))]


def checked_settings(analysis: str, settings: Mapping[str, Any]) -> None:
    """Raise ModelError where settings are not of the analysis, or wrong whatever the model."""
    if analysis not in ANALYSES:
        raise ModelError(f"analysis is {analysis!r}, expected {' or '.join(map(repr, ANALYSES))}")
    fits(f"study, with {analysis}", signature(ANALYSES[analysis]), (None,), settings)
    for name, value in settings.items():
        if name in SETTINGS:
            SETTINGS[name](value)


def fits(who: str, takes: Signature, first: tuple[None, ...], given: Mapping[str, Any]) -> None:
    """Raise ModelError where a function does not take what is given by name."""
    try:
        takes.bind(*first, **given)
    except TypeError as error:
        words = ", ".join(list(takes.parameters)[len(first) :])
        raise ModelError(f"{who} is given {', '.join(given)} ({error}); it takes {words}") from None


def checked_workers(workers: int | None) -> None:
    """Raise ModelError unless `workers` is a whole number of at least 1, or None for all cores."""
    if workers is not None:
        checked_count("workers", workers, 1)


def in_order(
    function: Callable[..., Any], tasks: Sequence[tuple[Any, ...]], workers: int | None
) -> Iterator[Any]:
    """Yield `function(*task)` of each task, in their order, from a pool of processes."""
    if workers == 1 or len(tasks) < 2:
        yield from (function(*task) for task in tasks)
        return
    from joblib import Parallel, delayed  # its processes need no `if __name__ == "__main__"` in scripts

    pool = Parallel(n_jobs=workers or -1, return_as="generator", batch_size=1, max_nbytes=None)
    try:
        with _uninterrupted():
            results = pool(delayed(function)(*task) for task in tasks)
        yield from results
    except BrokenProcessPool:
        raise SolveError("a process of the study was ended from outside; try fewer workers") from None


@contextmanager
def _uninterrupted() -> Iterator[None]:
    """Hold Ctrl-C back here, and for ever in processes that start meanwhile: this one ends them."""
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    resource_tracker.ensure_running()  # as it starts it lets go of the signal
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)

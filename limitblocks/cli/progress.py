"""Progress on stderr: a bar on a terminal, elsewhere a line every ten seconds."""

from __future__ import annotations

import logging
import math
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from rich.console import Console

    from limitblocks.evidence.results import Iteration
    from limitblocks.practice import CapacityPoint, SettlementPoint

EVERY = 10.0  # s between lines
Tell = Callable[[str, float | None], None]


@contextmanager
def of_iterations(verb: str) -> Iterator[Callable[[Iteration], None]]:
    """Give a callback for the iterations of an analysis."""
    with _told(verb) as tell:
        yield lambda one: tell(_of(one), _share(one))


@contextmanager
def of_stages(verb: str) -> Iterator[Callable[[str], None]]:
    """Give a callback for the stages of an analysis."""
    with _told_within(verb) as tell:
        yield lambda stage: tell(stage, None)


@contextmanager
def of_points(verb: str) -> Iterator[Callable[[CapacityPoint], None]]:
    """Give a callback for the points of a capacity curve."""
    with _told_within(verb) as tell:
        yield lambda one: tell(f"{one.displacement:.6g} m: load factor {one.load_factor:.6g}", None)


@contextmanager
def of_settlement(verb: str) -> Iterator[Callable[[SettlementPoint], None]]:
    """Give a callback for the points of a support that settles."""
    with _told_within(verb) as tell:
        yield lambda one: tell(f"{one.displacement:.6g} m: reaction {one.reaction:.6g} N", None)


@contextmanager
def of_places(verb: str) -> Iterator[Callable[[float, float], None]]:
    """Give a callback for the places of a vehicle."""
    with _told_within(verb) as tell:
        yield lambda x, factor: tell(f"X = {x:.6g} m: {_in_words(factor)}", None)


@contextmanager
def of_a_count(verb: str) -> Iterator[Callable[[int, int], None]]:
    """Give a callback for the number of analyses that are done, and of all."""
    with _told_within(verb) as tell:
        yield lambda done, total: tell(f"{done} of {total}", done / total)


def _share(one: Iteration) -> float | None:
    """Decades of theta, or of the largest residual, on the way down to the tolerance."""
    from limitblocks.evidence.residuals import TOLERANCE

    left = max(one.residuals.values(), default=math.nan)
    return min(1.0, math.log10(min(left, 1.0)) / math.log10(TOLERANCE)) if left > 0.0 else None


@contextmanager
def _told(verb: str) -> Iterator[Tell]:
    from rich.console import Console

    console = Console(stderr=True)
    with _bar(verb, console) if console.is_terminal else _lines(verb) as tell:
        yield tell


@contextmanager
def _told_within(verb: str) -> Iterator[Tell]:
    """Tell after what is told of an analysis how one within it goes, such as at the next point of a curve."""
    from limitblocks.evidence.results import ITERATIONS

    log, said = logging.getLogger(ITERATIONS), [""]
    with _told(verb) as tell:

        def outer(text: str, share: float | None) -> None:
            said[:] = [f"{text}; next "]
            tell(text, share)

        heard = _Heard(lambda one: tell(f"{said[0]}{_of(one)}", None))
        level = log.level
        log.setLevel(logging.DEBUG)
        log.addHandler(heard)
        try:
            yield outer
        finally:
            log.removeHandler(heard)
            log.setLevel(level)


class _Heard(logging.Handler):
    """Passes on the iterations that are logged."""

    def __init__(self, show: Callable[[Iteration], None]) -> None:
        super().__init__()
        self.show = show

    def emit(self, record: logging.LogRecord) -> None:
        self.show(record.msg)  # type: ignore[arg-type] # the Iteration itself


@contextmanager
def _bar(verb: str, console: Console) -> Iterator[Tell]:
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as ProgressBar

    columns = TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn()
    with ProgressBar(*columns, console=console, transient=True) as bar:
        task = bar.add_task(verb, total=None)

        def tell(text: str, share: float | None) -> None:
            if share is not None:
                bar.update(task, total=1.0, completed=share)
            bar.update(task, description=text)

        yield tell


@contextmanager
def _lines(verb: str) -> Iterator[Tell]:
    """Lines from a thread: one convex program may take minutes and tells nothing meanwhile."""
    begun, said, ended = time.monotonic(), [""], threading.Event()

    def watch() -> None:
        while not ended.wait(EVERY):
            typer.echo(f"{verb}: {time.monotonic() - begun:.0f} s{said[0]}", err=True)

    def tell(text: str, _share: float | None) -> None:
        said[0] = f", {text}"

    thread = threading.Thread(target=watch, daemon=True)
    thread.start()
    try:
        yield tell
    finally:
        ended.set()
        thread.join()


def _of(one: Iteration) -> str:
    return f"{one.kind}: {_in_words(one.load_factor)}"


def _in_words(load_factor: float) -> str:
    """Return a load factor as text; NaN is none, infinity is that of a load that only jams."""
    if math.isnan(load_factor):
        return "no load factor"
    return "unlimited" if math.isinf(load_factor) else f"load factor {load_factor:.6g}"

"""Ways of many answers that the user may stop: what was found by then is kept."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from itertools import takewhile
from typing import Any, Protocol, TypeVar

from limitblocks.errors import ModelError, NotConverged
from limitblocks.evidence.ending import Status


class Placed(Protocol):
    """A point of a way."""

    @property
    def displacement(self) -> float:
        """How far it is along the way, m."""

    @property
    def across(self) -> tuple[str, ...]:
        """Joints that press across a gap."""


P = TypeVar("P", bound=Placed)
A = TypeVar("A")


def solved(analysis: Callable[..., A], *given: Any) -> A:
    """An answer; where the user stops it there is none, and no shorter step is a way out."""
    try:
        return analysis(*given)
    except NotConverged as error:
        if error.result.status is Status.INTERRUPTED:
            raise KeyboardInterrupt from None
        raise


def gathered(way: Generator[P, None, A], progress: Callable[[P], None] | None) -> tuple[list[P], A | str]:
    """The points of a way and what it returns at its end; a sentence where the user stops it."""
    points: list[P] = []
    try:
        while True:
            points.append(next(way))
            if progress:
                progress(points[-1])
    except StopIteration as end:
        return points, end.value
    except KeyboardInterrupt:
        at = points[-1].displacement if points else 0.0
        return points, f"interrupted beyond {at:.6g} m"


def refuse_empty(points: Sequence[Placed], what: str) -> None:
    """ModelError where a way, as of a file, has no points."""
    if not points:
        raise ModelError(f"a {what} without points, expected the structure as it is at least")


def sound_to(points: Sequence[Placed]) -> float:
    """Return how far along a way no joint presses across a gap, m."""
    sound = [point.displacement for point in takewhile(lambda point: not point.across, points)]
    return sound[-1] if sound else 0.0

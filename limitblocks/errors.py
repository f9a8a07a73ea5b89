"""The error tree of limitblocks.

::

    LimitBlocksError
    ├── ModelError              the description of the structure is wrong
    │   └── GeometryError       ... because of the shape or place of a block or interface
    ├── SolveError              the analysis gave no answer
    │   ├── NoEquilibrium       the dead loads alone cannot stand
    │   ├── UnlimitedLoad       the live load can grow without limit
    │   ├── NotConverged        the iteration stopped early; carries its best result
    │   │   └── NoSolution      ... since it is proven that there is none
    │   └── SolverFailure       no solver gave an answer that passes the recomputed residuals
    ├── CheckFailed             a result does not satisfy the conditions it claims to satisfy
    └── MissingDependency       an optional package is needed

Every message is one line: what is wrong, the name and value, what would be right.
"""

from __future__ import annotations

import copyreg
import reprlib
from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from limitblocks.evidence.results import Nonassociated

__all__ = [
    "CheckFailed",
    "GeometryError",
    "LimitBlocksError",
    "MissingDependency",
    "ModelError",
    "NoEquilibrium",
    "NoSolution",
    "NotConverged",
    "SolveError",
    "SolverFailure",
    "UnlimitedLoad",
]

#: Faults that are listed; who mends these reads the file again.
MOST_PROBLEMS = 20


def bounded(lines: Sequence[str]) -> tuple[str, ...]:
    """Return the first 20 lines, and how many more there are where there are."""
    more = len(lines) - MOST_PROBLEMS
    return (*lines[:MOST_PROBLEMS], f"and {more} more faults") if more > 1 else tuple(lines)


def few(names: Sequence[object], most: int = 8) -> str:
    """Return the first of some names as text, and how many more there are."""
    return ", ".join(map(str, names[:most])) + (f" and {len(names) - most} more" if len(names) > most else "")


def missing(left_out: Sequence[str]) -> list[str]:
    """Return the line that says which parts of a file are missing in its model; none where none is."""
    if not left_out:
        return []
    return [
        f"left out when the file was read: {few(left_out)}; if these are what is missing, mend or show them "
        "in the drawing (limitblocks look says what is wrong) and import it again"
    ]


class LimitBlocksError(Exception):
    """Root of all errors that limitblocks raises on purpose."""

    def __reduce__(self) -> tuple[Any, ...]:  # Exception calls the class with the message alone
        return copyreg.__newobj__, (type(self), *self.args), vars(self)  # type: ignore[attr-defined]


class ModelError(LimitBlocksError):
    """The model is wrong; `problems` lists the first 20 faults found, one line each, and how many more."""

    def __init__(self, *problems: str) -> None:
        self.problems = bounded(problems)
        super().__init__("; ".join(self.problems))


class GeometryError(ModelError):
    """A block or an interface has an impossible shape or place."""


class SolveError(LimitBlocksError):
    """The analysis gave no answer."""


class NoEquilibrium(SolveError):
    """The dead loads alone cannot stand; `blocks` names the blocks that fall.

    `left_out` are parts of the file of the model that are no blocks of it, `loads` says what falls;
    `said` is the message without what to check, as of a structure that has moved.
    """

    def __init__(
        self, blocks: tuple[str, ...], left_out: Sequence[str] = (), loads: str = "the dead loads alone"
    ) -> None:
        self.blocks, self.left_out = blocks, tuple(left_out)
        self.said = f"{loads} cannot stand: {few(blocks)} would fall"
        check = "check dimensions, supports, missing interfaces, friction and strengths"
        super().__init__("; ".join([self.said, check, *missing(left_out)]))


class UnlimitedLoad(SolveError):
    """The live load can grow without limit: it jams the blocks instead of moving them."""


class NotConverged(SolveError):
    """The iteration did not reach its tolerance; `result` is the best state found."""

    def __init__(self, message: str, result: Nonassociated) -> None:
        self.result = result
        super().__init__(message)


class NoSolution(NotConverged):
    """The equations have no solution, which is proven; `result` is the state at the limit of yield."""


class SolverFailure(SolveError):
    """No solver gave an answer whose recomputed residuals are within tolerance."""


class CheckFailed(LimitBlocksError):
    """A result does not satisfy the conditions it claims to satisfy."""


class MissingDependency(LimitBlocksError):
    """An optional package is needed; the message names it and how to install it."""


def refuse_kind(value: object, kind: type, word: str) -> None:
    """Raise ModelError where `value`, named `word`, is not of a kind."""
    if not isinstance(value, kind):
        raise ModelError(f"{word} is a {type(value).__name__}, expected {kind.__name__}")


def refuse_no_function(maker: object) -> None:
    """Raise ModelError where what is to make models, `maker`, cannot be called, as a model cannot."""
    if not callable(maker):
        raise ModelError(
            f"maker is a {type(maker).__name__}, expected a function that gives the model of a value"
        )


def refuse_no_progress(progress: object) -> None:
    """Raise ModelError where what is to be told of the progress can neither be called nor is None."""
    if not (progress is None or callable(progress)):
        raise ModelError(f"progress is a {type(progress).__name__}, expected a function of one iteration")


def near(name: str, known: Iterable[str]) -> str:
    """Return '; did you mean ...?', or nothing where no known name is like `name`."""
    letters = {one.casefold(): one for one in known}
    names = get_close_matches(str(name).casefold(), letters, 1)
    return f"; did you mean {letters[names[0]]!r}?" if names else ""


def path_of(file: Any) -> Path:
    """Return the path of a file that is given by its name, or raise ModelError."""
    try:
        return Path(file)
    except TypeError:
        raise ModelError(f"file is {reprlib.repr(file)}, expected its name: a str or Path") from None


def sequence_of(word: str, given: Any, kind: type) -> tuple[Any, ...]:
    """Return a sequence of one kind of things as a tuple, or raise ModelError."""
    if isinstance(given, str) or not isinstance(given, Iterable):
        raise ModelError(f"{word} is {given!r}, expected a sequence of {kind.__name__}")
    members = tuple(given)
    wrong = [one for one in members if not isinstance(one, kind)]
    if wrong:
        raise ModelError(f"{word} holds {wrong[0]!r}, expected a sequence of {kind.__name__}")
    return members


def __dir__() -> list[str]:
    return __all__

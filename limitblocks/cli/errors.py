"""Errors as lines on stderr and exit codes."""

from __future__ import annotations

import os
import re
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryFile
from typing import Any

import typer
from typer.core import TyperGroup

from limitblocks.errors import CheckFailed, LimitBlocksError, ModelError, SolveError

INTERRUPTED = 130  # as shells say it: 128 and the number of the signal
_EXPECTED = {"float_parsing": "expected a number", "int_parsing": "expected a whole number"}
_EXPECTED |= {"int_from_float": "expected a whole number"}
_DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+([eE][+-]?\d+)?")


@contextmanager
def clean_errors() -> Iterator[None]:
    """Turn errors into lines on stderr, one a fault, and an exit code."""
    try:
        yield
    except LimitBlocksError as error:
        faults = error.problems if isinstance(error, ModelError) else (str(error),)
        for fault in faults:
            typer.echo(f"error: {' '.join(fault.split())}", err=True)
        for note in getattr(error, "__notes__", ()):
            typer.echo(note, err=True)
        raise typer.Exit(exit_code(error)) from None
    except KeyboardInterrupt:
        typer.echo("interrupted, with nothing to write yet", err=True)
        raise typer.Exit(INTERRUPTED) from None


class Verbs(TyperGroup):
    """The commands, with the value in front of what typer says of an option that is wrong."""

    def invoke(self, ctx: Any) -> Any:
        """Run the command; complete its complaint."""
        try:
            return super().invoke(ctx)
        except typer.BadParameter as error:
            cause: Any = error.__cause__
            if hasattr(cause, "errors"):  # of pydantic, by which typer reads numbers
                error.message = _wrong_value(cause.errors()[0])
            raise


def _wrong_value(fault: dict[str, Any]) -> str:
    """What is wrong with the value of an option, in words."""
    given, kind, said = fault["input"], fault["type"], str(fault["msg"])
    if kind == "value_error":  # names it already
        return said.removeprefix("Value error, ")
    expected = _EXPECTED.get(kind) or said.replace("Input should be", "expected a number")
    comma = kind == "float_parsing" and _DECIMAL_COMMA.fullmatch(given)
    point = f"; decimals stand after a point, as in {given.replace(',', '.')}" if comma else ""
    return f"{given!r}: {expected}{point}"


@contextmanager
def interrupts() -> Iterator[list[int]]:
    """Give a list that has an entry once the user pressed Ctrl-C, whatever the analysis makes of it."""
    seen: list[int] = []
    usual = signal.getsignal(signal.SIGINT)

    def noted(number: int, frame: Any) -> None:
        seen.append(number)
        signal.default_int_handler(number, frame)

    noting = threading.current_thread() is threading.main_thread()  # no other may set handlers
    if noting:
        signal.signal(signal.SIGINT, noted)
    try:
        yield seen
    finally:
        if noting:
            signal.signal(signal.SIGINT, usual)


def with_notes(error: Exception) -> str:
    """An error and what was noted with it, in one line."""
    return "; ".join(" ".join(part.split()) for part in (str(error), *getattr(error, "__notes__", ())))


def exit_code(error: LimitBlocksError) -> int:
    """1 a check failed, 2 the model is wrong, 3 no solution found."""
    if isinstance(error, CheckFailed):
        return 1
    return 3 if isinstance(error, SolveError) else 2


def refuse_existing(file: Path | None, force: bool, *others: Path | None, option: str = "--output") -> None:
    """Refuse a file that could not be written before the analysis.

    `others` are what the command reads, and what else it writes.
    """
    if file is None:
        return
    if str(file) == "-":
        said = "expected a file, not the standard output; commands that have --json print their answer there"
        raise LimitBlocksError(f"{option} -: {said}")
    if any(file.resolve() == other.resolve() for other in others if other):
        raise LimitBlocksError(f"{file} is what the command reads or writes, too; name another with {option}")
    if not os.path.isdir(file.parent):
        raise LimitBlocksError(f"{option} {file}: there is no folder {file.parent}; make it first")
    if os.path.isdir(file):
        raise LimitBlocksError(f"{option} {file} is a folder; name a file")
    device = os.path.exists(file) and not os.path.isfile(file)
    try:
        if not device:
            TemporaryFile(dir=file.parent).close()  # what may be written the system knows only as it is done
    except OSError as error:
        why = f"the folder {file.parent} may not be written to: {error.strerror}"
        raise LimitBlocksError(f"{option} {file}: {why}") from None
    if not force and os.path.exists(file):
        raise LimitBlocksError(f"{file} exists; name another file with {option} or replace it with --force")

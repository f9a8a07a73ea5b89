"""Errors as lines on stderr and exit codes."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import typer

from limitblocks.errors import CheckFailed, LimitBlocksError, ModelError, SolveError


@contextmanager
def clean_errors() -> Iterator[None]:
    """Turn errors into lines on stderr, one a fault, and an exit code."""
    try:
        yield
    except LimitBlocksError as error:
        faults = error.problems if isinstance(error, ModelError) else (str(error),)
        for fault in faults:
            typer.echo(f"error: {' '.join(fault.split())}", err=True)
        raise typer.Exit(exit_code(error)) from None


def exit_code(error: LimitBlocksError) -> int:
    """1 a check failed, 2 the model is wrong, 3 no solution found."""
    if isinstance(error, CheckFailed):
        return 1
    return 3 if isinstance(error, SolveError) else 2


def refuse_existing(file: Path | None, force: bool, model: Path) -> None:
    """Refuse before the analysis, not after it."""
    if file and file.resolve() == model.resolve():
        raise LimitBlocksError(f"{file} is the model; name another file with --output")
    if file and not force and file.exists():
        raise LimitBlocksError(f"{file} exists; name another file with --output or replace it with --force")

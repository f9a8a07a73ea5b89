"""Studies on a model file: many load factors by one command."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from limitblocks.cli.errors import INTERRUPTED as EXIT_INTERRUPTED
from limitblocks.cli.errors import clean_errors, refuse_existing
from limitblocks.cli.options import (
    AsJson,
    Count,
    CsvFile,
    Dilatancy,
    Force,
    ModelFile,
    OwnTolerance,
    ResultFile,
    Workers,
)
from limitblocks.cli.progress import of_a_count
from limitblocks.cli.vectors import Command, vector
from limitblocks.errors import LimitBlocksError, SolveError

if TYPE_CHECKING:
    from limitblocks.studies import Study

studies = typer.Typer(
    help="Many analyses of one model: push directions, a moving load.",
    no_args_is_help=True,
    rich_markup_mode=None,
)

Vertical = Annotated[bool, typer.Option("--vertical", help="Also up and down.")]
Nonassociated = Annotated[
    bool, typer.Option("--nonassociated", help="Joints that slide without lifting, not the bounds.")
]
MovingForce = Annotated[Any, vector("--load", names="FX,FY,FZ", help="Force, N, global axes.")]
Start = Annotated[Any, vector("--from", names="X,Y", help="First place in plan, m.")]
End = Annotated[Any, vector("--to", names="X,Y", help="Last place in plan, m.")]


@studies.command()
def directions(
    model: ModelFile,
    count: Count = 16,
    vertical: Vertical = False,
    nonassociated: Nonassociated = False,
    dilatancy: Dilatancy = 0.0,
    tolerance: OwnTolerance = None,
    workers: Workers = None,
    as_json: AsJson = False,
    csv: CsvFile = None,
    output: ResultFile = None,
    force: Force = False,
) -> None:
    """Print the load factor for each direction of a mass-proportional live load."""
    with clean_errors():
        from limitblocks.cli.answers import questioned
        from limitblocks.mechanics.loads import compass
        from limitblocks.studies import directions as study

        _refuse(model, csv, output, force)
        settings = _settings(nonassociated, dilatancy, tolerance, workers)
        with of_a_count("study") as show:
            answer = study(questioned(model), compass(count, vertical=vertical), progress=show, **settings)
        _tell(answer, as_json, csv, output, force)


@studies.command(cls=Command)
def moving(
    model: ModelFile,
    load: MovingForce,
    start: Start,
    end: End,
    count: Count = 21,
    nonassociated: Nonassociated = False,
    dilatancy: Dilatancy = 0.0,
    tolerance: OwnTolerance = None,
    workers: Workers = None,
    as_json: AsJson = False,
    csv: CsvFile = None,
    output: ResultFile = None,
    force: Force = False,
) -> None:
    """Print the load factor of a force on top of the structure at places along a line, and the least."""
    with clean_errors():
        import numpy as np

        from limitblocks.cli.answers import questioned
        from limitblocks.studies import moving_load as study

        _refuse(model, csv, output, force)
        settings = _settings(nonassociated, dilatancy, tolerance, workers)
        with of_a_count("study") as show:
            places = np.linspace(start, end, count)
            answer = study(questioned(model), load, places, progress=show, **settings)
        _tell(answer, as_json, csv, output, force)


def _settings(
    nonassociated: bool, dilatancy: float, tolerance: float | None, workers: int | None
) -> dict[str, Any]:
    if dilatancy and not nonassociated:
        raise LimitBlocksError("--dilatancy needs --nonassociated")
    analysis = {"analysis": "nonassociated", "dilatancy": dilatancy} if nonassociated else {}
    given = {} if tolerance is None else {"tolerance": tolerance}
    return {"workers": workers, **given, **analysis}


def _refuse(model: Path, csv: Path | None, output: Path | None, force: bool) -> None:
    refuse_existing(csv, force, model, option="--csv")
    refuse_existing(output, force, model)


def _tell(study: Study, as_json: bool, csv: Path | None, output: Path | None, force: bool) -> None:
    """Write and print the rows; no row with an answer is an error."""
    from limitblocks.io import write_result
    from limitblocks.io.result_file import result_text
    from limitblocks.reports.terminal import print_table, print_warnings
    from limitblocks.studies.pool import INTERRUPTED

    if csv:
        study.write_csv(csv, overwrite=force)
    if output:
        write_result(study, output, overwrite=force)
    if as_json:
        typer.echo(result_text(study))
    else:
        rows = study.rows()
        errors = [row.pop("error") for row in rows]
        words = [study.head(key).replace("_", " ") for key in rows[0]]
        heads = tuple(word[0].upper() + word[1:] for word in words)
        print_table("", heads, [[_cell(value) for value in row.values()] for row in rows])
        print_warnings(_grouped(errors))
        typer.echo(f"\n{study}")
    if INTERRUPTED in study.errors:
        raise typer.Exit(EXIT_INTERRUPTED)
    if all(study.errors) and not (study.load_factors == float("inf")).any():
        raise SolveError(f"no analysis gave a load factor: {study.errors[0]}")


def _grouped(errors: list[str]) -> Iterator[str]:
    """A line for the rows after one another that have the same error."""
    for error, rows in groupby(enumerate(errors, 1), key=lambda row: row[1]):
        numbers = [number for number, _ in rows]
        which = f"rows {numbers[0]} to {numbers[-1]}" if len(numbers) > 1 else f"row {numbers[0]}"
        if error:
            yield f"{which}: {error}"


def _cell(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)

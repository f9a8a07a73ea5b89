"""Studies on a model file: many load factors by one command."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import isnan
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from limitblocks.cli.answers import keeping, questioned
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


class Asked(NamedTuple):
    """How the analyses of a study are made, and what becomes of its rows."""

    nonassociated: Nonassociated = False
    dilatancy: Dilatancy = 0.0
    tolerance: OwnTolerance = None
    workers: Workers = None
    as_json: AsJson = False
    csv: CsvFile = None
    output: ResultFile = None
    force: Force = False


ASKED = Asked()


@studies.command()
@keeping
def directions(model: ModelFile, count: Count = 16, vertical: Vertical = False, asked: Asked = ASKED) -> None:
    """Print the load factor for each direction of a mass-proportional live load."""
    with clean_errors():
        from limitblocks.mechanics.loads import compass
        from limitblocks.studies import directions as study

        _answer(study, model, asked, compass(count, vertical=vertical))


@studies.command(cls=Command)
@keeping
def moving(
    model: ModelFile, load: MovingForce, start: Start, end: End, count: Count = 21, asked: Asked = ASKED
) -> None:
    """Print the load factor of a force on top of the structure at places along a line, and the least."""
    with clean_errors():
        import numpy as np

        from limitblocks.studies import moving_load as study

        if load[2] > 0.0:
            typer.echo(f"warning: the load acts upwards, {load[2]:g} N along Z: -{load[2]:g} N?", err=True)
        _answer(study, model, asked, load, np.linspace(start, end, count))


def _answer(study: Callable[..., Study], model: Path, asked: Asked, *what: Any) -> None:
    """Make a study of the model in a file, write and print its rows; no row with an answer is an error."""
    from limitblocks.studies.pool import INTERRUPTED

    if asked.dilatancy and not asked.nonassociated:
        raise LimitBlocksError("--dilatancy needs --nonassociated")
    refuse_existing(asked.csv, asked.force, model, option="--csv")
    refuse_existing(asked.output, asked.force, model, asked.csv)
    settings: Any = {} if asked.tolerance is None else {"tolerance": asked.tolerance}
    settings |= {"analysis": "nonassociated", "dilatancy": asked.dilatancy} if asked.nonassociated else {}
    with of_a_count("study") as show:
        answer = study(questioned(model), *what, progress=show, workers=asked.workers, **settings)
    try:
        _write(answer, asked)
    finally:  # a full disk does not cost the rows
        _tell(answer, asked)
    if INTERRUPTED in answer.errors:
        raise typer.Exit(EXIT_INTERRUPTED)
    if all(answer.errors) and not (answer.load_factors == float("inf")).any():
        raise SolveError(f"no analysis gave a load factor: {answer.errors[0]}")


def _write(study: Study, asked: Asked) -> None:
    """Write the files that are asked for."""
    from limitblocks.io import write_result

    if asked.csv:
        study.write_csv(asked.csv, overwrite=asked.force)
    if asked.output:
        write_result(study, asked.output, overwrite=asked.force)


def _tell(study: Study, asked: Asked) -> None:
    """Print the rows."""
    from limitblocks.io.result_file import result_text
    from limitblocks.reports.terminal import print_table, print_warnings
    from limitblocks.studies.rows import row_in_short

    if asked.as_json:
        typer.echo(result_text(study))
    else:
        rows = study.rows()
        said = [[row.pop(word) for row in rows] for word in ("error", "remarks")]
        if all(isnan(row.get("frictionless", 0.0)) for row in rows):  # not claimed
            rows = [{key: value for key, value in row.items() if key != "frictionless"} for row in rows]
        words = [study.head(key).replace("_", " ") for key in rows[0]]
        heads = tuple(word[0].upper() + word[1:] for word in words)
        print_table("", heads, [row_in_short(row) for row in rows])
        print_warnings(line for words in said for line in _grouped(words))
        typer.echo(f"\n{study}")


def _grouped(words: list[str]) -> Iterator[str]:
    """A line for the rows of which the same is said."""
    for word in dict.fromkeys(filter(None, words)):
        numbers = [number for number, said in enumerate(words, 1) if said == word]
        first, last = numbers[0], numbers[-1]
        run = len(numbers) > 1 and numbers == [*range(first, last + 1)]
        which = f"{first} to {last}" if run else ", ".join(map(str, numbers))
        yield f"{'rows' if len(numbers) > 1 else 'row'} {which}: {word}"

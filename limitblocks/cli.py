"""The command line: the verbs of the library on model files.

Exit codes: 0 done, 1 a check failed, 2 the model (or the usage) is wrong, 3 no solution found.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console
from rich.table import Table

from limitblocks.errors import CheckFailed, LimitBlocksError, ModelError, SolveError

if TYPE_CHECKING:
    from limitblocks.analysis.bounds import Bounds
    from limitblocks.model import Model


_MOST_FAULTS = 20
_SUFFIX = ".html"

app = typer.Typer(
    help="Limit analysis of structures made of rigid blocks, with evidence for every answer.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

ModelFile = Annotated[Path, typer.Argument(metavar="MODEL", help="Model file (JSON).", show_default=False)]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON and nothing else.")]
Tolerance = Annotated[float, typer.Option(help="Largest gap and residual accepted.", min=0.0)]
Force = Annotated[bool, typer.Option("--force", help="Replace the output file if it exists.")]
ResultFile = Annotated[
    Path | None,
    typer.Option("--output", "-o", metavar="RESULT", help="Also write the result as JSON."),
]
ReportFile = Annotated[
    Path | None,
    typer.Option("--output", "-o", metavar="FILE", help="HTML file [default: beside the model]."),
]
Version = Annotated[bool, typer.Option("--version", help="Print the version and leave.")]
DEFAULT_TOLERANCE = 1e-6


def main() -> None:
    """Run the command line."""
    app(prog_name="limitblocks")


@app.callback(invoke_without_command=True)
def _start(version: Version = False) -> None:
    if version:
        from limitblocks import __version__

        typer.echo(f"limitblocks {__version__}")
        raise typer.Exit


@app.command()
def bounds(
    model: ModelFile,
    as_json: AsJson = False,
    tolerance: Tolerance = DEFAULT_TOLERANCE,
    output: ResultFile = None,
    force: Force = False,
) -> None:
    """Print the static and the kinematic bound on the associated load factor."""
    with _clean_errors():
        _refuse_existing(output, force, model)
        read, result = _solved(model, tolerance)
        if output:
            _write(output, json.dumps(result.to_dict(), indent=1), force)
        if as_json:
            typer.echo(json.dumps(result.to_dict()))
        else:
            _print_bounds(read, result)


@app.command()
def info(model: ModelFile, as_json: AsJson = False) -> None:
    """Print what a model file contains."""
    with _clean_errors():
        from limitblocks.io import read
        from limitblocks.report.facts import fact_rows, facts

        known = facts(read(model))
        if as_json:
            typer.echo(json.dumps(known))
            return
        rows = (*fact_rows(known), ("SHA-256", known["digest"]))
        _print_table(known["name"] or str(model), (), rows)
        _print_warnings(known["warnings"])


@app.command()
def report(
    model: ModelFile,
    output: ReportFile = None,
    force: Force = False,
    tolerance: Tolerance = DEFAULT_TOLERANCE,
) -> None:
    """Analyse a model and write an HTML report."""
    with _clean_errors():
        from limitblocks.report import report

        file = output or model.with_suffix(_SUFFIX)
        _refuse_existing(file, force, model)
        read, result = _solved(model, tolerance)
        typer.echo(str(report(read, result).save(file, overwrite=force)))


@app.command()
def schema() -> None:
    """Print the JSON Schema of the model file."""
    from limitblocks.io import model_schema

    typer.echo(json.dumps(model_schema(), indent=1))


def _solved(file: Path, tolerance: float) -> tuple[Model, Bounds]:
    from limitblocks.analysis.bounds import bounds
    from limitblocks.io import read

    model = read(file)
    return model, bounds(model, tolerance=tolerance)


@contextmanager
def _clean_errors() -> Iterator[None]:
    """Turn errors into lines on stderr, one a fault, and an exit code."""
    try:
        yield
    except LimitBlocksError as error:
        faults = error.problems if isinstance(error, ModelError) else (str(error),)
        for fault in faults[:_MOST_FAULTS]:
            typer.echo(f"error: {' '.join(fault.split())}", err=True)
        if len(faults) > _MOST_FAULTS:
            typer.echo(f"error: and {len(faults) - _MOST_FAULTS} more faults", err=True)
        raise typer.Exit(_exit_code(error)) from None


def _exit_code(error: LimitBlocksError) -> int:
    if isinstance(error, CheckFailed):
        return 1
    return 3 if isinstance(error, SolveError) else 2


def _refuse_existing(file: Path | None, force: bool, model: Path) -> None:
    """Refuse before the analysis, not after it."""
    if file and file.resolve() == model.resolve():
        raise LimitBlocksError(f"{file} is the model; name another file with --output")
    if file and not force and file.exists():
        raise LimitBlocksError(f"{file} exists; name another file with --output or replace it with --force")


def _write(file: Path, text: str, force: bool) -> None:
    try:
        with file.open("w" if force else "x", encoding="utf-8") as stream:
            stream.write(text)
    except OSError as error:
        raise LimitBlocksError(f"cannot write {file}: {error.strerror}") from None


def _print_bounds(model: Model, result: Bounds) -> None:
    from limitblocks.report.sections import section

    said = section(model, result)
    console = Console()
    console.print(f"\n  load factor  [bold]{said.headline}[/bold]  (associated)\n", highlight=False)
    _print_table("", ("Quantity", "Value", "From"), said.values)
    checks = [
        (name, f"{value:.1e}", meaning, "pass" if passed else "fail")
        for name, value, meaning, passed in said.checks
    ]
    title = f"\nResiduals, each at most {said.tolerance:.1e}"
    _print_table(title, ("Residual", "Value", "Meaning", "Check"), checks)
    _print_warnings(said.warnings)


def _print_warnings(warnings: Iterable[str]) -> None:
    for warning in warnings:
        Console(soft_wrap=True).print(f"warning: {warning}", style="yellow", markup=False, highlight=False)


def _print_table(title: str, heads: tuple[str, ...], rows: Any) -> None:
    from rich.text import Text

    table = Table(
        title=Text(title) if title else None,
        title_justify="left",
        show_header=bool(heads),
        box=None,
        pad_edge=False,
    )
    for head in heads:
        table.add_column(head, justify="right" if head == "Value" else "left", overflow="fold")
    if not heads:
        table.add_column(no_wrap=True)
        table.add_column(overflow="fold")
    for row in rows:
        table.add_row(*(Text(cell) for cell in row))  # Text: a name in brackets is not markup
    Console().print(table)

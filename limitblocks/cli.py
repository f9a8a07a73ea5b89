"""The command line: the verbs of the library on model files.

Exit codes: 0 done, 1 a check failed, 2 the model (or the usage) is wrong, 3 no solution found.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from limitblocks.errors import (
    CheckFailed,
    LimitBlocksError,
    ModelError,
    NotConverged,
    SolveError,
    UnlimitedLoad,
)

if TYPE_CHECKING:
    from limitblocks.analysis.results import LoadPath, Nonassociated
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
Dilatancy = Annotated[float, typer.Option(help="Tangent of the dilatancy angle of sliding.", min=0.0)]
Force = Annotated[bool, typer.Option("--force", help="Replace the output file if it exists.")]
ResultFile = Annotated[
    Path | None,
    typer.Option("--output", "-o", metavar="RESULT", help="Also write the result as JSON."),
]
ReportFile = Annotated[
    Path | None,
    typer.Option("--output", "-o", metavar="FILE", help="HTML file [default: beside the model]."),
]
ClaimFile = Annotated[Path, typer.Argument(metavar="RESULT", help="Result file (JSON).", show_default=False)]
WithNonassociated = Annotated[bool, typer.Option("--nonassociated", help="Also the non-associated solution.")]
WithPath = Annotated[bool, typer.Option("--path", help="Also the load path.")]
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
        from limitblocks.analysis.bounds import bounds as solve

        _refuse_existing(output, force, model)
        _answer(model, partial(solve, tolerance=tolerance), as_json, output, force)


@app.command()
def nonassociated(
    model: ModelFile,
    dilatancy: Dilatancy = 0.0,
    tolerance: Tolerance = DEFAULT_TOLERANCE,
    as_json: AsJson = False,
    output: ResultFile = None,
    force: Force = False,
) -> None:
    """Print a load factor for joints that slide without lifting, and its proof."""
    with _clean_errors():
        _refuse_existing(output, force, model)
        _answer(model, partial(_nonassociated, dilatancy, tolerance), as_json, output, force)


@app.command()
def path(
    model: ModelFile,
    dilatancy: Dilatancy = 0.0,
    tolerance: Tolerance = DEFAULT_TOLERANCE,
    as_json: AsJson = False,
    output: ResultFile = None,
    force: Force = False,
) -> None:
    """Print the steps from the permanent loads to collapse."""
    with _clean_errors():
        _refuse_existing(output, force, model)
        _answer(model, partial(_path, dilatancy, tolerance), as_json, output, force)


@app.command()
def check(
    model: ModelFile,
    result: ClaimFile,
    tolerance: Tolerance = DEFAULT_TOLERANCE,
    as_json: AsJson = False,
) -> None:
    """Check a result file against Eqs (54)-(59) of its model; exit code 1 if a residual fails."""
    with _clean_errors():
        from limitblocks.analysis.mcp import check_mcp
        from limitblocks.io import read, read_result
        from limitblocks.io.result_file import result_text
        from limitblocks.report.terminal import print_result

        structure = read(model)
        claim = read_result(result, structure)
        found = check_mcp(structure, claim, tolerance=tolerance)
        if not claim.digest:
            typer.echo(f"warning: {result} does not say which model it belongs to", err=True)
        if as_json:
            typer.echo(result_text(found))
        else:
            print_result(structure, found)
        found.require()


@app.command()
def info(model: ModelFile, as_json: AsJson = False) -> None:
    """Print what a model file contains."""
    with _clean_errors():
        from limitblocks.io import read
        from limitblocks.report.facts import fact_rows, facts
        from limitblocks.report.terminal import print_table, print_warnings

        known = facts(read(model))
        if as_json:
            typer.echo(json.dumps(known))
            return
        rows = (*fact_rows(known), ("SHA-256", known["digest"]))
        print_table(known["name"] or str(model), (), rows)
        print_warnings(known["warnings"])


@app.command()
def report(
    model: ModelFile,
    output: ReportFile = None,
    force: Force = False,
    tolerance: Tolerance = DEFAULT_TOLERANCE,
    dilatancy: Dilatancy = 0.0,
    with_nonassociated: WithNonassociated = False,
    with_path: WithPath = False,
) -> None:
    """Analyse a model and write an HTML report."""
    with _clean_errors():
        from limitblocks.io import read
        from limitblocks.report import report

        file = output or model.with_suffix(_SUFFIX)
        _refuse_existing(file, force, model)
        structure = read(model)
        results = _bounds_if_any(structure, tolerance, needed=not (with_nonassociated or with_path))
        if with_nonassociated:
            results.append(_nonassociated(dilatancy, tolerance, structure))
        if with_path:
            results.append(_path(dilatancy, tolerance, structure))
        typer.echo(str(report(structure, *results).save(file, overwrite=force)))


@app.command()
def schema() -> None:
    """Print the JSON Schema of the model file."""
    from limitblocks.io import model_schema

    typer.echo(json.dumps(model_schema(), indent=1))


def _nonassociated(dilatancy: float, tolerance: float, model: Model) -> Nonassociated:
    from limitblocks.analysis.nonassociated import nonassociated
    from limitblocks.report.terminal import shown_progress

    with shown_progress() as show:
        return nonassociated(model, dilatancy=dilatancy, tolerance=tolerance, progress=show)


def _path(dilatancy: float, tolerance: float, model: Model) -> LoadPath:
    from limitblocks.analysis.load_path import load_path
    from limitblocks.report.terminal import shown_progress

    with shown_progress() as show:
        return load_path(model, dilatancy=dilatancy, tolerance=tolerance, progress=show)


def _bounds_if_any(model: Model, tolerance: float, needed: bool) -> list[Any]:
    """The bounds; none, with a warning, where dilating joints jam and other analyses are to come."""
    from limitblocks.analysis.bounds import bounds

    try:
        return [bounds(model, tolerance=tolerance)]
    except UnlimitedLoad as error:
        if needed:
            raise
        typer.echo(f"warning: no bounds: {error}", err=True)
        return []


def _answer(
    file: Path, solve: Callable[[Model], Any], as_json: bool, output: Path | None, force: bool
) -> None:
    """Solve the model in `file`; write and print the result, or write the best state there is."""
    from limitblocks.io import read, write_result
    from limitblocks.io.result_file import result_text
    from limitblocks.report.terminal import print_result

    model = read(file)
    try:
        result = solve(model)
    except NotConverged as error:
        if output and error.result is not None:
            write_result(error.result, output, overwrite=force)
            typer.echo(f"not converged; the best state found is in {output}", err=True)
        raise
    if output:
        write_result(result, output, overwrite=force)
    if as_json:
        typer.echo(result_text(result))
    else:
        print_result(model, result)


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

"""The command line: the verbs of the library on model files.

Exit codes: 0 done, 1 a check failed or the structure does not stand by itself, 2 the model (or the usage) is
wrong, 3 no solution found.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from limitblocks.choices import Method, Turning
from limitblocks.cli import analyses
from limitblocks.cli.errors import clean_errors, refuse_existing
from limitblocks.cli.examples import examples
from limitblocks.cli.importing import import_blocks
from limitblocks.cli.later import Later
from limitblocks.cli.options import (
    Along,
    AsJson,
    BackwardLimit,
    ClaimFile,
    Dilatancy,
    Exact,
    Force,
    Mechanisms,
    ModelFile,
    OwnTolerance,
    Paths,
    ReportFile,
    ResultFile,
    Seconds,
    Seed,
    Tolerance,
    Turns,
    Version,
    Way,
    WithNonassociated,
    WithPath,
)
from limitblocks.cli.studies import studies
from limitblocks.errors import NotConverged

if TYPE_CHECKING:
    from limitblocks.model import Model

_SUFFIX = ".html"

app = typer.Typer(
    help="Limit analysis of structures made of rigid blocks, with evidence for every answer.",
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

_new = typer.Typer(
    cls=Later.of("limitblocks.cli.new", "new"),
    help="Write the model file of a parametric structure.",
    no_args_is_help=True,
    rich_markup_mode=None,
)
for _name, _group in {"study": studies, "new": _new, "examples": examples}.items():
    app.add_typer(_group, name=_name)

DEFAULT_TOLERANCE, BOUNDS_TOLERANCE = 1e-8, 1e-6  # as in Python


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
def stability(
    model: ModelFile, as_json: AsJson = False, output: ResultFile = None, force: Force = False
) -> None:
    """Say whether the structure stands under its dead loads alone; exit code 1 unless it does by itself."""
    with clean_errors():
        answer = _answer(analyses.stability, model, as_json, output, force)
    if not answer.stands:
        raise typer.Exit(1)


@app.command()
def bounds(
    model: ModelFile,
    as_json: AsJson = False,
    tolerance: Tolerance = BOUNDS_TOLERANCE,
    output: ResultFile = None,
    force: Force = False,
) -> None:
    """Print the static and the kinematic bound on the associated load factor."""
    with clean_errors():
        _answer(analyses.bounds, model, as_json, output, force, tolerance=tolerance)


@app.command()
def nonassociated(
    model: ModelFile,
    dilatancy: Dilatancy = 0.0,
    turning: Turns = Turning.CENTROID,
    method: Way = Method.PATH,
    tolerance: Tolerance = DEFAULT_TOLERANCE,
    backward_error: BackwardLimit = None,
    as_json: AsJson = False,
    output: ResultFile = None,
    force: Force = False,
) -> None:
    """Print a load factor for joints that slide without lifting, and its proof."""
    with clean_errors():
        flow: Any = {"dilatancy": dilatancy, "turning": turning, "tolerance": tolerance}
        flow |= {"method": method, "backward_error": backward_error}
        _answer(analyses.nonassociated, model, as_json, output, force, **flow)


@app.command()
def path(
    model: ModelFile,
    dilatancy: Dilatancy = 0.0,
    turning: Turns = Turning.CENTROID,
    tolerance: Tolerance = DEFAULT_TOLERANCE,
    along: Along = False,
    as_json: AsJson = False,
    output: ResultFile = None,
    force: Force = False,
) -> None:
    """Print the steps from the permanent loads to collapse."""
    with clean_errors():
        flow: Any = {"dilatancy": dilatancy, "turning": turning, "tolerance": tolerance}
        snaps = {"snaps": "along"} if along else {}
        _answer(analyses.path, model, as_json, output, force, **flow, **snaps)


@app.command(name="range")
def load_factor_range(
    model: ModelFile,
    dilatancy: Dilatancy = 0.0,
    turning: Turns = Turning.CENTROID,
    paths: Paths = 15,
    mechanisms: Mechanisms = 100,
    seed: Seed = 0,
    time_limit: Seconds = 120.0,
    exact: Exact = False,
    as_json: AsJson = False,
    output: ResultFile = None,
    force: Force = False,
) -> None:
    """Print certified load factors of many ways, and how far they reach."""
    with clean_errors():
        settings: Any = {"dilatancy": dilatancy, "turning": turning, "paths": paths}
        settings |= {"mechanisms": mechanisms, "seed": seed, "time_limit": time_limit, "exact": exact}
        _answer(analyses.load_factor_range, model, as_json, output, force, **settings)


@app.command()
def check(
    model: ModelFile,
    result: ClaimFile,
    tolerance: Tolerance = DEFAULT_TOLERANCE,
    backward_error: BackwardLimit = None,
    as_json: AsJson = False,
) -> None:
    """Check a result file against Eqs (54)-(59) of its model."""
    with clean_errors():
        from limitblocks.evidence.check import check_mcp
        from limitblocks.io import read, read_result

        structure = read(model)
        claim = read_result(result, structure)
        checked = check_mcp(structure, claim, tolerance=tolerance, backward_error=backward_error)
        if not claim.digest:
            typer.echo(f"warning: {result} does not say which model it belongs to", err=True)
        _print(structure, checked, as_json)
        checked.require()


@app.command()
def info(model: ModelFile, as_json: AsJson = False) -> None:
    """Print what a model file contains."""
    with clean_errors():
        from limitblocks.io import read
        from limitblocks.reports.facts import fact_rows, facts
        from limitblocks.reports.terminal import print_table, print_warnings

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
    tolerance: OwnTolerance = None,
    dilatancy: Dilatancy = 0.0,
    turning: Turns = Turning.CENTROID,
    with_nonassociated: WithNonassociated = False,
    with_path: WithPath = False,
) -> None:
    """Analyse a model and write a report: HTML, JSON, Markdown or PDF, as the suffix of the file says."""
    with clean_errors():
        from limitblocks.io import read
        from limitblocks.reports import files, report

        file = output or model.with_suffix(_SUFFIX)
        refuse_existing(file, force, model)
        files.suffix(file)  # before the analysis, not after it
        structure = read(model)
        asked: Any = {} if tolerance is None else {"tolerance": tolerance}
        flow: Any = {"dilatancy": dilatancy, "turning": turning} | asked
        results = analyses.bounds_if_any(structure, asked, needed=not (with_nonassociated or with_path))
        results += [analyses.nonassociated(structure, **flow)] if with_nonassociated else []
        results += [analyses.path(structure, **flow)] if with_path else []
        typer.echo(str(report(structure, *results).save(file, overwrite=force)))


app.command("import")(import_blocks)


@app.command()
def schema() -> None:
    """Print the JSON Schema of the model file."""
    from limitblocks.io import model_schema

    typer.echo(json.dumps(model_schema(), indent=1))


def _answer(
    solve: Callable[..., Any],
    file: Path,
    as_json: bool,
    output: Path | None,
    force: bool,
    **settings: Any,
) -> Any:
    """Solve the model in `file`, write and print the result; write the best state where it stopped early."""
    from limitblocks.io import read, write_result

    refuse_existing(output, force, file)
    model = read(file)
    try:
        result = solve(model, **settings)
    except NotConverged as error:
        if output and error.result is not None:
            write_result(error.result, output, overwrite=force)
            typer.echo(f"the best state found, not a solution, is in {output}", err=True)
        raise
    if output:
        write_result(result, output, overwrite=force)
    _print(model, result, as_json)
    return result


def _print(model: Model, result: Any, as_json: bool) -> None:
    from limitblocks.io.result_file import result_text
    from limitblocks.reports.terminal import print_result

    if as_json:
        typer.echo(result_text(result))
    else:
        print_result(model, result)

"""The verbs about files: what a model contains, a report, the schema."""

from __future__ import annotations

import json
from typing import Any

import typer

from limitblocks.choices import Turning
from limitblocks.cli import analyses
from limitblocks.cli.errors import clean_errors, refuse_existing
from limitblocks.cli.options import (
    AsJson,
    Author,
    Demand,
    Dilatancy,
    Force,
    ModelFile,
    Notes,
    OwnTolerance,
    Project,
    ReportFile,
    ResultFiles,
    Title,
    Turns,
    WithBounds,
    WithNonassociated,
    WithPath,
)

_SUFFIX = ".html"


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


def report(
    model: ModelFile,
    results: ResultFiles = [],  # noqa: B006 # typer wants a list, and nothing changes it
    output: ReportFile = None,
    force: Force = False,
    tolerance: OwnTolerance = None,
    dilatancy: Dilatancy = 0.0,
    turning: Turns = Turning.CENTROID,
    with_bounds: WithBounds = False,
    with_nonassociated: WithNonassociated = False,
    with_path: WithPath = False,
    title: Title = "",
    author: Author = "",
    project: Project = "",
    notes: Notes = "",
    demand: Demand = None,
) -> None:
    """Write a report of saved results, or of analyses: HTML, JSON, Markdown or PDF, as the suffix says.

    Without RESULT the bounds are found; with it nothing is but what is asked for.
    """
    with clean_errors():
        from limitblocks.io import read, read_result
        from limitblocks.reports import files
        from limitblocks.reports import report as reported

        file = output or model.with_suffix(_SUFFIX)
        refuse_existing(file, force, model, *results)
        files.suffix(file)  # before the analysis, not after it
        structure = read(model)
        found: list[Any] = [read_result(result, structure) for result in results]
        labels: Any = {"title": title, "author": author, "project": project, "notes": notes}
        labels |= {"demand": demand}
        reported(structure, *found, **labels)  # refuses what it cannot show before the analysis, too
        asked: Any = {} if tolerance is None else {"tolerance": tolerance}
        flow: Any = {"dilatancy": dilatancy, "turning": turning} | asked
        if with_bounds or not results:
            found += analyses.bounds_if_any(structure, asked, needed=not (with_nonassociated or with_path))
        found += [analyses.nonassociated(structure, **flow)] if with_nonassociated else []
        found += [analyses.path(structure, **flow)] if with_path else []
        typer.echo(str(reported(structure, *found, **labels).save(file, overwrite=force)))


def schema() -> None:
    """Print the JSON Schema of the model file."""
    from limitblocks.io import model_schema

    typer.echo(json.dumps(model_schema(), indent=1))

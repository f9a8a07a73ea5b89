"""The verbs about files: what a model contains, a report, the schema."""

from __future__ import annotations

import json
import logging
from logging.handlers import BufferingHandler
from typing import Any

import typer

from limitblocks.choices import Turning
from limitblocks.cli import analyses
from limitblocks.cli.errors import INTERRUPTED, clean_errors, interrupts, refuse_existing, with_notes
from limitblocks.cli.options import (
    AsJson,
    Author,
    ClaimFile,
    Demand,
    Dilatancy,
    ExportFile,
    Force,
    ModelFile,
    Notes,
    OwnTolerance,
    Project,
    ReportFile,
    ResultFiles,
    Scale,
    Title,
    Turns,
    WithBounds,
    WithNonassociated,
    WithPath,
    WithStability,
)
from limitblocks.errors import LimitBlocksError

PARAVIEW = (".vtu", ".pvd")  # the second of load paths
MOST = 10**6  # lines kept


def info(model: ModelFile, as_json: AsJson = False) -> None:
    """Print what a model file contains."""
    with clean_errors():
        from limitblocks.io import read
        from limitblocks.reports.facts import fact_rows, facts
        from limitblocks.reports.terminal import print_table, print_warnings

        heard, log = BufferingHandler(MOST), logging.getLogger("limitblocks")
        log.addHandler(heard)  # what reading it says is among the facts, too: said once
        try:
            known = facts(read(model))
        finally:
            log.removeHandler(heard)
        said = [record.getMessage() for record in heard.buffer]
        known["warnings"] = list(dict.fromkeys([*said, *known["warnings"]]))
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
    with_stability: WithStability = False,
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

    Without RESULT the bounds are found; with it nothing is but what is asked for. An analysis without an
    answer is named in the report of the others, and the exit code is 3; 130 after Ctrl-C.
    """
    with clean_errors():
        from limitblocks.io import read, read_result
        from limitblocks.reports import files
        from limitblocks.reports import report as reported

        file = output or model.with_suffix(".html")
        refuse_existing(file, force, model, *results)
        files.suffix(file)  # before the analysis, not after it
        structure = read(model)
        found: list[Any] = [read_result(result, structure) for result in results]
        labels: Any = {"title": title, "author": author, "project": project, "notes": notes}
        labels |= {"demand": demand}
        reported(structure, *found, **labels)  # refuses what it cannot show before the analysis, too
        asked: Any = {} if tolerance is None else {"tolerance": tolerance}
        flow: Any = {"dilatancy": dilatancy, "turning": turning} | asked
        needed = not (with_nonassociated or with_path)
        wanted = {
            "stability": (with_stability, analyses.stability, asked),
            "bounds": (with_bounds or not results, analyses.bounds_if_any, {"needed": needed} | asked),
            "non-associated load factor": (with_nonassociated, analyses.nonassociated, flow),
            "load path": (with_path, analyses.path, flow),
        }
        asked_for = {word: (solve, settings) for word, (yes, solve, settings) in wanted.items() if yes}
        with interrupts() as stopped:
            more, failed = analyses.each(structure, asked_for)
        if found or more or not failed:
            said = [f"No {word}: {with_notes(error)}" for word, error in failed.items()]
            made = reported(structure, *found, *more, **labels, failed=said)
            try:
                typer.echo(str(made.save(file, overwrite=force)))
            except LimitBlocksError:  # a full disk does not cost the answers
                typer.echo(made.text)
                raise
        for error in failed.values():
            if not stopped:
                raise error
            typer.echo(f"error: {error}", err=True)
        if stopped:
            raise typer.Exit(INTERRUPTED)


def export(
    model: ModelFile, result: ClaimFile, file: ExportFile, scale: Scale = None, force: Force = False
) -> None:
    """Write forces and displaced blocks for Rhino (3dm), COMPAS (JSON), glTF (GLB) or ParaView (VTU, PVD)."""
    with clean_errors():
        from limitblocks.io import read, read_result, write_forces, write_vtu

        refuse_existing(file, force, model, result, option="FILE")
        structure = read(model)
        claim = read_result(result, structure)
        if file.suffix.lower() not in PARAVIEW:
            typer.echo(str(write_forces(structure, file, claim, scale=scale, overwrite=force)))
            return
        if scale is not None:
            raise LimitBlocksError(
                "--scale is of arrows; ParaView draws its own from the vectors in a VTU file"
            )
        typer.echo(" ".join(map(str, write_vtu(structure, file, claim, overwrite=force))))


def schema() -> None:
    """Print the JSON Schema of the model file."""
    from limitblocks.io import model_schema

    typer.echo(json.dumps(model_schema(), indent=1))

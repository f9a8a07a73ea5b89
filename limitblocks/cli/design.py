"""The command that analyses a model with partial factors."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from limitblocks.cli.errors import clean_errors, refuse_existing
from limitblocks.cli.options import AsJson, Force, ModelFile, ResultFile
from limitblocks.cli.practice import tell

Dead = Annotated[float, typer.Option("--gamma-g", help="Multiplies the dead loads.", show_default=False)]
Live = Annotated[float, typer.Option("--gamma-q", help="Multiplies the live loads.", show_default=False)]
Strength = Annotated[
    float, typer.Option("--gamma-m", help="Divides strengths and cohesion of the joints.", show_default=False)
]
Friction = Annotated[
    float | None, typer.Option("--gamma-phi", help="Divides the friction coefficient [default: gamma-m].")
]
Ties = Annotated[
    float | None, typer.Option("--gamma-s", help="Divides the strength of ties and dowels, if there are any.")
]
Associated = Annotated[bool, typer.Option("--associated", help="Bounds alone, not the answer without lift.")]
Filed = Annotated[
    Path | None,
    typer.Option("--report", help="Write a report with this chapter: .pdf, .html, .md or .json."),
]


def adequacy(
    model: ModelFile,
    dead: Dead,
    live: Live,
    strength: Strength,
    friction: Friction = None,
    ties: Ties = None,
    associated: Associated = False,
    filed: Filed = None,
    as_json: AsJson = False,
    output: ResultFile = None,
    force: Force = False,
) -> None:
    """Print the load factor with partial factors on loads and strengths; exit code 1 below one."""
    with clean_errors():
        from limitblocks.io import read
        from limitblocks.practice import PartialFactors
        from limitblocks.practice import adequacy as find
        from limitblocks.reports import files, report

        refuse_existing(output, force, model)
        if filed:
            files.suffix(filed)  # before the analysis, not after it
            refuse_existing(filed, force, model)
        structure = read(model)
        factors = PartialFactors(dead, live, strength, friction, ties)
        found = find(structure, factors, without_dilatancy=not associated)
        rows = [
            (
                f"{one.symbol}, {one.where}",
                one.design,
                f"{one.unit} from {one.characteristic:.6g}, {one.factor}",
            )
            for one in found.values
        ]
        rows += [
            ("characteristic load factor", found.characteristic.lower, "associated"),
            ("adequacy factor", found.factor, "associated" if associated else "without dilatancy"),
        ]
        if filed:
            report(structure, found).save(filed, overwrite=force)
        tell(found, "Design values", rows, as_json, output, force)
    if not found.satisfied:
        raise typer.Exit(1)

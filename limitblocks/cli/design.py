"""The command that analyses a model with partial factors."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from limitblocks.cli import analyses
from limitblocks.cli.answers import NOTHING, Kept, answer, keeping
from limitblocks.cli.errors import clean_errors
from limitblocks.cli.options import ModelFile

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


@keeping
def adequacy(
    model: ModelFile,
    dead: Dead,
    live: Live,
    strength: Strength,
    friction: Friction = None,
    ties: Ties = None,
    associated: Associated = False,
    kept: Kept = NOTHING,
) -> None:
    """Print the load factor with partial factors on loads and strengths; exit code 1 below one."""
    with clean_errors():
        from limitblocks.practice import PartialFactors

        settings: Any = {"factors": PartialFactors(dead, live, strength, friction, ties)}
        settings |= {"without_dilatancy": not associated}
        found = answer(analyses.adequacy, model, kept, **settings)
    if not found.satisfied:
        raise typer.Exit(1)

"""Commands of bridges: a vehicle that moves along the deck, fill that resists."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from limitblocks.cli import analyses
from limitblocks.cli.answers import NOTHING, Kept, answer, keeping
from limitblocks.cli.errors import clean_errors, refuse_existing
from limitblocks.cli.options import Force, ModelFile, NewModel
from limitblocks.cli.vectors import numbers, vector

if TYPE_CHECKING:
    from limitblocks.model import Model
    from limitblocks.practice import WorstPosition

Axles = Annotated[str, typer.Option(help="Axle loads, N, such as 60e3,100e3.", show_default=False)]
Distances = Annotated[str, typer.Option(help="Of the axles from the first, m, such as 0,1.2.")]
Level = Annotated[float, typer.Option(help="Of the road, Z in m.", show_default=False)]
Contact = Annotated[float, typer.Option(help="Length of the contact of a wheel along the deck, m.")]
Spread = Annotated[float, typer.Option(help="Of the dispersion along the deck, horizontal over vertical.")]
Across = Annotated[
    float | None,
    typer.Option("--y", help="Of the line of the vehicle, Y in m [default: the middle of the blocks]."),
]
First = Annotated[
    float | None,
    typer.Option("--first", help="First place of the first axle, X in m [default: off the end]."),
]
Last = Annotated[
    float | None, typer.Option("--last", help="Last place of the first axle, X in m [default: off the end].")
]
Places = Annotated[int, typer.Option("--count", help="Places to begin with.", min=3)]
Surface = Annotated[
    float, typer.Option("--level", help="Of the surface of the fill, Z in m.", show_default=False)
]
Weight = Annotated[float, typer.Option("--unit-weight", help="Of the fill, N/m3.", show_default=False)]
Coefficient = Annotated[
    float, typer.Option("--passive", help="Coefficient of passive earth pressure K_p.", show_default=False)
]
Resisting = Annotated[
    list[str] | None,
    typer.Option("--block", help="A block that the fill holds; again for more [default: all]."),
]
WithVehicle = Annotated[
    Path | None,
    typer.Option(
        "--model", metavar="MODEL", help="Also write the model with the vehicle at its worst, for `adequacy`."
    ),
]
Beyond = Annotated[
    Any, vector("--beyond", names="X,Y", help="Place in plan, m, where the fill ends sideways.")
]
Towards = Annotated[
    Any, vector("--towards", names="X,Y", help="Horizontal direction from there to the fill.")
]
Weighs = Annotated[bool, typer.Option("--weight", help="Add the weight of the fill to the dead loads, too.")]


@keeping
def vehicle(
    model: ModelFile,
    axles: Axles,
    level: Level,
    distances: Distances = "0",
    contact: Contact = 0.3,
    spread: Spread = 0.5,
    y: Across = None,
    first: First = None,
    last: Last = None,
    count: Places = 25,
    loaded: WithVehicle = None,
    kept: Kept = NOTHING,
) -> None:
    """Print the least load factor of a vehicle that moves along the deck, and where it stands."""

    def solve(structure: Model, **settings: Any) -> WorstPosition:
        for question in (*of_axles(loads.axles, loads.distances), *of_level(structure, level, "road")):
            typer.echo(f"warning: {question}", err=True)
        found: WorstPosition = analyses.vehicle(structure, **settings)
        if loaded:
            found.model.save(loaded, overwrite=kept.force)
        return found

    with clean_errors():
        from limitblocks.analysis.magnitudes_of_bridges import of_axles, of_level
        from limitblocks.practice import Deck, Vehicle

        refuse_existing(loaded, kept.force, model, kept.output, kept.filed, option="--model")
        if (first is None) != (last is None):
            raise typer.BadParameter("give both or neither", param_hint="--first, --last")
        loads = Vehicle(numbers("--axles", axles), numbers("--distances", distances), contact)
        between = None if first is None or last is None else (first, last)
        settings: Any = {"deck": Deck(level, spread, y), "between": between, "positions": count}
        answer(solve, model, kept, vehicle=loads, **settings)


def backfill(
    model: ModelFile,
    level: Surface,
    unit_weight: Weight,
    passive: Coefficient,
    output: NewModel,
    block: Resisting = None,
    beyond: Beyond = None,
    towards: Towards = None,
    weight: Weighs = False,
    force: Force = False,
) -> None:
    """Write the model with fill that resists blocks which move into it."""
    with clean_errors():
        from dataclasses import replace

        from limitblocks.analysis.magnitudes import of_fill
        from limitblocks.analysis.magnitudes_of_bridges import of_level, of_passive
        from limitblocks.analysis.magnitudes_of_fills import of_resisting
        from limitblocks.io import read
        from limitblocks.joints import Backfill
        from limitblocks.loads import fill
        from limitblocks.mechanics.loads.fills import Fill
        from limitblocks.practice import passive_fill, reinforced
        from limitblocks.shown import many

        refuse_existing(output, force, model)
        structure = read(model)
        asked = *of_fill(unit_weight), *of_passive(passive), *of_level(structure, level, "fill that resists")
        if any(isinstance(one.joint, Backfill) for one in structure.interfaces):
            asked = *asked, "the model has fill that resists already; this adds to it"
        for question in asked:
            typer.echo(f"warning: {question}", err=True)
        side: Any = {"beyond": beyond, "towards": None if towards is None else (*towards, 0.0)}
        given: Any = {"coefficient": passive, "blocks": tuple(block or ())} | side
        held = passive_fill(structure, level, unit_weight=unit_weight, **given)
        made = reinforced(structure, *held)
        for question in of_resisting(made):
            typer.echo(f"warning: {question}", err=True)
        if weight:
            if any(isinstance(term, Fill) for _, term in structure.dead.terms):
                typer.echo("warning: the model has the weight of fill already; --weight adds to it", err=True)
            made = replace(made, dead=made.dead + fill(unit_weight, level, **side))
        blocks = many(len({one.interface.block_i for one in held}), "block")
        faces = many(len(held), "face")
        typer.echo(f"{made.save(output, overwrite=force)}: {made}, fill holds {blocks} on {faces}")

"""Commands that add to a model: a tie, a strip, a dowel, water in its joints."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from limitblocks.cli.answers import ask
from limitblocks.cli.errors import clean_errors, refuse_existing
from limitblocks.cli.options import Force, ModelFile, NewModel
from limitblocks.cli.vectors import places, vector

if TYPE_CHECKING:
    from limitblocks.model import Model
    from limitblocks.practice import Element

Anchors = Annotated[
    list[Any],
    places("--anchor", help="A block and the point that holds an end, m; twice.", show_default=False),
]
Area = Annotated[float, typer.Option("--area", help="Cross-section of one tie, m2.", show_default=False)]
Yield = Annotated[
    float, typer.Option("--strength", help="Yield strength of the material, Pa.", show_default=False)
]
PullOut = Annotated[
    float, typer.Option("--pull-out", help="Largest force that the anchors hold, N, all ties together.")
]
Prestress = Annotated[
    float, typer.Option("--prestress", help="Tension from the beginning, N, a dead load; all ties together.")
]
NumberOf = Annotated[int, typer.Option("--number-of", help="Ties side by side.")]
At = Annotated[Any, vector("--point", names="X,Y,Z", help="Its place on the joint, m.", show_default=False)]
Across = Annotated[
    str,
    typer.Option(
        "--interface", help="The joint, such as 'ground|wall' or 'wall|ground' [default: that at the point]."
    ),
]
Width = Annotated[float, typer.Option("--width", help="Of the strip, m.", show_default=False)]
Holds = Annotated[
    float, typer.Option("--capacity", help="Force at which it breaks or debonds, N.", show_default=False)
]
Diameter = Annotated[float, typer.Option("--diameter", help="Of the dowel, m.", show_default=False)]
Shears = Annotated[
    float,
    typer.Option("--capacity", help="Shear force at which it yields or tears out, N.", show_default=False),
]
Level = Annotated[float, typer.Option("--level", help="Of the water, Z in m.", show_default=False)]
Wet = Annotated[
    list[str] | None,
    typer.Option(
        "--interface",
        help="A joint with water, such as 'ground|wall' or 'wall|ground'; again for more [default: all below "
        "the level].",
    ),
]
WaterWeight = Annotated[float, typer.Option("--unit-weight", help="Of the water, N/m3.")]
Share = Annotated[
    float, typer.Option("--share", help="Of the full pressure, 0 to 1, such as behind a drain.")
]


def tie(
    model: ModelFile,
    anchor: Anchors,
    area: Area,
    strength: Yield,
    output: NewModel,
    pull_out: PullOut = float("inf"),
    prestress: Prestress = 0.0,
    number_of: NumberOf = 1,
    force: Force = False,
) -> None:
    """Write the model with a tie between two blocks, such as a wall and the ground.

    An anchor lies in or on its block; that of a support may lie anywhere.
    """

    def make(_structure: Model) -> Element:
        from limitblocks.practice import tie

        (block_i, at_i), (block_j, at_j) = anchor
        settings: Any = {"area": area, "strength": strength, "pull_out": pull_out}
        settings |= {"prestress": prestress, "number_of": number_of}
        return tie(block_i, at_i, block_j, at_j, **settings)

    if len(anchor) != 2:
        raise typer.BadParameter(f"{len(anchor)} given, expected 2", param_hint="--anchor")
    _reinforce(model, make, output, force)


def strip(
    model: ModelFile,
    point: At,
    width: Width,
    capacity: Holds,
    output: NewModel,
    interface: Across = "",
    force: Force = False,
) -> None:
    """Write the model with a bonded strip across a joint, along its normal."""
    from limitblocks.practice import strip

    _reinforce(model, _across(strip, point, interface, width=width, capacity=capacity), output, force)


def dowel(
    model: ModelFile,
    point: At,
    diameter: Diameter,
    capacity: Shears,
    output: NewModel,
    interface: Across = "",
    force: Force = False,
) -> None:
    """Write the model with a dowel or stitch across a joint, which carries shear."""
    from limitblocks.practice import dowel

    _reinforce(model, _across(dowel, point, interface, diameter=diameter, capacity=capacity), output, force)


def uplift(
    model: ModelFile,
    level: Level,
    output: NewModel,
    interface: Wet = None,
    unit_weight: WaterWeight = 9810.0,
    share: Share = 1.0,
    force: Force = False,
) -> None:
    """Write the model with the pressure of water in its joints, a dead load that pushes blocks apart."""
    with clean_errors():
        from dataclasses import replace

        from limitblocks.analysis.magnitudes import of_fill
        from limitblocks.io import read
        from limitblocks.mechanics.loads import JointPressure
        from limitblocks.practice import uplift
        from limitblocks.practice.partial_factors import DesignModel
        from limitblocks.practice.places import joints_named
        from limitblocks.shown import many

        refuse_existing(output, force, model)
        structure = read(model)
        asked = of_fill(unit_weight)
        if any(isinstance(term, JointPressure) for _, term in structure.dead.terms):
            asked.append("the model has water in joints already; this adds to it")
        if isinstance(structure, DesignModel):
            asked.append("the model has design values; this water has no gamma_G: add it before them")
        wet = joints_named(structure, interface) if interface else None
        water = uplift(structure, level, interfaces=wet, unit_weight=unit_weight, share=share)
        made = replace(structure, dead=structure.dead + water)
        ask(made, *asked)
        joints = many(len(water.terms), "joint")
        typer.echo(f"{made.save(output, overwrite=force)}: {made}, with water in {joints}")


def _across(
    element: Callable[..., Element], point: Any, interface: str, **settings: float
) -> Callable[[Model], Element]:
    """Return what makes an element across the joint of a name, or at a point."""

    def make(structure: Model) -> Element:
        from limitblocks.practice.places import joint_at

        return element(joint_at(structure, point, [interface] if interface else []), point, **settings)

    return make


def _reinforce(file: Path, make: Callable[[Model], Element], output: Path, force: bool) -> None:
    """Write the model in `file` with the element that `make` returns, and ask about what is hardly meant."""
    with clean_errors():
        from limitblocks.io import read
        from limitblocks.practice import reinforced

        refuse_existing(output, force, file)
        structure = read(file)
        element = make(structure)
        made = reinforced(structure, element)
        ask(made)
        typer.echo(f"{made.save(output, overwrite=force)}: {made}, with a {element.interface.name}")

"""Commands of practice: settlement of a support, capacity curve, verification, a vehicle."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from limitblocks.cli.errors import clean_errors, refuse_existing
from limitblocks.cli.options import AsJson, Force, ModelFile, ResultFile
from limitblocks.cli.vectors import vector

if TYPE_CHECKING:
    from collections.abc import Iterable

    from limitblocks.model import Model
    from limitblocks.practice import CapacityCurve

Support = Annotated[str, typer.Option(help="Support that gives way.", show_default=False)]
Direction = Annotated[Any, vector("--direction", names="X,Y,Z", help="Of its motion.")]
ToCollapse = Annotated[
    bool, typer.Option("--until-collapse", help="Let it settle until the structure falls.")
]
Farthest = Annotated[float, typer.Option(help="Settlement at which the curve ends, m.", min=0.0)]
Steps = Annotated[int, typer.Option(help="Points to the zero that the slope foretells.", min=2)]
Block = Annotated[
    str, typer.Option("--block", help="Block whose displacement is measured [default: the fastest].")
]
Point = Annotated[Any, vector("--point", names="X,Y,Z", help="Its point, m.")]
Largest = Annotated[float, typer.Option(help="Displacement at which the curve ends, m.", min=0.0)]
Ground = Annotated[
    float, typer.Option("--a-g", help="Ground acceleration on rock over g, SLV.", show_default=False)
]
Soil = Annotated[float, typer.Option("--soil", help="S, soil and topography.", show_default=False)]
Amplification = Annotated[float, typer.Option("--f0", help="F0, at least 2.2.", show_default=False)]
Corner = Annotated[float, typer.Option("--t-c", help="T_C of the spectrum, s.", show_default=False)]
Behaviour = Annotated[
    float, typer.Option("--q", help="Behaviour factor of the linear check.", show_default=False)
]
Confidence = Annotated[float, typer.Option("--confidence", help="Confidence factor FC.")]
Linear = Annotated[bool, typer.Option("--linear", help="The linear check alone, without a capacity curve.")]
Filed = Annotated[
    Path | None,
    typer.Option("--report", help="Write a report with this chapter: .pdf, .html, .md or .json."),
]
Axles = Annotated[str, typer.Option(help="Axle loads, N, such as 60e3,100e3.", show_default=False)]
Distances = Annotated[str, typer.Option(help="Of the axles from the first, m, such as 0,1.2.")]
Level = Annotated[float, typer.Option(help="Of the road, Z in m.", show_default=False)]
Spread = Annotated[float, typer.Option(help="Of the dispersion along the deck, horizontal over vertical.")]
First = Annotated[
    float, typer.Option("--first", help="First place of the first axle, X in m.", show_default=False)
]
Last = Annotated[
    float, typer.Option("--last", help="Last place of the first axle, X in m.", show_default=False)
]
Places = Annotated[int, typer.Option("--count", help="Places to begin with.", min=3)]


def settle(
    model: ModelFile,
    support: Support,
    direction: Direction = (0.0, 0.0, -1.0),
    until_collapse: ToCollapse = False,
    largest: Farthest = float("inf"),
    as_json: AsJson = False,
    output: ResultFile = None,
    force: Force = False,
) -> None:
    """Print the least reaction of a support that gives way, and how far the structure follows it."""
    with clean_errors():
        from limitblocks.io import read
        from limitblocks.practice import settlement

        refuse_existing(output, force, model)
        if until_collapse:
            _settle_to_collapse(read(model), (support, direction, largest), as_json, output, force)
            return
        found = settlement(read(model), support, direction)
        rows = [
            ("associated, mechanism", found.lower, "N"),
            ("associated, stress state", found.upper, "N"),
            ("without dilatancy", found.nonassociated, "N"),
        ]
        tell(found, "Least reaction", rows, as_json, output, force)


def _settle_to_collapse(
    model: Model,
    asked: tuple[str, Any, float],
    as_json: bool,
    output: Path | None,
    force: bool,
) -> None:
    from limitblocks.practice import settlement_to_collapse

    support, direction, largest = asked
    curve = settlement_to_collapse(model, support, direction, largest=largest, progress=_settled)
    rows = [
        (f"{one.displacement:.9g}", one.reaction, "; ".join((*one.changes, *one.across)))
        for one in curve.points
    ]
    tell(curve, "", rows, as_json, output, force, heads=("Settlement, m", "Reaction, N", ""))


def _settled(point: Any) -> None:
    typer.echo(f"{point.displacement:.6g} m: reaction {point.reaction:.6g} N", err=True)


def capacity(
    model: ModelFile,
    steps: Steps = 20,
    block: Block = "",
    point: Point = (0.0, 0.0, 0.0),
    largest: Largest = float("inf"),
    as_json: AsJson = False,
    output: ResultFile = None,
    force: Force = False,
) -> None:
    """Print the load factor against the displacement of the mechanism, until it is zero."""
    with clean_errors():
        from limitblocks.io import read
        from limitblocks.practice import capacity_curve

        refuse_existing(output, force, model)
        control = (block, point) if block else None
        curve = capacity_curve(read(model), control=control, steps=steps, largest=largest, progress=_line)
        tell(
            curve,
            "",
            _curve_rows(curve),
            as_json,
            output,
            force,
            heads=("Displacement, m", "Load factor", ""),
        )


def verify(
    model: ModelFile,
    ground: Ground,
    soil: Soil,
    amplification: Amplification,
    corner: Corner,
    behaviour: Behaviour,
    confidence: Confidence = 1.35,
    linear: Linear = False,
    filed: Filed = None,
    as_json: AsJson = False,
    output: ResultFile = None,
    force: Force = False,
) -> None:
    """Print the kinematic verification of the mechanism, Circolare 7/2019; exit code 1 if it fails."""
    with clean_errors():
        from limitblocks.analysis.nonassociated.loop import nonassociated
        from limitblocks.io import read
        from limitblocks.practice import Spectrum, capacity_curve, verification
        from limitblocks.practice.spectra import G
        from limitblocks.reports import files, report

        refuse_existing(output, force, model)
        if filed:
            files.suffix(filed)  # before the analysis, not after it
            refuse_existing(filed, force, model)
        structure = read(model)
        site = Spectrum(ground * G, soil, amplification, corner)
        curve = None if linear else capacity_curve(structure, progress=_line)
        solved = nonassociated(structure)
        found = verification(structure, solved, site, q=behaviour, confidence=confidence, curve=curve)
        rows = [(f"{one.symbol}: {one.meaning}", one.value, one.unit) for one in found.quantities]
        rows += [
            (
                f"{one.name}: {'satisfied' if one.satisfied else 'NOT satisfied'}",
                one.ratio,
                "capacity / demand",
            )
            for one in found.checks
        ]
        if filed:
            shown = (solved, found, curve) if curve else (solved, found)
            report(structure, *shown).save(filed, overwrite=force)
        tell(found, "Circolare 7/2019, C8.7.1.2", rows, as_json, output, force)
    if not all(one.satisfied for one in found.checks):
        raise typer.Exit(1)


def vehicle(
    model: ModelFile,
    axles: Axles,
    level: Level,
    first: First,
    last: Last,
    distances: Distances = "0",
    spread: Spread = 0.5,
    count: Places = 25,
    as_json: AsJson = False,
    output: ResultFile = None,
    force: Force = False,
) -> None:
    """Print the least load factor of a vehicle that moves along the deck, and where it stands."""
    with clean_errors():
        from limitblocks.io import read
        from limitblocks.practice import Deck, Vehicle, worst_position

        refuse_existing(output, force, model)
        loads = Vehicle(_numbers("--axles", axles), _numbers("--distances", distances))
        found = worst_position(read(model), loads, Deck(level, spread), (first, last), positions=count)
        rows = [
            (f"x = {x:.6g} m", factor, "worst" if x == found.position else "")
            for x, factor in sorted(zip(found.positions.tolist(), found.load_factors.tolist(), strict=True))
        ]
        tell(found, "", rows, as_json, output, force, heads=("First axle at", "Load factor", ""))


def _curve_rows(curve: CapacityCurve) -> list[tuple[Any, ...]]:
    return [
        (f"{one.displacement:.6g}", one.load_factor, "; ".join((*one.changes, *one.across)))
        for one in curve.points
    ]


def _numbers(option: str, words: str) -> tuple[float, ...]:
    try:
        return tuple(float(word) for word in words.replace(",", " ").split())
    except ValueError:
        raise typer.BadParameter(f"{words!r}: expected numbers such as 0,1.2", param_hint=option) from None


def _line(point: Any) -> None:
    typer.echo(f"{point.displacement:.6g} m: load factor {point.load_factor:.6g}", err=True)


def tell(
    found: Any,
    title: str,
    rows: Iterable[tuple[Any, ...]],
    as_json: bool,
    output: Path | None,
    force: bool,
    heads: tuple[str, ...] = ("", "", ""),
) -> None:
    """Write and print the answer."""
    from limitblocks.reports.terminal import print_table
    from limitblocks.written import write

    text = json.dumps(found.to_dict(), indent=1)
    if output:
        write(output, text + "\n", force)
    if as_json:
        typer.echo(text)
        return
    cells = [[name, "" if value is None else f"{value:.6g}", note] for name, value, note in rows]
    print_table(title, heads, cells)
    typer.echo(f"\n{found}")

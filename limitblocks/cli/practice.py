"""Commands of practice: settlement of a support, capacity curve, verification, partial factors."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from limitblocks.cli import analyses
from limitblocks.cli.answers import NOTHING, Kept, answer, keeping
from limitblocks.cli.errors import clean_errors, refuse_existing
from limitblocks.cli.options import Animation, ModelFile
from limitblocks.cli.vectors import numbers, vector

if TYPE_CHECKING:
    from limitblocks.model import Model
    from limitblocks.practice import Floor, Spectrum, Verification

Support = Annotated[
    list[str],
    typer.Option(
        help="Support that gives way; repeat it for several that do as one body.", show_default=False
    ),
]
Direction = Annotated[Any, vector("--direction", names="X,Y,Z", help="Of the motion.")]
ToCollapse = Annotated[
    bool, typer.Option("--until-collapse", help="Let it settle until the structure falls.")
]
Farthest = Annotated[
    float | None,
    typer.Option(help="Settlement at which the curve ends, m [default: the size of the structure].", min=0.0),
]
Longest = Annotated[
    float | None,
    typer.Option("--step", help="Largest step, m [default: .01 of the size of the structure].", min=0.0),
]
Nearness = Annotated[
    float | None,
    typer.Option(
        "--accuracy", help="Of the settlement at which it falls, m [default: 1e-6 of the size].", min=0.0
    ),
]
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
Collapse = Annotated[str, typer.Option("--slc", help="A_G/g,S,F0,T_C of SLC, such as .3,1.2,2.5,.5.")]
Damage = Annotated[str, typer.Option("--sld", help="A_G/g,S,F0,T_C of SLD: is the mechanism set off?")]
Damping = Annotated[
    str, typer.Option("--damping", help="Of the mechanism at SLV,SLC as ratios [default: .08,.10].")
]
Modes = Annotated[
    list[str] | None,
    typer.Option(
        "--mode", help="T,GAMMA,PSI,XI of a mode of the building at the height of the mechanism; repeat it."
    ),
]
ElasticPeriod = Annotated[
    float, typer.Option(help="T_0 of an element free to vibrate, such as a parapet, s; 0 if it is not.")
]
Dead = Annotated[float, typer.Option("--gamma-g", help="Multiplies the dead loads.", show_default=False)]
Live = Annotated[float, typer.Option("--gamma-q", help="Multiplies the live loads.", show_default=False)]
Strength = Annotated[
    float, typer.Option("--gamma-m", help="Divides strengths and cohesion of the joints.", show_default=False)
]
Friction = Annotated[
    float | None, typer.Option("--gamma-phi", help="Divides the friction coefficient [default: gamma-m].")
]
Ties = Annotated[
    float | None,
    typer.Option(
        "--gamma-s", help="Divides the strength of ties, dowels and passive fill, if there are any."
    ),
]
SavedCurve = Annotated[
    Path | None,
    typer.Option("--curve", help="Capacity curve that `capacity --output` wrote, in place of a new one."),
]
Associated = Annotated[bool, typer.Option("--associated", help="Bounds alone, not the answer without lift.")]


@keeping
def settle(
    model: ModelFile,
    support: Support,
    direction: Direction = (0.0, 0.0, -1.0),
    associated: Associated = False,
    until_collapse: ToCollapse = False,
    largest: Farthest = None,
    step: Longest = None,
    accuracy: Nearness = None,
    animation: Animation = None,
    kept: Kept = NOTHING,
) -> None:
    """Print the least reaction of supports that give way, and how far the structure follows it."""
    with clean_errors():
        solve = analyses.settlement_to_collapse if until_collapse else analyses.settlement
        way: Any = {"largest": largest, "step": step, "accuracy": accuracy, "animation": animation}
        way = {name: value for name, value in way.items() if value is not None}
        if way and not until_collapse:
            hint = ", ".join(f"--{name}" for name in way)
            raise typer.BadParameter("give --until-collapse, too", param_hint=hint)
        way |= {"support": support, "direction": direction, "without_dilatancy": not associated}
        answer(solve, model, kept, **way)


@keeping
def capacity(
    model: ModelFile,
    steps: Steps = 20,
    block: Block = "",
    point: Point = None,
    largest: Largest = float("inf"),
    animation: Animation = None,
    kept: Kept = NOTHING,
) -> None:
    """Print the load factor against the displacement of the mechanism, until it is zero."""
    with clean_errors():
        if bool(block) != (point is not None):
            raise typer.BadParameter("give both or neither", param_hint="--block, --point")
        settings: Any = {"control": (block, point) if block else None, "steps": steps, "largest": largest}
        settings |= {"animation": animation}
        answer(analyses.capacity, model, kept, **settings)


@keeping
def verify(
    model: ModelFile,
    ground: Ground,
    soil: Soil,
    amplification: Amplification,
    corner: Corner,
    behaviour: Behaviour,
    confidence: Confidence = 1.35,
    linear: Linear = False,
    collapse: Collapse = "",
    damage: Damage = "",
    damping: Damping = "",
    modes: Modes = None,
    elastic_period: ElasticPeriod = 0.0,
    drawn: SavedCurve = None,
    kept: Kept = NOTHING,
) -> None:
    """Print the kinematic verification of the mechanism, Circolare 7/2019; exit code 1 if it fails.

    Where the capacity curve does not end at zero the linear checks are made alone, and it fails.
    """
    beside: list[Any] = []

    def solve(structure: Model) -> Verification:
        site = Spectrum(ground * G, soil, amplification, corner)
        saved: Any = None if drawn is None else read_result(drawn, structure)
        if saved is not None:
            refuse_kind(saved, CapacityCurve, "--curve")
        demands: dict[str, Any] = {"collapse_demand": _spectrum("--slc", collapse)}
        demands |= {"damage_demand": _spectrum("--sld", damage), "floor": _floor(modes or [])}
        demands |= {"elastic_period": elastic_period}
        demands |= {"damping": _counted("--damping", damping, "SLV,SLC")} if damping else {}
        solved = analyses.nonassociated(structure)
        verified = partial(
            verification, structure, solved, site, q=behaviour, confidence=confidence, **demands
        )
        alone = verified()  # refuses what is out of range before a curve is drawn
        if not linear and saved is None:
            typer.echo(f"before the capacity curve: {alone}", err=True)
        curve = None if linear else saved or analyses.capacity(structure)
        beside.extend((solved, curve) if curve else (solved,))
        if not curve:
            return alone
        return without_curve(alone, curve.ended) if curve.zero is None else verified(curve=curve)

    with clean_errors():
        from limitblocks.errors import refuse_kind
        from limitblocks.io import read_result
        from limitblocks.practice import Spectrum, verification
        from limitblocks.practice.capacity_result import CapacityCurve
        from limitblocks.practice.spectra import G
        from limitblocks.practice.verification_result import without_curve

        for option, given in (("--curve", drawn), ("--damping", damping)):
            if given and linear:
                raise typer.BadParameter("give one of both", param_hint=f"{option}, --linear")
        refuse_existing(kept.output, kept.force, drawn)
        refuse_existing(kept.filed, kept.force, drawn, option="--report")
        found = answer(solve, model, kept, beside)
    if not all(one.satisfied for one in found.checks) or found.left_out:
        raise typer.Exit(1)


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


def _spectrum(option: str, words: str) -> Spectrum | None:
    """The spectrum of another limit state, if it is given."""
    from limitblocks.practice import Spectrum
    from limitblocks.practice.spectra import G

    if not words:
        return None
    a_g, *rest = _counted(option, words, "A_G/g,S,F0,T_C")
    return Spectrum(a_g * G, *rest)


def _floor(modes: list[str]) -> Floor | None:
    from limitblocks.practice import Floor, FloorMode

    given = [FloorMode(*_counted("--mode", words, "T,GAMMA,PSI,XI")) for words in modes]
    return Floor(tuple(given)) if given else None


def _counted(option: str, words: str, names: str) -> tuple[float, ...]:
    given = numbers(option, words)
    if len(given) != 1 + names.count(","):
        raise typer.BadParameter(f"{words!r}: expected {names}", param_hint=option)
    return given

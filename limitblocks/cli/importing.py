"""The verb `import`: a model file from blocks that another program wrote."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from limitblocks.cli.errors import clean_errors, refuse_existing
from limitblocks.cli.options import Force
from limitblocks.errors import ModelError

if TYPE_CHECKING:
    from limitblocks.geometry import Tolerances
    from limitblocks.io.imported import ImportedBlocks
    from limitblocks.joints import Joint

BlocksFile = Annotated[Path, typer.Argument(metavar="FILE", help="File of blocks.", show_default=False)]
Output = Annotated[
    Path | None, typer.Option("--output", "-o", metavar="MODEL", help="Model file [default: beside FILE].")
]
Friction = Annotated[float, typer.Option(help="Coefficient of friction of every interface.")]
JointName = Annotated[str, typer.Option("--joint", metavar="NAME", help="What an interface can carry.")]
Slip = Annotated[
    str | None,
    typer.Option(
        help="Friction of OrdunaLourenco: exact (Coulomb's circle), paper (octagon), inner or outer "
        "[default: exact]."
    ),
]
Supports = Annotated[
    list[str],
    typer.Option(
        "--supports",
        metavar="NAME",
        help="A block or layer that does not move; repeat. [default: those that FILE marks]",
        show_default=False,
    ),
]
Live = Annotated[str, typer.Option(metavar="X,Y,Z", help="Direction of the mass-proportional live load.")]
UnitWeights = Annotated[
    list[str],
    typer.Option("--unit-weight", metavar="[LAYER=]N/M3", help="Of all blocks, or of a layer; repeat."),
]
Units = Annotated[str | None, typer.Option(help="Unit of length of FILE: m, cm, mm, in or ft.")]
Thickness = Annotated[
    float | None, typer.Option(help="FILE is a DXF elevation; depth of its blocks along Y, m.")
]
Up = Annotated[str | None, typer.Option(help="Axis of FILE that points up: y or z.")]
Gap = Annotated[
    float | None,
    typer.Option(
        help="Distance that counts as touching, in block lengths [default: by the accuracy of FILE]."
    ),
]
Angle = Annotated[
    float | None,
    typer.Option(help="Angle between faces that counts as touching, rad [default: by the accuracy of FILE]."),
]
Heal = Annotated[
    bool,
    typer.Option("--heal", help="Mend the blocks within their accuracy first: limitblocks.heal."),
]
Width = Annotated[
    float | None, typer.Option(help="Least width of an interface, in block lengths [default: the gap].")
]


def import_blocks(
    file: BlocksFile,
    friction: Friction,
    live: Live,
    unit_weight: UnitWeights,
    supports: Supports = [],  # noqa: B006 # typer wants a list, and nothing changes it
    joint: JointName = "OrdunaLourenco",
    slip: Slip = None,
    units: Units = None,
    thickness: Thickness = None,
    up: Up = None,
    gap: Gap = None,
    angle: Angle = None,
    width: Width = None,
    heal: Heal = False,
    output: Output = None,
    force: Force = False,
) -> None:
    """Make a model file from blocks in OBJ, STL, PLY, glTF, DXF, 3dm, COMPAS JSON; see docs/files.md."""
    with clean_errors():
        from limitblocks.analysis.magnitudes import questions
        from limitblocks.io.blocks import read_blocks
        from limitblocks.io.formats.dxf.outlines import read_drawing
        from limitblocks.io.structure_file import model_of
        from limitblocks.mechanics import mass_proportional

        to = output or file.with_suffix(".json")
        refuse_existing(to, force, file)
        law, load = _joint(joint, friction, slip), mass_proportional(_vector(live))
        weight = _unit_weight(unit_weight)
        if thickness is None:
            imported = read_blocks(file, units=units, unit_weight=weight, up=up)
        else:
            imported = read_drawing(file, thickness=thickness, units=units, unit_weight=weight)
        used: Tolerances | None = None
        if heal:
            imported, used = _healed(imported)
        model, contacts = model_of(
            imported,
            joint=law,
            supports=supports,
            live=load,
            gap=used.gap if used and gap is None else gap,
            angle=used.angle if used and angle is None else angle,
            width=used.width if used and width is None else width,
            name=file.stem,
        )
        notes = (*imported.notes, contacts.accuracy, *contacts.nothing)
        for word, lines in (("note", notes), ("warning", contacts.warnings + questions(model))):
            for line in lines:
                typer.echo(f"{word}: {line}", err=True)
        typer.echo(f"{model.save(to, overwrite=force)}: {model}")


def _healed(imported: ImportedBlocks) -> tuple[ImportedBlocks, Tolerances]:
    """Return the blocks mended within their accuracy, and the tolerances of the blocks as they were."""
    from limitblocks.geometry import heal

    mended = heal(imported.blocks)
    notes = (*imported.notes, str(mended), *mended.notes)
    return replace(imported, blocks=mended.blocks, notes=notes), mended.tolerances


def _joint(name: str, friction: float, slip: str | None) -> Joint:
    from limitblocks.io.registry import JOINTS

    if name not in JOINTS:
        raise ModelError(f"--joint {name!r} is unknown; expected one of {', '.join(JOINTS)}")
    if slip is not None and name != "OrdunaLourenco":
        raise ModelError(f"--slip is {slip!r}, but only OrdunaLourenco has a choice; leave it out")
    joint: Joint = JOINTS[name](friction=friction, **({} if slip is None else {"slip": slip}))
    return joint


def _vector(text: str) -> tuple[float, ...]:
    try:
        return tuple(float(part) for part in text.split(","))
    except ValueError:
        raise ModelError(f"--live is {text!r}; expected three numbers as in 1,0,0") from None


def _unit_weight(texts: list[str]) -> float | Mapping[str, float]:
    """Return one unit weight, or one by layer."""
    pairs = [text.rpartition("=") for text in texts]
    try:
        weights = {layer: float(number) for layer, _, number in pairs}
    except ValueError:
        raise ModelError(f"--unit-weight is {' '.join(texts)!r}; expected numbers, or LAYER=NUMBER") from None
    by_layer = [sign for _, sign, _ in pairs]
    if not all(by_layer) and len(pairs) > 1:
        raise ModelError(f"--unit-weight is {' '.join(texts)!r}; give one number, or LAYER=NUMBER each")
    return weights if all(by_layer) else weights[""]

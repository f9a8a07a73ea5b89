"""The verb `import`: a model file from blocks that another program wrote."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from limitblocks.cli.errors import clean_errors, refuse_existing
from limitblocks.cli.joints import DEFAULT, Friction, JointName, Slip, Strength, make_joint
from limitblocks.cli.options import BlocksFile, Force, Live, Supports, Units, UnitWeights
from limitblocks.errors import ModelError

if TYPE_CHECKING:
    from limitblocks.geometry import Tolerances
    from limitblocks.io.imported import ImportedBlocks

Output = Annotated[
    Path | None, typer.Option("--output", "-o", metavar="MODEL", help="Model file [default: beside FILE].")
]
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
    joint: JointName = DEFAULT,
    slip: Slip = None,
    compressive_strength: Strength = None,
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
        law = make_joint(joint, friction, slip=slip, compressive_strength=compressive_strength)
        load = mass_proportional(live)
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

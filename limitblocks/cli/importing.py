"""The verb `import`: a model file from blocks that another program wrote."""

from __future__ import annotations

import shlex
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from limitblocks.cli.errors import clean_errors, refuse_existing
from limitblocks.cli.joints import DEFAULT, MaybeFriction, MaybeJoint, Slip, Strength, make_joint
from limitblocks.cli.options import (
    BlocksFile,
    Force,
    Layers,
    Live,
    MaterialsFile,
    Supports,
    Thickness,
    TwistedFaces,
    Units,
    UnitWeights,
    Up,
)
from limitblocks.errors import ModelError

if TYPE_CHECKING:
    from limitblocks.geometry import Tolerances
    from limitblocks.io.imported import ImportedBlocks
    from limitblocks.joints import Joint, Materials
    from limitblocks.model import Model

Output = Annotated[
    Path | None, typer.Option("--output", "-o", metavar="MODEL", help="Model file [default: beside FILE].")
]
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
    bool, typer.Option("--heal", help="Mend the blocks within their accuracy first: limitblocks.heal.")
]
SkipBad = Annotated[
    bool, typer.Option("--skip-bad", help="Leave out solids that are no blocks, and say which.")
]
Width = Annotated[
    float | None, typer.Option(help="Least width of an interface, in block lengths [default: the gap].")
]


def import_blocks(
    file: BlocksFile,
    live: Live,
    friction: MaybeFriction = None,
    unit_weight: UnitWeights = [],  # noqa: B006 # typer wants a list, and nothing changes it
    materials: MaterialsFile = None,
    supports: Supports = [],  # noqa: B006 # as above
    joint: MaybeJoint = None,
    slip: Slip = None,
    compressive_strength: Strength = None,
    units: Units = None,
    thickness: Thickness = None,
    layers: Layers = [],  # noqa: B006 # as above
    up: Up = None,
    gap: Gap = None,
    angle: Angle = None,
    width: Width = None,
    heal: Heal = False,
    twisted: TwistedFaces = None,
    skip_bad: SkipBad = False,
    output: Output = None,
    force: Force = False,
) -> None:
    """Make a model file from blocks in OBJ, STL, PLY, glTF, DXF, 3dm, COMPAS JSON; `look` at FILE first."""
    with clean_errors():
        from limitblocks.analysis.uncarried import uncarried, uncarried_words
        from limitblocks.io.blocks import read_blocks
        from limitblocks.io.formats.dxf.elevation import read_drawing, refuse_with_thickness
        from limitblocks.io.guesses import on_side
        from limitblocks.io.structure_file import model_of
        from limitblocks.mechanics.loads import mass_proportional

        to = output or file.with_suffix(".json")
        refuse_existing(to, force, file)
        strength = {"slip": slip, "compressive_strength": compressive_strength}
        law, table = _joints(joint, friction, strength, materials)
        read: Any = {"units": units, "unit_weight": _unit_weight(unit_weight, table), "skip_bad": skip_bad}
        if thickness is None:
            if layers:
                raise ModelError("--layers is of DXF elevations: give --thickness, too")
            read |= {"up": up, "twisted": twisted}
            imported = read_blocks(file, **read)
        else:
            refuse_with_thickness(up=up, twisted=twisted)
            imported = read_drawing(file, thickness=thickness, layers=layers or None, **read)
        _refuse_no_supports(file, imported, supports)
        tolerances: Any = {"gap": gap, "angle": angle, "width": width}
        if heal:
            imported, used = _healed(imported)
            tolerances = {k: getattr(used, k) if given is None else given for k, given in tolerances.items()}
        made: Any = {"joint": law, "materials": table, "supports": supports, "name": file.stem}
        model, contacts, vain = model_of(imported, live=mass_proportional(live), **made, **tolerances)
        lying = on_side(model.blocks, model.supports) if up is None and thickness is None else ()
        hung = uncarried_words(uncarried(model, model.tolerances))
        nothing = [] if hung else contacts.nothing
        notes = (*imported.notes, *_joint_words(model, table), contacts.accuracy, *nothing)
        _tell(model, notes, (*imported.guesses, *lying, *vain, *contacts.warnings, *hung))
        typer.echo(f"{model.save(to, overwrite=force)}: {model}")


def _tell(model: Model, notes: Iterable[str], warnings: Iterable[str]) -> None:
    """Print notes, warnings and what is asked about the model; those alike but for the block as one."""
    from limitblocks.analysis.magnitudes import questions
    from limitblocks.reports.words import together

    for word, lines in (("note", notes), ("warning", (*warnings, *questions(model)))):
        for line in together(lines):
            typer.echo(f"{word}: {line}", err=True)


def _healed(imported: ImportedBlocks) -> tuple[ImportedBlocks, Tolerances]:
    """Return the blocks mended within their accuracy, and the tolerances of the blocks as they were."""
    from limitblocks.geometry import heal

    mended = heal(imported.blocks)
    notes = (*imported.notes, str(mended), *mended.notes)
    return replace(imported, blocks=mended.blocks, notes=notes), mended.tolerances


def _joints(
    name: str | None, friction: float | None, strength: dict[str, Any], file: Path | None
) -> tuple[Joint | None, Materials | None]:
    """Return the joint of all interfaces, or the table of materials that has them."""
    from limitblocks.io.materials import read_materials

    if file is None:
        if friction is None:
            raise ModelError("give --friction, the same for every interface, or --materials with a table")
        return make_joint(name or DEFAULT, friction, **strength), None
    said = {"joint": name, "friction": friction} | strength
    given = [f"--{word.replace('_', '-')}" for word, value in said.items() if value is not None]
    if given:
        raise ModelError(f"{', '.join(given)} and --materials: the table has the joints; give one of both")
    return None, read_materials(file)


def _refuse_no_supports(file: Path, imported: ImportedBlocks, supports: list[str]) -> None:
    """Say what could be chosen, in words of the shell."""
    from limitblocks.geometry.selection import listed
    from limitblocks.io.supports import likely_supports

    if supports or imported.supports:
        return
    likely = [one.chosen_by for one in likely_supports(imported.blocks)[:1]]
    such = [f", perhaps {' '.join(f'--supports {shlex.quote(one)}' for one in names)}" for names in likely]
    raise ModelError(
        f"{file}: which blocks do not move? give --supports{''.join(such)}; there are "
        f"{listed(imported.blocks)}; limitblocks look {shlex.quote(str(file))} shows more"
    )


def _joint_words(model: Model, table: Materials | None) -> list[str]:
    """Return where the joints between the materials of a model come from."""
    if table is None:
        return []
    material = {block.name: block.material for block in model.blocks}
    pairs = {tuple(sorted((material[i.block_i], material[i.block_j]))) for i in model.interfaces}
    return [f"joint {table.words(*pair)}" for pair in sorted(pairs)]


def _unit_weight(texts: list[str], table: Materials | None) -> float | Mapping[str, float] | None:
    """Return one unit weight, or one by layer; None where the materials have it."""
    if not texts and table is not None:
        return None
    if not texts:
        raise ModelError("give --unit-weight in N/m3, for all blocks or LAYER=NUMBER, or --materials")
    pairs = [text.rpartition("=") for text in texts]
    try:
        weights = {layer: float(number) for layer, _, number in pairs}
    except ValueError:
        raise ModelError(f"--unit-weight is {' '.join(texts)!r}; expected numbers, or LAYER=NUMBER") from None
    by_layer = [sign for _, sign, _ in pairs]
    if not all(by_layer) and len(pairs) > 1:
        raise ModelError(f"--unit-weight is {' '.join(texts)!r}; give one number, or LAYER=NUMBER each")
    if all(by_layer) and len(weights) < len(pairs):
        twice = Counter(layer for layer, _, _ in pairs).most_common(1)[0][0]
        raise ModelError(f"--unit-weight is {' '.join(texts)!r}; layer {twice!r} has several, give it one")
    return weights if all(by_layer) else weights[""]

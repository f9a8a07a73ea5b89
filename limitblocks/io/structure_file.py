"""A model from a file of any format: the model file, or blocks with what makes them a model."""

from __future__ import annotations

import logging
from pathlib import Path
from typing import Any

from limitblocks.analysis.magnitudes import questions
from limitblocks.analysis.uncarried import uncarried, uncarried_words
from limitblocks.errors import ModelError, path_of
from limitblocks.geometry import Contacts, Selection, find_contacts, select
from limitblocks.geometry.selection import listed
from limitblocks.geometry.twisted import Twisted
from limitblocks.io import faults, model_file
from limitblocks.io.blocks import is_model_file, read_blocks
from limitblocks.io.guesses import on_side
from limitblocks.io.imported import ImportedBlocks, UnitWeight
from limitblocks.io.materials import read_materials, refuse_jointless
from limitblocks.io.open_joints import joined
from limitblocks.io.supports import likely_supports
from limitblocks.joints import Joint, Materials
from limitblocks.mechanics import Load
from limitblocks.mechanics.loads import self_weight
from limitblocks.model import Model

_log = logging.getLogger("limitblocks")

_INSTEAD = (
    "leave the arguments out; change the file (gap, angle and width stand under interfaces, find), or what "
    "was read: dataclasses.replace(model, live=...)"
)


def read(
    file: str | Path,
    *,
    joint: Joint | None = None,
    materials: Materials | str | Path | None = None,
    supports: Selection | None = None,
    unit_weight: UnitWeight = None,
    units: str | None = None,
    up: str | None = None,
    twisted: Twisted | None = None,
    skip_bad: bool = False,
    dead: Load | None = None,
    live: Load | None = None,
    gap: float | None = None,
    angle: float | None = None,
    width: float | None = None,
) -> Model:
    """Return the model in `file`: a model file (docs/model-file.md) or blocks of any format in docs/files.md.

    A model file says everything itself, and other arguments are refused with it: what
    :meth:`limitblocks.Model.save` wrote gives the same model again, bit for bit. For other formats `joint`,
    `supports` and `live` are needed; the interfaces are found by :func:`limitblocks.find_interfaces`. What
    had to be mended, and blocks that nearly touch, are logged as warnings, a line each;
    :func:`limitblocks.files.read_blocks` and :func:`limitblocks.find_contacts` return them.

    Parameters
    ----------
    file : str or Path
        The suffix of its name says the format.
    joint : Joint, optional
        What every interface can carry.
    materials : Materials, str or Path, optional
        Instead of a joint: a table of materials, or the TOML file that holds it.
    supports : str, iterable of str, or function of a Block, optional
        Blocks that do not move, as for :func:`limitblocks.files.select`: names of blocks or layers,
        "layer:BASE*", "z<0.05", or a function; left out, those that the file marks:
        `ImportedBlocks.supports`.
    unit_weight : float or mapping of str to float, optional
        N/m3, of all blocks or by layer.
    units : str, optional
        Unit of length of the file, one of "m", "cm", "mm", "in", "ft"; left out, what the file says, and
        metres where it says nothing, or with a warning mm or cm where it would be larger than 300 m.
    up : str, optional
        Axis of the file that points up, "y" or "z"; left out, what the format says (glTF: Y), else Z, or with
        a warning Y where the structure would lie on its side.
    twisted, skip_bad
        As for :func:`limitblocks.files.read_blocks`.
    dead, live : Load, optional
        Loads; `dead` is self weight if left out.
    gap, angle, width : float, optional
        Tolerances of :func:`limitblocks.find_interfaces`, in block lengths and rad; left out, chosen by the
        accuracy of the faces. `Model.tolerances` says which were used.

    Raises
    ------
    ModelError
        The file cannot be read, the model in it is wrong, or something that the format needs is missing;
        `problems` has one line per fault, each with the file and the place in it.
    MissingDependency
        The format needs a package that is not installed.
    """
    path = path_of(file)
    made: Any = {"joint": joint, "materials": materials, "supports": supports}
    as_read: Any = {"unit_weight": unit_weight, "units": units, "up": up, "twisted": twisted}
    if is_model_file(path):
        given = made | as_read | {"skip_bad": skip_bad or None}
        given |= {"dead": dead, "live": live, "gap": gap, "angle": angle, "width": width}
        if said := [key for key, value in given.items() if value is not None]:
            raise ModelError(f"{path}: a model file says {', '.join(said)} itself; {_INSTEAD}")
        return model_file.read(path)
    imported = read_blocks(path, **as_read, skip_bad=skip_bad)
    if isinstance(materials, str | Path):
        made["materials"] = read_materials(materials)
    made |= {"live": live, "dead": dead, "gap": gap, "angle": angle, "width": width, "name": path.stem}
    with faults.named(path):
        model, contacts, vain = model_of(imported, **made)
    lying = on_side(model.blocks, model.supports) if up is None else ()
    seen = (*lying, *contacts.warnings, *uncarried_words(uncarried(model, model.tolerances)))
    for line in (*imported.notes, *imported.guesses, *vain, *seen, *questions(model)):
        _log.warning("%s: %s", path, line)
    _log.info("%s: %s", path, contacts.accuracy)
    return model


def model_of(
    imported: ImportedBlocks,
    *,
    joint: Joint | None,
    supports: Selection | None,
    live: Load | None,
    materials: Materials | None = None,
    dead: Load | None = None,
    gap: float | None = None,
    angle: float | None = None,
    width: float | None = None,
    name: str = "",
) -> tuple[Model, Contacts, tuple[str, ...]]:
    """Return the model of blocks that were read, what was seen in their contacts, and warnings on materials.

    Raises
    ------
    ModelError
        An argument is missing, a support is unknown, or the model is wrong.
    """
    wanted = supports or imported.supports or None
    _refuse_missing(imported, joint, materials, wanted, live)
    blocks, vain = (imported.blocks, ()) if materials is None else materials.on(imported.blocks)
    names = select(blocks, wanted, "support")  # type: ignore[arg-type] # not missing
    law = joint if materials is None else materials.between
    contacts = find_contacts(blocks, law, gap=gap, angle=angle, width=width)
    contacts.require()
    loads = self_weight() if dead is None else dead
    rest = (contacts.interfaces, loads, live, name, contacts.tolerances, imported.left_out)
    model = joined(contacts, blocks, names, *rest)
    refuse_jointless(model)
    return model, contacts, vain


def _refuse_missing(
    imported: ImportedBlocks,
    joint: Joint | None,
    materials: Materials | None,
    supports: Selection | None,
    live: Load | None,
) -> None:
    """Raise ModelError for what the format does not hold and was not given."""
    wrong = []
    if joint is None and materials is None:
        wrong.append(
            "the format holds blocks only; `limitblocks import` makes a model file of them, or give joint=..."
            " (or materials=...) to read a model"
        )
    if joint is not None and materials is not None:
        wrong.append("joint and materials are both given; the materials have the joints, leave joint out")
    if supports is None:
        likely = likely_supports(imported.blocks)
        such = f", such as {' '.join(map(repr, likely[0].chosen_by))}" if likely else ""
        wrong.append(
            f"the format holds blocks only; give supports=... to read a model{such}; "
            f"there are {listed(imported.blocks)}"
        )
    if live is None:
        wrong.append("the format holds blocks only; give live=... to read a model")
    if wrong:
        raise ModelError(*wrong)

"""A model from a file of any format: the model file, or blocks with what makes them a model."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from limitblocks.analysis.magnitudes import questions
from limitblocks.errors import ModelError
from limitblocks.geometry import Block, Contacts, find_contacts
from limitblocks.io import faults, model_file
from limitblocks.io.blocks import is_model_file, read_blocks
from limitblocks.io.imported import ImportedBlocks, UnitWeight
from limitblocks.joints import Joint
from limitblocks.mechanics import Load, self_weight
from limitblocks.model import Model

Supports = str | Iterable[str] | Callable[[Block], bool]

#: Gaps, in block lengths, that are tried where blocks have no interface.
_WIDER = (0.01, 0.02, 0.05, 0.1)

_log = logging.getLogger("limitblocks")


def read(
    file: str | Path,
    *,
    joint: Joint | None = None,
    supports: Supports | None = None,
    unit_weight: UnitWeight = None,
    units: str | None = None,
    up: str | None = None,
    dead: Load | None = None,
    live: Load | None = None,
    gap: float | None = None,
    angle: float | None = None,
    width: float | None = None,
) -> Model:
    """Return the model in `file`: a model file (docs/model-file.md) or blocks of any format in docs/files.md.

    A model file says everything itself: what :meth:`limitblocks.Model.save` wrote gives the same model again,
    bit for bit. For other formats `joint`, `supports` and `live` are needed; the interfaces are found by
    :func:`limitblocks.find_interfaces`. What had to be mended, and blocks that nearly touch, are logged as
    warnings, a line each; :func:`limitblocks.read_blocks` and :func:`limitblocks.find_contacts` return them.

    Parameters
    ----------
    file : str or Path
        The suffix of its name says the format.
    joint : Joint, optional
        What every interface can carry.
    supports : str, iterable of str, or function of a Block, optional
        Names of blocks or of layers, or what is true for a block that does not move; left out, the supports
        that the file marks: :attr:`ImportedBlocks.supports`.
    unit_weight : float or mapping of str to float, optional
        N/m3, of all blocks or by layer.
    units : str, optional
        Unit of length of the file, one of "m", "cm", "mm", "in", "ft"; left out, what the file says, and
        metres where it says nothing.
    up : str, optional
        Axis of the file that points up, "y" or "z"; left out, what the format says (glTF: Y), else Z.
    dead, live : Load, optional
        Loads; `dead` is self weight if left out.
    gap, angle, width : float, optional
        Tolerances of :func:`limitblocks.find_interfaces`, in block lengths and rad; left out, chosen by the
        accuracy of the faces. :attr:`limitblocks.Model.tolerances` says which were used.

    Raises
    ------
    ModelError
        The file cannot be read, the model in it is wrong, or something that the format needs is missing;
        `problems` has one line per fault, each with the file and the place in it.
    MissingDependency
        The format needs a package that is not installed.
    """
    path = Path(file)
    given: dict[str, object] = {
        "joint": joint,
        "supports": supports,
        "unit_weight": unit_weight,
        "units": units,
        "up": up,
    }
    said = [key for key, value in given.items() if value is not None]
    if is_model_file(path) and said:
        raise ModelError(f"{path}: a model file says {', '.join(said)} itself; leave the arguments out")
    if is_model_file(path):
        return model_file.read(path)
    imported = read_blocks(path, units=units, unit_weight=unit_weight, up=up)
    with faults.named(path):
        model, contacts = model_of(
            imported,
            joint=joint,
            supports=supports,
            live=live,
            dead=dead,
            gap=gap,
            angle=angle,
            width=width,
            name=path.stem,
        )
    for line in (*imported.notes, *contacts.warnings, *questions(model)):
        _log.warning("%s: %s", path, line)
    _log.info("%s: %s", path, contacts.accuracy)
    return model


def model_of(
    imported: ImportedBlocks,
    *,
    joint: Joint | None,
    supports: Supports | None,
    live: Load | None,
    dead: Load | None = None,
    gap: float | None = None,
    angle: float | None = None,
    width: float | None = None,
    name: str = "",
) -> tuple[Model, Contacts]:
    """Return the model of blocks that were read, and what was seen in their contacts.

    Raises
    ------
    ModelError
        An argument is missing, a support is unknown, or the model is wrong.
    """
    supports = supports or imported.supports or None
    if joint is None or supports is None or live is None:
        given = {"joint": joint, "supports": supports, "live": live}
        missing = (key for key, value in given.items() if value is None)
        raise ModelError(
            *(f"the format holds blocks only; give {key}=... to read a model" for key in missing)
        )
    names = supports_of(imported, supports)
    contacts = find_contacts(imported.blocks, joint, gap=gap, angle=angle, width=width)
    contacts.require()
    loads = self_weight() if dead is None else dead
    try:
        model = Model(imported.blocks, names, contacts.interfaces, loads, live, name, contacts.tolerances)
    except ModelError as error:
        raise ModelError(*error.problems, *_open_joints(contacts, imported.blocks)) from None
    return model, contacts


def _open_joints(contacts: Contacts, blocks: Sequence[Block]) -> list[str]:
    """Return the line that says which gap lets blocks touch that have no interface; none where none does."""
    for gap in _WIDER * bool(contacts.isolated):
        wide = find_contacts(blocks, None, gap=gap, width=contacts.tolerances.width)
        tied = len(contacts.isolated) - len(wide.isolated)
        if tied > 0:
            return [
                f"{tied} blocks without any interface would touch with gap={gap:g} (block lengths, "
                f"{1e3 * gap * wide.length:.2g} mm; import --gap {gap:g}): are the joints drawn open?"
            ]
    return []


def supports_of(imported: ImportedBlocks, supports: Supports) -> tuple[str, ...]:
    """Return the names of the supports: blocks named, of named layers, or that a function picks.

    Raises
    ------
    ModelError
        A name is neither that of a block nor that of a layer.
    """
    if callable(supports):
        return tuple(block.name for block in imported.blocks if supports(block))
    wanted = {supports} if isinstance(supports, str) else set(supports)
    names, layers = set(imported.layers), set(imported.layers.values()) - {""}
    unknown = sorted(wanted - names - layers)
    if unknown:
        raise ModelError(
            *(f"support {name!r} is neither a block nor a layer{faults.near(name, names | layers)}"
              for name in unknown)
        )  # fmt: skip
    return tuple(name for name, layer in imported.layers.items() if name in wanted or layer in wanted)

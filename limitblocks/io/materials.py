"""Tables of materials: TOML files, and the materials of a model file."""

from __future__ import annotations

import json
import tomllib
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from limitblocks.errors import ModelError, path_of
from limitblocks.geometry.selection import in_metres
from limitblocks.io import faults, strict_json
from limitblocks.io.registry import JOINTS
from limitblocks.io.units import METRES, in_si
from limitblocks.joints import Joint, Material, Materials

if TYPE_CHECKING:
    from limitblocks.io.documents import MaterialsDocument, ModelDocument
    from limitblocks.model import Model


def read_materials(file: str | Path) -> Materials:
    """Return the table of materials in a TOML file, as described in docs/from-a-drawing.md.

    Raises
    ------
    ModelError
        The file cannot be read or the table in it is wrong; `problems` has one line per fault, each with the
        file and the place in it.
    """
    path = path_of(file)
    with faults.named(path):
        from limitblocks.io.documents import MaterialsDocument  # here, to keep `import limitblocks` quick

        data = _toml(path)
        document = in_si(faults.validated(MaterialsDocument, json.dumps(data, default=str), data))
        wrong = faults.Faults()
        table = materials_of(document, wrong)
        if table is None:
            raise ModelError(*wrong)
        return table


def materials_of(document: MaterialsDocument | ModelDocument, wrong: faults.Faults) -> Materials | None:
    """Return the materials in a document in SI; None, with the reason in `wrong`, where they are none."""
    before, metre = len(wrong), METRES[document.units.length]
    materials = {
        name: wrong.made(f"materials.{name}", _material, one, metre)
        for name, one in document.materials.items()
    }
    pairs = {
        pair.between: wrong.made(f"pairs[{k}].joint", joint_of, pair.joint)
        for k, pair in enumerate(document.pairs)
    }
    if len(wrong) > before:
        return None
    table: Materials | None = wrong.made("pairs", Materials, materials, pairs)
    return table


def joint_of(document: Any) -> Joint:
    """Return the joint that a document describes."""
    joint: Joint = JOINTS[document.type](**document.model_dump(exclude={"type"}))
    return joint


def refuse_jointless(model: Model) -> None:
    """Raise ModelError where an interface has no joint, since neither of its materials has one."""
    material = {block.name: block.material for block in model.blocks}
    bare = {(material[i.block_i], material[i.block_j]): i.name for i in model.interfaces if i.joint is None}
    if bare:
        raise ModelError(
            *(f"interface {name}: materials {a!r} and {b!r} have no joint; give one or the pair"
              for (a, b), name in bare.items())
        )  # fmt: skip


def _material(document: Any, metre: Fraction) -> Material:
    joint = None if document.joint is None else joint_of(document.joint)
    return Material(document.unit_weight, joint, tuple(in_metres(text, metre) for text in document.blocks))


def _toml(path: Path) -> Any:
    try:
        return tomllib.loads(strict_json.plain_bytes(path, "TOML").decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        raise ModelError(f"is not UTF-8 text: byte {error.start} cannot be decoded") from None
    except tomllib.TOMLDecodeError as error:
        raise ModelError(f"not TOML: {error}") from None

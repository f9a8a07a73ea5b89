"""The model file: JSON, checked in full before a model is made of it."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import replace
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from limitblocks.arrays import read_only
from limitblocks.errors import ModelError, path_of
from limitblocks.geometry import Block, Contacts, Interface, Tolerances, find_contacts
from limitblocks.geometry.block import WORDS
from limitblocks.geometry.given_interfaces import interface_faults
from limitblocks.io import faults, strict_json
from limitblocks.io.materials import joint_of, materials_of, refuse_jointless
from limitblocks.io.open_joints import joined
from limitblocks.io.registry import TERMS
from limitblocks.io.units import in_si
from limitblocks.joints import Joint, Materials
from limitblocks.mechanics import Load
from limitblocks.mechanics.loads import self_weight, unit_vector
from limitblocks.model import Model

if TYPE_CHECKING:
    from limitblocks.io.block_documents import BlockDocument
    from limitblocks.io.documents import FindSettings, InterfaceDocument, ModelDocument, TermDocument

_log = logging.getLogger("limitblocks")


def read(file: str | Path) -> Model:
    """Return the model in `file`, a JSON document as described in docs/model-file.md.

    What :meth:`limitblocks.Model.save` wrote gives the same model again, bit for bit. Numbers in the units
    that the file states are converted to SI.

    Raises
    ------
    ModelError
        The file cannot be read or the model in it is wrong; `problems` has one line per fault, each with the
        file and the place in it.
    """
    path = path_of(file)
    with faults.named(path):
        return _model(in_si(_document(strict_json.read_text(path))))


def model_from(data: dict[str, Any]) -> Model:
    """Return the model whose ``to_dict()`` is `data`.

    Raises
    ------
    ModelError
        The model in it is wrong, with one line per fault.
    """
    return _model(in_si(_document(strict_json.text(data))))


@cache
def model_schema() -> dict[str, Any]:
    """Return the JSON Schema (2020-12) of the model file."""
    from limitblocks.io.documents import ModelDocument

    return {"$schema": "https://json-schema.org/draft/2020-12/schema"} | ModelDocument.model_json_schema()


def _document(text: str) -> ModelDocument:
    from limitblocks.io.documents import ModelDocument  # here, to keep `import limitblocks` quick

    data = strict_json.parse(text)
    if isinstance(data, dict) and "blocks" not in data and data.keys() & {"analysis", "stress_resultants"}:
        raise ModelError("is a result, not a model; the model comes first, then the result")
    faults.refuse_report(data, "a model file")
    return faults.validated(ModelDocument, text, data)


def _model(document: ModelDocument) -> Model:
    """The model of a document of the right form; raises ModelError with all its faults."""
    wrong = faults.Faults(_unknown_names(document))
    blocks = wrong.all_made("blocks", _block, document.blocks)
    joints = {name: wrong.made(f"joints.{name}", joint_of, joint) for name, joint in document.joints.items()}
    table = materials_of(document, wrong) if document.materials else None
    if table and not wrong:
        blocks = wrong.made("materials", _assigned, table, blocks) or blocks
    dead = wrong.all_made("dead", _load, document.dead)
    live = wrong.all_made("live", _load, document.live)
    tolerances = Tolerances(**document.tolerances.model_dump()) if document.tolerances else None
    contacts: Contacts | None = None
    interfaces: Sequence[Interface] = ()
    if isinstance(document.interfaces, list):
        interfaces = wrong.all_made("interfaces", _interface, document.interfaces, joints)
    elif not wrong:
        settings = document.interfaces.find
        law = joints[settings.joint] if settings.joint else table.between if table else None
        contacts = wrong.made("interfaces.find", partial(_contacts, blocks, law, settings))
        if contacts:
            interfaces, tolerances = contacts.interfaces, contacts.tolerances
    if wrong:
        raise ModelError(*wrong)
    loads = sum(dead, Load()), sum(live, Load())
    rest = (interfaces, *loads, document.name, tolerances, document.left_out)
    if contacts is None:
        model = Model(blocks, document.supports, *rest)
    else:
        model = joined(contacts, blocks, document.supports, *rest)
        for line in contacts.warnings:
            _log.warning("%s", line)
    refuse_jointless(model)
    if document.gamma_Q is None:
        return model
    from limitblocks.practice.partial_factors import with_design_values  # here, as practice takes its time

    return with_design_values(model, document.gamma_Q)


def _assigned(table: Materials, blocks: Sequence[Block]) -> tuple[Block, ...]:
    """Return the blocks with their materials; patterns in vain are logged."""
    assigned, warnings = table.on(blocks)
    for line in warnings:
        _log.warning("%s", line)
    return assigned


def _contacts(blocks: Sequence[Block], joint: Any, settings: FindSettings) -> Contacts:
    """Return the contacts found as the settings of a file say; raises GeometryError where they do not do."""
    asked = {"gap": settings.gap, "angle": settings.angle, "width": settings.width}
    contacts = find_contacts(blocks, joint, **asked)
    contacts.require()
    return contacts


def _unknown_names(document: ModelDocument) -> list[str]:
    """Names that stand for no block or joint, with their places."""
    blocks, joints = {block.name for block in document.blocks}, set(document.joints)
    used = [(f"supports[{k}]", name, blocks, "block") for k, name in enumerate(document.supports)]
    for word in ("dead", "live"):
        terms = enumerate(getattr(document, word))
        for k, term in terms:
            keys = [key for key in ("block", "block_i", "block_j") if hasattr(term, key)]
            used += [(f"{word}[{k}].{key}", getattr(term, key), blocks, "block") for key in keys]
            named = enumerate(getattr(term, "blocks", ()))
            used += [(f"{word}[{k}].blocks[{n}]", name, blocks, "block") for n, name in named]
    if isinstance(document.interfaces, list):
        for k, one in enumerate(document.interfaces):
            used.append((f"interfaces[{k}].block_i", one.block_i, blocks, "block"))
            used.append((f"interfaces[{k}].block_j", one.block_j, blocks, "block"))
            used.append((f"interfaces[{k}].joint", one.joint, joints, "joint"))
    elif document.interfaces.find.joint is not None:
        used.append(("interfaces.find.joint", document.interfaces.find.joint, joints, "joint"))
    wrong = []
    if not isinstance(document.interfaces, list) and not (
        document.interfaces.find.joint or document.materials
    ):
        wrong.append("interfaces.find.joint is null, and there are no materials that have joints")
    for place, name, known, word in used:
        if name not in known:
            wrong.append(f"{place}: {name!r} is not a {word} of the model{faults.near(name, known)}")
    return wrong


def _block(document: BlockDocument) -> Block:
    if document.box is not None:
        block = Block.box(document.name, document.box.size, document.box.at)
    elif document.prism is not None:
        block = Block.prism(document.name, **document.prism.model_dump())
    else:
        block = Block(document.name, document.vertices, document.faces)  # type: ignore[arg-type]
    return block.labelled(unit_weight=document.unit_weight, **{key: getattr(document, key) for key in WORDS})


def _load(document: TermDocument) -> Load:
    factor: float = document.factor
    if document.type == "SelfWeight":
        return factor * self_weight()
    term = TERMS[document.type](**document.model_dump(exclude={"type", "factor"}))
    # a unit vector stays as it is, so that what was written is read bit for bit
    if hasattr(term, "direction") and abs(np.linalg.norm(term.direction) - 1.0) > 1e-12:
        term = replace(term, direction=unit_vector(term.direction, "direction"))
    return Load(((factor, term),))


def _interface(document: InterfaceDocument, joints: dict[str, Joint | None]) -> Interface:
    interface = Interface(
        document.block_i,
        document.block_j,
        read_only(document.centroid),
        read_only(document.axes),
        read_only(document.polygon),
        joints.get(document.joint),
    )
    if said := interface_faults([interface]):
        raise ModelError(*said)
    return interface

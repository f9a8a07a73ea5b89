"""A model: blocks, supports, interfaces, dead and live loads."""

from __future__ import annotations

import hashlib
import json
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import compress
from pathlib import Path
from typing import Any
from weakref import WeakSet

import numpy as np
import numpy.typing as npt

from limitblocks.errors import ModelError, few, missing, path_of, sequence_of
from limitblocks.geometry import Block, Interface, Tolerances
from limitblocks.geometry.block import WORDS
from limitblocks.geometry.contact import nearly_tied
from limitblocks.geometry.ends import floating
from limitblocks.geometry.given_interfaces import interface_faults
from limitblocks.geometry.interface import PLACE
from limitblocks.joints.base import joints_of
from limitblocks.mechanics import Load, limit_problem
from limitblocks.problem import LimitProblem
from limitblocks.shown import Viewed, kept, many
from limitblocks.written import tagged, write

SCHEMA_VERSION = 1
# results keep the hash of their model, not the model: copies in other processes and saved ones stay small
_MODELS: WeakSet[Model] = WeakSet()  # whose digest was asked for; equal ones may come and go


@dataclass(frozen=True, eq=False, repr=False)
class Model(Viewed):
    """A structure of rigid blocks with its loads: dead + load factor x live.

    Parameters
    ----------
    blocks : sequence of Block
        All blocks, those of the supports included. Names are unique.
    supports : sequence of str
        Names of the blocks that do not move.
    interfaces : sequence of Interface
        Contacts between blocks; those between two supports are left out.
    dead, live : Load
        Constant loads Fc and variable loads Fv (Eq. 43); weights of supports count for nothing.
    name : str
        Title in reports.
    tolerances : Tolerances, optional
        Those that the interfaces were found with, which later checks of the contacts use as well.
    left_out : sequence of str
        Parts of the file it comes from that are no blocks; named where blocks float or fall.

    Raises
    ------
    ModelError
        With all faults at once: no or unknown support, no free block, two blocks of one name, an interface
        of an unknown block, a block that no chain of interfaces ties to a support, a load that names
        an unknown block or a support, no live load.
    """

    blocks: Sequence[Block]
    supports: Sequence[str]
    interfaces: Sequence[Interface]
    dead: Load
    live: Load
    name: str = ""
    tolerances: Tolerances | None = None
    left_out: Sequence[str] = ()

    def __post_init__(self) -> None:
        kinds = {"blocks": Block, "supports": str, "interfaces": Interface, "left_out": str}
        for word, kind in kinds.items():
            object.__setattr__(self, word, sequence_of(word, getattr(self, word), kind))
        problems = _name_problems(self)
        if not problems:
            supports = set(self.supports)
            loose = (i for i in self.interfaces if not {i.block_i, i.block_j} <= supports)
            object.__setattr__(self, "interfaces", tuple(loose))
            problems = interface_faults(self.interfaces) or _floating_problems(self) + _load_problems(self)
        if problems:
            raise ModelError(*problems)

    @cached_property
    def free(self) -> npt.NDArray[np.bool_]:
        """Whether each block can move, shape (n,)."""
        supports = set(self.supports)
        return np.array([block.name not in supports for block in self.blocks])

    @cached_property
    def free_blocks(self) -> tuple[Block, ...]:
        """The blocks that can move, in model order."""
        return tuple(compress(self.blocks, self.free.tolist()))

    @cached_property
    def problem(self) -> LimitProblem:
        """The dimensionless limit problem of the model."""
        free = self.free_blocks
        problem = limit_problem(free, self.interfaces, self.dead.on(free), self.live.on(free))
        return replace(problem, left_out=tuple(self.left_out))

    @cached_property
    def digest(self) -> str:
        """SHA-256 of the model less tolerances and what was left out; same models have the same.

        Of its columns as text, with the sizes of arrays, and then of their bytes, little endian.
        """
        blocks, interfaces = self.blocks, self.interfaces
        joint, joints = joints_of(interfaces)
        faces: dict[Any, int] = {}  # blocks share them
        columns = [
            [faces.setdefault(block.faces, len(faces)) for block in blocks],
            list(faces),
            *([getattr(block, key) or None for block in blocks] for key in ("name", *WORDS)),
            [(block.unit_weight, len(block.vertices)) for block in blocks],
            [(i.block_i, i.block_j, joint[id(i.joint)], len(i.polygon)) for i in interfaces],
            [SCHEMA_VERSION, self.name, self.supports, joints, self._loads],
        ]
        sha = hashlib.sha256(json.dumps(columns, sort_keys=True).encode())
        arrays = [block.vertices for block in blocks]
        arrays += [part for i in interfaces for part in (i.centroid, i.axes, i.polygon)]
        sha.update(
            np.frombuffer(b"".join([array.tobytes() for array in arrays])).astype("<f8", copy=False).data
        )
        found = sha.hexdigest()
        _MODELS.add(self)
        return found

    @property
    def _loads(self) -> dict[str, Any]:
        loads = {"dead": self.dead, "live": self.live}
        return {
            key: [{"factor": factor} | tagged(term) for factor, term in load.terms]
            for key, load in loads.items()
        }

    def to_dict(self) -> dict[str, Any]:
        """Return the document that :meth:`save` writes and :func:`limitblocks.read` reads."""
        joint, joints = joints_of(self.interfaces)
        used: dict[str, Any] = {} if self.tolerances is None else {"tolerances": self.tolerances.to_dict()}
        used |= {"left_out": list(self.left_out)} if self.left_out else {}
        return {
            "schema_version": SCHEMA_VERSION,
            "name": self.name,
            **used,
            "blocks": [
                {
                    "name": block.name,
                    "vertices": block.vertices.tolist(),
                    "faces": [list(face) for face in block.faces],
                    "unit_weight": block.unit_weight,
                    **{key: word for key in WORDS if (word := getattr(block, key))},
                }
                for block in self.blocks
            ],
            "supports": list(self.supports),
            "joints": joints,
            "interfaces": [kept(one, *PLACE) | {"joint": joint[id(one.joint)]} for one in self.interfaces],
            **self._loads,
        }

    def save(self, file: str | Path, *, overwrite: bool = False) -> Path:
        """Write the model to a JSON file and return its path.

        Raises
        ------
        LimitBlocksError
            If the file exists and `overwrite` is false, it cannot be written, or by its suffix
            :func:`limitblocks.read` would not read it.
        """
        if path_of(file).suffix.lower() not in ("", ".json"):
            raise ModelError(f"{file}: a model file ends in .json; files.write_blocks writes other formats")
        return write(file, json.dumps(self.to_dict(), indent=1), overwrite)

    def __str__(self) -> str:
        free, supports = many(len(self.free_blocks), "block"), many(len(self.supports), "support")
        return f"model {self.name!r}: {free}, {supports}, {many(len(self.interfaces), 'interface')}"


def checked_model(model: Any) -> Model:
    """Return `model`, or raise ModelError if it is none but, say, the name of its file."""
    if isinstance(model, Model):
        return model
    how = f"; limitblocks.read({str(model)!r}) reads one" if isinstance(model, str | Path) else ""
    raise ModelError(f"model is a {type(model).__name__}, expected a Model{how}")


def model_of(result: Any, model: Model | None = None) -> Model | None:
    """Return `model`, else the one in memory that `result` belongs to; None where it is gone.

    Raises
    ------
    ModelError
        If the result belongs to another model.
    """
    if model is not None:
        refuse_other(model, result)
        return model
    digest = getattr(result, "digest", "")
    return next((one for one in _MODELS if one.digest == digest), None)


def refuse_other(model: Model, result: Any) -> None:
    """Refuse a result that says it belongs to another model; a load path says so by its collapse.

    Raises
    ------
    ModelError
        Its digest is another one.
    """
    digest = str(getattr(getattr(result, "collapse", result), "digest", ""))
    if digest and digest != model.digest:
        kind = type(result).__name__
        raise ModelError(f"this {kind} belongs to model {digest[:12]}, not to this model {model.digest[:12]}")


def _name_problems(model: Model) -> list[str]:
    names = [block.name for block in model.blocks]
    known, supports = set(names), set(model.supports)
    problems = [f"block name {name!r} is used {k} times" for name, k in Counter(names).items() if k > 1]
    problems += [
        f"support {name!r} is named {k} times; once is enough"
        for name, k in Counter(model.supports).items()
        if k > 1
    ]
    problems += [f"support {name!r} is not a block of the model" for name in sorted(supports - known)]
    if not supports:
        problems.append("the model has no support; name at least one block that does not move")
    if known <= supports:
        problems.append("the model has no free block; every block is a support")
    for interface in model.interfaces:
        missing = sorted({interface.block_i, interface.block_j} - known)
        problems += [f"interface {interface.name} names block {name!r}, which is missing" for name in missing]
        if interface.block_i == interface.block_j:
            problems.append(f"interface {interface.name} joins a block to itself")
    return problems


def _floating_problems(model: Model) -> list[str]:
    """Free blocks that no chain of interfaces ties to a support."""
    loose = floating(model.blocks, model.interfaces, model.supports)
    said = f"floating: no chain of interfaces ties {few([*map(repr, loose)])} to a support"
    return (
        [said + nearly_tied(model.blocks, set(loose), model.tolerances), *missing(model.left_out)]
        if loose
        else []
    )


def _load_problems(model: Model) -> list[str]:
    problems, known = [], {block.name for block in model.blocks}
    for word, load in (("dead", model.dead), ("live", model.live)):
        if not isinstance(load, Load):
            problems.append(f"{word} is {load!r}, expected a load such as mass_proportional((1, 0, 0))")
            continue
        try:
            values = load.on(model.free_blocks)
            missing = {name for _, term in load.terms for name in getattr(term, "joins", ())} - known
            problems += [f"{word} load: block {name!r} of a joint is missing" for name in sorted(missing)]
        except ModelError as error:
            problems += [f"{word} load: {problem}" for problem in error.problems]
        else:
            if word == "live" and not values.any():
                problems.append("no live load: it is zero on every free block, expected a force to multiply")
    return problems

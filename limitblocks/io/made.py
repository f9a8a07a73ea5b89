"""Blocks made of the solids of a file, one by one: a bad one does not spoil the others."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple, get_args

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import GeometryError, ModelError
from limitblocks.geometry import Block
from limitblocks.geometry.accuracy import Accuracy, block_length, millimetres
from limitblocks.geometry.mend import TwistedFaces, mended
from limitblocks.geometry.twisted import Twisted, rounding

if TYPE_CHECKING:
    from limitblocks.io.imported import Solid

#: Distance of a corner from its plane over the accuracy that faces which touch show: as for healing.
_TWIST = 4.0


class Made(NamedTuple):
    """Blocks by name, what was mended, and what is wrong with the solids that are none, by name."""

    blocks: dict[str, Block]
    notes: list[str]
    wrong: dict[str, tuple[str, ...]]


def made(
    named: Mapping[str, Solid],
    placement: Array,
    weights: Mapping[str, float | None],
    twisted: Twisted | None,
) -> Made:
    """Return the blocks that solids are, in m, placed by the matrix `placement` (3, 3).

    Where `twisted` is left out, twisted faces are divided into triangles if they are so within the accuracy
    that the faces of the blocks show where they touch, else refused.
    """
    if twisted not in (None, *get_args(Twisted)):
        raise ModelError(f"twisted is {twisted!r}; expected one of {', '.join(get_args(Twisted))}")
    result, bent = Made({}, [], {}), dict[str, float]()
    for name, solid in named.items():
        try:
            result.blocks[name], said = _made(name, solid, placement, weights, twisted or "refuse")
            result.notes.extend(said)
        except ModelError as error:
            result.wrong[name] = error.problems
            if isinstance(error, TwistedFaces):
                bent[name] = error.distance
    if bent and twisted is None:
        _take_accurate(result, named, placement, weights, bent)
    return result._replace(blocks={name: result.blocks[name] for name in named if name in result.blocks})


def _made(
    name: str, solid: Solid, placement: Array, weights: Mapping[str, float | None], twisted: Twisted
) -> tuple[Block, tuple[str, ...]]:
    vertices = np.asarray(solid.vertices, dtype=np.float64) @ placement
    return mended(name, vertices, solid.faces, weights[name], twisted)


def _take_accurate(
    result: Made,
    named: Mapping[str, Solid],
    placement: Array,
    weights: Mapping[str, float | None],
    bent: Mapping[str, float],
) -> None:
    """Take blocks whose faces are twisted within the accuracy of all."""
    triangles = dict[str, tuple[Block, tuple[str, ...]]]()
    for name in bent:
        try:
            triangles[name] = _made(name, named[name], placement, weights, "triangulate")
        except GeometryError:  # its own fault was told
            continue
    blocks = [*result.blocks.values(), *(block for block, _ in triangles.values())]
    shown = (Accuracy.shown(blocks).size or 0.0) * block_length(blocks) if blocks else 0.0
    for name, (block, said) in triangles.items():
        # a corner rounded by half a step in each coordinate
        step = rounding(np.asarray(named[name].vertices, dtype=np.float64))
        step *= float(np.linalg.norm(placement[0]))
        if bent[name] <= max(_TWIST * shown, step):
            good = millimetres(max(shown, step / 2.0))
            result.blocks[name] = block
            result.notes.extend(f"{line}, as the file is good to about {good} there" for line in said)
            del result.wrong[name]


def refused(wrong: Mapping[str, Sequence[str]], good: int) -> ModelError:
    """Return the error that lists all solids that are no blocks, beside so many `good` ones."""
    lines = [line for problems in wrong.values() for line in problems]
    if good:
        lines.insert(
            0,
            f"{len(wrong)} of {good + len(wrong)} blocks are bad; --skip-bad (skip_bad=True) leaves them out",
        )
    return ModelError(*lines)


def left_out(wrong: Mapping[str, Sequence[str]]) -> list[str]:
    """Return notes on solids that were left out."""
    return [f"left out: {line}" for problems in wrong.values() for line in problems]

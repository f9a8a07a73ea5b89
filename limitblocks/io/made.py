"""Blocks made of the solids of a file, one by one: a bad one does not spoil the others."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import NamedTuple, get_args

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import GeometryError, ModelError, few
from limitblocks.geometry import Block
from limitblocks.geometry.accuracy import Accuracy, block_length, millimetres
from limitblocks.geometry.block import WORDS
from limitblocks.geometry.mend import TwistedFaces, mended
from limitblocks.geometry.twisted import Twisted, rounding
from limitblocks.io.colours import known
from limitblocks.io.solid import Solid, corners
from limitblocks.shown import many

#: Distance of a corner from its plane over the accuracy that faces which touch show: as for healing.
_TWIST = 4.0


class Made(NamedTuple):
    """Blocks, what was mended, what is wrong with solids that are none, by name, and which are supports.

    `twisted` is the number of solids whose fault is that faces are twisted, `lost` names supports among the
    solids that are no blocks.
    """

    blocks: tuple[Block, ...]
    notes: tuple[str, ...]
    wrong: dict[str, Sequence[str]]
    supports: tuple[str, ...] = ()
    twisted: int = 0
    lost: tuple[str, ...] = ()

    @property
    def warnings(self) -> list[str]:
        """The line that says which supports are no blocks; none where all are."""
        return [
            f"the file marks as supports what is no block: {few(self.lost)}; mend it, or draw a solid below "
            "the plane: what stands on it is without its support"
        ] * bool(self.lost)


_Mended = tuple[Block, tuple[str, ...]]


def made(named: Mapping[str, Solid], placement: Array, twisted: Twisted | None) -> Made:
    """Return the blocks that solids are, in m, placed by the matrix `placement` (3, 3).

    Where `twisted` is left out, twisted faces are divided into triangles if they are so within the accuracy
    that the faces of the blocks show where they touch, or within the last digit of their coordinates.
    """
    if twisted not in (None, *get_args(Twisted)):
        raise ModelError(f"twisted is {twisted!r}; expected one of {', '.join(get_args(Twisted))}")
    good, wrong, bent = dict[str, _Mended](), dict[str, Sequence[str]](), dict[str, float]()
    for name, solid in named.items():
        try:
            good[name] = _made(name, solid, placement, twisted or "refuse")
        except ModelError as error:
            wrong[name] = error.problems
            if isinstance(error, TwistedFaces):
                bent[name] = error.distance
    if bent and twisted is None:
        good |= _accurate(good, {name: named[name] for name in bent}, placement, bent)
    wrong = {name: lines for name, lines in wrong.items() if name not in good}
    kept = [good[name] for name in named if name in good]
    notes = tuple(line for _, said in kept for line in said)
    return Made(tuple(block for block, _ in kept), notes, wrong, twisted=sum(name in wrong for name in bent))


def _made(name: str, solid: Solid, placement: Array, twisted: Twisted) -> _Mended:
    vertices = np.asarray(solid.vertices, dtype=np.float64) @ placement
    block, said = mended(name, vertices, solid.faces, twisted=twisted)
    words = {key: getattr(solid, key) for key in WORDS}
    words["groups"] = [one for one in solid.groups if one]
    return block.labelled(**words | {"colour": known(solid.colour)}), said


def _accurate(
    good: Mapping[str, _Mended], named: Mapping[str, Solid], placement: Array, bent: Mapping[str, float]
) -> dict[str, _Mended]:
    """Return the blocks among those `named` whose faces are twisted within the accuracy of the file."""
    triangles = dict[str, _Mended]()
    for name, solid in named.items():
        with suppress(GeometryError):  # its own fault was told
            triangles[name] = _made(name, solid, placement, "triangulate")
    blocks = [block for block, _ in (*good.values(), *triangles.values())]
    shown = (Accuracy.shown(blocks).size or 0.0) * block_length(blocks) if blocks else 0.0
    taken = {}
    for name, (block, said) in triangles.items():
        # a corner rounded by half a step in each coordinate
        step = rounding(corners(named[name]))
        step *= float(np.linalg.norm(placement[0]))
        if bent[name] <= max(_TWIST * shown, step):
            is_good = f"as the file is good to about {millimetres(max(shown, step / 2.0))} there"
            taken[name] = block, tuple(f"{line}, {is_good}" for line in said)
    return taken


def refused(wrong: Mapping[str, Sequence[str]], good: int, twisted: int = 0) -> ModelError:
    """Return the error that lists all solids that are no blocks, beside so many `good` ones.

    The first line says what to do: about twisted faces where these are what is wrong with most.
    """
    lines = [line for problems in wrong.values() for line in problems]
    bad = f"{len(wrong)} of {many(good + len(wrong), 'block')} {'is' if len(wrong) == 1 else 'are'} bad"
    skip = "--skip-bad (skip_bad=True) leaves"
    if 2 * twisted > len(wrong) and good + len(wrong) > 1:
        most = f"{twisted} of them " * (twisted < len(wrong))
        also = f"; {skip} out what is bad" * bool(good)
        divide = "--twisted triangulate (twisted='triangulate') divides these"
        lines.insert(0, f"{bad}, {most}by twisted faces; {divide}{also}")
    elif good:
        lines.insert(0, f"{bad}; {skip} them out")
    return ModelError(*lines)


def left_out(wrong: Mapping[str, Sequence[str]]) -> list[str]:
    """Return notes on solids that were left out."""
    return [f"left out: {line}" for problems in wrong.values() for line in problems]

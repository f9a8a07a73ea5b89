"""Slips in the dead load: self weight or fill that is forgotten, or counted twice."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations

import numpy as np

from limitblocks.arrays import Array
from limitblocks.geometry import Block
from limitblocks.mechanics.loads.forces import MassProportional, PointForce
from limitblocks.mechanics.loads.load import Load, some
from limitblocks.mechanics.loads.surfaces import Fill
from limitblocks.model import Model
from limitblocks.shown import coordinate

#: Factor of the self weight beyond which it may be given twice: partial factors are at most 1.5.
_MOST = 1.5
#: Share by which forces may differ from the weight of a block that they stand for.
_CURVED = 0.1
#: Levels of fill, m, that are nearer are the same: a message shows no more.
_SAME = 1e-3


def of_weights(model: Model) -> Iterator[str]:
    """Return what is asked about self weight in the dead load of a model that has one."""
    heavy = [block for block in model.free_blocks if block.unit_weight]
    dead, live = _times(model.dead), _times(model.live)
    if heavy and -dead[2] > _MOST * (1.0 + 1e-9):
        yield (
            f"the dead load has {-dead[2]:.4g} times the weight of {_weights(heavy)}, more than partial "
            f"factors up to {_MOST:g}: self_weight() given twice?"
        )
    grows = live[2] < 0.0 and not live[:2].any()  # the weight is what the load factor multiplies
    if heavy and model.dead.terms and not dead.any() and not grows and not _by_hand(model.dead, heavy):
        yield f"the dead load lacks the weight of {_weights(heavy)}: add self_weight()"


def _times(load: Load) -> Array:
    """Return the factor of the weight of every block in a load, with its direction."""
    own = [(k, term.direction) for k, term in load.terms if isinstance(term, MassProportional)]
    return sum((k * np.array(direction) for k, direction in own), np.zeros(3))


def _by_hand(dead: Load, blocks: Sequence[Block]) -> bool:
    """Whether forces carry the weight of some block, such as at the centroids of curved stones."""
    down = dict.fromkeys((block.name for block in blocks), 0.0)
    for factor, term in dead.terms:
        if isinstance(term, PointForce) and term.block in down:
            down[term.block] -= factor * term.force[2]
    return any(abs(down[block.name] - block.weight) <= _CURVED * block.weight for block in blocks)


def _weights(blocks: Sequence[Block]) -> str:
    return f"{some([block.name for block in blocks])}, {sum(block.weight for block in blocks):.4g} N"


def of_fills(model: Model) -> Iterator[str]:
    """Return what is asked about fill that the dead load has twice, up to one level on the same faces."""
    fills = [(factor, term) for factor, term in model.dead.terms if isinstance(term, Fill)]
    for (a, one), (b, other) in combinations(fills, 2):
        if a * b > 0.0 and abs(one.level - other.level) <= _SAME:
            blocks = model.free_blocks
            if both := _faces(one, blocks) & _faces(other, blocks):
                names = dict.fromkeys(blocks[k].name for k, _ in sorted(both))
                yield (
                    f"the dead load has fill up to Z = {coordinate(one.level)} m on {some([*names])} twice, "
                    f"of {a * one.unit_weight:.4g} and {b * other.unit_weight:.4g} N/m3: one of them?"
                )


def _faces(fill: Fill, blocks: Sequence[Block]) -> set[tuple[int, int]]:
    return {(k, face) for k, face, weight, _ in fill.on_faces(blocks) if weight}

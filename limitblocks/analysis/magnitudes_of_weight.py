"""Slips in the dead load: self weight that is forgotten, counted twice, or does not act downwards."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from limitblocks.arrays import Array
from limitblocks.geometry import Block
from limitblocks.mechanics.loads.forces import MassProportional, PointForce
from limitblocks.mechanics.loads.load import Load, some
from limitblocks.model import Model
from limitblocks.shown import coordinates

#: Least and greatest partial factor; beyond the greatest, the self weight may be given twice.
_LEAST, _MOST = 0.9, 1.5
#: Share by which forces may differ from the weight of a block that they stand for, beside a partial factor.
_CURVED = 0.1


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
    if heavy and dead.any() and dead[2] >= 0.0 and not grows and not _by_hand(model.dead, heavy):
        to = coordinates((dead / np.linalg.norm(dead)).tolist())
        yield f"the dead load has the weight of {_weights(heavy)}, along {to}: meant? Down is (0, 0, -1)"


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
    least, most = _LEAST * (1.0 - _CURVED), _MOST * (1.0 + _CURVED)
    return any(least <= down[block.name] / block.weight <= most for block in blocks)


def _weights(blocks: Sequence[Block]) -> str:
    return f"{some([block.name for block in blocks])}, {sum(block.weight for block in blocks):.4g} N"

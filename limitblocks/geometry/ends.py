"""The blocks that interfaces join, and those that no chain of them ties to a support."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from limitblocks.arrays import Indices, tied
from limitblocks.geometry.block import Block
from limitblocks.geometry.interface import Interface


def ends_of(blocks: Sequence[Block], interfaces: Sequence[Interface]) -> Indices:
    """Return the places (m, 2) among `blocks` of blocks i and j of each interface; -1 for one not there."""
    place = {block.name: k for k, block in enumerate(blocks)}
    pairs = [(place.get(one.block_i, -1), place.get(one.block_j, -1)) for one in interfaces]
    return np.array(pairs, dtype=np.int64).reshape(-1, 2)


def floating(blocks: Sequence[Block], interfaces: Sequence[Interface], supports: Sequence[str]) -> list[str]:
    """Return the names of the blocks that no chain of interfaces ties to a support."""
    part, fixed = tied(ends_of(blocks, interfaces), len(blocks)).tolist(), set(supports)
    held = {own for own, block in zip(part, blocks, strict=True) if block.name in fixed}
    return [block.name for own, block in zip(part, blocks, strict=True) if own not in held]

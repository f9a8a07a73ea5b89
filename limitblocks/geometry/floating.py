"""Blocks that no chain of interfaces ties to a support."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from limitblocks.arrays import tied
from limitblocks.geometry.block import Block
from limitblocks.geometry.interface import Interface


def floating(blocks: Sequence[Block], interfaces: Sequence[Interface], supports: Sequence[str]) -> list[str]:
    """Return the names of the blocks that no chain of interfaces ties to a support."""
    place = {block.name: k for k, block in enumerate(blocks)}
    pairs = np.array([(place[i.block_i], place[i.block_j]) for i in interfaces]).reshape(-1, 2)
    part = tied(pairs, len(place))
    held = {part[place[name]] for name in supports}
    return [block.name for block in blocks if part[place[block.name]] not in held]

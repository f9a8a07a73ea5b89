"""Piers below an arch."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from limitblocks.arrays import Array
from limitblocks.geometry import Block
from limitblocks.structures.build import base, pier, prism, refuse, refuse_fewer, refuse_not_positive
from limitblocks.structures.rings import Ring

SAME = 1e-9  # of the width of a pier: springings as wide have its width


class Piers(NamedTuple):
    """Two piers of single blocks, flush with the intrados: width along X; number and height of blocks; m."""

    width: float
    blocks: int
    block_height: float = 0.4


def on_piers(ring: Ring, piers: Piers) -> Ring:
    """The ring raised until its springings stand on the piers, or ModelError."""
    refuse_not_positive(pier_width=piers.width, block_height=piers.block_height)
    refuse_fewer(1, pier_blocks=piers.blocks)
    across = float(ring.inner[0, 0] - ring.outer[0, 0])
    if piers.width < across * (1.0 - SAME):
        refuse([f"pier width is {piers.width!r}, expected at least that of the springing, {across!r}"])
    return ring.raised(piers.blocks * piers.block_height - float(ring.inner[0, 1]))


def pier_blocks_of(
    ring: Ring, piers: Piers, depth: float, unit_weight: float
) -> tuple[list[Block], list[Block], list[tuple[str, Array]]]:
    """Blocks of both piers, the base, and the edges of their tops beside the arch."""
    inner, y = -float(ring.inner[0, 0]), (-depth / 2, depth / 2)
    outer, top = inner + piers.width, piers.blocks * piers.block_height
    foot = float(ring.outer[0, 1])  # where the extrados begins
    blocks, ledges = [], []
    for side, sign in (("left", -1), ("right", 1)):
        x = sorted((sign * outer, sign * inner))
        blocks += pier(f"{side} pier", x, y, piers.blocks, piers.block_height, unit_weight)
        if foot - top > SAME * piers.width:
            shoulder = [(-outer, top), (-inner, top), ring.outer[0], (-outer, foot)]
            outline = np.array(shoulder[:3] if ring.outer[0, 0] + outer <= SAME * piers.width else shoulder)
            outline = outline if sign < 0 else outline[::-1] * (-1.0, 1.0)
            blocks.append(prism(f"{side} skewback", outline, depth, unit_weight))
        ledge = np.array([(-outer, foot), (ring.outer[0, 0], foot)])
        ledges.append((blocks[-1].name, ledge if sign < 0 else ledge[::-1] * (-1.0, 1.0)))
    return blocks, [base((-outer, outer), y, piers.block_height)], ledges

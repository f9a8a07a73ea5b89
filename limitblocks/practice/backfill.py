"""Passive resistance of the fill of a bridge: one-sided, on the blocks that move into it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from limitblocks.errors import ModelError
from limitblocks.mechanics import fill
from limitblocks.mechanics.loads.load import number, unit_vector
from limitblocks.model import Model
from limitblocks.practice.elements import Element, tie

BEHIND = 10.0  # of a block's size: where the tie that stands for passive fill is held


def passive_fill(
    model: Model,
    level: float,
    *,
    unit_weight: float,
    coefficient: float,
    blocks: Sequence[str] = (),
    along: Sequence[float] = (1.0, 0.0, 0.0),
) -> list[Element]:
    """Return the one-sided passive resistance of backfill, for :func:`~limitblocks.practice.reinforced`.

    A block that moves into the fill along +-`along` meets up to ``coefficient unit_weight depth`` on the
    projection of its faces that lie under the fill; one that moves away meets nothing. Rigid-plastic,
    associated, mobilised at once, no friction between fill and masonry. Each resistance is a tie that holds
    the block from behind, at the height of the resultant.

    Parameters
    ----------
    model : Model
        The structure.
    level : float
        Of the surface of the fill, Z, m.
    unit_weight : float
        Of the fill, N/m3.
    coefficient : float
        Of passive earth pressure K_p, less that at rest where :func:`~limitblocks.loads.fill` has it, > 0.
    blocks : sequence of str
        Blocks that touch the fill; all free ones unless given.
    along : sequence of float
        Horizontal direction along the deck.

    Raises
    ------
    ModelError
        If a number is out of range or no block lies under the fill with a face that leans along the deck.
    """
    number(coefficient, "coefficient of passive pressure", "", above=0.0)
    number(unit_weight, "unit weight of fill", "N/m3", above=0.0)
    d = np.array(unit_vector(along, "direction along the deck"))
    free, names = model.free_blocks, tuple(blocks)
    pressed = fill(unit_weight, level, blocks=names, earth_pressure=coefficient).on(free)
    pressed = pressed - fill(unit_weight, level, blocks=names).on(free)
    across = np.cross((0.0, 0.0, 1.0), d)
    elements = []
    for block, load in zip(free, pressed, strict=True):
        push = float(load[:3] @ d)
        if not abs(push) > 0.0:
            continue
        height = float(load[3:] @ across) / push  # of the resultant over the centroid
        at = block.centroid + np.array([0.0, 0.0, height])
        behind = at + np.sign(push) * BEHIND * block.size * d
        area = abs(push) / (coefficient * unit_weight)  # m3: any area does, the force counts
        elements.append(
            tie(
                block.name,
                at.tolist(),
                model.supports[0],
                behind.tolist(),
                area=area,
                strength=abs(push) / area,
            )
        )
    if not elements:
        raise ModelError(f"no block has a face that leans along the deck below the fill at {level:g} m")
    return elements

"""Passive resistance of the fill of a bridge: one-sided, on the blocks that move into it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from limitblocks.arrays import read_only
from limitblocks.errors import ModelError
from limitblocks.geometry import Interface
from limitblocks.joints import Backfill
from limitblocks.mechanics.loads import fill
from limitblocks.mechanics.loads.load import number, unit_vector
from limitblocks.model import Model
from limitblocks.practice.elements import CORNERS, Element, axes_of


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
    associated, mobilised at once, no friction between fill and masonry. Each resistance holds the block from
    behind, at the height of the resultant, and is held by the first support.

    Fill over a pier between two spans leans on the other span, not on the ground: name in `blocks` those of
    the end spans that push towards an abutment, unless backing or spandrel walls hold the rest.

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
        passive = coefficient * unit_weight * (level - at[2])  # pressure where the resultant acts
        area = abs(push) / passive
        elements.append(
            Element(
                Interface(
                    block.name,
                    model.supports[0],
                    read_only(at),
                    read_only(axes_of(np.sign(push) * d)),
                    read_only(np.sqrt(area) * CORNERS),
                    Backfill(passive),
                )
            )
        )
    if not elements:
        raise ModelError(f"no block has a face that leans along the deck below the fill at {level:g} m")
    return elements

"""Passive resistance of the fill of a bridge: one-sided, on the blocks that move into it."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np

from limitblocks.arrays import read_only
from limitblocks.errors import ModelError, sequence_of
from limitblocks.geometry import Interface
from limitblocks.geometry.polygon import axes_of
from limitblocks.joints import Backfill
from limitblocks.mechanics.loads import Fill
from limitblocks.mechanics.loads.load import horizontal, number, place, unit_vector
from limitblocks.model import Model, checked_model
from limitblocks.practice.elements import CORNERS, Element

STEEP = 1e-9  # slope of a face along the deck that counts as none


def passive_fill(
    model: Model,
    level: float,
    *,
    unit_weight: float,
    coefficient: float,
    blocks: Sequence[str] = (),
    along: Sequence[float] = (1.0, 0.0, 0.0),
    beyond: Sequence[float] | None = None,
    towards: Sequence[float] | None = None,
) -> list[Element]:
    """Return the one-sided passive resistance of backfill, for :func:`~limitblocks.practice.reinforced`.

    A block that moves into the fill along +-`along` meets up to ``coefficient unit_weight depth`` on the
    projection of its faces that lie under the fill; one that moves away meets nothing. Rigid-plastic,
    associated, mobilised at once, no friction between fill and masonry. The resistance of each face holds the
    block from behind, on the line of its resultant, and is held by the first support, or another at rest
    where that one settles. Upright faces, as the back of an abutment, meet nothing: no fill is above them.

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
    beyond, towards : sequence of float
        Where the fill ends sideways, as of :func:`~limitblocks.loads.fill`: needed where it lies on one side
        of a wall alone.

    Raises
    ------
    ModelError
        If a number is out of range, a direction is not horizontal, or no block lies under the fill with a
        face that leans along the deck.
    """
    checked_model(model)
    number(coefficient, "coefficient of passive pressure", "", above=0.0)
    number(unit_weight, "unit weight of fill", "N/m3", above=0.0)
    d, names = np.array(horizontal(along, "direction along the deck")), sequence_of("blocks", blocks, str)
    side = (
        None if beyond is None else place(beyond, "fill: beyond"),
        None if towards is None else unit_vector(towards, "fill: towards"),
    )
    free, elements = model.free_blocks, []
    for k, face, weight, first in Fill(unit_weight, level, names, 0.0, *side).on_faces(free):
        normal, block = free[k].normals[face], free[k]
        push = -coefficient * weight * float(normal @ d) / float(normal[2])
        if not abs(push) > STEEP * coefficient * weight:
            continue
        at = block.centroid + first / weight  # of the resultant, on the face
        passive = coefficient * unit_weight * (level - at[2])  # pressure where the resultant acts
        elements.append(
            Element(
                Interface(
                    block.name,
                    model.supports[0],
                    read_only(at),
                    read_only(axes_of(np.sign(push) * d)),
                    read_only(np.sqrt(abs(push) / passive) * CORNERS),
                    Backfill(passive),
                )
            )
        )
    if not elements:
        raise ModelError(f"no block has a face that leans along the deck below the fill at {level:g} m")
    return elements


def fill_at_rest(model: Model, moving: Collection[str]) -> Model:
    """Return the model whose passive fill is held by another support than those that move."""
    other = next(name for name in model.supports if name not in moving)

    def held(one: Interface) -> Interface:
        moves = isinstance(one.joint, Backfill) and one.block_j in moving
        return replace(one, block_j=other) if moves else one

    return replace(model, interfaces=tuple(map(held, model.interfaces)))

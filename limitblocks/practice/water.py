"""Water in joints: uplift as a load on both blocks."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from limitblocks.errors import ModelError
from limitblocks.geometry import Interface
from limitblocks.geometry.polygon import areas, second_moments
from limitblocks.mechanics import Load
from limitblocks.mechanics.loads import force
from limitblocks.mechanics.loads.load import number
from limitblocks.model import Model

WATER = 9810.0  # N/m3


def uplift(
    model: Model,
    level: float,
    *,
    interfaces: Sequence[Interface] | None = None,
    unit_weight: float = WATER,
    share: float = 1.0,
) -> Load:
    """Return the pressure of water in joints below a level, as forces that push their blocks apart.

    The pressure ``share * unit_weight * (level - z)`` acts on the whole joint, normal to it; its resultant
    and its place are exact for joints that are under the level altogether.

    Parameters
    ----------
    model : Model
        The structure; add the load to its dead loads.
    level : float
        Of the water, Z in m.
    interfaces : sequence of Interface, optional
        The joints with water; all that lie below the level unless given.
    unit_weight : float
        N/m3.
    share : float
        Of the full pressure, 0 to 1, such as behind a drain.

    Raises
    ------
    ModelError
        If a number is out of range, or a given joint reaches above the level.
    """
    number(level, "level of the water", "m")
    weight = number(unit_weight, "unit weight of water", "N/m3", above=0.0)
    if not 0.0 < share <= 1.0:
        raise ModelError(f"share of the water pressure is {share!r}, expected more than 0 and at most 1")
    free = {block.name for block in model.free_blocks}
    total = Load()
    for own in model.interfaces if interfaces is None else interfaces:
        top = float((own.centroid + own.polygon @ own.axes[:2])[:, 2].max())
        if top > level:
            if interfaces is not None:
                raise ModelError(f"interface {own.name} reaches to {top:g} m, above the water at {level:g} m")
            continue
        area = float(areas(own.polygon))
        mean = share * weight * (level - own.centroid[2])
        if not mean > 0.0:
            continue
        slope = -share * weight * own.axes[:2, 2]  # of the pressure along s1, s2
        i11, i22, i12 = second_moments(own.polygon).tolist()
        off = np.array([[i11, i12], [i12, i22]]) @ slope / (mean * area)
        at, push = own.centroid + off @ own.axes[:2], mean * area * own.axes[2]
        for block, sign in ((own.block_i, -1.0), (own.block_j, 1.0)):
            if block in free:
                total = total + force(block, (sign * push).tolist(), at.tolist())
    return total

"""Water in joints: uplift as a load on both blocks."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np

from limitblocks.errors import ModelError, sequence_of
from limitblocks.geometry import Interface
from limitblocks.joints import Dowel, Guide, Tie
from limitblocks.mechanics import Load
from limitblocks.mechanics.loads import JointPressure
from limitblocks.mechanics.loads.faces import integrals, part_where
from limitblocks.mechanics.loads.load import number, of, vector
from limitblocks.model import Model, checked_model

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

    The pressure ``share * unit_weight * (level - z)`` acts normal to the joint on the part of it below the
    level; its resultant and its place, the centre of pressure, are exact. It acts on the structure as it is:
    capacity curves, verifications and settlements until collapse, in which joints turn and open, refuse it.

    Parameters
    ----------
    model : Model
        The structure; add the load to its dead loads.
    level : float
        Of the water, Z in m.
    interfaces : sequence of Interface, optional
        The joints with water; all that reach below the level unless given. Ties, strips, dowels and passive
        fill are no joints of blocks.
    unit_weight : float
        N/m3.
    share : float
        Of the full pressure, 0 to 1, such as behind a drain.

    Raises
    ------
    ModelError
        If a number is out of range, no joint or a given one does not reach below the level, or a given one is
        of an element or given twice.
    """
    checked_model(model)
    number(level, "level of the water", "m")
    weight = number(unit_weight, "unit weight of water", "N/m3", above=0.0)
    share = number(share, "share of the water pressure", "", above=0.0, most=1.0)
    given = model.interfaces if interfaces is None else sequence_of("interfaces", interfaces, Interface)
    if twice := [own.name for own, times in Counter(given).items() if times > 1]:
        raise ModelError(f"interface {twice[0]} is given twice, expected once")
    total = Load()
    for own in given:
        if isinstance(own.joint, Tie | Dowel | Guide):
            if interfaces is not None:
                raise ModelError(f"interface {own.name} is of a {own.joint.word}, in which there is no water")
            continue
        wet, depth = part_where(own.corners, level - own.corners[:, 2])
        push, first = integrals(wet - own.centroid, share * weight * depth, own.axes[2])
        if not push > 0.0:
            if interfaces is not None:
                raise ModelError(f"interface {own.name} lies above the water at {level:g} m")
            continue
        at = own.centroid + first / push
        on_j = vector((push * own.axes[2]).tolist(), "force")
        total = total + of(JointPressure(own.block_i, own.block_j, on_j, vector(at.tolist(), "at")))
    if not total.terms:
        lowest = min((own.corners[:, 2].min() for own in model.interfaces), default=np.inf)
        raise ModelError(f"no joint reaches below the water at {level:g} m; the lowest at {lowest:.4g} m")
    return total

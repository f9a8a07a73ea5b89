"""Joints of an answer that carry more moment by Eq. (39) than by the exact stress block."""

from __future__ import annotations

import numpy as np

from limitblocks.arrays import Array
from limitblocks.joints.stress_block import over_stress_block
from limitblocks.model import Model

SAID = 1.01  # of the moment of the stress block: from there it is told


def beyond_stress_block(model: Model, stress_resultants: Array) -> tuple[str, ...]:
    """Return a remark where stress resultants (m, 6) have more moment than the exact stress block has."""
    if not np.isfinite(stress_resultants).all():
        return ()
    over = {}
    for own, Q in zip(model.interfaces, stress_resultants, strict=True):
        strength = getattr(own.joint, "compressive_strength", None)
        if strength is not None:
            tension = getattr(own.joint, "counted_tension", 0.0)
            over[own.name] = over_stress_block(own.polygon, strength, Q, tension)
    told = [name for name in over if over[name] > SAID]
    if not told:
        return ()
    worst = max(told, key=over.__getitem__)
    where = "" if len(told) == 1 else f", the most of {len(told)} joints with too large a moment"
    return (
        f"crushing by Eq. (39): {worst} carries {over[worst]:.2f} times the moment of the exact stress "
        f"block{where}; the load factor may be too large",
    )

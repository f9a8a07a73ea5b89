"""Joints of an answer that carry more moment by Eq. (39) than by the exact stress block."""

from __future__ import annotations

from typing import Any

import numpy as np

from limitblocks.arrays import Array
from limitblocks.joints.stress_block import over_stress_block
from limitblocks.model import Model

SAID = 1.01  # of the moment of the stress block: from there it is told
TOO_LARGE = "the load factor may be too large"
ALONE = "it may stand by Eq. (39) alone"
MANY = 500  # interfaces at a time, some 100 kB each


def beyond_stress_block(model: Model, stress_resultants: Array, then: str = TOO_LARGE) -> tuple[str, ...]:
    """Return a remark where stress resultants (m, 6) have more moment than the exact stress block has.

    `then` is what it says follows.
    """
    if not np.isfinite(stress_resultants).all():
        return ()
    over: dict[str, float] = {}
    for alike in _crushing(model).values():
        for start in range(0, len(alike), MANY):
            some = alike[start : start + MANY]
            own = [model.interfaces[k] for k in some]
            strengths, tensions = np.array([_strengths(one.joint) for one in own]).T
            polygons = np.array([one.polygon for one in own])
            found = over_stress_block(polygons, strengths, stress_resultants[some], tensions, SAID)
            for one, times in zip(own, found.tolist(), strict=True):
                over[one.name] = max(over.get(one.name, 0.0), times)  # pieces of an area share a name
    told = [name for name in over if over[name] > SAID]
    if not told:
        return ()
    worst = max(told, key=over.__getitem__)
    where = "" if len(told) == 1 else f", the most of {len(told)} joints with too large a moment"
    piece = "a piece of " * (sum(one.name == worst for one in model.interfaces) > 1)
    return (
        f"crushing by Eq. (39): {piece}{worst} carries {over[worst]:.2f} times the moment of the exact "
        f"stress block{where}; {then}",
    )


def _crushing(model: Model) -> dict[int, list[int]]:
    """Return the places of the interfaces that can crush, by the number of their vertices."""
    alike: dict[int, list[int]] = {}
    for k, own in enumerate(model.interfaces):
        if getattr(own.joint, "compressive_strength", None) is not None:
            alike.setdefault(len(own.polygon), []).append(k)
    return alike


def _strengths(joint: Any) -> tuple[float, float]:
    """Return the compressive strength and the tensile one that counts, Pa."""
    return joint.compressive_strength, getattr(joint, "counted_tension", 0.0)

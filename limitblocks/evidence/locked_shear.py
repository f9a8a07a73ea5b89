"""Shear forces that polyhedral friction locks: without dilatancy they make the load factor an interval."""

from __future__ import annotations

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import few
from limitblocks.problem import Flow, State

TURNED = 1e-3  # radians between the shear force and the slip: less is accuracy
MOVING = 1e-6  # of the largest slip: less is no slip


def locked_shear(flow: Flow, state: State) -> tuple[str, ...]:
    """Return a remark for the interfaces whose polyhedral friction leaves a shear across the slip.

    On a facet of a polygon that stands for the Coulomb circle, the shear across the direction of slip may be
    anything within mu N tan(pi / sides): the load factor without dilatancy is then one of an interval.
    """
    p = flow.problem
    sliding = np.array([mode.slides for mode in p.row_mode])
    sliding[p.cones.linear :] = False  # cones lock nothing
    slip = -(flow.matrix(state.x).T @ np.where(sliding, state.y, 0.0))
    V1, V2 = p.resultants[0::6].tocsr(), p.resultants[1::6].tocsr()
    if flow.associated or not sliding.any() or V1.nnz != V2.nnz:
        return ()
    a, b = V1.indices, V2.indices  # the pairs of shear forces of interfaces or points
    rate, force = np.stack([slip[a], slip[b]]), np.stack([state.x[a], state.x[b]])
    speed = np.hypot(*rate) / p.units.interface_force[p.stress_interface[a]]
    across = np.abs(rate[0] * force[1] - rate[1] * force[0])
    turned = across > TURNED * np.hypot(*rate) * np.hypot(*force)
    locked = turned & (speed > MOVING * speed.max(initial=0.0)) & (np.hypot(*force) > MOVING)
    if not locked.any():
        return ()
    angle = _angle(rate[:, locked], force[:, locked])
    names = list(dict.fromkeys(p.interfaces[k] for k in p.stress_interface[a[locked]]))
    return (
        f"polyhedral friction locks a shear force across the slip at {few(names, 3)}, up to {angle:.0f} "
        "degrees off: without dilatancy the load factor is one of an interval; round friction ('exact') has "
        "one",
    )


def _angle(rate: Array, force: Array) -> float:
    """Largest angle in degrees between directions (2, k), whatever their sense."""
    cosine = np.abs((rate * force).sum(axis=0)) / (np.hypot(*rate) * np.hypot(*force))
    return float(np.degrees(np.arccos(np.clip(cosine, 0.0, 1.0))).max())

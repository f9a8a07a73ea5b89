"""Which joint of a model is meant: by its name, by a point on it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely

from limitblocks.analysis.anchors import BESIDE
from limitblocks.arrays import Array
from limitblocks.errors import ModelError, few, near
from limitblocks.geometry import Interface
from limitblocks.joints import Dowel, Guide, Tie
from limitblocks.model import Model


def off_joint(interface: Interface, point: Array) -> float:
    """Return the distance of a point from the polygon of an interface, m; 0 within 1e-3 of its size."""
    x1, x2, out = interface.axes @ (point - interface.centroid)
    off = float(np.hypot(shapely.distance(shapely.Polygon(interface.polygon), shapely.Point(x1, x2)), out))
    return off if off > BESIDE * np.abs(interface.polygon).max() else 0.0


def joints_named(model: Model, names: Sequence[str] = ()) -> list[Interface]:
    """Return the joints in which two blocks touch that have one of the names; all of them without names.

    A name may have the blocks in either order, unless there are joints of both.

    Raises
    ------
    ModelError
        If a name is of none.
    """
    touching = [one for one in model.interfaces if not isinstance(one.joint, Tie | Dowel | Guide)]
    known = {one.name for one in touching}
    turned = {f"{one.block_j}|{one.block_i}": one.name for one in touching}
    names = [name if name in known else turned.get(name, name) for name in names]
    if unknown := [name for name in names if name not in known]:
        known_ones = f"; there are {few(sorted(known))}" if known else "; there is none"
        raise ModelError(
            *(f"{name!r} is no joint of two blocks{near(name, known)}{known_ones}" for name in unknown)
        )
    return [one for one in touching if not names or one.name in names]


def joint_at(model: Model, point: Sequence[float], names: Sequence[str] = ()) -> Interface:
    """Return the joint nearest to a point, global axes, m, of those that have one of the names.

    Raises
    ------
    ModelError
        If the point lies on joints of several names, or a name is of none.
    """
    found = joints_named(model, names)
    if not found:
        raise ModelError("the model has no joint in which two blocks touch")
    off = [off_joint(one, np.asarray(point)) for one in found]
    least = min(off)
    met = {one.name: one for one, away in zip(found, off, strict=True) if away == least}
    if len(met) > 1:
        raise ModelError(f"{tuple(point)} is on the joints {' and '.join(met)}: say which of them")
    return next(iter(met.values()))

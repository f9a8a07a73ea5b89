"""Fill above an arch: its weight as such, its inertia as forces on what carries it."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from limitblocks.arrays import Array, real
from limitblocks.mechanics import Load
from limitblocks.mechanics.loads import fill as earth
from limitblocks.mechanics.loads import force, unit_vector
from limitblocks.structures.build import record, refuse


class Fill(NamedTuple):
    """Fill between the extrados and a level surface: a load, not blocks.

    Its weight is a dead load, vertical, on the extrados below it. `pressure` times the vertical pressure acts
    horizontally, too, as a dead load on what the extrados shows sideways. The live load gets `inertia` times
    the weight, along its direction and at the same points, since the load factor multiplies the weight of all
    that moves with the arch.

    Attributes
    ----------
    height : float
        Of the level surface above the crown of the extrados, m; 0 or more.
    unit_weight : float
        N/m3.
    pressure : float
        Horizontal over vertical pressure, 0 or more; 0: weight alone.
    inertia : float
        Part of its weight that joins the live load, 0 to 1.
    """

    height: float
    unit_weight: float = 18e3
    pressure: float = 0.0
    inertia: float = 1.0


def fill_loads(
    fill: Fill | None, surfaces: Sequence[tuple[str, Array]], depth: float, direction: Sequence[float]
) -> tuple[Load, Load]:
    """Return the dead and the live load of fill, or of none, over the crown, the highest of some surfaces.

    Parameters
    ----------
    fill : Fill, optional
    surfaces : sequence of (str, Array)
        Names of blocks and their upper edges: points (x, z) from left to right, shape (n, 2), m.
    depth : float
        Dimension along Y, m.
    direction : sequence of float
        Direction of the live load.

    Raises
    ------
    ModelError
        It names everything that makes the fill impossible.
    """
    if fill is None:
        return Load(), Load()
    fill = record(Fill, fill)
    _refuse_fill(fill)
    level = max(float(points[:, 1].max()) for _, points in surfaces) + fill.height
    push = fill.inertia * np.array(unit_vector(direction, "direction"))
    live = []
    for name, points in surfaces:
        for (x1, z1), (x2, z2) in pairwise(points.tolist()):
            top, end = level - z1, level - z2  # the fill over a facet is a trapezium
            mean = fill.unit_weight * depth * (top + end) / 2
            if mean * (x2 - x1) <= 0.0:
                continue
            along = (top + 2 * end) / (3 * (top + end))
            at = (x1 + along * (x2 - x1), 0.0, z1 + along * (z2 - z1))
            live.append(force(name, mean * (x2 - x1) * push, at))
    dead = earth(fill.unit_weight, level, earth_pressure=fill.pressure)
    return dead, sum(live, Load()) if fill.inertia else Load()


def _refuse_fill(fill: Fill) -> None:
    problems = [
        f"fill {name} is {value!r}, expected a number >= 0"
        for name, value in zip(fill._fields, fill, strict=True)
        if not 0.0 <= real(value) < np.inf
    ]
    if real(fill.inertia) > 1.0:
        problems.append(f"fill inertia is {fill.inertia!r}, expected a part of its weight, 0 to 1")
    refuse(problems)

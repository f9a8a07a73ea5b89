"""A state of the limit problem: stresses and mechanism, dimensionless."""

from __future__ import annotations

from dataclasses import dataclass

from limitblocks.arrays import Array


@dataclass(frozen=True, eq=False)
class State:
    """Load factor, generalised stresses x, displacement rates u and multipliers y of a LimitProblem."""

    load_factor: float
    x: Array
    u: Array
    y: Array

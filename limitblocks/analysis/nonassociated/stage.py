"""States of the limit problem, dimensionless, and the stages of the outer loop that reach them."""

from __future__ import annotations

from dataclasses import dataclass

from limitblocks.arrays import Array
from limitblocks.evidence.residuals import Residuals


@dataclass(frozen=True, eq=False)
class State:
    """Load factor, generalised stresses x, displacement rates u and multipliers y of a LimitProblem."""

    load_factor: float
    x: Array
    u: Array
    y: Array


@dataclass(frozen=True, eq=False)
class Stage:
    """One accepted state of the outer loop.

    `kind` is "step" (quasi-static), "jump" (a step with viscosity) or "fixed point"; `inner` counts Newton
    iterations or rounds, `failures` the attempts that failed before it.
    """

    state: State
    residuals: Residuals
    rho: float
    kind: str
    inner: int
    failures: int

"""Stages of the outer loop: the states it reaches, with their evidence."""

from __future__ import annotations

from dataclasses import dataclass

from limitblocks.evidence.residuals import Residuals
from limitblocks.problem import State


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

"""From a state near collapse to one that satisfies Eqs (54)-(59): a leap, else the fixed point."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from limitblocks.analysis.nonassociated.fixed_point import NearestStresses, fixed_point
from limitblocks.analysis.nonassociated.implicit_step import Loading, Point, StepResult, implicit_step
from limitblocks.analysis.nonassociated.settings import Settings
from limitblocks.analysis.nonassociated.stage import Stage
from limitblocks.evidence.residuals import Residuals, mcp_residuals
from limitblocks.problem import Flow, State

LEAP = 0.03  # of the tolerance: the flow residual that a leap aims at
FARTHEST = 300.0  # times the last step


class Reach(NamedTuple):
    """Where a step leads: the stage, the point it was computed at, the step, and the way back to yield."""

    stage: Stage
    point: Point
    loading: Loading
    nearest: NearestStresses
    accepted: bool


class Closing(NamedTuple):
    """A solution near a state and how far the load factor drifts to it."""

    stage: Stage | None
    drift: float


def reached(
    loading: Loading, nearest: NearestStresses, result: StepResult, kind: str, failures: int
) -> Reach:
    """The state of a step; a jump, whose viscosity strays from yield, is brought back to it."""
    problem, z = loading.problem, result.point
    state = State(z.load_factor, z.x, z.u, z.y)
    if kind == "jump":
        back = nearest.find(z.x, np.zeros_like(z.y))
        if back is not None:
            state = State(*back, z.u, z.y)
    proof = evidence(loading.flow, state)
    stage = Stage(state, proof, loading.rho, kind, result.iterations, failures)
    return Reach(stage, z, loading, nearest, result.accepted)


def leap(start: Reach, tolerance: float, settings: Settings) -> Reach:
    """One quasi-static step, so long that what compliance leaves of the flow is within the tolerance.

    Not accepted where the load factor drifts: so long a step may end at another solution.
    """
    z, before = start.point, start.stage
    aim = LEAP * tolerance
    size = before.rho * max(aim / max(before.residuals["flow"], aim), 1.0 / FARTHEST)
    loading = replace(start.loading, x0=z.x, y0=z.y, rho=size, damping=0.0)
    result = implicit_step(loading, settings.leap)
    near = _drift(z.load_factor, result.point.load_factor) <= settings.drift
    return reached(loading, start.nearest, result, "step", 0)._replace(accepted=result.accepted and near)


def closed(reach: Reach, tolerance: float, settings: Settings) -> Closing:
    """The solution that the fixed point finds near a state."""
    stage, z, loading = reach.stage, reach.point, reach.loading
    start, problem = State(z.load_factor, z.x, z.u, z.y), loading.problem
    for from_state in (stage.state, start) if stage.kind == "jump" else (start,):
        state, rounds = fixed_point(reach.nearest, from_state, loading.flow, tolerance, settings.rounds)
        if state is not None:
            proof = evidence(loading.flow, state)
            found = Stage(state, proof, loading.rho, "fixed point", rounds, 0)
            return Closing(found, _drift(start.load_factor, state.load_factor))
    return Closing(None, np.inf)


def _drift(before: float, after: float) -> float:
    """Relative change of the load factor."""
    return abs(after - before) / max(abs(before), abs(after), 1e-300)


def flow_before_return(reach: Reach) -> float:
    """Flow residual of a jump before its stresses were brought back to yield."""
    z, loading = reach.point, reach.loading
    return evidence(loading.flow, State(z.load_factor, z.x, z.u, z.y))["flow"]


def evidence(flow: Flow, state: State) -> Residuals:
    """Residuals of Eqs (54)-(59)."""
    return mcp_residuals(flow, state)

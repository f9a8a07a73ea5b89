"""Outer loop: implicit steps from the permanent loads to collapse, closed by a leap or the fixed point."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from limitblocks.analysis.nonassociated.closing import (
    Closing,
    Reach,
    closed,
    evidence,
    flow_before_return,
    leap,
    reached,
)
from limitblocks.analysis.nonassociated.fixed_point import NearestStresses
from limitblocks.analysis.nonassociated.implicit_step import Loading, implicit_step
from limitblocks.analysis.nonassociated.interface_blocks import InterfaceBlocks
from limitblocks.analysis.nonassociated.settings import Settings
from limitblocks.analysis.nonassociated.stage import Stage
from limitblocks.arrays import Array
from limitblocks.problem import Flow, LimitProblem

log = logging.getLogger(__name__)

Progress = Callable[[Stage], None]
SOFTENING = 1e-3  # of the force of an interface: the epsilon of Table 5 while stepping
EXACT = 1e-12  # and in the evidence
AGAIN = 0.25  # of the flow residual where closing was last tried: from here the next try is worth its cost


def stages(
    flow: Flow,
    x0: Array,
    weights: Array,
    tolerance: float,
    settings: Settings,
    scale: float,
    progress: Progress | None = None,
) -> list[Stage]:
    """Accepted states from the stresses `x0` on; the last is within `tolerance` if the loop converged.

    `scale` is the load factor that steps are measured by, the associated one.
    """
    problem = flow.problem
    first = 1.0 / (elastic_work(problem, weights) * scale)  # rho of a step of one
    blocks = InterfaceBlocks(problem)

    def judged(stage: Stage) -> Stage:
        return replace(stage, residuals=evidence(replace(flow, softening=EXACT), stage.state))

    def report(stage: Stage) -> None:
        _log(stage)
        if progress is not None:
            progress(judged(stage))

    softened = replace(flow, softening=SOFTENING)
    task = _Task(softened, blocks, weights, tolerance, settings, first, NearestStresses(problem, weights))
    return [judged(stage) for stage in _followed(task, x0, report)]


def elastic_work(problem: LimitProblem, weights: Array) -> float:
    """Work of the live load at load factor one on elastic joints of compliance `weights`."""
    K = problem.C.T @ sparse.diags_array(1.0 / weights) @ problem.C + 1e-12 * sparse.eye_array(
        len(problem.live)
    )
    return float(problem.live @ linalg.spsolve(sparse.csc_array(K), problem.live))


class _Task(NamedTuple):
    """What stays the same from step to step; `first` is the rho of a step of one."""

    flow: Flow
    blocks: InterfaceBlocks
    weights: Array
    tolerance: float
    settings: Settings
    first: float
    nearest: NearestStresses

    def loading(self, x: Array, y: Array, rho: float, viscosity: float) -> Loading:
        """The step of size 1 / rho from the state (x, y)."""
        return Loading(self.flow, self.blocks, self.weights, x, y, rho, viscosity / rho)


class _Pace(NamedTuple):
    """Size of the next step, which retry it begins with, what failed before it, and iterations spent."""

    rho: float
    level: int = 0
    failures: int = 0
    used: int = 0


def _followed(task: _Task, x0: Array, report: Progress) -> list[Stage]:
    """Accepted states from the stresses `x0` on, of steps, jumps and the solution that closes them."""
    settings = task.settings
    x, y, pace = x0, np.zeros(len(task.flow.problem.g)), _Pace(task.first / settings.first)
    found: list[Stage] = []
    kept, tried, budget = Closing(None, np.inf), np.inf, settings.budget
    while True:
        reach, pace = _stepped(task, x, y, pace, budget)
        if reach is None:
            break
        found.append(reach.stage)
        report(reach.stage)
        if reach.stage.residuals.worst.value <= task.tolerance:
            return found
        worth = _worth(settings, reach, tried)
        closing = closed(reach, task.tolerance, settings) if worth else kept
        if closing.stage and closing.drift < kept.drift:
            budget = budget if kept.stage else min(budget, pace.used + settings.patience)
            kept = closing
            if closing.drift <= settings.drift:
                break
        following = _next(task, reach.stage, pace)
        if worth and _smooth(reach.stage) and settings.leap:
            tried = reach.stage.residuals["flow"]
            reach, following = _leapt(task, reach, following)
            if reach.stage is not found[-1]:
                found.append(reach.stage)
                report(reach.stage)
                if reach.stage.residuals.worst.value <= task.tolerance:
                    return found
        x, y, pace = reach.point.x, reach.point.y, following
    if kept.stage:
        report(kept.stage)
        found.append(kept.stage)
    return found


def _leapt(task: _Task, reach: Reach, pace: _Pace) -> tuple[Reach, _Pace]:
    """Where a leap leads and the pace after it; the state given where it fails."""
    far = leap(reach, task.tolerance, task.settings)
    pace = pace._replace(used=pace.used + far.stage.inner)
    return (far, pace._replace(rho=far.loading.rho)) if far.accepted else (reach, pace)


def _smooth(stage: Stage) -> bool:
    return stage.kind == "step" and not stage.failures


def _worth(settings: Settings, reach: Reach, tried: float) -> bool:
    """Whether a state is so close to collapse that closing may succeed.

    Where the next step is cheaper than a round, it must be well beyond the state of the last try.
    """
    if _smooth(reach.stage):
        return reach.stage.residuals["flow"] < min(settings.close, AGAIN * tried)
    return flow_before_return(reach) < settings.near


def _stepped(task: _Task, x: Array, y: Array, pace: _Pace, budget: int) -> tuple[Reach | None, _Pace]:
    """The next accepted step from (x, y), smaller or with viscosity where it fails; None if none is left."""
    settings = task.settings
    while pace.used < budget:
        factor, viscosity = settings.retries[pace.level]
        loading = task.loading(x, y, factor * pace.rho, viscosity)
        result = implicit_step(loading, settings.iterations)
        pace = pace._replace(used=pace.used + max(result.iterations, 1))
        if result.accepted:
            kind = "jump" if viscosity else "step"
            return reached(loading, task.nearest, result, kind, pace.failures), pace._replace(rho=loading.rho)
        log.info("step rho %.2g viscosity %.0e failed after %d", loading.rho, viscosity, result.iterations)
        pace = pace._replace(failures=pace.failures + 1, level=pace.level + 1)
        if pace.level == len(settings.retries):
            pace = pace._replace(rho=settings.growth * pace.rho, level=min(1, pace.level - 1))
    return None, pace


def _next(task: _Task, stage: Stage, pace: _Pace) -> _Pace:
    """The pace after an accepted step: longer after a success, with less viscosity after a jump."""
    settings, rho = task.settings, pace.rho
    if not pace.failures:
        longest = settings.last if stage.residuals["flow"] < 1e-3 else settings.longest
        rho = min(rho, max(rho / settings.growth, task.first / longest))  # after a leap no shorter than it
    level = max(0, pace.level - 1) if stage.kind == "jump" else 0
    return _Pace(rho, level, 0, pace.used)


def _log(stage: Stage) -> None:
    worst = stage.residuals.worst
    log.info(
        "%s rho %.2g: load factor %.6g, %s %.1e",
        stage.kind,
        stage.rho,
        stage.state.load_factor,
        worst.name,
        worst.value,
    )

"""Outer loop: implicit steps from the permanent loads to collapse, closed by the fixed point."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from limitblocks.analysis.fixed_point import fixed_point, nearest_stresses
from limitblocks.analysis.implicit_step import Loading, Point, StepResult, implicit_step
from limitblocks.analysis.interface_blocks import InterfaceBlocks
from limitblocks.analysis.mcp import mcp_residuals
from limitblocks.analysis.residuals import SMALL_LOAD, Residuals
from limitblocks.analysis.states import State
from limitblocks.arrays import Array
from limitblocks.mechanics import LimitProblem

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Settings:
    """How the outer loop steps; all numbers are dimensionless.

    Attributes
    ----------
    first : float
        First step, as the load factor it would add to elastic joints over the associated load factor.
    growth : float
        Steps grow by this factor after a success, and shrink by it where every retry failed.
    longest, last : float
        Longest step until the flow residual is 1e-3, and after that.
    retries : tuple of (float, float)
        (divisor of the step, viscosity of the multipliers) tried in turn; the first is the plain
        quasi-static step, a divisor above one a smaller step, a viscosity a jump across a snap.
    near, close : float
        Flow residual below which the fixed point is tried, where steps fail and where they do not.
    drift : float
        Change of the load factor, relative, up to which the fixed point belongs to the state it started
        from; farther solutions are kept in case the steps find nothing better.
    rounds : int
        Rounds of the fixed point.
    iterations, budget, patience : int
        Newton iterations of one step, of all together, and after the first solution kept.
    """

    first: float = 0.4
    growth: float = 3.0
    longest: float = 50.0
    last: float = 5e3
    retries: tuple[tuple[float, float], ...] = ((1.0, 0.0), (1.0, 1e-4), (1.0, 1e-3), (1.0, 1e-2))
    near: float = 0.1
    close: float = 1e-2
    drift: float = 1e-3
    rounds: int = 10
    iterations: int = 60
    budget: int = 1000
    patience: int = 300


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


Progress = Callable[[Stage], None]


def stages(
    problem: LimitProblem,
    x0: Array,
    weights: Array,
    dilatancy: float,
    tolerance: float,
    settings: Settings,
    scale: float,
    progress: Progress | None = None,
) -> list[Stage]:
    """Accepted states from the stresses `x0` on; the last is within `tolerance` if the loop converged.

    `scale` is the load factor that steps are measured by, the associated one.
    """
    unit = 1.0 / (elastic_work(problem, weights) * scale)  # rho of a step of one
    blocks = InterfaceBlocks(problem)
    x, y = x0, np.zeros(len(problem.g))
    found: list[Stage] = []
    kept: tuple[Stage, float] | None = None
    rho, level, failures, used, budget = unit / settings.first, 0, 0, 0, settings.budget
    while used < budget:
        factor, viscosity = settings.retries[level]
        size = factor * rho
        loading = Loading(problem, blocks, weights, x, y, size, viscosity / size, dilatancy)
        result = implicit_step(loading, settings.iterations)
        used += max(result.iterations, 1)
        if not result.accepted:
            log.info("step rho %.2g viscosity %.0e failed after %d", size, viscosity, result.iterations)
            failures, level = failures + 1, level + 1
            if level == len(settings.retries):
                rho, level = settings.growth * rho, min(1, level - 1)
            continue
        stage = _stage(loading, result, "jump" if viscosity else "step", failures)
        found.append(stage)
        _report(stage, progress)
        closed = _closed(loading, stage, result.point, tolerance, settings)
        if stage.residuals.worst.value <= tolerance or (closed and closed[1] <= settings.drift):
            return [*found, closed[0]] if closed else found
        if closed and (kept is None or closed[1] < kept[1]):
            budget = min(budget, used + settings.patience) if kept is None else budget
            kept = closed
        x, y, rho = result.point.x, result.point.y, size
        if not failures:
            longest = settings.last if stage.residuals["flow"] < 1e-3 else settings.longest
            rho = max(rho / settings.growth, unit / longest)
        level, failures = max(0, level - 1) if viscosity else 0, 0
    return [*found, kept[0]] if kept else found


def elastic_work(problem: LimitProblem, weights: Array) -> float:
    """Work of the live load at load factor one on elastic joints of compliance `weights`."""
    K = problem.C.T @ sparse.diags_array(1.0 / weights) @ problem.C + 1e-12 * sparse.eye_array(
        len(problem.live)
    )
    return float(problem.live @ linalg.spsolve(sparse.csc_array(K), problem.live))


def _closed(
    loading: Loading, stage: Stage, z: Point, tolerance: float, settings: Settings
) -> tuple[Stage, float] | None:
    """The solution that the fixed point finds near a state, and how far the load factor drifts to it."""
    start, problem = State(z.load_factor, z.x, z.u, z.y), loading.problem
    flow = _evidence(problem, start, loading.dilatancy)["flow"]
    smooth = stage.kind == "step" and not stage.failures  # the next step is cheaper than a round
    if flow >= (settings.close if smooth else settings.near) or stage.residuals.worst.value <= tolerance:
        return None
    for from_state in (stage.state, start) if stage.kind == "jump" else (start,):
        state, rounds = fixed_point(
            problem, from_state, loading.weights, loading.dilatancy, tolerance, settings.rounds
        )
        if state is not None:
            drift = abs(state.load_factor - start.load_factor) / max(abs(start.load_factor), SMALL_LOAD)
            evidence = _evidence(problem, state, loading.dilatancy)
            return Stage(state, evidence, loading.rho, "fixed point", rounds, 0), drift
    return None


def _stage(loading: Loading, result: StepResult, kind: str, failures: int) -> Stage:
    """The state of an accepted step; a jump, whose viscosity strays from yield, is brought back to it."""
    problem, z = loading.problem, result.point
    state = State(z.load_factor, z.x, z.u, z.y)
    if kind == "jump":
        back = nearest_stresses(problem, z.x, np.zeros_like(z.y), loading.weights)
        if back is not None:
            state = State(*back, z.u, z.y)
    evidence = _evidence(problem, state, loading.dilatancy)
    return Stage(state, evidence, loading.rho, kind, result.iterations, failures)


def _evidence(problem: LimitProblem, state: State, dilatancy: float) -> Residuals:
    return mcp_residuals(problem, state.load_factor, state.x, state.u, state.y, dilatancy)


def _report(stage: Stage, progress: Progress | None) -> None:
    worst = stage.residuals.worst
    log.info(
        "%s rho %.2g: load factor %.6g, %s %.1e",
        stage.kind,
        stage.rho,
        stage.state.load_factor,
        worst.name,
        worst.value,
    )
    if progress is not None:
        progress(stage)

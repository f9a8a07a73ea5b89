"""The ways from the permanent loads to a solution, one tried after the other."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from limitblocks.analysis.nonassociated.means import (
    SOFTENING,
    TURNED_MEANS,
    TURNED_SOFTENING,
    Means,
    follow,
)
from limitblocks.analysis.nonassociated.path_record import INTERRUPTED, Progress
from limitblocks.analysis.polish import polish
from limitblocks.arrays import Array
from limitblocks.evidence.residuals import mcp_residuals
from limitblocks.evidence.results import Iteration
from limitblocks.problem import Flow, LimitProblem, State, Turning


def first_to_solve(
    flow: Flow,
    x0: Array,
    scale: float,
    means: Sequence[Means],
    tolerance: float,
    record: Callable[[Iteration], None],
) -> tuple[State, str]:
    """The state to which one way after the other leads, and which it was: the load path comes first."""
    met: list[tuple[State, str]] = []
    for state, how in _ways(flow, x0, scale, means, tolerance, record):
        met.append((state, how))
        if mcp_residuals(flow, state).worst.value <= tolerance:
            return met[-1]
        if how.endswith(INTERRUPTED):
            break
    # what solves all equations but gives power comes next
    state, way = min(met, key=lambda one: left_over(flow, one[0], tolerance))
    interrupted = how.endswith(INTERRUPTED) and not way.endswith(INTERRUPTED)
    return state, f"{way}, {INTERRUPTED}" if interrupted else way


def _ways(
    flow: Flow,
    x0: Array,
    scale: float,
    means: Sequence[Means],
    tolerance: float,
    record: Callable[[Iteration], None],
) -> Iterator[tuple[State, str]]:
    """Polished ends of one way after the other, and which way it was."""
    problem, weights = flow.problem, flow.problem.compliance
    power = scale / len(problem.blocks)

    def tracked(one: Means, x: Array, softening: float = SOFTENING) -> tuple[State, str]:
        smooth = replace(flow, softening=softening)
        state, (info,) = follow(
            smooth, x, weights, means=[one], power=power, progress=lambda at: record(_point(problem, at))
        )
        return polish(flow, state), f"{info.how}, {INTERRUPTED}" if info.interrupted else info.how

    yield tracked(means[0], x0)
    if len(means) == 1:
        return
    if not flow.dissipative:
        centroid = replace(flow, turning=Turning.CENTROID)
        near, way = first_to_solve(centroid, x0, scale, means, tolerance, record)
        if way.endswith(INTERRUPTED):
            yield near, way
        for one in TURNED_MEANS:
            state, how = tracked(one, near.x, TURNED_SOFTENING)
            yield state, f"from the solution that twists about the centroid, {how}"
    for one in means[1:]:
        yield tracked(one, x0)


def left_over(flow: Flow, state: State, tolerance: float) -> tuple[bool, float]:
    """Whether more than the dissipation is above the tolerance, and the worst residual."""
    left = mcp_residuals(flow, state)
    return any(one.name != "dissipation" for one in left.above(tolerance)), left.worst.value


def _point(problem: LimitProblem, at: Progress) -> Iteration:
    """What a point of the path tells the user."""
    load_factor = at.load_factor / problem.units.live
    return Iteration(load_factor, "path", at.theta, {"theta": at.theta}, at.factorisations, 0)

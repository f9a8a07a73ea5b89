"""The ways from the permanent loads to a solution, one tried after the other."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import islice

import numpy as np

from limitblocks.analysis.nonassociated.closing import NEAR, Closing
from limitblocks.analysis.nonassociated.loading import Pushed, pushed
from limitblocks.analysis.nonassociated.means import (
    LARGE_HALF_MEANS,
    LARGE_MEANS,
    LARGE_PLANAR_MEANS,
    LARGEST_MEANS,
    MEANS,
    SOFTENING,
    TURNED_MEANS,
    TURNED_SOFTENING,
    Means,
    follow,
)
from limitblocks.analysis.nonassociated.path_equations import Barrier
from limitblocks.analysis.nonassociated.path_record import INTERRUPTED, Progress
from limitblocks.analysis.nonassociated.settings import Settings
from limitblocks.analysis.pivot import pivoted
from limitblocks.analysis.polish import defect, polish, polished
from limitblocks.arrays import Array
from limitblocks.evidence.residuals import Residuals, mcp_residuals
from limitblocks.evidence.results import Iteration
from limitblocks.problem import Flow, LimitProblem, State, Turning

LARGE = 100  # blocks in space: beyond it long paths take more than 40 times as long as bounds
LARGEST = 300  # beyond it one path takes what time there is
LARGE_IN_PLANE = 500  # beyond it increments take 35 times as long as bounds
SMALL = Barrier().size
Record = Callable[[Iteration], None]  # tells the user
Half = Callable[[], tuple[State, str] | None]  # what is found in one half of a symmetric structure
STEPS = Settings(growth=2.0, left=1e-5, budget=2500)  # the load path in larger and coarser increments


def no_half() -> None:
    """No half: what is not symmetric, or is reduced already."""


def first_to_solve(
    flow: Flow,
    x0: Array,
    scale: float,
    means: Sequence[Means],
    tolerance: float,
    record: Record,
    enough: Callable[[State], bool] = lambda _: False,
    half: Half = no_half,
    first: bool = False,
) -> tuple[State, str]:
    """The state to which one way after the other leads, and which it was: the load path comes first.

    If there are further means, `half` comes second. Where the `first` path is asked for it is followed alone.

    Of a large model a state that is near `enough` ends the search as well, but for the end of the first path.
    """
    met: list[tuple[State, str]] = []
    blocks, in_space = len(flow.problem.blocks), _in_space(flow)
    large = means is MEANS and blocks > LARGE and in_space and flow.dissipative
    large_in_plane = means is MEANS and blocks > LARGE_IN_PLANE and not in_space
    if means is MEANS and half is no_half:  # in a plane or one half points cost little
        means = tuple(one._replace(patience=None) for one in MEANS)
    if large:
        large_means = LARGEST_MEANS if blocks > LARGEST else LARGE_MEANS
        large_means = LARGE_HALF_MEANS if half is no_half else large_means
        ways = _large_ways(flow, x0, scale, large_means, tolerance, record)
    elif large_in_plane:
        ways = _large_planar_ways(flow, x0, scale, tolerance, record)
    else:
        ways = _ways(flow, x0, scale, means, tolerance, record)
    if first:  # that of a large model comes without rounds and with them
        ways = islice(ways, 2 if large else 1)
    elif len(means) > 1:
        ways = _then(ways, half, flow, tolerance)
    for state, how in ways:
        met.append((state, how))
        if mcp_residuals(flow, state).worst.value <= tolerance:
            return met[-1]
        if how.endswith(INTERRUPTED) or (large and len(met) > 1 and enough(state)):
            break
    # what solves all equations but gives power comes next
    state, way = min(met, key=lambda one: left_over(mcp_residuals(flow, one[0]), tolerance))
    interrupted = how.endswith(INTERRUPTED) and not way.endswith(INTERRUPTED)
    return state, f"{way}, {INTERRUPTED}" if interrupted else way


def _then(
    ways: Iterator[tuple[State, str]], half: Half, flow: Flow, tolerance: float
) -> Iterator[tuple[State, str]]:
    """The first way, then one half, polished in the whole, then the other ways."""
    yield next(ways)
    found = half()
    if found is not None:
        wanting = defect(flow, found[0]) > tolerance  # residuals of the half may double in the whole
        yield _polished(flow, *found, tolerance) if wanting else found
    yield from ways


def _ways(
    flow: Flow, x0: Array, scale: float, means: Sequence[Means], tolerance: float, record: Record
) -> Iterator[tuple[State, str]]:
    """Polished ends of one way after the other, and which way it was."""

    def tracked(one: Means) -> tuple[State, str]:
        return _polished(flow, *_tracked(flow, x0, scale, one, record), tolerance)

    first = tracked(means[0])
    yield first
    if len(means) == 1:
        return
    if not flow.dissipative:
        yield from _from_centroid(flow, x0, scale, means, tolerance, record)
    for one in means[1:]:
        if one.barrier.size <= SMALL:
            yield tracked(one)
    larger = (tracked(one) for one in means[1:] if one.barrier.size > SMALL)
    if _in_space(flow):
        yield from larger
        yield _in_rounds(Closing(flow, tolerance), *first)
    else:  # in a plane they cost little
        yield _increments(flow, x0, scale, tolerance, record)
    yield from larger


def _from_centroid(
    flow: Flow, x0: Array, scale: float, means: Sequence[Means], tolerance: float, record: Record
) -> Iterator[tuple[State, str]]:
    """Polished ends of paths from the solution that twists about the centroid, and which they were."""
    centroid = replace(flow, turning=Turning.CENTROID)
    near, way = first_to_solve(centroid, x0, scale, means, tolerance, record)
    if way.endswith(INTERRUPTED):
        yield near, way
    for one in TURNED_MEANS:
        end = _tracked(flow, near.x, scale, one, record, TURNED_SOFTENING)
        state, how = _polished(flow, *end, tolerance)
        yield state, f"from the solution that twists about the centroid, {how}"


def _polished(flow: Flow, state: State, how: str, tolerance: float) -> tuple[State, str]:
    """The end of a path polished, or closed by pivots where it is near, unless the user stopped it.

    A path of this very flow has tried the polish of an end that is farther off; what it leaves of one that
    is near enough takes steps of least norm, which may cost as much as the path.
    """
    left = defect(flow, state)
    if how.endswith(INTERRUPTED) or left <= tolerance / 10 or (flow.constant and left > NEAR):
        return state, how
    try:
        if flow.constant and left > tolerance:
            return polish(flow, pivoted(flow, state)), how
        return polished(flow, state, left)[0], how
    except KeyboardInterrupt:
        return state, f"{how}, {INTERRUPTED}"


def _in_space(flow: Flow) -> bool:
    """Whether blocks have more rates that move joints than the three of a plane."""
    return len(np.unique(flow.problem.C.indices)) > 3 * len(flow.problem.blocks)


def _large_ways(
    flow: Flow, x0: Array, scale: float, means: Sequence[Means], tolerance: float, record: Record
) -> Iterator[tuple[State, str]]:
    """Ends of the paths for large models, closed by rounds of the fixed point, and which way it was.

    That of the first comes without rounds as well: one half costs less, and follows the load path.
    """
    closing = Closing(flow, tolerance)
    for one in means:
        state, how = _tracked(flow, x0, scale, one, record, closing=closing)
        ended = how.endswith(INTERRUPTED) or defect(flow, state) <= tolerance
        if ended or one is means[0]:
            yield state, how
        if not ended:
            yield _in_rounds(closing, state, how)


def _large_planar_ways(
    flow: Flow, x0: Array, scale: float, tolerance: float, record: Record
) -> Iterator[tuple[State, str]]:
    """Ends of the paths for large models in a plane; rounds take off the compliance left, 1e-8 of flow."""
    for one in LARGE_PLANAR_MEANS:
        end = _tracked(flow, x0, scale, one, record)
        yield end
    yield _in_rounds(Closing(flow, tolerance), *end)
    yield _increments(flow, x0, scale, tolerance, record)


def _tracked(
    flow: Flow,
    x: Array,
    scale: float,
    one: Means,
    record: Record,
    softening: float = SOFTENING,
    closing: Closing | None = None,
) -> tuple[State, str]:
    """The end of one path from stresses x, and which path it was."""
    problem = flow.problem
    state, (info,) = follow(
        replace(flow, softening=softening),
        x,
        problem.compliance,
        means=[one],
        power=scale / len(problem.blocks),
        progress=lambda at: record(_point(problem, at)),
        closing=closing,
    )
    how = f"{info.how}{closing.how}" if closing and state is closing.solution else info.how
    return state, f"{how}, {INTERRUPTED}" if info.interrupted else how


def _in_rounds(closing: Closing, state: State, how: str) -> tuple[State, str]:
    """The end of a path closed by rounds, and how; the path's own where the user stops it."""
    try:
        return closing(state), how + closing.how
    except KeyboardInterrupt:
        return state, f"{how}, {INTERRUPTED}"


def _increments(flow: Flow, x0: Array, scale: float, tolerance: float, record: Record) -> tuple[State, str]:
    """The end of the load path, pushed increment by increment; the last one where the user stops it."""
    problem, how = flow.problem, "increments of the load path"
    met = [State(0.0, x0, np.zeros(problem.C.shape[1]), np.zeros(len(problem.g)))]

    def tell(one: Pushed) -> None:
        met.append(one.state)
        record(one.told(problem.units.live))

    try:
        return pushed(flow, x0, problem.compliance, tolerance, STEPS, scale, tell)[1], how
    except KeyboardInterrupt:
        return met[-1], f"{how}, {INTERRUPTED}"


def left_over(left: Residuals, tolerance: float) -> tuple[bool, float]:
    """Whether more than the dissipation is above the tolerance, and the worst residual."""
    return any(one.name != "dissipation" for one in left.above(tolerance)), left.worst.value


def _point(problem: LimitProblem, at: Progress) -> Iteration:
    """What a point of the path tells the user."""
    load_factor = at.load_factor / problem.units.live
    return Iteration(load_factor, "path", at.theta, {"theta": at.theta}, at.factorisations, 0)

"""Which way from the permanent loads comes when, and which end is the answer."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import islice

import numpy as np

from limitblocks.analysis.nonassociated.closing import Closing
from limitblocks.analysis.nonassociated.each_way import SMALL, Given, Way
from limitblocks.analysis.nonassociated.means import (
    LARGE_MEANS,
    LARGE_PLANAR_MEANS,
    LARGEST_MEANS,
    MEANS,
    REDUCED_MEANS,
    SPATIAL_MEANS,
    TURNED_MEANS,
    TURNED_SOFTENING,
    Means,
)
from limitblocks.analysis.nonassociated.path_record import CLIMBING, INTERRUPTED, UNSETTLED
from limitblocks.analysis.nonassociated.settling import exact_nearby
from limitblocks.analysis.polish import defect
from limitblocks.evidence.residuals import Residuals, mcp_residuals
from limitblocks.problem import Flow, State, Turning

LARGE = 100  # blocks in space: beyond it long paths take more than 40 times as long as bounds
FAR = 1.0  # residual of the end of a path: from nine ends farther off, of groin vaults, rounds close none
LARGEST = 300  # beyond it one path takes what time there is
LARGE_IN_PLANE = 500  # beyond it increments take 35 times as long as bounds
Half = Callable[[], Way | None]  # what is found in one half of a symmetric structure


def no_half() -> None:
    """No half: what is not symmetric, or is reduced already."""


def first_to_solve(
    given: Given,
    means: Sequence[Means],
    enough: Callable[[State], bool] = lambda _: False,
    half: Half = no_half,
    first: bool = False,
) -> Way:
    """The state to which one way after the other leads, and which it was: the load path comes first.

    If there are further means, `half` comes second. Where the `first` path is asked for it is followed alone.

    After a path whose load factor still changed, only what is exact for a model nearby is a solution.
    Of a large model a state that is near `enough` ends the search as well, but for the end of the first path.
    """
    flow, met = given.flow, list[Way]()
    if means is MEANS:
        means = means_of(flow, half is no_half)
    large = means in (LARGE_MEANS, LARGEST_MEANS)
    if large:
        ways = _large_ways(given, means[:1] if first else means)
    elif means is LARGE_PLANAR_MEANS:
        ways = _large_planar_ways(given)
    else:
        ways = _ways(given, means, half is no_half)
    if first and not large:
        ways = islice(ways, 1)
    elif not first and len(means) > 1:
        ways = _then(ways, half, given)
    for state, how in ways:
        met.append((state, how))
        if _solved(given, met):
            return met[-1]
        if how.endswith(INTERRUPTED) or (large and len(met) > 1 and enough(state)):
            break
    # what solves all equations but gives power comes next
    state, way = min(met, key=lambda one: left_over(mcp_residuals(flow, one[0]), given.tolerance))
    for said in (UNSETTLED, CLIMBING):
        way += f", {said}" * (_said(met, said) and said not in way)
    interrupted = how.endswith(INTERRUPTED) and not way.endswith(INTERRUPTED)
    return state, f"{way}, {INTERRUPTED}" if interrupted else way


def _solved(given: Given, met: Sequence[Way]) -> bool:
    """Whether the last way met leads to a solution."""
    state, how = met[-1]
    if UNSETTLED in how or mcp_residuals(given.flow, state).worst.value > given.tolerance:
        return False
    return not _said(met, UNSETTLED) or exact_nearby(given.flow, state)


def _said(met: Sequence[Way], end: str) -> bool:
    """Whether a way ended so."""
    return any(end in how for _, how in met)


def means_of(flow: Flow, reduced: bool = False) -> Sequence[Means]:
    """The paths to follow for a flow rule where none are given; reduced: to a plane or one half."""
    return own_means(len(flow.problem.blocks), _in_space(flow), flow.dissipative, reduced)


def own_means(blocks: int, in_space: bool, dissipative: bool, reduced: bool) -> Sequence[Means]:
    """The paths to follow where none are given, by the number of blocks; reduced: to a plane or one half."""
    if in_space and dissipative and blocks > LARGE:
        return LARGEST_MEANS if blocks > LARGEST and not reduced else LARGE_MEANS
    if not in_space and blocks > LARGE_IN_PLANE:
        return LARGE_PLANAR_MEANS
    if reduced:
        return REDUCED_MEANS
    return SPATIAL_MEANS if in_space and dissipative else MEANS


def _in_space(flow: Flow) -> bool:
    """Whether blocks have more rates that move joints than the three of a plane."""
    return len(np.unique(flow.problem.C.indices)) > 3 * len(flow.problem.blocks)


def _then(ways: Iterator[Way], half: Half, given: Given) -> Iterator[Way]:
    """The first way, then one half, polished in the whole, then the other ways."""
    yield next(ways)
    found = half()
    if found is not None:
        wanting = defect(given.flow, found[0]) > given.tolerance  # residuals may double in the whole
        yield given.polished(*found) if wanting else found
    yield from ways


def _ways(given: Given, means: Sequence[Means], reduced: bool) -> Iterator[Way]:
    """Polished ends of one way after the other, and which way it was; reduced: to a plane or one half."""

    def tracked(one: Means) -> Way:
        return given.polished(*given.tracked(one))

    first = tracked(means[0])
    yield first
    if len(means) == 1:
        return
    if not given.flow.dissipative:
        yield from _from_centroid(given, means)
    for one in means[1:]:
        if one.barrier.size <= SMALL:
            yield tracked(one)
    larger = (tracked(one) for one in means[1:] if one.barrier.size > SMALL)
    if _in_space(given.flow):
        yield from larger
        yield given.closed_in_rounds(*first)
        if reduced:  # the whole comes next
            return
    yield given.increments()  # in a plane they cost little
    yield from larger
    yield given.frozen()


def _from_centroid(given: Given, means: Sequence[Means]) -> Iterator[Way]:
    """Polished ends of paths from the solution that twists about the centroid, and which they were."""
    near, way = first_to_solve(replace(given, flow=replace(given.flow, turning=Turning.CENTROID)), means)
    if way.endswith(INTERRUPTED):
        yield near, way
    start = replace(given, x0=near.x)
    for one in TURNED_MEANS:
        state, how = given.polished(*start.tracked(one, TURNED_SOFTENING))
        yield state, f"from the solution that twists about the centroid, {how}"


def _large_ways(given: Given, means: Sequence[Means]) -> Iterator[Way]:
    """Ends of the paths for large models, closed by rounds of the fixed point, and which way it was.

    That of the first comes without rounds as well: one half costs less, and follows the load path. So does
    the path in displacements: a facade of 223 blocks pushed along ends at .182, by rounds of the first .125.
    Beyond 300 blocks rounds come before it: they close a facade of 508 pushed along in 2.6 times its bounds.
    """
    closing = Closing(given.flow, given.tolerance)
    for one in means:
        state, how = given.tracked(one, closing=closing)
        left, first = defect(given.flow, state), one is means[0]
        ended = how.endswith(INTERRUPTED) or left <= given.tolerance
        if ended or first:
            yield state, how
        largest = len(given.flow.problem.blocks) > LARGEST
        if first and not largest:
            yield from given.displaced(closing)
        if not ended and left < FAR:
            yield given.closed_in_rounds(state, how, closing)
        if first and largest:
            yield from given.displaced(closing)


def _large_planar_ways(given: Given) -> Iterator[Way]:
    """Ends of the paths for large models in a plane; rounds take off the compliance left, 1e-8 of flow."""
    for one in LARGE_PLANAR_MEANS:
        end = given.tracked(one)
        yield end
    yield given.closed_in_rounds(*end)
    yield given.increments()


def left_over(left: Residuals, tolerance: float) -> tuple[bool, float]:
    """Whether more than the dissipation is above the tolerance, and the worst residual."""
    return any(one.name != "dissipation" for one in left.above(tolerance)), left.worst.value

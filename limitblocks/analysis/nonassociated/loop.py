"""The non-associated load factor: zero dilatancy, reached from the permanent loads, proven by residuals."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from limitblocks.analysis.nonassociated.determinate import state_without_solution
from limitblocks.analysis.nonassociated.each_way import Given
from limitblocks.analysis.nonassociated.finished import finished, tell_end
from limitblocks.analysis.nonassociated.in_the_plane import (
    by_self_stress,
    flow_in_plane,
    found_in_plane_or_whole,
)
from limitblocks.analysis.nonassociated.left_out import without_what_is_idle
from limitblocks.analysis.nonassociated.loading import CLIMBS
from limitblocks.analysis.nonassociated.means import MEANS, Means, checked_means
from limitblocks.analysis.nonassociated.outer_loop import outer_loop, told
from limitblocks.analysis.nonassociated.path_record import CLIMBING, INTERRUPTED, UNSETTLED, recorder
from limitblocks.analysis.nonassociated.start import (
    Start,
    flow_of,
    load_scale,
    refuse_jammed,
    refuse_unlimited,
    solving_state,
    start_stresses,
)
from limitblocks.analysis.nonassociated.ways import Half, first_to_solve, no_half
from limitblocks.analysis.one_thread import one_thread
from limitblocks.arrays import Array
from limitblocks.choices import Method, method_of
from limitblocks.errors import ModelError, UnlimitedLoad
from limitblocks.evidence.backward_error import checked_limit, settled, within
from limitblocks.evidence.residuals import TOLERANCE, mcp_residuals
from limitblocks.evidence.results import Iteration, Nonassociated
from limitblocks.mechanics.loads.load import number
from limitblocks.model import Model
from limitblocks.problem import Flow, State, Turning


@one_thread
def nonassociated(
    model: Model,
    *,
    dilatancy: float = 0.0,
    turning: Turning | str = Turning.CENTROID,
    tolerance: float = TOLERANCE,
    backward_error: float | None = None,
    start: Start | None = None,
    method: Method | str = Method.PATH,
    means: Sequence[Means] | None = None,
    progress: Callable[[Iteration], None] | None = None,
    confirm: bool = True,
    throw: bool = True,
) -> Nonassociated:
    """Return a solution of Eqs (54)-(59) reached from the permanent loads, flow of Tables 3, 5 and 6.

    One path of solutions leads from a small step of rigid blocks on slightly compliant joints to the
    solution, on which compliance and a barrier fade to nothing; it is followed through folds by arclength,
    and Newton's method on the rows that yield takes its end to rounding. The load factor of a non-associated
    structure is not unique: this is one solution, the one that loading leads to where the barrier is small
    (`how` says which path it was), at most the associated value and, where twists are about the centroid, at
    least the frictionless one.

    Parameters
    ----------
    model : Model
        The structure.
    dilatancy : float
        Tangent of the dilatancy angle of sliding and twisting, 0 to the least friction coefficient, where
        the flow is associated.
    turning : {"centroid", "centre of pressure"}
        What twisting under bending turns about: the centroid, which never does negative work, or the point
        where the normal force acts, as in the paper's Table 5.
    tolerance : float
        Largest residual of a solution, dimensionless.
    backward_error : float, optional
        Also accept a state that is exact for a model changed by no more than this, such as 1e-4 of friction;
        its status is then Status.NEARBY. By default only the tolerance counts.
    start : Nonassociated, Bounds or array_like, shape (m, 6) or (s,), optional
        State to start from, in place of that of the permanent loads: of an earlier result, or in equilibrium
        with the dead and some live load, within yield: (V1, V2, N, M1, M2, T) of each interface, or
        generalised stresses in the order of a result's (joint by joint, not interface by interface), N, N m.
    method : {"path", "fixed point"}
        The tracked path, or the outer loop of Gilbert, Casapulla & Ahmed (2006) alone: associated limit
        analyses, each with the friction of the last, from the associated state or `start` on. Often the
        loop ends at another solution, and it may stall.
    means : sequence of Means, optional
        Paths to follow in turn, until one ends at a solution. If there is more than one, the other ways are
        tried, too: one half after the first, in space rounds of the fixed point, the outer loop at last, and
        increments of :func:`limitblocks.load_path`, in a plane before paths of a large barrier, in space
        after them.
    progress : callable, optional
        Called with each Iteration.
    confirm : bool
        Confirm the answer as a fixed point: with the flow frozen at it, the static and the kinematic program
        of limit analysis give its load factor again (`fixed_point_change`); costs about half of bounds.
    throw : bool
        Raise NotConverged (which carries the best result); if false, return that result with its status.

    Raises
    ------
    ModelError
        If the dilatancy or the tolerance is out of range, the method unknown, or `start` belongs to another
        model or is no state of it.
    NoEquilibrium
        If the dead loads alone cannot stand.
    UnlimitedLoad
        If the flow is associated everywhere, or normal forces alone balance the live load, and it can grow
        without limit; or if no path ends and the increments of the load path climb without limit.
    NotConverged
        If no path ends, or no round of the loop, within the tolerance, or the user interrupts it; NoSolution,
        one of its kind, if it is proven that there is none.
    """
    way = method_of(method)
    limit = checked_limit(backward_error)
    number(tolerance, "tolerance", "", above=0.0)
    if means is not None and way is Method.FIXED_POINT:
        raise ModelError(
            "means are paths to follow; method='fixed point' follows none, leave one of both out"
        )
    means = MEANS if means is None else checked_means(means) or MEANS
    flow, enclosing = flow_of(model, dilatancy, turning)
    refuse_jammed(enclosing)
    refuse_unlimited(flow, enclosing.associated)
    history, record = recorder(progress)
    said: tuple[str, ...] = ()
    paths = None if way is Method.FIXED_POINT else means
    same = partial(nonassociated, dilatancy=dilatancy, turning=turning, tolerance=tolerance, method=way)
    same = partial(same, means=paths, progress=record, confirm=False)
    state = solving_state(model, flow, enclosing, start, tolerance)
    if state is not None:
        how = "the bounds, of which flow is associated" if start is None else "the state given to start from"
    elif (proven := state_without_solution(flow)) is not None:
        state, how = proven, "statics alone"
    elif start is None and (without := without_what_is_idle(model, flow, tolerance, same)):
        state, how = without
    else:
        first = enclosing.bounds if way is Method.FIXED_POINT and start is None else start

        def solve(at: Flow, x0: Array, half: Half) -> tuple[State, str]:
            if way is Method.FIXED_POINT:
                return outer_loop(at, x0, tolerance, lambda *round: record(told(at, *round)))
            scale = load_scale(at.problem, enclosing.associated)
            near = partial(_near, at, tolerance, limit)
            given = Given(at, x0, scale, tolerance, record)
            return first_to_solve(given, means, near, half)

        state, how = found_in_plane_or_whole(model, flow, first, tolerance, solve)
        if CLIMBING in how and not how.endswith(INTERRUPTED) and not _near(flow, tolerance, limit, state):
            raise UnlimitedLoad(CLIMBS)
        said = by_self_stress(model, flow, flow.problem.compliance) if first is None else ()
    tell_end(flow, state, record)
    return finished(
        model, state, enclosing, tuple(history), flow, how, tolerance, throw, confirm, limit=limit, said=said
    )


def _near(flow: Flow, tolerance: float, limit: float | None, state: State) -> bool:
    """Whether a state is exact for a model within `limit`; False where there is none."""
    if limit is None:
        return False
    nearest, error = settled(flow, state, tolerance, limit, most=limit)
    return within(error, mcp_residuals(flow, nearest), tolerance, limit)


@np.errstate(all="ignore")  # a state that ran away is no solution
def end_of_first_path(
    model: Model, flow: Flow, associated: float, start: Start | None, tolerance: float
) -> float:
    """Load factor at the end of the first path of `nonassociated`, NaN where that is no solution.

    Raises KeyboardInterrupt where the user stops it: its end would be that of no path.
    """
    weights = flow.problem.compliance
    planar = flow_in_plane(model, flow, weights, start)
    if planar is None:
        at, x0, half = flow, start_stresses(model, flow, weights, start), _not_looked_for
    else:
        at, x0, half = planar.flow, planar.x0, no_half
    scale = load_scale(at.problem, associated)
    given = Given(at, x0, scale, tolerance, lambda _: None)
    state, how = first_to_solve(given, MEANS, half=half, first=True)
    if how.endswith(INTERRUPTED):
        raise KeyboardInterrupt
    solved = mcp_residuals(at, state).worst.value <= tolerance and UNSETTLED not in how
    solved &= planar is None or planar.accepted(state, tolerance) is not None
    return float(state.load_factor / at.problem.units.live) if solved else np.nan


def _not_looked_for() -> None:
    """No half of a whole problem."""

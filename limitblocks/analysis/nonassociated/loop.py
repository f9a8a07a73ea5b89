"""The non-associated load factor: zero dilatancy, reached from the permanent loads, proven by residuals."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from limitblocks.analysis.in_si import in_model_order, resultants_of
from limitblocks.analysis.nonassociated.determinate import state_without_solution, yielding
from limitblocks.analysis.nonassociated.means import MEANS, Means
from limitblocks.analysis.nonassociated.start import (
    Bracket,
    Start,
    bracket,
    flowing_state,
    load_scale,
    own_units,
    refuse_unlimited,
    start_stresses,
)
from limitblocks.analysis.nonassociated.ways import first_to_solve, left_over
from limitblocks.analysis.stability import dead_load_state
from limitblocks.arrays import read_only
from limitblocks.errors import NoSolution, NotConverged
from limitblocks.evidence.given_power import given_power
from limitblocks.evidence.locked_shear import locked_shear
from limitblocks.evidence.residuals import TOLERANCE, mcp_residuals
from limitblocks.evidence.results import Iteration, Nonassociated, Status
from limitblocks.model import Model
from limitblocks.problem import Flow, State, Turning, checked_dilatancy, turning_of


def nonassociated(
    model: Model,
    *,
    dilatancy: float = 0.0,
    turning: Turning | str = Turning.CENTROID,
    tolerance: float = TOLERANCE,
    start: Start | None = None,
    means: Sequence[Means] = MEANS,
    progress: Callable[[Iteration], None] | None = None,
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
    start : Nonassociated, Bounds or array_like, shape (s,), optional
        State to start from, in place of that of the permanent loads: of an earlier result, or generalised
        stresses (N, N m) in equilibrium with the dead and some live load, within yield.
    means : sequence of Means
        Paths to follow in turn, until one ends at a solution; after the first of several the implicit steps
        of :func:`limitblocks.load_path` are tried.
    progress : callable, optional
        Called with each Iteration.
    throw : bool
        Raise NotConverged (which carries the best result); if false, return that result with its status.

    Raises
    ------
    ModelError
        If the dilatancy is out of range, or `start` belongs to another model or is no state of it.
    NoEquilibrium
        If the dead loads alone cannot stand.
    UnlimitedLoad
        If the flow is associated everywhere and the live load can grow without limit.
    NotConverged
        If no path ends within the tolerance; NoSolution, one of its kind, if it is proven that there is none.
    """
    slope, about = checked_dilatancy(model.problem, dilatancy), turning_of(turning)
    enclosing = bracket(model)
    problem = own_units(model, enclosing)
    flow = Flow(problem, slope, about)
    refuse_unlimited(flow, enclosing.associated)
    history: list[Iteration] = []

    def record(iteration: Iteration) -> None:
        history.append(iteration)
        if progress is not None:
            progress(iteration)

    given = enclosing.bounds if flow.associated and start is None else start
    state = flowing_state(model, flow, given)
    if state is not None and mcp_residuals(flow, state).worst.value <= tolerance:
        how = "the bounds, of which flow is associated" if start is None else "the state given to start from"
    elif (proven := state_without_solution(flow)) is not None:
        state, how = proven, "statics alone"
    else:
        x0 = start_stresses(model, problem, problem.compliance, start)
        scale = load_scale(problem, enclosing.associated)
        state, how = first_to_solve(flow, x0, scale, means, tolerance, record)
    record(_end(flow, state))
    return finished(model, state, enclosing, tuple(history), flow, how, tolerance, throw)


def _end(flow: Flow, state: State) -> Iteration:
    load_factor = state.load_factor / flow.problem.units.live
    return Iteration(load_factor, "polish", 0.0, mcp_residuals(flow, state).to_dict(), 0, 0)


def finished(
    model: Model,
    state: State,
    enclosing: Bracket,
    history: tuple[Iteration, ...],
    flow: Flow,
    how: str,
    tolerance: float,
    throw: bool,
) -> Nonassociated:
    """The result of a state, raised as NotConverged where its residuals are above the tolerance."""
    problem = flow.problem
    si, residuals = problem.in_si(state), mcp_residuals(flow, state)
    found, claimed = enclosing.bounds, enclosing.of(flow)
    dead = found.dead_load_stresses if found else dead_load_state(model.problem) * model.problem.stress_units
    result = Nonassociated(
        load_factor=si.load_factor,
        frictionless=claimed.frictionless,
        associated=enclosing.associated,
        stress_resultants=resultants_of(problem, state.x),
        generalised_stresses=read_only(si.x),
        displacement_rates=in_model_order(model, si.u),
        flow_multipliers=read_only(si.y),
        dead_load_stresses=dead,
        residuals=residuals,
        status=_status(flow, state, tolerance),
        how=how,
        history=history,
        dilatancy=flow.dilatancy,
        turning=flow.turning,
        remarks=given_power(flow, state, tolerance) + locked_shear(flow, state),
        tolerance=tolerance,
        digest=model.digest,
        unclaimed=claimed.unclaimed,
    )
    if throw and not result.converged:
        raise _refused(flow, result)
    return result


def _refused(flow: Flow, result: Nonassociated) -> NotConverged:
    """The error that says why a result is no solution."""
    problem, worst = flow.problem, result.residuals.worst
    state = state_without_solution(flow)
    if result.status is Status.NO_SOLUTION and state is not None:
        first = problem.member_interface[yielding(flow, state.x)]
        return NoSolution(
            "no solution exists: statics alone gives the stresses, "
            f"{', '.join(dict.fromkeys(problem.interfaces[k] for k in first))} yields first, at load factor "
            f"{state.load_factor / problem.units.live:.6g}, and the live load does no work on what can flow",
            result,
        )
    place = f" at {worst.where}" if worst.where else ""
    return NotConverged(
        f"no solution within {result.tolerance:g}: {worst.name} residual {worst.value:.1e}{place}, "
        f"load factor {result.load_factor:.6g}; the error's result holds that state",
        result,
    )


def _status(flow: Flow, state: State, tolerance: float) -> Status:
    equations_left, worst = left_over(flow, state, tolerance)
    if worst <= tolerance:
        return Status.CONVERGED
    if not equations_left:
        return Status.GIVES_POWER
    proven = state_without_solution(flow) is not None
    return Status.NO_SOLUTION if proven else Status.OUT_OF_STEPS

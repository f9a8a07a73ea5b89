"""The answer of a search: its state as a result with its proof, or the error that says why it is none."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace

import numpy as np

from limitblocks.analysis.idle import idle_words
from limitblocks.analysis.in_si import in_model_order, resultants_of
from limitblocks.analysis.nonassociated.determinate import state_without_solution, yielding
from limitblocks.analysis.nonassociated.frozen_flow import fixed_point_change, unconfirmed
from limitblocks.analysis.nonassociated.in_the_plane import plane_of
from limitblocks.analysis.nonassociated.path_record import INTERRUPTED, RETURNS, UNSETTLED, off_load_path
from limitblocks.analysis.nonassociated.start import Bracket
from limitblocks.analysis.nonassociated.ways import left_over
from limitblocks.analysis.polish import polish
from limitblocks.analysis.stability import dead_load_state, stability
from limitblocks.analysis.uncarried import uncarried, uncarried_words
from limitblocks.arrays import Array, read_only
from limitblocks.errors import NoSolution, NotConverged, SolverFailure
from limitblocks.evidence.backward_error import BackwardError, far_off, settled, unknown, within
from limitblocks.evidence.crushing import beyond_stress_block
from limitblocks.evidence.ending import BELOW_ZERO, UNBOUNDED, Status
from limitblocks.evidence.given_power import given_power
from limitblocks.evidence.locked_shear import locked_shear
from limitblocks.evidence.locked_tension import locked_tension
from limitblocks.evidence.measure import without_rounding
from limitblocks.evidence.residuals import Residuals, mcp_residuals
from limitblocks.evidence.results import Iteration, Nonassociated
from limitblocks.model import Model
from limitblocks.problem import Flow, State

UNCHECKED = (
    "this state solves the equations; the analysis was interrupted before its backward error and its "
    "confirmation as a fixed point were known, and check_mcp finds the first"
)

ASK_FIRST = (
    "ask stability first, lb.stability(model) or limitblocks stability MODEL: where nothing but friction at "
    "its sides holds a stone there is often no such load factor; docs/no-convergence.md says what to do next"
)

TRY_LOAD_PATH = (
    "load_path, limitblocks path MODEL, says whether the live load climbs without limit or where it ends"
)


def tell_end(flow: Flow, state: State, record: Callable[[Iteration], None]) -> None:
    """Tell the user of the polished end; all of it is there where they stop it only now, or once more."""
    load_factor = float(state.load_factor / flow.problem.units.live)
    with suppress(KeyboardInterrupt):
        record(Iteration(load_factor, "polish", 0.0, mcp_residuals(flow, state).to_dict(), 0, 0))


def finished(
    model: Model,
    state: State,
    enclosing: Bracket,
    history: tuple[Iteration, ...],
    flow: Flow,
    how: str,
    tolerance: float,
    throw: bool,
    confirm: bool = True,
    limit: float | None = None,
    why: str = "",
    said: tuple[str, ...] = (),
) -> Nonassociated:
    """The result of a state, raised as NotConverged where its residuals are above the tolerance.

    With a `limit` of the backward error, unless that is within it; the error says `why`, if that is known.
    What is `said` already stands first among the remarks.
    """
    flow, state = _as_checked(model, flow, state, tolerance)
    problem = flow.problem
    state, error, change, stopped = _evidence(model, state, flow, tolerance, confirm, limit)
    state, _ = without_rounding(problem, state)
    si, residuals = problem.in_si(state), mcp_residuals(flow, state)
    far = () if stopped else far_off(error, residuals, tolerance)
    halfway = bool(far) and how.endswith(INTERRUPTED)  # the rest of the path may lead elsewhere
    status = Status.INTERRUPTED if stopped or halfway else _status(flow, residuals, how, tolerance)
    if status is Status.CONVERGED and _other_way(model, si.load_factor, tolerance):
        status = Status.OTHER_WAY
    if status is Status.OUT_OF_STEPS and within(error, residuals, tolerance, limit):
        status = Status.NEARBY
    remarks = _remarks(model, state, flow, how if status is Status.CONVERGED else "", tolerance)
    remarks = (*said, *_of_load_factor(si.load_factor, enclosing, status, why, tolerance), *remarks)
    remarks += (*unconfirmed(change), *far, *(UNCHECKED,) * (stopped and residuals.worst.value <= tolerance))
    claimed = enclosing.of(flow)
    result = Nonassociated(
        load_factor=si.load_factor,
        frictionless=claimed.frictionless,
        associated=enclosing.associated,
        stress_resultants=resultants_of(problem, state.x),
        generalised_stresses=read_only(si.x),
        displacement_rates=in_model_order(model, si.u),
        flow_multipliers=read_only(si.y),
        dead_load_stresses=_dead_load_stresses(model, enclosing),
        residuals=residuals,
        backward_error=error,
        status=status,
        how=how,
        history=history,
        dilatancy=flow.dilatancy,
        turning=flow.turning,
        remarks=remarks,
        tolerance=tolerance,
        digest=model.digest,
        unclaimed=claimed.unclaimed,
        fixed_point_change=change,
    )
    if throw and not result.accepted:
        raise _refused(model, flow, result, why)
    return result


def _as_checked(model: Model, flow: Flow, state: State, tolerance: float) -> tuple[Flow, State]:
    """The flow rule and the state in the units that a check has: the epsilon of Table 5 is small in them.

    Polished there where hardly pressed joints turn about another centre.
    """
    if flow.constant or flow.problem is model.problem:
        return flow, state
    own = replace(flow, problem=model.problem)
    checked = model.problem.dimensionless(flow.problem.in_si(state))
    solved, accepted = (
        mcp_residuals(*one).worst.value <= tolerance for one in ((flow, state), (own, checked))
    )
    return own, polish(own, checked) if solved and not accepted else checked


def _dead_load_stresses(model: Model, enclosing: Bracket) -> Array:
    """Those of the bounds, where these were found."""
    if enclosing.bounds:
        return enclosing.bounds.dead_load_stresses
    return dead_load_state(model.problem) * model.problem.stress_units


def _of_load_factor(
    load_factor: float, enclosing: Bracket, status: Status, why: str, tolerance: float
) -> tuple[str, ...]:
    """What is said of a load factor that nothing bounds, or that is below zero."""
    if status in (Status.CONVERGED, Status.NEARBY):
        return (BELOW_ZERO,) * (load_factor < -tolerance)
    return (UNBOUNDED,) * bool(np.isinf(enclosing.associated) and RETURNS not in why)


def _remarks(model: Model, state: State, flow: Flow, how: str, tolerance: float) -> tuple[str, ...]:
    """What is said of a state, and of `how` a solution was found."""
    problem = flow.problem
    return (
        *off_load_path(how),
        *given_power(flow, state, tolerance),
        *locked_shear(flow, state),
        *locked_tension(model, flow, state),
        *beyond_stress_block(model, resultants_of(problem, state.x)),
    )


def _evidence(
    model: Model, state: State, flow: Flow, tolerance: float, confirm: bool, limit: float | None
) -> tuple[State, BackwardError, float | None, bool]:
    """The state that is told, its backward error and change as a fixed point; whether the user stopped."""
    error = unknown()
    try:
        state, error = settled(flow, state, tolerance, limit)
        if not confirm or mcp_residuals(flow, state).worst.value > tolerance:
            return state, error, None, False
        return state, error, fixed_point_change(flow, state, plane_of(model, flow.problem, state.x)), False
    except KeyboardInterrupt:
        return state, error, None, True


def _refused(model: Model, flow: Flow, result: Nonassociated, known: str) -> NotConverged:
    """The error that says why a result is no solution."""
    worst = result.residuals.worst
    state = state_without_solution(flow)
    if result.status is Status.NO_SOLUTION and state is not None:
        return NoSolution(f"no solution exists: {_by_statics(flow, state)}", result)
    unbounded = UNBOUNDED in result.remarks
    if result.status is Status.OTHER_WAY:
        said = f"; {UNBOUNDED}" * unbounded
        error = NotConverged(f"{result.status.value}, at load factor {result.load_factor:.6g}{said}", result)
        error.add_note(TRY_LOAD_PATH)
        return error
    place = f" at {worst.where}" if worst.where else ""
    interrupted = result.status is Status.INTERRUPTED
    why = INTERRUPTED if interrupted else f"no solution within {result.tolerance:g}"
    if result.status is Status.UNSETTLED:
        why = "the load factor still changed as its path was followed on"
    reached = f", load factor {result.load_factor:.6g}, {result.backward_error}"
    said = f"; {UNBOUNDED}" if unbounded else reached
    error = NotConverged(f"{why}: {worst.name} residual {worst.value:.1e}{place}{said}", result)
    if not interrupted:
        for note in (
            *(known,) * bool(known),
            *idle_words(model.problem),
            *uncarried_words(uncarried(model, model.tolerances)),
            ASK_FIRST,
        ):
            error.add_note(note)
    return error


def _by_statics(flow: Flow, state: State) -> str:
    """What yields first where statics alone gives the stresses and nothing flows as it should."""
    p = flow.problem
    first = p.member_interface[yielding(flow, state.x)]
    if not len(first):
        return "statics alone gives the stresses, and however large the live load, no joint yields"
    return (
        "statics alone gives the stresses, "
        f"{', '.join(dict.fromkeys(p.interfaces[k] for k in first))} yields first, at load factor "
        f"{state.load_factor / p.units.live:.6g}, and the live load does no work on what can flow; beyond it "
        "no stresses within yield balance the loads"
    )


def _other_way(model: Model, load_factor: float, tolerance: float) -> bool:
    """Whether a structure that stands under its dead loads by itself would collapse only below zero."""
    if load_factor >= -tolerance:
        return False
    try:
        return stability(model).stands
    except SolverFailure:  # undecided
        return False


def _status(flow: Flow, residuals: Residuals, how: str, tolerance: float) -> Status:
    equations_left, worst = left_over(residuals, tolerance)
    if worst <= tolerance:
        return Status.UNSETTLED if UNSETTLED in how else Status.CONVERGED
    if how.endswith(INTERRUPTED):
        return Status.INTERRUPTED
    if not equations_left:
        return Status.GIVES_POWER
    proven = state_without_solution(flow) is not None
    return Status.NO_SOLUTION if proven else Status.OUT_OF_STEPS

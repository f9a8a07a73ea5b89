"""The non-associated load factor: zero dilatancy, reached from the permanent loads, proven by residuals."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from limitblocks.analysis.in_si import in_model_order, resultants_of
from limitblocks.analysis.nonassociated.closing import evidence
from limitblocks.analysis.nonassociated.loading import stages
from limitblocks.analysis.nonassociated.settings import Settings
from limitblocks.analysis.nonassociated.stage import Stage
from limitblocks.analysis.nonassociated.start import (
    Bracket,
    Start,
    associated_stage,
    bracket,
    load_scale,
    refuse_unlimited,
    start_stresses,
)
from limitblocks.analysis.polish import polish
from limitblocks.analysis.stability import dead_load_state
from limitblocks.arrays import Array, read_only
from limitblocks.errors import NotConverged
from limitblocks.evidence.locked_shear import locked_shear
from limitblocks.evidence.residuals import TOLERANCE, mcp_residuals
from limitblocks.evidence.results import Iteration, Nonassociated, Status
from limitblocks.model import Model
from limitblocks.problem import Flow, LimitProblem, State, Turning, checked_dilatancy, turning_of

# A snap that jams one step size is crossed by another, or by a flow rule that grows into the true one.
ATTEMPTS = (
    Settings(),
    Settings(longest=5e3),
    Settings(first=1.0, longest=15.0),
    Settings(flows=((0.0, 0.0), (0.5, 0.0), (1.0, 0.0))),
    Settings(first=0.13, retries=((1.0, 0.0), (1.0, 1e-3), (1.0, 1e-2), (1.0, 1e-1)), budget=800),
    Settings(flows=tuple((1.0, share) for share in (1.0, 0.8, 0.6, 0.4, 0.2, 0.1, 0.0)), budget=400),
)
ASSOCIATED = (1.0, 1.0)
COLLAPSING = 0.9  # of the largest load factor met: states below it are no candidates for the best one


def nonassociated(
    model: Model,
    *,
    dilatancy: float = 0.0,
    turning: Turning | str = Turning.CENTROID,
    tolerance: float = TOLERANCE,
    start: Start | None = None,
    settings: Settings | Sequence[Settings] = ATTEMPTS,
    progress: Callable[[Iteration], None] | None = None,
    throw: bool = True,
) -> Nonassociated:
    """Return a solution of Eqs (54)-(59) reached from the permanent loads, flow of Tables 3, 5 and 6.

    Implicit steps of growing size lead from the permanent-load state towards collapse; near it a fixed
    point of two convex programs with frozen flow, or one very long step, finds the solution. Where they jam,
    the flow rule grows from a simpler one into the true one; see :class:`limitblocks.Settings`. The load
    factor of a non-associated structure is not unique: this is one solution, between the frictionless and
    the associated value.

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
    settings : Settings or sequence of Settings
        How to step; further settings are tried in turn where the first do not converge.
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
        If no attempt ends within the tolerance.
    """
    problem = model.problem
    flow = Flow(problem, checked_dilatancy(problem, dilatancy), turning_of(turning))
    x0 = start_stresses(model, problem.compliance, start)
    enclosing = bracket(model)
    refuse_unlimited(flow, enclosing.associated)
    scale = load_scale(problem, enclosing.associated)
    history: list[Iteration] = []

    def record(stage: Stage) -> None:
        history.append(iteration(problem, stage))
        if progress is not None:
            progress(history[-1])

    met: list[Stage] = []
    if enclosing.bounds and start is None and flow.associated:
        met = [associated_stage(model, flow, enclosing.bounds)]
        record(met[-1])
    for setting in [settings] if isinstance(settings, Settings) else settings:
        if met and met[-1].residuals.worst.value <= tolerance:
            break
        x = _first_stresses(problem, setting, enclosing, x0)
        if x is not None:
            met += stages(flow, x, problem.compliance, tolerance, setting, scale, record)
    return finished(
        model,
        best_of(met, tolerance) or initial(flow, x0),
        enclosing,
        tuple(history),
        flow,
        tolerance,
        throw,
    )


def _first_stresses(problem: LimitProblem, setting: Settings, enclosing: Bracket, x0: Array) -> Array | None:
    """Where an attempt starts; None where its flow rules say nothing new or there is no associated state."""
    turnings, dilatings = (set(shares) for shares in zip(*setting.flows, strict=True))
    if setting.flows[0] == ASSOCIATED:
        found = enclosing.bounds
        return None if found is None else np.asarray(found.generalised_stresses / problem.stress_units)
    return x0 if problem.pivot.any() or turnings == {1.0} or len(dilatings) > 1 else None


def best_of(met: list[Stage], tolerance: float) -> Stage | None:
    """The last stage if it converged, else that of least residual among those close to collapse."""
    if not met or met[-1].residuals.worst.value <= tolerance:
        return met[-1] if met else None
    largest = max(stage.state.load_factor for stage in met)
    least = largest - (1.0 - COLLAPSING) * abs(largest)
    near = [stage for stage in met if stage.state.load_factor >= least]
    return min(near, key=lambda stage: stage.residuals.worst.value)


def initial(flow: Flow, x0: Array) -> Stage:
    """The permanent-load state as a stage: what is left to show where no step succeeds."""
    u, y = np.zeros(flow.problem.C.shape[1]), np.zeros(len(flow.problem.g))
    state = State(0.0, x0, u, y)
    return Stage(state, evidence(flow, state), np.inf, "step", 0, 0)


def iteration(problem: LimitProblem, stage: Stage) -> Iteration:
    """What a stage tells the user."""
    return Iteration(
        load_factor=stage.state.load_factor / problem.units.live,
        kind=stage.kind,
        step_size=1.0 / stage.rho,
        residuals=stage.residuals.to_dict(),
        inner=stage.inner,
        failures=stage.failures,
    )


def finished(
    model: Model,
    stage: Stage,
    enclosing: Bracket,
    history: tuple[Iteration, ...],
    flow: Flow,
    tolerance: float,
    throw: bool,
) -> Nonassociated:
    """The result of a stage, raised as NotConverged where its residuals are above the tolerance."""
    state = polish(flow, stage.state)
    si, residuals = model.problem.in_si(state), mcp_residuals(flow, state)
    worst = residuals.worst
    found = enclosing.bounds
    dead = found.dead_load_stresses if found else dead_load_state(model.problem) * model.problem.stress_units
    result = Nonassociated(
        load_factor=si.load_factor,
        frictionless=enclosing.frictionless,
        associated=enclosing.associated,
        stress_resultants=resultants_of(model.problem, state.x),
        generalised_stresses=read_only(si.x),
        displacement_rates=in_model_order(model, si.u),
        flow_multipliers=read_only(si.y),
        dead_load_stresses=dead,
        residuals=residuals,
        status=Status.CONVERGED if worst.value <= tolerance else Status.OUT_OF_STEPS,
        history=history,
        dilatancy=flow.dilatancy,
        turning=flow.turning,
        remarks=locked_shear(flow, state),
        tolerance=tolerance,
        digest=model.digest,
    )
    if throw and not result.converged:
        raise NotConverged(
            f"no solution within {tolerance:g}: {worst.name} residual {worst.value:.1e} at load factor "
            f"{result.load_factor:.6g}; the error's result holds that state",
            result,
        )
    return result

"""The non-associated load factor: zero dilatancy, reached from the permanent loads, proven by residuals."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import is_dataclass, replace

import numpy as np

from limitblocks.analysis.bounds import TOLERANCE, bounds, in_model_order, refuse_falling
from limitblocks.analysis.fixed_point import permanent_state
from limitblocks.analysis.loading import Settings, Stage, stages
from limitblocks.analysis.mcp import mcp_residuals
from limitblocks.analysis.residuals import SMALL_LOAD, Residuals, static_residuals
from limitblocks.analysis.results import Iteration, Nonassociated, Status
from limitblocks.analysis.states import State
from limitblocks.arrays import Array, read_only
from limitblocks.errors import (
    ModelError,
    NoEquilibrium,
    NotConverged,
    SolveError,
    SolverFailure,
    UnlimitedLoad,
)
from limitblocks.mechanics import LimitProblem
from limitblocks.mechanics.flow import dilatancy_share
from limitblocks.model import Model

# A snap that jams one step size is crossed by another.
ATTEMPTS = (
    Settings(),
    Settings(longest=5e3),
    Settings(first=1.0, longest=15.0),
    Settings(first=0.13, retries=((1.0, 0.0), (1.0, 1e-3), (1.0, 1e-2), (1.0, 1e-1)), budget=800),
)
NOISE = 1e-9  # of the associated load factor: a frictionless one below it is zero
COLLAPSING = 0.9  # of the largest load factor met: states below it are no candidates for the best one


def nonassociated(
    model: Model,
    *,
    dilatancy: float = 0.0,
    tolerance: float = TOLERANCE,
    start: Nonassociated | None = None,
    settings: Settings | Sequence[Settings] = ATTEMPTS,
    progress: Callable[[Iteration], None] | None = None,
    throw: bool = True,
) -> Nonassociated:
    """Return a solution of Eqs (54)-(59) reached from the permanent loads, flow of Tables 3, 5 and 6.

    Implicit steps of growing size lead from the permanent-load state towards collapse; near it a fixed
    point of two convex programs with frozen flow finds the solution. The load factor of a non-associated
    structure is not unique: this is one solution, between the frictionless and the associated value.

    Parameters
    ----------
    model : Model
        The structure.
    dilatancy : float
        Tangent of the dilatancy angle of sliding and twisting, 0 to the least friction coefficient, where
        the flow is associated.
    tolerance : float
        Largest residual of a solution, dimensionless.
    start : Nonassociated, optional
        Earlier result to start from, in place of the permanent-load state.
    settings : Settings or sequence of Settings
        How to step; further settings are tried in turn where the first do not converge.
    progress : callable, optional
        Called with each Iteration.
    throw : bool
        Raise NotConverged (which carries the best result); if false, return that result with its status.

    Raises
    ------
    ModelError
        If the dilatancy is out of range, or `start` belongs to another model.
    NoEquilibrium
        If the dead loads alone cannot stand.
    UnlimitedLoad
        If the flow is associated everywhere and the live load can grow without limit.
    NotConverged
        If no attempt ends within the tolerance.
    """
    problem = model.problem
    dilatancy_share(problem, dilatancy)
    x0 = start_stresses(model, problem.compliance, start)
    enclosing = bracket(model)
    refuse_unlimited(problem, enclosing[1], dilatancy)
    scale = load_scale(problem, enclosing[1])
    history: list[Iteration] = []

    def record(stage: Stage) -> None:
        history.append(iteration(problem, stage))
        if progress is not None:
            progress(history[-1])

    met: list[Stage] = []
    for setting in [settings] if isinstance(settings, Settings) else settings:
        found = stages(problem, x0, problem.compliance, dilatancy, tolerance, setting, scale, record)
        met += found
        if found and found[-1].residuals.worst.value <= tolerance:
            break
    return finished(
        model,
        best_of(met, tolerance) or initial(problem, x0, dilatancy),
        enclosing,
        tuple(history),
        dilatancy,
        tolerance,
        throw,
    )


def best_of(met: list[Stage], tolerance: float) -> Stage | None:
    """The last stage if it converged, else that of least residual among those close to collapse."""
    if not met or met[-1].residuals.worst.value <= tolerance:
        return met[-1] if met else None
    largest = max(stage.state.load_factor for stage in met)
    least = largest - (1.0 - COLLAPSING) * abs(largest)
    near = [stage for stage in met if stage.state.load_factor >= least]
    return min(near, key=lambda stage: stage.residuals.worst.value)


def initial(problem: LimitProblem, x0: Array, dilatancy: float) -> Stage:
    """The permanent-load state as a stage: what is left to show where no step succeeds."""
    u, y = np.zeros(problem.C.shape[1]), np.zeros(len(problem.g))
    evidence = mcp_residuals(problem, 0.0, x0, u, y, dilatancy)
    return Stage(State(0.0, x0, u, y), evidence, np.inf, "step", 0, 0)


def refuse_unlimited(problem: LimitProblem, associated: float, dilatancy: float) -> None:
    """Raise UnlimitedLoad where the flow is associated and nothing limits the load."""
    if np.isinf(associated) and bool((dilatancy_share(problem, dilatancy) == 1.0).all()):
        raise UnlimitedLoad("with dilatancy equal to friction the live load can grow without limit")


def start_stresses(model: Model, weights: Array, start: Nonassociated | None) -> Array:
    """Stresses to start from: of the result `start`, or under the dead loads, proven to be in equilibrium."""
    problem = model.problem
    if start is not None:
        if start.digest != model.digest:
            raise ModelError(
                f"start belongs to model {start.digest[:12]}, not to this model {model.digest[:12]}"
            )
        return np.asarray(start.generalised_stresses / problem.stress_units)
    x = permanent_state(problem, weights)
    if x is None or Residuals(static_residuals(problem, 0.0, x)).worst.value > TOLERANCE:
        refuse_falling(problem)
        raise SolveError("no state of the permanent loads was found, though they stand")
    return x


def load_scale(problem: LimitProblem, associated: float) -> float:
    """Dimensionless load factor that steps are measured by; the dead load's where none limits the load."""
    limit = associated / problem.scales.load_factor
    return max(limit, SMALL_LOAD) if np.isfinite(limit) else float(len(problem.blocks))


def iteration(problem: LimitProblem, stage: Stage) -> Iteration:
    """What a stage tells the user."""
    return Iteration(
        load_factor=stage.state.load_factor * problem.scales.load_factor,
        kind=stage.kind,
        step_size=1.0 / stage.rho,
        residuals=stage.residuals.to_dict(),
        inner=stage.inner,
        failures=stage.failures,
    )


def finished(
    model: Model,
    stage: Stage,
    enclosing: tuple[float, float],
    history: tuple[Iteration, ...],
    dilatancy: float,
    tolerance: float,
    throw: bool,
) -> Nonassociated:
    """The result of a stage, raised as NotConverged where its residuals are above the tolerance."""
    problem, state = model.problem, stage.state
    worst = stage.residuals.worst
    result = Nonassociated(
        load_factor=state.load_factor * problem.scales.load_factor,
        frictionless=enclosing[0],
        associated=enclosing[1],
        stress_resultants=read_only(
            (problem.resultants @ state.x).reshape(-1, 6) * problem.scales.resultants
        ),
        generalised_stresses=read_only(state.x * problem.stress_units),
        displacement_rates=in_model_order(model, state.u),
        flow_multipliers=read_only(state.y * problem.scales.work),
        residuals=stage.residuals,
        status=Status.CONVERGED if worst.value <= tolerance else Status.OUT_OF_STEPS,
        history=history,
        dilatancy=dilatancy,
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


def bracket(model: Model) -> tuple[float, float]:
    """Associated load factors without and with friction, which enclose every solution (Drucker 1954).

    NaN where the structure does not stand without friction, or the frictionless value is not to be had;
    infinite where the load is unlimited.
    """
    lower, upper = _lower(model), _associated(model, upper=True)
    noise = np.isfinite(upper) and abs(lower) < NOISE * abs(upper)
    return (0.0 if noise else lower), upper


def _lower(model: Model) -> float:
    if not all(is_dataclass(interface.joint) for interface in model.interfaces):
        return np.nan
    smooth = {i.joint: replace(i.joint, friction=0.0) for i in model.interfaces}  # type: ignore[type-var]
    interfaces = [replace(i, joint=smooth[i.joint]) for i in model.interfaces]
    try:
        return _associated(replace(model, interfaces=interfaces), upper=False)
    except (NoEquilibrium, SolverFailure):  # the lower end says little; its failure must not cost the answer
        return np.nan


def _associated(model: Model, *, upper: bool) -> float:
    try:
        found = bounds(model)
    except UnlimitedLoad:
        return np.inf
    return found.upper if upper else found.lower

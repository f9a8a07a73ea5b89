"""Where the non-associated analysis starts from: the bracket and the state of the permanent loads."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from limitblocks.analysis.bounds import bounds
from limitblocks.analysis.interior import carried
from limitblocks.analysis.nonassociated.permanent import permanent_state
from limitblocks.analysis.nonassociated.without_shear import load_factor_without_shear
from limitblocks.analysis.polish import polish
from limitblocks.analysis.programs import remeasured
from limitblocks.analysis.stability import dead_load_state
from limitblocks.arrays import Array, reals
from limitblocks.errors import ModelError, SolverFailure, UnlimitedLoad
from limitblocks.evidence.associated import Bounds
from limitblocks.evidence.residuals import Residuals, mcp_residuals, static_residuals
from limitblocks.evidence.results import Nonassociated
from limitblocks.known import known
from limitblocks.model import Model, refuse_other
from limitblocks.problem import Flow, LimitProblem, State, Turning, checked_dilatancy, turning_of

NOISE = 1e-9  # of the associated load factor, or of the dead loads: a frictionless one below it is zero
CLOSER = (0.1, 1e-3)  # of the tolerance: bounds that may solve where flow is associated
GIVEN = 1e-6  # residual up to which a state that is given may be started from

TURNED = "with this turning a joint can give power, so that solutions may be lower than without friction"

Start = Nonassociated | Bounds | npt.ArrayLike


@dataclass(frozen=True, eq=False)
class Bracket:
    """The load factor without shear and the associated one, which enclose every solution (Drucker 1954).

    `frictionless` is NaN where it is no lower end, and `unclaimed` says why; `associated` is infinite where
    the load is unlimited, and `bounds` its evidence otherwise.
    """

    frictionless: float
    associated: float
    bounds: Bounds | None
    unclaimed: str = ""

    @property
    def nothing(self) -> bool:
        """Whether every solution has the load factor zero."""
        return self.frictionless == self.associated == 0.0

    def of(self, flow: Flow) -> Bracket:
        """Return what is claimed of the solutions of a flow rule: no lower end where it can give power."""
        return self if flow.dissipative else replace(self, frictionless=np.nan, unclaimed=TURNED)


def bracket(model: Model) -> Bracket:
    """Return the associated load factors that enclose every non-associated one."""
    return known(model, "bracket", lambda: _bracket(model))


def _bracket(model: Model) -> Bracket:
    try:
        limit_load = bounds(model)
    except UnlimitedLoad:
        limit_load = None
    upper = limit_load.upper if limit_load else np.inf
    lower, unclaimed = load_factor_without_shear(model.problem, limit_load is not None)
    noise = abs(lower) < NOISE * load_scale(model.problem, abs(upper)) / model.problem.units.live
    return Bracket(0.0 if noise else lower, upper, limit_load, unclaimed)


def own_units(model: Model, enclosing: Bracket) -> LimitProblem:
    """The limit problem in units of what acts on its blocks at the associated load, where that is known."""
    limit_load = enclosing.bounds
    if limit_load is None:
        return model.problem
    state = state_of(model, model.problem, limit_load)
    return known(model, "own units", lambda: remeasured(model.problem, state)) or model.problem


def flow_of(model: Model, dilatancy: float, turning: Turning | str) -> tuple[Flow, Bracket]:
    """Return the flow rule of a model in its own units, and what encloses every solution."""
    slope, about = checked_dilatancy(model.problem, dilatancy), turning_of(turning)
    _refuse_no_measure(model.problem)
    enclosing = bracket(model)
    return Flow(own_units(model, enclosing), slope, about), enclosing


def _refuse_no_measure(problem: LimitProblem) -> None:
    """Raise ModelError where nothing but friction resists: with one load factor its multiples solve, too."""
    if not problem.dead.any() and not problem.g.any():
        raise ModelError(
            "no dead load acts on a free block, and no joint has a strength of its own: nothing measures the "
            "load factor, which is 0 or without limit; give unit weights or other dead loads"
        )


def solving_state(
    model: Model, flow: Flow, enclosing: Bracket, given: Start | None, tolerance: float
) -> State | None:
    """What solves without a path, polished: a result given, or the bounds of associated flow or of zero.

    Their gap is a sum over the structure: a joint may need bounds that are closer than the tolerance.
    """
    if given is not None:
        return solution(model, flow, given, tolerance)
    if not (flow.associated or enclosing.nothing) or enclosing.bounds is None:
        return None
    for share in CLOSER:
        try:
            close = bounds(model, tolerance=share * min(tolerance, enclosing.bounds.tolerance))
        except SolverFailure:
            close = enclosing.bounds
        if (state := solution(model, flow, close, tolerance)) is not None:
            return state
    return None


def solution(model: Model, flow: Flow, given: Start, tolerance: float) -> State | None:
    """A result as a state of the flow rule, polished, if it is a solution within the tolerance."""
    if not isinstance(given, Nonassociated | Bounds) or given.digest != model.digest:
        return None
    state = polish(flow, state_of(model, flow.problem, given))
    return state if mcp_residuals(flow, state).worst.value <= tolerance else None


def state_of(model: Model, problem: LimitProblem, result: Bounds | Nonassociated) -> State:
    """Return a result as a dimensionless state."""
    rates = result.displacement_rates[model.free].ravel()
    return problem.dimensionless(
        State(result.load_factor, result.generalised_stresses, rates, result.flow_multipliers)
    )


def load_scale(problem: LimitProblem, associated: float) -> float:
    """Dimensionless load factor that paths are measured by: the associated one, or that of the dead loads.

    The lesser of them: where blocks are wedged nothing but crushing may limit the associated one.
    """
    limit, live = associated * problem.units.live, float(np.linalg.norm(problem.live))
    dead = float(np.linalg.norm(problem.dead)) / live
    return min((scale for scale in (limit, dead) if 0.0 < scale < np.inf), default=1.0 / live)


def refuse_jammed(enclosing: Bracket) -> None:
    """Raise UnlimitedLoad where no mechanism of any flow rule exists: the load is unlimited without friction.

    Then normal forces x alone balance the live load, and G x in K as shear and torsion are zero. A mechanism
    C u = -G^T y with live.u = 1 would give 1 = x.C u = -(G x).y <= 0.
    """
    if np.isinf(enclosing.associated) and np.isinf(enclosing.frictionless):
        raise UnlimitedLoad(
            "the live load can grow without limit: normal forces alone balance it, without any friction, so "
            "that no mechanism does positive work with it; check its direction, and for tenons drawn tight"
        )


def refuse_unlimited(flow: Flow, associated: float) -> None:
    """Raise UnlimitedLoad where the flow is associated and nothing limits the load."""
    if np.isinf(associated) and flow.associated:
        raise UnlimitedLoad("with dilatancy equal to friction the live load can grow without limit")


def start_stresses(model: Model, flow: Flow, weights: Array, start: Start | None) -> Array:
    """Dimensionless stresses to start from: given, or those of the dead loads, proven to balance them.

    Raises
    ------
    ModelError
        The state given belongs to another model, or it is not in equilibrium within yield.
    """
    if start is not None:
        return _given(model, flow.problem, start)
    proven = carried(model.problem)
    if proven is None:  # a least-norm state of what falls may look like one
        proven = dead_load_state(model.problem)
    x = permanent_state(flow, weights)
    return proven * model.problem.stress_units / flow.problem.stress_units if x is None else x


def _of_resultants(problem: LimitProblem, resultants: Array) -> Array:
    """Generalised stresses (s,) from the resultants of each interface (m, 6), N and N m."""
    B = problem.resultants
    if B.nnz > B.shape[1]:
        raise ModelError(
            "start has the stress resultants of each interface, which do not determine the inner forces of "
            "this model's joints (point contacts): give generalised stresses, as a result has them"
        )
    return np.asarray((B.T @ (resultants.ravel() / problem.units.resultants)) * problem.stress_units)


def stresses_given(start: Start) -> Array:
    """Return the stresses of a result, or given as numbers, to start from; ModelError where it is neither."""
    if isinstance(start, Nonassociated | Bounds):
        return start.generalised_stresses
    try:
        return reals(start)
    except (TypeError, ValueError):
        raise ModelError(
            f"start is a {type(start).__name__}, expected a result of nonassociated or bounds (of a load path"
            " its collapse), or stresses as numbers, N and N m"
        ) from None


def _given(model: Model, problem: LimitProblem, start: Start) -> Array:
    if isinstance(start, Nonassociated | Bounds):
        refuse_other(model, start)
        return np.asarray(start.generalised_stresses / problem.stress_units)
    stresses = stresses_given(start)
    if stresses.shape == (len(model.interfaces), 6):
        stresses = _of_resultants(problem, stresses)
    stresses = stresses.ravel()
    if stresses.shape != problem.stress_units.shape or not np.isfinite(stresses).all():
        raise ModelError(
            f"start has {stresses.size} numbers; the {problem.stress_units.size} finite generalised stresses "
            f"of the model, or stress resultants of shape ({len(model.interfaces)}, 6), are needed, N and N m"
        )
    x = np.asarray(stresses / problem.stress_units)
    carried = problem.C.T @ x - problem.dead
    load_factor = float(carried @ problem.live / (problem.live @ problem.live))
    worst = Residuals(static_residuals(problem, load_factor, x)).worst
    if worst.value > GIVEN:
        raise ModelError(
            f"start is no state of this model: {worst.name} residual {worst.value:.1e} at load "
            f"factor {load_factor / problem.units.live:.6g}, at most {GIVEN:g} is needed"
        )
    return x

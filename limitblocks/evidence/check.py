"""Check of a claimed solution against Eqs (54)-(59); numpy and scipy only, no trust in any solver."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import CheckFailed, ModelError
from limitblocks.evidence.backward_error import BackwardError, backward_error, checked_limit, far_off, within
from limitblocks.evidence.claim import Claim, claim_of, real_number
from limitblocks.evidence.crushing import beyond_stress_block
from limitblocks.evidence.given_power import given_power
from limitblocks.evidence.load_path_result import LoadPath
from limitblocks.evidence.locked_shear import locked_shear
from limitblocks.evidence.locked_tension import locked_tension
from limitblocks.evidence.mechanism import find_mechanism
from limitblocks.evidence.other_convention import other_convention
from limitblocks.evidence.proof import Proof, proof_of
from limitblocks.evidence.residuals import (
    OF_BOUNDS,
    TOLERANCE,
    Residual,
    Residuals,
    bounds_residuals,
    mcp_residuals,
    residual,
    static_residuals,
)
from limitblocks.evidence.standing import standing_state
from limitblocks.evidence.steps import UNJUDGED, steps_residual
from limitblocks.model import Model, checked_model
from limitblocks.problem import Flow, LimitProblem, State, turning_of
from limitblocks.shown import Result, kept


@dataclass(frozen=True, repr=False)
class Check(Result):
    """Residuals of Eqs (54)-(59) for a claimed solution.

    Attributes
    ----------
    residuals : Residuals
        Of Eqs (54)-(59); and "standing": how far the dead loads alone are from standing. Without that, a
        solution is no collapse: a structure that falls already has trivial ones. Of a load path "steps", too:
        the most that a step is off equilibrium at its load factor.
    tolerance : float
        Largest residual of a solution.
    backward_error : BackwardError
        How far from the model the one is of which the claim is an exact solution.
    limit : float, optional
        Largest backward error that was asked for, in place of residuals within the tolerance.
    mechanism_found : bool
        Whether the checker had to search for the mechanism or the multipliers.
    remarks : tuple of str
        What a reader of the load factor should know, such as a shear that polyhedral friction locks.
    digest : str
        SHA-256 of the model.
    """

    residuals: Residuals
    tolerance: float
    backward_error: BackwardError
    limit: float | None
    mechanism_found: bool
    remarks: tuple[str, ...]
    digest: str

    @property
    def passed(self) -> bool:
        """True if every residual is within the tolerance."""
        return not self.residuals.above(self.tolerance)

    @property
    def accepted(self) -> bool:
        """True if it passed, or the claim is exact for a model as near as was asked for."""
        return self.passed or within(self.backward_error, self.residuals, self.tolerance, self.limit)

    @property
    def usual(self) -> float:
        """Tolerance unless another is asked for: that of bounds where both bounds were judged."""
        return OF_BOUNDS if any(entry.name == "gap" for entry in self.residuals.entries) else TOLERANCE

    @property
    def worst(self) -> Residual:
        """The largest residual."""
        return self.residuals.worst

    def rows(self) -> list[dict[str, Any]]:
        """Return a row for each residual."""
        return self.residuals.rows()

    def require(self) -> None:
        """Raise CheckFailed, naming every residual above the tolerance, unless the claim is accepted."""
        failed = self.residuals.above(self.tolerance)
        if not self.accepted:
            asked = "" if self.limit is None else f"; {self.backward_error}, above {self.limit:g}"
            raise CheckFailed(f"above {self.tolerance:g}: {', '.join(map(str, failed))}{asked}")

    def to_dict(self) -> dict[str, Any]:
        """Return the check as plain numbers and text."""
        return {
            "analysis": "check",
            **kept(self, "passed", "residuals"),
            "residual_details": self.residuals.details(),
            **kept(self, "tolerance", "backward_error", "limit", "accepted", "mechanism_found"),
            **kept(self, "remarks", "digest"),
        }

    def __str__(self) -> str:
        word = "passed" if self.passed else "FAILED"
        if self.accepted and not self.passed:
            word = f"not passed, but exact for a model within {self.limit:g}"
        source = ", mechanism found by the checker" if self.mechanism_found else ""
        place = f" at {self.worst.where}" if self.worst.where else ""
        worst = f"worst residual {self.worst.value:.1e} ({self.worst.name}{place})"
        return self._line(f"check {word}: {worst}, {self.backward_error}{source}", *self.remarks)


def check_mcp(model: Model, result: Any, *, tolerance: Any = None, backward_error: Any = None) -> Check:
    """Check a claimed solution residual by residual, Eqs (54)-(59).

    Residuals are dimensionless, see :class:`limitblocks.results.Residuals`. Undefined is infinite. A missing
    mechanism, missing multipliers and a missing state of the dead loads alone are searched for, so that a
    load factor with its stress resultants is enough.

    Parameters
    ----------
    model : Model
        The structure.
    result : Claim, or any result of limitblocks
        What is claimed, with the flow rule that it names; bounds are judged by the associated flow.
    tolerance : float, optional
        Largest residual of a solution, positive and finite; left out, that of the analysis: 1e-6 of bounds,
        else 1e-8.
    backward_error : float, optional
        Largest change of the model for which the claim may be exact instead, such as 1e-4; see
        :class:`limitblocks.evidence.backward_error.BackwardError`. Without it only the tolerance counts.

    Raises
    ------
    ModelError
        If the claim belongs to another model, an array has the wrong shape or is not real and finite, or the
        tolerance is out of range.
    """
    checked_model(model)
    least = None if tolerance is None else real_number("tolerance", tolerance)
    if least is not None and not least > 0.0:
        raise ModelError(f"tolerance is {tolerance!r}, expected a number above 0, such as {TOLERANCE:g}")
    limit = checked_limit(backward_error)
    claim = claim_of(model, result)
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):  # undefined residuals are infinite
        if not isinstance(result, LoadPath):
            return _checked(model, claim, least, limit, tuple(_told(result)))
        found = _checked(model, claim, least, limit, (steps_residual(model, result),))
        return replace(found, remarks=(*found.remarks, UNJUDGED))


def _told(result: Any) -> Iterator[Residual]:
    """What a proof says beyond its bounds, which are judged."""
    proof = getattr(result, "proof", None)
    if not isinstance(proof, Proof) or not proof.complete:
        return
    if proof.lower > result.lower or proof.upper < result.upper:
        yield Residual("proof told", np.inf, f"what is told of the bounds is no more than they are; {proof}")


def _checked(
    model: Model, claim: Claim, least: float | None, limit: float | None, steps: tuple[Residual, ...]
) -> Check:
    problem = model.problem
    flow = Flow(problem, claim.dilatancy, turning_of(claim.turning))
    state, mechanism_found = _state(model, flow, claim)
    upper = claim.upper if flow.associated else None
    tolerance = least or (TOLERANCE if upper is None else OF_BOUNDS)
    judged = mcp_residuals(flow, state) if upper is None else _of_bounds(flow, claim, state, upper)
    entries = (*judged.entries, *steps, _standing(problem, claim))
    error = backward_error(flow, state)
    remarks = given_power(flow, state, tolerance) + locked_shear(flow, state)
    remarks += locked_tension(model, flow, state) + beyond_stress_block(model, claim.stress_resultants)
    remarks += far_off(error, judged, tolerance) if upper is None else ()
    remarks += other_convention(problem, state) if judged["equilibrium"] > tolerance else ()
    return Check(Residuals(entries), tolerance, error, limit, mechanism_found, remarks, model.digest)


def _of_bounds(flow: Flow, claim: Claim, state: State, upper: float) -> Residuals:
    """Residuals of both theorems; and whether the states prove the bounds, if that is claimed."""
    problem = flow.problem
    judged = bounds_residuals(flow, state, upper * problem.units.live)
    if not claim.proven:
        return judged
    dead = claim.dead_load_stresses
    proof = proof_of(problem, problem.in_si(state), state.x * problem.stress_units if dead is None else dead)
    beyond = max(claim.load_factor - proof.lower, proof.upper - upper)
    said = proof.static or proof.kinematic or f"proven are {proof.lower:.17g} and {proof.upper:.17g}"
    proven = Residual("proof", np.inf if beyond > 0.0 else 0.0, f"bounds that are theorems; {said}")
    return Residuals((*judged.entries, proven))


def _state(model: Model, flow: Flow, claim: Claim) -> tuple[State, bool]:
    """The claim as a dimensionless state, and whether its mechanism had to be searched for."""
    problem, u, y = model.problem, _rates(model, claim), claim.flow_multipliers
    rates = np.zeros(problem.C.shape[1]) if u is None else u
    multipliers = np.zeros(len(problem.g)) if y is None else y
    state = problem.dimensionless(State(claim.load_factor, _stresses(problem, claim), rates, multipliers))
    if u is not None and y is not None:
        return state, False
    rates, multipliers = find_mechanism(flow, state.x, None if u is None else state.u)
    return State(state.load_factor, state.x, rates, multipliers), True


def _standing(problem: LimitProblem, claim: Claim) -> Residual:
    """How far the dead loads alone are from standing."""
    given = claim.dead_load_stresses
    x = standing_state(problem) if given is None else given / problem.stress_units
    meaning = "the dead loads alone: a state in equilibrium within yield"
    if x is None:
        return Residual("standing", np.inf, meaning + " was not found")
    worst = Residuals(static_residuals(problem, 0.0, x)).worst
    return Residual("standing", worst.value, f"{meaning}; {worst.meaning}", worst.where)


def _stresses(problem: LimitProblem, claim: Claim) -> Array:
    """Generalised stresses of the claim, N and N m."""
    B, units = problem.resultants, problem.units.resultants
    resultants = claim.stress_resultants.ravel() / units
    if claim.generalised_stresses is None:
        if B.nnz > B.shape[1]:
            raise ModelError(
                "this model has joints with inner forces (point contacts), which the stress resultants do "
                "not determine: give generalised_stresses too"
            )
        return np.asarray((B.T @ resultants) * problem.stress_units)
    x = claim.generalised_stresses / problem.stress_units
    off, size = np.abs(B @ x - resultants), abs(B) @ np.abs(x) + np.abs(resultants)
    off, size = (part.reshape(-1, 6).max(axis=1) for part in (off, size))  # of each interface
    worst = residual("resultants", off, "", size)
    if not worst.value <= TOLERANCE:
        raise ModelError(
            f"generalised stresses and stress resultants differ by {worst.value:.1e} of their size"
        )
    return np.asarray(claim.generalised_stresses)


def _rates(model: Model, claim: Claim) -> Array | None:
    """Rates of the free blocks in SI units, if the claim has rates."""
    if claim.displacement_rates is None:
        return None
    for k in np.flatnonzero(~model.free & claim.displacement_rates.any(axis=1)).tolist():
        raise ModelError(f"displacement rates move the support {model.blocks[k].name!r}, expected zero")
    return claim.displacement_rates[model.free].ravel()

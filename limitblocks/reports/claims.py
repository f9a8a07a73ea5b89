"""What was read from a file, with what the checker says of it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import isfinite
from typing import Any, ClassVar

from limitblocks.arrays import Array
from limitblocks.errors import CheckFailed
from limitblocks.evidence.associated import Bounds
from limitblocks.evidence.check import Check, check_mcp
from limitblocks.evidence.claim import Claim, claim_of
from limitblocks.evidence.ending import Status
from limitblocks.evidence.load_path_result import LoadPath, compared
from limitblocks.evidence.proof import Proof
from limitblocks.evidence.range_result import LoadFactorRange
from limitblocks.evidence.residuals import OF_BOUNDS, TOLERANCE
from limitblocks.evidence.results import Nonassociated
from limitblocks.evidence.steps import steps_residual
from limitblocks.kinds import kind_of, named
from limitblocks.model import Model


@dataclass(frozen=True, eq=False)
class CheckedClaim:
    """A claimed solution, such as one read from a file, and its check."""

    claim: Claim
    check: Check
    title: ClassVar[str] = Claim.title

    @property
    def collapse(self) -> Claim:
        """The state claimed, of the model it was checked with."""
        return replace(self.claim, digest=self.digest)

    @property
    def load_factor(self) -> float:
        """The load factor claimed."""
        return self.claim.load_factor

    @property
    def certified(self) -> bool:
        """Whether it passed as a solution without the dilatancy of associated flow."""
        return self.check.accepted and isfinite(self.claim.dilatancy)

    @property
    def displacement_rates(self) -> Array | None:
        """The mechanism claimed, if there is one."""
        return self.claim.displacement_rates

    @property
    def digest(self) -> str:
        """SHA-256 of the model."""
        return self.check.digest

    def to_dict(self) -> dict[str, Any]:
        """Return load factor, dilatancy and check as plain numbers and text."""
        associated = not isfinite(self.claim.dilatancy)
        return {
            "analysis": "claim",
            "load_factor": self.load_factor,
            "dilatancy": None if associated else self.claim.dilatancy,
            "check": self.check.to_dict(),
        }


def checked(model: Model, result: Any) -> Any:
    """Return a claim with its check, and what was read from a file as it is judged here.

    What was read and proves to be what it says stays of its class, with residuals recomputed; what does not
    is a claim with its check. A result of this session is returned as it is.

    Raises
    ------
    ModelError
        It belongs to another model.
    CheckFailed
        A range has an answer that is no solution.
    """
    if isinstance(result, Claim):
        return CheckedClaim(result, check_mcp(model, result))
    kind = kind_of(result) if getattr(result, "from_file", False) else None
    return named(kind.judge)(model, result) if kind and kind.judge else result


def judged_bounds(model: Model, bounds: Bounds) -> Bounds | CheckedClaim:
    """Return bounds that the check has proven again, or the claim of them that it has not."""
    tolerance = min(bounds.tolerance, OF_BOUNDS)
    check = check_mcp(model, bounds, tolerance=tolerance)
    if not check.passed:
        return CheckedClaim(claim_of(model, bounds), check)
    found = check.residuals
    proof = Proof(bounds.lower, bounds.upper) if bounds.proven else bounds.proof  # the check has proven them
    gap, worth = found["gap"], found["worth"]
    bounds = replace(bounds, residuals=found, tolerance=tolerance, proof=proof, gap=gap, worth=worth)
    return replace(bounds, remarks=check.remarks)


def judged_nonassociated(model: Model, result: Nonassociated) -> Nonassociated | CheckedClaim:
    """Return the solution with the residuals of the check, or the claim that is none."""
    tolerance = min(result.tolerance, TOLERANCE)
    check = check_mcp(model, result, tolerance=tolerance)
    if result.accepted and not check.passed:
        return CheckedClaim(claim_of(model, result), check)
    refused = result.status in (Status.UNSETTLED, Status.OTHER_WAY)  # for what its residuals do not tell
    return replace(
        result,
        residuals=check.residuals,
        backward_error=check.backward_error,
        status=Status.CONVERGED if check.passed and not refused else result.status,
        remarks=tuple(dict.fromkeys(check.remarks + result.remarks)),
        tolerance=tolerance,
    )


def judged_path(model: Model, path: LoadPath) -> LoadPath | CheckedClaim:
    """Return the path with its collapse as it is judged, or the claim that is none."""
    end = judged_nonassociated(model, path.collapse)
    if isinstance(end, CheckedClaim):
        return end
    if not steps_residual(model, path).value <= end.tolerance:
        return CheckedClaim(claim_of(model, path), check_mcp(model, path, tolerance=end.tolerance))
    known = isfinite(path.tracked)
    told = compared(path.load_factor, path.tracked, end.accepted) if known else path.remarks[:1]
    return replace(path, collapse=end, remarks=(*told, *path.remarks[1:]))


def judged_range(model: Model, result: LoadFactorRange) -> LoadFactorRange:
    """Return the range with every answer checked.

    Raises
    ------
    CheckFailed
        One of them is no solution.
    """
    answers = []
    for one in result.answers:
        check = check_mcp(model, one.solution)
        if not check.passed:
            raise CheckFailed(
                f"the range that was read has an answer, load factor {one.load_factor:.6g}, that is no "
                f"solution: {check.worst}; expected what load_factor_range saved"
            )
        solution = replace(one.solution, residuals=check.residuals, backward_error=check.backward_error)
        answers.append(replace(one, solution=replace(solution, status=Status.CONVERGED), check=check))
    first = next((k for k, one in enumerate(result.answers) if one is result.load_path), None)
    return replace(result, answers=tuple(answers), load_path=None if first is None else answers[first])

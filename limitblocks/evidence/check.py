"""Check of a claimed solution against Eqs (54)-(59); numpy and scipy only, no trust in any solver."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import CheckFailed, ModelError
from limitblocks.evidence.mechanism import find_mechanism
from limitblocks.evidence.residuals import Residual, Residuals, residual, static_residuals
from limitblocks.model import Model
from limitblocks.problem import LimitProblem
from limitblocks.problem.flow import plastic_potential

TOLERANCE = 1e-6


class Claimed(Protocol):
    """What a claimed solution has at least; see :class:`Claim` for the rest."""

    @property
    def load_factor(self) -> float:
        """Load factor."""

    @property
    def stress_resultants(self) -> Array:
        """Stress resultants, shape (m, 6), N and N m."""


@dataclass(frozen=True, eq=False)
class Claim:
    """A claimed solution, from any source, in SI units.

    Attributes
    ----------
    load_factor : float
        Load factor.
    stress_resultants : Array, shape (m, 6)
        (V1, V2, N, M1, M2, T) of the model's interfaces, local axes, N and N m; N <= 0 in compression.
    displacement_rates : Array, shape (n, 6), optional
        Of all blocks of the model at their centroids, global axes, m and rad, in the scale in which the live
        load does the work 1 N m, Eq. (55); searched for if missing.
    flow_multipliers : Array, shape (R,), optional
        Of the rows of the limit problem, m, in the same scale; searched for if missing.
    generalised_stresses : Array, shape (s,), optional
        Stresses that the rows act on, N and N m; needed where a joint has inner forces (PointContact).
    dilatancy : float
        Tangent of the dilatancy angle of the flow.
    digest : str
        SHA-256 of the model it belongs to; empty if unknown.
    """

    load_factor: float
    stress_resultants: Array
    displacement_rates: Array | None = None
    flow_multipliers: Array | None = None
    generalised_stresses: Array | None = None
    dilatancy: float = 0.0
    digest: str = ""


@dataclass(frozen=True)
class Check:
    """Residuals of Eqs (54)-(59) for a claimed solution."""

    residuals: Residuals
    tolerance: float
    mechanism_found: bool
    digest: str

    @property
    def passed(self) -> bool:
        """True if every residual is within the tolerance."""
        return not self.residuals.above(self.tolerance)

    @property
    def worst(self) -> Residual:
        """The largest residual."""
        return self.residuals.worst

    def require(self) -> None:
        """Raise CheckFailed, naming every residual above the tolerance, unless the check passed."""
        failed = self.residuals.above(self.tolerance)
        if failed:
            said = ", ".join(f"{entry.name} {entry.value:.1e} ({entry.meaning})" for entry in failed)
            raise CheckFailed(f"above {self.tolerance:g}: {said}")

    def to_dict(self) -> dict[str, Any]:
        """Return the check as plain numbers and text."""
        return {
            "analysis": "check",
            "passed": self.passed,
            "residuals": self.residuals.to_dict(),
            "tolerance": self.tolerance,
            "mechanism_found": self.mechanism_found,
        }

    def __str__(self) -> str:
        word = "passed" if self.passed else "FAILED"
        source = ", mechanism found by the checker" if self.mechanism_found else ""
        return f"check {word}: worst residual {self.worst.value:.1e} ({self.worst.name}){source}"


def check_mcp(model: Model, result: Claimed, *, tolerance: float = TOLERANCE) -> Check:
    """Check a claimed non-associated solution residual by residual, Eqs (54)-(59).

    Residuals are dimensionless: forces over the mean block weight, displacement rates in the scale in
    which the live load of unit resultant does unit work. Undefined is infinite. A missing mechanism or
    missing multipliers are searched for, so that a load factor with its stress resultants is enough.

    Parameters
    ----------
    model : Model
        The structure.
    result : Claim, or any result of limitblocks
        What is claimed.
    tolerance : float
        Largest residual of a solution.

    Raises
    ------
    ModelError
        If the claim belongs to another model, or an array has the wrong shape.
    """
    problem = model.problem
    claim = _claim(model, result)
    load_factor = claim.load_factor / problem.scales.load_factor
    x = _stresses(problem, claim)
    u = _rates(model, claim)
    y = None if claim.flow_multipliers is None else claim.flow_multipliers / problem.scales.work
    found = u is None or y is None
    if found:
        u, y = find_mechanism(problem, x, claim.dilatancy, rates=u)
    assert u is not None
    assert y is not None
    residuals = mcp_residuals(problem, load_factor, x, u, y, claim.dilatancy)
    return Check(residuals, tolerance, found, model.digest)


def mcp_residuals(
    problem: LimitProblem,
    load_factor: float,
    stresses: Array,
    rates: Array,
    multipliers: Array,
    dilatancy: float,
) -> Residuals:
    """Recompute the residuals of Eqs (54)-(59); all arguments dimensionless, see LimitProblem."""
    G = plastic_potential(problem, stresses, dilatancy)
    margin = problem.cones.margin(multipliers)
    work = (problem.F @ stresses + problem.g) @ multipliers
    flow = problem.C @ rates + G.T @ multipliers
    return Residuals(
        (
            *static_residuals(problem, load_factor, stresses),
            residual("flow", flow, "compatibility and flow rule, Eq. (54)"),
            residual("normalisation", problem.live @ rates - 1.0, "work of the live load less one, Eq. (55)"),
            residual("multipliers", np.minimum(margin, 0.0), "most negative flow multiplier, Eq. (58)"),
            residual("complementarity", work, "yield functions times multipliers, Eq. (59)"),
        )
    )


def _claim(model: Model, result: Claimed) -> Claim:
    names = ("displacement_rates", "flow_multipliers", "generalised_stresses")
    optional = {name: getattr(result, name, None) for name in names}
    claim = Claim(
        load_factor=float(result.load_factor),
        stress_resultants=np.asarray(result.stress_resultants, dtype=float),
        dilatancy=float(getattr(result, "dilatancy", 0.0)),
        digest=str(getattr(result, "digest", "")),
        **{name: None if value is None else np.asarray(value, float) for name, value in optional.items()},
    )
    if claim.digest and claim.digest != model.digest:
        raise ModelError(
            f"the result belongs to model {claim.digest[:12]}, not to this model {model.digest[:12]}"
        )
    problem = model.problem
    expected = {
        "stress_resultants": (len(model.interfaces), 6),
        "displacement_rates": (len(model.blocks), 6),
        "flow_multipliers": (problem.F.shape[0],),
        "generalised_stresses": (problem.C.shape[0],),
    }
    for name, shape in expected.items():
        value = getattr(claim, name)
        if value is not None and value.shape != shape:
            raise ModelError(f"{name} has shape {value.shape}, expected {shape} for this model")
    return claim


def _stresses(problem: LimitProblem, claim: Claim) -> Array:
    """Generalised stresses of the claim, dimensionless."""
    B = problem.resultants
    resultants = (claim.stress_resultants / problem.scales.resultants).ravel()
    if claim.generalised_stresses is None:
        if B.nnz > B.shape[1]:
            raise ModelError(
                "this model has joints with inner forces (point contacts), which the stress resultants do "
                "not determine: give generalised_stresses too"
            )
        return np.asarray(B.T @ resultants)
    stresses = claim.generalised_stresses / problem.stress_units
    off = float(np.abs(B @ stresses - resultants).max(initial=0.0))
    if not off <= TOLERANCE * max(1.0, float(np.abs(resultants).max(initial=0.0))):
        raise ModelError(f"generalised stresses and stress resultants differ by {off:.1e} block weights")
    return np.asarray(stresses)


def _rates(model: Model, claim: Claim) -> Array | None:
    """Dimensionless rates of the free blocks in the scale live . u = 1, if the claim has rates."""
    if claim.displacement_rates is None:
        return None
    moving = dict(zip((block.name for block in model.blocks), claim.displacement_rates, strict=True))
    for name in model.supports:
        if np.any(moving[name] != 0.0):
            raise ModelError(f"displacement rates move the support {name!r}, expected zero")
    problem = model.problem
    return np.concatenate([moving[name] for name in problem.blocks]) / problem.rate_units

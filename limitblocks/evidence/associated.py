"""Result of the associated bounds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from limitblocks.arrays import Array
from limitblocks.evidence.claim import ARRAYS
from limitblocks.evidence.proof import Proof
from limitblocks.evidence.residuals import Residuals
from limitblocks.problem import ASSOCIATED, Turning
from limitblocks.shown import Result, kept


@dataclass(frozen=True, eq=False, repr=False)
class Bounds(Result):
    """Bounds on the load factor of the associated flow, with the states that prove them.

    For the yield surface used, a structure with associated flow collapses between `lower` (a stress state
    in equilibrium within the yield surface) and `upper` (a mechanism). They are the two
    solutions, primal and dual, of one convex program; each is judged by residuals of its own.

    Attributes
    ----------
    lower, upper : float
        Static and kinematic load factor; equal up to `gap`. Where `proven`, ``lower <= load factor <= upper``
        is a theorem about the numbers of the limit problem, rounding errors included.
    gap : float
        Difference relative to the load factor; where that is less than the rounding errors of the power of
        all forces, relative to those.
    worth : float
        What the violations of both states may be worth in the load factor, relative to it, added up in size.
    stress_resultants : Array, shape (m, 6)
        (V1, V2, N, M1, M2, T) of each interface at the lower bound, local axes, N and N m; N <= 0.
    generalised_stresses : Array, shape (s,)
        What the joints' rows act on, N and N m: for OrdunaLourenco the stress resultants, for PointContact
        the forces of the points, in the order of the limit problem.
    displacement_rates : Array, shape (n, 6)
        Mechanism of the upper bound: (du, dv, dw, dwX, dwY, dwZ) of each block of the model at its centroid,
        global axes, such that the live load does the work 1 N m, Eq. (55); zero for supports.
    flow_multipliers : Array, shape (R,)
        Flow multiplier of each row of the limit problem, m, in the scale of the mechanism.
    dead_load_stresses : Array, shape (s,)
        Generalised stresses, N and N m, that carry the dead loads alone.
    residuals : Residuals
        Recomputed from the limit problem without the solver; all at most `tolerance`.
    proof : Proof
        What is proven, and why a side is not where it is not.
    solvers : tuple of str
        Solver of the stress state and of the mechanism.
    tolerance : float
        Largest residual and gap asked for; what is proven may lie farther apart, and the text says so.
    digest : str
        SHA-256 of the model.
    remarks : tuple of str
        What a reader of the load factors should know.
    """

    lower: float
    upper: float
    gap: float
    worth: float
    stress_resultants: Array
    generalised_stresses: Array
    displacement_rates: Array
    flow_multipliers: Array
    dead_load_stresses: Array
    residuals: Residuals
    proof: Proof
    solvers: tuple[str, str]
    tolerance: float
    digest: str
    remarks: tuple[str, ...] = ()

    title: ClassVar[str] = "Associated bounds"

    @property
    def collapse(self) -> Bounds:
        """The state at collapse: the stresses of the lower bound, the mechanism of the upper one."""
        return self

    @property
    def load_factor(self) -> float:
        """The static bound, as which :func:`limitblocks.check_mcp` judges the result."""
        return self.lower

    @property
    def dilatancy(self) -> float:
        """Infinite: the flow is associated at every interface."""
        return ASSOCIATED

    @property
    def turning(self) -> Turning:
        """Of no account where the flow is associated."""
        return Turning.CENTROID

    @property
    def proven(self) -> bool:
        """Whether the bounds are theorems, rounding errors included."""
        return self.proof.complete

    def __str__(self) -> str:
        worst = self.residuals.worst
        word = "proven" if self.proven else "not proven"
        return self._line(
            f"associated load factor {self.lower:.6g} (static) to {self.upper:.6g} (kinematic), "
            f"gap {self.gap:.1e}, worst residual {worst.value:.1e} ({worst.name}), {word}{self._wide}",
            *self.remarks,
        )

    @property
    def _wide(self) -> str:
        """What is said of proven bounds farther apart than the tolerance."""
        width = self.proof.width
        if not self.proven or width <= self.tolerance:
            return ""
        return f"; the bounds are {width:.1e} of it apart, more than the tolerance of {self.tolerance:g}"

    def to_dict(self) -> dict[str, Any]:
        """Return the result as plain numbers, lists and text."""
        told = {"lower": self.lower, "upper": self.upper} if self.proven else {}
        return {
            "analysis": "bounds",
            **kept(self, "lower", "upper", "gap", "worth", "proven", "residuals"),
            "proof": self.proof.to_dict() | told,  # what is proven are the bounds
            "residual_details": self.residuals.details(),
            **kept(self, "tolerance", "remarks", "solvers", *ARRAYS, "digest"),
        }

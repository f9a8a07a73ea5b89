"""Result of the non-associated analysis."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from limitblocks.arrays import Array
from limitblocks.evidence.backward_error import BackwardError
from limitblocks.evidence.claim import ARRAYS
from limitblocks.evidence.ending import Status
from limitblocks.evidence.residuals import Residuals
from limitblocks.problem import Turning
from limitblocks.shown import Result, kept

#: Logger told of each Iteration, at debug level: also of a search within another analysis.
ITERATIONS = "limitblocks.iterations"


@dataclass(frozen=True)
class Iteration:
    """One point of the tracked path, one round of the fixed-point loop, or one step of the load path.

    Attributes
    ----------
    load_factor : float
        Load factor.
    kind : str
        "path" (a point of the tracked path), "fixed point" (a round of convex programs), "step" (an increment
        of the load path), "polish" (the end of any).
    step_size : float
        Dimensionless; of an increment the work of the live load. Of a path theta, what is left of compliance
        and barrier; of a round of the loop how far its friction envelopes are rotated.
    residuals : dict
        All residuals of Eqs (54)-(59); of a point of a path theta.
    inner, failures : int
        Factorisations (of a path so far, of an increment its own), and attempts that failed before.
    """

    load_factor: float
    kind: str
    step_size: float
    residuals: dict[str, float]
    inner: int
    failures: int

    def __str__(self) -> str:
        return f"{self.kind}: load factor {self.load_factor:.6g}"


@dataclass(frozen=True, eq=False, repr=False)
class Nonassociated(Result):
    """Load factor for the paper's flow rule (zero dilatancy unless said), with the state that proves it.

    A non-associated load factor is not unique; this is one solution of Eqs (54)-(59), reached from the
    permanent loads. Every solution is at most `associated` and, where that is claimed, at least
    `frictionless`.

    Attributes
    ----------
    load_factor : float
        Load factor at collapse.
    frictionless, associated : float
        The bracket: the largest load factor without shear (Drucker 1954), and the associated one. The first
        is NaN where it is not claimed to be a lower end, the second infinite where the load is unlimited.
    stress_resultants : Array, shape (m, 6)
        (V1, V2, N, M1, M2, T) of each interface, local axes, N and N m; N <= 0 in compression.
    generalised_stresses : Array, shape (s,)
        What the joints' rows act on, N and N m.
    displacement_rates : Array, shape (n, 6)
        Mechanism: rates of each block of the model at its centroid, global axes, m and rad, such that the
        live load does the work 1 N m, Eq. (55); zero for supports.
    flow_multipliers : Array, shape (R,)
        Flow multiplier of each row of the limit problem, m.
    residuals : Residuals
        Of Eqs (54)-(59), recomputed by the checker.
    backward_error : BackwardError
        How far from the model the one is of which the state is an exact solution.
    status : Status
        Whether it converged.
    how : str
        Which path led there, in words.
    history : tuple of Iteration
        Points of the tracked path or rounds of the loop and their end, or steps of the load path.
    dead_load_stresses : Array, shape (s,)
        Generalised stresses, N and N m, that carry the dead loads alone.
    dilatancy : float
        Tangent of the dilatancy angle.
    turning : Turning
        What twisting under bending turns about.
    remarks : tuple of str
        What a reader of the load factor should know, such as a shear that polyhedral friction locks.
    tolerance : float
        Largest residual of a converged solution.
    digest : str
        SHA-256 of the model.
    unclaimed : str
        Why `frictionless` is NaN, such as a turning with which joints can give power; else empty.
    fixed_point_change : float, optional
        What a round of the fixed point, limit analysis with the flow frozen at this state, changes in the
        load factor, over it; zero but for rounding at a solution, whatever its mechanism, infinite where
        the round has no answer. None where it was not asked for, or the analysis did not converge.
    """

    load_factor: float
    frictionless: float
    associated: float
    stress_resultants: Array
    generalised_stresses: Array
    displacement_rates: Array
    flow_multipliers: Array
    dead_load_stresses: Array
    residuals: Residuals
    backward_error: BackwardError
    status: Status
    how: str
    history: tuple[Iteration, ...] = field(repr=False)
    dilatancy: float
    turning: Turning
    remarks: tuple[str, ...]
    tolerance: float
    digest: str
    unclaimed: str = ""
    fixed_point_change: float | None = None

    title: ClassVar[str] = "Non-associated"

    @property
    def collapse(self) -> Nonassociated:
        """The state at collapse, which is this one."""
        return self

    @property
    def converged(self) -> bool:
        """True if every residual is within the tolerance."""
        return self.status is Status.CONVERGED

    @property
    def accepted(self) -> bool:
        """True if it converged, or is exact for a model as near as was asked for."""
        return self.status in (Status.CONVERGED, Status.NEARBY)

    @property
    def astray(self) -> bool:
        """True if it is no solution and nothing bounds its load factor, so that this says nothing."""
        return not self.accepted and self.associated == np.inf

    def __str__(self) -> str:
        worst = self.residuals.worst
        word = "" if self.converged else f" ({self.status.value})"
        change = self.fixed_point_change
        confirmed = "" if change is None else f", fixed point within {change:.1e}"
        least, said = f"between {self.frictionless:.6g} (frictionless) and", self.remarks
        if np.isnan(self.frictionless):
            least, said = "at most", (f"lower end not claimed: {self.unclaimed}", *said)
        found = f"{self.load_factor:.6g}"
        if self.astray:
            found = "none found"
        return self._line(
            f"non-associated load factor {found}, {least} {self.associated:.6g} (associated), "
            f"worst residual {worst.value:.1e} ({worst.name}), {self.backward_error}{confirmed}{word}",
            *said,
        )

    def to_dict(self) -> dict[str, Any]:
        """Return the result as plain numbers, lists and text."""
        return {
            "analysis": "nonassociated",
            **kept(self, "load_factor", "frictionless", "unclaimed", "associated", "status", "dilatancy"),
            **kept(self, "turning", "remarks", "residuals"),
            "residual_details": self.residuals.details(),
            **kept(self, "tolerance", "backward_error", "how", "fixed_point_change", "history"),
            **kept(self, *ARRAYS, "digest"),
        }

"""A claim of somebody's, with what the checker says of it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import isfinite
from typing import Any, ClassVar

from limitblocks.arrays import Array
from limitblocks.evidence.check import Check, check_mcp
from limitblocks.evidence.claim import Claim
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
    """Return a claim with its check; any other result as it is."""
    return CheckedClaim(result, check_mcp(model, result)) if isinstance(result, Claim) else result

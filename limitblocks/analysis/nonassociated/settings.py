"""Settings of the increments of the load path."""

from __future__ import annotations

from dataclasses import dataclass

from limitblocks.joints.base import checked_count
from limitblocks.mechanics.loads.load import number


@dataclass(frozen=True)
class Settings:
    """How the load path steps; all numbers are dimensionless.

    Attributes
    ----------
    first : float
        First increment, as the load factor it would add to elastic joints over the associated load factor.
    growth : float
        Each increment is this times the one before, and smaller by its square where it fails.
    barrier : float
        Size of the barrier along an increment, over the mean load of a block; it is gone at its end. Snaps
        smaller than what it rounds off are not seen.
    left : float
        What is left of the barrier at the end of an increment that is far from collapse, as `barrier`.
    budget : int
        Factorisations of all increments together; a push without end from the last has its own.
    """

    first: float = 0.05
    growth: float = 1.4
    barrier: float = 1e-2
    left: float = 1e-10
    budget: int = 4000

    def __post_init__(self) -> None:
        for word in ("first", "barrier", "left"):
            number(getattr(self, word), f"{word} of the settings", "", above=0.0)
        number(self.growth, "growth of the settings", "", above=1.0)
        checked_count("budget of the settings", self.budget, 0)

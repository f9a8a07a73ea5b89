"""Settings of the implicit steps of the load path."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Settings:
    """How the load path steps; all numbers are dimensionless.

    Attributes
    ----------
    first : float
        First step, as the load factor it would add to elastic joints over the associated load factor.
    growth : float
        Steps grow by this factor after a success, and shrink by it where every retry failed.
    longest, last : float
        Longest step until the flow residual is 1e-3, and after that.
    retries : tuple of (float, float)
        (divisor of the step, viscosity of the multipliers) tried in turn; the first is the plain
        quasi-static step, a divisor above one a smaller step, a viscosity a jump across a snap.
    near, close : float
        Flow residual below which the fixed point is tried, where steps fail and where they do not.
    drift : float
        Change of the load factor, relative, up to which the fixed point belongs to the state it started
        from; farther solutions are kept in case the steps find nothing better.
    rounds : int
        Rounds of the fixed point.
    iterations, leap, budget, patience : int
        Newton iterations of one step, of the leap that closes them (0: none), of all together, and after the
        first solution kept.
    """

    first: float = 0.4
    growth: float = 3.0
    longest: float = 50.0
    last: float = 5e3
    retries: tuple[tuple[float, float], ...] = ((1.0, 0.0), (1.0, 1e-4), (1.0, 1e-3), (1.0, 1e-2))
    near: float = 0.1
    close: float = 1e-2
    drift: float = 1e-3
    rounds: int = 10
    iterations: int = 60
    leap: int = 100
    budget: int = 1000
    patience: int = 300

"""Residuals of a claimed solution, recomputed from the limit problem with numpy alone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from limitblocks.arrays import Array
from limitblocks.problem import LimitProblem

SMALL_LOAD = 0.1  # block weights; a live load below it is compared in these units


@dataclass(frozen=True)
class Residual:
    """One recomputed condition: its name, its value (dimensionless, >= 0) and what it measures."""

    name: str
    value: float
    meaning: str


@dataclass(frozen=True)
class Residuals:
    """Residuals of a claimed solution. Undefined values (NaN) count as infinite."""

    entries: tuple[Residual, ...]

    def __getitem__(self, name: str) -> float:
        return next(entry.value for entry in self.entries if entry.name == name)

    @property
    def worst(self) -> Residual:
        """The largest residual."""
        return max(self.entries, key=lambda entry: entry.value)

    def above(self, tolerance: float) -> tuple[Residual, ...]:
        """Residuals larger than `tolerance`."""
        return tuple(entry for entry in self.entries if entry.value > tolerance)

    def to_dict(self) -> dict[str, float]:
        """Name and value of each residual."""
        return {entry.name: entry.value for entry in self.entries}


def residual(name: str, values: Array | float, meaning: str) -> Residual:
    """Largest absolute value as a residual; NaN becomes infinite, nothing becomes zero."""
    largest = float(np.max(np.abs(values), initial=0.0))
    return Residual(name, largest if np.isfinite(largest) else np.inf, meaning)


def static_residuals(problem: LimitProblem, load_factor: float, stresses: Array) -> tuple[Residual, ...]:
    """Residuals of the static theorem, Eqs (56) and (57), in mean block weights."""
    unbalanced = problem.dead + load_factor * problem.live - problem.C.T @ stresses
    margin = problem.cones.margin(problem.F @ stresses + problem.g)
    return (
        residual("equilibrium", unbalanced, "largest unbalanced force or moment, Eq. (56)"),
        residual("yield", np.minimum(margin, 0.0), "largest violation of a yield function, Eq. (57)"),
    )


def kinematic_residuals(
    problem: LimitProblem, load_factor: float, displacement_rates: Array, multipliers: Array
) -> tuple[Residual, ...]:
    """Residuals of the kinematic theorem for the associated flow, Eqs (54), (55) and (58).

    The displacement rates are measured so that the live load, of unit resultant, does unit work.
    """
    strain_rates = problem.C @ displacement_rates
    work = problem.live @ displacement_rates
    power = problem.g @ multipliers - problem.dead @ displacement_rates
    excess = (power - load_factor) / max(abs(load_factor), SMALL_LOAD)
    return (
        residual("flow", strain_rates + problem.F.T @ multipliers, "compatibility and flow rule, Eq. (54)"),
        residual("normalisation", work - 1.0, "work of the live load less one, Eq. (55)"),
        residual(
            "multipliers",
            np.minimum(problem.cones.margin(multipliers), 0.0),
            "most negative flow multiplier, Eq. (58)",
        ),
        residual("power", excess, "dissipation less work of the dead loads against the load factor"),
    )


def relative_gap(lower: float, upper: float) -> float:
    """Return |upper - lower| over the larger bound, or over a tenth of a block weight if both are less."""
    return abs(upper - lower) / max(abs(lower), abs(upper), SMALL_LOAD)


def worth_of_violations(
    problem: LimitProblem, lower: float, stresses: Array, rates: Array, multipliers: Array
) -> float:
    """Return what the violations of a pair of bounds may be worth in the load factor, dimensionless.

    With r the unbalanced loads, f = C u + F^T y and s = F x + g, identically
    upper - lower = s.y - x.f - r.u + lower (live.u - 1), and s.y >= 0 for s and y in K. All other terms, and
    those that put s and y into K, are added up in size: violations of 1e-10 may hide a gap of 1e-6.
    """
    s = problem.F @ stresses + problem.g
    unbalanced = problem.dead + lower * problem.live - problem.C.T @ stresses
    flow = problem.C @ rates + problem.F.T @ multipliers
    groups = [first + size * np.arange(count) for first, count, size in problem.cones.blocks]
    heads = np.concatenate([np.arange(problem.cones.linear), *groups])
    outside = [np.maximum(-problem.cones.margin(rows), 0.0) for rows in (s, multipliers)]
    return float(
        np.abs(stresses) @ np.abs(flow)
        + np.abs(unbalanced) @ np.abs(rates)
        + abs(lower * (problem.live @ rates - 1.0))
        + outside[0] @ np.abs(multipliers[heads])
        + outside[1] @ np.abs(s[heads])
    )

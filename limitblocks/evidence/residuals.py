"""Residuals of a claimed state, recomputed from the limit problem with numpy alone.

What they are measured by is in :mod:`limitblocks.evidence.measure`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from limitblocks.arrays import Array, Indices
from limitblocks.errors import ModelError
from limitblocks.evidence.measure import Measure
from limitblocks.problem import Flow, LimitProblem, State
from limitblocks.shown import Tabular, many

OF_BOUNDS = 1e-6  # largest residual, gap and worth of a pair of bounds
TOLERANCE = 1e-8  # largest residual of an answer

POWER = "the power of the interface's own force on it over that of the live load"


@dataclass(frozen=True)
class Residual:
    """One recomputed condition.

    Attributes
    ----------
    name : str
        Such as "equilibrium".
    value : float
        Dimensionless, >= 0.
    meaning : str
        What it measures.
    where : str
        Interface or block where it is largest.
    """

    name: str
    value: float
    meaning: str
    where: str = ""

    def __str__(self) -> str:
        place = f" at {self.where}" if self.where else ""
        return f"{self.name} {self.value:.1e}{place} ({self.meaning})"


def nearest(tried: Sequence[Residual], what: str) -> str:
    """Return what is said of the best of all that was tried, each by its worst residual."""
    best = min(tried, key=lambda one: one.value)
    place = f" at {best.where}" if best.where else ""
    return f"the best of {many(len(tried), what)} has the {best.name} residual {best.value:.1e}{place}"


@dataclass(frozen=True, repr=False)
class Residuals(Tabular):
    """Residuals of a claimed solution, dimensionless. Undefined values (NaN) count as infinite.

    Every block is measured by what acts on it, every interface by what acts on the lesser of its blocks, a
    rate by the power of that force on it over that of the live load. ``residuals["flow"]`` is one by name.

    Attributes
    ----------
    entries : tuple of Residual
    """

    entries: tuple[Residual, ...]

    def __getitem__(self, name: str) -> float:
        known = self.to_dict()
        if name not in known:
            raise ModelError(f"there is no residual {name!r}; there are {', '.join(known)}")
        return known[name]

    @property
    def worst(self) -> Residual:
        """The largest residual."""
        return max(self.entries, key=lambda entry: entry.value)

    def above(self, tolerance: float) -> tuple[Residual, ...]:
        """Residuals larger than `tolerance`."""
        return tuple(entry for entry in self.entries if entry.value > tolerance)

    def rows(self) -> list[dict[str, Any]]:
        """Return a row for each residual: what it is, how large, where."""
        return [
            {"residual": entry.name, "value": entry.value, "at": entry.where, "meaning": entry.meaning}
            for entry in self.entries
        ]

    def to_dict(self) -> dict[str, float]:
        """Name and value of each residual."""
        return {entry.name: entry.value for entry in self.entries}

    def details(self) -> dict[str, list[str]]:
        """What each residual measures, and where it is largest."""
        return {entry.name: [entry.meaning, entry.where] for entry in self.entries}

    def __str__(self) -> str:
        return "; ".join(f"{entry.name} {entry.value:.1e}" for entry in self.entries)


def residual(
    name: str,
    values: Array | float,
    meaning: str,
    scale: Array | float = 1.0,
    where: Sequence[str] = (),
    of: Indices | None = None,
) -> Residual:
    """Largest size of `values` over `scale` as a residual, and the place in `where` of it.

    `of` numbers the places of the values; left out, there is one for each. Nothing over nothing is zero;
    something over nothing, and NaN, is infinite.
    """
    size, scale = np.abs(np.atleast_1d(values)), np.asarray(scale)
    shares = np.where(size == 0.0, 0.0, np.inf)
    np.divide(size, scale, out=shares, where=(scale > 0.0) & np.isfinite(scale) & np.isfinite(size))
    if not len(shares):
        return Residual(name, 0.0, meaning)
    k = int(shares.argmax())
    return Residual(name, float(shares[k]), meaning, where[k if of is None else of[k]] if len(where) else "")


def largest_of(problem: LimitProblem, values: Array) -> Array:
    """Largest size of values of generalised stresses (s,) at each interface, shape (m,)."""
    largest = np.zeros(len(problem.interfaces))
    np.maximum.at(largest, problem.stress_interface, np.abs(values))
    return largest


def static_residuals(
    problem: LimitProblem, load_factor: float, x: Array, measure: Measure | None = None
) -> tuple[Residual, ...]:
    """Residuals of the static theorem, Eqs (56) and (57)."""
    none = np.zeros(0)
    measure = measure or Measure(problem, State(load_factor, x, none, none))
    margin = problem.cones.margin(measure.slack)
    k = problem.member_interface
    rows = problem.units.row[problem.cones.heads]
    return (
        residual(
            "equilibrium",
            np.abs(measure.unbalanced).reshape(-1, 6).max(axis=1),
            "unbalanced force or moment over what acts on the block, Eq. (56)",
            measure.loaded,
            problem.blocks,
        ),
        residual(
            "yield",
            np.minimum(margin, 0.0) * rows,
            "violation of a yield function over what acts on the block, Eq. (57)",
            measure.interface[k],
            problem.interfaces,
            k,
        ),
    )


def kinematic_residuals(measure: Measure, force: Array, broken: Array) -> tuple[Residual, ...]:
    """Residuals of the mechanism, Eqs (54), (55) and (58): the power of a `force` (m,) of each interface.

    `broken` (s,) are the strain rates that break the flow rule.
    """
    p, state, k = measure.problem, measure.state, measure.problem.member_interface
    negative = np.minimum(p.cones.margin(state.y), 0.0) / p.units.row[p.cones.heads]
    return (
        residual(
            "flow",
            largest_of(p, broken) * force,
            f"compatibility and flow rule, Eq. (54), {POWER}",
            measure.power,
            p.interfaces,
        ),
        residual("normalisation", p.live @ state.u - 1.0, "work of the live load less one, Eq. (55)"),
        residual(
            "multipliers",
            negative * force[k],
            f"negative flow multiplier, Eq. (58), {POWER}",
            measure.power,
            p.interfaces,
            k,
        ),
    )


@np.errstate(over="ignore", invalid="ignore")  # those of a state that ran away are infinite
def mcp_residuals(flow: Flow, state: State) -> Residuals:
    """Recompute the residuals of Eqs (54)-(59) of a dimensionless state.

    Complementarity is judged row by row and cone by cone, as the size of the Jordan product (F x + g) o y: on
    a cone it is in proportion to the angle between the slip and the shear force. Without dissipation at every
    interface the theorems that enclose the load factor do not hold.
    """
    p, measure = flow.problem, Measure(flow.problem, state)
    product = p.cones.norm(p.cones.product(measure.slack, state.y))
    k = p.member_interface
    return Residuals(
        (
            *static_residuals(p, state.load_factor, state.x, measure),
            *kinematic_residuals(measure, measure.pressed, p.C @ state.u + flow.strains(state.x, state.y)),
            residual(
                "complementarity",
                product,
                f"yield function times multiplier, Eq. (59), {POWER}",
                measure.power,
                p.interfaces,
                k,
            ),
            residual(
                "dissipation",
                np.minimum(flow.dissipation(state.x, state.y), 0.0),
                "power that an interface gives instead of taking it up, over that of its own force",
                measure.power,
                p.interfaces,
            ),
        )
    )


@np.errstate(over="ignore", invalid="ignore")
def bounds_residuals(flow: Flow, state: State, upper: float) -> Residuals:
    """Recompute every residual of a pair of bounds; the state's load factor is the lower one."""
    problem, measure = flow.problem, Measure(flow.problem, state)
    power = problem.g @ state.y - problem.dead @ state.u
    return Residuals(
        (
            *static_residuals(problem, state.load_factor, state.x, measure),
            *kinematic_residuals(measure, measure.interface, measure.broken),
            residual(
                "power",
                power - upper,
                "dissipation less work of the dead loads against the upper bound",
                measure.power,
            ),
            residual("gap", upper - state.load_factor, "gap between the bounds", measure.load_factor),
            residual(
                "worth",
                worth_of_violations(measure),
                "what the violations of both states may be worth in the load factor, over it",
                measure.load_factor,
            ),
        )
    )


def worth_of_violations(measure: Measure) -> float:
    """Return what the violations of a pair of bounds may be worth in the load factor, dimensionless.

    With r the unbalanced loads, f = C u + F^T y and s = F x + g, identically
    upper - lower = s.y - x.f - r.u + lower (live.u - 1), and s.y >= 0 for s and y in K. All other terms, and
    those that put s and y into K, are added up in size: violations of 1e-10 may hide a gap of 1e-6.
    """
    problem, state, s = measure.problem, measure.state, measure.slack
    x, u, y, cones = state.x, state.u, state.y, problem.cones
    outside = [np.maximum(-cones.margin(rows), 0.0) for rows in (s, y)]
    return float(
        np.abs(x) @ np.abs(measure.broken)
        + np.abs(measure.unbalanced) @ np.abs(u)
        + abs(state.load_factor * (problem.live @ u - 1.0))
        + outside[0] @ np.abs(y[cones.heads])
        + outside[1] @ np.abs(s[cones.heads])
    )

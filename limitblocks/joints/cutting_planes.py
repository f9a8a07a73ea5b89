"""Strength of an interface whose rows act on point forces: a linear program with tangent planes of cones."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.optimize import linprog

from limitblocks.arrays import Array, Indices
from limitblocks.errors import SolverFailure
from limitblocks.joints.base import YieldRows

FIRST_PLANES = 16  # tangent planes of each cone to start with
LARGEST = 1e4  # of the given stresses and the direction, both of unit size: more is unlimited
UNLIMITED = LARGEST * (1 - 1e-6)
ROUNDS = 60
FAN = np.linspace(-1.0, 1.0, 9)  # tangent planes about a violated one, of the angle by which it is violated
# Of the planes, and so of the cones of forces of unit size. HiGHS gives up on some of these programs, whose
# planes all but coincide, with the first: with the next it does not.
TOLERANCES = (1e-10, 1e-9, 1e-8)


def farthest(rows: YieldRows, given: Array, direction: Array) -> tuple[float, Array]:
    """Return the largest t with `given` + t `direction` within the yield set, and the multipliers there.

    Kelley's method: cones (t0, z), sizes 3, become planes t0 - d.z >= 0, and each solution adds the
    planes it violates and some beside them, until none does by more than the tolerance.

    Parameters
    ----------
    rows : YieldRows
        Of one interface, all its points alike; no constant terms; a plane for each cone if there are cones.
    given, direction : Array, shape (6,)
        Stress resultants in units that make them of size one.

    Returns
    -------
    t : float
        Infinite without limit, NaN if `given` is outside the yield set.
    multipliers : Array, shape (k,)
        Rates (>= 0) of the planes and of the cones in the mechanism that limits t.

    Raises
    ------
    SolverFailure
        If HiGHS gives no answer, or the planes do not converge.
    """
    F, linear = rows.F[0], rows.linear
    cones = F[linear:].reshape(-1, 3, F.shape[1])
    owner = np.repeat(np.arange(len(cones)), FIRST_PLANES)
    angle = np.tile(2 * np.pi * np.arange(FIRST_PLANES) / FIRST_PLANES, len(cones))
    for k in range(ROUNDS):
        d = np.column_stack([np.cos(angle), np.sin(angle)])
        head, shear = cones[owner, 0], (d[:, None] @ cones[owner, 1:])[:, 0]
        solution, tolerance = _solved(rows, head - shear, given, direction)
        if solution.status == 2:
            return np.nan, np.zeros(0)
        if k == 0 and solution.x[-1] > UNLIMITED:  # of many solutions none need be within the cones
            within, _ = _solved(rows, np.cos(np.pi / FIRST_PLANES) * head - shear, given, direction)
            solution = within if within.status == 0 and within.x[-1] > UNLIMITED else solution
        force = cones @ solution.x[:-1]
        size = np.linalg.norm(force[:, 1:], axis=1)
        bad = np.flatnonzero(size - force[:, 0] > tolerance * max(1.0, solution.x[-1]))
        if not len(bad):
            t = np.inf if solution.x[-1] > UNLIMITED else float(solution.x[-1])
            return t, _rates(np.maximum(-solution.ineqlin.marginals, 0.0), rows, owner, d)
        # a plane violated by 1 - cos(a) of ||z|| is off by the angle a
        off = np.arccos(np.clip(force[bad, 0] / size[bad], np.cos(np.pi / FIRST_PLANES), 1.0))
        about = np.arctan2(force[bad, 2], force[bad, 1])
        owner = np.concatenate([owner, np.repeat(bad, len(FAN))])
        angle = np.concatenate([angle, (about[:, None] + off[:, None] * FAN).ravel()])
    raise SolverFailure(f"strength of point contacts: no answer after {ROUNDS} rounds of tangent planes")


def _solved(rows: YieldRows, planes: Array, given: Array, direction: Array) -> tuple[Any, float]:
    """Answer of HiGHS, and its tolerance: the largest t with A x >= 0, resultants x = given + t direction.

    A are the linear rows and the planes.
    """
    A, resultants = np.concatenate([rows.F[0, : rows.linear], planes]), rows.resultants[0]
    program: Any = {
        "c": np.append(np.zeros(A.shape[1]), -1.0),
        "A_ub": np.column_stack([-A, np.zeros(len(A))]),
        "b_ub": np.zeros(len(A)),
        "A_eq": np.column_stack([resultants, -direction]),
        "b_eq": given,
        "bounds": [(None, None)] * A.shape[1] + [(0.0, LARGEST)],
    }
    said = []
    for tolerance in TOLERANCES:
        options: Any = {
            "presolve": False,
            "primal_feasibility_tolerance": tolerance,
            "dual_feasibility_tolerance": tolerance,
        }
        solution = linprog(**program, method="highs", options=options)
        if solution.status == 2 or solution.x is not None:
            return solution, tolerance
        said.append(f"tolerance {tolerance:g}: {solution.message}")
    raise SolverFailure("strength of point contacts: " + "; ".join(said))


def _rates(multipliers: Array, rows: YieldRows, owner: Indices, d: Array) -> Array:
    """Rates of the planes and the cones from those of the first planes and of tangent planes d (k, 2).

    Rates (r, -r d) of one cone add up to (y0, y): it slips by ||y||, and the rest of y0 opens its point.
    """
    rates, tangent = multipliers[: rows.linear].copy(), multipliers[rows.linear :]
    if not len(owner):
        return rates
    y0, *y = (np.bincount(owner, w) for w in (tangent, *(tangent * d.T)))
    slip = np.hypot(*y)
    rates += rows.friction * np.maximum(y0 - slip, 0.0)
    return np.concatenate([rates, slip])

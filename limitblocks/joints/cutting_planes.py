"""Strength of an interface whose rows act on point forces: a linear program with tangent planes of cones."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.optimize import linprog

from limitblocks.arrays import Array
from limitblocks.errors import SolverFailure
from limitblocks.joints.base import YieldRows

FIRST_PLANES = 16  # tangent planes of each cone to start with
VIOLATION = 1e-10  # of cones of forces of unit size
LARGEST = 1e4  # of the given stresses and the direction, both of unit size: more is unlimited
ROUNDS = 60
PRECISE: Any = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}


def farthest(rows: YieldRows, given: Array, direction: Array) -> tuple[float, Array]:
    """Return the largest t with `given` + t `direction` within the yield set, and the multipliers there.

    Kelley's method: cones (t0, z), sizes 3, become planes t0 - d.z >= 0, and each solution adds the
    planes it violates, until none does by more than 1e-10.

    Parameters
    ----------
    rows : YieldRows
        Of one interface, all its points alike; no constant terms.
    given, direction : Array, shape (6,)
        Stress resultants in units that make them of size one.

    Returns
    -------
    t : float
        Infinite without limit, NaN if `given` is outside the yield set.
    multipliers : Array, shape (k,)
        Rates (>= 0) of the planes and of the cones in the mechanism that limits t.
    """
    F, linear = rows.F[0], rows.linear
    cones = F[linear:].reshape(-1, 3, F.shape[1])
    angles = 2 * np.pi * np.arange(FIRST_PLANES) / FIRST_PLANES
    planes = [_planes(cones, np.stack([np.cos(angles), np.sin(angles)], axis=1)[None])]
    owner = [np.repeat(np.arange(len(cones)), FIRST_PLANES)]
    for _ in range(ROUNDS):
        A = np.concatenate([F[:linear], *planes])
        found = linprog(
            np.append(np.zeros(F.shape[1]), -1.0),
            A_ub=np.column_stack([-A, np.zeros(len(A))]),
            b_ub=np.zeros(len(A)),
            A_eq=np.column_stack([rows.resultants[0], -direction]),
            b_eq=given,
            bounds=[(None, None)] * F.shape[1] + [(0.0, LARGEST)],
            method="highs",
            options=PRECISE,
        )
        if found.status == 2:
            return np.nan, np.zeros(0)
        if found.x is None:
            raise SolverFailure(f"strength of point contacts: {found.message}")
        force = cones @ found.x[:-1]
        z = force[:, 1:]
        size = np.linalg.norm(z, axis=1)
        bad = size - force[:, 0] > VIOLATION * max(1.0, found.x[-1])
        if not bad.any():
            rates = np.maximum(-found.ineqlin.marginals, 0.0)
            slip = np.bincount(np.concatenate(owner), rates[linear:], minlength=len(cones))
            t = np.inf if found.x[-1] > LARGEST * (1 - 1e-6) else float(found.x[-1])
            return t, np.concatenate([rates[:linear], slip])
        planes.append(_planes(cones[bad], (z[bad] / size[bad, None])[:, None]))
        owner.append(np.flatnonzero(bad))
    raise SolverFailure(f"strength of point contacts: no answer after {ROUNDS} rounds of tangent planes")


def _planes(cones: Array, normals: Array) -> Array:
    """Rows t0 - d.z (c k, s) of cones (c, 3, s), for unit vectors d (c or 1, k, 2)."""
    return np.asarray((cones[:, None, 0] - normals @ cones[:, 1:]).reshape(-1, cones.shape[2]))

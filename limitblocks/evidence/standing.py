"""A stress state that carries the dead loads alone, by a linear program; scipy only."""

from __future__ import annotations

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array
from limitblocks.evidence.mechanism import PRECISE, linear_program
from limitblocks.problem import Cones, LimitProblem
from limitblocks.problem.cones import rays

SIDES = 32  # of the polygon within each cone: 0.5 % of its strength is left out


def standing_state(problem: LimitProblem) -> Array | None:
    """Return generalised stresses in equilibrium with the dead loads, as far within yield as they can be.

    The largest t <= 1 with F x + g - t e in K is sought, cones as polygons drawn within them. None where
    the program has no solution; the residuals of the state say whether it stands.
    """
    p, planes = problem, _planes(problem.cones)
    margin = sparse.csr_array((planes @ p.cones.identity)[:, None])
    A = sparse.csr_array(sparse.hstack([-sparse.csr_array(planes @ p.F), margin]))
    solution = linear_program(
        np.append(np.zeros(p.C.shape[0]), -1.0),
        A_ub=A,
        b_ub=planes @ p.g,
        A_eq=sparse.csr_array(sparse.hstack([p.C.T, sparse.csr_array((p.C.shape[1], 1))])),
        b_eq=p.dead,
        bounds=[(None, None)] * p.C.shape[0] + [(None, 1.0)],
        method="highs",
        options=PRECISE,
    )
    return None if solution.x is None else np.asarray(solution.x[:-1])


def _planes(cones: Cones) -> sparse.csr_array:
    """Planes (k, R) whose cone lies within K: polygons in each pair of axes of a second-order cone."""
    parts = [sparse.eye_array(cones.height, format="csr")[: cones.linear]]
    for places in cones.groups:
        count, size = places.shape
        normals = rays(size, SIDES)
        # with ||z_p|| <= c t in every pair p of axes, ||z||^2 <= (size - 1) / 2 (c t)^2
        normals[:, 0] = np.cos(np.pi / SIDES) * min(1.0, np.sqrt(2.0 / (size - 1)))
        k = len(normals)
        rows = np.repeat(np.arange(count * k), size)
        data, columns = np.tile(normals, (count, 1)).ravel(), np.repeat(places, k, axis=0).ravel()
        parts.append(sparse.coo_array((data, (rows, columns)), shape=(count * k, cones.height)).tocsr())
    return sparse.csr_array(sparse.vstack(parts))

"""Flow rule of a limit problem: the plastic potential at a stress state, Tables 3, 5 and 6."""

from __future__ import annotations

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.mechanics.problem import LimitProblem

SMALL_NORMAL_FORCE = 1e-3  # block weights; the epsilon of Table 5


def eccentricities(problem: LimitProblem, stresses: Array) -> Array:
    """Return (e1, e2) of each interface, shape (m, 2), block lengths: -M2/N and M1/N.

    For N near 0 the quotient is noise: M N / (N^2 + eps^2) replaces M / N, and the point stays within
    the half sides of the interface.
    """
    Q = (problem.resultants @ stresses).reshape(-1, 6)
    N = Q[:, 2]
    inverse = N / (N**2 + SMALL_NORMAL_FORCE**2)
    e = np.stack([-Q[:, 4] * inverse, Q[:, 3] * inverse], axis=1)
    return np.clip(e, -problem.reach, problem.reach)


def plastic_potential(problem: LimitProblem, stresses: Array, dilatancy: float = 0.0) -> sparse.csr_array:
    """Return G at a stress state, shape (R, s): the flow is C u = -G^T y, y in K*.

    Parameters
    ----------
    problem : LimitProblem
        The structure.
    stresses : Array, shape (s,)
        Generalised stresses; they place the centre of the twisting rows, Table 5.
    dilatancy : float
        Tangent of the dilatancy angle of sliding and twisting, from 0 (Tables 3 and 5) to the friction
        coefficient (G = F, associated); in between the two flows are mixed in proportion.

    Raises
    ------
    ModelError
        If the dilatancy is negative or above the least friction coefficient.
    """
    least = float(problem.friction.min())
    if not 0.0 <= dilatancy <= least:
        raise ModelError(
            f"dilatancy is {dilatancy!r}, expected 0 to the least friction coefficient, {least:g}"
        )
    zero = sparse.csr_array(problem.G + _pivoted(problem, stresses))
    if dilatancy == 0.0:
        return zero
    share = sparse.diags_array((dilatancy / problem.friction)[problem.row_interface])
    return sparse.csr_array(zero + share @ (problem.F - zero))


def _pivoted(problem: LimitProblem, stresses: Array) -> sparse.csr_array:
    """Tangential terms of the rows that turn about (e1, e2): ds = dthn (e2, -e1), Table 5."""
    rows = np.flatnonzero(problem.pivot)
    k = problem.row_interface[rows]
    turn = problem.pivot[rows]
    e1, e2 = eccentricities(problem, stresses)[k].T
    entries = np.concatenate([-turn * e2, turn * e1])
    places = np.concatenate([rows, rows]), np.concatenate([6 * k, 6 * k + 1])
    shape = (len(problem.pivot), problem.resultants.shape[0])
    tangential = sparse.coo_array((entries, places), shape=shape).tocsr()
    return sparse.csr_array(tangential @ problem.resultants)

"""Flow rule of a limit problem: the plastic potential at a stress state, Tables 3, 5 and 6."""

from __future__ import annotations

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.problem.limit_problem import LimitProblem

SMALL_NORMAL_FORCE = 1e-3  # block weights; the epsilon of Table 5
FARTHEST = 1.5  # of the half sides: states within the yield set stay below 1, iterates may stray


def dilatancy_share(problem: LimitProblem, dilatancy: float) -> Array:
    """Return dilatancy over friction for each row, shape (R,): 0 zero dilatancy, 1 associated.

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
    share = dilatancy / np.where(problem.friction > 0.0, problem.friction, 1.0)
    return np.asarray(share[problem.row_interface])


def plastic_potential(problem: LimitProblem, stresses: Array, dilatancy: float = 0.0) -> sparse.csr_array:
    """Return G at a stress state, shape (R, s): the flow is C u = -G^T y, y in K*.

    Twisting rows turn about (e1, e2) = (-M2/N, M1/N), Table 5. Where N is near 0 the quotient is noise, and
    M N / (N^2 + eps^2) replaces M / N.

    Parameters
    ----------
    problem : LimitProblem
        The structure.
    stresses : Array, shape (s,)
        Generalised stresses; they place the centre of the twisting rows.
    dilatancy : float
        Tangent of the dilatancy angle of sliding and twisting, from 0 (Tables 3 and 5) to the friction
        coefficient (G = F, associated); in between the two flows are mixed in proportion.

    Raises
    ------
    ModelError
        If the dilatancy is negative or above the least friction coefficient.
    """
    zero = sparse.csr_array(problem.G + _pivoted(problem, stresses))
    if dilatancy == 0.0:
        return zero
    share = sparse.diags_array(dilatancy_share(problem, dilatancy))
    return sparse.csr_array(zero + share @ (problem.F - zero))


def turning(
    problem: LimitProblem, stresses: Array, multipliers: Array, dilatancy: float = 0.0
) -> sparse.csr_array:
    """Return the derivative of -G(x)^T y with respect to x at fixed y, shape (s, s)."""
    m, B = len(problem.interfaces), problem.resultants
    if not problem.pivot.any():
        return sparse.csr_array((B.shape[1], B.shape[1]))
    turn = problem.pivot * multipliers * (1.0 - dilatancy_share(problem, dilatancy))
    spin = np.bincount(problem.row_interface, weights=turn, minlength=m)
    N, M1, M2, quotient = _fading(problem, stresses)
    slope = 1.0 / (N**2 + SMALL_NORMAL_FORCE**2) - 2.0 * quotient**2
    within = np.abs(quotient[:, None] * np.stack([M1, M2], axis=1)) < FARTHEST * problem.reach[:, ::-1]
    spin1, spin2 = (spin[:, None] * within).T
    entries = np.concatenate([spin1 * quotient, spin1 * M1 * slope, spin2 * quotient, spin2 * M2 * slope])
    V1, V2, n, m1, m2, _ = np.arange(6 * m).reshape(m, 6).T
    places = np.concatenate([V1, V1, V2, V2]), np.concatenate([m1, n, m2, n])
    derivative = sparse.coo_array((entries, places), shape=(6 * m, 6 * m)).tocsr()
    return sparse.csr_array(B.T @ derivative @ B)


def _fading(problem: LimitProblem, stresses: Array) -> tuple[Array, Array, Array, Array]:
    """N, M1, M2 of each interface, and N / (N^2 + eps^2), which fades out where 1 / N explodes."""
    Q = (problem.resultants @ stresses).reshape(-1, 6)
    N = Q[:, 2]
    return N, Q[:, 3], Q[:, 4], N / (N**2 + SMALL_NORMAL_FORCE**2)


def _pivoted(problem: LimitProblem, stresses: Array) -> sparse.csr_array:
    """Tangential terms of the rows that turn about (e1, e2): ds = dthn (e2, -e1), Table 5."""
    rows = np.flatnonzero(problem.pivot)
    k = problem.row_interface[rows]
    turn = problem.pivot[rows]
    _, M1, M2, quotient = _fading(problem, stresses)
    e = np.stack([-M2 * quotient, M1 * quotient], axis=1)
    e1, e2 = np.clip(e, -FARTHEST * problem.reach, FARTHEST * problem.reach)[k].T
    entries = np.concatenate([-turn * e2, turn * e1])
    places = np.concatenate([rows, rows]), np.concatenate([6 * k, 6 * k + 1])
    shape = (len(problem.pivot), problem.resultants.shape[0])
    tangential = sparse.coo_array((entries, places), shape=shape).tocsr()
    return sparse.csr_array(tangential @ problem.resultants)

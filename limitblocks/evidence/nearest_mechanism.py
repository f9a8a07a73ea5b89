"""The mechanism nearest to a claimed one that is exact for a choice of rows. numpy and scipy only."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array, Indices
from limitblocks.evidence.factors import diagonal_factors
from limitblocks.evidence.limits import Flags
from limitblocks.problem import LimitProblem

REGULAR = 1e-13  # eps of the quasidefinite system
REFINEMENTS = 6
LEAST_MULTIPLIER = 1e-3  # of the largest: multipliers below it are measured by it
EXACT, SOLVED = 1e-12, 1e-6  # of the largest rate: what is left of the flow rule by rounding, and by a step
ROUNDS = 8  # steps, each without the rows whose multipliers turned negative


def nearest_mechanism(
    problem: LimitProblem, G: sparse.csr_array, u: Array, y: Array, flowing: Flags
) -> tuple[Array, Array] | None:
    """Return u, y with C u + G^T y = 0, live . u = 1, near to those given; None if none is found.

    Only the linear rows and cones `flowing` (degree,) have multipliers. Changes are measured by the size of
    the multipliers, so that small ones keep their sign.
    """
    cones, n = problem.cones, problem.C.shape[1]
    for _ in range(ROUNDS):
        y = np.where(flowing[cones.member], y, 0.0)
        left = _left(problem, G, u, y)
        if left > EXACT:
            rows = np.flatnonzero(flowing[cones.member])
            d = _least_change(problem, G, rows, u, y)
            u, y = u + d[:n], y.copy()
            y[rows] += d[n:]
            left = _left(problem, G, u, y)
            if not left <= SOLVED:
                return None
        negative = y[cones.heads] < 0.0
        if left <= EXACT and not negative.any():
            return u, y
        flowing = flowing & ~negative
    return None


def _left(problem: LimitProblem, G: sparse.csr_array, u: Array, y: Array) -> float:
    """What is left of Eqs (54) and (55), over the largest rate."""
    flow = np.abs(problem.C @ u + G.T @ y).max()
    return float(max(flow, abs(problem.live @ u - 1.0)) / (np.abs(u).max() or 1.0))


def _least_change(problem: LimitProblem, G: sparse.csr_array, rows: Indices, u: Array, y: Array) -> Array:
    """Least change of u and of the multipliers of `rows`, by their size, that satisfies Eqs (54), (55)."""
    size = problem.cones.norm(y)[problem.cones.member][rows]
    largest = size.max(initial=0.0)
    unit = np.maximum(size / largest, LEAST_MULTIPLIER) if largest > 0.0 else np.ones(len(size))
    live = sparse.csr_array(problem.live[None, :])
    blocks: list[list[Any]] = [[problem.C, sparse.csr_array(G[rows].T)], [live, None]]
    J = sparse.csr_array(sparse.block_array(blocks if len(size) else [row[:1] for row in blocks]))
    columns = sparse.diags_array(np.append(np.ones(problem.C.shape[1]), unit))
    length = np.sqrt((J @ columns).power(2).sum(axis=1))
    scale = sparse.diags_array(1.0 / np.where(length > 0.0, length, 1.0))
    r = -np.append(problem.C @ u + G.T @ y, problem.live @ u - 1.0)
    scaled = sparse.csr_array(scale @ J @ columns)
    return np.asarray(columns @ least_solution(scaled, scale @ r, REGULAR, REFINEMENTS))


def least_solution(J: sparse.csr_array, r: Array, regular: float, refinements: int) -> Array:
    """Least-norm solution of J p = r, from the quasidefinite system with refinement.

    [I J^T; J -eps] is regular for every J (Vanderbei 1995, SIAM J. Optimization 5).
    """
    m, n = J.shape
    eps = sparse.diags_array(np.full(m, -regular))
    K = sparse.csc_array(sparse.block_array([[sparse.eye_array(n), J.T], [J, eps]]))
    lu = diagonal_factors(K)
    right = np.concatenate([np.zeros(n), r])
    z = lu.solve(right)
    for _ in range(refinements):
        z = z + lu.solve(right - K @ z)
    return np.asarray(z[:n])

"""The mechanism nearest to a claimed one that is exact for a choice of rows. numpy and scipy only."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array
from limitblocks.evidence.factors import diagonal_factors
from limitblocks.evidence.multipliers import Multipliers
from limitblocks.evidence.residuals import TOLERANCE
from limitblocks.problem import LimitProblem

REGULAR = 1e-13  # eps of the quasidefinite system
LEAST_MULTIPLIER = 1e-3  # of the largest: multipliers below it are measured by it
CLOSE = 0.01 * TOLERANCE  # of the largest rate, or multiplier: what may be left of the flow rule and of signs
EXACT = 0.01 * CLOSE  # what is tried next: a slow heavy block is worth more than the largest rate tells
ROUNDS = 8  # steps, each without the rows whose multipliers turned negative; fewer where they leave too much


def nearest_mechanism(
    problem: LimitProblem, G: sparse.csr_array, u: Array, y: Array, may: Multipliers, ease: float = 1.0
) -> tuple[Array, Array] | None:
    """Return u, y with C u + G^T y = 0, live . u = 1, near to those given; None if none is found.

    There are only the multipliers that `may` be. Changes are measured by the size of the multipliers, so that
    small ones keep their sign, and by their ease; those of rates by `ease`.
    """
    n, w = problem.C.shape[1], may.parts(problem.cones, y)
    live = sparse.csr_array(problem.live[None, :])
    strains = sparse.csr_array(G.T @ may.columns)
    blocks: list[list[Any]] = [[problem.C, strains], [live, None]]
    J = sparse.csr_array(sparse.block_array(blocks if len(w) else [row[:1] for row in blocks]))
    right, kept = np.append(np.zeros(len(J.indptr) - 2), 1.0), np.ones(len(w), dtype=bool)
    found, aim = None, CLOSE
    for further in reversed(range(ROUNDS)):
        w = np.where(kept, w, 0.0)
        left = right - J @ np.append(u, w)
        before = _share(left, u)
        if before > EXACT:
            largest = float(np.abs(w).max(initial=0.0)) or 1.0
            size = np.maximum(np.abs(w[may.ray]) / largest, LEAST_MULTIPLIER)
            d = _least_change(J, left, np.append(np.full(n, ease), np.where(kept, may.ease * size, 0.0)))
            u, w = u + d[:n], w + d[n:]
            left = right - J @ np.append(u, w)
        below = np.where(may.along, -w, 0.0) / (np.abs(w).max(initial=0.0) or 1.0)
        share = _share(left, u)
        if max(share, below.max(initial=0.0)) <= aim:
            found = u, np.asarray(may.columns @ np.where(may.along, np.maximum(w, 0.0), w))
            if aim == EXACT:
                return found
            aim = EXACT
        # not within the rounds that are left at this rate
        if share > aim and share * (share / before) ** further > aim:
            return found
        kept &= ~(below > aim)[may.ray]
    return found


def _share(left: Array, u: Array) -> float:
    """What is left of Eqs (54) and (55), over the largest rate."""
    return float(np.abs(left).max() / (np.abs(u).max() or 1.0))


def _least_change(J: sparse.csr_array, r: Array, unit: Array) -> Array:
    """Least change d, each part of it in its unit, with J d = r."""
    columns = sparse.diags_array(unit)
    length = np.sqrt((J @ columns).power(2).sum(axis=1))
    scale = sparse.diags_array(1.0 / np.where(length > 0.0, length, 1.0))
    scaled = sparse.csr_array(scale @ J @ columns)
    return unit * least_solution(scaled, np.asarray(scale @ r), REGULAR)


def least_solution(J: sparse.csr_array, r: Array, regular: float) -> Array:
    """Least-norm solution of J p = r, from the quasidefinite system.

    [I J^T; J -eps] is regular for every J (Vanderbei 1995, SIAM J. Optimization 5).
    """
    m, n = J.shape
    eps = sparse.diags_array(np.full(m, -regular))
    K = sparse.csc_array(sparse.block_array([[sparse.eye_array(n), J.T], [J, eps]]))
    return np.asarray(diagonal_factors(K).solve(np.concatenate([np.zeros(n), r]))[:n])

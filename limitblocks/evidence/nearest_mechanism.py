"""The mechanism nearest to a claimed one that is exact for a choice of rows. numpy and scipy only."""

from __future__ import annotations

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array, Indices
from limitblocks.evidence.elimination import Entries, elimination, factors_in_order, placed
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
    (s, n), w = problem.C.shape, may.parts(problem.cones, y)
    C, strains, live = (
        Entries.of(A) for A in (problem.C, G.T @ may.columns, sparse.csr_array(problem.live[None]))
    )
    entries = placed([(C, 0, 0), (strains, 0, n), (live, s, 0)])
    J = sparse.csr_array((entries.data, (entries.row, entries.column)), (s + 1, n + len(w)))
    order = _order(problem, may.columns)
    right, kept = np.append(np.zeros(s), 1.0), np.ones(len(w), dtype=bool)
    found, aim = None, CLOSE
    for further in reversed(range(ROUNDS)):
        w = np.where(kept, w, 0.0)
        left = right - J @ np.append(u, w)
        before = _share(left, u)
        if before > EXACT:
            largest = float(np.abs(w).max(initial=0.0)) or 1.0
            size = np.maximum(np.abs(w[may.ray]) / largest, LEAST_MULTIPLIER)
            unit = np.append(np.full(n, ease), np.where(kept, may.ease * size, 0.0))
            d = _least_change(entries, left, unit, order)
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


def _order(problem: LimitProblem, columns: sparse.csr_array) -> Indices:
    """Order of elimination of rates, multipliers w of the columns, and the equations of strains and work."""
    (s, n), k, entries = problem.C.shape, columns.shape[1], columns.tocoo()
    interface = np.zeros(k, dtype=np.int64)
    interface[entries.col] = problem.row_interface[entries.row]
    strains, work = n + k + np.arange(s), [n + k + s]
    return np.concatenate([strains, np.arange(n), work, n + np.arange(k)])[elimination(problem, interface)]


def _least_change(J: Entries, r: Array, unit: Array, order: Indices) -> Array:
    """Least change d, each part of it in its unit, with J d = r."""
    data = J.data * unit[J.column]
    length = np.sqrt(np.bincount(J.row, data * data, len(r)))
    scale = 1.0 / np.where(length > 0.0, length, 1.0)
    return unit * least_solution(J._replace(data=scale[J.row] * data), scale * r, order, REGULAR)


def least_solution(J: Entries, r: Array, order: Indices, regular: float) -> Array:
    """Least-norm solution of J p = r, from the quasidefinite system, its unknowns eliminated in an order.

    [I J^T; J -eps] is regular for every J (Vanderbei 1995, SIAM J. Optimization 5).
    """
    every, n = np.arange(len(order)), len(order) - len(r)
    diagonal = Entries(np.where(every < n, 1.0, -regular), every, every)
    K = placed([(J.T, 0, n), (J, n, 0), (diagonal, 0, 0)])
    return factors_in_order(K, order).solve(np.append(np.zeros(n), r))[:n]

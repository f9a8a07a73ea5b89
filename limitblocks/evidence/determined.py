"""Which stresses a mechanism determines: all states that go with it have the same. numpy and scipy only."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import sparse
from scipy.sparse import linalg

from limitblocks.arrays import Array
from limitblocks.evidence.mechanism import sparse_columns
from limitblocks.problem import LimitProblem

FLOWS = 1e-6  # of the largest strain rate: a row with less does not flow
REGULAR = 1e-13  # of columns of unit length
SAME = 1e-5  # of a functional: what is left of it where all states agree on its value


def determined(problem: LimitProblem, y: Array, functionals: sparse.csr_array) -> npt.NDArray[np.bool_]:
    """Whether functionals (k, s) of the stresses have one value in all states of a mechanism, shape (k,).

    With the mechanism whose multipliers are y, stresses and load factor may change by dx and da with
    C^T dx = da live and no change of the rows that flow, but for a cone's along the ray that is complementary
    to y (Eqs (56)-(59)). A functional has one value if it is a sum of columns of C, of rates that do no live
    work, and of those rows.
    """
    fixed = sparse.csr_array(problem.F.T @ _fixed(problem, y))
    live = sparse.csr_array(problem.live[None])
    A = sparse.block_array([[problem.C, fixed], [live, None]], format="csc")
    A = A @ sparse.diags_array(1.0 / np.maximum(linalg.norm(A, axis=0), np.finfo(float).tiny))
    given = np.vstack([functionals.toarray().T, np.zeros(functionals.shape[0])])
    n = A.shape[0]
    regular = -REGULAR * sparse.eye_array(A.shape[1])
    lu = linalg.splu(sparse.csc_array(sparse.block_array([[sparse.eye_array(n), A], [A.T, regular]])))
    left = lu.solve(np.vstack([given, np.zeros((A.shape[1], given.shape[1]))]))[:n]
    return np.asarray(np.linalg.norm(left, axis=0) <= SAME * np.linalg.norm(given, axis=0))


def _fixed(problem: LimitProblem, y: Array) -> sparse.csr_array:
    """Combinations (R, k) of the rows that the mechanism holds at zero."""
    cones, size = problem.cones, np.sqrt(problem.F.multiply(problem.F).sum(axis=1))
    least = FLOWS * float((np.abs(y) * size).max(initial=0.0))
    linear = np.flatnonzero((y * size)[: cones.linear] > least)
    parts: list[tuple[Any, Array]] = [(linear[:, None], np.ones((len(linear), 1, 1)))]
    for group in cones.groups:
        places = group[(np.abs(y[group]) * size[group]).max(axis=1) > least]
        z = y[places]
        length = np.linalg.norm(z[:, 1:], axis=1)
        ray = np.concatenate([length[:, None], -z[:, 1:]], axis=1)
        ray /= np.maximum(np.linalg.norm(ray, axis=1, keepdims=True), np.finfo(float).tiny)
        parts.append((places, np.eye(places.shape[1]) - ray[:, :, None] * ray[:, None]))
    return sparse_columns(parts, len(y))

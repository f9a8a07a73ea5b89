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
MANY = 100  # right-hand sides at a time
SAME = 1e-5  # of a functional: what is left of it where all states agree on its value


def determined(
    problem: LimitProblem, y: Array, functionals: sparse.csr_array, *, load_factor: bool = False
) -> npt.NDArray[np.bool_]:
    """Whether functionals (k, s) of the stresses have one value in all states of a mechanism, shape (k,).

    With the mechanism whose multipliers are y, stresses and load factor may change by dx and da with
    C^T dx = da live and no change of the rows that flow, but for a cone's along the ray that is complementary
    to y (Eqs (56)-(59)). A functional has one value if it is a sum of columns of C, of rates that do no live
    work, and of those rows; of any rates where the `load_factor` is the same, da = 0.
    """
    fixed = sparse.csr_array(problem.F.T @ _fixed(problem, y))
    live = sparse.csr_array(0.0 * problem.live[None] if load_factor else problem.live[None])
    A = sparse.block_array([[problem.C, fixed], [live, None]], format="csc")
    A = A @ sparse.diags_array(1.0 / np.maximum(linalg.norm(A, axis=0), np.finfo(float).tiny))
    regular, s = -REGULAR * sparse.eye_array(A.shape[1]), problem.C.shape[0]
    lu = linalg.splu(sparse.csc_array(sparse.block_array([[sparse.eye_array(s + 1), A], [A.T, regular]])))
    same = [np.zeros(0, dtype=bool)]
    for first in range(0, functionals.shape[0], MANY):
        given = functionals[first : first + MANY].toarray().T
        left = lu.solve(np.pad(given, ((0, 1 + A.shape[1]), (0, 0))))[: s + 1]
        same.append(np.linalg.norm(left, axis=0) <= SAME * np.linalg.norm(given, axis=0))
    return np.concatenate(same)


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
        ray[z[:, 0] - length > FLOWS * z[:, 0]] = 0.0  # at the apex nothing of the cone changes
        parts.append((places, np.eye(places.shape[1]) - ray[:, :, None] * ray[:, None]))
    return sparse_columns(parts, len(y))

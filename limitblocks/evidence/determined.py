"""Which stresses a mechanism determines: all states that go with it have the same. numpy and scipy only."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import sparse
from scipy.sparse import linalg

from limitblocks.arrays import Array
from limitblocks.evidence.mechanism import sparse_columns
from limitblocks.problem import Flow, LimitProblem, State

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
    return _one_value(A, functionals)


def determined_as_slip_turns(
    flow: Flow, state: State, functionals: sparse.csr_array
) -> npt.NDArray[np.bool_]:
    """Whether functionals (k, s) have one value in all solutions next to a state, (k,), whose slip may turn.

    As `determined`, but cones that flow stay at yield only, and turn as the shear force does, by a mechanism
    that changes by du and dy: C du + G^T dy = 0, live . du = 0.
    """
    p = flow.problem
    s, G = p.F @ state.x + p.g, flow.matrix(state.x)
    unit = np.abs(state.y).max(initial=0.0) or 1.0
    held, freed, turned = _turning(p, s, state.y / unit)
    rates = sparse.csr_array(G.T @ freed)  # of the changes of multipliers that the flow allows
    live = sparse.csr_array(p.live[None])
    coupled = sparse.csr_array(freed.T @ turned[1])
    A = sparse.block_array(
        [
            [p.C, p.F.T @ held, p.F.T @ turned[0], None, None],
            [live, None, None, None, None],
            [None, None, None, p.C.T, live.T],
            [None, None, coupled, rates.T, None],
        ],
        format="csc",
    )
    return _one_value(A, functionals)


def _turning(
    p: LimitProblem, s: Array, y: Array
) -> tuple[sparse.csr_array, sparse.csr_array, tuple[sparse.csr_array, sparse.csr_array]]:
    """Combinations of rows that flow: slacks held, multipliers that may change, and what turns together."""
    size = np.sqrt(p.F.multiply(p.F).sum(axis=1))
    least = FLOWS * float((np.abs(y) * size).max(initial=0.0))
    linear = np.flatnonzero((y * size)[: p.cones.linear] > least)[:, None]
    ones = np.ones((len(linear), 1, 1))
    held: list[tuple[Any, Array]] = [(linear, ones)]
    freed: list[tuple[Any, Array]] = [(linear, ones)]
    slack: list[tuple[Any, Array]] = [(linear[:0], ones[:0])]
    turns: list[tuple[Any, Array]] = [(linear[:0], ones[:0])]
    for group in p.cones.groups:
        for rows in group[(np.abs(y[group]) * size[group]).max(axis=1) > least]:
            z, length, whole = y[rows], float(np.linalg.norm(y[rows][1:])), np.eye(len(rows))
            if z[0] - length > FLOWS * z[0] or not s[rows[0]] > 0.0:  # at the apex
                held.append((rows[None], whole[None]))
                freed.append((rows[None], whole[None]))
                continue
            n = z[1:] / length
            along = np.concatenate([[1.0], n])[:, None] / np.sqrt(2.0)
            across = np.zeros((len(rows), len(rows) - 2))
            across[1:] = np.linalg.svd(n[None])[2][1:].T
            held.append((rows[None], along.T[None]))
            freed.append((rows[None], np.hstack([along, across]).T[None]))
            slack.append((rows[None], across.T[None] / s[rows[0]]))
            turns.append((rows[None], across.T[None] / z[0]))
    return (
        sparse_columns(held, len(y)),
        sparse_columns(freed, len(y)),
        (sparse_columns(slack, len(y)), sparse_columns(turns, len(y))),
    )


def _one_value(A: sparse.csc_array, functionals: sparse.csr_array) -> npt.NDArray[np.bool_]:
    """Whether functionals (k, s) of what comes first are sums of columns of A."""
    A = A @ sparse.diags_array(1.0 / np.maximum(linalg.norm(A, axis=0), np.finfo(float).tiny))
    regular, rows = -REGULAR * sparse.eye_array(A.shape[1]), A.shape[0]
    lu = linalg.splu(sparse.csc_array(sparse.block_array([[sparse.eye_array(rows), A], [A.T, regular]])))
    same = [np.zeros(0, dtype=bool)]
    for first in range(0, functionals.shape[0], MANY):
        given = functionals[first : first + MANY].toarray().T
        left = lu.solve(np.pad(given, ((0, rows + A.shape[1] - len(given)), (0, 0))))[:rows]
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

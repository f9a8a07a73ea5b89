"""Forces of a place moved as little as it takes to put what flows there at yield. numpy and scipy only."""

from __future__ import annotations

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array, Flags, Indices, positions
from limitblocks.evidence.limits import ROUNDING
from limitblocks.problem import Cones, LimitProblem

PASSES = 4  # each with the rows that the one before took beyond yield
RANK = 1e-3  # of the largest singular value: rows that lean less on each other are one


def moved_forces(problem: LimitProblem, x: Array, y: Array, places: tuple[Indices, Indices]) -> Array:
    """Return the stresses (s,) nearest to x, place by place, at which what flows is at yield.

    Of linear rows with a multiplier s = 0, of cones z = s0 d with d opposite to the flow; other rows come in
    where they would be beyond yield. Each place has the least-norm solution of these equations; where they
    contradict each other it is one of least squares.
    """
    p, moved = problem, x
    active, aim = p.cones.norm(y) > 0.0, _against(p.cones, p.F @ x + p.g, y)
    for _ in range(PASSES):
        chosen, members = _conditions(p.cones, aim, active)
        left = chosen @ (p.F @ x + p.g)
        moved = x - _least_norm(sparse.csr_array(chosen @ p.F), left, places[0][members], places[1])
        terms = (abs(p.F) @ np.abs(moved) + np.abs(p.g))[p.cones.heads]
        beyond = (p.cones.margin(p.F @ moved + p.g) < -ROUNDING * terms) & ~active
        if not beyond.any():
            break
        active = active | beyond
    return moved


def _against(cones: Cones, s: Array, y: Array) -> Array:
    """Unit vectors opposite to the flow of cones, or along s where there is none; in their rows, (R,)."""
    aim = np.zeros(cones.height)
    for index in cones.groups:
        for z in (s[index][:, 1:], -y[index][:, 1:]):
            size = np.linalg.norm(z, axis=1)
            on = size > 0.0
            aim[index[on, 1:]] = z[on] / size[on, None]
    return aim


def _conditions(cones: Cones, aim: Array, active: Flags) -> tuple[sparse.csr_array, Indices]:
    """Combinations (q, R) of rows that are zero where linear rows and cones yield, and whose each is."""
    linear = np.flatnonzero(active[: cones.linear])
    count, members = len(linear), [linear]
    entries = [(np.ones(count), np.arange(count), linear)]
    first = cones.linear
    for index in cones.groups:
        on = np.flatnonzero(active[first : first + len(index)])
        tails, heads = index[on, 1:].ravel(), np.repeat(index[on, 0], index.shape[1] - 1)
        rows = count + np.arange(len(tails))
        entries += [(np.ones(len(tails)), rows, tails), (-aim[tails], rows, heads)]
        members.append(first + np.repeat(on, index.shape[1] - 1))
        count, first = count + len(tails), first + len(index)
    data, row, column = (np.concatenate(part) for part in zip(*entries, strict=True))
    return sparse.coo_array((data, (row, column)), shape=(count, cones.height)).tocsr(), np.concatenate(
        members
    )


def _least_norm(matrix: sparse.csr_array, right: Array, row_place: Indices, stresses: Indices) -> Array:
    """Least-norm least-squares solution of matrix d = right, whose rows and columns belong to places."""
    if not len(right):
        return np.zeros(len(stresses))
    row_at, column_at = positions(row_place), positions(stresses)
    count = int(max(row_place.max(), stresses.max())) + 1
    blocks = np.zeros((count, int(row_at.max()) + 1, int(column_at.max()) + 1))
    values = np.zeros(blocks.shape[:2])
    entries = matrix.tocoo()
    rows, columns = entries.coords
    blocks[row_place[rows], row_at[rows], column_at[columns]] = entries.data
    values[row_place, row_at] = right
    solution = np.einsum("pkr,pr->pk", np.linalg.pinv(blocks, rcond=RANK), values)
    return np.asarray(solution[stresses, column_at])

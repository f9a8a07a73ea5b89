"""Linear complementarity problems by pivoting: s = q + M y, s >= 0, y >= 0, s_k y_k = 0.

Both methods follow the solutions of s = q + M y + t d, a line from breakpoint to breakpoint, until t is zero;
at each the pair that meets zero exchanges its slack and its multiplier (complementary pivots: Lemke 1965,
Management Science 11; Cottle, Pang & Stone 1992, The Linear Complementarity Problem, Chapter 4). One starts
at a given pair (s, y) with d its residual, as the path search of Ralph (1994), Math. of Operations Research
19, and ends mostly at the nearest solution; the other, where that line goes to infinity or back, at y = 0
with a positive d.
"""

from __future__ import annotations

import numpy as np

from limitblocks.arrays import Array, Indices

PIVOTS = 2  # of them for each pair, at most
NONE = 1e-10  # of the largest entry of a column: a smaller pivot is none
EXACT = 1e-3  # of the largest q: a larger residual is the rounding of too many pivots
SPREAD = 0.5  # of the covering vector: ties would let pivots cycle

Pair = tuple[Array, Array]


def complementary(q: Array, M: Array, s: Array, y: Array) -> Pair | None:
    """Return slacks and multipliers of a solution, None where no line leads to one.

    Parameters
    ----------
    q, M : Array, shapes (k,) and (k, k)
        The problem.
    s, y : Array, shape (k,)
        Where to start from: not negative, with one of each pair zero.
    """
    if not len(q):
        return q, q
    for follow in (_from_pair, _from_zero):
        found = follow(q, M, s, y)
        if found is not None and np.abs(q + M @ found[1] - found[0]).max() <= EXACT * np.abs(q).max():
            return found
    return None


def _from_pair(q: Array, M: Array, s: Array, y: Array) -> Pair | None:
    """Follow the line on which the residual of (s, y) falls."""
    k, basic = len(q), y > 0.0
    on, off = np.flatnonzero(basic), np.flatnonzero(~basic)
    right = np.column_stack([M, q, s - q - M @ y])
    try:
        solved = np.linalg.solve(M[np.ix_(on, on)], np.column_stack([np.eye(len(on)), -right[on]]))
    except np.linalg.LinAlgError:
        return None
    rest = solved[:, len(on) :]
    table = right.copy()
    table[on], table[np.ix_(on, on)] = rest, solved[:, : len(on)]
    table[off] += M[np.ix_(off, on)] @ rest
    table[np.ix_(off, on)] = M[np.ix_(off, on)] @ solved[:, : len(on)]
    names = np.arange(k)
    table[:, k] = np.maximum(table[:, k] + table[:, k + 1], 0.0) - table[:, k + 1]
    fall = np.where(table[:, k + 1] > 0.0, table[:, k + 1], np.nan)
    steps = (table[:, k] + table[:, k + 1]) / fall
    first = int(np.nanargmin(steps)) if np.isfinite(steps).any() else 0
    rows, columns = np.where(basic, k + names, names), np.where(basic, names, k + names)
    if not steps[first] < 1.0:
        return _values(table[:, k], rows)
    return _pivots(table, rows, columns, first)


def _from_zero(q: Array, M: Array, s: Array, y: Array) -> Pair | None:
    """Follow the line from y = 0; rows are covered in the scale of their own pairs."""
    k = len(q)
    if q.min() >= 0.0:
        return q, np.zeros(k)
    spread = np.random.default_rng(0).uniform(1.0 - SPREAD, 1.0 + SPREAD, k)
    cover = np.sqrt(np.maximum(np.abs(np.diag(M)), np.finfo(float).tiny)) * spread
    table = np.column_stack([M, q, cover])
    return _pivots(table, np.arange(k), k + np.arange(k), int(np.argmax(-q / cover)))


def _pivots(table: Array, rows: Indices, columns: Indices, first: int) -> Pair | None:
    """Pivot until t is zero; `first` is the row that meets zero first.

    Variable j of 2 k is the slack of pair j, or the multiplier of pair j - k; 2 k is t, and no variable the
    constant -1. Rows of the table give the basic variables, in the order of `rows`.
    """
    k = len(rows)
    rows, columns = rows.copy(), np.append(columns, [-1, 2 * k])
    leaving, row, column = -1, first, k + 1
    for _ in range(PIVOTS * k + 1):
        _exchange(table, row, column)
        leaving, rows[row] = rows[row], columns[column]
        columns[column] = leaving
        if leaving == 2 * k:
            return _values(table[:, k], rows)
        column = int(np.flatnonzero(columns == (leaving + k) % (2 * k))[0])
        rate = table[:, column]
        falls = rate < -NONE * np.abs(rate).max()
        if not falls.any():
            return None  # to infinity
        steps = np.full(k, np.inf)
        steps[falls] = np.maximum(table[falls, k], 0.0) / -rate[falls]
        row = int(np.argmin(steps))
        ends = int(np.flatnonzero(rows == 2 * k)[0])
        row = ends if steps[ends] <= steps[row] * (1.0 + NONE) else row
    return None


def _exchange(table: Array, row: int, column: int) -> None:
    """Exchange the basic variable of a row with the one of a column, in place."""
    pivot, line, rate = table[row, column], table[row].copy(), table[:, column].copy()
    line = -line / pivot
    line[column] = 1.0 / pivot
    table += np.outer(rate, line)
    table[:, column] = rate / pivot
    table[row] = line


def _values(constant: Array, rows: Indices) -> Pair:
    """Slacks and multipliers of the basic variables."""
    k = len(rows)
    both = np.zeros(2 * k)
    both[rows] = np.maximum(constant, 0.0)
    return both[:k], both[k:]

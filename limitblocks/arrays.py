"""Array type and read-only copies, shared by every module."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import sparse

Array = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]
Flags = npt.NDArray[np.bool_]


class Sealed:
    """Something whose arrays stay read-only when it is copied or pickled, which would lose that."""

    def __setstate__(self, state: dict[str, Any]) -> None:
        for value in state.values():
            if isinstance(value, np.ndarray):
                value.flags.writeable = False
        self.__dict__.update(state)


def read_only(values: Any) -> Array:
    """Return a float copy of `values` that cannot be written to."""
    array = np.array(values, dtype=np.float64)
    array.flags.writeable = False
    return array


def reals(values: Any) -> Array:
    """Return numbers as floats; ValueError where one is none, such as text, which numpy would read."""
    array = np.asarray(values)
    if array.dtype.kind not in "iufO":
        raise ValueError(f"{array.dtype.name} is no number")
    if array.dtype.kind == "O" and np.isnan([real(value) for value in array.flat]).any():
        raise ValueError("not all are numbers")
    return array.astype(np.float64)


def reals_if_any(values: Any) -> Array:
    """Return numbers as floats, shape (0,) where one is none."""
    try:
        return reals(values)
    except (TypeError, ValueError):
        return np.zeros(0)


def real(value: Any) -> float:
    """Return a number as a float, NaN for what is none, such as text, True, or an integer without bounds."""
    try:
        number = np.asarray(value)
        return float(value) if number.ndim == 0 and number.dtype.kind in "iufO" else np.nan
    except (OverflowError, TypeError, ValueError):
        return np.nan


def as_typed(value: Any) -> str:
    """Return what a user gave as text, its numbers without the types that NumPy gives them."""
    with np.printoptions(legacy="1.25"):
        return repr(value)


def largest_in_rows(matrix: sparse.csr_array) -> Array:
    """Size of the largest entry of each row, zero for none."""
    largest, filled = np.zeros(matrix.shape[0]), np.flatnonzero(np.diff(matrix.indptr))
    if len(filled):
        largest[filled] = np.maximum.reduceat(np.abs(matrix.data), matrix.indptr[filled])
    return largest


def in_blocks(matrix: sparse.csr_array, first: Indices, column: Indices, shape: tuple[int, ...]) -> Array:
    """Rows of a matrix as an array of a `shape`: the `first` place of each, -1 for none, and of columns."""
    place, values = np.repeat(first, np.diff(matrix.indptr)), np.zeros(shape)
    kept = slice(None) if first.min(initial=0) >= 0 else place >= 0
    place += column[matrix.indices]
    values.ravel()[place[kept]] = matrix.data[kept]
    return values


def positions(owner: Indices) -> Indices:
    """Running number of each entry among those of its owner, shape (len,)."""
    position = np.empty(len(owner), dtype=np.int64)
    position[np.argsort(owner, kind="stable")] = repeated(np.bincount(owner))[1]
    return position


def owned(owner: Indices, count: int) -> tuple[Indices, Indices]:
    """Numbers (count, most) of what each owner has, len(owner) beyond; the position of each (len,)."""
    position = positions(owner)
    table = np.full((count, int(position.max(initial=-1)) + 1), len(owner))
    table[owner, position] = np.arange(len(owner))
    return table, position


def repeated(count: Indices) -> tuple[Indices, Indices]:
    """Each of (c,) as often as it counts: which one it is, and its position among its copies."""
    which = np.repeat(np.arange(len(count)), count)
    return which, np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)


def sums(owner: Indices, vectors: Array, count: int) -> Array:
    """Sum of the vectors (k, d) of each of `count` owners, shape (count, d)."""
    return np.column_stack([np.bincount(owner, x, count) for x in vectors.T]).astype(np.float64)


def tied(pairs: Indices, count: int) -> Indices:
    """Number of the part that each of `count` things belongs to, where `pairs` (p, 2) tie them, (count,)."""
    graph = sparse.coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(count, count))
    return np.asarray(sparse.csgraph.connected_components(graph, directed=False)[1], dtype=np.int64)


def first_tied(pairs: Indices, count: int) -> Indices:
    """The first of all that each of `count` things is tied to, as in :func:`tied`, (count,)."""
    part = tied(pairs, count)
    return np.asarray(np.unique(part, return_index=True)[1][part])


def equal_rows(values: Array) -> tuple[Indices, Indices]:
    """The first of each class of rows (K, d) with the same bits, and the class of each (K,)."""
    rows = np.ascontiguousarray(np.pad(values, ((0, 0), (1, 0))))  # those without columns are equal, too
    bits = rows.view(np.dtype((np.void, rows.itemsize * rows.shape[1]))).ravel()
    _, first, label = np.unique(bits, return_index=True, return_inverse=True)
    return first, label


def same_rows(values: Array, within: float = 0.0) -> tuple[Indices, Indices]:
    """The first of each class of rows (K, d) that agree within a distance, and the class of each (K,).

    Rows are sorted by one number each; those that disagree with the first of theirs are classes of their own.
    """
    key = values @ np.cos(np.arange(values.shape[1]) ** 2 + 1.0)  # numbers without a pattern
    size = np.sqrt(values.shape[1] * np.einsum("kd,kd->k", values, values))
    order = np.argsort(key, kind="stable")
    apart = (within * values.shape[1] + 4.0 * np.finfo(float).eps * size)[order[1:]]
    new = ~(np.diff(key[order]) <= apart)
    label = np.empty(len(values), dtype=np.int64)
    label[order] = np.concatenate([[0], np.cumsum(new)])[: len(values)]
    first = np.unique(label, return_index=True)[1]
    off = values[first[label]]
    off -= values
    odd = np.flatnonzero(~(np.abs(off, out=off).max(axis=1, initial=0.0) <= within))
    if not len(odd):
        return first, label
    label[odd] = len(first) + np.arange(len(odd))
    _, first, label = np.unique(label, return_index=True, return_inverse=True)
    return np.asarray(first), np.asarray(label).ravel()

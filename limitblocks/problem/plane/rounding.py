"""Numbers that are equal up to rounding."""

from __future__ import annotations

import numpy as np

from limitblocks.arrays import Array, Indices, same_rows

EXACT = 1e-10  # of the largest number of its kind: more is no rounding error
AGREE = 0.01 * EXACT  # of numbers up to one: places that agree within it are judged once


def classes(*numbers: Array) -> tuple[Indices, Indices]:
    """The first place of each class of places with the same numbers (K, ...), and the class of each (K,).

    Structures repeat a few joints over and over.
    """
    return same_rows(np.concatenate([used(part) for part in numbers], axis=1), AGREE)


def used(values: Array) -> Array:
    """The numbers (K, ...) of each place as a row, without those that are zero at all places."""
    rows = values.reshape(len(values), -1)
    return np.asarray(rows[:, rows.any(axis=0)])


def close(a: Array, b: Array, scale: Array | float) -> bool:
    """Whether two arrays agree up to EXACT times the scale."""
    return bool((np.abs(a - b) <= EXACT * scale).all())


def pseudo_inverses(matrices: Array) -> Array:
    """Pseudo-inverses of symmetric matrices (K, c, c); inverses, seven times faster, where all have one."""
    try:
        inverses = np.linalg.inv(matrices)
        exact = close(inverses @ matrices, np.eye(matrices.shape[1]), 1.0)
    except np.linalg.LinAlgError:
        exact = False
    return np.asarray(inverses if exact else np.linalg.pinv(matrices, hermitian=True))


def without_rounding(turn: Array) -> Array:
    """The turn with 0, 1 and -1 where rounding is off them, lest a solver's last digits depend on it."""
    whole = np.rint(turn) + 0.0  # no negative zeros: turns are classed by their bits
    return np.asarray(np.where(np.abs(turn - whole) <= AGREE, whole, turn))


def size_of(values: Array) -> Array:
    """Largest of the numbers (K, ...) of each place, one for nothing, to divide them by."""
    size = np.abs(values).max(axis=tuple(range(1, values.ndim)), keepdims=True)
    return np.asarray(np.where(size > 0.0, size, 1.0))

"""Which rows of two places are the same, whatever their order and whatever turns their cones."""

from __future__ import annotations

import numpy as np

from limitblocks.arrays import Array, Indices, same_rows
from limitblocks.problem.plane.places import Place

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
    whole = np.rint(turn)
    return np.asarray(np.where(np.abs(turn - whole) <= AGREE, whole, turn))


def alike(kind: Place, other: Place, turn: Array | None) -> Indices | None:
    """Which linear row or cone (K, members) of `other` each one of `kind` is, its stresses turned.

    None where one is like none. Cones are alike where their heads are, and the lengths of their other rows.
    """
    turned, there = numbers(kind, turn), numbers(other, None)
    scale = size_of(there)
    turned, there = turned / scale, there / scale
    partners = []
    for kinds in _same_size(kind):
        a, b = (np.stack([length_of(v[:, at]) for at in kinds], axis=1) for v in (turned, there))
        here, there_too = in_order(a), in_order(b)
        pair = [np.take_along_axis(v, at[..., None], 1) for v, at in ((a, here), (b, there_too))]
        if not close(pair[0], pair[1], 1.0):
            return None
        partner = np.empty_like(here)
        np.put_along_axis(partner, here, kind.members.index(kinds[0]) + there_too, axis=1)
        partners.append(partner)
    return np.concatenate(partners, axis=1) if partners else np.zeros((len(kind.rows), 0), dtype=np.int64)


def size_of(values: Array) -> Array:
    """Largest of the numbers (K, ...) of each place, one for nothing, to divide them by."""
    size = np.abs(values).max(axis=tuple(range(1, values.ndim)), keepdims=True)
    return np.asarray(np.where(size > 0.0, size, 1.0))


def numbers(kind: Place, turn: Array | None) -> Array:
    """Rows of F, g and G (K, r, 2 c + 1), of turned stresses."""
    F, G = (kind.F, kind.G) if turn is None else (kind.F @ turn, kind.G @ turn)
    return np.concatenate([F, kind.g[..., None], G], axis=2)


def _same_size(kind: Place) -> list[list[slice]]:
    """Linear rows, and cones of each size."""
    sizes = sorted({at.stop - at.start for at in kind.members[kind.linear :]})
    conic = [[at for at in kind.members[kind.linear :] if at.stop - at.start == size] for size in sizes]
    return [part for part in (list(kind.members[: kind.linear]), *conic) if part]


def in_order(values: Array) -> Indices:
    """An order (K, L) of values (K, L, n) that puts equal ones beside each other, whatever theirs was."""
    mix = np.cos(np.arange(values.shape[2]) ** 2 + 1.0)  # numbers without a pattern: unlike values differ
    with np.errstate(invalid="ignore"):
        return np.argsort(values @ mix, axis=1)


def length_of(rows: Array) -> Array:
    """Head of a linear row or a cone (K, size, n) and products of its other rows: what no turn changes."""
    rest = rows[:, 1:]
    if not rest.shape[1]:
        return np.asarray(rows[:, 0])
    products = np.einsum("kri,krj->kij", rest, rest).reshape(len(rows), -1)
    return np.concatenate([rows[:, 0], products], axis=1)

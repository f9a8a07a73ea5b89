"""Linear rows that others imply."""

from __future__ import annotations

import numpy as np

from limitblocks.arrays import Array, Flags, Indices
from limitblocks.problem.plane.rounding import classes

ROUNDING = 1e-10  # of rows of unit length
ENTRIES = 2**20  # of an array of all sums of two rows: sets are judged so many at a time


def redundant(rows: Array, present: Flags, flow: Array | None = None) -> Flags:
    """Return which rows a.(x, 1) >= 0 (K, L, d + 1) of each set follow from two others of it, (K, L).

    A row follows where it is a sum of two with factors >= 0, one of which may be the constant 1 >= 0. In the
    plane rows act on (V, N) or on (N, M): two are enough. `present` (K, L) tells which rows there are. With
    `flow` (K, L, d) a row must also flow as a sum of what must be at yield if it is: opening does not follow
    from sliding to both sides, twisting without a twist does from hinging.
    """
    order = np.argsort(~present, axis=1, kind="stable")[:, : int(present.sum(axis=1).max(initial=0))]
    own = np.take_along_axis(rows, order[..., None], axis=1)
    there = np.take_along_axis(present, order, axis=1)
    size = np.linalg.norm(own, axis=2, keepdims=True)
    own = np.where(there[..., None], own / np.where(size > 0.0, size, 1.0), 0.0)
    D = own.shape[2]
    moves = (
        np.zeros((*own.shape[:2], 0)) if flow is None else np.take_along_axis(flow, order[..., None], axis=1)
    )
    moves = np.where(there[..., None], moves, 0.0)
    first, kind = classes(own, moves, there.astype(float))
    constant = np.broadcast_to(np.eye(D)[-1], (len(first), 1, D))
    still = np.zeros((len(first), 1, moves.shape[2]))
    lines, flows = (np.concatenate(both, axis=1) for both in ((own[first], constant), (moves[first], still)))
    few = max(1, ENTRIES // (lines.shape[1] ** 3 * D))
    chunks = [slice(at, at + few) for at in range(0, len(first), few)]
    follows = [_follows(lines[its], there[first[its]], flows[its]) for its in chunks]
    flags = np.zeros_like(present)
    if follows:
        np.put_along_axis(flags, order, np.concatenate(follows)[kind], axis=1)
    return flags


def _follows(rows: Array, present: Flags, flow: Array) -> Flags:
    """The same of rows of unit length, the last of which is the constant; one row after the other."""
    K, L = present.shape
    i, j = np.triu_indices(L + 1, 1)
    products = rows @ rows.transpose(0, 2, 1)
    cosine, a, b = products[:, None, i, j], products[:, :L, i], products[:, :L, j]
    sine = 1.0 - cosine**2
    apart = sine > ROUNDING
    sine = np.where(apart, sine, 1.0)
    by_i, by_j = (a - b * cosine) / sine, (b - a * cosine) / sine
    off = by_i[..., None] * rows[:, None, i] + by_j[..., None] * rows[:, None, j] - rows[:, :L, None]
    sums = (
        apart & (np.minimum(by_i, by_j) >= -ROUNDING) & (np.einsum("kcpd,kcpd->kcp", off, off) <= ROUNDING**2)
    )
    own = np.arange(L)[:, None]
    sums &= (i != own) & (j != own)
    left, follows = np.concatenate([present, np.ones((K, 1), dtype=bool)], axis=1), np.zeros_like(present)
    for c in range(L):
        implied = sums[:, c] & left[:, i] & left[:, j]
        if flow.shape[2]:
            by = by_i[:, c] > ROUNDING, by_j[:, c] > ROUNDING
            implied &= _flows(flow, c, np.where(by[0], i, L), np.where(by[1], j, L))
        follows[:, c] = left[:, c] & implied.any(axis=1)
        left[:, c] &= ~follows[:, c]
    return follows


def _flows(flow: Array, c: int, i: Indices, j: Indices) -> Flags:
    """Whether the flow (K, L + 1, d) of row c is a sum, factors >= 0, of that of rows i, j (K, pairs)."""
    place = np.arange(len(flow))[:, None]
    a, b, own = flow[place, i], flow[place, j], flow[:, c, None]
    aa, ab, bb = (np.einsum("kpd,kpd->kp", v, w) for v, w in ((a, a), (a, b), (b, b)))
    ca, cb = (np.einsum("kpd,kpd->kp", v, np.broadcast_to(own, v.shape)) for v in (a, b))
    det = aa * bb - ab**2
    both = det > ROUNDING * np.maximum(aa * bb, ROUNDING)
    zero = np.zeros_like(aa)
    sums = [
        (zero, zero),
        (np.maximum(ca, 0.0) / np.where(aa > 0.0, aa, 1.0), zero),
        (zero, np.maximum(cb, 0.0) / np.where(bb > 0.0, bb, 1.0)),
        tuple(
            np.where(both, np.maximum(part, 0.0) / np.where(both, det, 1.0), 0.0)
            for part in (ca * bb - cb * ab, cb * aa - ca * ab)
        ),
    ]
    off = [np.abs(s[..., None] * a + t[..., None] * b - own).max(axis=2) for s, t in sums]
    return np.asarray(np.min(off, axis=0) <= ROUNDING)

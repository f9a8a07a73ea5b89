"""Where a mirror takes the places of one kind, and how it turns their stresses."""

from __future__ import annotations

import numpy as np

from limitblocks.arrays import Array, Indices, owned
from limitblocks.problem.plane.places import Place
from limitblocks.problem.plane.rounding import EXACT, pseudo_inverses, without_rounding


def images(kind: Place, blocks: Indices, rates: Array) -> tuple[Indices, Array]:
    """The place (K,) that fits the mirrored one best, and the turn (K, c, c) of stresses; zero if none."""
    K, c = kind.columns.shape
    goal = np.where(kind.ends >= 0, blocks[kind.ends], -1)
    i, j = np.concatenate([kind.ends, goal]).T + 1
    _, bucket = np.unique(np.minimum(i, j) * (len(blocks) + 1) + np.maximum(i, j), return_inverse=True)
    here, wanted = bucket.ravel()[:K], bucket.ravel()[K:]
    count = int(bucket.max()) + 1
    table, _ = owned(here, count)
    number = np.bincount(here, minlength=count)[wanted]
    scale = np.abs(kind.strain).max(axis=(1, 2, 3))
    whole = kind.middle is kind.strain  # one place at each interface
    wide = kind.strain if whole else np.concatenate([kind.strain, kind.middle], axis=3)
    mirrored = (wide.reshape(-1, 6) @ rates).reshape(wide.shape)
    free = np.where(goal[:, 0] >= 0, 0, 1)
    least, image, turn = np.full(K, np.inf), np.full(K, K), np.zeros((K, c, c))
    for k in range(table.shape[1]):
        there = np.minimum(table[wanted, k], K - 1)  # any beyond its number
        strain = wide[there]
        turned_round = kind.ends[there, 0] != goal[:, 0]
        strain[turned_round] = strain[turned_round, ::-1]
        own = strain[np.arange(K), free, :, :6]
        gram = pseudo_inverses(own @ own.transpose(0, 2, 1))
        # the transpose of the turn
        back = mirrored[np.arange(K), free, :, :6] @ own.transpose(0, 2, 1) @ gram
        apart = np.abs(back[:, None] @ strain - mirrored)
        off = apart[..., :6].max(axis=(1, 2, 3)) / scale
        # where two interfaces meet, points of theirs coincide: their middles tell which is which; of two
        # interfaces between the same blocks any fits with all six stresses, but one alone by a rotation
        far = apart.max(axis=(1, 2, 3))
        if table.shape[1] > 1:
            skew = np.abs(back @ back.transpose(0, 2, 1) - np.eye(c)).max(axis=(1, 2))
            far = np.maximum(far, skew * scale)
        fits = (k < number) & (off <= EXACT) & (far < least)
        image, least = np.where(fits, there, image), np.where(fits, far, least)
        turn = np.where(fits[:, None, None], back.transpose(0, 2, 1), turn)
    lost = image == K  # their turn is zero, which is no mirror
    return np.where(lost, np.arange(K), image), without_rounding(turn)

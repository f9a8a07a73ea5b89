"""Multipliers that what is near yield may have, in parts that each have a cost. numpy and scipy only."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array, Flags, Indices
from limitblocks.evidence.mechanism import sparse_columns
from limitblocks.problem import Cones


class Multipliers(NamedTuple):
    """Multipliers y = columns w: of linear rows, of cones along a ray and across it.

    `columns` has shape (R, k). `along` (k,) says which are linear rows or rays: their w must not be negative.
    `ray` (k,) is the one each belongs to, `ease` (k,) by what share of it each may change at like cost.
    """

    columns: sparse.csr_array
    along: Flags
    ray: Indices
    ease: Array

    def parts(self, cones: Cones, y: Array) -> Array:
        """Return w of multipliers y, (k,): rays by the first rows of cones, across only what is as easy."""
        heads = np.flatnonzero(cones.identity)
        w = np.where(self.along, self.columns[heads].T @ y[heads], 0.0)
        free = ~self.along & (self.ease == 1.0)
        return np.where(free, self.columns.T @ (y - self.columns @ w), w)


def near_yield(cones: Cones, s: Array, near: Flags, moves: Array, turn: float) -> Multipliers:
    """Return the multipliers of linear rows and cones that are `near` yield, (degree,).

    The ray of a cone is opposite to s = F x + g. Across it the flow changes by `turn` as readily as along it
    by all of it, or by the angle that forces may turn s, which they change by `moves` (degree,).
    """
    linear = np.flatnonzero(near[: cones.linear])
    generators, eases = [(linear[:, None], np.ones((len(linear), 1, 1)))], [np.ones((len(linear), 1))]
    first = cones.linear
    for places in cones.groups:
        on, members = near[first : first + len(places)], slice(first, first + len(places))
        around, ease = _of_cones(s[places[on]], moves[members][on], turn)
        generators.append((places[on], around))
        eases.append(ease)
        first += len(places)
    along = np.concatenate([np.arange(ease.size) % ease.shape[1] == 0 for ease in eases])
    return Multipliers(
        sparse_columns(generators, cones.height),
        along,
        np.flatnonzero(along)[np.cumsum(along) - 1],
        np.concatenate([ease.ravel() for ease in eases]),
    )


def _of_cones(s: Array, moves: Array, turn: float) -> tuple[Array, Array]:
    """Ray and directions across it of cones s (k, size), shape (k, size, size), and their ease (k, size).

    Where forces may move s by more than its size the flow may have any direction.
    """
    k, size = s.shape
    length = np.linalg.norm(s[:, 1:], axis=1)
    firm = length > moves
    away = s[:, 1:] / np.where(length > 0.0, length, 1.0)[:, None]
    around = np.zeros((k, size, size))
    around[:, 0, 0] = 1.0
    around[:, 0, 1:] = -away
    around[:, 1:, 1:] = np.eye(size - 1) - np.where(firm, 1.0, 0.0)[:, None, None] * (
        away[:, :, None] * away[:, None, :]
    )
    ease = np.ones((k, size))
    ease[firm, 1:] = np.maximum(turn, moves[firm] / length[firm])[:, None]
    return around, ease

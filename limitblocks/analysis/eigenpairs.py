"""Slacks and multipliers of a state as pairs of numbers, one of each pair zero at a solution.

A linear row is a pair already. On a second-order cone s and y of a solution share a frame: with d the
unit direction of the tail of s - y, the eigenvalues s0 -/+ d.s and y0 -/+ d.y are two pairs (Fukushima,
Luo & Tseng 2002, SIAM J. Optimization 12), so that a cone that lets go or takes hold is a change of one
pair. Across d the projection on the cone gives

    s_perp + kappa y_perp = 0,   kappa = t / (1 - t),   t = the part of v = s - y within K, over its spread:

none for a cone at its tip (kappa = 0, s = 0), and without a limit for one inside (y = 0). The frame and
kappa are those of the state; Newton's method on the pairs takes them anew at each step.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array, Indices
from limitblocks.problem import Cones

LOOSE = 1e6  # kappa from which on a cone has no multiplier across its frame


@dataclass(frozen=True, eq=False)
class Pairs:
    """Pairs (k,) of slack and multiplier, and what cones do across their frames (m rows).

    Slacks are `rows` s; multipliers y = rows^T (multipliers of the pairs) + across^T w, where
    across s + kappa w = 0.
    """

    rows: sparse.csr_array
    slack: Array
    multiplier: Array
    across: sparse.csr_array
    kappa: Array

    @property
    def signed(self) -> Array:
        """Slack where it is the larger one, less the multiplier where that is, shape (k,)."""
        return np.asarray(self.slack - self.multiplier)


def pairs(cones: Cones, s: Array, y: Array) -> Pairs:
    """Return the pairs of a state with slacks s and multipliers y in like units, both (R,)."""
    n = cones.linear
    line = np.arange(n)
    along = _Rows([np.ones(n)], [line], [line], n)
    across, kappa = _Rows([], [], [], 0), []
    back = _Rows([np.ones(n)], [line], [line], n)  # multipliers of the pairs from y
    for index in cones.groups:
        v = s[index] - y[index]
        size = np.linalg.norm(v[:, 1:], axis=1)
        d = np.where(size[:, None] > 0.0, v[:, 1:], np.eye(1, v.shape[1] - 1))
        d = d / np.linalg.norm(d, axis=1)[:, None]
        for sign in (-1.0, 1.0):
            frame = np.column_stack([np.ones(len(d)), sign * d])
            along.add(0.5 * frame, index)
            back.add(frame, index)
        least, largest = v[:, 0] - size, v[:, 0] + size
        within = np.clip(largest, 0.0, None) - np.clip(least, 0.0, None)
        beyond = np.clip(-least, 0.0, None) - np.clip(-largest, 0.0, None)
        ratio = within / np.maximum(beyond, np.finfo(float).tiny)
        held = ratio < LOOSE
        normal = np.eye(d.shape[1]) - d[:, :, None] * d[:, None, :]
        for row in range(d.shape[1]):
            across.add(np.column_stack([np.zeros(len(d)), normal[:, row]])[held], index[held])
            kappa.append(ratio[held])
    rows, height = along.matrix(cones.height), cones.height
    return Pairs(
        rows,
        rows @ s,
        back.matrix(height) @ y,
        across.matrix(height),
        np.concatenate(kappa) if kappa else np.zeros(0),
    )


@dataclass
class _Rows:
    """Rows of a sparse matrix on their way."""

    values: list[Array]
    places: list[Indices]
    columns: list[Indices]
    count: int

    def add(self, rows: Array, columns: Indices) -> None:
        """Add dense rows with the columns of their entries, both (k, size)."""
        self.values.append(rows.ravel())
        self.places.append(np.repeat(self.count + np.arange(len(rows)), rows.shape[1]))
        self.columns.append(columns.ravel())
        self.count += len(rows)

    def matrix(self, width: int) -> sparse.csr_array:
        """The rows as a matrix."""
        if not self.values:
            return sparse.csr_array((0, width))
        entries = np.concatenate(self.values), (np.concatenate(self.places), np.concatenate(self.columns))
        return sparse.csr_array(entries, shape=(self.count, width))

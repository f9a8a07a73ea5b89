"""Matrices that couple the generalised stresses of one interface only, inverted block by block."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy import sparse

from limitblocks.problem import LimitProblem


class InterfaceBlocks:
    """Places of the generalised stresses of each interface; smaller blocks are padded with ones."""

    def __init__(self, problem: LimitProblem) -> None:
        B = problem.resultants.tocoo()
        m, n = len(problem.interfaces), B.shape[1]
        self.interface = np.zeros(n, dtype=np.int64)
        self.interface[B.col] = B.row // 6
        count = np.bincount(self.interface, minlength=m)
        order = np.argsort(self.interface, kind="stable")
        self.place = np.empty(n, dtype=np.int64)
        self.place[order] = np.arange(n) - np.repeat(np.cumsum(count) - count, count)
        size = int(count.max())
        table = np.full((m, size), -1)
        table[self.interface, self.place] = np.arange(n)
        shape = (m, size, size)
        rows, columns = np.broadcast_to(table[:, :, None], shape), np.broadcast_to(table[:, None, :], shape)
        self.inside = (rows >= 0) & (columns >= 0)
        self.entries = rows[self.inside], columns[self.inside]
        self.padding = np.eye(size) * (table < 0)[:, :, None]

    def inverse(self, matrix: Any) -> sparse.csr_array:
        """Return the inverse of a sparse matrix of this pattern; LinAlgError if a block is singular."""
        entries, blocks = sparse.csr_array(matrix).tocoo(), self.padding.copy()
        rows, columns = entries.coords
        blocks[self.interface[rows], self.place[rows], self.place[columns]] += entries.data
        inverse = np.linalg.inv(blocks)[self.inside]
        return sparse.coo_array((inverse, self.entries), shape=matrix.shape).tocsr()

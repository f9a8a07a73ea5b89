"""Matrices that couple the generalised stresses of one interface only, inverted block by block."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy import sparse

from limitblocks.arrays import owned
from limitblocks.problem import LimitProblem


class InterfaceBlocks:
    """Places of the generalised stresses of each interface; smaller blocks are padded with ones."""

    def __init__(self, problem: LimitProblem) -> None:
        self.interface = problem.stress_interface
        table, self.place = owned(self.interface, len(problem.interfaces))
        (m, size), n = table.shape, len(self.place)
        shape = (m, size, size)
        rows, columns = np.broadcast_to(table[:, :, None], shape), np.broadcast_to(table[:, None, :], shape)
        self.inside = (rows < n) & (columns < n)
        self.entries = rows[self.inside], columns[self.inside]
        self.padding = np.eye(size) * (table == n)[:, :, None]

    def inverse(self, matrix: Any) -> sparse.csr_array:
        """Return the inverse of a sparse symmetric matrix of this pattern, the pseudoinverse if singular."""
        entries, blocks = matrix.tocoo(), self.padding.copy()
        rows, columns = entries.coords
        blocks[self.interface[rows], self.place[rows], self.place[columns]] += entries.data
        try:
            inverse = np.linalg.inv(blocks)
        except np.linalg.LinAlgError:  # a joint is 1e10 times as strong as its loads
            inverse = np.linalg.pinv(blocks, hermitian=True)
        return sparse.coo_array((inverse[self.inside], self.entries), shape=matrix.shape).tocsr()

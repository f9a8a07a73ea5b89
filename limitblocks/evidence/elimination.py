"""The order in which unknowns are eliminated: interface by interface, and then the rates of the blocks.

Stresses and rows of an interface couple with those of no other one; eliminated first they leave what couples
the rates of neighbouring blocks, as sparse as an order of all unknowns does. To find that one at each step
takes three times as long as the factors; the one of the rates is found once for a problem.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array, Indices, repeated
from limitblocks.evidence.factors import diagonal_factors
from limitblocks.known import known
from limitblocks.problem import LimitProblem


class Entries(NamedTuple):
    """Entries of a sparse matrix; several of one place are added."""

    data: Array
    row: Indices
    column: Indices

    @classmethod
    def of(cls, matrix: Any) -> Entries:
        """Return those of a sparse matrix."""
        entries = matrix.tocoo()
        return cls(entries.data, *entries.coords)

    @property
    def T(self) -> Entries:
        """Those of the transposed matrix."""
        return Entries(self.data, self.column, self.row)

    def __neg__(self) -> Entries:
        return Entries(-self.data, self.row, self.column)

    def square(self, size: int) -> sparse.csr_array:
        """Return the square matrix of this size with these entries."""
        return sparse.csr_array((self.data, (self.row, self.column)), (size, size))

    def times(self, matrix: sparse.csr_array) -> Entries:
        """Return those of the product with a matrix."""
        which, position = repeated(np.diff(matrix.indptr)[self.column])
        at = matrix.indptr[self.column][which] + position
        return Entries(self.data[which] * matrix.data[at], self.row[which], matrix.indices[at])


class Factors(NamedTuple):
    """Factors of a matrix, the unknowns of which are eliminated in an `order`; those not in it are zero."""

    factors: Any
    order: Indices

    def solve(self, right: Array) -> Array:
        """Return the solution for a right-hand side (n,), or several (n, c)."""
        solution = np.zeros_like(right)
        solution[self.order] = self.factors.solve(right.take(self.order, axis=0))
        return solution


def factors_in_order(entries: Entries, order: Indices) -> Factors:
    """Return the factors of a matrix, its unknowns eliminated in an order, without row exchanges."""
    (data, row, column), place = entries, numbered(order)
    matrix = sparse.csc_array((data, (place[row], place[column])), (len(order), len(order)))
    return Factors(diagonal_factors(matrix, "NATURAL"), order)


def numbered(order: Indices) -> Indices:
    """Return the number of each unknown in an order of all."""
    number = np.empty_like(order)
    number[order] = np.arange(len(order))
    return number


def placed(blocks: Sequence[tuple[Entries, int, int]]) -> Entries:
    """Return the entries of blocks, each with the row and the column where it begins."""
    return Entries(
        np.concatenate([block.data for block, _, _ in blocks]),
        np.concatenate([first + block.row for block, first, _ in blocks]),
        np.concatenate([first + block.column for block, _, first in blocks]),
    )


def elimination(problem: LimitProblem, interface: Indices) -> Indices:
    """Return the order of stresses, rates, load factor and rows of some interfaces, (s + 6 n + 1 + rows,)."""
    last = 2 * len(problem.interfaces) + numbered(rates_in_order(problem))
    return np.argsort(np.concatenate([2 * problem.stress_interface + 1, last, 2 * interface]), kind="stable")


def rates_in_order(problem: LimitProblem) -> Indices:
    """Return the order of the rates and the load factor that keeps factors sparse, shape (6 n + 1,)."""
    return known(problem, "order of the rates", lambda: _rates_in_order(problem))


def _rates_in_order(problem: LimitProblem) -> Indices:
    moves, n, loaded = problem.C.tocoo(), problem.C.shape[1], np.flatnonzero(problem.live)
    pairs = len(problem.interfaces) + np.arange(len(loaded))  # each of a rate and the load factor
    row = np.concatenate([problem.stress_interface[moves.row], pairs, pairs])
    column = np.concatenate([moves.col, loaded, np.full(len(loaded), n)])
    shape = len(problem.interfaces) + len(loaded), n + 1
    together = sparse.coo_array((np.ones(len(row)), (row, column)), shape).tocsr()
    coupled = together.T @ together
    dominant = sparse.csc_array(coupled + coupled.sum() * sparse.eye_array(n + 1))
    return np.argsort(diagonal_factors(dominant).perm_c)

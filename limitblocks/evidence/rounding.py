"""Sums of products with bounds on their rounding errors: what makes a bound a theorem.

A sum of k products in floating point, in any order, with or without fused operations, is off by at most
gamma_k = k eps / (1 - k eps) times the sum of their sizes, plus what underflows (Higham 2002, Accuracy and
Stability of Numerical Algorithms, Sections 2.1, 3.1 and 4.2).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, reduce
from operator import add
from typing import Any

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array

EPS = float(np.finfo(float).eps)  # twice the unit roundoff: pays for the sums beside the products
TINY = float(np.finfo(float).tiny)
LEAST = 1e-150  # its square is no underflow
UP = 1.0 + 2.0**-30  # pays for a million roundings of a sum of nonnegative numbers


@dataclass(frozen=True, eq=False)
class Products:
    """Sums of the products of some matrices with as many vectors, and the most that each row is off by."""

    matrices: tuple[sparse.csr_array | sparse.csc_array, ...]

    @cached_property
    def sizes(self) -> tuple[sparse.csr_array | sparse.csc_array, ...]:
        """The sizes of their entries."""
        return tuple(type(A)((size_of(A.data), A.indices, A.indptr), shape=A.shape) for A in self.matrices)

    @cached_property
    def count(self) -> int:
        """The most products that are summed in a row."""
        rows = self.matrices[0].shape[0]
        counts = [
            np.diff(A.indptr) if A.format == "csr" else np.bincount(A.indices, minlength=rows)
            for A in self.matrices
        ]
        return int(reduce(add, counts).max(initial=0))

    def of(self, vectors: tuple[Array, ...], *addends: Array) -> tuple[Array, Array]:
        """Return the sums as computed, the addends among them, and the most that each row is off by."""
        value = reduce(add, [A @ v for A, v in zip(self.matrices, vectors, strict=True)] + [*addends])
        sizes = [A @ size_of(v) for A, v in zip(self.sizes, vectors, strict=True)]
        size = reduce(add, sizes + [size_of(addend) for addend in addends])
        error = _error(self.count + 2 * len(addends) + 2, size)
        alone = sum((1 * (addend != 0.0) for addend in addends), np.zeros(len(value), dtype=int)) < 2
        return value, error * ~(alone & (reduce(add, sizes) == 0.0))  # nothing is added: it is exact


def size_of(values: Array) -> Array:
    """Sizes of numbers, those that are not zero at least so large that no product of two underflows."""
    sizes = np.abs(values)
    sizes[(sizes > 0.0) & (sizes < LEAST)] = LEAST
    return np.asarray(sizes)


def scalar_product(a: Array, b: Array) -> tuple[float, float]:
    """Return the scalar product as computed, and the most that it is off by."""
    return float(a @ b), float(_error(len(a) + 2, np.abs(a) @ np.abs(b)))


def products(A: Array, B: Array) -> tuple[Array, Array]:
    """Return the products of two stacks of small matrices, and the most that each entry is off by."""
    return A @ B, _error(A.shape[-1] + 2, np.abs(A) @ np.abs(B))


def _error(count: int, size: Any) -> Any:
    return UP * UP * count * EPS * size + count * TINY

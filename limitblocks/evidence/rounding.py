"""Sums of products with bounds on their rounding errors: what makes a bound a theorem.

A sum of k products in floating point, in any order, with or without fused operations, is off by at most
gamma_k = k eps / (1 - k eps) times the sum of their sizes, plus what underflows (Higham 2002, Accuracy and
Stability of Numerical Algorithms, Sections 2.1, 3.1 and 4.2).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array

EPS = float(np.finfo(float).eps)  # twice the unit roundoff: pays for the sums beside the products
TINY = float(np.finfo(float).tiny)
UP = 1.0 + 2.0**-30  # pays for a million roundings of a sum of nonnegative numbers


def product(A: sparse.csr_array, v: Array, *addends: Array) -> tuple[Array, Array]:
    """Return A v + the addends as computed, and the most that each row is off by."""
    count = int(np.diff(A.indptr).max(initial=0)) + 2 * len(addends) + 2
    value, size, terms = A @ v, abs(A) @ np.abs(v), A.astype(bool) @ (v != 0.0)
    for addend in addends:
        value, size, terms = value + addend, size + np.abs(addend), terms | (addend != 0.0)
    return value, np.where(terms, _error(count, size), 0.0)


def scalar_product(a: Array, b: Array) -> tuple[float, float]:
    """Return the scalar product as computed, and the most that it is off by."""
    return float(a @ b), float(_error(len(a) + 2, np.abs(a) @ np.abs(b)))


def products(A: Array, B: Array) -> tuple[Array, Array]:
    """Return the products of two stacks of small matrices, and the most that each entry is off by."""
    return A @ B, _error(A.shape[-1] + 2, np.abs(A) @ np.abs(B))


def _error(count: int, size: Any) -> Any:
    return UP * UP * count * EPS * size + count * TINY

"""Linear equations with a positive semidefinite matrix, such as that of equilibrium, factorised once."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy import sparse
from scipy.linalg import cho_solve_banded, cholesky_banded
from scipy.sparse import csgraph, linalg

from limitblocks.arrays import Array, Indices

REGULAR = 1e-12  # blocks that can move freely make the matrix of equilibrium singular
BAND = 512  # widest that is factorised as a band: docs/solvers.md


def solver_of(K: sparse.csr_array) -> Callable[[Array], Array]:
    """Return the function x(b) with K x = b, nearly where K is singular.

    A narrow band of entries (Cuthill & McKee 1969) is factorised by LAPACK, in dense arithmetic.
    """
    diagonal = K.diagonal()  # in units of a state its entries are far apart
    more = REGULAR * np.where(diagonal > 0.0, diagonal, 1.0)
    order = csgraph.reverse_cuthill_mckee(K, symmetric_mode=True).astype(np.int64)
    order = order[np.diff(K.indptr)[order] > 0]  # rates out of a plane have no equations
    place = np.empty(len(more), dtype=np.int64)
    place[order] = np.arange(len(order))
    column = np.repeat(place, np.diff(K.indptr))
    below = place[K.indices] - column
    if below.max(initial=0) <= BAND:
        try:
            return _banded(K.data, below, column, order, more)
        except np.linalg.LinAlgError:  # not definite, by rounding
            pass
    symmetric: Any = {"SymmetricMode": True}  # definite: no exchange of rows, half the entries
    A = sparse.csc_array(K + sparse.diags_array(more))
    return linalg.splu(A, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=symmetric).solve


def _banded(
    data: Array, below: Indices, column: Indices, order: Indices, more: Array
) -> Callable[[Array], Array]:
    """The same by the entries `data` so far `below` the diagonal of a `column`, unknowns in an `order`.

    The diagonal has `more`, one for each unknown.
    """
    band = np.zeros((int(below.max(initial=0)) + 1, len(order)), order="F")
    lower = below >= 0
    band[below[lower], column[lower]] = data[lower]
    band[0] += more[order]
    factor = cholesky_banded(band, overwrite_ab=True, lower=True, check_finite=False)

    def solve(b: Array) -> Array:
        x = b / more
        x[order] = cho_solve_banded((factor, True), b[order], overwrite_b=True, check_finite=False)
        return x

    return solve

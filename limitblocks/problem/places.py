"""The places where forces act: interfaces, or points of them."""

from __future__ import annotations

import numpy as np
from scipy import sparse
from scipy.sparse import csgraph

from limitblocks.arrays import Indices
from limitblocks.problem.limit_problem import LimitProblem


def places(problem: LimitProblem) -> tuple[Indices, Indices]:
    """Number the places where forces act: interfaces, or points of them.

    Returns the place of each linear row and cone (degree,) and of each stress (s,) that it acts on.
    """
    F, cones = problem.F, problem.cones
    degree, count = cones.degree, cones.degree + F.shape[1]
    start = np.concatenate([F.indptr[cones.heads], np.full(F.shape[1] + 1, F.nnz)])  # rows of a cone are one
    graph = sparse.csr_array((F.data, F.indices + degree, start), shape=(count, count))
    numbers = np.asarray(csgraph.connected_components(graph, directed=False)[1], dtype=np.int64)
    return numbers[:degree], numbers[degree:]

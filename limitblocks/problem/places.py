"""The places where forces act: interfaces, or points of them."""

from __future__ import annotations

import numpy as np
from scipy import sparse

from limitblocks.arrays import Indices
from limitblocks.problem.limit_problem import LimitProblem


def places(problem: LimitProblem) -> tuple[Indices, Indices]:
    """Number the places where forces act: interfaces, or points of them.

    Returns the place of each linear row and cone (degree,) and of each stress (s,) that it acts on.
    """
    cones = problem.cones
    F = problem.F.tocoo()
    acts = F.data != 0.0
    pairs = cones.member[F.row[acts]], cones.degree + F.col[acts]
    count = cones.degree + F.shape[1]
    graph = sparse.coo_array((np.ones(len(pairs[0])), pairs), shape=(count, count)).tocsr()
    _, label = sparse.csgraph.connected_components(graph, directed=False)
    numbers = np.asarray(label, dtype=np.int64)
    return numbers[: cones.degree], numbers[cones.degree :]

"""The places where forces act: interfaces, or points of them."""

from __future__ import annotations

import numpy as np

from limitblocks.arrays import Indices, tied
from limitblocks.problem.limit_problem import LimitProblem


def places(problem: LimitProblem) -> tuple[Indices, Indices]:
    """Number the places where forces act: interfaces, or points of them.

    Returns the place of each linear row and cone (degree,) and of each stress (s,) that it acts on.
    """
    cones = problem.cones
    F = problem.F.tocoo()
    acts = F.data != 0.0
    pairs = np.column_stack([cones.member[F.row[acts]], cones.degree + F.col[acts]])
    numbers = tied(pairs, cones.degree + F.shape[1])
    return numbers[: cones.degree], numbers[cones.degree :]

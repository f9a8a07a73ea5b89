"""Dimensionless stresses and rates as the arrays of a result, SI units."""

from __future__ import annotations

import numpy as np

from limitblocks.arrays import Array, read_only
from limitblocks.model import Model
from limitblocks.problem import LimitProblem


def resultants_of(problem: LimitProblem, x: Array) -> Array:
    """Stress resultants (m, 6), N and N m, of dimensionless stresses."""
    return read_only((problem.resultants @ x * problem.units.resultants).reshape(-1, 6))


def in_model_order(model: Model, rates: Array) -> Array:
    """Displacement rates (n, 6) of all blocks, supports as zero; `rates` of the free ones, m and rad."""
    ordered = np.zeros((len(model.blocks), 6))
    ordered[model.free] = rates.reshape(-1, 6)
    return read_only(ordered)

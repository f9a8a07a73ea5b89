"""The matrices of a program that cvxpy has built, as Clarabel takes them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import cvxpy as cp
import numpy as np
from cvxpy.atoms.affine.add_expr import AddExpression
from scipy import sparse

from limitblocks.arrays import Array
from limitblocks.problem import Cones


@dataclass(frozen=True, eq=False)
class Conic:
    """The least c.v + v^T W v / 2 with b - A v zero in its first rows, in K in all others; no W is zero."""

    c: Array
    A: sparse.csc_array
    b: Array
    cones: Cones
    W: Array | None = None


def compiled(problem: cp.Problem) -> Conic:
    """Return the matrices of a program in one variable v, all of it a matrix times v, or that plus constants.

    They are what `get_problem_data` returns, read where cvxpy keeps them: in a sixth of the time, since no
    other expressions and no parameters are looked for.
    """
    kinds = cp.constraints.Equality, cp.constraints.Inequality, cp.SOC
    equal, above, conic = ([one for one in problem.constraints if isinstance(one, kind)] for kind in kinds)
    parts = [_affine(one.args[0]) for one in equal] + [_affine(one.args[1]) for one in above]
    right = [np.ravel(one.args[1].value) for one in equal]
    parts += [_affine(part) for one in conic for part in one.args]  # all heads t, and then all tails
    K = Cones.of_sizes(sum(one.size for one in above), [size for one in conic for size in one.cone_sizes()])
    zero = sum(map(len, right))
    order = [np.arange(zero + K.linear)]
    for rows in K.groups:
        count, size = rows.shape
        tails = count + np.arange(count * (size - 1)).reshape(count, -1)
        order.append(zero + rows[0, 0] + np.column_stack([np.arange(count), tails]).ravel())
    place = np.concatenate(order)
    A = sparse.vstack([matrix for matrix, _ in parts], format="csc")
    A.data[A.indices >= zero] *= -1.0
    if K.second_order:
        A.indices[:] = np.argsort(place)[A.indices]
        A.has_sorted_indices = False
        A.sort_indices()
    constants = np.concatenate(right + [constant for _, constant in parts[len(equal) :]])
    cost = np.ravel(problem.objective.expr.args[0].value)
    return Conic(cost, A, constants[place], K)


def _affine(rows: cp.Expression) -> tuple[sparse.csc_array, Array]:
    """A and b of rows A v + b."""
    if isinstance(rows, cp.reshape):
        return _affine(rows.args[0])
    product, *constant = rows.args if isinstance(rows, AddExpression) else (rows,)
    matrix: Any = product.args[0].value
    matrix = matrix if sparse.issparse(matrix) else matrix[None]
    return sparse.csc_array(matrix), np.ravel(constant[0].value) if constant else np.zeros(rows.size)

"""Compatibility matrix C of the assemblage: strain rates = C (displacement rates), Eqs (44)-(47)."""

from __future__ import annotations

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array, Indices

# Of a direction cosine: where joints without friction are level but for rounding, an equation of nothing but
# rounding would leave no normal force.
ROUNDING = 1e-12


def compatibility_matrix(
    axes: Array, at_i: Array, at_j: Array, block_i: Indices, block_j: Indices, n_blocks: int
) -> sparse.csr_array:
    """Return C, shape (6 m, 6 n_blocks), for m interfaces.

    Eq. (46) built from the rotation du + w x r, because the last row of its printed upper-right block has
    a wrong sign: with + on (Xk - Xi) virtual work fails.

    Parameters
    ----------
    axes : Array, shape (m, 3, 3)
        Rows s1, s2, n of each interface.
    at_i, at_j : Array, shape (m, 3)
        Interface centroid minus the centroid of block i or j.
    block_i, block_j : Indices, shape (m,)
        Positions of the two blocks; -1 for a support, which does not move.
    n_blocks : int
        Number of free blocks.
    """
    m = len(axes)
    values, columns = [], []
    for sign, at, block in ((-1.0, at_i, block_i), (1.0, at_j, block_j)):
        values.append(sign * _rigid_body(axes, at))
        columns.append(np.where(block[:, None] >= 0, 6 * block[:, None] + np.arange(6), -1))
    rows = np.broadcast_to(np.arange(6 * m).reshape(m, 6, 1), (m, 6, 6))
    data = np.stack(values)
    column = np.broadcast_to(np.stack(columns)[:, :, None, :], data.shape)
    row = np.broadcast_to(rows, data.shape)
    keep = (column >= 0) & (data != 0.0)
    return sparse.coo_array((data[keep], (row[keep], column[keep])), shape=(6 * m, 6 * n_blocks)).tocsr()


def _rigid_body(axes: Array, at: Array) -> Array:
    """Local strain rates (m, 6, 6) at the points `at` per displacement rate of a block: du + w x r."""
    axes = np.where(np.abs(axes) > ROUNDING, axes, 0.0)
    cross = np.zeros((len(axes), 3, 3))  # cross @ w = w x r
    x, y, z = at.T
    cross[:, 0, 1], cross[:, 0, 2] = z, -y
    cross[:, 1, 0], cross[:, 1, 2] = -z, x
    cross[:, 2, 0], cross[:, 2, 1] = y, -x
    matrix = np.zeros((len(axes), 6, 6))
    matrix[:, :3, :3] = matrix[:, 3:, 3:] = axes
    matrix[:, :3, 3:] = axes @ cross
    return matrix

"""Jordan algebra of the cone K: products, arrow matrices, longest steps; vectorised over cones of one size.

Source: Alizadeh & Goldfarb (2003), Second-order cone programming, Mathematical Programming 95, Section 4.
"""

from __future__ import annotations

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array, Indices
from limitblocks.problem import Cones


def _groups(cones: Cones) -> list[Indices]:
    """Places of the rows of each size of second-order cone, shapes (count, size)."""
    return [first + np.arange(count * size).reshape(count, size) for first, count, size in cones.blocks]


def product(cones: Cones, a: Array, b: Array) -> Array:
    """Return a o b: row by row, and (a.b, a0 bz + b0 az) for a second-order cone."""
    found = a * b
    for index in _groups(cones):
        p, q = a[index], b[index]
        found[index] = p[:, :1] * q + q[:, :1] * p
        found[index[:, 0]] = (p * q).sum(axis=1)
    return found


def arrow(cones: Cones, v: Array) -> sparse.csr_array:
    """Return the matrix L(v) of L(v) w = v o w."""
    blocks = []
    for index in _groups(cones):
        w = v[index]
        block = w[:, :1, None] * np.eye(w.shape[1])
        block[:, 0, 1:] = block[:, 1:, 0] = w[:, 1:]
        blocks.append(block)
    return _matrix(cones, v[: cones.linear], blocks)


def inverse_arrow(cones: Cones, v: Array) -> sparse.csr_array:
    """Return the inverse of L(v)."""
    blocks = []
    for index in _groups(cones):
        w = v[index]
        t, z, det = w[:, 0], w[:, 1:], _determinant(w)
        block = np.zeros((*w.shape, w.shape[1]))
        block[:, 0, 0] = t / det
        block[:, 0, 1:] = block[:, 1:, 0] = -z / det[:, None]
        outer = z[:, :, None] * z[:, None, :] / (t * det)[:, None, None]
        block[:, 1:, 1:] = np.eye(w.shape[1] - 1) / t[:, None, None] + outer
        blocks.append(block)
    return _matrix(cones, 1.0 / v[: cones.linear], blocks)


def least_product(cones: Cones, a: Array, b: Array) -> float:
    """Return the least eigenvalue of the products of a and b, both in K: how far off the central path."""
    least = float(np.min(a[: cones.linear] * b[: cones.linear], initial=np.inf))
    for index in _groups(cones):
        p, q = a[index], b[index]
        half = (p * q).sum(axis=1)
        det = _determinant(p) * _determinant(q)
        root = np.sqrt(np.maximum(half * half - det, 0.0))
        safe = np.where(half > 0.0, half + root, 1.0)
        least = min(least, float(np.where(half > 0.0, det / safe, -1.0).min(initial=np.inf)))
    return least


def longest(cones: Cones, v: Array, dv: Array) -> float:
    """Return the largest t with v + t dv in K, for v inside K; infinite if there is none."""
    a, b = v[: cones.linear], dv[: cones.linear]
    t = float(np.min(-a[b < 0.0] / b[b < 0.0], initial=np.inf))
    for index in _groups(cones):
        p, d = v[index], dv[index]
        aa, cc = _determinant(d), _determinant(p)
        bb = p[:, 0] * d[:, 0] - (p[:, 1:] * d[:, 1:]).sum(axis=1)
        meets = bb * bb >= aa * cc
        below = np.sqrt(np.where(meets, bb * bb - aa * cc, 0.0)) - bb
        # the stable form of the first root of aa t^2 + 2 bb t + cc
        first = np.where(meets & (below > 0.0), cc / np.where(below > 0.0, below, 1.0), np.inf)
        falling = d[:, 0] < 0.0
        t = min(
            t, float(first.min(initial=np.inf)), float(np.min(-p[falling, 0] / d[falling, 0], initial=np.inf))
        )
    return t


def _determinant(v: Array) -> Array:
    return np.asarray(v[:, 0] ** 2 - (v[:, 1:] ** 2).sum(axis=1))


def _matrix(cones: Cones, line: Array, blocks: list[Array]) -> sparse.csr_array:
    k = np.arange(cones.linear)
    data, rows, columns = [line], [k], [k]
    for index, block in zip(_groups(cones), blocks, strict=True):
        data.append(block.ravel())
        rows.append(np.broadcast_to(index[:, :, None], block.shape).ravel())
        columns.append(np.broadcast_to(index[:, None, :], block.shape).ravel())
    height = cones.linear + sum(count * size for count, size in cones.second_order)
    entries = (np.concatenate(data), (np.concatenate(rows), np.concatenate(columns)))
    return sparse.coo_array(entries, shape=(height, height)).tocsr()

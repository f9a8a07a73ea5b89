"""Geometry of the barrier of cones: quotients, its metric, and the spread of products.

Source: Alizadeh & Goldfarb (2003), Second-order cone programming, Mathematical Programming 95, Section 4.
Vectors of a group of cones stand side by side, shape (size, count, ...): sums over a few rows are fast so.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from limitblocks.arrays import Array
from limitblocks.problem.cones import Cones


def minkowski(a: Array, b: Array) -> Array:
    """Return a0 b0 - az.bz of each cone, shapes (size, count, ...)."""
    return np.asarray(a[0] * b[0] - (a[1:] * b[1:]).sum(axis=0))


def quotient(cones: Cones, s: Array, q: Array) -> Array:
    """Return L(s)^-1 q: what times s is q."""
    rows, k = np.empty_like(q), slice(0, cones.linear)
    rows[k] = q[k] / s[k]
    for index in cones.groups:
        v, w = s.take(index.T), q.take(index.T)
        first = minkowski(v, w) / minkowski(v, v)
        rows[index.T] = np.vstack([first, (w[1:] - first * v[1:]) / v[0]])
    return rows


def central(cones: Cones, v: Array, products: Array) -> tuple[Array, Array]:
    """Return s and y in int K with s - y = v and s o y = products, multiples (R,) of the identity.

    They are smooth in v, as the positive parts of v and -v are not: Fukushima, Luo & Tseng (2002), Smoothing
    functions for second-order-cone complementarity problems, SIAM J. Optimization 12, Section 4.
    """
    k = slice(0, cones.linear)
    s, y = np.empty_like(v), np.empty_like(v)
    s[k], y[k] = _halves(v[k], products[k])
    for index in cones.groups:
        w, product = v.take(index.T), products.take(index[:, 0])
        size = np.sqrt((w[1:] * w[1:]).sum(axis=0))
        axis = w[1:] / np.where(size > 0.0, size, 1.0)
        for vector, (a, b) in zip(
            (s, y), _halves(np.array([w[0] + size, w[0] - size]), product), strict=True
        ):
            rows = vector[index[0, 0] : index[-1, -1] + 1].reshape(index.shape)
            rows[:, 0], rows[:, 1:] = (a + b) / 2.0, ((a - b) / 2.0 * axis).T
    return s, y


def _halves(v: Array, product: Array) -> tuple[Array, Array]:
    """Return positive a and b with a - b = v and this product, without cancellation."""
    large = (np.abs(v) + np.sqrt(v * v + 4.0 * product)) / 2.0
    small = product / large
    return np.where(v > 0.0, large, small), np.where(v > 0.0, small, large)


def slope(cones: Cones, s: Array, y: Array) -> Callable[[Array], Array]:
    """Return what applies L(s)^-1 L(y) to rows (R,) or (R, k): how multipliers fall with the slack."""
    k = slice(0, cones.linear)
    line = y[k] / s[k]
    matrices = [_slopes(s.take(index.T), y.take(index.T)) for index in cones.groups]

    def applied(rows: Array) -> Array:
        fall = np.empty_like(rows)
        fall[k] = (rows[k].T * line).T
        for index, matrix in zip(cones.groups, matrices, strict=True):
            part = slice(index[0, 0], index[-1, -1] + 1)
            fall[part] = (matrix @ rows[part].reshape(*index.shape, -1)).reshape(rows[part].shape)
        return fall

    return applied


def _slopes(v: Array, w: Array) -> Array:
    """L(v)^-1 L(w) of each cone, shape (count, size, size)."""
    size, count = v.shape
    matrix = np.empty((size, size, count))
    matrix[0, 0] = minkowski(v, w)
    matrix[0, 1:] = v[0] * w[1:] - w[0] * v[1:]
    matrix[0] /= minkowski(v, v)
    matrix[1:] = -v[1:, None] * matrix[0]
    matrix[1:, 0] += w[1:]
    diagonal = np.arange(1, size)
    matrix[diagonal, diagonal] += w[0]
    matrix[1:] /= v[0]
    return np.ascontiguousarray(matrix.transpose(2, 0, 1))


def curvature(cones: Cones, v: Array, a: Array) -> Array:
    """Return the Hessian of the barrier at v times a: a change relative to v, as a covector.

    The barrier is -log v of a row and -log(v0^2 - vz.vz) / 2 of a cone (Nesterov & Todd 1997).
    """
    k = slice(0, cones.linear)
    curved = np.empty_like(a)
    curved[k] = a[k] / v[k] ** 2
    for index in cones.groups:
        w, p = v.take(index.T), a.take(index.T)
        size = minkowski(w, w)
        part = (2.0 * minkowski(w, p) / size * w - p) / size
        part[1:] *= -1.0
        curved[index.T] = part
    return curved


def spread(cones: Cones, s: Array, y: Array, target: Array) -> float:
    """Return the largest |log| of an eigenvalue of the products of s and y over its target."""
    k = slice(0, cones.linear)
    products = [s[k] * y[k] / target[k]]
    for index in cones.groups:
        p, q, aim = s.take(index.T), y.take(index.T), target.take(index[:, 0])
        half = (p * q).sum(axis=0)
        both = minkowski(p, p) * minkowski(q, q)
        large = half + np.sqrt(np.maximum(half * half - both, 0.0))
        products += [large / aim, both / (large * aim)]
    eigenvalues = np.concatenate(products)
    least, most = eigenvalues.min(initial=1.0), eigenvalues.max(initial=1.0)
    return float(max(-np.log(least), np.log(most))) if least > 0.0 else np.inf

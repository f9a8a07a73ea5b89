"""Geometry of the barrier of cones: quotients, its metric, and the spread of products.

Source: Alizadeh & Goldfarb (2003), Second-order cone programming, Mathematical Programming 95, Section 4.
"""

from __future__ import annotations

import numpy as np

from limitblocks.arrays import Array
from limitblocks.problem.cones import Cones


def minkowski(a: Array, b: Array) -> Array:
    """Return a0 b0 - az.bz of each cone, shapes (count, size, ...)."""
    return np.asarray(a[:, 0] * b[:, 0] - (a[:, 1:] * b[:, 1:]).sum(axis=1))


def inverse(cones: Cones, s: Array) -> Array:
    """Return s^-1, with s o s^-1 the identity."""
    inverted = np.empty_like(s)
    inverted[: cones.linear] = 1.0 / s[: cones.linear]
    for index in cones.groups:
        v = s[index]
        v = v / minkowski(v, v)[:, None]
        v[:, 1:] *= -1.0
        inverted[index] = v
    return inverted


def quotient(cones: Cones, s: Array, q: Array) -> Array:
    """Return L(s)^-1 q: what times s is q."""
    rows = np.empty_like(q)
    rows[: cones.linear] = q[: cones.linear] / s[: cones.linear]
    for index in cones.groups:
        v, w = s[index], q[index]
        first = minkowski(v, w) / minkowski(v, v)
        rows[index[:, 0]] = first
        rows[index[:, 1:]] = (w[:, 1:] - first[:, None] * v[:, 1:]) / v[:, :1]
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
        w, product = v[index], products[index[:, 0]]
        size = np.linalg.norm(w[:, 1:], axis=1)
        axis = w[:, 1:] / np.where(size > 0.0, size, 1.0)[:, None]
        large, small = _halves(w[:, 0] + size, product), _halves(w[:, 0] - size, product)
        for vector, a, b in zip((s, y), large, small, strict=True):
            vector[index] = np.column_stack([(a + b) / 2.0, ((a - b) / 2.0)[:, None] * axis])
    return s, y


def _halves(v: Array, product: Array) -> tuple[Array, Array]:
    """Return positive a and b with a - b = v and this product, without cancellation."""
    large = (np.abs(v) + np.sqrt(v * v + 4.0 * product)) / 2.0
    small = product / large
    return np.where(v > 0.0, large, small), np.where(v > 0.0, small, large)


def slope(cones: Cones, s: Array, y: Array, rows: Array) -> Array:
    """Return L(s)^-1 L(y) applied to rows, shape (R, k): how multipliers fall with the slack."""
    k = slice(0, cones.linear)
    slopes = np.empty_like(rows)
    slopes[k] = rows[k] * (y[k] / s[k])[:, None]
    for index in cones.groups:
        v, w, F = s[index][:, :, None], y[index][:, :, None], rows[index]
        head = (w * F).sum(axis=1, keepdims=True)
        tail = w[:, :1] * F[:, 1:] + w[:, 1:] * F[:, :1]
        first = (v[:, :1] * head - (v[:, 1:] * tail).sum(axis=1, keepdims=True)) / minkowski(v, v)[:, None]
        slopes[index] = np.concatenate([first, (tail - first * v[:, 1:]) / v[:, :1]], axis=1)
    return slopes


def relative(cones: Cones, v: Array, a: Array, b: Array) -> float:
    """Return the product of two changes of v relative to v, in the Hessian of the barrier at v.

    The barrier is -log v of a row and -log(v0^2 - vz.vz) / 2 of a cone (Nesterov & Todd 1997).
    """
    k = slice(0, cones.linear)
    total = float(np.sum(a[k] * b[k] / v[k] ** 2))
    for index in cones.groups:
        w, p, q = v[index], a[index], b[index]
        size = minkowski(w, w)
        along = 2.0 * minkowski(w, p) * minkowski(w, q) / size**2
        total += float(np.sum(along - minkowski(p, q) / size))
    return total


def spread(cones: Cones, s: Array, y: Array, target: Array) -> float:
    """Return the largest |log| of an eigenvalue of the products of s and y over its target."""
    k = slice(0, cones.linear)
    products = [s[k] * y[k] / target[k]]
    for index in cones.groups:
        p, q, aim = s[index], y[index], target[index[:, 0]]
        half = (p * q).sum(axis=1)
        both = minkowski(p, p) * minkowski(q, q)
        large = half + np.sqrt(np.maximum(half * half - both, 0.0))
        products += [large / aim, both / (large * aim)]
    eigenvalues = np.concatenate(products)
    return float(np.abs(np.log(eigenvalues)).max(initial=0.0)) if (eigenvalues > 0.0).all() else np.inf

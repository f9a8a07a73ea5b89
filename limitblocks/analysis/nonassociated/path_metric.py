"""Lengths along a path: the local metric of the barrier, the spread of products, the room to the boundary."""

from __future__ import annotations

import numpy as np

from limitblocks.analysis.nonassociated.path_equations import Point
from limitblocks.arrays import Array
from limitblocks.problem import Cones


def inner(cones: Cones, z: Point, a: Point, b: Point) -> float:
    """Product of two directions: mean of relative changes of s and y, and of theta.

    Of a cone in the Hessian of its barrier -log(t^2 - z.z)/2 (Nesterov & Todd 1997).
    """
    total = _relative(cones, z.s, a.s, b.s) + _relative(cones, z.y, a.y, b.y)
    return total / cones.degree + a.theta * b.theta / z.theta**2


def _relative(cones: Cones, v: Array, a: Array, b: Array) -> float:
    k = slice(0, cones.linear)
    total = float(np.sum(a[k] * b[k] / v[k] ** 2))
    for index in cones.groups:
        w, p, q = v[index], a[index], b[index]
        det = _minkowski(w, w)
        total += float(np.sum(2.0 * _minkowski(w, p) * _minkowski(w, q) / det**2 - _minkowski(p, q) / det))
    return total


def _minkowski(a: Array, b: Array) -> Array:
    return np.asarray(a[:, 0] * b[:, 0] - (a[:, 1:] * b[:, 1:]).sum(axis=1))


def spread(cones: Cones, s: Array, y: Array, target: Array) -> float:
    """Largest |log| of an eigenvalue of the products of s and y over its target."""
    k = slice(0, cones.linear)
    products = [s[k] * y[k] / target[k]]
    for index in cones.groups:
        p, q, aim = s[index], y[index], target[index[:, 0]]
        half = (p * q).sum(axis=1)
        det = _minkowski(p, p) * _minkowski(q, q)
        large = half + np.sqrt(np.maximum(half * half - det, 0.0))
        products += [large / aim, det / large / aim]
    found = np.concatenate(products)
    if not (found > 0.0).all():
        return np.inf
    return float(np.abs(np.log(found)).max(initial=0.0))


def room(cones: Cones, z: Point, d: Point) -> float:
    """Largest t for which z + t d keeps s, y in K and theta at least zero."""
    t = min(cones.longest(z.s, d.s), cones.longest(z.y, d.y))
    return min(t, z.theta / -d.theta) if d.theta < 0.0 else t

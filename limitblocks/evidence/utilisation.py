"""How much of its strength each interface uses, from the yield rows. numpy only."""

from __future__ import annotations

from typing import Any

import numpy as np

from limitblocks.arrays import Array, Indices
from limitblocks.joints.rows import hinge_gradients
from limitblocks.model import Model
from limitblocks.problem import LimitProblem

NOISE = 1e-9  # of the mean block weight: a strength below it counts as none


def utilisation(model: Model, stresses: Array) -> Array:
    """Return the utilisation of each interface, shape (m,), from 0 to 1 on the yield surface.

    It is 1/t, t the largest multiple of (V1, V2, M1, M2, T) within the yield rows under the same N, as
    :meth:`limitblocks.joints.queries.Queries.utilisation` has it. Where the rows act on the forces of points
    (PointContact), which are not unique, it is the larger of the friction in use over that available, summed
    over the points, and the way of the centre of pressure from the centroid to the edge.

    Parameters
    ----------
    model : Model
        The structure.
    stresses : Array, shape (s,)
        Generalised stresses of a result, N and N m.
    """
    problem = model.problem
    x = stresses / problem.stress_units
    V1, V2, N = (problem.resultants[k::6].tocsr() for k in range(3))
    normal = np.zeros(len(x))
    normal[N.indices] = 1.0
    share = _shares(problem, problem.F @ (x * normal) + problem.g, problem.F @ (x * (1.0 - normal)))
    used = np.zeros(len(problem.interfaces))
    np.maximum.at(used, _first_rows(problem), share)
    points = np.flatnonzero(np.diff(N.indptr) > 1)  # rows that act on the forces of points
    if len(points):
        sizes = np.hypot(x[V1.indices], x[V2.indices])
        owner = np.repeat(np.arange(len(used)), np.diff(V1.indptr))
        friction = np.bincount(owner, weights=sizes, minlength=len(used))[points]
        used[points] = _ratio(friction, problem.friction[points] * -(N @ x)[points])
        Q = (problem.resultants @ x).reshape(-1, 6)
        for k in points.tolist():
            h = hinge_gradients(model.interfaces[k].polygon[None] / problem.scales.length)[0]
            used[k] = max(used[k], float(_ratio((h[:, 3:] @ Q[k, 3:]).max(), -Q[k, 2])))
    return used


def _first_rows(problem: LimitProblem) -> Indices:
    """Interface of each linear row and of each cone."""
    cones = [first + size * np.arange(count) for first, count, size in problem.cones.blocks]
    return np.asarray(problem.row_interface[np.concatenate([np.arange(problem.cones.linear), *cones])])


def _shares(problem: LimitProblem, held: Array, rest: Array) -> Array:
    """Least s >= 0 of each linear row and each cone for which s held + rest is in it: 1 at yield."""
    n = problem.cones.linear
    parts = [_ratio(-rest[:n], held[:n])]
    for first, count, size in problem.cones.blocks:
        a, b = (v[first : first + count * size].reshape(count, size) for v in (held, rest))
        signs = np.r_[1.0, -np.ones(size - 1)]
        aa, ab, bb = (a * a) @ signs, (a * b) @ signs, (b * b) @ signs
        parts.append(_ratio(np.sqrt(np.maximum(ab**2 - aa * bb, 0.0)) - ab, aa))
    return np.concatenate(parts)


def _ratio(used: Any, available: Any) -> Array:
    """Quotient in 0 to 1; where nothing is available it is 1 if anything is used."""
    safe = np.where(available > NOISE, available, 1.0)
    share = np.where(available > NOISE, np.clip(used / safe, 0.0, 1.0), used > NOISE)
    return np.asarray(share, dtype=float)

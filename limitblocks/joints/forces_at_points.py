"""How much of their strength interfaces use whose rows act on the forces of points, which are not unique.

The largest t is sought for which forces of the points, each within its cone, have the resultants N and
t (V1, V2, M1, M2, T): a small cone program for each interface, all of them at once by a barrier method
(Nesterov & Nemirovskii 1994, Interior-Point Polynomial Algorithms in Convex Programming, Sections 2.2, 3.2).
"""

from __future__ import annotations

from contextlib import suppress

import numpy as np

from limitblocks.arrays import Array
from limitblocks.joints.base import YieldRows
from limitblocks.problem import Cones

RATIO = 10.0
WEIGHTS = 3.0 * RATIO ** np.arange(
    7
)  # of t against the barrier: 10 / weight of it is missing; more is rounding
CENTRAL = 1e-3  # Newton decrement near enough to the centre
STEPS = 30  # to a centre; some eight are usual


def used(rows: YieldRows, Q: Array) -> Array:
    """Return the utilisation under the same N, from 0 to 1, of interfaces that are pressed together, (m,).

    Parameters
    ----------
    rows : YieldRows
        Of m interfaces, alike but for their resultants; no constant terms.
    Q : Array, shape (m, 6)
        Stress resultants in the units of the rows, N < 0; any N by itself can be carried.
    """
    carried = rows.resultants[0].any(axis=1)  # without friction N, M1, M2 alone
    d = (Q / -Q[:, 2:3] * [1.0, 1.0, 0.0, 1.0, 1.0, 1.0])[:, carried]
    size = np.abs(d).max(axis=1)
    asked, found = size > 0.0, np.zeros(len(Q))
    held = _pressed(rows.resultants[asked])
    t = _farthest(rows, held, rows.resultants[asked][:, carried], d[asked] / size[asked, None])
    found[asked] = np.minimum(size[asked] / t, 1.0)
    return found


def _farthest(rows: YieldRows, x: Array, B: Array, d: Array) -> Array:
    """Largest t with resultants t d beside those of x, (m,): last centre and a ninth of the last way."""
    F, cones = rows.F[0], Cones.of_sizes(rows.linear, rows.cones)
    t = before = np.zeros(len(B))
    with suppress(np.linalg.LinAlgError):  # as near to yield as rounding allows
        for weight in WEIGHTS:
            before, push = t, weight / np.where(t > 0.0, t, 1.0)
            for _ in range(STEPS):
                dx, dt, decrement = _newton(*_barrier(F, cones, x), B, d, push)
                step = 1.0 / (1.0 + decrement)  # never leaves the cones
                x, t = x + step[:, None] * dx, t + step * dt
                if not (decrement > CENTRAL).any():
                    break
    return t + (t - before) / (RATIO - 1.0)


def _newton(gradient: Array, hessian: Array, B: Array, d: Array, push: Array) -> tuple[Array, Array, Array]:
    """Step of x (m, s) and t (m,) towards the centre with B x = t d + held, and its decrement (m,)."""
    solved = np.linalg.solve(hessian, np.append(B.mT, gradient[..., None], axis=2))
    moved = B @ solved
    across = np.linalg.solve(moved[..., :-1], np.stack([d, moved[..., -1]], axis=2))
    along, rest = np.einsum("mi,mik->km", d, across)
    dt = (push - rest) / along
    change = across[..., 0] * dt[:, None] + across[..., 1]
    dx = (solved[..., :-1] @ change[..., None])[..., 0] - solved[..., -1]
    return dx, dt, np.sqrt(np.einsum("ms,mst,mt->m", dx, hessian, dx))


def _barrier(F: Array, cones: Cones, x: Array) -> tuple[Array, Array]:
    """Gradient (m, s) and Hessian (m, s, s) of -log of linear rows and of t^2 - ||z||^2 of cones F x."""
    slack = x @ F.T
    lines = F[: cones.linear] / slack[:, : cones.linear, None]
    gradient, hessian = -lines.sum(axis=1), lines.mT @ lines
    for index in cones.groups:
        sign = np.where(np.arange(index.shape[1]) > 0, -1.0, 1.0)
        v, own = slack[:, index], F[index]
        inside = 1.0 / (v[..., 0] ** 2 - (v[..., 1:] ** 2).sum(axis=2))
        lines = 2.0 * inside[..., None] * np.einsum("mci,cis->mcs", v * sign, own)
        gradient -= lines.sum(axis=1)
        hessian += lines.mT @ lines
        hessian -= np.einsum("mc,cst->mst", 2.0 * inside, np.einsum("cis,i,cit->cst", own, sign, own))
    return gradient, hessian


def _pressed(B: Array) -> Array:
    """Forces (m, s) of all points, all compressive, whose resultant is N = -1 at the centroid.

    Mean value coordinates (Floater 2003, Computer Aided Geometric Design 20): positive in a convex polygon.
    """
    pressure = np.flatnonzero(B[0, 2])
    points = np.stack([-B[:, 4, pressure], B[:, 3, pressure]], axis=2)
    following = np.roll(points, -1, axis=1)
    cross = points[..., 0] * following[..., 1] - points[..., 1] * following[..., 0]
    reach = np.linalg.norm(points, axis=2)
    half = cross / (
        reach * np.roll(reach, -1, axis=1) + (points * following).sum(axis=2)
    )  # tan of half the angle
    weight = (half + np.roll(half, 1, axis=1)) / reach
    x = np.zeros((len(B), B.shape[2]))
    x[:, pressure] = -weight / weight.sum(axis=1, keepdims=True)
    return x

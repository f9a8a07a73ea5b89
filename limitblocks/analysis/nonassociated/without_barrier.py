"""What of the load factor at the end of a path its barrier bears, and the rest of the path without that.

Where compliance and barrier fade alike, mu / rho stays. A joint that nothing presses bears sqrt(mu / (rho W))
all along, and where it slides its friction is part of the load factor. It grows with the root of the
barrier's size, so that twice its derivative by the logarithm of the size is this part.
Where it is too large the barrier fades first, at the compliance there is, and then what is left of both.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from limitblocks.analysis.nonassociated.increment import FADING
from limitblocks.analysis.nonassociated.path import Walk
from limitblocks.analysis.nonassociated.path_equations import Barrier, Base, Equations, Path, moved
from limitblocks.analysis.nonassociated.path_newton import Newton
from limitblocks.analysis.nonassociated.path_record import BORNE, CLOSED, FADED, INTERRUPTED
from limitblocks.analysis.nonassociated.stretch import Stretch

MOST = 5e-3  # of the load factor that the barrier may bear
LEFT = 1e-4  # of the barrier after it has faded: a hundredth of what it bore
BUDGET, PATIENCE = 300, 100  # factorisations of the rest of the path


def borne(path: Path, base: Base) -> float:
    """Share of the load factor that the barrier bears at a point of a path; an estimate."""
    p, z = path.flow.problem, base.point
    still = np.zeros_like(z.x), np.zeros(p.C.shape[1]), 0.0, np.zeros_like(z.s)
    try:
        (change,) = Newton(path, z).solve(Equations(*still, -z.y))
    except (RuntimeError, ValueError):  # SuperLU: singular or not finite
        return 0.0
    share = 2.0 * change.load_factor / z.load_factor
    return float(share) if np.isfinite(share) else 0.0


def without_barrier(walk: Walk) -> Walk:
    """Return a walk that has closed, or the one on which its barrier faded first where that bears too much.

    Where this leads to no solution, the walk given, which then says how much its barrier bears.
    """
    if walk.end != CLOSED or walk.compliant is None:
        return walk
    path, base = walk.compliant
    walk.factorisations += 1
    share = borne(path, base)
    if abs(share) <= MOST:
        return walk
    percent = min(100.0 * abs(share), 100.0)
    walk.said = f", about {percent:.{int(percent < 10.0)}f} {BORNE}"
    try:
        rest = _rest(walk, path, base)
    except KeyboardInterrupt:
        walk.end = INTERRUPTED
        return walk
    if rest is not None and rest.end == CLOSED:
        return rest
    if rest is not None and rest.end == INTERRUPTED:
        walk.end = INTERRUPTED
    return walk


def _rest(walk: Walk, path: Path, base: Base) -> Walk | None:
    """The walk from a base on without the barrier; None where that does not fade."""
    z = moved(path, base.point, 1.0, base.correction)
    size, used = path.barrier.size, walk.factorisations
    fading = Barrier(size * z.theta / FADING, 0.0, 0.0)
    elastic = path.rho(z.theta) * path.elastic
    fade = Stretch(replace(path, barrier=fading, elastic=elastic), replace(z, theta=FADING), LEFT * FADING)
    ended, used = fade.go(), used + fade.factorisations
    walk.factorisations = used
    if ended != "arrived":
        return None
    left = fade.kept[-1]
    barrier = replace(path.barrier, size=size * left.theta / FADING)
    rest = Walk(replace(path, barrier=barrier), used + BUDGET, walk.progress)
    rest.begin, rest.tried, rest.patience = replace(left, theta=z.theta), np.inf, PATIENCE
    rest.factorisations, rest.failures = used, walk.failures
    rest.end = rest.go()
    rest.path = replace(rest.path, barrier=path.barrier)  # as which it is told
    rest.points, rest.said = walk.points + rest.points, f", {FADED}"
    walk.factorisations = rest.factorisations
    return rest

"""What of the load factor at the end of a path its barrier bears, and the rest of the path without that.

Where compliance and barrier fade alike, mu / rho stays. A joint that nothing presses bears sqrt(mu / (rho W))
all along, and where it slides its friction is part of the load factor. It grows with the root of the
barrier's size, so that twice its derivative by the logarithm of the size is this part.
Where it is too large the barrier fades first, at the compliance there is, and then what is left of both.
Without the barrier it is plain what yields: where that path stops, a round of the fixed point closes it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from limitblocks.analysis.nonassociated.closing import Closing
from limitblocks.analysis.nonassociated.increment import FADING, fading_from
from limitblocks.analysis.nonassociated.path import Walk
from limitblocks.analysis.nonassociated.path_equations import Base, Equations, Path, moved
from limitblocks.analysis.nonassociated.path_newton import Newton
from limitblocks.analysis.nonassociated.path_record import BORNE, CLOSED, FADED, INTERRUPTED
from limitblocks.analysis.nonassociated.stretch import Stretch
from limitblocks.evidence.residuals import TOLERANCE

MOST = 5e-3  # of the load factor that the barrier may bear
LEFT = 1e-4  # of the barrier after it has faded: a hundredth of what it bore
BUDGET = 60  # factorisations of the rest of the path: of 13 models 11 take 4 to 54, two wind beyond
LOST, CLOSED_BY = "lost", ", closed by rounds"


def borne(path: Path, base: Base) -> float:
    """Share of the load factor that the barrier bears at a point of a path; an estimate."""
    p, z = path.flow.problem, base.point
    still = np.zeros_like(z.x), np.zeros(p.C.shape[1]), 0.0, np.zeros_like(z.s)
    (change,) = Newton(path, z).solve(Equations(*still, -z.y))
    return float(np.divide(2.0 * change.load_factor, z.load_factor))


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
    walk.said = _told(share)
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


def _told(share: float) -> str:
    """What is said of a share of the load factor."""
    percent = min(100.0 * abs(share), 100.0)
    return f", about {percent:.{int(percent < 10.0)}f} {BORNE}"


def _rest(walk: Walk, path: Path, base: Base) -> Walk | None:
    """The walk from a base on without the barrier, or with what is left of it; None where that is all."""
    z = moved(path, base.point, 1.0, base.correction)
    size, used = path.barrier.size, walk.factorisations
    fading = fading_from(path, z, path.rho(z.theta) * path.elastic)
    fade = Stretch(fading, replace(z, theta=FADING), LEFT * FADING)
    fade.go()
    walk.factorisations = used = used + fade.factorisations
    if fade.base is None:
        return None
    left = fade.kept[-1]
    barrier = replace(path.barrier, size=size * left.theta / FADING)
    rest = Walk(replace(path, barrier=barrier), used + BUDGET, walk.progress)
    rest.begin = rest.z = replace(left, theta=z.theta)
    rest.tried = np.inf
    rest.factorisations, rest.failures = used, walk.failures
    rest.end = rest.go() if fade.arrived else LOST
    rest.said = f", {FADED}"
    if rest.end not in (CLOSED, INTERRUPTED):
        rest.settling.keep(Closing(path.flow, TOLERANCE)(rest.state), rest.state)
        rest.end = CLOSED if rest.settling.left <= TOLERANCE else rest.end
        rest.said += CLOSED_BY
    bears = borne(fade.path, fade.base)
    if abs(bears) > MOST:
        rest.said = _told(bears)
    rest.path = replace(rest.path, barrier=path.barrier)  # as which it is told
    rest.points = walk.points + rest.points
    walk.factorisations = rest.factorisations
    return rest

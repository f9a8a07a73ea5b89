"""One increment of the load path, followed by arclength in the displacement on which the live load works.

From the stresses x_k the increments du, dy of displacements and multipliers satisfy

    W (x - x_k) = C du + G(x)^T dy,   dead + a live = C^T x,   live . du = tau,
    F x + g = s,   s o dy = nu,   s, dy in int K

With u = du / tau and y = dy / tau these are the equations of a path with rho = 1 / tau and mu = nu / tau. So
theta is the first tau over tau, and where theta turns the structure snaps back: tau has to fall before it can
go on growing. Where it springs back beyond x_k, tau counts from before that, live . du = tau - behind.
At the last tau the barrier fades at a fixed rho; the increment ends on the yield surface.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from limitblocks.analysis.nonassociated.path import RETURNED
from limitblocks.analysis.nonassociated.path_equations import Barrier, Path, Point
from limitblocks.analysis.nonassociated.path_newton import REFINED
from limitblocks.analysis.nonassociated.path_start import INSIDE, centred
from limitblocks.analysis.nonassociated.stretch import Stretch, Visit
from limitblocks.arrays import Array

# last tau over the first one: the elastic part of an increment needs no points; where tau is large already
# Newton's method may find no first point so far from the elastic part
SPANS = (10.0, 1000.0)
NO_BARRIER = 1e-10  # mu at the end of an increment; below it the eliminated equations lose their digits
SHARP = 1e-8  # size of the barrier where an increment snaps: by about its root a fold comes early
FELL = 1e-3  # of the load factor at its start: an increment that loses more may have snapped unseen
# That loses so much and is lost without the barrier has begun beyond a snap: facades that soften lose .4 %.
OVER = 0.1
FARTHER = (1.0, 2.0, 4.0)  # times tau
FARTHEST = 1000.0  # theta where a path that counts tau from before its start has gone back beyond that
FADING = 0.5 * REFINED  # theta where the barrier begins to fade: directions are refined from there on


@dataclass(frozen=True, eq=False)
class Increment:
    """Points from the first tau to the last with the barrier, and the end with as little of it as is left.

    `fading` is the path on which theta is the barrier, at the last tau. A `rounded` one snaps, and could be
    followed with the large barrier only, or from beyond the snap.
    """

    visits: tuple[Visit, ...]
    end: Point
    rho: float
    fading: Path
    rounded: bool = False

    @property
    def left(self) -> float:
        """Size of the barrier at the end."""
        return self.fading.barrier.size * self.end.theta

    @property
    def folds(self) -> tuple[tuple[int, int], ...]:
        """Places of both ends of each snap among the visits."""
        return _folds(self.visits)


def _folds(at: Sequence[Visit]) -> tuple[tuple[int, int], ...]:
    """Places of the visit of largest tau at each fold, and of the first beyond it at that tau or more."""
    folds, k = [], 1
    while k < len(at):
        if not at[k].forward:
            fold = k - 1
            while fold + 1 < len(at) and at[fold + 1].rho < at[fold].rho:
                fold += 1
            if fold + 1 == len(at):  # det J changed its sign, but tau grew on: rounding
                break
            later = (j for j in range(fold + 1, len(at)) if at[j].forward and at[j].rho <= at[fold].rho)
            k = next(later, len(at) - 1)
            folds.append((fold, k))
        k += 1
    return tuple(folds)


@dataclass(frozen=True, eq=False)
class Tried:
    """What came of an increment: itself if it succeeded, else whether a snap goes back beyond its start."""

    increment: Increment | None
    factorisations: int
    returned: bool = False


@np.errstate(all="ignore")  # a point that ran away is not accepted
def increment(path: Path, weights: Array, rho: float, left: float = NO_BARRIER) -> Tried:
    """Push by 1 / rho from the stresses path.x0; where that snaps or may have, once more with less barrier.

    Parameters
    ----------
    path : Path
        Flow, barrier of power 1 and x0.
    weights : Array, shape (s,)
        Compliance W of the joints.
    rho : float
        One over the displacement on which the live load works, dimensionless.
    left : float
        Size of the barrier at the end.
    """
    met = _pushed(path, weights, rho, left, SPANS)
    if met.increment is None or not (met.increment.folds or _fell(path, met.increment.end)):
        return met
    sharp = replace(path, barrier=replace(path.barrier, size=min(SHARP, path.barrier.size)))
    used, stands = met.factorisations, met.increment
    for farther in FARTHER:  # the barrier makes a fold come early: without it the increment may end before
        again = _pushed(sharp, weights, rho / farther, left, SPANS[1:])
        used += again.factorisations
        if again.returned:
            return Tried(None, used, returned=True)
        if again.increment is None:
            over = bool(met.increment.folds) or _fell(path, met.increment.end, OVER)
            return Tried(replace(met.increment, rounded=over), used)
        beyond = _fell(path, again.increment.visits[0].point)  # a small step from x0: over a snap
        stands = replace(again.increment, rounded=beyond)
        if stands.folds or not met.increment.folds:
            break
    return Tried(stands, used)


def _fell(path: Path, reached: Point, share: float = FELL) -> bool:
    """Whether the load factor is lower at a point of an increment than at its start, by a share of it."""
    p = path.flow.problem
    start = (path.layout.balance @ path.x0 - p.dead) @ p.live / (p.live @ p.live)
    return bool(reached.load_factor < start - share * abs(start))


def _pushed(path: Path, weights: Array, rho: float, left: float, spans: tuple[float, ...]) -> Tried:
    """One increment with the barrier of the path."""
    for span in spans:
        farther = 1.0 + path.behind * span * rho  # the first tau over what of it lies beyond the start
        first = span * rho / farther
        barrier = replace(path.barrier, size=path.barrier.size / farther)
        curve = replace(path, barrier=barrier, elastic=first * weights, behind=path.behind * first)
        start, used = _started(curve)
        if start is not None:
            break
    if start is None:
        return Tried(None, used)
    walk = Stretch(curve, start, farther / (span * (1.0 + path.behind * rho)))
    walk.farthest = FARTHEST if path.behind else RETURNED
    walk.go()
    used += walk.factorisations
    if not walk.arrived:
        return Tried(None, used, walk.returned)
    visits = walk.visits(first)
    met = _without_barrier(curve, weights, _from_start(visits[-1], path.behind), left)
    whole = None if met.increment is None else replace(met.increment, visits=visits)
    return Tried(whole, used + met.factorisations)


def _started(curve: Path) -> tuple[Point | None, int]:
    """The first point of an increment, and factorisations; where many rows yield, by a barrier that fades.

    So, too, where Newton's method runs away: else a corner (friction .8, pushed diagonally) goes over snaps
    to a load factor of .71, where increments of other sizes end at .53. It costs 278 load paths a tenth of
    their time.
    """
    start, used = _centred(curve)
    if start is not None:
        return start, used
    # its slacks are as large as the first ones
    size = INSIDE**2 * float((curve.elastic * curve.measures.stress**2).mean()) / curve.measures.power
    fading = replace(curve, barrier=Barrier(size, 0.0, 0.0))
    start, more = _centred(fading)
    if start is None:
        return None, used + more
    walk = Stretch(fading, start, curve.barrier.size / size)
    walk.go()
    start = replace(walk.kept[-1], theta=1.0) if walk.arrived else None
    return start, used + more + walk.factorisations


def _centred(curve: Path) -> tuple[Point | None, int]:
    """The first point by Newton's method, None where it runs away, and factorisations."""
    try:
        return centred(curve)
    except (RuntimeError, ValueError):  # SuperLU: singular or not finite
        return None, 1


def _from_start(visit: Visit, behind: float) -> Visit:
    """A visit with tau counted from the start of the increment."""
    z, share = visit.point, 1.0 - behind * visit.rho
    own = replace(z, u=z.u / share, y=z.y / share, theta=z.theta / share)
    return visit._replace(point=own, rho=visit.rho / share)


def _without_barrier(path: Path, weights: Array, visit: Visit, left: float) -> Tried:
    """The increment that ends at a visit with as little of the barrier as is left."""
    fading = fading_from(path, visit.point, visit.rho * weights)
    return faded(Increment((visit,), replace(visit.point, theta=FADING), visit.rho, fading), left)


def fading_from(path: Path, z: Point, elastic: Array) -> Path:
    """The path on which theta is the barrier, from FADING on: that of a point, at a compliance that stays."""
    barrier = Barrier(path.barrier.size * z.theta / FADING, 0.0, 0.0)
    return replace(path, barrier=barrier, elastic=elastic, behind=0.0)


@np.errstate(all="ignore")
def faded(met: Increment, left: float = NO_BARRIER, used: int = 0) -> Tried:
    """The increment with no more of the barrier at its end; `used` factorisations are counted with it."""
    fade = Stretch(met.fading, met.end, left / met.fading.barrier.size)
    fade.go()
    used += fade.factorisations
    return Tried(replace(met, end=fade.kept[-1]) if fade.arrived else None, used)

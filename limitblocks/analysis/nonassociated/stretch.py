"""A walk along a path by arclength that keeps its points, and turns where theta does.

The displacement of an increment of the load path, or the barrier at its end, falls and grows along it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from limitblocks.analysis.nonassociated.path import Lost, Walk
from limitblocks.analysis.nonassociated.path_equations import Base, Path, Point, inner, moved

ARRIVED = 1.01  # times the last theta
TURN = 1e-5  # of tau: how near a fold is approached, and the state after the snap
BUDGET = 200  # factorisations; increments that succeed take 20 to 80
FIRST = 0.3  # length of the first predictor: with .6 the peak before a snap is met less closely


class Visit(NamedTuple):
    """A point of an increment: 1 / tau, arclength from its first point, and whether tau grows there."""

    point: Point
    rho: float
    arclength: float
    forward: bool


class Stretch(Walk):
    """A walk from a point to a given theta, which keeps the points."""

    first = FIRST

    def __init__(self, path: Path, start: Point, until: float, budget: int = BUDGET) -> None:
        super().__init__(path, budget, None)
        self.z, self.until = start, until
        self.kept: list[Point] = []
        self.fold = np.inf  # theta of a fold that tau has not come back to

    @property
    def arrived(self) -> bool:
        """Whether the last point kept is at the end."""
        return bool(self.kept) and self.kept[-1].theta <= ARRIVED * self.until and self._forward(-1)

    @property
    def returned(self) -> bool:
        """Whether the path went back to where tau is zero."""
        return bool(self.kept) and self.kept[-1].theta > self.farthest

    def _forward(self, k: int) -> bool:
        return self.points[k].sign == self.points[0].sign

    @property
    def _lax(self) -> bool:
        return self.z.theta > ARRIVED * self.until

    @property
    def _stop(self) -> float:
        """The theta that a step stops at: that of a fold once tau grows again, else the last."""
        return self.fold if np.isfinite(self.fold) and self._forward(-1) else self.until

    def go(self) -> str:
        """Follow the path as far as it is asked for."""
        try:
            while not self.arrived and self.factorisations < self.budget:
                self._advance()
        except (Lost, RuntimeError, ValueError):  # SuperLU: singular or not finite
            pass
        return "arrived" if self.arrived else "lost"

    def _accept(self, sign: float, base: Base) -> None:
        forward = not self.points or sign == self.points[0].sign
        if self.base is not None and self._forward(-1) and not forward:
            ahead = self.length * abs(self.base.tangent.theta) / self.base.point.theta
            if ahead > TURN:
                self._retreat()
                return
            self.fold = min(self.fold, self.base.point.theta, self.z.theta)
        elif self.kept and forward and self.z.theta <= self.fold:
            if self.z.theta < (1.0 - TURN) * self.fold < np.inf:  # corrected to beyond it
                self._retreat()
                return
            self.fold = np.inf
        self.kept.append(self.z)
        super()._accept(sign, base)

    def _predict(self) -> None:
        super()._predict()
        if self.base is None or self.z.theta >= self._stop:
            return
        z, correction, tangent, _ = self.base
        start = moved(self.path, z, 1.0, correction)
        if start.theta < self._stop < z.theta:  # the end is on the way to the corrected point
            self.z = moved(self.path, z, (self._stop - z.theta) / correction.theta, correction)
        else:
            self.z = moved(self.path, start, (self._stop - start.theta) / tangent.theta, tangent)

    def visits(self, rho: float) -> tuple[Visit, ...]:
        """The points kept; rho is that at theta = 1."""
        lengths = [0.0]
        for a, b in zip(self.kept, self.kept[1:], strict=False):
            d = b.moved(-1.0, a)
            lengths.append(lengths[-1] + float(np.sqrt(inner(self.path.cones, a, d, d))))
        return tuple(
            Visit(z, rho * z.theta, length, self._forward(k))
            for k, (z, length) in enumerate(zip(self.kept, lengths, strict=True))
        )

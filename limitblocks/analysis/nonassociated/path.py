"""The non-associated answer as the end of one path, followed through its folds by arclength.

The central path of the non-associated problem folds: the barrier has to grow again before it can go on
falling, so that steps which lower it fail. Arclength follows the curve instead (Allgower & Georg 1990,
Numerical Continuation Methods, Chapters 2 and 6), by a predictor along the tangent and Newton's method in the
plane normal to it. The way along the tangent comes from the sign of det J, which changes where theta turns
back; the angle to the last tangent goes wrong at long steps. A factorisation serves corrector and tangent.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from limitblocks.analysis.nonassociated.path_equations import (
    Base,
    Equations,
    Path,
    Point,
    covector,
    distance,
    moved,
    moved_on,
    residuals,
    theta_slope,
)
from limitblocks.analysis.nonassociated.path_newton import Newton
from limitblocks.analysis.nonassociated.path_record import (
    CLOSED,
    INTERRUPTED,
    UNSETTLED,
    Progress,
    Tracked,
    winds,
)
from limitblocks.analysis.nonassociated.path_start import centred
from limitblocks.analysis.nonassociated.settling import EXACT, FURTHER, Settling
from limitblocks.analysis.pivot import pivoted
from limitblocks.analysis.polish import defect, polished
from limitblocks.evidence.residuals import TOLERANCE
from limitblocks.problem import State

START = 0.2  # theta of the first point: above it little yields, and at 0.1 one tower finds no first point
FIRST, LEAST, LONGEST = 0.6, 1e-6, 1e3  # lengths of predictors: mean relative change of s and y
CUT = 0.35  # of the length after a failure
SHORT = 0.005  # length of a step that goes across no fold
PACE = (2.0, 2.0, 1.4, 1.0, 0.7)  # of the length after 0, 1, 2, ... correctors
CORRECTORS = 6
RETURNED = 1.2  # theta: the path went back beyond its start
TRIED, AGAIN, LAST = 1e-2, 0.2, 1e-11  # theta where the polish is tried first, how often, and last
DEGENERATE, NEAR = 3e-3, 1e-6  # residuals from which on complementary pivots and rounds are tried
PIVOTS = 200  # pairs of slack and multiplier that are not plain: more cost more than further steps
COMPLIANT = 1e-4  # rho down to which the last base is kept that the barrier may fade from
BUDGET = 600  # factorisations


class Lost(Exception):
    """The path cannot be followed any further."""


class Walk:
    """A path on the way: the point, the base of its predictor, the length, and what is worth telling."""

    patience: int | None = None
    farthest = RETURNED
    first = FIRST
    closing: Callable[[State], State] | None = None
    begin: Point | None = None  # a first point that is known
    left: tuple[Equations, float] | None = None  # what a correction left, and how far off that is
    compliant: tuple[Path, Base] | None = None  # the last base on the way down with rho of COMPLIANT or more
    end = ""  # what the end was
    said = ""  # what else to say of the way here

    def __init__(self, path: Path, budget: int, progress: Callable[[Progress], None] | None) -> None:
        self.path, self.budget, self.progress = path, budget, progress
        self.z = Point(path.x0, np.zeros(path.flow.problem.C.shape[1]), 0.0, path.weights, path.weights, 1.0)
        self.base: Base | None = None
        self.length, self.correctors, self.tried = self.first, 0, TRIED
        self.factorisations = self.failures = 0
        self.points: list[Progress] = []
        self.settling = Settling(path.flow)

    @property
    def state(self) -> State:
        """The last accepted point as a state."""
        return (self.base.point if self.base else self.z).state

    def told(self, seed: int) -> tuple[State, Tracked]:
        """Return the solution, or the best state met, and how the path of this seed went."""
        end, flow, found = self.end, self.path.flow, self.settling
        if end not in (CLOSED, INTERRUPTED) and found.unsettled:
            end = UNSETTLED
        best, left = found.best, found.left
        if best is None or (end == INTERRUPTED and defect(flow, self.state) < left):  # nothing starts from it
            best, left = self.state, defect(flow, self.state)
        counts = self.factorisations, self.failures, tuple(self.points)
        return best, Tracked(self.path.barrier, seed, end, left, *counts, self.said)

    def go(self) -> str:
        """Follow the path to its end, and say what it was."""
        try:
            if self.begin is None:
                self.begin, self.factorisations = centred(self.path, START)
            if self.begin is None:
                return "not centred"
            self.z = self.begin
            while not self._closed():
                if self.factorisations >= self.budget:
                    return "budget"
                if winds(self.points, self.factorisations, self.patience):
                    return "winds"
                self._advance()
        except Lost as lost:
            return str(lost)
        except (RuntimeError, ValueError):  # SuperLU: singular or not finite
            return "singular start"
        except KeyboardInterrupt:
            return INTERRUPTED
        return CLOSED

    def _advance(self) -> None:
        """Correct the point, or accept it and predict the next one."""
        left, off = self.left or self._measured()
        if np.isnan(off) or (off > 1.0 and self.correctors == CORRECTORS):
            self._retreat()
            return
        self.factorisations += 1
        try:
            newton = Newton(self.path, self.z)
            step, turn = newton.solve(left, theta_slope(self.path, self.z))
        except (RuntimeError, ValueError):
            self._retreat()
            return
        turn = replace(turn, theta=1.0)
        onto = covector(self.path.cones, self.z, turn)
        square = onto.of(turn)
        if not (np.isfinite(square) and square > 0.0):
            self._retreat()
            return
        correction = step.moved(-onto.of(step) / square, turn)
        if off > 1.0:
            self.correctors += 1
            self.z = moved(self.path, self.z, 1.0, correction)
            self.left = self._measured()
            if not self.left[1] <= 1.0:
                return
            # near enough: the factors of its last correction give the direction
            correction, onto = step.scaled(0.0), covector(self.path.cones, self.z, turn)
        sign = newton.sign
        unit = self._heading(sign, turn) / float(np.sqrt(onto.of(turn)))
        base = Base(self.z, correction, turn.scaled(unit), onto.scaled(unit))
        if not sign or self._returns(base):
            self._retreat()
        else:
            self._accept(sign, base)

    def _measured(self) -> tuple[Equations, float]:
        """What is left of the equations at the point, and how far off the path it is."""
        left = residuals(self.path, self.z)
        return left, distance(self.path, self.z, left, self._lax)

    @property
    def _lax(self) -> bool:
        """Whether a point on the way may be farther off than the end."""
        return False

    def _heading(self, sign: float, turn: Point) -> float:
        """Whether theta grows (1) or falls (-1) along the path: it falls first, and turns with det J."""
        return -sign * (self.points[0].sign if self.points else sign)

    def _returns(self, base: Base) -> bool:
        """Whether the corrector fell back behind the last base: the step went across a fold."""
        if self.base is None or self.length < SHORT:
            return False
        step = base.point.moved(-1.0, self.base.point)
        return min(base.ahead.of(step), self.base.ahead.of(step)) < 0.0

    def _accept(self, sign: float, base: Base) -> None:
        """Go on from a point near the path."""
        z = self.z
        least = min(z.theta, self.points[-1].least) if self.points else z.theta
        self.points.append(Progress(z.theta, z.load_factor, sign, self.factorisations, least))
        if self.progress is not None:
            self.progress(self.points[-1])
        if z.theta > self.farthest:
            raise Lost("returned")
        if self.base is not None:
            self.length = min(PACE[min(self.correctors, len(PACE) - 1)] * self.length, LONGEST)
        if sign == self.points[0].sign and self.path.rho(z.theta) >= COMPLIANT:
            self.compliant = self.path, base
        self.path = moved_on(self.path, z)
        self.base = base
        self._predict()

    def _retreat(self) -> None:
        """Predict again from the last base, not as far."""
        self.failures += 1
        self.length *= CUT
        if self.base is None or self.length < LEAST:
            raise Lost("no step succeeds")
        self._predict()

    def _predict(self) -> None:
        assert self.base is not None
        self.left = None
        z, correction, tangent, _ = self.base
        z = moved(self.path, z, 1.0, correction)
        self.z = moved(self.path, z, self.length, tangent)
        self.correctors = 0

    def _closed(self) -> bool:
        """Whether the polish of a base far down the path is a solution; tried as theta falls."""
        if self.base is None or self.base.point.theta >= self.tried:
            return self._stands_still()
        z = self.base.point
        if z.theta < LAST:
            raise Lost("no solution at the end")
        flow, reached, found = self.path.flow, self.state, self.settling
        left = defect(flow, reached)
        # where it may solve all as it is; half as far on where it does, and yet is exact for no model nearby
        self.tried = max(AGAIN, TOLERANCE / max(left, 2.0 * TOLERANCE)) * z.theta
        state, residual = polished(flow, reached, left, patience=1)  # a point costs less than more steps
        found.keep(state, reached, residual)
        if found.left > EXACT and left < DEGENERATE:
            found.keep(pivoted(flow, reached, largest=PIVOTS), reached)
        if self.closing and found.left > TOLERANCE and left < NEAR:
            found.keep(self.closing(reached), reached)
        return found.ends() or self._stands_still()

    def _stands_still(self) -> bool:
        """Whether a path within the tolerance has led to no other load factor."""
        if self.settling.left > TOLERANCE:
            return False
        still = self.settling.stands_still(self.state, self.factorisations)
        self.budget, self.patience = self.settling.within + FURTHER, None
        return still

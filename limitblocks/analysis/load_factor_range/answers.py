"""Certified states on the way, and the answers they become."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from scipy import sparse

from limitblocks.analysis.load_factor_range.faces import extremes, ray
from limitblocks.analysis.nonassociated.finished import finished
from limitblocks.analysis.nonassociated.start import Bracket
from limitblocks.analysis.polish import defect
from limitblocks.arrays import Array
from limitblocks.evidence.check import check_mcp
from limitblocks.evidence.range_answer import Origin, RangeAnswer
from limitblocks.evidence.relative_rates import MOVING, speeds
from limitblocks.evidence.residuals import TOLERANCE
from limitblocks.evidence.results import Nonassociated
from limitblocks.model import Model
from limitblocks.problem import Flow, LimitProblem, State
from limitblocks.problem.places import places

DISTINCT = 1e-4  # of the scale of load factors: nearer ones are one answer
SLIPPING = 1e-3  # of the multipliers of a point: less strain is no slip
NOISE = 1e-9  # of the multipliers: mechanisms that hardly slip have no thrust to compare


class Certified(NamedTuple):
    """A state within the tolerance, how it was found, and whether a load path reached it."""

    state: State
    how: str
    origin: Origin


@dataclass(eq=False)
class Collected:
    """Certified states of one flow rule, the intervals that they prove, and the ray without limit.

    `limits` enclose the dimensionless load factors looked at, measured by `scale`; `endless` tells
    whether the associated load is unlimited.
    """

    flow: Flow
    limits: tuple[float, float]
    scale: float
    endless: bool
    found: list[Certified] = field(default_factory=list)
    least: Certified | None = None
    least_within: Certified | None = None  # the limits: a mechanism drawn at random may lie below them
    greatest: Certified | None = None
    intervals: list[tuple[float, float]] = field(default_factory=list)
    beyond: Certified | None = None

    def add(self, state: State | None, how: str, origin: Origin, keep: bool) -> bool:
        """Take a state in if it is a solution; return whether it is. `keep` it if it is distinct."""
        if state is None or not defect(self.flow, state) <= TOLERANCE:
            return False
        new = Certified(state, how, origin)
        near = DISTINCT * self.scale
        same = [
            one
            for one in self.found
            if one.origin is origin and abs(one.state.load_factor - state.load_factor) <= near
        ]
        if keep and not same:
            self.found.append(new)
        self._stretch(new)
        if self.flow.constant:
            self._along_its_face(new)
        return True

    def _along_its_face(self, new: Certified) -> None:
        """The solutions of the same mechanism: their ends, all between them, and a ray."""
        ends = extremes(self.flow, new.state, self.limits)
        kept = [end for end in ends if end is not None]
        for end in kept:
            self._stretch(
                Certified(end, f"end of the solutions of one mechanism; {new.how}", Origin.SEARCHED)
            )
        shared = [z for z in (*kept, new.state) if np.array_equal(z.y, new.state.y)]
        factors = [z.load_factor for z in shared]
        near = TOLERANCE * self.scale
        self.intervals = merged([*self.intervals, (min(factors), max(factors))], near)
        if self.endless and self.beyond is None:
            added = ray(self.flow, new.state)
            if added is not None:
                z, t = new.state, self.limits[1]
                far = State(z.load_factor + t, z.x + t * added, z.u, z.y)
                if defect(self.flow, far) <= TOLERANCE:
                    self.beyond = Certified(
                        far, f"any greater load factor solves too; {new.how}", Origin.SEARCHED
                    )
                    self.intervals = merged([*self.intervals, (z.load_factor, np.inf)], near)

    def _stretch(self, new: Certified) -> None:
        value = new.state.load_factor
        if self.least is None or value < self.least.state.load_factor:
            self.least = new
        if self.greatest is None or value > self.greatest.state.load_factor:
            self.greatest = new
        if value < self.limits[0] - TOLERANCE * self.scale:
            return
        if self.least_within is None or value < self.least_within.state.load_factor:
            self.least_within = new

    def all(self, known: float = np.nan) -> list[Certified]:
        """Distinct states, by load factor; an end where it is farther than any, and than the one `known`."""
        near, kept = TOLERANCE * self.scale, list(self.found)
        for end in (self.least, self.beyond or self.greatest):
            factors = [known, *(one.state.load_factor for one in kept)]
            if end and not any(abs(factor - end.state.load_factor) <= near for factor in factors):
                kept.append(end)
        return sorted(kept, key=lambda one: one.state.load_factor)


def merged(intervals: list[tuple[float, float]], near: float) -> list[tuple[float, float]]:
    """Return the union of intervals as intervals farther apart than `near`, in order."""
    union: list[tuple[float, float]] = []
    for low, high in sorted(intervals):
        if union and low <= union[-1][1] + near:
            union[-1] = union[-1][0], max(union[-1][1], high)
        else:
            union.append((low, high))
    return union


def answer(model: Model, flow: Flow, enclosing: Bracket, permanent: Array, one: Certified) -> RangeAnswer:
    """Return a certified state as an answer with its evidence."""
    result = finished(model, one.state, enclosing, (), flow, one.how, TOLERANCE, False, False)
    return of_result(model, flow, permanent, result, one.origin)


def of_result(
    model: Model, flow: Flow, permanent: Array, result: Nonassociated, origin: Origin
) -> RangeAnswer:
    """Return a solution as an answer; `permanent` are the dimensionless stresses of the permanent loads."""
    free, speed = model.free_blocks, speeds(model, result.displacement_rates)[model.free]
    moves = speed > MOVING * speed.max()
    moving = tuple(block.name for block, fast in zip(free, moves.tolist(), strict=True) if fast)
    weights = {b.name: b.volume * (b.unit_weight or 0.0) for b in free}
    weights = weights if any(weights.values()) else {b.name: b.volume for b in free}
    p = flow.problem
    G = flow.matrix(permanent)
    slips = sparse.csr_array(p.F - G)  # what slipping takes up per multiplier, (F - G) x
    y = _slipping(p, slips, G, result.flow_multipliers / p.multiplier_units)
    before, now = (float(y @ (slips @ x)) for x in (permanent, result.generalised_stresses / p.stress_units))
    return RangeAnswer(
        solution=result,
        check=check_mcp(model, result),
        origin=origin,
        moving=moving,
        share=sum(weights[name] for name in moving) / sum(weights.values()),
        thrust=max(0.0, now) / before if before > NOISE * abs(y).sum() else 1.0,
    )


def _slipping(p: LimitProblem, slips: sparse.csr_array, G: sparse.csr_array, y: Array) -> Array:
    """Multipliers of what slips: none at open points, where those of friction may be any that cancel."""
    members, stresses = places(p)
    rubs = np.bincount(p.cones.member, np.diff(slips.indptr), p.cones.degree) > 0.0
    own = np.where(rubs[p.cones.member], y, 0.0)
    strains, largest = (np.zeros(max(members.max(), stresses.max()) + 1) for _ in range(2))
    np.maximum.at(strains, stresses, np.abs(G.T @ own))
    np.maximum.at(largest, members, p.cones.norm(own))
    return np.where((strains > SLIPPING * largest)[members][p.cones.member], own, 0.0)


def remarks(flow: Flow, first: RangeAnswer | None, answers: list[RangeAnswer]) -> tuple[str, ...]:
    """Return what a reader of the range should know."""
    said = []
    if first is None:
        said.append("nonassociated found no answer")
    elif first.origin is not Origin.LOAD_PATH:
        said.append(f"the answer of nonassociated is not that of the load path ({first.solution.how})")
    if not flow.constant:
        said.append("with turning about the centre of pressure the set has no convex pieces: paths alone")
    ends = [answers[0], answers[-1]] if answers else []
    said += [f"the load factor {one.load_factor:.6g} is of {one.mechanism}" for one in ends if one.local]
    shown = [first, *ends] if first else ends
    return tuple(dict.fromkeys([*said, *(one for found in shown for one in found.check.remarks)]))

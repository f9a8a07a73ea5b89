"""Paths in the plane of a planar problem, or in one half: followed there, lifted, judged in the whole.

Symmetric stresses and rates of the plane solve the equations of a path in the whole problem, too, if its
compliance is symmetric: docs/planar.md has the proof.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from limitblocks.analysis.in_plane import in_plane
from limitblocks.analysis.interior import carried
from limitblocks.analysis.nonassociated.loading import ADMISSIBLE, Pushed
from limitblocks.analysis.nonassociated.path_equations import Point
from limitblocks.analysis.nonassociated.path_record import IN_HALF, INTERRUPTED
from limitblocks.analysis.nonassociated.permanent import arose, permanent_state
from limitblocks.analysis.nonassociated.start import Start, start_stresses
from limitblocks.analysis.nonassociated.ways import Half, no_half
from limitblocks.analysis.stability import dead_load_state
from limitblocks.arrays import Array
from limitblocks.evidence.residuals import mcp_residuals
from limitblocks.known import known
from limitblocks.model import Model
from limitblocks.problem import Flow, LimitProblem, State
from limitblocks.problem.plane import Choice, Planar

PRESTRESSED = (
    "no stresses were found that arise under the dead loads without dilatancy: the path starts from others "
    "that carry them, of least elastic energy where these are found, for which something may have to press "
    "the blocks together; stability says whether they stand without"
)


@dataclass(frozen=True, eq=False)
class InPlane:
    """The flow rule `whole` in its plane or one half, the stresses a path starts from, their compliance."""

    whole: Flow
    plane: Planar
    flow: Flow
    x0: Array
    weights: Array

    def accepted(self, state: State, tolerance: float) -> State | None:
        """Return a state of the plane as one of the whole problem; None where that is no solution."""
        lifted = self.plane.lifted(state)
        with np.errstate(all="ignore"):  # a state that ran away is none
            return lifted if mcp_residuals(self.whole, lifted).worst.value <= tolerance else None

    def pushed(self, one: Pushed) -> Pushed:
        """Return an increment of the plane as one of the whole problem."""
        live, start, met = self.plane.live, self.plane.stresses @ one.start, one.increment
        visits = tuple(
            visit._replace(point=self._point(visit.point), rho=live * visit.rho) for visit in met.visits
        )
        increment = replace(met, visits=visits, end=self._point(met.end), rho=live * met.rho)
        state = self.plane.lifted(one.state)
        return replace(
            one, start=start, increment=increment, state=state, residuals=mcp_residuals(self.whole, state)
        )

    @property
    def share(self) -> Array:
        """Of the barrier of the whole problem in each row of the plane."""
        return self.plane.barrier_of(self.whole.problem.cones)

    def _point(self, z: Point) -> Point:
        up, p = self.plane.lifted(State(z.load_factor, z.x, z.u, z.y)), self.whole.problem
        return Point(up.x, up.u, up.load_factor, p.F @ up.x + p.g, up.y, z.theta)


def flow_in_plane(
    model: Model,
    flow: Flow,
    weights: Array,
    start: Start | None,
    choice: Choice = Choice.FLOWING,
    *,
    half: bool = False,
) -> InPlane | None:
    """Return the flow rule in the plane parallel to which everything acts, or in one half; None without one.

    Nor is there one where the compliance `weights` (s,) or the stresses to start from are not symmetric. With
    every row the path of a barrier without seed is that of the whole problem.
    """
    found = in_plane(model.problem)  # known from the bounds
    if found is None or found.flat is half:
        return None
    plane = _in_units_of(model, flow.problem, choice)
    own = plane.compliance_of(weights)
    x0 = None if own is None else _start(model, flow, plane, own, weights, start)
    if own is None or x0 is None:
        return None
    return InPlane(flow, plane, replace(flow, problem=plane.problem), x0, own)


def by_self_stress(model: Model, flow: Flow, weights: Array) -> tuple[str, ...]:
    """What is said where paths start from stresses that do not arise under the dead loads."""
    planar = flow_in_plane(model, flow, weights, None)
    at, own = (flow, weights) if planar is None else (planar.flow, planar.weights)
    return () if arose(at, own) else (PRESTRESSED,)


def plane_of(model: Model, problem: LimitProblem, x: Array) -> Planar | None:
    """Return the plane or one half of a model in the units of `problem`, if stresses x are symmetric."""
    found = in_plane(model.problem)
    symmetric = found is not None and found.symmetric(x * problem.stress_units / model.problem.stress_units)
    return _in_units_of(model, problem, Choice.FLOWING) if symmetric else None


def _in_units_of(model: Model, problem: LimitProblem, choice: Choice) -> Planar:
    found = in_plane(model.problem, choice)
    assert found is not None  # which depends on no choice
    return known(problem, ("plane in these units", choice), lambda: found.measured(problem))


def found_in_plane_or_whole(
    model: Model,
    flow: Flow,
    start: Start | None,
    tolerance: float,
    solve: Callable[[Flow, Array, Half], tuple[State, str]],
) -> tuple[State, str]:
    """Return what `solve` finds in the plane, if the whole problem accepts it; else what it finds there.

    In the whole problem `solve` may ask for what it finds in one half.
    """
    weights = flow.problem.compliance
    planar = flow_in_plane(model, flow, weights, start)
    if planar is not None:
        state, how = solve(planar.flow, planar.x0, no_half)
        lifted = planar.accepted(state, tolerance)
        if lifted is not None or how.endswith(INTERRUPTED):
            return lifted or planar.plane.lifted(state), way_in_plane(how)

    def half() -> tuple[State, str] | None:
        """Its state, lifted; the flow that turns about the centre of pressure is not that of the half."""
        one = flow_in_plane(model, flow, weights, start, half=True) if flow.constant else None
        if one is None:
            return None
        state, how = solve(one.flow, one.x0, no_half)
        return one.plane.lifted(state), way_in_plane(how, IN_HALF)

    return solve(flow, start_stresses(model, flow, weights, start), half)


def _start(
    model: Model, flow: Flow, plane: Planar, own: Array, weights: Array, start: Start | None
) -> Array | None:
    """Stresses of the plane to start from: given, or those of the dead loads, which stand."""
    if start is not None:
        x = start_stresses(model, flow, weights, start)
        return plane.stresses_of(x) if plane.symmetric(x) else None
    if carried(model.problem) is None:
        dead_load_state(model.problem)
    usual = _in_units_of(model, flow.problem, Choice.FLOWING)  # one for all choices of rows
    return permanent_state(replace(flow, problem=usual.problem), own)


def way_in_plane(how: str, where: str = "in the plane") -> str:
    """Return the words of a way that was gone in the plane, or in one half."""
    end = f", {INTERRUPTED}"
    return f"{how.removesuffix(end)}, {where}{end * how.endswith(end)}"


def admissible(pushes: tuple[Pushed, ...]) -> bool:
    """Whether all increments end in equilibrium within yield."""
    return all(max(one.residuals["equilibrium"], one.residuals["yield"]) <= ADMISSIBLE for one in pushes)

"""Limit analysis with the flow frozen at a state: solutions of Eqs (54)-(59) are its fixed points.

At stresses x_k, replace the yield rows F x + g in K by rows along the flow of x_k that agree with them there:

    G(x_k) x + h in K,   h = g + (F - G(x_k)) x_k.

Coulomb's cone ||V|| <= mu |N| becomes ||V|| <= mu |N_k|, a friction limit that does not depend on N, so that
sliding without dilatancy is normal to it: an associated problem, whose static and kinematic bounds are convex
programs. Gilbert, Casapulla & Ahmed (2006), Computers & Structures 84, 873-887, freeze friction so; here the
flow of every row is frozen, which covers slip, twist, shear with torsion and Table 5 alike.

Theorem. Let (a, x) be in equilibrium within yield, Eqs (56)-(57). It solves Eqs (54)-(59), with some u and y,
exactly where a is the limit load of the problem frozen at x, and attained by a mechanism.
Proof. At x both yield sets have the same rows, G(x) x + h = F x + g, so that (a, x) is a static state of the
frozen problem. For each of its mechanisms, C u = -G(x)^T y, y in K*, live . u = 1, virtual work gives

    h . y - dead . u  =  a + y . (F x + g)  >=  a.

So the kinematic bound is a exactly where a mechanism has y . (F x + g) = 0, which for two members of K is
Eq. (59) row by row; the rest is Eqs (54), (55) and (58).

Stresses, mechanism and multipliers need not be unique, and a round that starts at a solution may return
others. What it cannot change is the load factor: both its bounds are a.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from limitblocks.analysis.bounds import Pair, pairs_of_bounds
from limitblocks.analysis.direct import Programs
from limitblocks.analysis.forms import Stresses
from limitblocks.analysis.limit_state import limit_state
from limitblocks.analysis.scales import scaled
from limitblocks.arrays import Array, read_only
from limitblocks.errors import SolverFailure, UnlimitedLoad
from limitblocks.evidence.measure import Measure
from limitblocks.evidence.residuals import OF_BOUNDS
from limitblocks.problem import Flow, LimitProblem, State
from limitblocks.problem.plane import Planar


def frozen(flow: Flow, x: Array) -> LimitProblem:
    """Return the limit problem of the frozen rows: normal to the flow at x, and true at x.

    What rounding leaves outside K is put back: a friction limit below zero is one that nothing meets.
    """
    p, G = flow.problem, flow.matrix(x)
    return replace(p, F=G, G=G, g=read_only(p.cones.nearest(p.F @ x + p.g) - G @ x))


def fixed_point_change(flow: Flow, state: State, plane: Planar | None = None) -> float:
    """Return by how much a round of the fixed point changes the load factor of a state.

    The round solves the static and the kinematic program of the problem frozen at the state's stresses; the
    change is that of the farther one, over the load factor as bounds measure their gap. Infinite where no
    solver finds a pair of bounds within 1e-6.

    Symmetric stresses leave the frozen rows symmetric, so that the `plane` of the problem serves them, too;
    its pair is judged in the whole frozen problem, and where it is none, or stresses are not symmetric, the
    programs of the whole one are solved.
    """
    problem = flow.problem
    try:
        pair = _round(flow, state.x, plane)
    except (SolverFailure, UnlimitedLoad):
        return np.inf
    values = np.array([pair.state.load_factor, pair.upper]) / pair.problem.units.live
    change = np.abs(values * problem.units.live - state.load_factor).max()
    return float(change / Measure(problem, state).load_factor)


@np.errstate(all="ignore")  # a state that ran away is no pair
def _round(flow: Flow, x: Array, plane: Planar | None) -> Pair:
    """Bounds of the problem frozen at x, by one accurate solve or by one solver after the other."""
    whole = frozen(flow, x)
    at = whole if plane is None else frozen(replace(flow, problem=plane.problem), plane.stresses_of(x))
    planar = plane is not None and plane.flat
    found = limit_state(Programs(Stresses(scaled(at), planar)), plane)
    if found is not None and (pair := Pair(whole, *found)).residuals.worst.value <= OF_BOUNDS:
        return pair
    return next(pairs_of_bounds(whole, x, OF_BOUNDS))


def unconfirmed(change: float | None) -> tuple[str, ...]:
    """What a reader should know where a round changes the load factor beyond the accuracy of bounds."""
    if change is None or change <= OF_BOUNDS:
        return ()
    if np.isinf(change):
        return ("no solver confirms the state as a fixed point of frozen flow",)
    return (f"with the flow frozen at this state the load factor changes by {change:.1e} of it",)

"""Proof that Eqs (54)-(59) have no solution, for structures whose stresses follow from statics alone.

With C square and regular x = x0 + a x1 are the only stresses that balance dead + a live. Where the dead
loads leave a margin to yield, so do all load factors between the two at which yield is first met, since K is
convex: nothing flows there. At these two, only what yields can flow, and by virtual work a solution has

    1 = live . u = x1 . C u = -x1 . G(x)^T y,

which no y in K* satisfies if x1 does no work on the flow of any yielding row. Nor is it a solution if all
that yields at an interface gives power as it flows.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy import sparse
from scipy.sparse import linalg

from limitblocks.arrays import Array
from limitblocks.problem import Flow, State

INSIDE = 1e-6  # margin of the dead loads, in units of the forces on an interface
AT_YIELD = 1e-9  # margin of what may flow
NO_WORK = 1e-9  # of the sizes of its terms: less work is none
BALANCED = 1e-9  # force left over by stresses that balance


def state_without_solution(flow: Flow) -> State | None:
    """Return the state at the largest load factor within yield if it is proven that there is no solution."""
    p = flow.problem
    if p.C.shape[0] != p.C.shape[1]:
        return None
    try:
        lu = linalg.splu(sparse.csc_array(p.C.T))
    except RuntimeError:  # singular
        return None
    x0, x1 = lu.solve(p.dead), lu.solve(p.live)
    left = max(np.abs(p.C.T @ x0 - p.dead).max(), np.abs(p.C.T @ x1 - p.live).max())
    s0, s1 = p.F @ x0 + p.g, p.F @ x1
    if not left <= BALANCED or not p.cones.margin(s0).min() > INSIDE:
        return None
    most, least = p.cones.longest(s0, s1), -p.cones.longest(s0, -s1)
    if any(_works(flow, x0 + a * x1, x1) for a in (most, least) if np.isfinite(a)):
        return None
    a = most if np.isfinite(most) else 0.0
    return State(a, x0 + a * x1, np.zeros(p.C.shape[1]), np.zeros(len(p.g)))


def yielding(flow: Flow, x: Array) -> npt.NDArray[np.bool_]:
    """Return which linear rows and cones are at yield, shape (degree,)."""
    p = flow.problem
    return np.asarray(p.cones.margin(p.F @ x + p.g) <= AT_YIELD)


def _works(flow: Flow, x: Array, x1: Array) -> bool:
    """Whether the stresses x1 may do work on what can flow at x."""
    p, cones = flow.problem, flow.problem.cones
    G, s = flow.matrix(x), p.F @ x + p.g
    head = cones.identity > 0.0
    length = cones.norm(np.where(head, 0.0, s))[cones.member]
    y = np.where(head, 1.0, -s / np.where(length > 0.0, length, 1.0))  # s . y = 0 on the boundary of a cone

    def share(stresses: Array) -> Array:
        """Work of stresses on the flow of each linear row and cone, over the sizes of its terms."""
        work = np.bincount(cones.member, weights=-(G @ stresses) * y)
        size = np.bincount(cones.member, weights=(abs(G) @ np.abs(stresses)) * np.abs(y))
        return np.asarray(work / np.where(size > 0.0, size, 1.0))

    flows, at_tip = yielding(flow, x), length[cones.heads] <= AT_YIELD
    at_tip[: cones.linear] = False  # at the tip of a cone any y of K may flow
    taken = np.full(len(p.ends), -np.inf)  # an interface all of whose flows give power does not flow
    np.maximum.at(taken, p.member_interface[flows], np.where(at_tip, 0.0, share(x))[flows])
    flows &= taken[p.member_interface] >= -NO_WORK
    return bool((flows & (at_tip | (share(x1) > NO_WORK))).any())

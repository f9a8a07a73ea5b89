"""How far the mechanisms of one stress state reach: it may have many. numpy and scipy only."""

from __future__ import annotations

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array
from limitblocks.evidence.mechanism import PRECISE, flow_columns, linear_program
from limitblocks.problem import Flow, State

YIELDS = 1e-6  # of the force of an interface: rows closer than this to yield may flow
LEFT = 1e-10  # of the largest strain rate: what a linear program leaves of the flow rule


def reach_of_mechanisms(flow: Flow, state: State, functional: Array) -> tuple[float, float] | None:
    """Least and greatest value of a functional (6 n,) of the rates of all mechanisms of a stress state.

    Linear programs over the rates u and multipliers y in K* of rows that yield: C u + G^T y = 0 and
    live . u = 1, Eqs (54)-(55), up to what the mechanism of the state itself leaves of them; its own
    multipliers are among those that may be, so that it is never lost. An end is infinite where nothing limits
    it; None if a program ends without an answer.
    """
    p, n = flow.problem, flow.problem.C.shape[1]
    columns = flow_columns(p, p.F @ state.x + p.g, YIELDS)
    own = sparse.coo_array((state.y, (np.arange(len(state.y)), p.cones.member))).tocsr()
    G = flow.matrix(state.x)
    strains = G.T @ sparse.hstack([columns, own])
    left = np.abs(p.C @ state.u + G.T @ state.y).max() + LEFT * np.abs(p.C @ state.u).max()
    A = sparse.hstack([p.C, strains]).tocsr()
    live = sparse.csr_array(np.append(p.live, np.zeros(strains.shape[1]))[None])
    goal = np.append(functional, np.zeros(strains.shape[1]))
    ends = []
    for sign in (1.0, -1.0):
        found = linear_program(
            sign * goal,
            A_ub=sparse.vstack([A, -A]).tocsr(),
            b_ub=np.full(2 * A.shape[0], left),
            A_eq=live,
            b_eq=[float(p.live @ state.u)],
            bounds=[(None, None)] * n + [(0.0, None)] * strains.shape[1],
            method="highs",
            options=PRECISE,
        )
        if found.status not in (0, 3):  # an optimum, or unlimited
            return None
        ends.append(sign * found.fun if found.status == 0 else -sign * np.inf)
    return ends[0], ends[1]

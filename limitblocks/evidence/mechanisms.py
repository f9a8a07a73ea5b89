"""Whether the mechanism of a stress state is the only one. numpy and scipy only."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array
from limitblocks.evidence.mechanism import flow_columns, linear_program
from limitblocks.problem import Flow, State

YIELDS = 1e-6  # of the force of an interface: rows closer than this to yield may flow
# The first ends without an answer where rows are nearly dependent, as of vaults; the second takes longer.
WAYS: tuple[tuple[Any, Any], ...] = (("highs-ipm", {}), ("highs-ds", {"presolve": False}))


def change_of_mechanism(flow: Flow, state: State, functional: Array) -> float | None:
    """Return by how much a functional (6 n,) of the rates differs in another mechanism of the same stresses.

    Linear programs over changes of the rates, and of multipliers of the rows that yield or flow:
    C du + G^T dy = 0 and live . du = 0, Eqs (54)-(55), y + dy in K*. To stay is one of them. What flows may
    double or stop, and what yields flow as much as the most: another mechanism changes more only in
    proportion. None if a program ends without an answer.
    """
    p, n = flow.problem, flow.problem.C.shape[1]
    own = sparse.coo_array((state.y, (np.arange(len(state.y)), p.cones.member))).tocsr()
    free = flow_columns(p, p.F @ state.x + p.g, YIELDS)
    strains = sparse.csr_array(flow.matrix(state.x).T @ sparse.hstack([own, free]))
    k, largest = own.shape[1], float(np.abs(p.C @ state.u).max())
    size = abs(strains).max(axis=0).toarray().ravel()[k:]
    unit = np.append(np.ones(k) / largest, 1.0 / np.maximum(size, np.finfo(float).tiny))
    rate = float(np.abs(state.u).max())
    A = sparse.block_array(
        [
            [p.C * (rate / largest), strains @ sparse.diags_array(unit)],
            [sparse.csr_array(p.live[None] / np.abs(p.live).max()), None],
        ],
        format="csr",
    )
    bounds = [(None, None)] * n + [(-1.0, 1.0)] * k + [(0.0, 1.0)] * free.shape[1]
    goal, changes = np.append(rate * functional, np.zeros(strains.shape[1])), []
    for sign in (1.0, -1.0):
        for method, options in WAYS:
            found = linear_program(
                sign * goal,
                A_eq=A,
                b_eq=np.zeros(A.shape[0]),
                bounds=bounds,
                method=method,
                options=options,
            )
            if found.status == 0:
                changes.append(abs(float(found.fun)))
                break
        else:
            return None
    return max(changes)

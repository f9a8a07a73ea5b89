"""The mechanism of a claimed stress state by linear programs, and whether it is the only one. scipy only."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy import optimize, sparse

from limitblocks.arrays import Array
from limitblocks.problem import Flow, LimitProblem, State
from limitblocks.problem.cones import rays

ACTIVE = 1e-3  # of the force of an interface: rows closer than this to yield may flow
APEX_DIRECTIONS = 32
linear_program: Any = optimize.linprog  # its stubs know no sparse matrices
YIELDS = 1e-6  # of the force of an interface: rows closer than this to yield may flow
# The first ends without an answer where rows are nearly dependent, as of vaults; the second takes longer.
WAYS: tuple[tuple[Any, Any], ...] = (("highs-ipm", {}), ("highs-ds", {"presolve": False}))
PRECISE: Any = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}


def find_mechanism(flow: Flow, stresses: Array, rates: Array | None = None) -> tuple[Array, Array]:
    """Return displacement rates u and multipliers y of least residual for a stress state.

    A linear program over the rows at or near yield minimises max |C u + G^T y| + y . (F x + g) under
    live . u = 1, y in K*. With `rates` given only the multipliers are sought. Where none exists the result
    is NaN, which every residual counts as infinite.
    """
    problem = flow.problem
    n, R = problem.C.shape[1], problem.F.shape[0]
    rows = problem.F @ stresses + problem.g
    if not np.isfinite(rows).all() or (rates is not None and not np.isfinite(rates).all()):
        return np.full(n, np.nan) if rates is None else rates, np.full(R, np.nan)
    columns = flow_columns(problem, rows)
    strains = (flow.matrix(stresses).T @ columns).tocsr()
    worst = sparse.csr_array(np.ones((problem.C.shape[0], 1)))
    free = problem.C if rates is None else sparse.csr_array((problem.C.shape[0], 0))
    known = np.zeros(problem.C.shape[0]) if rates is None else problem.C @ rates
    above = sparse.hstack([free, strains, -worst])
    below = sparse.hstack([-free, -strains, -worst])
    k = free.shape[1]
    work = [sparse.csr_array(problem.live[None, :k]), sparse.csr_array((1, columns.shape[1] + 1))]
    solution = linear_program(
        np.concatenate([np.zeros(k), np.maximum(columns.T @ rows, 0.0), [1.0]]),
        A_ub=sparse.vstack([above, below]).tocsr(),
        b_ub=np.concatenate([-known, known]),
        A_eq=sparse.hstack(work).tocsr() if k else None,
        b_eq=[1.0] if k else None,
        bounds=[(None, None)] * k + [(0.0, None)] * (columns.shape[1] + 1),
        method="highs-ipm",
        options=PRECISE,
    )
    if solution.x is None:
        return np.full(n, np.nan), np.full(R, np.nan)
    u = solution.x[:k] if rates is None else rates
    return u, columns @ solution.x[k:-1]


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


def flow_columns(problem: LimitProblem, rows: Array, near: float = ACTIVE) -> sparse.csr_array:
    """Generators of the multipliers that complementarity allows `near` yield: y = columns @ (>= 0).

    On a cone's boundary the ray orthogonal to the state, (1, -z/||z||); at its apex rays all around.
    """
    linear = np.flatnonzero(rows[: problem.cones.linear] < near)
    parts: list[tuple[Any, Array]] = [(linear[:, None], np.ones((len(linear), 1, 1)))]
    for places in problem.cones.groups:
        cone = rows[places]
        z = np.linalg.norm(cone[:, 1:], axis=1)
        yields, apex = cone[:, 0] - z < near, z < near
        edge = yields & ~apex
        ray = np.concatenate([np.ones((edge.sum(), 1)), -cone[edge, 1:] / z[edge, None]], axis=1)
        parts.append((places[edge], ray[:, None]))
        at_apex, around = places[yields & apex], rays(cone.shape[1], APEX_DIRECTIONS)
        parts.append((at_apex, np.broadcast_to(around, (len(at_apex), *around.shape))))
    return sparse_columns(parts, len(rows))


def sparse_columns(parts: list[tuple[Any, Array]], height: int) -> sparse.csr_array:
    """Return sparse columns from rows' places (k, size) and stacks of generators (k, count, size)."""
    data, row, column, width = [], [], [], 0
    for places, generators in parts:
        k, count, _ = generators.shape
        number = width + np.arange(k * count).reshape(k, count, 1)
        data.append(generators.ravel())
        row.append(np.broadcast_to(places[:, None], generators.shape).ravel())
        column.append(np.broadcast_to(number, generators.shape).ravel())
        width += k * count
    triplets = (np.concatenate(data), (np.concatenate(row), np.concatenate(column)))
    return sparse.coo_array(triplets, shape=(height, width)).tocsr()

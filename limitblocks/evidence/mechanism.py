"""The linear program that completes a claimed stress state by its mechanism. scipy only."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy import optimize, sparse

from limitblocks.arrays import Array
from limitblocks.problem import Flow, LimitProblem
from limitblocks.problem.cones import rays

ACTIVE = 1e-3  # of the force of an interface: rows closer than this to yield may flow
APEX_DIRECTIONS = 32
linear_program: Any = optimize.linprog  # its stubs know no sparse matrices
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

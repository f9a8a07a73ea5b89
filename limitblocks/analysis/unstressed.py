"""The stresses that arise when the dead loads are put on unstressed blocks with slightly compliant joints.

One implicit step under load control, from x = 0, of joints of one compliance W per area and zero dilatancy:

    W x = C u + G^T y,   dead = C^T x + k u,   F x + g in K,   y in K*,   (F x + g) o y = 0,

k = 0. Where friction alone cannot keep a block that nobody wedges, it has no solution. Then weak springs k
tie every block to the ground: those whose springs carry a share of their load are not held.
The question is that of Kao et al. (2022), Coupled rigid-block analysis, Computer-Aided Design 146, 103216.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from limitblocks.analysis.interface_blocks import InterfaceBlocks
from limitblocks.analysis.nonassociated.implicit_step import Loading, StepResult, implicit_step
from limitblocks.analysis.nonassociated.path_equations import Point
from limitblocks.arrays import Array
from limitblocks.problem import Flow, LimitProblem

ITERATIONS = 100  # of Newton's method
# Work of the dead loads on the joints over that on the springs, tried in turn: where friction can hold what
# nobody wedges, the step on soft springs has several solutions, and often none is found.
SPRINGS = (1e-4, 1e-2, 1e-1, 1.0)
# Times the stiffness, 0.01 to 0.9 of what acts on a block: the springs of a block not held carry more.
CARRIED = 5.0


def joint_compliance(problem: LimitProblem) -> Array:
    """One compliance per area, scaled so that the dead loads do unit elastic work on each part, (s,).

    Parts that no interface joins are problems of their own; a common scale would lose the light ones.
    """
    p, W = problem, problem.compliance
    K = p.C.T @ sparse.diags_array(1.0 / W) @ p.C + 1e-12 * sparse.eye_array(p.C.shape[1])
    work = p.dead * linalg.spsolve(sparse.csc_array(K), p.dead)
    of_block = np.bincount(p.parts, weights=work.reshape(-1, 6).sum(axis=1))[p.parts]
    of_interface = of_block[p.ends.max(axis=1)][p.stress_interface]
    return np.asarray(W / np.where(of_interface > 0.0, of_interface, 1.0))


def arising(problem: LimitProblem, weights: Array) -> StepResult:
    """The stresses that arise on joints of compliance `weights`, and the displacements."""
    return _under_load(problem, weights)


def not_held(problem: LimitProblem, weights: Array) -> Array | None:
    """Which blocks weak springs have to carry, shape (n,); None where no step with springs succeeds."""
    n = 6 * len(problem.blocks)
    free = sparse.csr_array((len(problem.g), n))
    on_springs = replace(
        problem,
        C=sparse.csr_array(sparse.vstack([problem.C, sparse.eye_array(n)])),
        F=sparse.csr_array(sparse.hstack([problem.F, free])),
        G=sparse.csr_array(sparse.hstack([problem.G, free])),
        resultants=sparse.csr_array(sparse.block_diag([problem.resultants, sparse.eye_array(n)])),
        interfaces=problem.interfaces + problem.blocks,
    )
    for stiffness in SPRINGS:
        step = _under_load(on_springs, np.append(weights, np.full(n, 1.0 / stiffness)))
        if step.accepted:
            x, springs = np.split(step.point.x, [-n])
            acting = np.abs(problem.dead) + problem.acting @ np.abs(x)
            share = min(max(0.01, CARRIED * stiffness), 0.9)
            return np.asarray(_largest(np.abs(springs)) > share * _largest(acting))
    return None


def _under_load(problem: LimitProblem, weights: Array) -> StepResult:
    """One implicit step from x = 0 under the dead loads.

    The step is under control of live.u = 1: the live load moves a coordinate of its own, tied to nothing.
    """
    s, n = problem.C.shape
    controlled = replace(
        problem,
        C=sparse.csr_array(sparse.hstack([problem.C, sparse.csr_array((s, 1))])),
        dead=np.append(problem.dead, 0.0),
        live=np.append(np.zeros(n), 1.0),
    )
    loading = Loading(Flow(controlled), InterfaceBlocks(controlled), weights, np.zeros(s), rho=1.0)
    step = implicit_step(loading, ITERATIONS)
    z = step.point
    return replace(step, point=Point(z.x, z.u[:-1], 0.0, z.s, z.y))


def _largest(values: Array) -> Array:
    return np.asarray(values.reshape(-1, 6).max(axis=1))

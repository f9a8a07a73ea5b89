"""The stresses that arise when the dead loads are put on unstressed blocks with slightly compliant joints.

One implicit step under load control, from x = 0, of joints of compliance W:

    W x = C u + G^T y,   dead = C^T x + k u,   F x + g in K,   y in K*,   (F x + g) o y = 0,

k = 0. Where friction alone cannot keep a block that nobody wedges, it has no solution. Then weak springs k
tie every block to the ground: those whose springs carry a share of their load are not held. A barrier on
(F x + g) o y fades along a path that is followed by arclength: steps that lower a large one fail.
The question is that of Kao et al. (2022), Coupled rigid-block analysis, Computer-Aided Design 146, 103216.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from limitblocks.analysis.nonassociated.least_norm import least_state
from limitblocks.analysis.nonassociated.path import BUDGET
from limitblocks.analysis.nonassociated.path_equations import Barrier, Path
from limitblocks.analysis.nonassociated.path_layout import Layout
from limitblocks.analysis.nonassociated.path_measures import by_units
from limitblocks.analysis.nonassociated.path_start import centred
from limitblocks.analysis.nonassociated.stretch import Stretch
from limitblocks.arrays import Array
from limitblocks.problem import Flow, LimitProblem, State

FIRST = 1.0  # barrier where a path begins, of the work of the dead loads
LEFT = 1e-10  # at the end
# Barrier to begin with where there is no path: steps of Newton's method from it find what arises in all of
# 93 models of the gallery that yield, in two thirds of the time of a path. Stresses are off by at most 1e-3
# of the largest at its end.
SMALL, LEAST = 1e-5, 1e-9
LONG = 0.6  # first predictor
# Of 122 flat arches, tilted and pushed, that no path starts from, rounds that go all the way decide 7, half
# of it in 30 rounds 60, three tenths in 30 rounds 105, in 60 rounds 116, in 120 rounds 118.
ROUNDS, SHARE = 60, 0.3
# Work of the dead loads on the joints over that on the springs, tried in turn: where friction can hold what
# nobody wedges, the step on soft springs has several solutions, and often none is found.
SPRINGS = (1e-4, 1e-2, 1e-1, 1.0)
# Times the stiffness, 0.01 to 0.9 of what acts on a block: the springs of a block not held carry more.
CARRIED = 5.0


def elastic_displacements(problem: LimitProblem, weights: Array) -> Array:
    """Displacements (6 n,) under the dead loads on joints of compliance `weights` that never yield."""
    C = problem.C
    K = C.T @ sparse.diags_array(1.0 / weights) @ C
    stiffest = np.repeat(K.diagonal().reshape(-1, 6).max(axis=1), 6)  # of each block
    K = K + sparse.diags_array(np.maximum(1e-12, 1e-14 * stiffest))
    return np.asarray(linalg.spsolve(sparse.csc_array(K), problem.dead))


def joint_compliance(problem: LimitProblem, weights: Array | None = None, u: Array | None = None) -> Array:
    """One compliance per area, or `weights`, scaled: the dead loads do unit elastic work on each part, (s,).

    Parts that no interface joins are problems of their own; a common scale would lose the light ones. The
    elastic displacements `u` on joints of that compliance may be known.
    """
    p, W = problem, problem.compliance if weights is None else weights
    work = p.dead * (elastic_displacements(p, W) if u is None else u)
    of_block = np.bincount(p.parts, weights=work.reshape(-1, 6).sum(axis=1))[p.parts]
    of_interface = of_block[p.ends.max(axis=1)][p.stress_interface]
    return np.asarray(W / np.where(of_interface > 0.0, of_interface, 1.0))


def may_arise(flow: Flow, weights: Array) -> Iterator[State]:
    """Give what a path and steps lead to on joints of compliance `weights`, the state of least norm, rounds.

    That has dilatancy, which does no work where it arises: residuals have to say.
    """
    found = arising(flow, weights)
    if found is not None:
        yield found
    found = at_once(flow, weights)  # where the path finds no start, or ends
    if found is not None:
        yield found
    found = least_state(flow.problem, weights)  # where the path finds no start, as on many arches
    if found is not None:
        yield found
        yield from in_rounds(flow, weights, found.x)


def in_rounds(flow: Flow, weights: Array, x: Array) -> Iterator[State]:
    """Give states of least norm with the friction of stresses x, which go a `SHARE` of the way to each.

    Panagiotopoulos (1975), Ingenieur-Archiv 44: an associated problem in each round. Where no path starts, as
    where joints without friction lie beside others, they mostly converge to what arises without dilatancy.
    """
    p = flow.problem
    for _ in range(ROUNDS):
        G = flow.matrix(x)
        found = least_state(replace(p, F=G, G=G, g=p.g + (p.F - G) @ x), weights)
        if found is None:
            return
        yield found
        x = x + SHARE * (found.x - x)


def not_held(problem: LimitProblem, weights: Array) -> Array | None:
    """Which blocks weak springs have to carry, shape (n,); None where no step with springs succeeds."""
    n = problem.C.shape[1]
    flow = Flow(_on_springs(problem))
    for stiffness in SPRINGS:
        found = arising(flow, np.append(weights, np.full(n, 1.0 / stiffness)))
        if found is not None:
            x, springs = np.split(found.x, [-n])
            acting = np.abs(problem.dead) + problem.acting @ np.abs(x)
            share = min(max(0.01, CARRIED * stiffness), 0.9)
            return np.asarray(_largest(np.abs(springs)) > share * _largest(acting))
    return None


@np.errstate(all="ignore")  # a point that ran away is not accepted
def arising(
    flow: Flow, weights: Array, first: float = FIRST, left: float = LEFT, *, along_path: bool = True
) -> State | None:
    """The stresses that arise on joints of compliance `weights`, and the displacements; None if not found.

    They are within yield, by what is `left` of the barrier; it begins with `first`, and falls along a path,
    or from step to step of Newton's method. Without a live load there is no load factor to find.
    """
    s, n = flow.problem.C.shape
    flow = replace(flow, problem=replace(flow.problem, live=np.zeros(n)))
    even, x0 = flow.problem.cones.identity, np.zeros(s)
    barrier, own = Barrier(first, power=0.0, floor=0.0), by_units(flow.problem, weights, 1.0)
    path = Path(flow, Layout(flow), barrier, even, weights, x0, x0, own)
    try:
        start, _ = centred(path, until=None if along_path else left / first)
    except (RuntimeError, ValueError):  # SuperLU: singular or not finite
        return None
    if start is None or not along_path:
        return None if start is None else start.state
    walk = Stretch(path, start, left / first, BUDGET)
    walk.length = LONG
    return walk.kept[-1].state if walk.go() == "arrived" else None


def at_once(flow: Flow, weights: Array) -> State | None:
    """The same by steps of Newton's method from a barrier that is small already."""
    return arising(flow, weights, SMALL, LEAST, along_path=False)


def _on_springs(problem: LimitProblem) -> LimitProblem:
    """The problem with further interfaces that never yield: a spring to each rate of each block."""
    springs = sparse.eye_array(problem.C.shape[1])
    free = sparse.csr_array((len(problem.g), problem.C.shape[1]))
    return replace(
        problem,
        C=sparse.csr_array(sparse.vstack([problem.C, springs])),
        F=sparse.csr_array(sparse.hstack([problem.F, free])),
        G=sparse.csr_array(sparse.hstack([problem.G, free])),
        resultants=sparse.csr_array(sparse.block_diag([problem.resultants, springs])),
        interfaces=problem.interfaces + problem.blocks,
    )


def _largest(values: Array) -> Array:
    return np.asarray(values.reshape(-1, 6).max(axis=1))

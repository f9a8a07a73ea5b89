"""End game: from a state near a solution to one that satisfies Eqs (54)-(59) to rounding.

The rows that yield are read off the state: of a linear row or a cone, s = F x + g or its multiplier y is the
larger one, and the smaller is zero in the solution (strict complementarity). What is left is a smooth square
system in (x, u, load factor a, y of what yields):

    C u + G(x)^T y = 0,   C^T x = dead + a live,   live . u = 1,
    s = 0 where y is the larger,   s o y = 0 for a cone where both lie on the boundary,

solved by Newton's method. Stresses of rigid parts and multipliers of redundant rows are not unique: J is
singular. With the first equations negated it is skew for associated flow, so that J + delta I is regular and
refinement on J is the proximal point method (Rockafellar 1976, SIAM J. Control 14); the polish of OSQP does
the same (Stellato et al. 2020, Math. Prog. Computation 12). The rows that yield are read off again at every
step: a semismooth Newton method, which closes paths earlier than one that solves for each set of rows. Where
it fails the steps are those of least norm, from a quasidefinite system (Vanderbei 1995, SIAM J. Optim. 5):
lintels that crush need them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from enum import IntEnum

import numpy as np

from limitblocks.arrays import Array, Indices
from limitblocks.evidence.elimination import Entries, elimination, factors_in_order, placed
from limitblocks.evidence.nearest_mechanism import least_solution
from limitblocks.evidence.residuals import mcp_residuals
from limitblocks.problem import Cones, Flow, LimitProblem, State

PROXIMAL = 1e-6  # delta
REGULAR = 1e-11  # eps of the least solution
REFINEMENTS = 4
ROUNDING = 1e-14  # a residual that cannot fall further
STEPS = 20  # of Newton's method
PATIENCE = 4  # steps in turn that do not better the best state


class Kind(IntEnum):
    """What a linear row or a cone does: y = 0, both on the boundary of the cone, or s = 0."""

    FREE = 0
    BOUNDARY = 1
    TIGHT = 2


@dataclass(frozen=True, eq=False)
class Active:
    """What yields: kinds of the linear rows and the cones, yielding rows, and those of boundary cones."""

    kind: Indices
    rows: Indices
    on_boundary: Indices


Solution = Callable[[LimitProblem, Active, Entries, Array], Array]


def defect(flow: Flow, state: State) -> float:
    """Return the largest residual of Eqs (54)-(59)."""
    return mcp_residuals(flow, state).worst.value


def classified(cones: Cones, s: Array, y: Array) -> Active:
    """Read off what yields: the larger of s and y, eigenvalue by eigenvalue of a cone."""
    kind = np.where(s[: cones.linear] < y[: cones.linear], Kind.TIGHT, Kind.FREE)
    kinds = [kind]
    for index in cones.groups:
        a, b = s[index], y[index]
        across, along = np.linalg.norm(a[:, 1:], axis=1), np.linalg.norm(b[:, 1:], axis=1)
        # s and y of a solution share a frame, in reverse: the least of s meets the largest of y
        free, tight = a[:, 0] - across >= b[:, 0] + along, b[:, 0] - along >= a[:, 0] + across
        kinds.append(np.where(free, Kind.FREE, np.where(tight, Kind.TIGHT, Kind.BOUNDARY)))
    kind = np.concatenate(kinds)
    of_row = kind[cones.member]
    return Active(kind, np.flatnonzero(of_row != Kind.FREE), np.flatnonzero(of_row == Kind.BOUNDARY))


@np.errstate(all="ignore")
def polish(flow: Flow, state: State, *, until: float = ROUNDING, patience: int | None = None) -> State:
    """Return the state with residuals as small as rounding allows, or as it was where they do not fall.

    Parameters
    ----------
    flow : Flow
        Any flow rule; with associated flow the state is a pair of bounds.
    state : State
        A state near a solution, dimensionless.
    until : float
        Residual that is small enough.
    patience : int, optional
        Proximal steps in turn that may fail to better the best state. Left out: a few, and then as many of
        least norm, which take ten times as long.
    """
    return polished(flow, state, defect(flow, state), until=until, patience=patience)[0]


@np.errstate(all="ignore")  # a state that ran away is not kept
def polished(
    flow: Flow, state: State, least: float, *, until: float = ROUNDING, patience: int | None = None
) -> tuple[State, float]:
    """Return what `polish` returns and its largest residual; that of the state given is `least`."""
    best, given = state, least
    if least <= until:
        return best, least
    for solution in (_proximal_solution, _least_solution)[: 1 if patience else 2]:
        for iterate, worst in _steps(flow, state, given, solution, patience or PATIENCE):
            if worst < least:
                best, least = iterate, worst
            if least <= until:
                return best, least
    return best, least


def _steps(
    flow: Flow, state: State, least: float, solution: Solution, patience: int
) -> Iterator[tuple[State, float]]:
    """States of a semismooth Newton method and their residuals, until they get worse."""
    p, now, failed = flow.problem, state, 0
    for _ in range(STEPS):
        s = p.F @ now.x + p.g
        sigma = float(np.linalg.norm(s)) / max(float(np.linalg.norm(now.y)), 1e-300)
        try:
            now = _step(flow, now, classified(p.cones, s, sigma * now.y), solution)
        except (RuntimeError, ValueError):  # SuperLU: singular, or not finite
            return
        iterate = admissible(p.cones, now)
        worst = defect(flow, iterate)
        failed = failed + 1 if worst >= least else 0
        least = min(least, worst)
        yield iterate, worst
        if failed == patience:
            return


def _step(flow: Flow, now: State, active: Active, solution: Solution) -> State:
    """One Newton step on the equations of a set of yielding rows."""
    p = flow.problem
    y = np.zeros_like(now.y)
    y[active.rows] = now.y[active.rows]
    now = State(now.load_factor, now.x, now.u, y)
    residual, entries = _equations(flow, now, active)
    n, k = p.C.shape[0], p.C.shape[0] + p.C.shape[1]
    d = solution(p, active, entries, -residual)
    y = now.y.copy()
    y[active.rows] += d[k + 1 :]
    return State(now.load_factor + float(d[k]), now.x + d[:n], now.u + d[n:k], y)


def _proximal_solution(p: LimitProblem, active: Active, entries: Entries, r: Array) -> Array:
    """Solution of J d = r from J + delta I with refinement; the first equations (s,) negated."""
    every, J = np.arange(len(r)), entries.square(len(r))
    sign = np.where(every < p.C.shape[0], -1.0, 1.0)
    signed = entries._replace(data=sign[entries.row] * entries.data)
    added = placed([(signed, 0, 0), (Entries(np.full(len(r), PROXIMAL), every, every), 0, 0)])
    factors = factors_in_order(added, elimination(p, p.row_interface[active.rows]))
    d = factors.solve(sign * r)
    for _ in range(REFINEMENTS):
        d = d + factors.solve(sign * (r - J @ d))
    return d


def _least_solution(p: LimitProblem, active: Active, entries: Entries, r: Array) -> Array:
    """Least-norm least-squares solution of J d = r, where rows contradict each other."""
    order = elimination(p, p.row_interface[active.rows])
    return least_solution(entries, r, np.stack([order, len(r) + order], axis=1).ravel(), REGULAR)


def _equations(flow: Flow, now: State, active: Active) -> tuple[Array, Entries]:
    """Residual of the equations of the yielding rows, and their derivative by (x, u, a, y of the rows)."""
    p = flow.problem
    s = p.F @ now.x + p.g
    conditions, by_stress, by_multiplier = _complementarity(p, s, now.y, active)
    residual = np.concatenate(
        [
            p.C @ now.u + flow.strains(now.x, now.y),
            p.balance @ now.x - p.dead - now.load_factor * p.live,
            [p.live @ now.u - 1.0],
            conditions,
        ]
    )
    n, a = p.C.shape[0], p.C.shape[0] + p.C.shape[1]
    C, yields, loaded = Entries.of(p.C), np.arange(len(active.rows)), np.flatnonzero(p.live)
    flows = Entries(np.ones(len(yields)), yields, active.rows).times(flow.matrix(now.x)).T
    no = np.zeros_like(loaded)
    blocks = [
        (C, 0, n), (flows, 0, a + 1),
        (C.T, n, 0), (Entries(-p.live[loaded], loaded, no), n, a),
        (Entries(p.live[loaded], no, loaded), a, n),
        (by_stress, a + 1, 0), (by_multiplier, a + 1, a + 1),
    ]  # fmt: skip
    if not flow.constant:
        blocks.append((Entries.of(-flow.derivative(now.x, now.y)), 0, 0))
    return residual, placed(blocks)


def _complementarity(p: LimitProblem, s: Array, y: Array, active: Active) -> tuple[Array, Entries, Entries]:
    """Conditions s = 0 or s o y = 0 of the yielding rows, and their derivatives by x and by y of the rows."""
    rows, cones = active.rows, p.cones
    both = np.zeros(cones.height, dtype=bool)
    both[active.on_boundary] = True
    # a cone on the boundary counts in units of its larger part
    unit = np.maximum(np.abs(s[cones.heads]), np.abs(y[cones.heads]))[cones.member]
    unit = np.maximum(unit, 1e-300)
    factor = np.where(both, y / unit, cones.identity)  # s = s o e, e the identity
    place = np.full(cones.height, -1)
    place[rows] = np.arange(len(rows))

    def derivative(v: Array) -> Entries:
        """Of s o v in the yielding rows, by s."""
        data, row, column = cones.arrow_entries(v)
        kept = (data != 0.0) & (place[row] >= 0)
        return Entries(data[kept], place[row[kept]], column[kept])

    by_stress, (data, row, column) = derivative(factor), derivative(np.where(both, s / unit, 0.0))
    return cones.product(s, factor)[rows], by_stress.times(p.F), Entries(data, row, place[column])


def admissible(cones: Cones, state: State) -> State:
    """Return the state with multipliers that left K by rounding put back."""
    return replace(state, y=cones.nearest(state.y))

"""Closing step: the rows of which it is not plain whether they yield, by complementary pivots.

Newton's method of :mod:`limitblocks.analysis.polish` reads off the state which rows yield. Where slack and
multiplier of some are of like size the guess is wrong, and it may change for ever. Here Eqs (54)-(59) are
linearised at the state (Josephy 1979; Robinson 1980), and rows keep s = 0 or y = 0, whichever is less. Those
that this violates are not plain: all else is eliminated, and they are a linear complementarity problem,
s = q + M y, small and dense (:mod:`limitblocks.analysis.complementarity`), which what it violates joins.
Stresses of rigid parts are not unique, so that a proximal term delta (z - z_k) is added, which fades.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy import sparse

from limitblocks.analysis.complementarity import complementary
from limitblocks.analysis.eigenpairs import Pairs, pairs
from limitblocks.analysis.polish import admissible, defect, polished
from limitblocks.arrays import Array, Indices
from limitblocks.evidence.elimination import Entries, Factors, elimination, factors_in_order, placed
from limitblocks.evidence.residuals import TOLERANCE
from limitblocks.problem import Flow, State

PROXIMAL = (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-8)  # delta of the steps
LARGEST = 400  # pairs that are not plain
WIDENED = 6  # times that rows join in a step
COLUMNS = 32  # solved at once: 200 take twice as long, as they leave the cache

Mask = npt.NDArray[np.bool_]


@np.errstate(all="ignore")  # a state that ran away is not kept
def pivoted(flow: Flow, state: State, largest: int = LARGEST) -> State:
    """Return the solution that complementary pivots lead to, or the state of least residual met.

    Parameters
    ----------
    flow : Flow
        The limit problem and its flow rule.
    state : State
        A state near a solution, dimensionless.
    largest : int
        Pairs that are not plain, beyond which no step is tried: their cost grows with the cube of it.
    """
    now, best, least = state, state, defect(flow, state)
    for delta in PROXIMAL:
        if least <= 0.01 * TOLERANCE:
            break
        found = _step(flow, now, delta, largest)
        if found is None:
            break
        now = found
        near, left = polished(flow, now, defect(flow, now), patience=2)
        if left < least:
            best, least = near, left
    return best


def _step(flow: Flow, now: State, delta: float, largest: int) -> State | None:
    """One step from a state, None where no pivots lead to its end or too many rows are not plain."""
    linear, found = _Linearised(flow, now, delta), None
    unsure = np.zeros(0, dtype=int)
    ends = np.zeros((0, 0))
    try:
        ends = linear.plain
        for _ in range(WIDENED):
            found = linear.solved(unsure, ends)
            if found is None or not len(found.violated):
                break
            unsure = np.append(unsure, found.violated)
            if len(unsure) > largest:
                return None
            ends = np.column_stack([ends, linear.opened(found.violated)])
    except (RuntimeError, ValueError):  # singular, or not finite
        return None
    return None if found is None else admissible(flow.problem.cones, found.state)


class _Solved(NamedTuple):
    """The end of a step, and the plain pairs that it violates."""

    state: State
    violated: Indices


@dataclass(frozen=True, eq=False)
class _Linearised:
    """Eqs (54)-(59) linearised at a state; rates and multipliers times sigma, to have like sizes."""

    flow: Flow
    now: State
    delta: float

    @cached_property
    def sigma(self) -> float:
        """Size of the slacks over that of the multipliers."""
        s = self.flow.problem.F @ self.now.x + self.flow.problem.g
        return float(np.linalg.norm(s)) / max(float(np.linalg.norm(self.now.y)), np.finfo(float).tiny)

    @cached_property
    def pairs(self) -> Pairs:
        """Slacks and multipliers of the state."""
        p = self.flow.problem
        return pairs(p.cones, p.F @ self.now.x + p.g, self.sigma * self.now.y)

    @cached_property
    def tight(self) -> Mask:
        """Pairs held at s = 0; the others are at y = 0."""
        return self.pairs.signed < 0.0

    @cached_property
    def held(self) -> sparse.csr_array:
        """Rows of what is held."""
        return sparse.csr_array(sparse.vstack([self.pairs.rows[self.tight], self.pairs.across]))

    def solved(self, unsure: Indices, ends: Array) -> _Solved | None:
        """The end of the step with these pairs open, and the others as they are, from what `opened` gives."""
        p, pair, tight = self.flow.problem, self.pairs, self.tight
        n, first = p.C.shape[0], p.C.shape[0] + p.C.shape[1] + 1
        rows, was_tight = pair.rows[unsure], tight[unsure]
        # slacks of the pairs that were loose and multipliers of those that were held, by the others
        table = rows @ (p.F @ ends[:n]) + self.delta * np.eye(len(unsure), ends.shape[1], 1)
        table[:, 0] += rows @ p.g - self.delta * np.maximum(pair.multiplier[unsure], 0.0)
        places = first + np.cumsum(tight) - 1
        table[was_tight] = ends[places[unsure[was_tight]]]
        q, M = _exchanged(table, was_tight)
        signed = pair.signed[unsure]
        found = complementary(q, M, np.maximum(signed, 0.0), np.maximum(-signed, 0.0))
        if found is None:
            return None
        end = ends @ np.append(1.0, np.where(was_tight, *found))
        y = rows[~was_tight].T @ found[1][~was_tight] + self.held.T @ end[first:]
        state = State(float(end[first - 1]), end[:n], end[n : first - 1] / self.sigma, y / self.sigma)
        slack = pair.rows @ (p.F @ state.x + p.g)
        least = -TOLERANCE * max(1.0, float(np.abs(slack).max()))
        violated = slack < least
        violated[tight] = end[places[tight]] < least
        violated[unsure] = False
        return _Solved(state, np.flatnonzero(violated))

    @cached_property
    def plain(self) -> Array:
        """(x, sigma u, load factor, multipliers of what is held) with every pair as it is, one column."""
        p, now, sigma = self.flow.problem, self.now, self.sigma
        multipliers = np.concatenate([self.pairs.multiplier[self.tight], self.pairs.across @ (sigma * now.y)])
        before = np.concatenate([now.x, sigma * now.u, [now.load_factor], multipliers])
        known = np.concatenate([np.zeros(len(now.x)), p.dead, [sigma], -(self.held @ p.g)])
        if self._turn is not None:
            known[: len(now.x)] += self._turn @ now.x
        return self._refined((known + self.delta * before)[:, None])

    def opened(self, unsure: Indices) -> Array:
        """What a unit of slack adds to it for pairs that are held, and a unit multiplier for loose ones."""
        p, was_tight = self.flow.problem, self.tight[unsure]
        n, first = p.C.shape[0], p.C.shape[0] + p.C.shape[1] + 1
        units = np.zeros((first + self.held.shape[0], len(unsure)))
        units[:n, ~was_tight] = (self._matrix.T @ self.pairs.rows[unsure[~was_tight]].T).toarray()
        units[first + np.cumsum(self.tight)[unsure[was_tight]] - 1, np.flatnonzero(was_tight)] = 1.0
        return self._refined(units)

    def _refined(self, right: Array) -> Array:
        (J, factors), count = self._system, right.shape[1]
        ends = np.empty_like(right)
        for part in (slice(k, k + COLUMNS) for k in range(0, count, COLUMNS)):
            found = factors.solve(right[:, part])
            ends[:, part] = found + factors.solve(right[:, part] - J @ found)
        return ends

    @cached_property
    def _matrix(self) -> sparse.csr_array:
        return self.flow.matrix(self.now.x)

    @cached_property
    def _turn(self) -> sparse.csr_array | None:
        return None if self.flow.constant else self.flow.derivative(self.now.x, self.sigma * self.now.y)

    @cached_property
    def _system(self) -> tuple[sparse.csr_array, Factors]:
        """The system of what is held, and its factors."""
        p, held, tight = self.flow.problem, self.held, np.count_nonzero(self.tight)
        n, a = p.C.shape[0], p.C.shape[0] + p.C.shape[1]
        C, live, height = Entries.of(p.C), Entries.of(sparse.csr_array(p.live[:, None])), held.shape[0]
        across = np.arange(tight, height)
        blocks = [
            (-C, 0, n), (-Entries.of(held @ self._matrix).T, 0, a + 1),
            (C.T, n, 0), (-live, n, a),
            (live.T, a, n),
            (Entries.of(held @ p.F), a + 1, 0), (Entries(self.pairs.kappa, across, across), a + 1, a + 1),
        ]  # fmt: skip
        if self._turn is not None:
            blocks.append((Entries.of(self._turn), 0, 0))
        every = np.arange(a + 1 + height)
        entries = placed([*blocks, (Entries(np.full(len(every), self.delta), every, every), 0, 0)])
        order = elimination(p, p.row_interface[held.indices[held.indptr[:-1]]])
        return entries.square(len(every)), factors_in_order(entries, order)


def _exchanged(table: Array, was_tight: Mask) -> tuple[Array, Array]:
    """The q and M of s = q + M y from [q, M] with slacks and multipliers of some pairs exchanged."""
    table = table.copy()
    on, columns = np.flatnonzero(was_tight), np.flatnonzero(np.append(False, was_tight))
    back = np.linalg.inv(table[np.ix_(on, columns)])
    rest = -back @ table[on]
    rest[:, columns] = back
    by = table[:, columns].copy()
    table[:, columns] = 0.0
    table += by @ rest
    table[on] = rest
    return table[:, 0], table[:, 1:]

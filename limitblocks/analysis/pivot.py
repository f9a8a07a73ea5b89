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
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from scipy import sparse

from limitblocks.analysis.complementarity import complementary
from limitblocks.analysis.eigenpairs import Pairs, pairs
from limitblocks.analysis.polish import admissible, defect, polished
from limitblocks.arrays import Array
from limitblocks.evidence.factors import diagonal_factors
from limitblocks.evidence.residuals import TOLERANCE
from limitblocks.problem import Flow, State

PROXIMAL = (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-8)  # delta of the steps
LARGEST = 400  # pairs that are not plain
WIDENED = 6  # times that rows join in a step

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
    unsure = np.zeros(len(linear.pairs.slack), dtype=bool)
    for _ in range(WIDENED):
        if np.count_nonzero(unsure) > largest:
            return None
        try:
            found = linear.solved(unsure)
        except (RuntimeError, ValueError):  # SuperLU: singular, or not finite
            return None
        if found is None or not found.violated.any():
            break
        unsure = unsure | found.violated
    return None if found is None else admissible(flow.problem.cones, found.state)


class _Solved(NamedTuple):
    """The end of a step, and the plain pairs that it violates."""

    state: State
    violated: Mask


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

    def solved(self, unsure: Mask) -> _Solved | None:
        """The end of the step with these pairs open, and the others as they are."""
        p, pair, k = self.flow.problem, self.pairs, int(np.count_nonzero(unsure))
        tight, signed = (pair.signed < 0.0) & ~unsure, pair.signed
        held = sparse.csr_array(sparse.vstack([pair.rows[tight], pair.across]))
        ends = self._ends(tight, held, pair.rows[unsure])
        n, m = p.C.shape
        F = sparse.csr_array(pair.rows[unsure] @ p.F)
        q = F @ ends[:n, k] + pair.rows[unsure] @ p.g
        M = F @ ends[:n, :k] + self.delta * np.eye(k)
        q = q - self.delta * np.maximum(pair.multiplier[unsure], 0.0)
        if not np.isfinite(M).all():
            return None
        found = complementary(q, M, np.maximum(signed[unsure], 0.0), np.maximum(-signed[unsure], 0.0))
        if found is None:
            return None
        end = ends[:, k] + ends[:, :k] @ found[1]
        y = pair.rows[unsure].T @ found[1] + held.T @ end[n + m + 1 :]
        state = State(float(end[n + m]), end[:n], end[n : n + m] / self.sigma, y / self.sigma)
        slack = pair.rows @ (p.F @ state.x + p.g)
        least = -TOLERANCE * max(1.0, float(np.abs(slack).max()))
        violated = (slack < least) & ~tight & ~unsure
        violated[np.flatnonzero(tight)[end[n + m + 1 :][: np.count_nonzero(tight)] < least]] = True
        return _Solved(state, violated)

    def _ends(self, tight: Mask, held: sparse.csr_array, unsure: sparse.csr_array) -> Array:
        """(x, sigma u, load factor, multipliers of what is held) by unit multipliers (k), and without any."""
        p, now, delta, sigma = self.flow.problem, self.now, self.delta, self.sigma
        G, live = self.flow.matrix(now.x), sparse.csr_array(p.live[:, None])
        n = p.C.shape[0]
        turn = None if self.flow.constant else self.flow.derivative(now.x, sigma * now.y)
        kappa = np.concatenate([np.zeros(np.count_nonzero(tight)), self.pairs.kappa])
        blocks: list[list[Any]] = [
            [turn, -p.C, None, -sparse.csr_array(G.T @ held.T)],
            [sparse.csr_array(p.C.T), None, -live, None],
            [None, live.T, None, None],
            [sparse.csr_array(held @ p.F), None, None, sparse.diags_array(kappa)],
        ]
        J = sparse.block_array(blocks, format="csc")
        J = sparse.csc_array(J + delta * sparse.eye_array(J.shape[0]))
        multipliers = np.concatenate([self.pairs.multiplier[tight], self.pairs.across @ (sigma * now.y)])
        before = np.concatenate([now.x, sigma * now.u, [now.load_factor], multipliers])
        known = np.concatenate([np.zeros(n), p.dead, [sigma], -(held @ p.g)])
        if turn is not None:
            known[:n] += turn @ now.x
        units = np.zeros((len(known), unsure.shape[0]))
        units[:n] = (G.T @ unsure.T).toarray()
        right = np.column_stack([units, known + delta * before])
        lu = diagonal_factors(J)
        ends = lu.solve(right)
        return np.asarray(ends + lu.solve(right - J @ ends))

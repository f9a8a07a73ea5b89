"""Whether the mechanism of a pair of bounds is the only one."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from limitblocks.analysis.conic import Conic
from limitblocks.analysis.direct import FIXED, solution
from limitblocks.analysis.programs import DIRECT
from limitblocks.arrays import Array, Indices
from limitblocks.evidence.mechanism import APEX_DIRECTIONS, sparse_columns
from limitblocks.problem import Cones, LimitProblem, State
from limitblocks.problem.cones import rays

YIELDING = 1e-6  # of the largest strain rate: less is no flow
READY = 1e-5  # of the terms of the rows of an interface: one with less to spare yields, and may flow
MOVES = 1e-4  # of the rows that begin to flow by 1 at most: less is no motion of the blocks
SINGULAR = 1e-8  # least eigenvalue over the diagonal, below which another mechanism exists
ROUNDS = 8  # of the inverse power method
REGULAR = 1e-13


@dataclass(frozen=True, eq=False)
class Yielding:
    """The rows that flow in a state, and what follows from them for all pairs of bounds.

    Parameters
    ----------
    problem : LimitProblem
        The structure.
    state : State
        A pair of bounds, dimensionless.
    """

    problem: LimitProblem
    state: State

    @cached_property
    def _flowing(self) -> tuple[sparse.csr_array, Any, Any]:
        """Directions of flow, of unit length, of what flows, shape (k, s); what flows, and what at an apex.

        A cone whose flow is within the dual one is at its apex, where the flow may turn: each row is one.
        """
        p, cones, y = self.problem, self.problem.cones, self.state.y
        weights = np.append(np.ones(cones.linear), y[cones.linear :])
        members = sparse.coo_array((weights, (cones.member, np.arange(len(y))))).tocsr()
        flows = sparse.csr_array(members @ p.F)
        rates = np.append(y[: cones.linear], np.ones(cones.degree - cones.linear))
        strain = rates * abs(flows).max(axis=1).toarray().ravel()
        least = YIELDING * max(float(strain.max()), np.finfo(float).tiny)
        apex = cones.margin(y) * abs(p.F).max() > least
        apex[: cones.linear] = False
        turning = p.F[np.flatnonzero(apex[cones.member])]
        active = sparse.vstack([flows[np.flatnonzero((strain > least) & ~apex)], turning], format="csr")
        return _of_unit_length(active), strain > least, apex

    @cached_property
    def flows(self) -> sparse.csr_array:
        """Directions of flow, of unit length, of what flows, shape (k, s): one of a linear row or a cone."""
        return self._flowing[0]

    @cached_property
    def ready(self) -> sparse.csr_array:
        """The same of what yields but does not flow, shape (k, s): it may do so in another mechanism.

        A cone with stresses at its apex may also flow along other rays than one on the boundary.
        """
        (p, cones, x), (_, flows, turns) = (self.problem, self.problem.cones, self.state.x), self._flowing
        z, terms = p.F @ x + p.g, abs(p.F) @ np.abs(x) + np.abs(p.g)
        most = np.zeros(len(p.interfaces))
        np.maximum.at(most, p.row_interface, terms)
        some = READY * most[p.row_interface[cones.heads]]
        apex = z[cones.heads] <= some
        yields = (cones.margin(z) <= some) & ~turns & (~flows | apex)
        linear = np.flatnonzero((yields & ~flows)[: cones.linear])
        parts: list[tuple[Indices, Array]] = [(linear[:, None], np.ones((len(linear), 1, 1)))]
        for group in cones.groups:
            its, every = cones.member[group[:, 0]], rays(group.shape[1], APEX_DIRECTIONS)
            on, at = group[yields[its] & ~apex[its]], group[yields[its] & apex[its]]
            along = np.concatenate([z[on[:, :1]], -z[on[:, 1:]]], axis=1)
            parts.append((on, along[:, None]))
            parts.append((at, np.broadcast_to(every, (len(at), *every.shape))))
        return _of_unit_length(sparse.csr_array(sparse_columns(parts, len(z)).T @ p.F))

    @cached_property
    def _factors(self) -> tuple[Any, float]:
        """Factors of the matrix of rates and multipliers, which is sparse; and its scale."""
        p, D = self.problem, self.flows
        live = sparse.csr_array(p.live[None])
        rates = sparse.csr_array(p.C.T @ p.C + live.T @ live)
        scale, across = float(rates.diagonal().max()), D @ p.C
        first = rates + REGULAR * scale * sparse.eye_array(rates.shape[0])
        second = D @ D.T + REGULAR * sparse.eye_array(D.shape[0])
        return linalg.splu(sparse.csc_array(sparse.block_array([[first, across.T], [across, second]]))), scale

    @property
    def alone(self) -> bool:
        """Whether no other rates of live work 1 follow the flow of what flows and of what yields."""
        return self._follows and not self._begins

    @property
    def _follows(self) -> bool:
        """Whether no other rates follow the flow of what flows alone.

        With P the projection to the directions of flow, (1 - P) C u = 0 and live.u = 0 leave u = 0: the least
        eigenvalue of C^T (1 - P) C + live live^T, by the inverse power method.
        """
        lu, scale = self._factors
        v = np.random.default_rng(0).standard_normal(self.problem.C.shape[1])
        rest, eigenvalue = np.zeros(self.flows.shape[0]), np.inf
        for _ in range(ROUNDS):
            v /= np.linalg.norm(v)
            onward = lu.solve(np.append(v, rest))[: len(v)]
            eigenvalue, v = 1.0 / abs(float(v @ onward)), onward
        return bool(eigenvalue > SINGULAR * scale)

    @property
    def _begins(self) -> bool:
        """Whether other rates follow where rows that yield without flowing begin to flow, dy >= 0.

        C du = -D^T dy, live.du = 0, of which both programs find rates along a direction if there are any.
        """
        p, D, N = self.problem, self.flows, self.ready
        live, n, k = sparse.csr_array(p.live[None]), p.C.shape[1], N.shape[0]
        blocks: list[list[Any]] = [[p.C, D.T, N.T], [live, None, None]]
        equal: sparse.coo_array = sparse.block_array(blocks)
        size = equal.shape[1]
        begins = sparse.eye_array(k, size, k=size - k)
        rows = sparse.csc_array(sparse.vstack([equal, begins, -begins]))
        ends = np.concatenate([np.zeros(equal.shape[0]), np.ones(k), np.zeros(k)])
        along = np.pad(np.random.default_rng(0).standard_normal(n), (0, size - n))
        for cost in (along, -along):
            found = np.array(solution(Conic(cost, rows, ends, Cones(2 * k)), DIRECT.settings | FIXED).x)
            if not cost @ found >= -MOVES:  # or not a number
                return True
        return False


def _of_unit_length(rows: sparse.csr_array) -> sparse.csr_array:
    size = np.sqrt(rows.multiply(rows).sum(axis=1))
    return sparse.csr_array(sparse.diags_array(1.0 / size) @ rows)

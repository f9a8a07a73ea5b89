"""Whether the mechanism of a pair of bounds is the only one."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from limitblocks.problem import LimitProblem, State

YIELDING = 1e-6  # of the largest strain rate: less is no flow
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
    def flows(self) -> sparse.csr_array:
        """Directions of flow, of unit length, of what yields, shape (k, s): one of a linear row or a cone.

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
        size = np.sqrt(active.multiply(active).sum(axis=1))
        return sparse.csr_array(sparse.diags_array(1.0 / size) @ active)

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
        """Whether no other rates follow the flow of the rows that yield and do the live work 1.

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

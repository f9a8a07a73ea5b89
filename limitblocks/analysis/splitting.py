"""States strictly within a cone by splitting: stresses under the dead loads, mechanisms that open joints.

The rows F x of stresses without loads and the multipliers of mechanisms are spaces normal to each other, and
K is its own dual: one projection serves both. Douglas-Rachford splitting reflects at the cone and at the
space in turn until a point of the space is within the cone (Lions & Mercier 1979, Splitting algorithms for
the sum of two nonlinear operators, SIAM Journal on Numerical Analysis 16), and a step goes beyond (Eckstein &
Bertsekas 1992, Mathematical Programming 55). Room is asked for, not accuracy: that takes a few rounds, each
with one solution of linear equations that are factorised once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse

from limitblocks.analysis.scales import Projection, Scaled, compatible
from limitblocks.arrays import Array, Flags, owned
from limitblocks.problem import LimitProblem

ROUNDS = 200
FEW = 60  # for stresses: those that take more have little room, and one program finds more
ROOM = 0.1  # that stresses are asked for at first, in the units of the rows
LESS = 0.9  # times the room each round: there may be little
SHARE = 0.5  # of the room asked for that is enough
RELAXED = 1.7  # of 0 to 2: about a third fewer rounds than with 1, docs/solvers.md


@dataclass(frozen=True, eq=False)
class Splitting:
    """Projections of a problem in its units, and strictly admissible states."""

    p: Scaled

    @cached_property
    def projection(self) -> Projection:
        """Onto equilibrium; the distance is that of the yield rows."""
        square = self.p.F.T @ self.p.F
        if square.nnz == np.count_nonzero(square.diagonal()) == square.shape[0]:  # every row is one stress
            return Projection(self.p.C, sparse.csr_array(sparse.diags_array(1.0 / square.diagonal())))
        weights = inverse_by_interfaces(self.p.problem, square)
        weights.eliminate_zeros()  # between the points of an interface
        return Projection(self.p.C, weights)

    def at(self, carries: Flags) -> Projection:
        """Onto equilibrium, by the stresses that carry anything (s,); the others keep what they have."""
        if carries.all():
            return self.projection
        kept = sparse.diags_array(1.0 * carries)
        return Projection(self.p.C, sparse.csr_array(kept @ self.projection.weights @ kept))

    def stresses(self) -> Array | None:
        """Return stresses strictly within yield under the dead loads, (s,); None where none were found."""
        p = self.p
        rows = self._within(
            lambda rows: p.F @ self._nearest(rows - p.g, p.dead)[0] + p.g, ROOM * p.cones.identity, FEW, LESS
        )
        return None if rows is None else self._nearest(rows - p.g, p.dead)[0]

    def mechanism(self, amount: Array) -> tuple[Array, Array] | None:
        """Return rates and multipliers that open joints by about `amount` (R,); None if none were found."""
        F, nothing, u = self.p.F, np.zeros_like(self.p.dead), np.zeros_like(self.p.dead)

        def following(rows: Array) -> Array:
            nonlocal u
            x, u = self._nearest(rows, nothing)
            return np.asarray(rows - F @ x)

        y = self._within(following, amount, ROUNDS)
        return None if y is None else (u, y)

    def following(self, u: Array, y: Array) -> Array:
        """Return the nearest multipliers that follow the rates, to rounding, brought into K."""
        return compatible(self.p, u, y, lambda strain: np.asarray(self.projection.weights @ strain))

    def _nearest(self, rows: Array, loads: Array) -> tuple[Array, Array]:
        """Stresses under the loads, F x nearest to `rows`; rates u with C u = -F^T (rows - F x)."""
        return self.projection.nearest(loads, self._inverse @ rows)

    @cached_property
    def _inverse(self) -> sparse.csr_array:
        """The stresses whose rows F x are nearest to given ones, shape (s, R)."""
        return sparse.csr_array(self.projection.weights @ self.p.F.T)

    def _within(
        self, onto: Callable[[Array], Array], room: Array, rounds: int, less: float = 1.0
    ) -> Array | None:
        """Point of a space, projected `onto`, in K with a share of the `room` (R,), `less` each round."""
        cones, z = self.p.cones, room
        for _ in range(rounds):
            inner = room + cones.nearest(z - room)
            found = onto(2.0 * inner - z)
            if (cones.margin(found) > SHARE * room[cones.heads]).all():
                return found
            z, room = z + RELAXED * (found - inner), less * room
        return None


def inverse_by_interfaces(problem: LimitProblem, matrix: sparse.csr_array) -> sparse.csr_array:
    """Return the inverse of a symmetric matrix that couples the stresses of one interface only.

    The pseudoinverse if one is singular. Interfaces with fewer stresses are padded with ones.
    """
    interface = problem.stress_interface
    table, place = owned(interface, len(problem.interfaces))
    there = table < len(place)
    blocks = np.eye(table.shape[1]) * ~there[:, :, None]
    entries = matrix.tocoo()
    rows, columns = entries.coords
    blocks[interface[rows], place[rows], place[columns]] += entries.data
    try:
        inverse = np.linalg.inv(blocks)
    except np.linalg.LinAlgError:  # a joint is 1e10 times as strong as its loads
        inverse = np.linalg.pinv(blocks, hermitian=True)
    inside = there[:, :, None] & there[:, None]
    own = [np.broadcast_to(part, inside.shape)[inside] for part in (table[:, :, None], table[:, None])]
    return sparse.coo_array((inverse[inside], tuple(own)), shape=matrix.shape).tocsr()

"""States strictly within a cone by splitting: stresses under the dead loads, mechanisms that open joints.

The rows F x of stresses without loads and the multipliers of mechanisms are spaces normal to each other, and
K is its own dual: one projection serves both. Douglas-Rachford splitting reflects at the cone and at the
space in turn until a point of the space is within the cone (Lions & Mercier 1979, Splitting algorithms for
the sum of two nonlinear operators, SIAM Journal on Numerical Analysis 16). Room is asked for, not accuracy:
that takes a few rounds, each with one solution of linear equations that are factorised once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse
from scipy.sparse import csgraph

from limitblocks.analysis.scales import Projection, Scaled
from limitblocks.arrays import Array

ROUNDS = 200
ROOM = 0.1  # that stresses are asked for at first, in the units of the rows
LESS = 0.9  # times the room each round: there may be little
SHARE = 0.5  # of the room asked for that is enough


@dataclass(frozen=True, eq=False)
class Splitting:
    """Projections of a problem in its units, and strictly admissible states."""

    p: Scaled

    @cached_property
    def projection(self) -> Projection:
        """Onto equilibrium; the distance is that of the yield rows."""
        F = self.p.F
        return Projection(self.p.C, inverse_of_blocks(F.T @ F))

    def stresses(self) -> Array | None:
        """Return stresses strictly within yield under the dead loads, (s,); None where none were found."""
        p = self.p
        rows = self._within(
            lambda rows: p.F @ self._nearest(rows - p.g, p.dead)[0] + p.g, ROOM * p.cones.identity, LESS
        )
        return None if rows is None else self._nearest(rows - p.g, p.dead)[0]

    def mechanism(self, amount: Array) -> tuple[Array, Array] | None:
        """Return rates and multipliers that open joints by about `amount` (R,); None if none were found."""
        F, nothing = self.p.F, np.zeros_like(self.p.dead)
        y = self._within(lambda y: y - F @ self._nearest(y, nothing)[0], amount)
        return None if y is None else (self._nearest(y, nothing)[1], y)

    def following(self, u: Array, y: Array) -> Array:
        """Return the nearest multipliers that follow the rates, to rounding, brought into K."""
        p = self.p
        for _ in range(2):
            y = y - p.F @ (self.projection.weights @ (p.C @ u + p.F.T @ y))
        return p.raised(y)

    def _nearest(self, rows: Array, loads: Array) -> tuple[Array, Array]:
        """Stresses under the loads, F x nearest to `rows`; rates u with C u = -F^T (rows - F x)."""
        return self.projection.nearest(loads, self._inverse @ rows)

    @cached_property
    def _inverse(self) -> sparse.csr_array:
        """The stresses whose rows F x are nearest to given ones, shape (s, R)."""
        return sparse.csr_array(self.projection.weights @ self.p.F.T)

    def _within(self, onto: Callable[[Array], Array], room: Array, less: float = 1.0) -> Array | None:
        """Point of a space, projected `onto`, in K with a share of the `room` (R,), `less` each round."""
        cones, z = self.p.cones, room
        for _ in range(ROUNDS):
            inner = room + cones.nearest(z - room)
            found = onto(2.0 * inner - z)
            if (cones.margin(found) > SHARE * room[cones.heads]).all():
                return found
            z, room = z + found - inner, less * room
        return None


def inverse_of_blocks(H: sparse.csr_array) -> sparse.csr_array:
    """Return the inverse of a matrix of small blocks on the diagonal, in any order."""
    entries = H.tocoo()
    entries.eliminate_zeros()
    _, owner = csgraph.connected_components(entries, directed=False)
    n, size = len(owner), np.bincount(owner)
    place = np.empty(n, dtype=np.int64)
    place[np.argsort(owner, kind="stable")] = np.arange(n) - np.repeat(np.cumsum(size) - size, size)
    index = np.full((len(size), size.max()), -1)
    index[owner, place] = np.arange(n)
    blocks = (index < 0)[:, :, None] * np.eye(size.max())
    blocks[owner[entries.row], place[entries.row], place[entries.col]] = entries.data
    k, i, j = np.nonzero((index >= 0)[:, :, None] & (index >= 0)[:, None, :])
    return sparse.csr_array((np.linalg.inv(blocks)[k, i, j], (index[k, i], index[k, j])), shape=H.shape)

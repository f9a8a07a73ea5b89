"""Where the numbers of a path go: dense blocks of interfaces and the fixed pattern of the matrix left over.

The stresses and rows of an interface couple with those of no other one; eliminated by interfaces, what is
left couples the rates of neighbouring blocks and the load factor. All index maps are made once a problem.
"""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array, Indices, owned
from limitblocks.evidence.factors import diagonal_factors
from limitblocks.problem import Flow, LimitProblem


@dataclass(frozen=True, eq=False)
class Layout:
    """Index maps of a limit problem; interfaces with fewer stresses, rows or free blocks are padded."""

    flow: Flow

    @property
    def problem(self) -> LimitProblem:
        """The limit problem."""
        return self.flow.problem

    @cached_property
    def balance(self) -> sparse.csr_array:
        """C^T, shape (6 n, s)."""
        return sparse.csr_array(self.problem.C.T)

    @cached_property
    def _constant(self) -> tuple[sparse.csr_array, Array]:
        return self._potentials(np.zeros(len(self.stress_place)))

    def _potentials(self, x: Array) -> tuple[sparse.csr_array, Array]:
        G = self.flow.matrix(x)
        return sparse.csr_array(G.T), np.swapaxes(self.by_interface(self.rows(G)), 1, 2)

    def potential(self, x: Array) -> sparse.csr_array:
        """Return G(x)^T, shape (s, R)."""
        return (self._constant if self.flow.constant else self._potentials(x))[0]

    def potential_parts(self, x: Array) -> Array:
        """Return G(x)^T of each interface, shape (m, k, r)."""
        return (self._constant if self.flow.constant else self._potentials(x))[1]

    @cached_property
    def interfaces(self) -> int:
        """Number of interfaces."""
        return len(self.problem.interfaces)

    @cached_property
    def _owned_stresses(self) -> tuple[Indices, Indices]:
        return owned(self.problem.stress_interface, self.interfaces)

    @property
    def stresses(self) -> Indices:
        """Stresses of each interface, shape (m, k); s where there is none."""
        return self._owned_stresses[0]

    @property
    def stress_place(self) -> Indices:
        """Place of each stress in its interface, shape (s,)."""
        return self._owned_stresses[1]

    @cached_property
    def padding(self) -> Array:
        """Ones on the diagonals of places without a stress, shape (m, k, k)."""
        empty = self.stresses == len(self.stress_place)
        return np.asarray(np.eye(empty.shape[1]) * empty[:, :, None])

    @cached_property
    def coupled(self) -> int:
        """Number of stresses in turn that rows couple: 3 where all are those of contact points, else k."""
        k, cones = int(self.stresses.shape[1]), self.problem.cones
        if not self.flow.constant:
            return k
        acts = (self.yield_rows != 0.0) | (
            self.rows(self.flow.matrix(np.zeros(len(self.stress_place)))) != 0.0
        )
        first, last = np.full(cones.degree, k), np.zeros(cones.degree, dtype=int)
        row, place = np.nonzero(acts)
        np.minimum.at(first, cones.member[row], place)
        np.maximum.at(last, cones.member[row], place)
        sizes = (size for size in range(1, k) if k % size == 0 and (last // size <= first // size).all())
        return next(sizes, k)

    def uncoupled(self, parts: Array) -> Array:
        """Return the diagonal blocks of parts (m, k, k) that rows couple, not copied, (b, m, size, size)."""
        size, k = self.coupled, parts.shape[1]
        each = parts.reshape(len(parts), k // size, size, k // size, size)
        return np.asarray(np.einsum("mbibj->bmij", each))

    @cached_property
    def _owned_rows(self) -> tuple[Indices, Indices]:
        return owned(self.problem.row_interface, self.interfaces)

    @property
    def interface_rows(self) -> Indices:
        """Rows of each interface, shape (m, r); R where there is none."""
        return self._owned_rows[0]

    @property
    def row_place(self) -> Indices:
        """Place of each row in its interface, shape (R,)."""
        return self._owned_rows[1]

    def rows(self, matrix: sparse.csr_array) -> Array:
        """Return the rows of a (R, s) matrix in the places of their own interface, shape (R, k)."""
        local, entries = np.zeros((matrix.shape[0], self.stresses.shape[1])), matrix.tocoo()
        local[entries.row, self.stress_place[entries.col]] = entries.data
        return local

    def by_interface(self, rows: Array) -> Array:
        """Return rows (R, k) gathered by interface, shape (m, r, k)."""
        return np.concatenate([rows, np.zeros_like(rows[:1])]).take(self.interface_rows, axis=0)

    @cached_property
    def yield_rows(self) -> Array:
        """Rows of F, shape (R, k)."""
        return self.rows(self.problem.F)

    @cached_property
    def rates(self) -> Indices:
        """Rates that move each interface, shape (m, d); 6 n where there is none."""
        entries = self.problem.C.tocoo()
        n = self.problem.C.shape[1]
        pairs = np.unique(self.problem.stress_interface[entries.row] * n + entries.col)
        owner, rate = pairs // n, pairs % n
        return np.append(rate, n)[owned(owner, self.interfaces)[0]]

    @cached_property
    def compatibility(self) -> Array:
        """C of each interface, shape (m, k, d)."""
        m, n = self.interfaces, self.problem.C.shape[1]
        lookup = np.full((m, n + 1), -1)
        lookup[np.arange(m)[:, None], self.rates] = np.arange(self.rates.shape[1])
        parts = np.zeros((m, self.stresses.shape[1], self.rates.shape[1]))
        entries = self.problem.C.tocoo()
        k = self.problem.stress_interface[entries.row]
        parts[k, self.stress_place[entries.row], lookup[k, entries.col]] = entries.data
        return parts

    @cached_property
    def _pattern(self) -> tuple[Any, Indices, Indices, Indices, Indices, Indices]:
        """Ordered pattern of [[-K, live], [live^T, 0]], places of K's parts and live in it, the ordering.

        And those on the diagonal of rates that move nothing, out of the plane of a planar problem.
        """
        n, d = self.problem.C.shape[1], self.rates.shape[1]
        shape = (self.interfaces, d, d)
        i = np.broadcast_to(self.rates[:, :, None], shape).ravel()
        j = np.broadcast_to(self.rates[:, None, :], shape).ravel()
        inside = np.flatnonzero((i < n) & (j < n))
        loaded = np.flatnonzero(self.problem.live)
        end = np.full(len(loaded), n)
        row = np.concatenate([i[inside], np.arange(n + 1), loaded, end])
        column = np.concatenate([j[inside], np.arange(n + 1), end, loaded])
        order = self._ordering(row, column)
        places, at = np.unique(order[column] * (n + 1) + order[row], return_inverse=True)
        pattern = sparse.csc_array(
            (np.ones(len(places)), (places % (n + 1), places // (n + 1))), shape=(n + 1, n + 1)
        )
        still = np.setdiff1d(np.arange(n), self.problem.C.indices[self.problem.C.data != 0.0])
        border = at[len(inside) + n + 1 :]
        return pattern, inside, at[: len(inside)], border, at[len(inside) + still], order

    def _ordering(self, row: Indices, column: Indices) -> Indices:
        """Where each unknown goes so that factors stay sparse, found once for all points of a path."""
        n = int(row.max()) + 1
        matrix = sparse.coo_array((np.ones(len(row)), (row, column)), shape=(n, n)).tocsc()
        dominant = sparse.csc_array(matrix + abs(matrix).sum() * sparse.eye_array(n))
        return np.asarray(diagonal_factors(dominant).perm_c)

    def factors(self, parts: Array) -> Any:
        """Return the factors of [[-K, live], [live^T, 0]] of the stiffness parts (m, d, d)."""
        pattern, inside, at, border, idle, _ = self._pattern
        data = -np.bincount(at, weights=parts.ravel()[inside], minlength=pattern.nnz)
        live = self.problem.live[self.problem.live != 0.0]
        data[border] = np.concatenate([live, live])
        data[idle] = -1.0
        if not np.isfinite(data).all():  # BLAS would print that it is illegal
            raise np.linalg.LinAlgError("the stiffness of a point that ran away is not finite")
        matrix = copy(pattern)  # which is checked once
        matrix.data = data
        return diagonal_factors(matrix, "NATURAL")

    def solved(self, lu: Any, right: Array) -> Array:
        """Return the solution of those factors for a right-hand side (6 n + 1,), or several (6 n + 1, c)."""
        order = self._pattern[-1]
        ordered = np.empty_like(right)
        ordered[order] = right
        return np.asarray(lu.solve(ordered).take(order, axis=0))

    @cached_property
    def _stress_at(self) -> Indices:
        return np.asarray(self.problem.stress_interface * self.stresses.shape[1] + self.stress_place)

    @cached_property
    def _row_at(self) -> Indices:
        return np.asarray(self.problem.row_interface * self.interface_rows.shape[1] + self.row_place)

    def per_interface(self, x: Array) -> Array:
        """Return stresses (s,) or (s, c) by interface, shape (m, k) or (m, k, c)."""
        return np.concatenate([x, np.zeros_like(x[:1])]).take(self.stresses, axis=0)

    def per_stress(self, blocks: Array) -> Array:
        """Return what stands by interface (m, k, c) as stresses (s, c)."""
        return _flat(blocks).take(self._stress_at, axis=0)

    def per_row(self, blocks: Array) -> Array:
        """Return what stands by interface (m, r, c) as rows (R, c)."""
        return _flat(blocks).take(self._row_at, axis=0)


def _flat(blocks: Array) -> Array:
    return blocks.reshape(-1, blocks.shape[2])

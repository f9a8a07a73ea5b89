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
import numpy.typing as npt
from scipy import sparse

from limitblocks.arrays import Array, Indices, owned
from limitblocks.evidence.elimination import Factors, rates_in_order
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
        return sparse.csr_array(G.T), np.swapaxes(self.by_cell(self.rows(G)), 1, 2)

    def potential(self, x: Array) -> sparse.csr_array:
        """Return G(x)^T, shape (s, R)."""
        return (self._constant if self.flow.constant else self._potentials(x))[0]

    def potential_parts(self, x: Array) -> Array:
        """Return G(x)^T of each cell, shape (cells, size, r)."""
        return (self._constant if self.flow.constant else self._potentials(x))[1]

    @cached_property
    def sliding(self) -> npt.NDArray[np.bool_]:
        """Whether each row or cone flows otherwise than along its normal, shape (degree,)."""
        p = self.problem
        across = abs(p.F - self.flow.matrix(np.zeros(len(self.stress_place)))).sum(axis=1) > 0.0
        return np.asarray(np.bincount(p.cones.member, across) > 0.0)

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
    def coupled(self) -> int:
        """Size of a cell, stresses in turn that rows couple: 3 where all are of contact points, else k."""
        k = int(self.stresses.shape[1])
        if not self.flow.constant:
            return k
        first, last = self._reach
        sizes = (size for size in range(1, k) if k % size == 0 and (last // size <= first // size).all())
        return next(sizes, k)

    @cached_property
    def _reach(self) -> tuple[Indices, Indices]:
        """First and last place in its interface that each row or cone acts on, shapes (degree,)."""
        cones, k = self.problem.cones, int(self.stresses.shape[1])
        first, last = np.full(cones.degree, k), np.zeros(cones.degree, dtype=int)
        for matrix in (self.problem.F, self.flow.matrix(np.zeros(len(self.stress_place)))):
            entries = matrix.tocoo()
            acts = entries.data != 0.0
            member, place = cones.member[entries.row[acts]], self.stress_place[entries.col[acts]]
            np.minimum.at(first, member, place)
            np.maximum.at(last, member, place)
        return np.minimum(first, last), last

    @cached_property
    def cell_stresses(self) -> Indices:
        """Stresses of each cell, shape (cells, size); s where there is none."""
        return self.stresses.reshape(-1, self.coupled)

    @cached_property
    def padding(self) -> Array:
        """Ones on the diagonals of places without a stress, shape (cells, size, size)."""
        empty = self.cell_stresses == len(self.stress_place)
        return np.asarray(np.eye(empty.shape[1]) * empty[:, :, None])

    @cached_property
    def _cell_rows(self) -> Indices:
        """Rows of each cell, shape (cells, r); R where there is none."""
        per_interface = self.stresses.shape[1] // self.coupled
        inside = (self._reach[0] // self.coupled)[self.problem.cones.member] if per_interface > 1 else 0
        cell = self.problem.row_interface * per_interface + inside
        return owned(cell, len(self.cell_stresses))[0]

    def rows(self, matrix: sparse.csr_array) -> Array:
        """Return the rows of a (R, s) matrix in the places of their own cell, shape (R, size)."""
        local, entries = np.zeros((matrix.shape[0], self.coupled)), matrix.tocoo()
        acts = entries.data != 0.0
        local[entries.row[acts], self.stress_place[entries.col[acts]] % self.coupled] = entries.data[acts]
        return local

    def by_cell(self, rows: Array) -> Array:
        """Return rows (R, size) gathered by cell, shape (cells, r, size)."""
        return np.concatenate([rows, np.zeros_like(rows[:1])]).take(self._cell_rows, axis=0)

    def per_cell(self, x: Array) -> Array:
        """Return stresses (s,) by cell, shape (cells, size)."""
        return np.append(x, 0.0).take(self.cell_stresses)

    def by_interface(self, cells: Array) -> Array:
        """Return matrices of cells (cells, size, size) as diagonal blocks of interfaces, shape (m, k, k)."""
        m, k, size = self.interfaces, self.stresses.shape[1], self.coupled
        blocks = np.zeros((m, k // size, size, k // size, size))
        np.einsum("mbibj->mbij", blocks)[:] = cells.reshape(m, -1, size, size)
        return blocks.reshape(m, k, k)

    @cached_property
    def yield_rows(self) -> Array:
        """Rows of F, shape (R, size)."""
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
    def _pattern(self) -> tuple[Any, sparse.csr_array, Indices]:
        """[[0, live], [live^T, 0]] in the order of elimination, what takes parts of K to its data, the order.

        Rates that move nothing, out of the plane of a planar problem, are left out, and the load factor where
        there is no live load.
        """
        live, n, d = self.problem.live, self.problem.C.shape[1], self.rates.shape[1]
        moving = np.zeros(n + 1, dtype=bool)
        moving[self.problem.C.indices[self.problem.C.data != 0.0]] = True
        moving[n] = live.any()
        order = rates_in_order(self.problem)
        order = order[moving[order]]
        number, size = np.full(n + 1, -1), len(order)
        number[order] = np.arange(size)
        loaded, end = np.flatnonzero(moving[:n] & (live != 0.0)), number[n]
        number[n] = -1  # of what is no rate of an interface
        shape, rates = (self.interfaces, d, d), number[self.rates]
        i = np.broadcast_to(rates[:, :, None], shape).ravel()
        j = np.broadcast_to(rates[:, None, :], shape).ravel()
        inside, end = np.flatnonzero((i >= 0) & (j >= 0)), np.full(len(loaded), end)
        row = np.concatenate([np.arange(size), number[loaded], end, i[inside]])
        column = np.concatenate([np.arange(size), end, number[loaded], j[inside]])
        places, at = np.unique(column * size + row, return_inverse=True)
        constant = np.concatenate([np.zeros(size), live[loaded], live[loaded]])
        data, at = np.bincount(at[: len(constant)], constant, len(places)), at[len(constant) :]
        pattern = sparse.csc_array((data, (places % size, places // size)), shape=(size, size))
        assembly = sparse.csr_array((np.ones(len(at)), (at, inside)), shape=(len(places), i.size))
        return pattern, assembly, order

    def factors(self, parts: Array) -> Factors:
        """Return the factors of [[-K, live], [live^T, 0]] of the stiffness parts (m, d, d)."""
        pattern, assembly, order = self._pattern
        data = pattern.data - assembly @ parts.ravel()
        matrix = copy(pattern)  # which is checked once
        matrix.data = data
        return Factors(diagonal_factors(matrix, "NATURAL"), order)

    @cached_property
    def _stress_at(self) -> Indices:
        return np.asarray(self.problem.stress_interface * self.stresses.shape[1] + self.stress_place)

    def per_interface(self, x: Array) -> Array:
        """Return stresses (s,) or (s, c) by interface, shape (m, k) or (m, k, c)."""
        return np.concatenate([x, np.zeros_like(x[:1])]).take(self.stresses, axis=0)

    def per_stress(self, blocks: Array) -> Array:
        """Return what stands by interface (m, k, c) as stresses (s, c)."""
        return blocks.reshape(-1, blocks.shape[2]).take(self._stress_at, axis=0)

"""How far the exact state may lie from a computed one, and whether it has the room in the cone.

The theorems of limit analysis ask for exact equilibrium and for mechanisms that satisfy the flow rule
exactly; a state in floating point does neither, but is shown to lie near one that does:

- *static*. What the stresses x leave unbalanced, rounding errors included, is carried to the supports along
  a spanning tree: dx with C^T (x + dx) = dead + a live exists, and its size is bounded block by block.
- *kinematic*. What C u + F^T y leaves at an interface is made up by multipliers dy of its own rows.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from limitblocks.arrays import Array, Indices, equal_rows, in_blocks, owned
from limitblocks.evidence.rounding import EPS, UP, Products, products, size_of
from limitblocks.evidence.spanning_tree import Tree
from limitblocks.problem import LimitProblem
from limitblocks.problem.cones import lengths

POOREST = 1e-3  # error of a right inverse beyond which nothing is claimed of it


@dataclass(frozen=True, eq=False)
class Reach:
    """`need` of each linear row and each cone, over the `room` it has; `change` bounds dx or dy in size.

    Where the room is at least the need everywhere, the exact state is admissible.
    """

    need: Array
    room: Array
    change: Array

    @property
    def proven(self) -> bool:
        """True if the exact state is admissible."""
        return bool((self.room >= self.need).all())

    def times(self, reserve: float) -> Reach:
        """The same with `reserve` times the need."""
        return Reach(reserve * self.need, self.room, reserve * self.change)


@dataclass(frozen=True, eq=False)
class Static:
    """How far stresses in exact equilibrium may lie from computed ones, by a tree of interfaces."""

    problem: LimitProblem
    tree: Tree

    def reach(self, load_factor: float, x: Array) -> Reach:
        """Of stresses x (s,) that shall balance dead + load_factor live."""
        p, push = self.problem, load_factor * self.problem.live
        residual, off = self._balance.of((-x,), p.dead, push)
        unbalanced = (np.abs(residual) + off + EPS * np.abs(push)) * UP
        change = self.carried(unbalanced.reshape(-1, 6))
        s, off = self._rows.of((x,), p.g)
        return Reach(*_in_cones(p, s, (self._rows.sizes[0] @ change + off) * UP), change)

    def carried(self, unbalanced: Array) -> Array:
        """Bound the size of stresses (s,) that carry forces within +-`unbalanced` (n, 6) along the tree."""
        places, right, share, ways = self._ways
        force = size_of(unbalanced)
        for block, there, transfer in ways:
            more = np.einsum("kij,kj->ki", transfer, force[block]).ravel()
            force = (force + np.bincount(there, more, force.size).reshape(force.shape)) * UP
        change = np.zeros(self.problem.C.shape[0] + 1)
        change[places] = np.einsum("kij,kj->ki", right, _exactly(force, share)) * UP
        if (force[~np.isfinite(share)] > 0.0).any():  # it cannot be carried, nor what it puts on others
            change[:] = np.inf
        return change[:-1]

    @cached_property
    def poor(self) -> Indices:
        """Blocks whose interface of the tree does not carry every force."""
        return np.flatnonzero(~np.isfinite(self._ways[2]))

    @cached_property
    def _balance(self) -> Products:
        return Products((self.problem.balance,))

    @cached_property
    def _rows(self) -> Products:
        return Products((self.problem.F,))

    @cached_property
    def _ways(self) -> tuple[Indices, Array, Array, list[tuple[Indices, Indices, Array]]]:
        """Stresses (n, S) of the tree's interfaces, sizes of what a force on the block needs of them, ways.

        Each of the ways has blocks, the equations of those 2^k steps behind, and how much (6, 6) of a force
        gets there: with T one step, 1 + T + T^2 + ... = (1 + T) (1 + T^2) (1 + T^4) ...
        """
        places, on_block, on_parent = _tree_matrices(self.problem, self.tree)
        right, share = _right_inverse(on_block)  # stresses that put a force on the block
        behind, off = products(on_parent, right)
        more = np.where(np.isfinite(share), share, 0.0)[:, None, None]
        transfer, parent = size_of((np.abs(behind) + off) @ (np.eye(6) + more) * UP * UP), self.tree.parent
        ways = []
        while (parent >= 0).any():
            k = np.flatnonzero(parent >= 0)
            ways.append((k, (6 * parent[k][:, None] + np.arange(6)).ravel(), transfer[k]))
            beyond = np.where(parent >= 0, parent[parent], -1)
            k = np.flatnonzero(beyond >= 0)
            twice = np.zeros_like(transfer)
            twice[k] = size_of(transfer[parent[k]] @ transfer[k] * UP)
            parent, transfer = beyond, twice
        return places, np.abs(right), share, ways


@dataclass(frozen=True, eq=False)
class Kinematic:
    """How far multipliers that satisfy the associated flow rule exactly may lie from computed ones."""

    problem: LimitProblem

    def reach(self, u: Array, y: Array) -> Reach:
        """Of multipliers y (R,) that shall follow the rates u."""
        strain, off = self._flow.of((u, y))
        change = self.made_up((np.abs(strain) + off) * UP)
        return Reach(*_in_cones(self.problem, y, change), change)

    def made_up(self, defect: Array) -> Array:
        """Bound the size of multipliers (R,) with F^T dy within +-`defect` (s,), interface by interface."""
        change = np.zeros(len(self.problem.g))
        for rows, columns, kind, right, share in self._inverses:
            strain = _exactly(defect[columns], share[kind])
            change[rows] = (strain[:, None] @ right.take(kind, axis=0))[:, 0] * UP
        return change

    @cached_property
    def _flow(self) -> Products:
        return Products((self.problem.C, self.problem.F.T))

    @cached_property
    def _inverses(self) -> list[tuple[Indices, Indices, Indices, Array, Array]]:
        """Rows (K, r) and stresses (K, c) of interfaces of one shape, their kind (K,), its right inverse.

        The latter transposed and in size, and its error. Interfaces of one kind have the same numbers.
        """
        p, m, parts = self.problem, len(self.problem.interfaces), []
        rows, row = owned(p.row_interface, m)
        columns, column = owned(p.stress_interface, m)
        tall, wide = (np.bincount(of, minlength=m) for of in (p.row_interface, p.stress_interface))
        more = int(wide.max(initial=0)) + 1
        for r, c in (divmod(shape, more) for shape in np.unique(tall * more + wide).tolist()):
            these = np.flatnonzero((tall == r) & (wide == c))
            number = np.full(m, -1)
            number[these] = np.arange(len(these))
            block = number[p.row_interface]
            first = np.where(block >= 0, (block * r + row) * c, -1)
            matrix = in_blocks(p.F, first, column, (len(these), r, c))
            one, kind = equal_rows(matrix.reshape(len(these), -1))
            right, share = _right_inverse(np.swapaxes(matrix[one], 1, 2))
            across = np.abs(np.swapaxes(right, 1, 2), order="C")
            parts.append((rows[these, :r], columns[these, :c], kind, across, share))
        return parts


def _right_inverse(matrix: Array) -> tuple[Array, Array]:
    """Right inverses R of a stack of matrices A, and |e| / (1 - |e|) of the error e = A R - 1, row sums."""
    across, square = np.swapaxes(matrix, 1, 2), matrix.shape[1] == matrix.shape[2]
    try:
        right = np.asarray(np.linalg.inv(matrix) if square else across @ np.linalg.inv(matrix @ across))
    except np.linalg.LinAlgError:  # one of them has no right inverse
        right = np.asarray(np.linalg.pinv(matrix), dtype=float)
    identity, off = products(matrix, right)
    error = (np.abs(identity - np.eye(matrix.shape[1])) + off).sum(axis=2).max(axis=1) * UP
    share = np.where(error < POOREST, error / (1.0 - np.minimum(error, POOREST)) * UP, np.inf)
    return right, np.asarray(share, dtype=float)


def _exactly(size: Array, share: Array) -> Array:
    """Bound (A R)^-1 v for all |v| <= size (k, d): v, and `share` (k,) of its largest entry (Neumann)."""
    most = size.max(axis=1)
    more = np.zeros_like(most)
    np.multiply(share, most, out=more, where=most > 0.0)
    return np.asarray((size + more[:, None]) * UP)


def _tree_matrices(problem: LimitProblem, tree: Tree) -> tuple[Indices, Array, Array]:
    """Places (n, S) of the stresses of the tree's interfaces, and what they put on block and parent."""
    p, n = problem, len(problem.blocks)
    places, position = owned(p.stress_interface, len(p.interfaces))
    child = np.full(len(p.interfaces), -1)
    child[tree.interface] = np.arange(n)
    block = child[p.stress_interface]
    size = np.diff(p.C.indptr)
    its = np.repeat(block >= 0, size)  # few of all
    k, column = np.repeat(block, size)[its], p.C.indices[its]
    block, row = np.divmod(column, 6)
    matrices = np.zeros((2, n, 6, places.shape[1]))
    first = ((block != k) * n + k) * 6 + row
    matrices.reshape(-1)[first * places.shape[1] + np.repeat(position, size)[its]] = p.C.data[its]
    return places[tree.interface], matrices[0], matrices[1]


def _in_cones(problem: LimitProblem, rows: Array, reach: Array) -> tuple[Array, Array]:
    """Need and room of each linear row and each cone where rows move by at most `reach`."""
    cones = problem.cones
    need, room = [reach[: cones.linear]], [rows[: cones.linear]]
    for index in cones.groups:
        t, z = rows[index[:, 0]], rows[index[:, 1:]]
        single = np.count_nonzero(z, axis=1) < 2  # no square is rounded
        norm = np.where(single, np.abs(z).max(axis=1, initial=0.0), lengths(z))
        moved = reach[index[:, 0]] + lengths(reach[index[:, 1:]])
        rounding = EPS * np.where(single, np.abs(t - norm), np.abs(t) + (index.shape[1] + 4) * norm)
        need.append((moved + rounding) * UP)
        room.append(t - norm)
    return np.concatenate(need), np.concatenate(room)

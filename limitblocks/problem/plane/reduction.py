"""A limit problem reduced to the plane parallel to which everything acts.

By convexity stresses may be sought among those that the mirror leaves as they are, and mechanisms among
in-plane rates: docs/planar.md has the proof. The reduced problem is a limit problem again, with the columns
of rates out of the plane empty; its states are lifted back to the whole one and judged there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from limitblocks.arrays import Array, Indices, read_only
from limitblocks.problem.cones import Cones
from limitblocks.problem.limit_problem import LimitProblem, State
from limitblocks.problem.plane.alike import EXACT
from limitblocks.problem.plane.mirror import Mirror, Mirrored
from limitblocks.problem.plane.rows import Choice, PlaneRows, plane_rows

SMALLEST = 0.1  # column of a projection that is left: the largest of six is above 0.4
NOTHING = 1e-13  # of the largest entry of a row: rounding of what vanishes by symmetry


@dataclass(frozen=True, eq=False)
class Planar:
    """A limit problem in its plane, and what lifts its states back.

    Attributes
    ----------
    problem : LimitProblem
        The reduced problem.
    stresses : csr_array, shape (s, s')
        x of the whole problem = stresses x'.
    rates : csr_array, shape (6 n, 6 n)
        u = rates u'.
    multipliers : csr_array, shape (R, R')
        y = multipliers y'.
    live : float
        Unit of the live load of the whole problem over that of the reduced one.
    """

    problem: LimitProblem
    stresses: sparse.csr_array
    rates: sparse.csr_array
    multipliers: sparse.csr_array
    live: float = 1.0

    def lifted(self, state: State) -> State:
        """Return a state of the reduced problem as one of the whole."""
        return State(
            self.live * state.load_factor,
            self.stresses @ state.x,
            self.live * (self.rates @ state.u),
            self.live * (self.multipliers @ state.y),
        )

    def averaged(self, state: State) -> State:
        """Return the mean of a state of the whole problem and its mirror image as a reduced one.

        Multipliers of rows that others imply go to the nearest ones.
        """
        M = self.multipliers
        nearest = linalg.splu(sparse.csc_array(M.T @ M))
        return State(
            state.load_factor / self.live,
            self.stresses_of(state.x),
            self.rates.T @ state.u / self.live,
            nearest.solve(M.T @ state.y) / self.live,
        )

    def measured(self, whole: LimitProblem) -> Planar:
        """Return the same for the whole problem in other units of force."""
        problem = self.problem.measured(whole.units.block_force)
        return replace(self, problem=problem, live=whole.units.live / problem.units.live)

    def barrier_of(self, cones: Cones) -> Array:
        """Return how many logarithms of the cone K of the whole problem each reduced row stands for, (R',).

        Rows merged in their mean stand for as many as they are. A cone of which z keeps one direction is two
        rows, t + z > 0 and t - z > 0, and log(t^2 - z^2) / 2 the sum of half their logarithms.
        """
        heads = abs(self.multipliers)[cones.heads]
        count = np.asarray((heads > 0.0).sum(axis=0)).ravel().astype(float)
        conic = np.asarray((heads[cones.linear :] > 0.0).sum(axis=0)).ravel() > 0
        line = np.arange(len(count)) < self.problem.cones.linear
        return np.where(conic & line, count / 2.0, count)

    def compliance_of(self, weights: Array) -> Array | None:
        """Return the compliance of reduced stresses from that of all, (s,); None where it is not symmetric.

        Only then elastic strains of symmetric stresses are symmetric, too.
        """
        S = self.stresses
        own = np.asarray(S.multiply(S).T @ weights)
        squares = np.asarray(S.multiply(S).sum(axis=0)).ravel()
        off = sparse.diags_array(weights) @ S - S @ sparse.diags_array(own / squares)
        return None if abs(off).max() > EXACT * weights.max() else own

    def stresses_of(self, x: Array) -> Array:
        """Return stresses of the whole problem, averaged with their mirror image, as reduced ones."""
        squares = np.asarray(self.stresses.multiply(self.stresses).sum(axis=0)).ravel()
        return np.asarray(self.stresses.T @ x / squares)


def reduced(problem: LimitProblem, mirror: Mirror, choice: Choice = Choice.FEW) -> Planar:
    """Return the problem reduced to the plane of its mirror.

    Parameters
    ----------
    problem : LimitProblem
        The whole problem.
    mirror : Mirror
        Its mirror plane.
    choice : Choice
        FEW rows serve the associated flow, FLOWING ones any, EVERY one margins.
    """
    stresses, rows = _stresses_and_rows(problem, mirror, choice)
    rates = _rates(problem, mirror)
    source, weights, cones = rows
    units = problem.units.row
    W = sparse.csr_array(sparse.diags_array(1.0 / units[source]) @ weights @ sparse.diags_array(units))
    kept, interface = np.unique(problem.row_interface[source], return_inverse=True)
    B = sparse.csr_array(problem.resultants @ stresses)
    six = (6 * kept[:, None] + np.arange(6)).ravel()
    planar = replace(
        problem,
        C=_cleaned(stresses.T @ problem.C @ rates),
        dead=read_only(rates.T @ problem.dead),
        live=read_only(rates.T @ problem.live),
        F=_cleaned(W @ problem.F @ stresses),
        G=_cleaned(W @ problem.G @ stresses),
        g=read_only(W @ problem.g),
        cones=cones,
        pivot=read_only(np.zeros(len(source))),
        half_sides=problem.half_sides[kept],
        resultants=_cleaned(B[six]),
        compliance=read_only(stresses.multiply(stresses).T @ problem.compliance),
        ends=problem.ends[kept],
        row_interface=interface,
        row_mode=tuple(problem.row_mode[k] for k in source),
        friction=problem.friction[kept],
        units=replace(
            problem.units,
            interface_force=problem.units.interface_force[kept],
            interface_length=problem.units.interface_length[kept],
            row=units[source],
        ),
        interfaces=tuple(problem.interfaces[k] for k in kept),
    )
    return Planar(planar, stresses, rates, sparse.csr_array(W.T))


def _rates(problem: LimitProblem, mirror: Mirror) -> sparse.csr_array:
    """Rates of all blocks per in-plane rate: along the axes of the plane, and about its normal."""
    along = np.arange(3) != mirror.axis
    block = np.zeros((6, 6))
    block[:3, :3], block[3:, 3:] = mirror.frame * along, mirror.frame * ~along
    return sparse.csr_array(sparse.kron(sparse.eye_array(len(problem.blocks)), block))


def _stresses_and_rows(
    problem: LimitProblem, mirror: Mirror, choice: Choice
) -> tuple[sparse.csr_array, tuple[Indices, sparse.csr_array, Cones]]:
    """Columns that the mirror leaves as they are; rows: the one each comes from, weights, and their cone."""
    triplets, parts, width = [], [], 0
    for kind in mirror.kinds:
        first = np.flatnonzero(kind.image >= np.arange(len(kind.image)))
        basis = symmetric(kind.turn[first])
        for d in np.unique(basis.any(axis=1).sum(axis=1)).tolist():
            if d == 0:  # a tie across the plane carries nothing in it
                continue
            its = np.flatnonzero(basis.any(axis=1).sum(axis=1) == d)
            own, X = first[its], basis[its][:, :, :d]
            new = width + np.arange(len(own) * d).reshape(-1, 1, d)
            width += len(own) * d
            image = kind.image[own]
            for there, also in ((own, np.ones(len(own), dtype=bool)), (image, image != own)):
                old = kind.places.columns[there][:, :, None]
                keep = (X != 0.0) & also[:, None, None]
                triplets.append([np.broadcast_to(v, X.shape)[keep] for v in (X, old, new)])
            parts += _rows_of(kind, own, X, choice)
    data, old, new = (np.concatenate(part) for part in zip(*triplets, strict=True))
    stresses = sparse.coo_array((data, (old, new)), shape=(problem.C.shape[0], width)).tocsr()
    return sparse.csr_array(stresses), _joined(parts, len(problem.g))


def _rows_of(kind: Mirrored, own: Indices, X: Array, choice: Choice) -> list[PlaneRows]:
    """Rows of the places `own` and of their images, on the stresses of the basis X (K, c, d)."""
    twice = kind.image[own] != own
    some = [its for its in (~twice, twice) if its.any()]
    return [part for its in some for part in plane_rows(kind, own[its], X[its], choice)]


def symmetric(turn: Array) -> Array:
    """Bases (K, c, c) of the stresses that `turn` leaves as they are, zero columns after them.

    Columns of the projection, the largest first: axes stay axes.
    """
    K, c, _ = turn.shape
    left, basis = (np.eye(c) + turn) / 2.0, np.zeros((K, c, c))
    for k in range(c):
        sizes = np.linalg.norm(left, axis=1)
        largest = sizes.argmax(axis=1)
        size = sizes[np.arange(K), largest][:, None]
        column = np.where(
            size > SMALLEST, left[np.arange(K), :, largest] / np.where(size > SMALLEST, size, 1.0), 0.0
        )
        column = np.where(np.abs(column) < EXACT, 0.0, column)
        basis[:, :, k] = column
        left = left - column[:, :, None] * (column[:, None] @ left)
    return basis


def _joined(parts: list[PlaneRows], height: int) -> tuple[Indices, sparse.csr_array, Cones]:
    """All rows, linear ones first, then cones by their size."""
    parts = sorted(parts, key=lambda part: part.size)
    source = np.concatenate([part.source for part in parts])
    first = np.cumsum([0] + [len(part.source) for part in parts])
    data = np.concatenate([part.weight for part in parts])
    rows = np.concatenate([part.row + k for part, k in zip(parts, first[:-1], strict=True)])
    columns = np.concatenate([part.column for part in parts])
    weights = sparse.coo_array((data, (rows, columns)), shape=(len(source), height)).tocsr()
    linear = sum(len(part.source) for part in parts if part.size == 1)
    sizes = [part.size for part in parts if part.size > 1 for _ in range(len(part.source) // part.size)]
    return source, sparse.csr_array(weights), Cones.of_sizes(linear, sizes)


def _cleaned(matrix: Any) -> sparse.csr_array:
    """The matrix without entries that are rounding of nothing."""
    A: sparse.csr_array = sparse.csr_array(matrix).copy()
    largest = abs(A).max(axis=1).toarray().ravel() if A.nnz else np.zeros(A.shape[0])
    A.data[np.abs(A.data) <= NOTHING * np.repeat(largest, np.diff(A.indptr))] = 0.0
    A.eliminate_zeros()
    return A

"""A limit problem reduced by its mirror plane.

By convexity stresses and mechanisms may be sought among those that the mirror leaves as they are:
docs/planar.md has the proof. The reduced problem is a limit problem again, of one block of each pair and of
those that are their own images, with empty columns of rates out of the plane; its states are lifted back to
the whole one and judged there.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array, Indices, equal_rows, largest_in_rows, read_only
from limitblocks.problem.cones import Cones
from limitblocks.problem.limit_problem import LimitProblem, in_units
from limitblocks.problem.plane.mirror import Mirror, Mirrored
from limitblocks.problem.plane.planar import Planar
from limitblocks.problem.plane.rounding import EXACT
from limitblocks.problem.plane.rows import Choice, PlaneRows, plane_rows

SMALLEST = 0.1  # column of a projection that is left: the largest of six is above 0.4
ALIKE = 6  # digits: of columns as large as each other the first is taken, whatever rounding says
NOTHING = 1e-13  # of the largest entry of a row: rounding of what vanishes by symmetry


def reduced(problem: LimitProblem, mirror: Mirror, choice: Choice = Choice.FEW) -> Planar:
    """Return the problem reduced by its mirror.

    Parameters
    ----------
    problem : LimitProblem
        The whole problem.
    mirror : Mirror
        Its mirror plane.
    choice : Choice
        FEW rows serve the associated flow, the only one they have, FLOWING ones any, EVERY one margins.
    """
    stresses, rows = _stresses_and_rows(problem, mirror, choice)
    blocks = np.flatnonzero(mirror.image >= np.arange(len(mirror.image)))
    rates = _rates(mirror, blocks)
    source, weights, cones = rows
    units = problem.units.row
    W, back = in_units(weights, 1.0 / units[source], units), rates.T
    kept, interface = np.unique(problem.row_interface[source], return_inverse=True)
    B = _cleaned(problem.resultants @ stresses)
    F = _cleaned(W @ problem.F @ stresses)
    six = (6 * kept[:, None] + np.arange(6)).ravel()
    planar = replace(
        problem,
        C=_cleaned(stresses.T.tocsr() @ problem.C @ rates),
        dead=read_only(back @ problem.dead),
        live=read_only(back @ problem.live),
        F=F,
        G=F if choice is Choice.FEW else _cleaned(W @ problem.G @ stresses),
        g=read_only(W @ problem.g),
        cones=cones,
        pivot=read_only(np.zeros(len(source))),
        half_sides=problem.half_sides[kept],
        resultants=B if len(six) == B.shape[0] else B[six],
        compliance=read_only(stresses.power(2).T @ problem.compliance),
        ends=_ends(problem.ends[kept], mirror.image, blocks),
        row_interface=interface,
        row_mode=problem.row_mode[source],
        friction=problem.friction[kept],
        units=problem.units.of(blocks, kept, source),
        blocks=_taken(problem.blocks, blocks),
        interfaces=_taken(problem.interfaces, kept),
        centroids=problem.centroids[blocks],
    )
    return Planar(planar, stresses, rates, W.T.tocsr(), blocks, mirror.flat, problem.units)


def _taken(values: tuple[Any, ...], places: Indices) -> tuple[Any, ...]:
    return tuple([values[place] for place in places.tolist()])


def _rates(mirror: Mirror, blocks: Indices) -> sparse.csr_array:
    """Rates of all blocks per rate of `blocks`: of itself and its image; of its own image, in the plane.

    The latter along the axes of the plane, and about its normal.
    """
    along = np.arange(3) != mirror.axis
    block = np.zeros((6, 6))
    block[:3, :3], block[3:, 3:] = mirror.frame * along, mirror.frame * ~along
    image, n, column = mirror.image[blocks], len(mirror.image), np.arange(len(blocks))
    still, paired = image == blocks, image != blocks
    parts = [(block, blocks[still], column[still]), (np.eye(6), blocks[paired], column[paired])]
    parts.append((mirror.rates, image[paired], column[paired]))
    triplets = []
    for own, i, j in parts:
        a, b = np.nonzero(own)
        entries = np.tile(own[a, b], len(i)), (6 * i[:, None] + a).ravel(), (6 * j[:, None] + b).ravel()
        triplets.append(entries)
    data, rows, columns = (np.concatenate(part) for part in zip(*triplets, strict=True))
    return sparse.csr_array((data, (rows, columns)), shape=(6 * n, 6 * len(blocks)))


def _ends(ends: Indices, image: Indices, blocks: Indices) -> Indices:
    """Blocks of the reduced problem at the ends of interfaces; what leans on its image leans on the plane."""
    index = np.searchsorted(blocks, np.minimum(image, np.arange(len(image))))
    own = np.where(ends >= 0, index[ends], -1)
    own[own[:, 0] == own[:, 1], 1] = -1
    return np.asarray(own)


def _stresses_and_rows(
    problem: LimitProblem, mirror: Mirror, choice: Choice
) -> tuple[sparse.csr_array, tuple[Indices, sparse.csr_array, Cones]]:
    """Columns that the mirror leaves as they are; rows: the one each comes from, weights, and their cone."""
    triplets, parts, width = [], [], 0
    for kind in mirror.kinds:
        first = np.flatnonzero(kind.image >= np.arange(len(kind.image)))
        paired = kind.paired[first, None, None]
        turns, of_turn = equal_rows(kind.turn[first].reshape(len(first), -1))
        basis = np.where(paired, np.eye(kind.turn.shape[1]), symmetric(kind.turn[first[turns]])[of_turn])
        for d in np.unique(basis.any(axis=1).sum(axis=1)).tolist():
            if d == 0:  # a tie across the plane carries nothing in it
                continue
            its = np.flatnonzero(basis.any(axis=1).sum(axis=1) == d)
            own, X = first[its], basis[its][:, :, :d]
            new = width + np.arange(len(own) * d).reshape(-1, 1, d)
            width += len(own) * d
            two = kind.image[own] != own
            turned = np.where(paired[its][two], kind.turn[own[two]] @ X[two], X[two])
            for there, Y, column in ((own, X, new), (kind.image[own[two]], turned, new[two])):
                old, keep = kind.places.columns[there][:, :, None], Y != 0.0
                triplets.append([np.broadcast_to(v, Y.shape)[keep] for v in (Y, old, column)])
            parts += _rows_of(kind, own, X, choice, mirror.flat)
    data, old, new = (np.concatenate(part) for part in zip(*triplets, strict=True))
    stresses = sparse.csr_array((data, (old, new)), shape=(problem.C.shape[0], width))
    return stresses, _joined(parts, len(problem.g))


def _rows_of(kind: Mirrored, own: Indices, X: Array, choice: Choice, lines: bool) -> list[PlaneRows]:
    """Rows of the places `own` and of their images, on the stresses of the basis X (K, c, d)."""
    twice, paired = kind.image[own] != own, kind.paired[own]
    groups = ((~twice, choice), (twice & ~paired, choice), (paired, Choice.EVERY))  # pairs imply nothing
    return [
        part
        for its, which in groups
        if its.any()
        for part in plane_rows(kind, own[its], X[its], which, lines)
    ]


def symmetric(turn: Array) -> Array:
    """Bases (K, c, c) of the stresses that `turn` leaves as they are, zero columns after them.

    Columns of the projection, the largest first: axes stay axes.
    """
    K, c, _ = turn.shape
    left, basis = (np.eye(c) + turn) / 2.0, np.zeros((K, c, c))
    for k in range(c):
        sizes = np.linalg.norm(left, axis=1)
        largest = sizes.round(ALIKE).argmax(axis=1)
        size = sizes[np.arange(K), largest][:, None]
        if (size <= SMALLEST).all():
            break
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
    weights = sparse.csr_array((data, (rows, columns)), shape=(len(source), height))
    linear = sum(len(part.source) for part in parts if part.size == 1)
    sizes = [part.size for part in parts if part.size > 1 for _ in range(len(part.source) // part.size)]
    return source, weights, Cones.of_sizes(linear, sizes)


def _cleaned(A: sparse.csr_array) -> sparse.csr_array:
    """The matrix, a product, without entries that are rounding of nothing."""
    A.data[np.abs(A.data) <= NOTHING * np.repeat(largest_in_rows(A), np.diff(A.indptr))] = 0.0
    A.eliminate_zeros()
    return A

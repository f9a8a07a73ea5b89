"""A plane parallel to which everything acts: found in the numbers of a limit problem.

The mirror maps every free block to itself: its rates (du, w) to (R du, -R w) with R = 1 - 2 m m^T, m the
normal of the plane. A place where forces act, an interface or a point of one, is mapped to itself or to
another place between the same two blocks. docs/planar.md has the proofs of what follows from it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from limitblocks.arrays import Array, Indices
from limitblocks.problem.limit_problem import LimitProblem
from limitblocks.problem.plane.alike import EXACT, alike, classes, close, numbers, size_of
from limitblocks.problem.plane.places import Place, kinds_of, owned

UNIQUE = 1e-6  # of all normals and forces: less across two directions leaves the plane open
SNAP = 1e-10  # distance of a normal from an axis that is rounding


@dataclass(frozen=True, eq=False)
class Mirrored:
    """Places of one kind under the mirror.

    Attributes
    ----------
    places : Place
        The places.
    image : Indices, shape (K,)
        Where each one goes.
    turn : Array, shape (K, c, c)
        The stresses there per stress.
    partner : Indices, shape (K, members)
        The linear row or cone of the place itself that the mirror makes of each.
    sort : Indices, shape (K,)
        Equal for places with the same rows, up to their unit, and the same turn.
    """

    places: Place
    image: Indices
    turn: Array
    partner: Indices
    sort: Indices


@dataclass(frozen=True, eq=False)
class Mirror:
    """The mirror plane of a limit problem.

    Attributes
    ----------
    frame : Array, shape (3, 3)
        Orthonormal columns: the normal of the plane is column `axis`, the others lie in it.
    axis : int
        Which one.
    kinds : tuple of Mirrored
        All places, kind by kind.
    """

    frame: Array
    axis: int
    kinds: tuple[Mirrored, ...]


def mirror_of(problem: LimitProblem) -> Mirror | None:
    """Return the plane parallel to which everything acts; None where there is none up to EXACT."""
    if problem.C.shape[1] != 6 * len(problem.blocks) or not len(problem.blocks):
        return None
    ends = _strain_by_end(problem)
    normal = _normal(problem, ends)
    if normal is None:
        return None
    frame, axis = _frame(normal)
    sides = np.ones(3)
    sides[axis] = -1.0
    reflected = (frame * sides) @ frame.T
    rates = np.zeros((6, 6))
    rates[:3, :3], rates[3:, 3:] = reflected, -reflected
    if not _loaded_in_plane(problem, rates):
        return None
    kinds = []
    for kind in kinds_of(problem, ends):
        mirrored = _mirrored(kind, rates)
        if mirrored is None:
            return None
        kinds.append(mirrored)
    return Mirror(frame, axis, tuple(kinds))


def _strain_by_end(problem: LimitProblem) -> Array:
    """Strain rates (s, 2, 6) per rate of the block at each end of the interface; zero for a support."""
    C = problem.C.tocoo()
    k = problem.stress_interface[C.row]
    end = (problem.ends[k, 0] != C.col // 6).astype(int)
    strain = np.zeros((problem.C.shape[0], 2, 6))
    strain[C.row, end, C.col % 6] = C.data
    return strain


def _normal(problem: LimitProblem, strain: Array) -> Array | None:
    """Unit vector across all normals of interfaces and all forces; None where there is not just one."""
    pressing = np.unique(problem.resultants[2::6].indices)
    forces = [load.reshape(-1, 6)[:, :3] for load in (problem.dead, problem.live)]
    sizes = [max(float(np.abs(force).max()), np.finfo(float).tiny) for force in forces]
    vectors = [strain[pressing, :, :3].reshape(-1, 3)]
    length = np.linalg.norm(vectors[0], axis=1, keepdims=True)
    vectors[0] = vectors[0] / np.where(length > 0.0, length, 1.0)
    vectors += [force / size for force, size in zip(forces, sizes, strict=True)]
    gram = [part.T @ part / max(len(part), 1) for part in vectors]
    values, axes = np.linalg.eigh(np.sum(gram, axis=0))
    normal = np.asarray(axes[:, 0])
    off = max(float(np.abs(part @ normal).max(initial=0.0)) for part in vectors)
    return normal if values[1] > UNIQUE**2 and off <= EXACT else None


def _frame(normal: Array) -> tuple[Array, int]:
    """Orthonormal axes, one of them the normal: a Householder matrix, the global axes where it is one."""
    axis = int(np.abs(normal).argmax())
    v = normal * np.sign(normal[axis]) - np.eye(3)[axis]
    size = float(v @ v)
    return (np.eye(3) if size < SNAP**2 else np.eye(3) - 2.0 * np.outer(v, v) / size), axis


def _loaded_in_plane(problem: LimitProblem, rates: Array) -> bool:
    loads = [load.reshape(-1, 6) for load in (problem.dead, problem.live)]
    return all(close(load @ rates, load, np.abs(load).max(initial=0.0)) for load in loads)


def _mirrored(kind: Place, rates: Array) -> Mirrored | None:
    """Where the mirror takes each place; None where one has no image, or its rows are not symmetric."""
    image, turn = _images(kind, rates)
    K, c = kind.columns.shape
    if not (image[image] == np.arange(K)).all():
        return None
    if not (close(turn @ turn, np.eye(c)[None], 1.0) and close(turn[image], turn, 1.0)):
        return None
    values = numbers(kind, None)
    first, sort = classes(values / size_of(values), turn)
    few = kind.taken(first)
    partner = alike(few, few, turn[first])
    if partner is None:
        return None
    if (image != np.arange(K)).any() and alike(kind, kind.taken(image), None) is None:
        return None
    return Mirrored(kind, image, turn, partner[sort], sort)


def _images(kind: Place, rates: Array) -> tuple[Indices, Array]:
    """The place (K,) that fits the mirrored one best, and the turn (K, c, c) of stresses; zero if none."""
    K, c = kind.columns.shape
    _, bucket = np.unique(kind.ends, axis=0, return_inverse=True)
    table, _ = owned(bucket.ravel(), int(bucket.max()) + 1)
    number = np.bincount(bucket.ravel())[bucket.ravel()]
    free = np.where(kind.ends[:, 0] >= 0, 0, 1)
    inverse = np.linalg.pinv(kind.strain[np.arange(K), free])
    mirrored = kind.strain @ rates
    own = mirrored[np.arange(K), free]
    scale = np.abs(kind.strain).max(axis=(1, 2, 3))
    least = np.full(K, EXACT)
    image, turn = np.full(K, K), np.zeros((K, c, c))
    for k in range(table.shape[1]):
        there = table[bucket.ravel(), k]
        back = own @ inverse[there]  # the transpose of the turn
        off = np.abs(back[:, None] @ kind.strain[there] - mirrored).max(axis=(1, 2, 3)) / scale
        # moments carry any interface over to any other; a mirror image has them about its own centroid
        off = np.maximum(off, np.abs(back @ back.transpose(0, 2, 1) - np.eye(c)).max(axis=(1, 2)))
        fits = (k < number) & (off <= least)
        image, least = np.where(fits, there, image), np.where(fits, off, least)
        turn = np.where(fits[:, None, None], back.transpose(0, 2, 1), turn)
    lost = image == K  # their turn is zero, which is no mirror
    return np.where(lost, np.arange(K), image), turn

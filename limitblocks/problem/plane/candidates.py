"""Mirror planes that a limit problem may have, and where each takes the blocks and the places."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.spatial import cKDTree

from limitblocks.arrays import Array, Indices, owned
from limitblocks.problem.limit_problem import LimitProblem
from limitblocks.problem.plane.places import Place
from limitblocks.problem.plane.rounding import EXACT, pseudo_inverses, without_rounding

UNIQUE = 1e-6  # of all normals and forces: less across two directions leaves the plane open


def candidates(problem: LimitProblem, strain: Array) -> Iterator[tuple[Array, Indices]]:
    """Unit normals of mirror planes to try, and the image (n,) of each block; `strain` as in `Place`.

    First the plane parallel to which everything acts, which takes every block to itself. Then those through
    the mean of the centroids: a mirror of the loads has their resultants in its plane, and its normal is an
    axis of inertia.
    """
    normal = _parallel_to_all(problem, strain)
    if normal is not None:
        yield normal, np.arange(len(problem.blocks))
    at = problem.centroids - problem.centroids.mean(axis=0)
    across = _across_resultants(problem)
    _, axes = np.linalg.eigh(across.T @ at.T @ at @ across)
    for normal in (across @ axes).T:
        image = _images(at, normal)
        if image is not None:
            yield normal, image


def _parallel_to_all(problem: LimitProblem, strain: Array) -> Array | None:
    """Unit vector across all normals of interfaces and all forces; None where there is not just one."""
    Q = problem.resultants
    pressing = Q.indices[np.repeat(np.arange(Q.shape[0]) % 6, np.diff(Q.indptr)) == 2]
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


def _across_resultants(problem: LimitProblem) -> Array:
    """Orthonormal directions (3, k) across the resultants of the dead and of the live loads."""
    forces = [load.reshape(-1, 6)[:, :3] * problem.units.block_force[:, None]
              for load in (problem.dead, problem.live)]  # fmt: skip
    sums = [force.sum(axis=0) / max(float(np.abs(force).sum()), np.finfo(float).tiny) for force in forces]
    lengths = [float(np.linalg.norm(total)) for total in sums]
    found = [total / length for total, length in zip(sums, lengths, strict=True) if length > UNIQUE]
    if not found:
        return np.eye(3)
    _, sizes, axes = np.linalg.svd(np.stack(found))
    return np.asarray(axes[int((sizes > UNIQUE).sum()) :].T)


def _images(at: Array, normal: Array) -> Indices | None:
    """The block (n,) at the mirror image of each centroid; None where one has no such block."""
    mirrored = at - 2.0 * np.outer(at @ normal, normal)
    off, image = (np.asarray(part) for part in cKDTree(at).query(mirrored))
    exact = off.max() <= EXACT * np.abs(at).max() and (image[image] == np.arange(len(at))).all()
    return np.asarray(image, dtype=np.int64) if exact else None


def images(kind: Place, blocks: Indices, rates: Array) -> tuple[Indices, Array]:
    """The place (K,) that fits the mirrored one best, and the turn (K, c, c) of stresses; zero if none."""
    K, c = kind.columns.shape
    goal = np.where(kind.ends >= 0, blocks[kind.ends], -1)
    i, j = np.concatenate([kind.ends, goal]).T + 1
    _, bucket = np.unique(np.minimum(i, j) * (len(blocks) + 1) + np.maximum(i, j), return_inverse=True)
    here, wanted = bucket.ravel()[:K], bucket.ravel()[K:]
    count = int(bucket.max()) + 1
    table, _ = owned(here, count)
    number = np.bincount(here, minlength=count)[wanted]
    scale = np.abs(kind.strain).max(axis=(1, 2, 3))
    whole = kind.middle is kind.strain  # one place at each interface
    wide = kind.strain if whole else np.concatenate([kind.strain, kind.middle], axis=3)
    mirrored = (wide.reshape(-1, 6) @ rates).reshape(wide.shape)
    free = np.where(goal[:, 0] >= 0, 0, 1)
    least, image, turn = np.full(K, np.inf), np.full(K, K), np.zeros((K, c, c))
    for k in range(table.shape[1]):
        there = np.minimum(table[wanted, k], K - 1)  # any beyond its number
        strain = wide[there]
        turned_round = kind.ends[there, 0] != goal[:, 0]
        strain[turned_round] = strain[turned_round, ::-1]
        own = strain[np.arange(K), free, :, :6]
        gram = pseudo_inverses(own @ own.transpose(0, 2, 1))
        # the transpose of the turn
        back = mirrored[np.arange(K), free, :, :6] @ own.transpose(0, 2, 1) @ gram
        apart = np.abs(back[:, None] @ strain - mirrored)
        off = apart[..., :6].max(axis=(1, 2, 3)) / scale
        # where two interfaces meet, points of theirs coincide: their middles tell which is which; of two
        # interfaces between the same blocks any fits with all six stresses, but one alone by a rotation
        far = apart.max(axis=(1, 2, 3))
        if table.shape[1] > 1:
            skew = np.abs(back @ back.transpose(0, 2, 1) - np.eye(c)).max(axis=(1, 2))
            far = np.maximum(far, skew * scale)
        fits = (k < number) & (off <= EXACT) & (far < least)
        image, least = np.where(fits, there, image), np.where(fits, far, least)
        turn = np.where(fits[:, None, None], back.transpose(0, 2, 1), turn)
    lost = image == K  # their turn is zero, which is no mirror
    return np.where(lost, np.arange(K), image), without_rounding(turn)

"""Mirror planes that a limit problem may have, and where each takes the blocks."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.spatial import cKDTree

from limitblocks.arrays import Array, Indices
from limitblocks.problem.limit_problem import LimitProblem
from limitblocks.problem.plane.rounding import EXACT

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

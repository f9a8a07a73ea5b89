"""Bodies that are not convex, for the tests of blocks and contacts."""

from collections import Counter

import numpy as np
from scipy.spatial.transform import Rotation

from limitblocks.geometry import Block

L = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
U = [(0, 0), (3, 0), (3, 2), (2, 2), (2, 1), (1, 1), (1, 2), (0, 2)]
PLUS = [(1, 0), (2, 0), (2, 1), (3, 1), (3, 2), (2, 2), (2, 3), (1, 3), (1, 2), (0, 2), (0, 1), (1, 1)]
SQUARE = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) / 2


def extruded(name, outline, low=0.0, high=1.0):
    """Prism along Z over a counter-clockwise outline (n, 2)."""
    return Block.prism(name, outline, (low, high), along="z")


def ring(name, outer, inner, low=0.0, high=1.0):
    """Prism along Z between two outlines (n, 2) with as many corners; each end is n quadrilaterals."""
    n = len(outer)
    points = np.concatenate([
        np.column_stack([outline, np.full(n, z)]) for z in (low, high) for outline in (outer, inner)
    ])  # fmt: skip
    faces = []
    for k in range(n):
        j = (k + 1) % n
        faces += [(k, j, 2 * n + j, 2 * n + k), (n + j, n + k, 3 * n + k, 3 * n + j)]
        faces += [(2 * n + k, 2 * n + j, 3 * n + j, 3 * n + k), (j, k, n + k, n + j)]
    return Block(name, points, faces)


def regular(n, radius):
    angle = 2 * np.pi * np.arange(n) / n
    return radius * np.column_stack([np.cos(angle), np.sin(angle)])


def hollow(name, outer, inner, at=(0, 0, 0)):
    """Cube of side `outer` with a cubic cavity of side `inner` about `at`."""
    shell, cavity = Block.box("shell", (outer,) * 3, (0, 0, 0)), Block.box("cavity", (inner,) * 3, at)
    faces = [*shell.faces, *(tuple(8 + v for v in face[::-1]) for face in cavity.faces)]
    return Block(name, np.concatenate([shell.vertices, cavity.vertices]), faces)


def triangulated(block):
    return Block(block.name, block.vertices, block.triangles.tolist(), block.unit_weight)


def moved(blocks, seed, shift=0.0):
    rng = np.random.default_rng(seed)
    rotation = Rotation.from_quat(rng.normal(size=4)).as_matrix()
    translation = rng.uniform(-10, 10, 3) + shift
    return [block.moved(rotation, translation) for block in blocks], rotation, translation


def joined(name, *blocks):
    """One body of blocks that share whole faces: common vertices become one, faces between them go."""
    points, place = np.unique(
        np.concatenate([block.vertices for block in blocks]).round(9), axis=0, return_inverse=True
    )
    start = np.cumsum([0, *(len(block.vertices) for block in blocks)])
    faces = [
        tuple(place.ravel()[start[k] + v] for v in face)
        for k, block in enumerate(blocks)
        for face in block.faces
    ]
    count = Counter(frozenset(face) for face in faces)
    faces = [face for face in faces if count[frozenset(face)] == 1]
    used, local = np.unique(np.concatenate(faces), return_inverse=True)
    parts = np.split(local, np.cumsum([len(face) for face in faces])[:-1])
    return Block(name, points[used], [part.tolist() for part in parts])

"""Blocks and interfaces made by hand: exact at any size, where contact detection has tolerances."""

import numpy as np

import limitblocks as lb

LEAST_SHARE = 0.02  # of the smaller side: no contact is a sliver


def interface(i, j, corners, normal, joint):
    """Interface of convex `corners` (n, 3), counter-clockwise about the unit `normal` out of i."""
    corners, normal = np.asarray(corners, dtype=float), np.asarray(normal, dtype=float)
    sides = np.roll(corners, -1, axis=0) - corners
    first = int(np.linalg.norm(sides, axis=1).argmax())
    s1 = sides[first] / np.linalg.norm(sides[first])
    axes = np.array([s1, np.cross(normal, s1), normal])
    local = np.roll((corners - corners[0]) @ axes[:2].T, -first - 1, axis=0)
    middle = centroid(local)
    return lb.Interface(i, j, corners[0] + middle @ axes[:2], axes, local - middle, joint)


def centroid(polygon):
    """Centroid (2,) of a polygon (n, 2), by triangles at its first corner."""
    a = polygon - polygon[0]
    b = np.roll(a, -1, axis=0)
    area = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return polygon[0] + area @ (a + b) / 3.0 / area.sum()


def turned(one):
    """The same interface with its blocks in the other order."""
    s1, s2, n = one.axes
    flipped = (one.polygon * (1.0, -1.0))[::-1]
    return lb.Interface(one.block_j, one.block_i, one.centroid, np.array([s1, -s2, -n]), flipped, one.joint)


def frustum(name, below, above, z, unit_weight=None):
    """Block between two homothetic polygons (n, 2), counter-clockwise, at the heights z = (z0, z1)."""
    n = len(below)
    rings = [
        np.column_stack([ring, np.full(n, height)]) for ring, height in zip((below, above), z, strict=True)
    ]
    sides = [(k, (k + 1) % n, (k + 1) % n + n, k + n) for k in range(n)]
    return lb.Block(
        name, np.concatenate(rings), (tuple(reversed(range(n))), tuple(range(n, 2 * n)), *sides), unit_weight
    )


def box(name, low, high, weight=None):
    """Box between two corners, of a given weight."""
    low, high = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    unit_weight = None if weight is None else weight / np.prod(high - low)
    return lb.Block.box(name, high - low, (low + high) / 2, unit_weight)


def touching(boxes, joint_of):
    """Interfaces of boxes {name: (low, high)} whose faces lie in one plane, equal to the last digit.

    `joint_of()` gives the joint of each.
    """
    values, names = [], list(boxes)
    for a, i in enumerate(names):
        for j in names[a + 1 :]:
            values += [one for axis in range(3) for one in _faces(boxes, i, j, axis, joint_of)]
    return values


def _faces(boxes, i, j, axis, joint_of):
    (low_i, high_i), (low_j, high_j) = boxes[i], boxes[j]
    others = [k for k in range(3) if k != axis]
    low, high = np.maximum(low_i, low_j)[others], np.minimum(high_i, high_j)[others]
    smaller = np.minimum(np.subtract(high_i, low_i), np.subtract(high_j, low_j))[others]
    if (high - low < LEAST_SHARE * smaller).any():
        return
    for plane, other, sign in ((high_i[axis], low_j[axis], 1.0), (low_i[axis], high_j[axis], -1.0)):
        if plane == other:
            corners = np.full((4, 3), plane)
            corners[:, others] = [low, (high[0], low[1]), high, (low[0], high[1])]
            normal = sign * np.eye(3)[axis]
            if (sign > 0) == (axis == 1):  # (x, z) turns about -y
                corners = corners[::-1]
            yield interface(i, j, corners, normal, joint_of())

"""The load factor of an arch bridge by another program: forces at the ends of joints, in the plane.

Written from radius and angles, with nothing of the library: outlines, joints, equilibrium of each block about
the origin, a linear program.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linprog

LOAD = 1e3  # N downwards at load factor one
WATER = 9810.0  # N/m3


@dataclass(frozen=True)
class Bridge:
    """Clear span, rise, thickness, joints; width of piers; `between` is the friction between rings."""

    span: float = 3.0
    rise: float = 0.75
    thickness: float = 0.22
    voussoirs: int = 15
    depth: float = 2.0
    friction: float = 0.6
    spans: int = 1
    rings: int = 1
    between: float = 0.6
    width: float = 0.5
    height: float = 1.5
    courses: int = 4
    gamma: float = 20e3  # N/m3

    def point(self, k, m, j):
        """End of joint j of span k, on the intrados of ring m."""
        radius = (self.span**2 / 4 + self.rise**2) / (2 * self.rise)
        half = 2 * np.arctan(2 * self.rise / self.span)
        angle = half * (2 * j / self.voussoirs - 1)
        centre = k * (self.span + self.width), self.height * (self.spans > 1) - radius * np.cos(half)
        return centre + (radius + self.thickness * m / self.rings) * np.array([np.sin(angle), np.cos(angle)])


def arch(bridge, k):
    """Outlines and joints of span k; a joint is two blocks, two ends, a friction."""
    n, outlines, joints = bridge.voussoirs, {}, []
    for m in range(bridge.rings):
        for j in range(n):
            corners = (m, j), (m, j + 1), (m + 1, j + 1), (m + 1, j)
            outlines[k, m, j] = np.array([bridge.point(k, *corner) for corner in corners])
            before = (k, m, j - 1) if j else ("springer", k - 1)
            joints.append(
                (before, (k, m, j), bridge.point(k, m, j), bridge.point(k, m + 1, j), bridge.friction)
            )
            if m + 1 < bridge.rings:
                ends = bridge.point(k, m + 1, j), bridge.point(k, m + 1, j + 1)
                joints.append(((k, m, j), (k, m + 1, j), *ends, bridge.between))
        ends = bridge.point(k, m, n), bridge.point(k, m + 1, n)
        joints.append((("springer", k), (k, m, n - 1), *ends, bridge.friction))
    return outlines, joints


def pier(bridge, k):
    """Outlines and joints of the pier between spans k and k + 1, its springer included."""
    a = bridge.span / 2 + k * (bridge.span + bridge.width)
    b, top, step = a + bridge.width, bridge.height, bridge.height / bridge.courses
    ends = bridge.point(k + 1, bridge.rings, 0), bridge.point(k, bridge.rings, bridge.voussoirs)
    outlines, joints = {("springer", k): np.array([(a, top), (b, top), *ends])}, []
    below = ("base", k)
    for c in range(bridge.courses):
        own = "pier", k, c
        outlines[own] = np.array([(a, c * step), (b, c * step), (b, (c + 1) * step), (a, (c + 1) * step)])
        joints.append((below, own, np.array((a, c * step)), np.array((b, c * step)), bridge.friction))
        below = own
    joints.append((below, ("springer", k), np.array((a, top)), np.array((b, top)), bridge.friction))
    return outlines, joints


def load_factor(bridge, at, loaded=0, pulls=(), water=None):
    """Greatest multiple of 1 kN at X = `at` on the extrados of span `loaded` that a safe state carries.

    `pulls` are forces between two limits: point, unit direction, limits, the block pulled, the block that
    pulls (None for the ground). In the joints stands water up to the level `water`.
    """
    yields, equilibrium, dead, limits = statics(bridge, at, loaded, pulls, water)
    objective = -np.eye(len(limits))[-1]
    return -solved(objective, yields, equilibrium, dead, limits)


def least_pulls(bridge, at, required, pulls):
    """Least sum of `pulls`, N, with which a safe state carries `required` times 1 kN at X = `at`."""
    yields, equilibrium, dead, limits = statics(bridge, at, 0, pulls, None)
    limits[-1] = required, required
    objective = np.zeros(len(limits))
    objective[-1 - len(pulls) : -1] = 1e3
    return solved(objective, yields, equilibrium, dead, limits)


def solved(objective, yields, equilibrium, dead, limits):
    found = linprog(objective, yields, np.zeros(len(yields)), equilibrium, -dead, limits)
    assert found.status == 0, found.message
    return found.fun


def statics(bridge, at, loaded, pulls, water):
    """Yield rows, equilibrium, dead loads and limits of the forces, in kN: joint ends, pulls, load factor."""
    parts = [arch(bridge, k) for k in range(bridge.spans)] + [
        pier(bridge, k) for k in range(bridge.spans - 1)
    ]
    outlines = {name: outline for own, _ in parts for name, outline in own.items()}
    joints = [joint for _, own in parts for joint in own]
    row = {name: 3 * k for k, name in enumerate(outlines)}
    count = 4 * len(joints) + len(pulls) + 1
    equilibrium = np.zeros((3 * len(row), count))
    dead = np.zeros(3 * len(row))

    def add(to, force, name, sign=1.0):
        if name in row:  # neither abutment nor ground
            to[row[name] : row[name] + 3] += sign * force

    for name, outline in outlines.items():
        area, centre = measures(outline)
        add(dead, -area * bridge.gamma * bridge.depth / 1e3 * np.array([0.0, 1.0, centre[0]]), name)
    top = [bridge.point(loaded, bridge.rings, j)[0] for j in range(bridge.voussoirs + 1)]
    own = loaded, bridge.rings - 1, int(np.searchsorted(top, at)) - 1
    add(equilibrium[:, -1], -LOAD / 1e3 * np.array([0.0, 1.0, at]), own)
    yields = np.zeros((4 * len(joints), count))
    for t, (point, direction, _, *ends) in enumerate(pulls):
        for name, sign in zip(ends, (1.0, -1.0), strict=True):
            add(equilibrium[:, 4 * len(joints) + t], wrench(point, direction), name, sign)
    for c, (i, j, p, q, friction) in enumerate(joints):
        length = np.linalg.norm(q - p)
        along = (q - p) / length
        normal = np.array([along[1], -along[0]])
        normal *= np.sign(normal @ (measures(outlines[j])[1] - (p + q) / 2))  # into j
        heads = np.zeros(2) if water is None else WATER * (water - np.array([p[1], q[1]]))
        pushes = bridge.depth * length / 6e3 * np.array([[2, 1], [1, 2]]) @ heads  # linear between the ends
        for e, end in enumerate((p, q)):
            for name, sign in ((j, 1.0), (i, -1.0)):
                add(dead, pushes[e] * wrench(end, normal), name, sign)
                for d, direction in enumerate((normal, along)):
                    add(equilibrium[:, 4 * c + 2 * e + d], wrench(end, direction), name, sign)
            place = 4 * c + 2 * e
            yields[place, [place, place + 1]] = -friction, 1.0
            yields[place + 1, [place, place + 1]] = -friction, -1.0
    limits = [(0, None), (None, None)] * (2 * len(joints))
    limits += [(low / 1e3, high / 1e3) for _, _, (low, high), *_ in pulls]
    return yields, equilibrium, dead, [*limits, (None, None)]


def wrench(point, direction):
    """Force of unit size along `direction`, and its moment about the origin."""
    return np.array([*direction, point[0] * direction[1] - point[1] * direction[0]])


def measures(outline):
    """Area and centroid of a polygon (n, 2)."""
    x, y = outline.T
    cross = x * np.roll(y, -1) - np.roll(x, -1) * y
    area = cross.sum() / 2
    sums = outline + np.roll(outline, -1, axis=0)
    return abs(area), (sums * cross[:, None]).sum(axis=0) / (6 * area)

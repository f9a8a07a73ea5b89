"""Load factors by another program: forces at the corners of joints, wrenches about the origin, HiGHS.

Only the corners and normals of joints are the library's; weights come from hulls, ties from their anchors.
Cones of friction and dowels are cut by tangent planes until none is violated, or for as many rounds as bring
the optimum to ten digits: forces that do not matter wander on.
"""

import numpy as np
from scipy.optimize import linprog
from scipy.spatial import ConvexHull

EXACT = 1e-8  # of a mean weight: the most by which a cone may be violated, in space
ROUNDS = 40
TIGHT = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}


def wrench(force, at):
    return np.concatenate([force, np.cross(at, force)])


def weighed(block):
    """Weight of a convex block and its centroid, from tetrahedra over its hull."""
    corners = np.array(block.vertices)
    middle = corners.mean(axis=0)
    parts = corners[ConvexHull(corners).simplices] - middle
    volumes = np.abs(np.linalg.det(parts)) / 6
    centroid = middle + volumes @ parts.sum(axis=1) / 4 / volumes.sum()
    return volumes.sum() * block.unit_weight, centroid


class CornerForces:
    """Columns of a linear program for one structure: what acts on its free blocks, N and N m."""

    def __init__(self, model, push, divisor=1.0):
        self.place = {block.name: k for k, block in enumerate(model.free_blocks)}
        self.columns, self.low, self.high, self.cones, self.costs = [], [], [], [], []
        self.dead, self.live = np.zeros((2, 6 * len(self.place)))
        weights = [weighed(block) for block in model.free_blocks]
        self.unit = np.mean([weight for weight, _ in weights])
        for block, (weight, at) in zip(model.free_blocks, weights, strict=True):
            self.dead += self.on(block.name, wrench([0, 0, -weight], at))
            self.live += self.on(block.name, wrench(weight * np.array(push) / np.linalg.norm(push), at))
        for one in model.interfaces:
            for at in one.corners:
                n, t, s = (self.pair(one, axis, at, k) for k, axis in enumerate(one.axes[[2, 0, 1]]))
                self.cones.append((n, t, s, one.joint.friction / divisor))

    def on(self, name, given):
        found = np.zeros((len(self.place), 6))
        if name in self.place:
            found[self.place[name]] = given
        return found.ravel()

    def column(self, values, low, high, cost=0.0):
        kept = self.columns, self.low, self.high, self.costs
        for values_of, value in zip(kept, (values, low, high, cost), strict=True):
            values_of.append(value)
        return len(self.columns) - 1

    def pair(self, one, axis, at, tangential):
        """A unit force on block j and its opposite on block i; a normal one only pushes."""
        push = wrench(axis, at)
        return self.column(
            self.on(one.block_j, push) - self.on(one.block_i, push), -np.inf if tangential else 0.0, np.inf
        )

    def tie(self, block_i, at_i, block_j, at_j, most, prestress=0.0, cost=0.0):
        """Tension from the prestress, which stays, to the most; `cost` is that of 1 N."""
        along = np.subtract(at_j, at_i) / np.linalg.norm(np.subtract(at_j, at_i))
        ends = self.on(block_i, wrench(along, at_i)) + self.on(block_j, wrench(-along, at_j))
        self.column(ends, prestress / self.unit, most / self.unit, cost)

    def dowel(self, one, at, most):
        self.cones.append((None, self.pair(one, one.axes[0], at, 1), self.pair(one, one.axes[1], at, 1),
                           most / self.unit))  # fmt: skip

    def solved(self, cost, live, load_factor):
        """Least cost, N or 1, of forces that carry the loads; `live` is a column where given."""
        columns, low, high = np.array(self.columns).T, [*self.low], [*self.high]
        if live is not None:
            columns, low, high = (
                np.column_stack([columns, live / self.unit]),
                [*low, -np.inf],
                [*high, np.inf],
            )
        right = -(self.dead + load_factor * self.live) / self.unit
        cuts = [self.cut(cone, k * np.pi / 4, columns.shape[1]) for cone in self.cones for k in range(8)]
        for _ in range(ROUNDS):
            rows, most = (np.array(part) for part in zip(*cuts, strict=True))
            found = linprog(
                cost, rows, most, columns, right, list(zip(low, high, strict=True)), method="highs"
            )
            assert found.status == 0, found.message
            over = [
                self.cut((n, t, s, limit), np.arctan2(found.x[s], found.x[t]), columns.shape[1])
                for n, t, s, limit in self.cones
                if np.hypot(found.x[t], found.x[s]) > limit * (1.0 if n is None else found.x[n]) + EXACT
            ]
            if not over:
                break
            cuts += over
        return found.fun

    @staticmethod
    def cut(cone, angle, count):
        n, t, s, limit = cone
        row = np.zeros(count)
        row[[t, s]] = np.cos(angle), np.sin(angle)
        if n is None:
            return row, limit
        row[n] = -limit
        return row, 0.0

    def load_factor(self):
        return -self.solved([*np.zeros(len(self.columns)), -1.0], self.live, 0.0)

    def least(self, load_factor=0.0):
        """Least sum of costs, N, at a load factor."""
        return self.unit * self.solved(self.costs, None, load_factor)

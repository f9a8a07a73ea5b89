"""A state whose backward error is asked for: what yields, what is near to it and what stands still."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array, Flags, Indices, positions
from limitblocks.evidence.limits import ROUNDING, Limits
from limitblocks.evidence.measure import Measure
from limitblocks.evidence.residuals import TOLERANCE
from limitblocks.evidence.sought import Sought
from limitblocks.problem import Flow, State
from limitblocks.problem.places import places

STILL = TOLERANCE / 2  # what the rates of a place are worth in the load factor: below it the place is still


@dataclass(frozen=True, eq=False)
class Given:
    """A state whose backward error is asked for, with what does not depend on the answer."""

    flow: Flow
    state: State

    @cached_property
    def G(self) -> sparse.csr_array:
        """The flow at the state."""
        return self.flow.matrix(self.state.x)

    @cached_property
    def _entries(self) -> tuple[Indices, Indices, tuple[int, int]]:
        """Row of each entry of G, its place in a table by linear row or cone and stress, and its shape."""
        p, position = self.flow.problem, positions(self.flow.problem.stress_interface)
        row, most = np.repeat(np.arange(len(p.g)), np.diff(self.G.indptr)), int(position.max()) + 1
        return row, p.cones.member[row] * most + position[self.G.indices], (p.cones.degree, most)

    def by_member(self, y: Array) -> Array:
        """Return the strain rates -G^T y of each linear row and cone by itself, shape (degree, k)."""
        row, place, shape = self._entries
        sums = np.bincount(place, -y[row] * self.G.data, shape[0] * shape[1])
        return np.asarray(sums.reshape(shape), dtype=float)

    @cached_property
    def sought(self) -> Sought:
        """Where the mechanism is sought."""
        return Sought.of(self.flow, self.state)

    @cached_property
    def limits(self) -> Limits:
        """Strengths of the rows."""
        return Limits(self.flow.problem)

    @cached_property
    def change(self) -> Array:
        """Relative change of strength that takes each linear row and cone to yield, (degree,)."""
        return self.limits.changes(self.state.x)

    @cached_property
    def places(self) -> tuple[Indices, Indices]:
        """Place of each linear row and cone (degree,) and of each stress (s,)."""
        return places(self.flow.problem)

    @cached_property
    def force(self) -> Array:
        """Force at each place over what acts on the lesser block; infinite where rows need it, (places,)."""
        p, force = self.flow.problem, self.largest(self.state.x)
        apart = np.abs(p.cones.margin(p.g)) > ROUNDING * np.abs(p.g)[p.cones.heads]
        force[self.places[0][apart]] = np.inf  # without a force these rows do not yield
        return force

    @cached_property
    def across(self) -> Flags:
        """Which stresses press or bend: what opens a joint, not what slides or twists it, (s,)."""
        normal = np.tile([0.0, 0.0, 1.0, 1.0, 1.0, 0.0], len(self.flow.problem.interfaces))
        return np.asarray(abs(self.flow.problem.resultants).T @ normal > 0.0)

    @cached_property
    def acting(self) -> Array:
        """What acts on the lesser block of the interface of each stress, (s,)."""
        return Measure(self.flow.problem, self.state).interface[self.flow.problem.stress_interface]

    def largest(self, x: Array) -> Array:
        """Largest size of stresses (s,) over what acts on the lesser block, (places,)."""
        members, stresses = self.places
        sizes = np.zeros(max(members.max(initial=0), stresses.max()) + 1)
        np.maximum.at(sizes, stresses, np.abs(x) / self.acting)
        return sizes

    @cached_property
    def reach(self) -> Array:
        """What the forces that act on the lesser block can do to each linear row and cone, (degree,)."""
        p = self.flow.problem
        weights = abs(p.F) @ self.acting
        return np.asarray(np.bincount(p.cones.member, weights, minlength=p.cones.degree), dtype=float)

    @cached_property
    def lever(self) -> Array:
        """What makes rotations comparable to displacements: half the size of the interface, else 1, (s,)."""
        p = self.flow.problem
        is_force = abs(p.resultants).T @ np.tile([1.0, 1.0, 1.0, 0.0, 0.0, 0.0], len(p.interfaces)) > 0.0
        return np.where(is_force, 1.0, p.half_sides.max(axis=1)[p.stress_interface])

    @cached_property
    def off(self) -> Array:
        """Least change of strength, or of forces by what acts, that takes each row to yield, (degree,)."""
        p, s = self.flow.problem, self.flow.problem.F @ self.state.x + self.flow.problem.g
        apart = np.abs(p.cones.margin(s)) / np.where(self.reach > 0.0, self.reach, np.inf)
        return np.asarray(np.minimum(np.minimum(np.abs(self.change), self.force[self.places[0]]), apart))

    def still(self, u: Array) -> Flags:
        """Which places do not move, by what their rates are worth in the load factor, (places,)."""
        measure = Measure(self.flow.problem, self.state)
        worth = np.abs(self.flow.problem.C @ u) * measure.pressed[self.flow.problem.stress_interface]
        largest = np.zeros(len(self.force))
        np.maximum.at(largest, self.places[1], worth)
        return np.asarray(largest <= STILL * measure.power)

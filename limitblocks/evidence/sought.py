"""Where the mechanism of a state is sought: of a symmetric one in its plane or one half, else in the whole.

What is found in the plane is lifted: Eqs (54) and (55) hold in the whole, docs/planar.md has the proof.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array, Flags
from limitblocks.problem import Flow, LimitProblem, State
from limitblocks.problem.plane import Choice, Planar, mirror_of, reduced
from limitblocks.problem.plane.planar import SYMMETRIC


@dataclass(frozen=True, eq=False)
class Sought:
    """A flow rule and a state in the `plane` of `whole`, or the whole ones where there is none."""

    whole: LimitProblem
    plane: Planar | None
    flow: Flow
    state: State

    @classmethod
    def of(cls, flow: Flow, state: State) -> Sought:
        """Return the problem in which the mechanism of a state is sought."""
        mirror = mirror_of(flow.problem)
        if mirror is not None and (mirror.flat or flow.constant):
            plane = reduced(flow.problem, mirror, Choice.EVERY)
            own = plane.averaged(state)
            if _same(plane.lifted(own), state):
                return cls(flow.problem, plane, replace(flow, problem=plane.problem), own)
        return cls(flow.problem, None, flow, state)

    @property
    def problem(self) -> LimitProblem:
        """The problem in which the mechanism is sought."""
        return self.flow.problem

    @cached_property
    def G(self) -> sparse.csr_array:
        """The flow at the state."""
        return self.flow.matrix(self.state.x)

    def every(self, flags: Flags) -> Flags:
        """Of which linear rows and cones all that they merge of the whole are flagged, (degree,)."""
        if self.plane is None:
            return flags
        missing = abs(self.plane.multipliers).T @ (~flags[self.whole.cones.member]).astype(float)
        cones = self.problem.cones
        return np.asarray(np.bincount(cones.member, missing, cones.degree) == 0.0)

    def merged(self, values: Array) -> Array:
        """Return the means of values (degree,) of the whole over what linear rows and cones merge."""
        if self.plane is None:
            return values
        cones = self.whole.cones
        means = abs(self.plane.multipliers).T @ (cones.identity * values[cones.member])
        return np.asarray(means[self.problem.cones.heads])

    def lifted(self, u: Array, y: Array) -> tuple[Array, Array]:
        """Return rates and multipliers of the whole."""
        if self.plane is None:
            return u, y
        state = self.plane.lifted(replace(self.state, u=u, y=y))
        return state.u, state.y


def _same(one: State, other: State) -> bool:
    """Whether two states are the same but for rounding."""
    pairs = (one.x, other.x), (one.u, other.u), (one.y, other.y)
    return all(np.abs(a - b).max(initial=0.0) <= SYMMETRIC * np.abs(b).max(initial=0.0) for a, b in pairs)

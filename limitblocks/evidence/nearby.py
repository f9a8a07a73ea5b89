"""The problem near a given one of which a state is an exact solution, and that state."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array, Indices
from limitblocks.evidence.limits import Flags, Limits
from limitblocks.evidence.measure import Measure
from limitblocks.evidence.nearest_mechanism import nearest_mechanism
from limitblocks.problem import Flow, LimitProblem, State, Turning
from limitblocks.problem.places import places

NOISE = 1e-12  # of the largest rate of an interface: a flow below it is rounding
ACROSS = 0.01  # of a change along the ray of a cone: as large a change across it, which turns the flow
ROUNDS = 4  # of stilling what would have to flow in another direction


class Nearby(NamedTuple):
    """A changed problem with the state that solves it, and the changes.

    `flow` is the changed problem with its flow, `state` the exact state, `mechanism` the given state with the
    exact mechanism. `limits` (degree,) is the relative change of strength of each linear row and cone,
    `turned` (places,) the tangent of the angle by which the flow at a place turns, `loads` (n,) the change of
    the loads of a block over what acts on it.
    """

    flow: Flow
    state: State
    mechanism: State
    limits: Array
    turned: Array
    loads: Array

    @property
    def change(self) -> float:
        """The largest change of the model."""
        return max(float(np.abs(part).max(initial=0.0)) for part in (self.limits, self.turned, self.loads))


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
        p, (members, stresses) = self.flow.problem, self.places
        force = np.zeros(max(members.max(initial=0), stresses.max()) + 1)
        acting = Measure(p, self.state).interface[p.stress_interface]
        np.maximum.at(force, stresses, np.abs(self.state.x) / acting)
        force[members[p.cones.margin(p.g) != 0.0]] = np.inf  # without a force these rows do not yield
        return force

    def ways(self, level: float) -> sparse.csr_array:
        """Columns (R, R) along which multipliers change: of a cone its ray, and less readily across it.

        At places whose force may be dropped, any.
        """
        p = self.flow.problem
        s, free = p.F @ self.state.x + p.g, (self.force <= level)[self.places[0]]
        blocks, first = [], p.cones.linear
        for rows in p.cones.groups:
            z = s[rows][:, 1:]
            size = np.linalg.norm(z, axis=1)
            d = z / np.where(size > 0.0, size, 1.0)[:, None]
            way = np.zeros((*rows.shape, rows.shape[1]))
            way[:, 0, 0], way[:, 1:, 0] = 1.0, -d
            way[:, 1:, 1:] = ACROSS * (np.eye(d.shape[1]) - d[:, :, None] * d[:, None, :])
            way[free[first : first + len(rows)] | (size == 0.0)] = np.eye(rows.shape[1])
            blocks.append(way)
            first += len(rows)
        return p.cones.matrix(np.ones(p.cones.linear), blocks)


def nearby(given: Given, level: float) -> Nearby | None:
    """Return a problem of which the state is exact, changed by about `level`; None if none is found.

    What is within `level` of yield, or carries no more than that, may flow; all else is still.
    """
    p, members = given.flow.problem, given.places[0]
    near = np.minimum(np.abs(given.change), given.force[members]) <= level
    if (~near & (given.change > 0.0)).any():
        return None
    ways, best = given.ways(level), None
    held = np.where((given.force <= level)[given.places[1]], 0.0, given.state.x)
    u, y = given.state.u, _aligned(p, given.G, held, given.state.y)
    for _ in range(ROUNDS):
        mechanism = nearest_mechanism(p, given.G, u, y, near, ways)
        if mechanism is None:
            break
        u, y = mechanism
        solved = _changed(given, u, y)
        if best is None or solved.change < best.change:
            best = solved
        wild = (solved.turned > level)[members]
        wild[: p.cones.linear] = False
        if not wild.any():
            break
        near = near & ~wild
    return best


def _changed(given: Given, u: Array, y: Array) -> Nearby:
    """The problem of which stresses and mechanism are exact, where the flow of `y` is that of u."""
    flow, state, members = given.flow, given.state, given.places[0]
    p = flow.problem
    rates = np.sqrt(by_member(p, given.G, y).power(2).sum(axis=1))
    flows = rates > NOISE * np.abs(p.C @ u).max(initial=0.0)
    y = np.where(flows[p.cones.member], y, 0.0)
    change = np.where(flows | (given.change > 0.0), given.change, 0.0)
    needed = np.zeros(len(given.force))
    np.maximum.at(needed, members, np.abs(change))
    dropped = needed > given.force
    *_, turned = _flowing(given, u, y, change, dropped)
    dropped |= turned > given.force
    scaled, exact, G, turned = _flowing(given, u, y, change, dropped)
    dead = p.C.T @ exact.x - state.load_factor * p.live
    # dilatancy and what turns about the centre of pressure are in G and pivot already
    problem = replace(scaled, G=G, dead=dead, pivot=flow.pivot, friction=np.ones(len(p.friction)))
    return Nearby(
        Flow(problem, 0.0, flow.turning, flow.softening),
        exact,
        State(state.load_factor, state.x, u, y),
        np.where(dropped[members], 0.0, change),
        turned,
        np.abs(dead - p.dead).reshape(-1, 6).max(axis=1) / Measure(p, state).loaded,
    )


def _flowing(
    given: Given, u: Array, y: Array, change: Array, dropped: Flags
) -> tuple[LimitProblem, State, sparse.csr_array, Array]:
    """Problem of changed limits, state without the forces dropped, G, and the angles by which it turns."""
    members, stresses = given.places
    x = np.where(dropped[stresses], 0.0, given.state.x)
    scaled = given.limits.scaled(np.where(dropped[members], 0.0, change))
    exact = State(given.state.load_factor, x, u, _aligned(scaled, given.G, x, y))
    return scaled, exact, *_turned(given, exact, y)


def by_member(p: LimitProblem, G: sparse.csr_array, y: Array) -> sparse.csr_array:
    """Strain rates -G^T y of each linear row and cone by itself, shape (degree, s)."""
    rows = np.arange(p.cones.height)
    each = sparse.coo_array((-y, (p.cones.member, rows)), shape=(p.cones.degree, p.cones.height))
    return sparse.csr_array(each.tocsr() @ G)


def _aligned(p: LimitProblem, G: sparse.csr_array, x: Array, y: Array) -> Array:
    """The multipliers of cones on the ray opposite to s = F x + g, nearest in flow to those given."""
    s, ray, fixed = p.F @ x + p.g, y.copy(), [np.zeros(p.cones.linear, dtype=bool)]
    for rows in p.cones.groups:
        z, w = s[rows][:, 1:], y[rows]
        size = np.linalg.norm(z, axis=1)
        w[:, 0] = np.maximum(w[:, 0], np.linalg.norm(w[:, 1:], axis=1))  # at the apex anything within K
        on = size > 0.0
        w[on] = np.column_stack([np.ones(on.sum()), -z[on] / size[on, None]])
        ray[rows] = w
        fixed.append(on)
    given, along = by_member(p, G, y), by_member(p, G, ray)
    both, square = given.multiply(along).sum(axis=1), along.power(2).sum(axis=1)
    part = np.maximum(both, 0.0) / np.where(square > 0.0, square, 1.0)
    return np.asarray(np.where(np.concatenate(fixed), part, 1.0)[p.cones.member] * ray)


def _turned(given: Given, exact: State, asked: Array) -> tuple[sparse.csr_array, Array]:
    """G of twists about the centroid with G^T y = -C u wherever y flows, and its angle at places (places,).

    Place by place the least change of G: y e^T / (y . y), with e = C u + G^T y.
    """
    flow, p, y = given.flow, given.flow.problem, exact.y
    rows, columns, count = given.places[0][p.cones.member], given.places[1], len(given.force)
    rates = p.C @ exact.u
    meant = np.bincount(rows, weights=np.abs(asked), minlength=count) > 0.0
    off = np.where(meant[columns], rates + flow.matrix(exact.x).T @ y, 0.0)
    square = np.bincount(rows, weights=y * y, minlength=count)
    share = y / np.where(square > 0.0, square, 1.0)[rows]
    R, s = p.F.shape
    Y = sparse.coo_array((share, (np.arange(R), rows)), shape=(R, count)).tocsr()
    E = sparse.coo_array((off, (columns, np.arange(s))), shape=(count, s)).tocsr()
    centroid = Flow(p, flow.dilatancy, Turning.CENTROID).matrix(exact.x)
    lever = _levers(p)
    by_angle, whole = (np.bincount(columns, (lever * v) ** 2, count) for v in (off, rates))
    tangent = np.where(by_angle > 0.0, np.inf, 0.0)
    np.divide(np.sqrt(by_angle), np.sqrt(whole), out=tangent, where=whole > 0.0)
    return sparse.csr_array(centroid - Y @ E), tangent


def _levers(p: LimitProblem) -> Array:
    """What makes rotations of interfaces comparable to displacements: half of their size, else 1, (s,)."""
    forces = np.tile([1.0, 1.0, 1.0, 0.0, 0.0, 0.0], len(p.interfaces))
    is_force = abs(p.resultants).T @ forces > 0.0
    return np.where(is_force, 1.0, p.half_sides.max(axis=1)[p.stress_interface])

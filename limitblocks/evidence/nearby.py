"""The problem near a given one of which a state is an exact solution, and that state."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array, Flags
from limitblocks.evidence.given_state import Given
from limitblocks.evidence.measure import Measure
from limitblocks.evidence.moved_forces import moved_forces
from limitblocks.evidence.multipliers import near_yield
from limitblocks.evidence.nearest_mechanism import nearest_mechanism
from limitblocks.problem import Flow, State, Turning

TURN = 1e-3  # flow that turns less readily than this is lost in rounding
ROUNDED = 1e-9  # of what acts on the lesser block: what rounding of coordinates far from the origin moves
SLIGHT = 0.1  # of what acts on the lesser block: a joint that carries more keeps its force


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


class _Choice(NamedTuple):
    """Rates and multipliers of the changed problem, the flow of each linear row and cone, and which do."""

    u: Array
    y: Array
    each: Array
    flows: Flags


class _Flowing(NamedTuple):
    """What stresses ask for: change of limits (degree,), multipliers, and by how much the flow is off.

    `off` is C u + G^T y wherever y flows, (s,), `angle` the tangent of the angle of it at places (places,).
    """

    change: Array
    y: Array
    off: Array
    angle: Array


def nearby(given: Given, level: float, held: bool = False) -> Nearby | None:
    """Return a problem of which the state may be exact, changed by about `level`; None if none is found.

    What is within `level` of yield, or carries no more than that, may flow; all else is still. The mechanism
    is the nearest one; where it is `held`, rates are as dear as directions of flow.
    """
    at = given.sought
    p, state = at.problem, at.state
    near = given.off <= level
    if (~near & (given.change > 0.0)).any():
        return None
    moves = np.where((given.force <= SLIGHT)[given.places[0]], level * given.reach, 0.0)
    turn = max(level, TURN)
    may = near_yield(p.cones, p.F @ state.x + p.g, at.every(near), at.merged(moves), turn)
    mechanism = nearest_mechanism(p, at.G, state.u, state.y, may, turn if held else 1.0)
    return None if mechanism is None else _changed(given, *at.lifted(*mechanism))


def _changed(given: Given, u: Array, y: Array) -> Nearby:
    """The problem of which stresses and mechanism are exact, where the flow of `y` is that of u."""
    flow, state = given.flow, given.state
    p = flow.problem
    each = given.by_member(y)
    rates = np.sqrt((each * each).sum(axis=1))
    flows = (rates > 0.0) & ~given.still(u)[given.places[0]]
    choice = _Choice(u, np.where(flows[p.cones.member], y, 0.0), each * flows[:, None], flows)
    x = _cheapest(given, choice)
    at = _flowing(given, x, choice)
    dead = p.balance @ x - state.load_factor * p.live
    # dilatancy and what turns about the centre of pressure are in G and pivot already
    scaled = given.limits.scaled(_finite(at.change))
    ones = np.ones(len(p.friction))
    problem = replace(scaled, G=_turned(given, at), dead=dead, pivot=flow.pivot, friction=ones)
    return Nearby(
        Flow(problem, 0.0, flow.turning, flow.softening),
        State(state.load_factor, x, u, at.y),
        State(state.load_factor, state.x, u, choice.y),
        at.change,
        at.angle,
        np.abs(dead - p.dead).reshape(-1, 6).max(axis=1) / Measure(p, state).loaded,
    )


def _cheapest(given: Given, choice: _Choice) -> Array:
    """Stresses (s,), place by place as they are, moved to where what flows yields, or none at all.

    Or shear alone, as cohesion lets an open joint carry. Each costs the largest change of limits, flow and
    loads of the place that it asks for; loads change only where the place, or what it loses beside shear,
    carries little, or by rounding of what acts on the lesser block.
    """
    members, stresses = given.places
    own, little = given.state.x, given.force <= SLIGHT
    moved = moved_forces(given.flow.problem, own, choice.y, given.places)
    shear = np.where(given.across, 0.0, own)
    sheared = (given.largest(own - shear) <= SLIGHT) & (given.largest(shear) > 0.0)
    choices = ((own, little), (moved, little), (np.zeros_like(own), little), (shear, sheared))
    costs = []
    for x, slight in choices:
        at = _flowing(given, x, choice)
        by = given.largest(x - own)
        cost = np.maximum(at.angle, np.where(slight | (by <= ROUNDED), by, np.inf))
        np.maximum.at(cost, members, np.abs(at.change))
        costs.append(cost)
    best = np.argmin(costs, axis=0)[stresses]
    return np.asarray(np.array([x for x, _ in choices])[best, np.arange(len(own))])


def _flowing(given: Given, x: Array, choice: _Choice) -> _Flowing:
    """What stresses x ask for."""
    flow, p = given.flow, given.flow.problem
    change = given.limits.changes(x)
    change = np.where(choice.flows | (change > 0.0), change, 0.0)
    y = _aligned(given, given.limits.rows(x, _finite(change)), choice)
    rows, columns, count = given.places[0][p.cones.member], given.places[1], len(given.force)
    rates = p.C @ choice.u
    meant = np.bincount(rows, weights=np.abs(choice.y), minlength=count) > 0.0
    off = np.where(meant[columns], rates + flow.strains(x, y), 0.0)
    by_angle, whole = (np.bincount(columns, (given.lever * v) ** 2, count) for v in (off, rates))
    tangent = np.where(by_angle > 0.0, np.inf, 0.0)
    np.divide(np.sqrt(by_angle), np.sqrt(whole), out=tangent, where=whole > 0.0)
    return _Flowing(change, y, off, tangent)


def _finite(change: Array) -> Array:
    """Changes of limits that can be made."""
    return np.where(np.isfinite(change), change, 0.0)


def _aligned(given: Given, s: Array, choice: _Choice) -> Array:
    """The multipliers of cones on the ray opposite to s = F x + g, nearest in flow to those given."""
    p, y = given.flow.problem, choice.y
    if not p.cones.groups:
        return y
    ray, fixed = y.copy(), [np.zeros(p.cones.linear, dtype=bool)]
    for rows in p.cones.groups:
        z, w = s[rows][:, 1:], y[rows]
        size = np.linalg.norm(z, axis=1)
        w[:, 0] = np.maximum(w[:, 0], np.linalg.norm(w[:, 1:], axis=1))  # at the apex anything within K
        on = size > 0.0
        w[on] = np.column_stack([np.ones(on.sum()), -z[on] / size[on, None]])
        ray[rows] = w
        fixed.append(on)
    along = given.by_member(ray)
    both, square = (choice.each * along).sum(axis=1), (along * along).sum(axis=1)
    part = np.maximum(both, 0.0) / np.where(square > 0.0, square, 1.0)
    return np.asarray(np.where(np.concatenate(fixed), part, 1.0)[p.cones.member] * ray)


def _turned(given: Given, at: _Flowing) -> sparse.csr_array:
    """G of twists about the centroid with G^T y = -C u wherever y flows.

    Place by place the least change of G: y e^T / (y . y), with e = C u + G^T y.
    """
    p, y = given.flow.problem, at.y
    rows, columns, count = given.places[0][p.cones.member], given.places[1], len(given.force)
    square = np.bincount(rows, weights=y * y, minlength=count)
    share = y / np.where(square > 0.0, square, 1.0)[rows]
    R, s = p.F.shape
    Y = sparse.coo_array((share, (np.arange(R), rows)), shape=(R, count)).tocsr()
    E = sparse.coo_array((at.off, (columns, np.arange(s))), shape=(count, s)).tocsr()
    centroid = replace(given.flow, turning=Turning.CENTROID).matrix(given.state.x)
    return sparse.csr_array(centroid - Y @ E)

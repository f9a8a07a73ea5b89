"""Chains of blocks, such as arches and columns: along them runs a line of thrust."""

from __future__ import annotations

from collections import defaultdict

import numpy as np

from limitblocks.arrays import Array
from limitblocks.evidence.interface_states import InterfaceStates
from limitblocks.geometry import Interface
from limitblocks.geometry.accuracy import ANGLE
from limitblocks.model import Model

Joint = tuple[int, ...]
At = dict[str, list[Joint]]


def crowded(model: Model) -> tuple[str, int] | None:
    """Return the first free block with more than two joints, and their number; None if there is none."""
    return next(((name, len(known)) for name, known in _meeting(model).items() if len(known) > 2), None)


def joints_between(model: Model) -> list[Joint]:
    """Return the joints in which two blocks touch, by the places of their interfaces; ties are none.

    Interfaces of the same two blocks in one plane are pieces of one joint: they carry one resultant.
    """
    pieces: dict[tuple[str, str], list[list[int]]] = defaultdict(list)
    for k, one in enumerate(model.interfaces):
        if getattr(one.joint, "word", ""):  # ties, dowels, fill and guides
            continue
        known = pieces[one.block_i, one.block_j]
        plane = next((own for own in known if _in_one_plane(model.interfaces[own[0]], one)), None)
        if plane is None:
            known.append([k])
        else:
            plane.append(k)
    return sorted(tuple(own) for known in pieces.values() for own in known)


def chains(model: Model) -> list[list[Joint]]:
    """Return the joints of each chain of blocks, from a support on; none if the blocks branch."""
    at, supports = _meeting(model), set(model.supports)
    if crowded(model):
        return []
    lines: list[list[Joint]] = []
    seen = set[Joint]()
    for joint in joints_between(model):
        own = model.interfaces[joint[0]]
        if joint not in seen and supports & {own.block_i, own.block_j}:
            lines.append(_chain(model, joint, at))
            seen.update(lines[-1])
    return lines


def thrust(states: InterfaceStates, chain: list[Joint]) -> Array:
    """Return where the joints of a chain (c, 3) press, global axes, m; NaN without a normal force.

    The resultant of pieces in one plane acts at the mean of their centres, weighted by their normal forces.
    """
    N = np.where(np.isnan(states.centre_of_pressure[:, 0]), 0.0, states.stress_resultants[:, 2])
    moments = N[:, None] * np.nan_to_num(states.centre_of_pressure)
    total = np.array([N[list(joint)].sum() for joint in chain])
    first = np.array([moments[list(joint)].sum(axis=0) for joint in chain])
    return np.asarray(first / np.where(total < 0.0, total, np.nan)[:, None])


def _in_one_plane(one: Interface, other: Interface) -> bool:
    """Whether two interfaces are parallel and the way between them lies along both, as faces that touch."""
    way = other.centroid - one.centroid
    off = max(abs(float(way @ own.axes[2])) for own in (one, other))
    return float(one.axes[2] @ other.axes[2]) >= np.cos(ANGLE) and off <= ANGLE * float(np.linalg.norm(way))


def _meeting(model: Model) -> At:
    """Joints in which each free block touches others, by the places of their interfaces."""
    supports, at = set(model.supports), defaultdict[str, list[Joint]](list)
    for joint in joints_between(model):
        own = model.interfaces[joint[0]]
        for name in {own.block_i, own.block_j} - supports:
            at[name].append(joint)
    return at


def _chain(model: Model, first: Joint, at: At) -> list[Joint]:
    chain = [first]
    while True:
        own = model.interfaces[chain[-1][0]]
        around = {joint for name in (own.block_i, own.block_j) for joint in at.get(name, ())}
        beyond = sorted(around - set(chain))
        if not beyond:
            return chain
        chain.append(beyond[0])

"""Vaults of crossing barrels over a square: groin and pavilion vault, mitred on the diagonals."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from limitblocks.arrays import Array
from limitblocks.geometry import Block
from limitblocks.joints import Joint
from limitblocks.model import Model
from limitblocks.structures.build import (
    HORIZONTAL,
    UNIT_WEIGHT,
    model_of,
    plain_numbers,
    refuse,
    refuse_fewer,
    refuse_many,
    refuse_not_positive,
)
from limitblocks.structures.convex import hull
from limitblocks.structures.rings import circular

SIDES = ("right", "back", "left", "front")  # towards +X, +Y, -X, -Y


@plain_numbers
def groin_vault(
    joint: Joint,
    *,
    radius: float,
    thickness: float,
    length: float,
    courses: int,
    stone_length: float,
    embrace: float = np.pi,
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = HORIZONTAL,
) -> Model:
    """Return a groin vault: the upper envelope of two equal barrels along X and Y, on its four corners.

    The courses of a web run along the axis of its barrel, from the groin, a diagonal, to its free edge; in
    every second one the head joints lie half a stone off. Bed joints are radial planes of the barrel. On the
    groins the stones of two webs meet in the vertical plane of the diagonal, so that they are convex.

    Parameters
    ----------
    joint : Joint
        Joint of all interfaces, the springings included.
    radius, thickness : float
        Of the barrels to the centreline, and of the vault, m.
    length : float
        Of either barrel along its axis, m; more than their width at the supports.
    courses : int
        Number of courses of a barrel from springing to springing; stones are named `side course.place`.
    stone_length : float
        Of a stone along its course, m; stones at the groin are up to 1.5 times as long.
    embrace : float
        Angle between the springings of a barrel, rad, up to pi.
    unit_weight : float
        N/m3.
    direction : sequence of float
        Direction of the live load, which is the weight.
    """
    refuse_not_positive(length=length, stone_length=stone_length)
    refuse_many(stone_length, length=length)
    refuse_fewer(2, courses=courses)
    ring, end = circular(radius, thickness, courses, embrace), length / 2
    feet = ring.skewbacks()
    half_width = max(np.abs(outline[:, 0]).max() for outline in feet.values())
    if end <= half_width:
        refuse([f"length is {length!r}, expected more than {2 * half_width:g} m, the width at the supports"])
    blocks: list[Block] = []
    for turn, side in enumerate(SIDES):
        for course, outline in enumerate(ring.voussoirs()):
            least = float(np.abs(outline[:, 0]).max()) + stone_length / 2
            cuts = end - stone_length * (np.arange(int(end / stone_length) + 1) + (course % 2) / 2)
            cuts = np.sort([end, *cuts[(cuts > least) & (cuts < end)]])
            corners = _with_crown(outline)
            starts = [np.abs(corners[:, 0]), *cuts[:-1]]
            blocks += [
                _turned(f"{side} {course + 1}.{k + 1}", _along_u(corners, *ends), turn, unit_weight)
                for k, ends in enumerate(zip(starts, cuts, strict=True))
            ]
    supports = [
        _turned(f"{side} {foot} support", _along_u(outline, np.abs(outline[:, 0]), end), turn)
        for turn, side in enumerate(SIDES)
        for foot, outline in feet.items()
    ]
    return model_of(blocks, supports, joint, direction, "groin vault")


@plain_numbers
def pavilion_vault(
    joint: Joint,
    *,
    radius: float,
    thickness: float,
    courses: int,
    stone_length: float,
    embrace: float = np.pi,
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = HORIZONTAL,
) -> Model:
    """Return a pavilion (cloister) vault: the lower envelope of two equal barrels, on its four sides.

    The courses run parallel to the sides, from diagonal to diagonal; in every second one the head joints lie
    half a stone off. On the diagonals the stones meet in their vertical plane. An odd number of courses has a
    square key.

    Parameters
    ----------
    joint : Joint
        Joint of all interfaces, the springings included.
    radius, thickness : float
        Of the barrels to the centreline, and of the vault, m.
    courses : int
        Number of courses of a barrel from springing to springing; stones are named `side course.place`, the
        course counted from the springing up.
    stone_length : float
        Of a stone along its course, m; those that reach from diagonal to diagonal are up to twice as long
        on their shortest edge, other stones at the diagonals up to 1.5 times.
    embrace : float
        Angle between opposite springings, rad, up to pi.
    unit_weight : float
        N/m3.
    direction : sequence of float
        Direction of the live load, which is the weight.
    """
    refuse_not_positive(radius=radius, stone_length=stone_length)
    refuse_many(stone_length, radius=radius)
    refuse_fewer(2, courses=courses)
    ring = circular(radius, thickness, courses, embrace)
    outlines = ring.voussoirs()[::-1]  # from the right springing up
    blocks = [
        _turned(f"{side} {course + 1}.{k + 1}", corners, turn, unit_weight)
        for turn, side in enumerate(SIDES)
        for course, outline in enumerate(outlines[: courses // 2])
        for k, corners in enumerate(_between_diagonals(outline, stone_length, course % 2))
    ]
    if courses % 2:
        (x, z) = outlines[courses // 2].T
        key = [(a, b, c) for a, c in zip(x, z, strict=True) for b in (-a, a)]
        blocks.append(hull("key", key, unit_weight))
    foot = ring.skewbacks()["right"]
    supports = [
        _turned(f"{side} support", next(_between_diagonals(foot, np.inf, 0)), turn)
        for turn, side in enumerate(SIDES)
    ]
    return model_of(blocks, supports, joint, direction, "pavilion vault")


def _with_crown(outline: Array) -> Array:
    """An outline (x, z) with its corners above x = 0 added where it lies on both sides of it."""
    if outline[:, 0].min() * outline[:, 0].max() >= 0.0:
        return outline
    crown = [(0.0, z) for z in np.unique(outline[:, 1])]
    return np.vstack([outline, crown])


def _along_u(outline: Array, start: Array | float, end: Array | float) -> Array:
    """Corners (u, v, z) of what an outline (v, z) sweeps along u from `start` to `end`, m."""
    v, z = outline.T
    return np.concatenate([np.column_stack([np.broadcast_to(u, v.shape), v, z]) for u in (start, end)])


def _between_diagonals(outline: Array, stone_length: float, odd: int) -> Iterator[Array]:
    """Yield the corners (u, v, z) of the stones of a course whose outline is (u, z), from v = -u to v = u."""
    u, z = outline.T
    end = float(u.min()) - stone_length / 2
    count = int(max(end, 0.0) / stone_length) + 2 if np.isfinite(stone_length) else 0
    cuts = stone_length * (np.arange(-count, count) + odd / 2) if count else np.array([])
    edges = [-u, *cuts[np.abs(cuts) < end], u]
    for start, stop in pairwise(edges):
        yield np.concatenate([np.column_stack([u, np.broadcast_to(v, u.shape), z]) for v in (start, stop)])


def _turned(name: str, corners: Array, quarters: int, unit_weight: float | None = None) -> Block:
    """The hull of corners turned by quarters of a circle about the Z axis, anticlockwise from above."""
    u, v, z = corners.T
    for _ in range(quarters):
        u, v = -v, u
    return hull(name, np.column_stack([u, v, z]), unit_weight)

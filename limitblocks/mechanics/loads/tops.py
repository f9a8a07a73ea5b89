"""Loads that fall from above on whatever block is there: a force at a place in plan, a line load."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from limitblocks.arrays import Array, Indices, sums
from limitblocks.errors import ModelError
from limitblocks.geometry import Block
from limitblocks.mechanics.loads.load import Load, Place, Vector, of, place, triple, vector
from limitblocks.shown import coordinates

_SIDE = 1e-9  # of a block's size squared: a triangle with a smaller area in plan counts as vertical
_SAME = 1e-9  # of a line: edges that cut it as near to each other are one, met once for each of its faces
_TOUCH = 1e-9  # of the blocks' size: an edge belongs to both its blocks, and the first of them counts


@dataclass(frozen=True)
class TopForce:
    """A force (N, global axes) at the place `at` (x, y) in plan, on top of the highest block there."""

    force: Vector
    at: Place

    def on(self, blocks: Sequence[Block]) -> Array:
        """Return forces and moments at the centroids, shape (n, 6)."""
        return _on_tops(np.array([self.force]), np.array([self.at]), blocks)

    def in_words(self) -> str:
        """Return the term in words."""
        where = f"on top of the structure at {coordinates(self.at)} m in plan"
        return f"a force {triple(self.force, 1e3)} kN {where}"


@dataclass(frozen=True)
class LineLoad:
    """A force per length in plan (N/m, global axes) on top of all blocks below a line in plan, in (x, y)."""

    force_per_length: Vector
    start: Place
    end: Place

    def __post_init__(self) -> None:
        if self.start == self.end:
            raise ModelError(f"line load: start and end are both {self.start}, expected two places in plan")

    def on(self, blocks: Sequence[Block]) -> Array:
        """Return forces and moments at the centroids, shape (n, 6)."""
        start, end = np.array(self.start), np.array(self.end)
        # between two edges seen from above, the line runs on one plane face: its middle stands for it
        s = _crossings(start, end - start, blocks)
        length = float(np.linalg.norm(end - start)) * np.diff(s)
        middles = start + np.outer((s[1:] + s[:-1]) / 2.0, end - start)
        return _on_tops(np.outer(length, self.force_per_length), middles, blocks)

    def in_words(self) -> str:
        """Return the term in words."""
        line = f"from {coordinates(self.start)} m to {coordinates(self.end)} m in plan"
        return f"a line load {triple(self.force_per_length, 1e3)} kN/m on top of the structure, {line}"


def top_force(force: Sequence[float], at: Sequence[float]) -> Load:
    """Return a force (N, global axes) at the place `at` (x, y), m, on top of the highest free block there.

    It acts where the vertical line through the place meets the top of the block; at an edge of two blocks,
    on the first of them in the model.

    Raises
    ------
    ModelError
        If a number is not finite. Where the load meets the blocks (as a Model is made): if there is no free
        block at the place.
    """
    return of(TopForce(vector(force, "force"), place(at, "place")))


def line_load(force_per_length: Sequence[float], start: Sequence[float], end: Sequence[float]) -> Load:
    """Return a line load, `force_per_length` (N per m of plan, global axes), from `start` to `end` (x, y), m.

    Each stretch of the line acts on top of the highest free block below it; resultants and moments are exact.

    Raises
    ------
    ModelError
        If a number is not finite or the line has no length. Where the load meets the blocks (as a Model is
        made): if there is no free block below a part of the line.
    """
    a, b = place(start, "line load: start"), place(end, "line load: end")
    return of(LineLoad(vector(force_per_length, "line load: force per length"), a, b))


def tops(blocks: Sequence[Block], places: Array) -> tuple[Indices, Array]:
    """Return the highest block above each place in plan, -1 where there is none, and the height of its top.

    Parameters
    ----------
    places : Array, shape (m, 2)
        m.

    Returns
    -------
    Indices, Array
        Position in `blocks` and Z in m, shape (m,).
    """
    corners, first, sizes = _upward(blocks)
    flat, end = corners[:, :, :2], np.roll(corners[:, :, :2], -1, axis=1)
    side = end - flat
    inwards = np.stack([-side[..., 1], side[..., 0]], axis=-1) / np.linalg.norm(side, axis=2, keepdims=True)
    far = np.einsum("tsa,tsa->ts", inwards, np.roll(end, -1, axis=1) - flat)  # of the corner across
    near = np.einsum("tsa,ma->tsm", inwards, places) - np.einsum("tsa,tsa->ts", inwards, flat)[..., None]
    touch = _TOUCH * sizes[:, None]
    z = np.einsum("tsm,ts->tm", near, np.roll(corners[:, :, 2], -2, axis=1) / far)
    z = np.clip(z, corners[:, :, 2].min(axis=1)[:, None], corners[:, :, 2].max(axis=1)[:, None])
    every = np.where((near >= -touch[:, None]).all(axis=1), z, -np.inf)
    height, touch = np.maximum.reduceat(every, first), touch[first]
    best = (height >= height.max(axis=0) - touch).argmax(axis=0)
    highest = height[best, np.arange(len(places))]
    return np.where(np.isfinite(highest), best, -1), highest


def covered(start: Array, end: Array, blocks: Sequence[Block]) -> Array:
    """Return the parts of a line in plan, from `start` to `end` (2,), with a block below, m; (k, 2, 2)."""
    s, owner = stretches(start, end, blocks)
    change = np.diff(np.concatenate([[False], owner >= 0, [False]]).astype(int))
    ends = np.stack([s[change == 1], s[change == -1]], axis=1)
    return np.asarray(start + ends[..., None] * (end - start))


def stretches(start: Array, end: Array, blocks: Sequence[Block]) -> tuple[Array, Indices]:
    """Return where edges cut a line in plan, from `start` to `end` (2,), and the block below each part.

    Places from 0 to 1, shape (k + 1,), and positions in `blocks`, -1 where there is none, shape (k,).
    """
    s = _crossings(start, end - start, blocks)
    owner, _ = tops(blocks, start + np.outer((s[1:] + s[:-1]) / 2.0, end - start))
    return s, owner


def _upward(blocks: Sequence[Block]) -> tuple[Array, Indices, Array]:
    """Triangles (t, 3, 3) of faces that look up, the first of each block, the sizes of their blocks."""
    points, sides = [block.vertices for block in blocks], [block.triangles for block in blocks]
    sizes = np.array([block.size for block in blocks])
    owner = np.repeat(np.arange(len(blocks)), [len(side) for side in sides])
    before = np.cumsum([0, *(len(own) for own in points[:-1])])
    corners = np.concatenate(points)[np.concatenate(sides) + before[owner][:, None]]
    (a, b), (c, d) = np.moveaxis(corners[:, 1:, :2] - corners[:, :1, :2], 0, 2)
    up = a * d - b * c > _SIDE * sizes[owner] ** 2  # twice the area in plan
    return corners[up], np.searchsorted(owner[up], np.arange(len(blocks))), sizes[owner[up]]


def _on_tops(forces: Array, places: Array, blocks: Sequence[Block]) -> Array:
    """Forces (m, 3) on the tops of blocks at `places` (m, 2) as a load, shape (n, 6)."""
    owner, z = tops(blocks, places)
    if (owner < 0).any():
        x, y = places[owner < 0][0].tolist()
        raise ModelError(f"a load acts at x = {x:g} m, y = {y:g} m, where there is no free block")
    centroids = np.stack([block.centroid for block in blocks])
    arms = np.column_stack([places, z]) - centroids[owner]
    return sums(owner, np.concatenate([forces, np.cross(arms, forces)], axis=1), len(blocks))


def _crossings(start: Array, along: Array, blocks: Sequence[Block]) -> Array:
    """Where a line in plan, 0 to 1, crosses edges of blocks seen from above, ends included; ascending."""
    a = np.concatenate([block.vertices[block.mesh.start, :2] for block in blocks])
    b = np.concatenate([block.vertices[block.mesh.end, :2] for block in blocks])
    side = b - a
    across = along[0] * side[:, 1] - along[1] * side[:, 0]
    meet = across != 0.0  # one along it may cut it anywhere, which changes nothing
    a, side, across, off = a[meet], side[meet], across[meet], (a - start)[meet]
    s = (off[:, 0] * side[:, 1] - off[:, 1] * side[:, 0]) / across
    t = (off[:, 0] * along[1] - off[:, 1] * along[0]) / across
    within = (s < 1.0 - _SAME) & (t > -_SAME) & (t < 1.0 + _SAME) & (s > 0.0)
    s = np.unique(np.concatenate([[0.0, 1.0], s[within]]))
    return np.asarray(s[np.diff(s, prepend=-1.0) > _SAME])

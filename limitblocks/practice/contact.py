"""Contacts of displaced blocks, as each of both sees them, for capacity curves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any

import numpy as np

from limitblocks.arrays import Array, Flags, Indices, repeated
from limitblocks.geometry import Block, Interface
from limitblocks.geometry.ends import ends_of
from limitblocks.joints import Dowel, Tie
from limitblocks.practice.resting import half_way, rims_at

CLOSED = 1e-9  # gap over the size of the structure that counts as none
RIM = 1e-6  # of the size of a joint: a corner as near to the rim of a face is at it
EVEN = 1e-3  # of a unit normal: rims that face across a hinge as much alike end together

BOND = ("cohesion", "tensile_strength")  # strengths of a joint that hold until it moves


@dataclass(frozen=True, eq=False)
class DisplacedContacts:
    """Interfaces as each of their blocks sees them: m of them, with k corners in a row.

    Attributes
    ----------
    interfaces : tuple of Interface
        With their polygons and joints, on the faces that they rest on; half way where edges meet.
    ends : Indices, shape (m, 2)
        Blocks i and j, in model order.
    on_i, on_j : Array, shape (k, 3)
        Corners as material points of blocks i and of blocks j, global axes, m; they coincide where closed. A
        tie has one, its two anchors; a dowel has the point where it crosses the joint as often as corners.
    axes_i, axes_j : Array, shape (m, 3, 3)
        Axes as they turn with blocks i and with blocks j.
    rims_i, rims_j : Array, shape (k, s, 2)
        The rims of both faces at the corners (:func:`~.resting.rims_at`), as the contact was last
        :func:`seated`; NaN at corners that were open.
    pressed : Flags, shape (m,)
        Which carried a force at the last answer: these do not slide while the structure falls.
    taut : Array, shape (m,)
        Distance of the anchors of a tie at which it is taut, m: as it was first, and more once it has
        yielded. What a strip has, which is between points that coincide, is along the normal of its joint.
    """

    interfaces: tuple[Interface, ...]
    ends: Indices
    on_i: Array
    on_j: Array
    axes_i: Array
    axes_j: Array
    rims_i: Array
    rims_j: Array
    pressed: Flags
    taut: Array

    @property
    def interface(self) -> Interface:
        """The interface of a single contact."""
        (own,) = self.interfaces
        return own

    def __len__(self) -> int:
        return len(self.interfaces)

    def __getitem__(self, which: int | Sequence[int] | Indices | Flags) -> DisplacedContacts:
        """Return some of the contacts, in any order."""
        numbers = np.atleast_1d(np.arange(len(self))[which])
        part, position = repeated(np.bincount(self.of)[numbers])
        corners = self.first[numbers][part] + position
        interfaces = tuple(self.interfaces[k] for k in numbers)
        taken = {key: getattr(self, key)[corners if key in OF_CORNERS else numbers] for key in ARRAYS}
        return DisplacedContacts(interfaces, **taken)

    @cached_property
    def tied(self) -> Flags:
        """Which are ties, shape (m,)."""
        return np.array([isinstance(own.joint, Tie) for own in self.interfaces], dtype=bool)

    @cached_property
    def rigid(self) -> Flags:
        """Where a gap never turns negative, shape (m,): not of a dowel, which keeps none."""
        return np.array([not isinstance(own.joint, Dowel) for own in self.interfaces])

    @cached_property
    def of(self) -> Indices:
        """Contact of each corner, shape (k,)."""
        corners = np.array([len(own.polygon) for own in self.interfaces], dtype=np.int64)
        return repeated(np.where(self.tied, 1, corners))[0]

    @cached_property
    def first(self) -> Indices:
        """First corner of each contact, shape (m,)."""
        return np.flatnonzero(np.diff(self.of, prepend=-1))

    @cached_property
    def half_way(self) -> Array:
        """Axes half way between both blocks, shape (m, 3, 3)."""
        return half_way(self.axes_i, self.axes_j)

    @cached_property
    def hinge(self) -> Array:
        """Where the planes of both faces cross, times the sine of their angle, shape (m, 3)."""
        return np.cross(self.axes_i[:, 2], self.axes_j[:, 2])

    @cached_property
    def on_face_i(self) -> Flags:
        """Which corners of block j rest on the face of block i, shape (k,); the others are of i on that of j.

        The faces come nearer across the hinge. The one whose rim there faces that way more ends, and rests on
        the other; where both end, that of j rests where it is farther: the separating axis of convex bodies.
        """
        normals = np.stack([self.axes_i[:, 2], self.axes_j[:, 2]])
        off_i, off_j = np.einsum("ka,ska->sk", self.on_j - self.on_i, normals[:, self.of])
        nearer = np.cross(self.hinge, normals.sum(axis=0))
        nearer /= np.maximum(np.linalg.norm(nearer, axis=1, keepdims=True), 1e-300)
        end_i, end_j = (
            np.einsum("ksa,kab,kb->ks", rims, axes[self.of, :2], nearer[self.of]).max(axis=1)
            for rims, axes in ((self.rims_i, self.axes_i), (self.rims_j, self.axes_j))
        )  # NaN where a corner was open
        return np.asarray((end_j > end_i + EVEN) | ((off_i >= off_j) & ~(end_i > end_j + EVEN)))

    @cached_property
    def axes(self) -> Array:
        """Axes of each corner, shape (k, 3, 3): two half way between both blocks, then normal to the face.

        The last of a tie points from block j to block i: its gap is what it is slack.
        """
        normal = np.where(self.on_face_i[:, None], self.axes_i[self.of, 2], self.axes_j[self.of, 2])
        normal = np.where(self.tied[self.of, None], -self.line[self.of], normal)
        return np.concatenate([self.half_way[self.of, :2], normal[:, None]], axis=1)

    @cached_property
    def rest(self) -> Array:
        """Corners that rest on a face, global axes, m, shape (k, 3)."""
        return np.where(self.on_face_i[:, None], self.on_j, self.on_i)

    @cached_property
    def line(self) -> Array:
        """Direction of ties from block i to block j, shape (m, 3); a strip is normal to its joint."""
        long = np.array([bool(getattr(own.joint, "length", 0.0)) for own in self.interfaces])
        way = np.where(long[:, None], (self.on_j - self.on_i)[self.first], self.half_way[:, 2])
        return np.asarray(way / np.linalg.norm(way, axis=1, keepdims=True))

    @cached_property
    def ways(self) -> Array:
        """Way from the corners on i to those on j along their axes, m, shape (k, 3); the gap comes last."""
        slack = np.outer(self.taut[self.of], [0.0, 0.0, 1.0])
        return np.asarray(np.einsum("kab,kb->ka", self.axes, self.on_j - self.on_i) + slack)

    @cached_property
    def least(self) -> Array:
        """Least gap of each contact, m, shape (m,)."""
        return np.minimum.reduceat(self.ways[:, 2], self.first)

    def any(self, corners: Flags) -> Flags:
        """Which contacts have any of the corners (k,), shape (m,)."""
        return np.logical_or.reduceat(corners, self.first)

    def yielded(self, which: Flags) -> DisplacedContacts:
        """Return the contacts, some ties (m,) as long as they are; a large step may have shortened one."""
        return replace(self, taut=self.taut - np.where(which, np.minimum(self.least, 0.0), 0.0))

    def parted(self, which: Flags) -> DisplacedContacts:
        """Return the contacts, some (m,) of them without their bond."""
        bare = list(self.interfaces)
        for k in np.flatnonzero(which):
            joint: Any = bare[k].joint
            bare[k] = replace(bare[k], joint=replace(joint, **dict.fromkeys(bond(joint), 0.0)))
        return replace(self, interfaces=tuple(bare))


ARRAYS = [field.name for field in fields(DisplacedContacts)][1:]
OF_CORNERS = ("on_i", "on_j", "rims_i", "rims_j")


def bond(joint: object) -> tuple[str, ...]:
    """Return the names of the strengths that a joint has by a bond."""
    return tuple(name for name in BOND if getattr(joint, name, 0.0))


def together(parts: Sequence[DisplacedContacts]) -> DisplacedContacts:
    """Return the contacts of all parts."""
    arrays = {key: [getattr(own, key) for own in parts] for key in ARRAYS}
    joined: dict[str, Any] = {
        key: _stacked(of) if key.startswith("rims") else np.concatenate(of) for key, of in arrays.items()
    }
    return DisplacedContacts(tuple(one for own in parts for one in own.interfaces), **joined)


def _stacked(rims: Sequence[Array]) -> Array:
    """Rims of corners (k, s, 2) in one array, those of corners with fewer sides filled with zeros."""
    most = max(one.shape[1] for one in rims)
    return np.concatenate([np.pad(one, ((0, 0), (0, most - one.shape[1]), (0, 0))) for one in rims])


def contacts_of(interfaces: Sequence[Interface], blocks: Sequence[Block]) -> DisplacedContacts:
    """Return interfaces as both of their blocks see them where they are closed."""
    taut = np.array([own.joint.length if isinstance(own.joint, Tie) else 0.0 for own in interfaces])
    corners = []
    for own, length in zip(interfaces, taut, strict=True):
        spread = 0.0 if isinstance(own.joint, Dowel) else 1.0
        flat = np.zeros((1, 2)) if isinstance(own.joint, Tie) else spread * own.polygon
        points, half = own.centroid + flat @ own.axes[:2], length / 2.0 * own.axes[2]
        corners.append([points - half, points + half])
    on_i, on_j = np.concatenate(corners, axis=1)
    axes, rims = np.stack([own.axes for own in interfaces]), np.zeros((len(on_i), 1, 2))
    ends, pressed = ends_of(blocks, interfaces), np.zeros(len(interfaces), dtype=bool)
    found = DisplacedContacts(tuple(interfaces), ends, on_i, on_j, axes, axes, rims, rims, pressed, taut)
    return seated(found, blocks)


def seated(own: DisplacedContacts, blocks: Sequence[Block], size: float = 0.0) -> DisplacedContacts:
    """Return contacts with the rims of their faces at their corners as they are; NaN where these are open.

    `size` is that of the structure, m.
    """
    least = [RIM * float(np.abs(one.polygon).max()) for one in own.interfaces]
    opened = (own.ways[:, 2] > 10.0 * CLOSED * size)[:, None, None]

    def rims(side: int, out: float, on: Array, turned: Array) -> Array:
        each = zip(own.ends[:, side], np.split(on, own.first[1:]), turned, least, own.tied, strict=True)
        found = [
            np.zeros((1, 1, 2)) if tied else rims_at(blocks[k], out * axes[2], points, axes, near)
            for k, points, axes, near, tied in each
        ]
        return np.where(opened, np.nan, _stacked(found))

    return replace(own, rims_i=rims(0, 1.0, own.on_i, own.axes_i), rims_j=rims(1, -1.0, own.on_j, own.axes_j))

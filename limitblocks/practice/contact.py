"""Contacts of displaced blocks, as each of both sees them, for capacity curves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from limitblocks.arrays import Array, read_only
from limitblocks.geometry import Block, Interface
from limitblocks.joints import Dowel, Tie
from limitblocks.practice.resting import half_way, resting_axes, rims_at

CLOSED = 1e-9  # gap over the size of the structure that counts as none
RIM = 1e-6  # of the size of a joint: a corner as near to the rim of a face is at it
EVEN = 1e-3  # of a unit normal: rims that face across a hinge as much alike end together

BOND = ("cohesion", "tensile_strength")  # strengths of a joint that hold until it moves

Truths = npt.NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Contact:
    """An interface as each of its blocks sees it.

    Attributes
    ----------
    interface : Interface
        With its polygon and joint, on the face that it rests on; half way where edges meet.
    ends : tuple of int
        Blocks i and j, in model order.
    on_i, on_j : Array, shape (k, 3)
        Its corners as material points of block i and of block j, global axes, m; they coincide where it is
        closed. A tie has its two anchors, a dowel the point where it crosses the joint, k times.
    taut : float
        Distance of the anchors of a tie at which it is taut, m: as it was first, and more once it has
        yielded. What a strip has, which is between points that coincide, is along the normal of its joint.
    axes_i, axes_j : Array, shape (3, 3)
        Its axes as they turn with block i and with block j.
    rims_i, rims_j : Array, shape (k, s, 2)
        The rims of both faces at the corners (:func:`~.resting.rims_at`), as the contact was last
        :func:`seated`; NaN at corners that were open.
    pressed : bool
        Whether it carried a force at the last answer: it does not slide while the structure falls.
    """

    interface: Interface
    ends: tuple[int, int]
    on_i: Array
    on_j: Array
    axes_i: Array
    axes_j: Array
    rims_i: Array
    rims_j: Array
    pressed: bool = False
    taut: float = 0.0

    @cached_property
    def half_way(self) -> Array:
        """Axes half way between both blocks, shape (3, 3)."""
        return half_way(self.axes_i, self.axes_j)

    @cached_property
    def on_face_i(self) -> Truths:
        """Which corners of block j rest on the face of block i, shape (k,); the others are of i on that of j.

        The faces come nearer across the hinge. The one whose rim there faces that way more ends, and rests on
        the other; where both end, that of j rests where it is farther: the separating axis of convex bodies.
        """
        way, hinge = self.on_j - self.on_i, np.cross(self.axes_i[2], self.axes_j[2])
        farther = way @ self.axes_i[2] >= way @ self.axes_j[2]
        nearer = np.cross(hinge, self.axes_i[2] + self.axes_j[2])
        nearer = nearer / max(float(np.linalg.norm(nearer)), 1e-300)
        end_i, end_j = (
            (rims @ (axes[:2] @ nearer)).max(axis=1)
            for rims, axes in ((self.rims_i, self.axes_i), (self.rims_j, self.axes_j))
        )  # NaN where a corner was open
        return np.asarray((end_j > end_i + EVEN) | (farther & ~(end_i > end_j + EVEN)))

    @cached_property
    def axes(self) -> Array:
        """Axes of each corner, shape (k, 3, 3): two half way between both blocks, then normal to the face.

        The last of a tie points from block j to block i: its gap is what it is slack.
        """
        if self.tied:
            return np.concatenate([self.half_way[:2], -self.line[None]])[None]
        normal = np.where(self.on_face_i[:, None], self.axes_i[2], self.axes_j[2])
        sides = np.broadcast_to(self.half_way[:2], (len(normal), 2, 3))
        return np.concatenate([sides, normal[:, None]], axis=1)

    @cached_property
    def rest(self) -> Array:
        """Corners that rest on a face, global axes, m, shape (k, 3)."""
        return np.where(self.on_face_i[:, None], self.on_j, self.on_i)

    @cached_property
    def line(self) -> Array:
        """Direction of a tie from block i to block j, shape (3,); a strip is normal to its joint."""
        joint: Any = self.interface.joint
        way = self.on_j[0] - self.on_i[0] if joint.length else self.half_way[2]
        return np.asarray(way / np.linalg.norm(way))

    @cached_property
    def ways(self) -> Array:
        """Way from the corners on i to those on j along their axes, m, shape (k, 3); the gap comes last."""
        slack = np.array([0.0, 0.0, self.taut])
        return np.asarray(np.einsum("kab,kb->ka", self.axes, self.on_j - self.on_i) + slack)

    @property
    def yielded(self) -> Contact:
        """The tie as long as it is now; a large step may have shortened one that yields at its start."""
        return replace(self, taut=self.taut - min(float(self.ways[0, 2]), 0.0))

    @property
    def tied(self) -> bool:
        """True of a tie."""
        return isinstance(self.interface.joint, Tie)

    @property
    def rigid(self) -> bool:
        """True where a gap never turns negative: not of a dowel, which keeps none."""
        return not isinstance(self.interface.joint, Dowel)

    @property
    def bond(self) -> tuple[str, ...]:
        """Names of the strengths that its joint has by a bond."""
        return tuple(name for name in BOND if getattr(self.interface.joint, name, 0.0))

    @property
    def parted(self) -> Contact:
        """The contact without its bond."""
        joint: Any = self.interface.joint
        bare = replace(joint, **dict.fromkeys(self.bond, 0.0)) if self.bond else joint
        return replace(self, interface=replace(self.interface, joint=bare))


def contact(own: Interface, blocks: Sequence[Block], place: dict[str, int]) -> Contact:
    """Return an interface as both of its blocks see it where it is closed."""
    taut = own.joint.length if isinstance(own.joint, Tie) else None
    half = None if taut is None else taut / 2.0 * own.axes[2]
    spread = 0.0 if isinstance(own.joint, Dowel) else 1.0
    corners = own.centroid + spread * own.polygon @ own.axes[:2]
    on_i = corners if half is None else (own.centroid - half)[None]
    on_j = corners if half is None else (own.centroid + half)[None]
    ends, rims = (place[own.block_i], place[own.block_j]), np.zeros((len(on_i), 1, 2))
    found = Contact(own, ends, on_i, on_j, own.axes, own.axes, rims, rims)
    return seated(found, blocks) if taut is None else replace(found, taut=taut)


def seated(own: Contact, blocks: Sequence[Block], size: float = 0.0) -> Contact:
    """Return a contact with the rims of its faces at its corners as they are now; NaN where these are open.

    `size` is that of the structure, m.
    """
    i, j = (blocks[k] for k in own.ends)
    least = RIM * float(np.abs(own.interface.polygon).max())
    rims_i = rims_at(i, own.axes_i[2], own.on_i, own.axes_i, least)
    rims_j = rims_at(j, -own.axes_j[2], own.on_j, own.axes_j, least)
    opened = (own.ways[:, 2] > 10.0 * CLOSED * size)[:, None, None]
    return replace(own, rims_i=np.where(opened, np.nan, rims_i), rims_j=np.where(opened, np.nan, rims_j))


def placed(own: Contact, blocks: Sequence[Block]) -> Interface:
    """Return the interface on the face that its closed corners rest on; a tie between its anchors.

    A strip is normal to its joint, half way between both blocks: its line as the joint turns about an edge.
    """
    axes = own.half_way
    joint = own.interface.joint
    if isinstance(joint, Tie):
        n = own.line
        s1 = axes[0] - (axes[0] @ n) * n
        s1 = s1 / np.linalg.norm(s1)
        axes = np.stack([s1, np.cross(n, s1), n])
        centroid = (own.on_i[0] + own.on_j[0]) / 2.0
    else:
        gap, size = own.ways[:, 2], float(np.abs(own.interface.polygon).max())
        kept = gap <= gap.min() + 1e-6 * size
        middle = (own.on_i + own.on_j)[kept].mean(axis=0) / 2.0
        if not kept.all():
            resting = [blocks[k] for k in own.ends]
            axes = resting_axes(resting, own.axes_i, own.axes_j, own.rest[kept].mean(axis=0), size)
        elif own.rigid:  # half way of what slides and turns pieces would overlap; a dowel is a point
            middle, axes = own.on_i.mean(axis=0), own.axes_i
        centroid = middle - own.interface.polygon[kept].mean(axis=0) @ axes[:2]
        across = float((own.on_j - own.on_i)[kept].mean(axis=0) @ own.half_way[2])
        if abs(across) > 1e-6 * size:  # closed joints stay where they are to the last digit
            centroid += _short_of(own, across)
    return replace(own.interface, centroid=read_only(centroid), axes=read_only(axes))


def _short_of(own: Contact, gap: float) -> Array:
    """Return the way (3,), m, from half way across a gap to as far from the hinge as its corner is on a face.

    Corners at r from it part by 2 r sin(turn / 2), and half way is at r cos(turn / 2): pieces would overlap.
    """
    hinge = np.cross(own.axes_i[2], own.axes_j[2])
    sine = max(float(np.linalg.norm(hinge)), 1e-300)
    turn = np.arctan2(sine, own.axes_i[2] @ own.axes_j[2])
    return np.asarray(gap / 2.0 * np.tan(turn / 4.0) / sine * np.cross(own.half_way[2], hinge))

"""Blocks moved by finite displacements, with their contacts and loads, for capacity curves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.spatial import ConvexHull
from scipy.spatial.distance import pdist
from scipy.spatial.transform import Rotation

from limitblocks.arrays import Array, Flags, Indices, read_only, sums
from limitblocks.geometry import Block
from limitblocks.model import Model
from limitblocks.practice.carried_loads import carried_load, prestress
from limitblocks.practice.contact import CLOSED, DisplacedContacts, contacts_of
from limitblocks.practice.resting import resting_axes


@dataclass(frozen=True, eq=False)
class Assembly:
    """A displaced structure: its model as it is now, and the contacts of the model's interfaces, in order."""

    model: Model
    contacts: DisplacedContacts

    @cached_property
    def size(self) -> float:
        """Size of the structure: the largest distance of two vertices, m."""
        return size_of(self.model)

    @cached_property
    def at_rest(self) -> Motion:
        """The motion of blocks that stay where they are."""
        centres = np.stack([block.centroid for block in self.model.blocks])
        return Motion(centres, centres, np.tile(np.eye(3), (len(centres), 1, 1)))

    @cached_property
    def closed(self) -> Flags:
        """Which corners of the contacts are closed, shape (k,)."""
        return self.contacts.ways[:, 2] <= 10.0 * CLOSED * self.size

    @cached_property
    def tight(self) -> Indices:
        """Numbers of the contacts without ties that are slack."""
        return np.flatnonzero(~self.contacts.tied | self.contacts.any(self.closed))


def size_of(model: Model) -> float:
    """Return the size of a structure: the largest distance of two vertices, m."""
    points = np.concatenate([block.vertices for block in model.blocks])
    return float(pdist(points[ConvexHull(points - points[0]).vertices]).max())


def assembly_of(model: Model) -> Assembly:
    """Return the structure where it is first."""
    return Assembly(model, contacts_of(model.interfaces, model.blocks))


@dataclass(frozen=True, eq=False)
class Motion:
    """Rigid motions of n blocks: what is at r goes to at + (r - centres) turns.

    Attributes
    ----------
    centres, at : Array, shape (n, 3)
        Centroids before and after, m.
    turns : Array, shape (n, 3, 3)
        Transposed matrices of rotation.
    """

    centres: Array
    at: Array
    turns: Array

    def then(self, displacements: Array) -> Motion:
        """Return the motions followed by screws (n, 6) about the centroids: exact where their axes stay."""
        turns = Rotation.from_rotvec(displacements[:, 3:]).as_matrix().swapaxes(1, 2)
        return replace(self, at=self.at + _screw_shift(displacements), turns=self.turns @ turns)

    def of(self, k: int | Indices, points: Array) -> Array:
        """Return where points of blocks k go, m."""
        return np.asarray(self.at[k] + ((points - self.centres[k])[..., None, :] @ self.turns[k])[..., 0, :])

    def contacts(self, own: DisplacedContacts) -> DisplacedContacts:
        """Return contacts as their blocks see them then, their interfaces where they were."""
        i, j = own.ends.T
        on_i, on_j = self.of(i[own.of], own.on_i), self.of(j[own.of], own.on_j)
        axes_i, axes_j = own.axes_i @ self.turns[i], own.axes_j @ self.turns[j]
        return replace(own, on_i=on_i, on_j=on_j, axes_i=axes_i, axes_j=axes_j)


def moved(assembly: Assembly, motion: Motion) -> Assembly:
    """Return the structure after a motion.

    Loads keep their directions; added masses and point forces move with their blocks. The prestress of a tie
    stays on its line.
    """
    model, own = assembly.model, assembly.contacts
    stays = (motion.at == motion.centres).all(axis=1) & (motion.turns == np.eye(3)).all(axis=(1, 2))
    blocks = tuple(
        one if stays[k] else replace(one, vertices=motion.of(k, one.vertices))
        for k, one in enumerate(model.blocks)
    )
    contacts = placed(motion.contacts(own), blocks)
    pulls = [
        pair
        for k in np.flatnonzero(own.tied)
        for pair in zip(*(prestress(each.interfaces[k], model) for each in (own, contacts)), strict=True)
    ]
    place = {block.name: k for k, block in enumerate(model.blocks)}
    dead, live = (
        carried_load(load, lambda name, point: motion.of(place[name], point), pulls)
        for load in (model.dead, model.live)
    )
    there = replace(model, blocks=blocks, interfaces=contacts.interfaces, dead=dead, live=live)
    return Assembly(there, contacts)


def _screw_shift(displacements: Array) -> Array:
    """Displacements of the centroids (n, 3) where the velocities (n, 6) are those of screws that stay."""
    v, w = displacements[:, :3], displacements[:, 3:]
    angle = np.linalg.norm(w, axis=1)
    axis = w / np.where(angle > 0.0, angle, 1.0)[:, None]
    along = np.einsum("na,na->n", axis, v)[:, None] * axis
    sine = np.sinc(angle / np.pi)  # sin(angle) / angle
    versine = np.sin(angle / 2.0) * np.sinc(angle / (2.0 * np.pi))  # (1 - cos(angle)) / angle
    return np.asarray(along + sine[:, None] * (v - along) + versine[:, None] * np.cross(axis, v))


def placed(own: DisplacedContacts, blocks: Sequence[Block]) -> DisplacedContacts:
    """Return contacts with interfaces on the faces that their closed corners rest on; ties between anchors.

    A strip is normal to its joint, half way between both blocks: its line as the joint turns about an edge.
    """
    polygons = zip(own.interfaces, own.tied, strict=True)
    polygon = np.concatenate([np.zeros((1, 2)) if tied else one.polygon for one, tied in polygons])
    size = np.maximum.reduceat(np.abs(polygon).max(axis=1), own.first)
    kept = own.ways[:, 2] <= (own.least + 1e-6 * size)[own.of]
    whole, axes = ~own.any(~kept), own.half_way.copy()

    def middle(points: Array) -> Array:
        return sums(own.of[kept], points[kept], len(own)) / np.bincount(own.of[kept])[:, None]

    on_i, on_j, rest = middle(own.on_i), middle(own.on_j), middle(own.rest)
    for k in np.flatnonzero(~whole):
        pair = [blocks[end] for end in own.ends[k]]
        axes[k] = resting_axes(pair, own.axes_i[k], own.axes_j[k], rest[k], size[k])
    # half way of what slides and turns pieces would overlap; a dowel is a point
    flat = whole & own.rigid & ~own.tied
    axes[flat], at = own.axes_i[flat], np.where(flat[:, None], on_i, (on_i + on_j) / 2.0)
    n = own.line[own.tied]
    s1 = axes[own.tied, 0] - np.einsum("ma,ma->m", axes[own.tied, 0], n)[:, None] * n
    s1 /= np.linalg.norm(s1, axis=1, keepdims=True)
    axes[own.tied] = np.stack([s1, np.cross(n, s1), n], axis=1)
    gap = np.einsum("ma,ma->m", on_j - on_i, own.half_way[:, 2])
    apart = ~own.tied & (np.abs(gap) > 1e-6 * size)  # closed joints stay where they are to the last digit
    centroid = at - np.einsum("ma,mab->mb", middle(polygon), axes[:, :2])
    centroid = read_only(centroid + np.where(apart[:, None], _short_of(own, gap), 0.0))
    places = zip(own.interfaces, centroid, read_only(axes), strict=True)
    return replace(own, interfaces=tuple(replace(one, centroid=c, axes=a) for one, c, a in places))


def _short_of(own: DisplacedContacts, gap: Array) -> Array:
    """Return ways (m, 3), m, from half way across gaps to as far from the hinge as corners are on a face.

    Corners at r from it part by 2 r sin(turn / 2), and half way is at r cos(turn / 2): pieces would overlap.
    """
    sine = np.maximum(np.linalg.norm(own.hinge, axis=1), 1e-300)
    turn = np.arctan2(sine, np.einsum("ma,ma->m", own.axes_i[:, 2], own.axes_j[:, 2]))
    way = gap / 2.0 * np.tan(turn / 4.0) / sine
    return np.asarray(way[:, None] * np.cross(own.half_way[:, 2], own.hinge))

"""Blocks moved by finite displacements, with their contacts and loads, for capacity curves."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.spatial import ConvexHull
from scipy.spatial.distance import pdist
from scipy.spatial.transform import Rotation

from limitblocks.arrays import Array
from limitblocks.geometry import Block
from limitblocks.model import Model
from limitblocks.practice.carried_loads import carried_load, prestress
from limitblocks.practice.contact import CLOSED, Contact, contact, placed


@dataclass(frozen=True, eq=False)
class Assembly:
    """A displaced structure: its model as it is now, and the contacts of the model's interfaces, in order."""

    model: Model
    contacts: tuple[Contact, ...]

    @cached_property
    def size(self) -> float:
        """Size of the structure: the largest distance of two vertices, m."""
        points = np.concatenate([block.vertices for block in self.model.blocks])
        return float(pdist(points[ConvexHull(points - points[0]).vertices]).max())

    @cached_property
    def tight(self) -> list[int]:
        """Numbers of the contacts without ties that are slack."""
        least = 10.0 * CLOSED * self.size
        return [k for k, own in enumerate(self.contacts) if not own.tied or own.ways[0, 2] <= least]


def assembly_of(model: Model) -> Assembly:
    """Return the structure where it is first."""
    place = {block.name: k for k, block in enumerate(model.blocks)}
    return Assembly(model, tuple(contact(own, model.blocks, place) for own in model.interfaces))


def moved(assembly: Assembly, displacements: Array) -> Assembly:
    """Return the structure after screws (n, 6) about the centroids: exact where their axes stay.

    Loads keep their directions; added masses and point forces move with their blocks. The prestress of a tie
    stays on its line.
    """
    model = assembly.model
    centres = np.stack([block.centroid for block in model.blocks])
    turns = Rotation.from_rotvec(displacements[:, 3:]).as_matrix()
    shifts = _screw_shift(displacements)

    def at(k: int, points: Array) -> Array:
        return np.asarray(centres[k] + shifts[k] + (points - centres[k]) @ turns[k].T)

    blocks = tuple(
        Block(own.name, at(k, own.vertices), own.faces, own.unit_weight) if displacements[k].any() else own
        for k, own in enumerate(model.blocks)
    )
    contacts = []
    for own in assembly.contacts:
        i, j = own.ends
        turned = replace(
            own,
            on_i=at(i, own.on_i),
            on_j=at(j, own.on_j),
            axes_i=own.axes_i @ turns[i].T,
            axes_j=own.axes_j @ turns[j].T,
        )
        contacts.append(replace(turned, interface=placed(turned, blocks)))
    pulls = [
        pair
        for own, turned in zip(assembly.contacts, contacts, strict=True)
        for pair in zip(prestress(own.interface, model), prestress(turned.interface, model), strict=True)
    ]
    place = {block.name: k for k, block in enumerate(model.blocks)}
    dead, live = (
        carried_load(load, lambda name, point: at(place[name], point), pulls)
        for load in (model.dead, model.live)
    )
    interfaces = tuple(own.interface for own in contacts)
    now = replace(model, blocks=blocks, interfaces=interfaces, dead=dead, live=live)
    return Assembly(now, tuple(contacts))


def _screw_shift(displacements: Array) -> Array:
    """Displacements of the centroids (n, 3) where the velocities (n, 6) are those of screws that stay."""
    v, w = displacements[:, :3], displacements[:, 3:]
    angle = np.linalg.norm(w, axis=1)
    axis = w / np.where(angle > 0.0, angle, 1.0)[:, None]
    along = np.einsum("na,na->n", axis, v)[:, None] * axis
    sine = np.sinc(angle / np.pi)  # sin(angle) / angle
    versine = np.sin(angle / 2.0) * np.sinc(angle / (2.0 * np.pi))  # (1 - cos(angle)) / angle
    return np.asarray(along + sine[:, None] * (v - along) + versine[:, None] * np.cross(axis, v))

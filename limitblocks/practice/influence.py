"""Influence lines: the power of a vehicle through a mechanism, wherever it stands."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from limitblocks.arrays import Array, Indices
from limitblocks.mechanics.loads.tops import stretches
from limitblocks.model import Model
from limitblocks.practice.vehicles import Deck, Vehicle, half_lengths


@dataclass(frozen=True, eq=False)
class Line:
    """The line of a deck along the tops of the blocks, cut where it comes to another face.

    Attributes
    ----------
    model : Model
    vehicle : Vehicle
    deck : Deck
    ends : Array, shape (k + 1,)
        X of the ends of its stretches, m.
    owner : Indices, shape (k,)
        Free block below each, -1 where there is none.
    centres : Array, shape (n, 3)
        Centroids of the free blocks, m.
    """

    model: Model
    vehicle: Vehicle
    deck: Deck
    ends: Array
    owner: Indices
    centres: Array

    def standing(self, x: Array) -> list[tuple[Array, Array, Array]]:
        """Return load per length, N/m, start and end of each axle, the first axle at each X (m,)."""
        found, free = [], self.model.free_blocks
        for load, distance in zip(self.vehicle.axles, self.vehicle.distances, strict=True):
            half = half_lengths(free, self.vehicle.contact, self.deck, x + distance)
            found.append((load / (2.0 * half), x + distance - half, x + distance + half))
        return found

    def at_edges(self, x: Array) -> Array:
        """Return the places of the first axle (k,), among X (m,), where an axle begins or ends at an edge."""
        found = [
            np.interp(self.ends, side, x, left=np.nan, right=np.nan)
            for _, *sides in self.standing(x)
            for side in sides
        ]
        every = np.concatenate(found)
        return np.asarray(every[np.isfinite(every)])

    def powers(self, rates: Array, standing: list[tuple[Array, Array, Array]]) -> Array:
        """Return the power (m,) of a vehicle `standing` at m places, through rates (n, 6) of the blocks.

        That of an even load is the integral of the velocity downwards, which is linear along each stretch.
        """
        moving = rates[self.model.free][self.owner]
        off = self.ends[:-1] - self.centres[self.owner, 0], self.deck.y - self.centres[self.owner, 1]
        on, length = self.owner >= 0, np.diff(self.ends)
        first = np.where(on, moving[:, 4] * off[0] - moving[:, 3] * off[1] - moving[:, 2], 0.0)
        slope = np.where(on, moving[:, 4], 0.0)
        before = np.append(0.0, np.cumsum(length * (first + slope * length / 2.0)))

        def until(x: Array) -> Array:
            x = np.clip(x, self.ends[0], self.ends[-1])
            k = np.minimum(np.searchsorted(self.ends, x, "right"), len(length)) - 1
            way = x - self.ends[k]
            return np.asarray(before[k] + way * (first[k] + slope[k] * way / 2.0))

        return np.asarray(sum(load * (until(end) - until(start)) for load, start, end in standing))


def line_of(model: Model, vehicle: Vehicle, deck: Deck) -> Line:
    """Return the line along which a vehicle moves."""
    x = np.concatenate([block.vertices[:, 0] for block in model.free_blocks])
    low, high = float(x.min()), float(x.max())
    places, owner = stretches(np.array([low, deck.y]), np.array([high, deck.y]), model.free_blocks)
    centres = np.stack([block.centroid for block in model.free_blocks])
    return Line(model, vehicle, deck, low + (high - low) * places, owner, centres)

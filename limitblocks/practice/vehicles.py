"""Vehicles on arch bridges: axles through fill."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import ModelError, refuse_kind
from limitblocks.geometry import Block
from limitblocks.mechanics import Load
from limitblocks.mechanics.loads import line_load
from limitblocks.mechanics.loads.load import number
from limitblocks.mechanics.loads.tops import covered, tops
from limitblocks.model import Model, checked_model
from limitblocks.shown import coordinate, many

SUNK = 1e-6  # of the size of a block: how far a road may lie below it


@dataclass(frozen=True)
class Vehicle:
    """Axle loads at distances from the first axle, along X; the load factor multiplies all of them.

    Parameters
    ----------
    axles : sequence of float
        Axle loads, N.
    distances : sequence of float
        Of each axle from the first, along the deck, m; the first is 0.
    contact : float
        Length of a wheel's contact along the deck, m.

    Raises
    ------
    ModelError
        If a load is not positive, the numbers of loads and distances differ, or the first is not 0.
    """

    axles: tuple[float, ...]
    distances: tuple[float, ...] = (0.0,)
    contact: float = 0.3

    def __post_init__(self) -> None:
        if not all(isinstance(one, list | tuple | np.ndarray) for one in (self.axles, self.distances)):
            raise ModelError(
                f"axles are {self.axles!r} at {self.distances!r}, expected a list of N and a list of m"
            )
        axles = tuple(number(load, "axle load", "N", above=0.0) for load in self.axles)
        distances = tuple(number(way, "distance of an axle", "m") for way in self.distances)
        if not axles or len(axles) != len(distances):
            raise ModelError(
                f"a vehicle of {many(len(axles), 'axle')} has {many(len(distances), 'distance')}, expected "
                "one for each axle, from the first, which is at 0"
            )
        if distances[0]:
            raise ModelError(
                f"the first axle is {distances[0]:g} m from itself, expected 0: distances are from the first"
            )
        number(self.contact, "contact length", "m", above=0.0)
        object.__setattr__(self, "axles", axles)
        object.__setattr__(self, "distances", distances)


@dataclass(frozen=True)
class Deck:
    """The line along which a vehicle moves, and what spreads its axles.

    Parameters
    ----------
    level : float
        Z of the road, m.
    spread : float
        Horizontal over vertical of the dispersion through the fill along the deck: 0.5 of the usual 2:1 rule.
        An axle acts evenly on the length ``contact + 2 spread depth`` of the extrados, straight down.
    y : float, optional
        Of the line, m; left out, the middle of the blocks that can move. A block that spans the width takes
        the axle at the line, with its moment about the middle: how much that eccentricity counts depends on
        the joint, from nothing to most of the load factor; of several across the deck those below the line
        carry all.

    Raises
    ------
    ModelError
        If a number is out of range.
    """

    level: float
    spread: float = 0.5
    y: float | None = None

    def __post_init__(self) -> None:
        number(self.level, "level of the road", "m")
        number(self.spread, "spread", "", least=0.0)
        if self.y is not None:
            number(self.y, "line y of the deck", "m")

    def on(self, model: Model) -> Deck:
        """Return the deck with its line on a model."""
        checked_model(model)
        if self.y is not None:
            return self
        y = np.concatenate([block.vertices[:, 1] for block in model.free_blocks])
        return replace(self, y=float(y.min() + y.max()) / 2.0)


def vehicle_load(model: Model, vehicle: Vehicle, deck: Deck, position: float) -> Load:
    """Return the axles of a vehicle on the `deck` of a `model`, the first at X = `position`, m.

    They are dispersed through the fill. Axles beyond the blocks, on the approaches, put nothing on it.

    Raises
    ------
    ModelError
        If no axle stands on a free block, or the road is below the blocks under it.
    """
    refuse_kind(vehicle, Vehicle, "vehicle")
    refuse_kind(deck, Deck, "deck")
    total = axles(model, vehicle, deck.on(model), number(position, "position", "m"))
    if not total.terms:
        raise ModelError(f"no axle of the vehicle at x = {coordinate(position)} m stands on a free block")
    return total


def axles(model: Model, vehicle: Vehicle, deck: Deck, position: float) -> Load:
    """Return the axles as :func:`vehicle_load`, without terms where none stands on a free block."""
    places = zip(vehicle.axles, vehicle.distances, strict=True)
    each = [_axle(model, load, vehicle.contact, deck, position + distance) for load, distance in places]
    return sum(each, Load())


def half_lengths(free: Sequence[Block], contact: float, deck: Deck, x: Array) -> Array:
    """Return half the length, m, on which an axle at each X (k,) acts; see :class:`Deck`.

    Raises
    ------
    ModelError
        If the road is below the blocks there.
    """
    x_of = np.concatenate([block.vertices[:, 0] for block in free])
    nearest = np.clip(x, x_of.min(), x_of.max())  # beyond its end the fill is as deep as there
    owner, top = tops(free, np.column_stack([nearest, np.full(len(x), deck.y)]))
    depth = np.where(owner >= 0, deck.level - top, 0.0)
    for k in np.flatnonzero(depth < -SUNK * np.array([block.size for block in free])[owner])[:1].tolist():
        raise ModelError(
            f"the road at {coordinate(deck.level)} m is below the structure, {coordinate(top[k])} m high "
            f"at x = {coordinate(nearest[k])} m"
        )
    return np.asarray(contact / 2.0 + deck.spread * np.maximum(depth, 0.0))


def _axle(model: Model, load: float, contact: float, deck: Deck, x: float) -> Load:
    """One axle; the parts of its length that lie beyond the structure go to the approaches."""
    half = float(half_lengths(model.free_blocks, contact, deck, np.array([x]))[0])
    per_length = (0.0, 0.0, -load / (2.0 * half))
    parts = covered(np.array([x - half, deck.y]), np.array([x + half, deck.y]), model.free_blocks)
    return sum((line_load(per_length, a, b) for a, b in parts.tolist()), Load())

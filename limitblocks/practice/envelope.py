"""Where along a deck the load factor is least: influence lines of the mechanisms found so far tell it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from limitblocks.arrays import Array, Indices
from limitblocks.evidence.associated import Bounds
from limitblocks.mechanics.loads.tops import stretches
from limitblocks.model import Model
from limitblocks.practice.vehicles import Deck, Vehicle, half_lengths

PLACES = 1001  # at which mechanisms are compared, along the way and again about the worst
NEGLIGIBLE = 1e-3  # of the least load factor: a place that may have less by no more is not tried
ATTAINED = 1e-5  # the same about the worst place
NARROW = 2e-3  # of the way: a shorter part is not halved
CLOSE = 0.05  # of the least load factor: what the mechanisms found carry more where an axle ends at an edge

Found = dict[float, tuple[Bounds, Model] | None]  # by place; None where the load is unlimited


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


@dataclass(eq=False)
class Envelope:
    """The least load factor of the mechanisms found at places `x`, m: no place carries more than that."""

    line: Line
    at: Callable[[float], tuple[Bounds, Model] | None]
    found: Found
    x: Array
    factors: Array = field(init=False)

    def __post_init__(self) -> None:
        self.standing = self.line.standing(self.x)
        self.factors = np.full(len(self.x), np.inf)
        for one in self.found.values():
            self._lower(one)

    def _lower(self, found: tuple[Bounds, Model] | None) -> None:
        if found:
            bounds = found[0]  # its mechanism is such that the vehicle that it is of has the power 1 W
            power = self.line.powers(bounds.displacement_rates, self.standing)
            own = bounds.upper / np.where(power > 0.0, power, np.nan)
            self.factors = np.fmin(self.factors, own)

    @property
    def least(self) -> float:
        """Least static load factor found."""
        return min((float(one[0].lower) for one in self.found.values() if one), default=np.inf)

    def tried(self, x: float) -> float:
        """Try a place; the share by which it carries less than the mechanisms found before."""
        before = self.between(x, x)
        found = self.at(x)
        self._lower(found)
        return max(1.0 - float(found[0].lower) / before, 0.0) if found else 0.0

    def between(self, low: float, high: float) -> float:
        """Least load factor of the mechanisms between two places."""
        first, last = np.searchsorted(self.x, [low, high])
        return float(self.factors[max(first - 1, 0) : last + 1].min())

    def try_edges(self) -> None:
        """Try the places where an axle begins or ends at an edge: what it then loads may sink at once."""
        places = [float(x) for x in self.line.at_edges(self.x)]
        while places:
            carried = [self.between(x, x) for x in places]
            k = int(np.argmin(carried))
            if not carried[k] < (1.0 + CLOSE) * self.least:
                break
            self.tried(places.pop(k))

    def attain(self, share: float) -> None:
        """Try the place where the mechanisms found carry least until it does, but for a share of that."""
        while self.factors.min() < (1.0 - share) * self.least:
            x = float(self.x[self.factors.argmin()])
            if x in self.found:
                break
            self.tried(x)


def search(
    line: Line,
    at: Callable[[float], tuple[Bounds, Model] | None],
    found: Found,
    between: tuple[float, float],
    positions: int,
) -> None:
    """Try evenly spaced places, then where the load factor may be less; `at` puts them into `found`."""
    low, high = between
    known = Envelope(line, at, found, np.linspace(low, high, PLACES))
    places = np.linspace(low, high, positions).tolist()
    drops = {x: known.tried(x) for x in (*places[::2], *places[1::2])}
    parts = [(a, b, max(drops[a], drops[b])) for a, b in pairwise(places)]
    while parts:
        # halving a part may bring as much as halving what it is a part of did
        hopes = [(1.0 - drop) * known.between(a, b) if drop < 1.0 else 0.0 for a, b, drop in parts]
        k = int(np.argmin(hopes))
        if not hopes[k] < (1.0 - NEGLIGIBLE) * known.least:
            break
        a, b, _ = parts.pop(k)
        if b - a > NARROW * (high - low):
            drop = known.tried((a + b) / 2.0)
            parts += [(a, (a + b) / 2.0, drop), ((a + b) / 2.0, b, drop)]
    known.try_edges()
    worst = int(known.factors.argmin())
    about = known.x[[max(worst - 1, 0), min(worst + 1, PLACES - 1)]]
    Envelope(line, at, found, np.linspace(about[0], about[1], PLACES)).attain(ATTAINED)

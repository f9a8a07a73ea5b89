"""Loads on blocks: self weight, mass-proportional loads, forces and moments, and any sum of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.geometry import Block

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class MassProportional:
    """The weight of every block, acting at its centroid along the unit vector `direction`."""

    direction: Vector

    def on(self, blocks: Sequence[Block]) -> Array:
        """Return forces and moments at the centroids, shape (n, 6)."""
        load = np.zeros((len(blocks), 6))
        load[:, :3] = np.outer([block.weight for block in blocks], self.direction)
        return load


@dataclass(frozen=True)
class PointForce:
    """A force (N, global axes) on the block named `block` at the point `at` (m)."""

    block: str
    force: Vector
    at: Vector

    def on(self, blocks: Sequence[Block]) -> Array:
        """Return forces and moments at the centroids, shape (n, 6)."""
        load = np.zeros((len(blocks), 6))
        k = _position(self.block, blocks)
        load[k, :3] = self.force
        load[k, 3:] = np.cross(np.subtract(self.at, blocks[k].centroid), self.force)
        return load


@dataclass(frozen=True)
class Moment:
    """A moment (N m, global axes, right-hand rule) on the block named `block`."""

    block: str
    moment: Vector

    def on(self, blocks: Sequence[Block]) -> Array:
        """Return forces and moments at the centroids, shape (n, 6)."""
        load = np.zeros((len(blocks), 6))
        load[_position(self.block, blocks), 3:] = self.moment
        return load


LoadTerm = MassProportional | PointForce | Moment


@dataclass(frozen=True)
class Load:
    """A sum of load terms, each with a factor. Loads add up and can be multiplied by a number."""

    terms: tuple[tuple[float, LoadTerm], ...] = ()

    def __add__(self, other: Load) -> Load:
        return Load(self.terms + other.terms)

    def __mul__(self, factor: float) -> Load:
        return Load(tuple((factor * own, term) for own, term in self.terms))

    __rmul__ = __mul__

    def on(self, blocks: Sequence[Block]) -> Array:
        """Return forces (N) and moments (N m) at the centroids of `blocks`, global axes, shape (n, 6).

        Raises
        ------
        ModelError
            If a term names a block that is not in `blocks`, or a block has no unit weight.
        """
        return sum((factor * term.on(blocks) for factor, term in self.terms), np.zeros((len(blocks), 6)))


def self_weight() -> Load:
    """Return the weight of every block, along -Z."""
    return Load(((1.0, MassProportional((0.0, 0.0, -1.0))),))


def mass_proportional(direction: Sequence[float]) -> Load:
    """Return a load equal to the weight of every block along `direction`.

    The direction is brought to unit length, so that the load factor is an acceleration over g.

    Raises
    ------
    ModelError
        If the direction is not three finite numbers or is zero.
    """
    vector = _vector(direction, "direction")
    length = float(np.linalg.norm(vector))
    if length == 0.0:
        raise ModelError("mass-proportional load: direction is (0, 0, 0), expected a non-zero vector")
    x, y, z = vector
    return Load(((1.0, MassProportional((x / length, y / length, z / length))),))


def force(block: str, force: Sequence[float], at: Sequence[float]) -> Load:
    """Return a force (N) on the block named `block`, acting at the point `at` (m), global axes."""
    return Load(((1.0, PointForce(block, _vector(force, "force"), _vector(at, "at"))),))


def moment(block: str, moment: Sequence[float]) -> Load:
    """Return a moment (N m, right-hand rule) on the block named `block`, global axes."""
    return Load(((1.0, Moment(block, _vector(moment, "moment"))),))


def _vector(values: Sequence[float], word: str) -> Vector:
    array = np.asarray(values, dtype=float)
    if array.shape != (3,) or not np.isfinite(array).all():
        raise ModelError(f"{word} is {values!r}, expected three finite numbers")
    x, y, z = array.tolist()
    return x, y, z


def _position(name: str, blocks: Sequence[Block]) -> int:
    for k, block in enumerate(blocks):
        if block.name == name:
            return k
    raise ModelError(f"a load names block {name!r}, which is not a free block of the model")

"""Weights, added masses, forces and moments at given points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import ModelError, sequence_of
from limitblocks.geometry import Block
from limitblocks.mechanics.loads.load import (
    Load,
    Vector,
    along,
    number,
    of,
    position,
    triple,
    unit_vector,
    vector,
)
from limitblocks.shown import coordinates
from limitblocks.units import gravity

DOWN = (0.0, 0.0, -1.0)


@dataclass(frozen=True)
class MassProportional:
    """The weight of every block, acting at its centroid along the unit vector `direction`."""

    direction: Vector

    def on(self, blocks: Sequence[Block]) -> Array:
        """Return forces and moments at the centroids, shape (n, 6)."""
        load = np.zeros((len(blocks), 6))
        load[:, :3] = np.outer([block.weight for block in blocks], self.direction)
        return load

    def in_words(self) -> str:
        """Return the term in words."""
        return f"the weight of every block, {along(self.direction)}"


@dataclass(frozen=True)
class AddedMass:
    """The weight (N) of a mass fixed to the block named `block` at the point `at` (m), along `direction`."""

    block: str
    weight: float
    at: Vector
    direction: Vector = DOWN

    def __post_init__(self) -> None:
        word = f"added mass on block {self.block!r}"
        object.__setattr__(self, "weight", number(self.weight, f"{word}: weight", "N", above=0.0))
        object.__setattr__(self, "at", vector(self.at, f"{word}: at"))

    def on(self, blocks: Sequence[Block]) -> Array:
        """Return forces and moments at the centroids, shape (n, 6)."""
        return _at_point(self.block, np.multiply(self.weight, self.direction), self.at, blocks)

    def in_words(self) -> str:
        """Return the term in words."""
        where = f"fixed to block {self.block!r} at {coordinates(self.at)} m"
        return f"a mass that weighs {self.weight / 1e3:.4g} kN, {where}, {along(self.direction)}"


@dataclass(frozen=True)
class PointForce:
    """A force (N, global axes) on the block named `block` at the point `at` (m)."""

    block: str
    force: Vector
    at: Vector

    def on(self, blocks: Sequence[Block]) -> Array:
        """Return forces and moments at the centroids, shape (n, 6)."""
        return _at_point(self.block, np.array(self.force), self.at, blocks)

    def in_words(self) -> str:
        """Return the term in words."""
        return f"a force {triple(self.force, 1e3)} kN on block {self.block!r} at {coordinates(self.at)} m"


@dataclass(frozen=True)
class JointPressure:
    """A force (N, global axes) at the point `at` (m) of a joint: on block j, its opposite on block i.

    A block that does not move takes its own without effect, until its settlement is asked for.
    """

    block_i: str
    block_j: str
    force: Vector
    at: Vector

    @property
    def joins(self) -> tuple[str, str]:
        """Names of both blocks, of which one may be a support."""
        return self.block_i, self.block_j

    def on(self, blocks: Sequence[Block]) -> Array:
        """Return forces and moments at the centroids, shape (n, 6)."""
        on_j = np.array(self.force)
        names, load = {block.name for block in blocks}, np.zeros((len(blocks), 6))
        for name, push in ((self.block_i, -on_j), (self.block_j, on_j)):
            if name in names:
                load += _at_point(name, push, self.at, blocks)
        return load

    def in_words(self) -> str:
        """Return the term in words."""
        where = f"from the joint with {self.block_i!r} at {coordinates(self.at)} m"
        return f"a force {triple(self.force, 1e3)} kN on block {self.block_j!r} {where}, and its opposite"


@dataclass(frozen=True)
class Moment:
    """A moment (N m, global axes, right-hand rule) on the block named `block`."""

    block: str
    moment: Vector

    def on(self, blocks: Sequence[Block]) -> Array:
        """Return forces and moments at the centroids, shape (n, 6)."""
        load = np.zeros((len(blocks), 6))
        load[position(self.block, blocks), 3:] = self.moment
        return load

    def in_words(self) -> str:
        """Return the term in words."""
        return f"a moment {triple(self.moment, 1e3)} kN m on block {self.block!r}"


def self_weight(added: Sequence[AddedMass] = ()) -> Load:
    """Return the weight of every block and of the masses `added`, along -Z."""
    return mass_proportional(DOWN, added)


def mass_proportional(direction: Sequence[float], added: Sequence[AddedMass] = ()) -> Load:
    """Return a load equal to the weight of every block, and of the masses `added`, along `direction`.

    The direction is brought to unit length, so that the load factor is an acceleration over g.

    Raises
    ------
    ModelError
        If the direction is not three finite numbers or is zero, or `added` is no sequence of masses.
    """
    unit = unit_vector(direction, "mass-proportional load: direction")
    masses = sequence_of("added", added, AddedMass)
    return of(MassProportional(unit), *(replace(mass, direction=unit) for mass in masses))


def added_mass(
    block: str, at: Sequence[float], *, weight: float | None = None, mass: float | None = None
) -> AddedMass:
    """Return a mass without volume, such as a floor, fixed to the block named `block` at the point `at` (m).

    Give it to :func:`limitblocks.self_weight` and to :func:`limitblocks.mass_proportional`, both: then it
    counts in the dead and in the live load like the weight of the blocks. It takes no strength: the joints
    are those of the blocks.

    Parameters
    ----------
    block : str
        The block that it moves with.
    at : sequence of float
        Its centre of mass, global axes, m; need not lie within the block.
    weight, mass : float
        Its weight (N) or its mass (kg), one of the two; the weight is the mass times 9.80665 m/s2.

    Raises
    ------
    ModelError
        If neither or both of weight and mass are given, or the number is not finite and positive.
    """
    if (weight is None) == (mass is None):
        raise ModelError(f"added mass on block {block!r}: give either weight in N or mass in kg")
    if mass is not None:
        weight = gravity * number(mass, f"added mass on block {block!r}: mass", "kg", above=0.0)
    return AddedMass(block, weight, vector(at, "at"))  # type: ignore[arg-type] # one of the two is given


def left_still(dead: Load, live: Load) -> tuple[str, ...]:
    """Return the blocks whose added masses weigh a larger share in `dead` than is pushed in `live`, by name.

    A share is the factor of a mass over that of the blocks' weights.
    """
    weighed, pushed = map(_shares, (dead, live))
    less = (mass for mass, share in weighed.items() if pushed.get(mass, 0.0) < share * (1.0 - 1e-9))
    return tuple(sorted({mass.block for mass in less}))


def _shares(load: Load) -> dict[AddedMass, float]:
    """Shares of the masses of a load, whatever their direction."""
    whole = sum(factor for factor, term in load.terms if isinstance(term, MassProportional)) or 1.0
    shares: dict[AddedMass, float] = {}
    for factor, term in load.terms:
        if isinstance(term, AddedMass):
            mass = replace(term, direction=DOWN)
            shares[mass] = shares.get(mass, 0.0) + factor / whole
    return shares


def force(block: str, force: Sequence[float], at: Sequence[float]) -> Load:
    """Return a force (N) on the block named `block`, acting at the point `at` (m), global axes.

    Raises
    ------
    ModelError
        If a vector is not three finite numbers; the model refuses an unknown block.
    """
    return of(PointForce(block, vector(force, "force"), vector(at, "at")))


def moment(block: str, moment: Sequence[float]) -> Load:
    """Return a moment (N m, right-hand rule) on the block named `block`, global axes.

    Raises
    ------
    ModelError
        If it is not three finite numbers; the model refuses an unknown block.
    """
    return of(Moment(block, vector(moment, "moment")))


def _at_point(name: str, force: Array, at: Vector, blocks: Sequence[Block]) -> Array:
    load = np.zeros((len(blocks), 6))
    k = position(name, blocks)
    load[k, :3] = force
    load[k, 3:] = np.cross(np.subtract(at, blocks[k].centroid), force)
    return load

"""Directions to push in, loads turned into another direction, and the tilting plane."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from limitblocks.arrays import Array, as_typed, read_only, real
from limitblocks.errors import ModelError
from limitblocks.joints.base import checked_count
from limitblocks.mechanics.loads.forces import AddedMass, MassProportional, mass_proportional, self_weight
from limitblocks.mechanics.loads.load import Load, horizontal, unit_vector
from limitblocks.shown import coordinates


def compass(count: int | np.integer[Any], *, vertical: bool = False) -> Array:
    """Return `count` unit vectors equally spaced in plan, from +X towards +Y, shape (n, 3).

    With `vertical`, +Z and -Z follow.

    Raises
    ------
    ModelError
        If `count` is no whole number of at least one.
    """
    checked_count("count of directions", count, 1)
    angles = 2 * np.pi * np.arange(count) / count
    along = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(count)])
    along[np.abs(along) < 1e-15] = 0.0  # cos(90 deg) in floating point
    return read_only(np.concatenate([along, [(0, 0, 1), (0, 0, -1)]]) if vertical else along)


def turned(load: Load, direction: Sequence[float]) -> Load:
    """Return a mass-proportional load, with its added masses, acting along another direction.

    Raises
    ------
    ModelError
        If a term is not mass-proportional, they act along several directions, or the new one is zero.
    """
    along, terms = unit_vector(direction, "direction"), []
    given: set[tuple[float, ...]] = set()
    for factor, term in load.terms:
        if not isinstance(term, MassProportional | AddedMass):
            raise ModelError(
                f"the live load has a {type(term).__name__}, which no direction turns; "
                "expected mass_proportional(...), or give the loads as a function of the direction"
            )
        if factor:
            given.add(tuple(np.round(np.sign(factor) * np.array(term.direction), 9).tolist()))
            terms.append((abs(factor), replace(term, direction=along)))
    if len(given) > 1:
        said = " and ".join(map(coordinates, sorted(given)))
        raise ModelError(
            f"the live load acts along {said}, expected one direction to turn, or give the loads as a "
            "function of the direction"
        )
    return Load(tuple(terms))


@dataclass(frozen=True)
class Tilting:
    """Loads of a structure on a plane that tilts: self weight, and the same weight along `direction`.

    At the angle t, a weight W is W cos t across the plane and W sin t along it, that is cos t times the dead
    load plus tan t times the live load. Where the stress resultants may be scaled at will, as without
    cohesion, tensile strength or crushing, cos t changes nothing and the load factor at collapse is tan t.
    With such strengths it is not, and :meth:`at` gives the loads of one angle.

    Attributes
    ----------
    dead, live : Load
        For :class:`limitblocks.Model`.
    """

    dead: Load
    live: Load

    @staticmethod
    def angle(load_factor: float) -> float:
        """Return the angle of the plane (rad) at which a structure of this `load_factor` collapses."""
        return float(np.arctan(load_factor))

    def at(self, angle: float) -> Load:
        """Return the weight on a plane tilted by `angle`, rad; ModelError beyond a right angle."""
        if not abs(real(angle)) <= np.pi / 2:
            raise ModelError(
                f"angle is {as_typed(angle)}, expected rad up to pi/2: math.radians({angle}) if degrees"
            )
        return float(np.cos(angle)) * self.dead + float(np.sin(angle)) * self.live


def tilting(direction: Sequence[float], added: Sequence[AddedMass] = ()) -> Tilting:
    """Return the loads of a structure on a plane that tilts, down towards the horizontal `direction`.

    The masses `added` (:func:`added_mass`) tilt with it.

    Raises
    ------
    ModelError
        If the direction is zero or not horizontal.
    """
    along = horizontal(direction, "tilting: direction")
    return Tilting(self_weight(added), mass_proportional(along, added))

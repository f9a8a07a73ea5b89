"""The masses that a mechanism moves: weights and virtual displacements, Circolare 7/2019, [C8.7.1.1]."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.mechanics.loads.forces import AddedMass, JointPressure, MassProportional, left_still
from limitblocks.mechanics.loads.load import along
from limitblocks.model import Model

STILL = 1e-6  # of the largest displacement: a mass below it does not move


@dataclass(frozen=True)
class MovingMass:
    """A mass of the mechanism.

    Attributes
    ----------
    name : str
        Block, or block with what was added to it.
    block : str
        The block that carries it.
    weight : float
        P_k + Q_k, N: what the live load takes of it.
    horizontal, vertical : float
        Virtual displacements of its centre along the live load and upwards, the largest horizontal one of
        all masses being 1.
    """

    name: str
    block: str
    weight: float
    horizontal: float
    vertical: float


def moving_masses(model: Model, rates: Array) -> tuple[tuple[MovingMass, ...], float]:
    """Return the masses of the live load that a mechanism (n, 6) moves, and what scales its rates to them.

    Raises
    ------
    ModelError
        If the live load is not made of weights and added masses along one horizontal direction, or takes
        another share of the weights than all, or lacks a mass of the dead load or a part of one; if the dead
        load has the weights other than once, or water in joints, which open.
    """
    place = {block.name: k for k, block in enumerate(model.blocks)}
    if any(isinstance(term, JointPressure) for _, term in model.dead.terms):
        raise ModelError(
            "the dead load has water in joints, which open: a verification needs them without it"
        )
    found = []
    for name, block, weight, at, direction in _masses(model):
        k = place[block]
        velocity = rates[k, :3] + np.cross(rates[k, 3:], at - model.blocks[k].centroid)
        found.append(MovingMass(name, block, weight, float(velocity @ direction), float(velocity[2])))
    still = left_still(model.dead, model.live)
    if still:
        raise ModelError(
            f"the live load lacks the mass added to {', '.join(still)} in the dead load, or a part of it; "
            "give it to both"
        )
    largest = max(abs(one.horizontal) for one in found)  # the live load works on a mechanism: some mass moves
    scale = 1.0 / largest
    masses = tuple(
        MovingMass(one.name, one.block, one.weight, one.horizontal * scale, one.vertical * scale)
        for one in found
        if max(abs(one.horizontal), abs(one.vertical)) > STILL * largest
    )
    return masses, scale


def _masses(model: Model) -> Iterator[tuple[str, str, float, Array, Array]]:
    """Name, block, weight, place and direction of each mass of the live load."""
    direction: Array | None = None
    for factor, term in model.live.terms:
        if not isinstance(term, MassProportional | AddedMass):
            raise ModelError(f"the live load has a {type(term).__name__}; expected weights and added masses")
        own = np.array(term.direction)
        if abs(own[2]) > 1e-9 or (direction is not None and not np.allclose(own, direction)):
            raise ModelError(f"the live load acts {along(own.tolist())}; expected one horizontal direction")
        direction = own
        if isinstance(term, AddedMass):
            yield f"mass on {term.block}", term.block, factor * term.weight, np.array(term.at), own
        else:
            for block in model.free_blocks:
                yield block.name, block.name, factor * block.weight, block.centroid, own
    pushed = [factor for factor, term in model.live.terms if isinstance(term, MassProportional)]
    if abs(sum(pushed) - 1.0) > 1e-9:
        raise ModelError(
            f"the live load has the weights times {sum(pushed):g}; expected 1: its load factor is the"
            " acceleration over g"
        )
    if min(pushed) <= 0.0:
        raise ModelError(
            f"the live load has the weights times {min(pushed):g} among its terms; expected their sum as one"
        )
    down = sum(
        -factor * term.direction[2] for factor, term in model.dead.terms if isinstance(term, MassProportional)
    )
    if abs(down - 1.0) > 1e-9:
        raise ModelError(
            f"the dead load has the weights times {down:g}, the live load once; expected 1: the weights of"
            " [C8.7.1.1] are the same in both, without partial factors"
        )

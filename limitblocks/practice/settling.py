"""A model whose supports can move along a direction: rigid guides make one body of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from limitblocks.analysis.in_si import resultants_of
from limitblocks.analysis.stability import dead_load_state
from limitblocks.arrays import Array, read_only
from limitblocks.errors import ModelError, few, sequence_of
from limitblocks.geometry import Block, Interface
from limitblocks.geometry.polygon import axes_of
from limitblocks.joints import Guide
from limitblocks.mechanics import Load
from limitblocks.mechanics.loads import JointPressure, force, moment
from limitblocks.mechanics.loads.load import triple, unit_vector
from limitblocks.model import Model, checked_model
from limitblocks.practice.backfill import fill_at_rest
from limitblocks.practice.elements import CORNERS, Element
from limitblocks.shown import kept

RIGID = 1e3  # strength of the guides over the weight of the structure
WIDE = 100.0  # their sides over the size of what moves: paths start at one stiffness per area of all joints


@dataclass(frozen=True, eq=False)
class Settling:
    """A model whose supports, one or several as one body, can move along a direction: the live load pulls.

    Attributes
    ----------
    model : Model
        The structure: dead loads with the reaction `held` on the supports, live load `unit` along the
        direction.
    supports : tuple of str
        Names of the supports that move.
    direction : Array, shape (3,)
        Unit vector of their motion.
    held : float
        Reaction against the direction that an admissible state of the permanent loads needs, N.
    unit : float
        Live load at load factor one, N.
    """

    model: Model
    supports: tuple[str, ...]
    direction: Array
    held: float
    unit: float

    def reaction(self, load_factor: float) -> float:
        """Return the reaction against the direction, N, at a `load_factor` of the settling model."""
        return self.held - load_factor * self.unit

    def to_dict(self) -> dict[str, Any]:
        """Return the model and its motion as numbers and text."""
        return kept(self, "supports", "direction", "held", "unit", "model")

    @property
    def named(self) -> str:
        """The supports in words."""
        return few([*map(repr, self.supports)])

    @property
    def gives_way(self) -> str:
        """What moves, and where to, as a clause."""
        one = len(self.supports) == 1
        who = "the support {} gives way" if one else "the supports {} give way as one body,"
        return f"{who.format(few(self.supports))} along {triple(self.direction.tolist())}, without turning"


def settling(model: Model, support: str | Sequence[str], direction: Sequence[float]) -> Settling:
    """Return the model in which `support` can move along `direction` only; see :func:`settlement`.

    Raises
    ------
    ModelError
        If `support` is none, or none stays, the direction is zero, or there are no dead loads.
    """
    checked_model(model)
    moving = _moving_supports(model, support)
    d = np.array(unit_vector(direction, f"settlement of {few([*map(repr, moving)])}: direction"))
    model = fill_at_rest(model, moving)
    weight = float(np.linalg.norm(model.dead.on(model.free_blocks)[:, :3], axis=1).sum())
    if not weight > 0.0:
        raise ModelError("settlement: the dead loads are zero; there is no reaction to lose")
    blocks = [block for name in moving for block in model.blocks if block.name == name]
    pulled = sum((Element(own).loads(moving) for own in model.interfaces), Load())
    water = Load(tuple(one for one in model.dead.terms if isinstance(one[1], JointPressure)))
    at, press = (water + pulled).on(blocks)[:, :3], _pressed(model, moving)
    held = [float((press[name] + on) @ d) for name, on in zip(moving, at, strict=True)]
    reactions = [
        force(one.name, (-part * d).tolist(), one.centroid.tolist())
        for one, part in zip(blocks, held, strict=True)
    ]
    reaction = sum(reactions, Load())
    freed = replace(
        model,
        blocks=tuple(replace(one, unit_weight=0.0) if one.name in moving else one for one in model.blocks),
        supports=tuple(name for name in model.supports if name not in moving),
        interfaces=(*model.interfaces, *_guides(model, blocks, d, weight)),
        dead=model.dead + pulled + reaction,
        live=force(moving[0], (weight * d).tolist(), blocks[0].centroid.tolist()),
    )
    # in the order of the dead loads: the same to the last digit
    on_supports = dict(zip(moving, (water + pulled + reaction).on(blocks), strict=True))
    return Settling(_as_before(model, freed, on_supports), moving, read_only(d), sum(held), weight)


def _guides(model: Model, moving: Sequence[Block], d: Array, weight: float) -> list[Interface]:
    """The guide along d of the first block that moves, and what holds the others to it."""
    still = next(name for name in model.supports if name not in {block.name for block in moving})
    first, size = moving[0], WIDE * moving[0].size
    axes, polygon = read_only(axes_of(d)[[2, 0, 1]]), read_only(size * CORNERS)  # s1 along the motion
    own = Guide(RIGID * weight / size**2)
    return [
        Interface(still, first.name, first.centroid, axes, polygon, own),
        *(
            Interface(first.name, one.name, one.centroid, axes, polygon, replace(own, slides=False))
            for one in moving[1:]
        ),
    ]


def _as_before(model: Model, freed: Model, on_supports: Mapping[str, Array]) -> Model:
    """The freed model less what fill and loads from above put elsewhere as supports are free.

    `on_supports` are the forces and moments (6,) that act on each of those.
    """
    wanted = dict(zip((b.name for b in model.free_blocks), model.dead.on(model.free_blocks), strict=True))
    wanted |= on_supports
    free, back = freed.free_blocks, Load()
    for block, has in zip(free, freed.dead.on(free), strict=True):
        off = wanted[block.name] - has
        if off.any():
            back += force(block.name, off[:3].tolist(), block.centroid.tolist())
            back += moment(block.name, off[3:].tolist())
    return replace(freed, dead=freed.dead + back)


def _pressed(model: Model, supports: Sequence[str]) -> dict[str, Array]:
    """Force of the structure on supports in an admissible state of the dead loads, global axes, N."""
    problem = model.problem
    Q = resultants_of(problem, dead_load_state(problem))
    total = {name: np.zeros(3) for name in supports}
    for own, stresses in zip(model.interfaces, Q, strict=True):
        on_j = -stresses[:3] @ own.axes
        for name, force_on in ((own.block_i, -on_j), (own.block_j, on_j)):
            if name in total:
                total[name] += force_on
    return total


def _moving_supports(model: Model, support: str | Sequence[str]) -> tuple[str, ...]:
    """The names of one support or of several; ModelError where one is none, or none stays."""
    names: tuple[str, ...] = (support,) if isinstance(support, str) else sequence_of("support", support, str)
    said = few([*map(repr, names)])
    for name in names:
        if name not in model.supports:
            kind = "a free block" if name in {b.name for b in model.blocks} else "not a block of the model"
            known = few([*map(repr, model.supports)])
            raise ModelError(f"settlement: {name!r} is {kind}; expected one of the supports {known}")
    if not names or len(set(names)) < len(names):
        raise ModelError(f"settlement of {said or 'no support'}: expected supports, each named once")
    if len(names) == len(model.supports):
        which = "is the only support" if len(names) == 1 else "are all the supports"
        raise ModelError(f"settlement: {said} {which}; the whole structure would move with what settles")
    return names

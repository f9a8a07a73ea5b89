"""What acts on a support, and on the structure, once the support is a block that can move."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from limitblocks.analysis.in_si import resultants_of
from limitblocks.analysis.stability import dead_load_state
from limitblocks.arrays import Array
from limitblocks.errors import ModelError, few, sequence_of
from limitblocks.mechanics import Load
from limitblocks.mechanics.loads import force, moment
from limitblocks.model import Model

ROUNDING = 1e-12  # of the dead loads: a smaller difference is none


def as_before(model: Model, freed: Model, on_supports: Mapping[str, Array]) -> Model:
    """Return the freed model less what fill and loads from above put elsewhere as supports are free.

    `on_supports` are the forces and moments (6,) that act on each of those.
    """
    wanted = dict(zip((b.name for b in model.free_blocks), model.dead.on(model.free_blocks), strict=True))
    wanted |= on_supports
    free, back = freed.free_blocks, Load()
    given = freed.dead.on(free)
    least = ROUNDING * float(np.abs(given[:, :3]).sum())
    for block, has in zip(free, given, strict=True):
        off = wanted[block.name] - has
        if np.abs(off / np.repeat([1.0, block.size], 3)).max() > least:
            back += force(block.name, off[:3].tolist(), block.centroid.tolist())
            back += moment(block.name, off[3:].tolist())
    return replace(freed, dead=freed.dead + back)


def pressed(model: Model, supports: Sequence[str]) -> dict[str, Array]:
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


def moving_supports(model: Model, support: str | Sequence[str]) -> tuple[str, ...]:
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

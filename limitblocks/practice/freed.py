"""What acts on a support, and on the structure, once the support is a block that can move."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from limitblocks.analysis.in_si import resultants_of
from limitblocks.analysis.stability import dead_load_state
from limitblocks.arrays import Array
from limitblocks.errors import ModelError, refuse_kind
from limitblocks.mechanics import Load
from limitblocks.mechanics.loads import force, moment
from limitblocks.model import Model

ROUNDING = 1e-12  # of the dead loads: a smaller difference is none


def as_before(model: Model, freed: Model, support: str, on_support: Array) -> Model:
    """Return the freed model less what fill and loads from above put elsewhere as the support is free.

    `on_support` (6,) are the forces and moments that act on the support.
    """
    wanted = dict(zip((b.name for b in model.free_blocks), model.dead.on(model.free_blocks), strict=True))
    wanted[support] = on_support
    free, back = freed.free_blocks, Load()
    given = freed.dead.on(free)
    least = ROUNDING * float(np.abs(given[:, :3]).sum())
    for block, has in zip(free, given, strict=True):
        off = wanted[block.name] - has
        if np.abs(off / np.repeat([1.0, block.size], 3)).max() > least:
            back += force(block.name, off[:3].tolist(), block.centroid.tolist())
            back += moment(block.name, off[3:].tolist())
    return replace(freed, dead=freed.dead + back)


def pressed(model: Model, support: str) -> Array:
    """Force of the structure on a support in an admissible state of the dead loads, global axes, N."""
    problem = model.problem
    Q = resultants_of(problem, dead_load_state(problem))
    total = np.zeros(3)
    for own, stresses in zip(model.interfaces, Q, strict=True):
        on_j = -stresses[:3] @ own.axes
        total += on_j if own.block_j == support else -on_j if own.block_i == support else 0.0
    return total


def other_supports(model: Model, support: str) -> list[str]:
    """Supports that stay; ModelError where `support` is none, or the only one."""
    refuse_kind(support, str, "support")
    others = [name for name in model.supports if name != support]
    if support not in model.supports:
        kind = "a free block" if support in {b.name for b in model.blocks} else "not a block of the model"
        known = ", ".join(map(repr, model.supports))
        raise ModelError(f"settlement: {support!r} is {kind}; expected one of the supports {known}")
    if not others:
        raise ModelError(
            f"settlement: {support!r} is the only support; the whole structure would move with it"
        )
    return others

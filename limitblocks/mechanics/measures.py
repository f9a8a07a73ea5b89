"""Units of the limit problem: powers of two, from the loads and from the sizes of what they act on."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array, Indices, largest_in_rows, read_only
from limitblocks.errors import ModelError
from limitblocks.geometry import Block, Interface
from limitblocks.problem import Cones, Units, parts_of, power_of_two


def units_of(
    free: Sequence[Block], interfaces: Sequence[Interface], ends: Indices, dead: Array, live: Array
) -> Units:
    """Return units: of a block the loads that may go through it, of an interface that of its lesser block."""
    length = power_of_two(np.array([block.size for block in free]) / 2.0)

    def magnitude(load: Array) -> Array:
        return np.asarray(np.linalg.norm(load[:, :3], axis=1) + np.linalg.norm(load[:, 3:], axis=1) / length)

    if not magnitude(live).any():
        raise ModelError("the live load is zero on every free block, expected a force or moment to multiply")
    own, push = magnitude(dead), magnitude(live)
    own = np.where(own > 0.0, own, push * (own.sum() / push.sum() or 1.0))
    block = power_of_two(carried(own, ends))
    return Units(
        block_force=read_only(block),
        block_length=read_only(length),
        interface_force=read_only(np.where(ends >= 0, block[ends], np.inf).min(axis=1)),
        interface_length=read_only(power_of_two(_reaches(interfaces))),
        live=float(power_of_two((push / block).sum())),
        row=np.ones(0),
    )


def _reaches(interfaces: Sequence[Interface]) -> Array:
    """Largest coordinate of each polygon, in size, shape (m,)."""
    first = np.cumsum([0, *(len(interface.polygon) for interface in interfaces[:-1])])
    corners = np.concatenate([interface.polygon for interface in interfaces])
    return np.asarray(np.maximum.reduceat(np.abs(corners).max(axis=1), first))


def carried(own: Array, ends: Indices) -> Array:
    """Return the most that may go through each block, shape (n,): the largest load of those it is tied to.

    Blocks are tied by chains of interfaces between free blocks. What does go through a block only an analysis
    can tell; too large a unit of force loses digits that a second solution in its own units finds, too
    small a one loses all.
    """
    part = parts_of(ends, len(own))
    largest = np.zeros(len(own))
    np.maximum.at(largest, part, own)
    return np.asarray(np.where(largest > 0.0, largest, largest.max())[part])


def row_units(F: sparse.csr_array, cones: Cones) -> Array:
    """Return powers of two that bring the largest entry of each linear row and each cone near one, (R,)."""
    largest = np.zeros(cones.degree)
    np.maximum.at(largest, cones.member, largest_in_rows(F))
    return read_only(power_of_two(np.where(largest > 0.0, largest, 1.0))[cones.member])

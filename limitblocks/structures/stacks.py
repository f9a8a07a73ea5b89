"""Blocks on top of one another: single block, column, overhanging stack."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from limitblocks.arrays import real
from limitblocks.errors import ModelError
from limitblocks.joints import Joint
from limitblocks.model import Model
from limitblocks.structures.build import (
    HORIZONTAL,
    UNIT_WEIGHT,
    base,
    model_of,
    plain_numbers,
    refuse_fewer,
    refuse_not_positive,
    span_box,
)


@plain_numbers
def block(
    joint: Joint,
    *,
    width: float,
    height: float,
    depth: float = 1.0,
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = HORIZONTAL,
) -> Model:
    """Return a single block on a base; its load factor along X is min(mu, width / height).

    Parameters
    ----------
    joint : Joint
        Joint of the base.
    width, height, depth : float
        Dimensions along X, Z and Y, m.
    unit_weight : float
        N/m3.
    direction : sequence of float
        Direction of the live load, which is the weight.
    """
    refuse_not_positive(width=width)
    return column(
        joint, count=1, width=width, height=height, depth=depth, unit_weight=unit_weight, direction=direction
    )


@plain_numbers
def column(
    joint: Joint,
    *,
    count: int,
    width: float,
    height: float,
    depth: float = 1.0,
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = HORIZONTAL,
) -> Model:
    """Return a column of equal blocks on a base; its load factor along X is min(mu, width / (count height)).

    Parameters
    ----------
    joint : Joint
        Joint of all interfaces.
    count : int
        Number of blocks.
    width, height, depth : float
        Dimensions of one block along X, Z and Y, m.
    unit_weight : float
        N/m3.
    direction : sequence of float
        Direction of the live load, which is the weight.
    """
    refuse_not_positive(width=width)
    _refuse_stack(count, width, height, depth)
    return _stack(joint, np.zeros(count), (width, depth, height), unit_weight, direction, "column")


@plain_numbers
def overhang(
    joint: Joint,
    *,
    count: int,
    length: float,
    height: float,
    depth: float = 1.0,
    fraction: float = 1.0,
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = HORIZONTAL,
) -> Model:
    """Return the harmonic stack: block i from the top projects in X by `fraction` length / (2 i).

    At fraction one, the top projects by (length / 2) (1 + 1/2 + ... + 1/count) over the edge of the table
    and the stack is about to fall. From zero to one its load factor along X is
    min(mu, (1 - fraction) length / (count height)): the centroid of the k top blocks is
    (1 - fraction) length / 2 inside the edge of the block below them.

    Parameters
    ----------
    count : int
        Number of blocks above the table.
    length, height, depth : float
        Dimensions of one block along X, Z and Y, m.
    fraction : float
        Part of the largest possible overhang.
    joint, unit_weight, direction
        As for :func:`column`.
    """
    _refuse_stack(count, length, height, depth)
    if not np.isfinite(real(fraction)):
        raise ModelError(f"fraction is {fraction!r}, expected a number, 1 where the stack is about to fall")
    steps = fraction * length / (2 * np.arange(count, 0, -1))
    return _stack(joint, np.cumsum(steps), (length, depth, height), unit_weight, direction, "overhang")


def _stack(
    joint: Joint,
    offsets: np.typing.NDArray[np.float64],
    size: tuple[float, float, float],
    unit_weight: float,
    direction: Sequence[float],
    name: str,
) -> Model:
    """Equal blocks, their left edges at `offsets` along X, on a table as long as a block at offset zero."""
    length, depth, height = size
    y = (-depth / 2, depth / 2)
    blocks = [
        span_box(f"block {k + 1}", (x, x + length), y, (k * height, (k + 1) * height), unit_weight)
        for k, x in enumerate(offsets.tolist())
    ]
    return model_of(blocks, [base((0.0, length), y, height)], joint, direction, name)


def _refuse_stack(count: int, length: float, height: float, depth: float) -> None:
    refuse_fewer(1, count=count)
    refuse_not_positive(length=length, height=height, depth=depth)

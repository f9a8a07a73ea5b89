"""Stairs whose treads turn about a newel."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from limitblocks.geometry import Block
from limitblocks.joints import Joint
from limitblocks.model import Model
from limitblocks.structures.build import (
    HORIZONTAL,
    UNIT_WEIGHT,
    base,
    model_of,
    refuse,
    refuse_not_positive,
    span_box,
)


def stair(
    joint: Joint,
    *,
    treads: int = 9,
    length: float = 1.2,
    width: float = 0.6,
    rise: float = 0.18,
    newel: float = 0.3,
    turn: float = np.pi / 6,
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = HORIZONTAL,
) -> Model:
    """Return a spiral stair: every tread lies on the one below, turned against it about the Z axis.

    The treads cantilever from the newel, which their own inner ends form, so that a horizontal load twists
    the joints between them. The joints are the overlap of two rectangles, of up to eight sides.

    Parameters
    ----------
    joint : Joint
        Joint of all interfaces, the base included.
    treads : int
        Number of treads; `tread 1` lies on the base along X.
    length, width, rise : float
        Dimensions of a tread, m.
    newel : float
        From the inner end of a tread to the axis, m; less than the length.
    turn : float
        Angle from tread to tread, rad, anticlockwise seen from above.
    unit_weight : float
        N/m3.
    direction : sequence of float
        Direction of the live load, which is the weight.
    """
    refuse_not_positive(length=length, width=width, rise=rise, newel=newel)
    problems = [] if treads >= 1 else [f"treads is {treads!r}, expected at least one"]
    if newel >= length:
        problems.append(f"newel is {newel!r}, expected less than the length {length!r}")
    if not np.isfinite(turn):
        problems.append(f"turn is {turn!r}, expected an angle in rad")
    refuse(problems)
    x, y = (-newel, length - newel), (-width / 2, width / 2)
    boxes = [span_box(f"tread {k + 1}", x, y, (k * rise, (k + 1) * rise), unit_weight) for k in range(treads)]
    blocks = [_turned(box, k * turn) for k, box in enumerate(boxes)]
    return model_of(blocks, [base(x, y, rise)], joint, direction, "stair")


def _turned(block: Block, angle: float) -> Block:
    """The block turned about the Z axis, anticlockwise seen from above."""
    c, s = np.cos(angle), np.sin(angle)
    turned = block.vertices @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    return Block(block.name, turned, block.faces, block.unit_weight)

"""Stairs whose treads turn about a newel, and stairs whose treads cantilever from a wall."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from limitblocks.arrays import real
from limitblocks.geometry import Block
from limitblocks.joints import Joint
from limitblocks.mechanics import Load
from limitblocks.mechanics.loads import force, unit_vector
from limitblocks.model import Model
from limitblocks.structures.bond import Bond
from limitblocks.structures.build import (
    HORIZONTAL,
    UNIT_WEIGHT,
    base,
    model_of,
    plain_numbers,
    refuse,
    refuse_fewer,
    refuse_not_positive,
    span_box,
)


@plain_numbers
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
    refuse_fewer(1, treads=treads)
    problems = []
    if newel >= length:
        problems.append(f"newel is {newel!r}, expected less than the length {length!r}")
    if not np.isfinite(real(turn)):
        problems.append(f"turn is {turn!r}, expected an angle in rad")
    refuse(problems)
    x, y = (-newel, length - newel), (-width / 2, width / 2)
    boxes = [span_box(f"tread {k + 1}", x, y, (k * rise, (k + 1) * rise), unit_weight) for k in range(treads)]
    blocks = [_turned(box, k * turn) for k, box in enumerate(boxes)]
    return model_of(blocks, [base(x, y, rise)], joint, direction, "stair")


@plain_numbers
def cantilever_stair(
    joint: Joint,
    *,
    treads: int = 5,
    length: float = 0.9,
    going: float = 0.3,
    rise: float = 0.17,
    overlap: float = 0.04,
    wall_thickness: float = 0.4,
    courses_above: int = 5,
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = (0.0, 0.0, -1.0),
) -> Model:
    """Return a straight stair of treads built into a wall, each resting on the edge of the one below.

    The wall stands on X; its courses are as high as a tread, its blocks two goings long. Every tread goes
    through the whole wall and is held down by what is above it; the first lies in the lowest course.

    Parameters
    ----------
    joint : Joint
        Joint of all interfaces, the base included.
    treads : int
        Number of treads, `tread 1` at the lower end.
    length : float
        From the wall to the free ends of the treads, along Y, m.
    going, rise : float
        From tread to tread along X, and the height of a tread, m.
    overlap : float
        Of a tread on the one below, along X, m; 0 or more, less than the going. Without it the treads are
        corbels that do not touch.
    wall_thickness : float
        m.
    courses_above : int
        Courses of the wall above the highest tread.
    unit_weight : float
        N/m3.
    direction : sequence of float
        Direction of the live load; default: down. It is as large as the weight of what projects from the
        wall, and acts on each tread in the middle of its free length: the load factor times this weight is
        the imposed load.
    """
    refuse_not_positive(length=length, going=going, rise=rise, wall_thickness=wall_thickness)
    refuse_fewer(1, treads=treads)
    refuse_fewer(0, courses_above=courses_above)
    if not 0.0 <= real(overlap) < going:
        refuse([f"overlap is {overlap!r}, expected a number from 0 to less than the going {going!r}"])
    bond, y = Bond(2 * going, rise, treads + courses_above), (-wall_thickness, 0.0)
    end = 2 * going * ((treads + 3) // 2)
    spans = [((k + 1) * going - overlap * (k > 0), (k + 2) * going) for k in range(treads)]
    stones = bond.pieces("wall", [(0.0, end)] * 2, 1, gaps={k: [span] for k, span in enumerate(spans)})
    blocks = bond.boxes(stones, 0, y, unit_weight)
    blocks += [
        span_box(f"tread {k + 1}", span, (-wall_thickness, length), (k * rise, (k + 1) * rise), unit_weight)
        for k, span in enumerate(spans)
    ]
    model = model_of(blocks, [base((0.0, end), y, rise)], joint, direction, "cantilever stair")
    push = np.array(unit_vector(direction, "direction"))
    load = [
        force(
            f"tread {k + 1}",
            (unit_weight * (b - a) * length * rise * push).tolist(),
            at=((a + b) / 2, length / 2, (k + 0.5) * rise),
        )
        for k, (a, b) in enumerate(spans)
    ]
    return replace(model, live=sum(load, Load()))


def _turned(block: Block, angle: float) -> Block:
    """The block turned about the Z axis, anticlockwise seen from above."""
    c, s = np.cos(angle), np.sin(angle)
    turned = block.vertices @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    return replace(block, vertices=turned)

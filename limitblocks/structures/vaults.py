"""Barrel vaults."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from limitblocks.joints import Joint
from limitblocks.model import Model
from limitblocks.structures.build import (
    HORIZONTAL,
    UNIT_WEIGHT,
    model_of,
    plain_numbers,
    prism,
    refuse_fewer,
    refuse_not_positive,
)
from limitblocks.structures.rings import circular


@plain_numbers
def barrel_vault(
    joint: Joint,
    *,
    radius: float,
    thickness: float,
    length: float,
    courses: int,
    stones: int,
    embrace: float = 2 * np.pi / 3,
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = HORIZONTAL,
) -> Model:
    """Return a barrel vault about the Y axis in running bond, on two supports.

    Its courses run along the axis. Bed joints are radial planes between them; head joints lie across the
    axis, in every second course half a stone off, so that this course has half stones at its ends. The
    corners of a course lie on the circles of radius +- thickness / 2; its edges are straight.

    Parameters
    ----------
    joint : Joint
        Joint of all interfaces, the springings included.
    radius, thickness : float
        To the centreline, and of the vault, m.
    length : float
        Along the axis, m, from y = 0.
    courses : int
        Number of courses from springing to springing; stones are named `course.place` from the left (-X).
    stones : int
        Number of stones along the first, third, ... course.
    embrace : float
        Angle between the springings, rad, up to pi.
    unit_weight : float
        N/m3.
    direction : sequence of float
        Direction of the live load, which is the weight.
    """
    refuse_not_positive(length=length)
    refuse_fewer(1, stones=stones)
    refuse_fewer(2, courses=courses)
    ring = circular(radius, thickness, courses, embrace)
    even = length / stones * np.arange(stones + 1.0)
    odd = np.array([0.0, *(even[:-1] + even[1:]) / 2, length])
    blocks = [
        prism(f"{course + 1}.{k + 1}", outline, end - start, unit_weight, at=(start + end) / 2)
        for course, outline in enumerate(ring.voussoirs())
        for k, (start, end) in enumerate(np.lib.stride_tricks.sliding_window_view((even, odd)[course % 2], 2))
    ]
    supports = [
        prism(f"{side} support", outline, length, at=length / 2) for side, outline in ring.skewbacks().items()
    ]
    return model_of(blocks, supports, joint, direction, "barrel vault")

"""The four walls of Ferris & Tin-Loi (2001), the common benchmark of non-associated limit analysis."""

from __future__ import annotations

from collections.abc import Sequence

from limitblocks.joints import Joint
from limitblocks.model import Model
from limitblocks.structures.build import (
    HORIZONTAL,
    UNIT_WEIGHT,
    base,
    model_of,
    plain_numbers,
    refuse,
    refuse_not_positive,
    span_box,
)

BLOCK_LENGTH, BLOCK_HEIGHT = 0.4, 0.175  # m

# Courses from the bottom up in block lengths; a negative number is an opening.
_HALVES, _FULL = (0.5, 1, 1, 1, 1, 0.5), (1, 1, 1, 1, 1)
_EVEN_3, _UNEVEN_3 = (1, 1, 1, 1), (0.5, 1, 1, 1, 0.5)
_OPEN_EVEN_3, _OPEN_UNEVEN_3 = (1, 0.5, -1, 0.5, 1), (0.5, 1, -1, 1, 0.5)
_OPEN_EVEN_4, _OPEN_UNEVEN_4 = (0.5, 0.5, -1, 0.5, 0.5, -1, 0.5, 0.5), (1, -1, 1, -1, 1)


def _with_openings(
    even: Sequence[float], uneven: Sequence[float], open_even: Sequence[float], open_uneven: Sequence[float]
) -> list[Sequence[float]]:
    middle = [open_uneven, open_even, open_uneven, open_even, open_uneven]
    return [even, uneven, even, *middle, even, uneven, even]


COURSES: dict[int, list[Sequence[float]]] = {
    1: [_HALVES, _FULL] * 3,
    2: [_HALVES, _FULL] * 5,
    3: _with_openings(_EVEN_3, _UNEVEN_3, _OPEN_EVEN_3, _OPEN_UNEVEN_3),
    4: _with_openings(_HALVES, _FULL, _OPEN_EVEN_4, _OPEN_UNEVEN_4),
}


@plain_numbers
def ferris_tin_loi_wall(
    number: int,
    joint: Joint,
    *,
    thickness: float = 0.2,
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = HORIZONTAL,
) -> Model:
    """Return wall 1, 2, 3 or 4 of Ferris & Tin-Loi (2001) on a rigid base, in the plane X, Z.

    Blocks of 0.4 m x 0.175 m and half blocks; the source has friction 0.65 everywhere. Associated load
    factors along X: 0.64286, 0.58000, 0.40369, 0.33195.

    Parameters
    ----------
    number : int
        Wall 1 to 4.
    joint : Joint
        Joint of all interfaces, the base included.
    thickness : float
        Dimension along Y, m; the source is plane.
    unit_weight : float
        N/m3.
    direction : sequence of float
        Direction of the live load, which is the weight.

    References
    ----------
    M. C. Ferris, F. Tin-Loi, Limit analysis of frictional block assemblies as a mathematical program with
    complementarity constraints, Int. J. Mech. Sci. 43 (2001) 209-224.
    """
    refuse([] if number in COURSES else [f"wall {number!r} is unknown, expected 1, 2, 3 or 4"])
    refuse_not_positive(thickness=thickness)
    y, blocks = (-thickness / 2, thickness / 2), []
    for course, lengths in enumerate(COURSES[number]):
        z, x = (course * BLOCK_HEIGHT, (course + 1) * BLOCK_HEIGHT), 0.0
        for k, length in enumerate(lengths):
            end = x + abs(length) * BLOCK_LENGTH
            if length > 0:
                blocks.append(span_box(f"{course + 1}.{k + 1}", (x, end), y, z, unit_weight))
            x = end
    ground = base((0.0, x), y, BLOCK_HEIGHT)
    return model_of(blocks, [ground], joint, direction, f"Ferris & Tin-Loi wall {number}")

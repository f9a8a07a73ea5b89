"""Walls in running bond that interlock: a corner, a facade with its return walls, a tower, a buttress.

All are half a block thick, so that the quoins belong to either wall in turn, course by course.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

from limitblocks.joints import Joint
from limitblocks.model import Model
from limitblocks.structures.bond import Bond, Opening, multiple, openings_of, refuse_wall
from limitblocks.structures.build import HORIZONTAL, UNIT_WEIGHT, base, model_of, plain_numbers, refuse

FACADE_OPENINGS = (Opening(1.2, 0.0, 1.2, 2.4), Opening(4.0, 1.2, 1.2, 1.2))


@plain_numbers
def facade(
    joint: Joint,
    *,
    length: float = 6.4,
    courses: int = 11,
    return_length: float = 3.2,
    block_length: float = 0.8,
    block_height: float = 0.4,
    openings: Sequence[Opening | tuple[float, float, float, float]] = FACADE_OPENINGS,
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = (0.0, -1.0, 0.0),
) -> Model:
    """Return a facade with a door, a window and two return walls, interlocked at the corners.

    The facade stands on X from 0 to `length`, its outer face at y = 0; the return walls run along Y. All are
    half a block thick, so that the quoins belong to the facade and to the return wall in turn, course by
    course, and each bears half on the other wall. Default: stones of 0.8 m x 0.4 m x 0.4 m, 6.4 m x 4.4 m.

    Parameters
    ----------
    joint : Joint
        Joint of all interfaces, the base included.
    length, return_length : float
        Outer dimensions along X and Y, m; multiples of half the block length.
    courses : int
        Number of courses.
    block_length, block_height : float
        Dimensions of a block, m; the walls are block_length / 2 thick.
    openings : sequence of Opening
        (left, sill, width, height) in the facade, m, as for :func:`wall`; left out, a door
        (1.2, 0, 1.2, 2.4) and a window (4, 1.2, 1.2, 1.2), which need the default size.
    unit_weight : float
        N/m3.
    direction : sequence of float
        Direction of the live load, which is the weight; default: outwards, away from the return walls.
    """
    refuse_wall(courses, block_length, length=length, return_length=return_length, block_height=block_height)
    t = block_length / 2
    if length <= 2 * block_length or return_length < block_length:
        refuse([f"length {length:g} m and return length {return_length:g} m leave no room for corners"])
    bond = Bond(block_length, block_height, courses)
    odd = _odd(length, t)
    pieces = bond.pieces("facade", _spans(length, t, True), 1, openings_of(openings))
    blocks = bond.boxes(pieces, 0, (0.0, t), unit_weight)
    for side, x, first in (("left", (0.0, t), False), ("right", (length - t, length), odd)):
        back = [(0.0, return_length), (t, return_length)][:: 1 if first else -1]
        blocks += bond.boxes(bond.pieces(side, back, int(first)), 1, x, unit_weight)
    ground = base((0.0, length), (0.0, return_length), block_height)
    return model_of(blocks, [ground], joint, direction, "facade")


@plain_numbers
def corner(
    joint: Joint,
    *,
    length: float,
    return_length: float,
    courses: int,
    block_length: float = 0.8,
    block_height: float = 0.4,
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = HORIZONTAL,
) -> Model:
    """Return two walls along X and Y that interlock at the origin, on a base.

    Both are half a block thick; the quoins belong to either wall in turn, as in :func:`facade`.

    Parameters
    ----------
    length, return_length : float
        Outer dimensions along X and Y, m; multiples of half the block length.
    joint, courses, block_length, block_height, unit_weight, direction
        As for :func:`facade`; the default direction is X.
    """
    refuse_wall(courses, block_length, length=length, return_length=return_length, block_height=block_height)
    t = block_length / 2
    if min(length, return_length) < block_length:
        refuse([f"length {length:g} m and return length {return_length:g} m leave no room for the corner"])
    bond = Bond(block_length, block_height, courses)
    front = bond.pieces("front", [(0.0, length), (t, length)], 1)
    side = bond.pieces("side", [(t, return_length), (0.0, return_length)], 0)
    blocks = [*bond.boxes(front, 0, (0.0, t), unit_weight), *bond.boxes(side, 1, (0.0, t), unit_weight)]
    ground = base((0.0, length), (0.0, return_length), block_height)
    return model_of(blocks, [ground], joint, direction, "corner")


@plain_numbers
def tower(
    joint: Joint,
    *,
    length: float,
    width: float,
    courses: int,
    block_length: float = 0.8,
    block_height: float = 0.4,
    openings: Mapping[str, Sequence[Opening | tuple[float, float, float, float]]] = MappingProxyType({}),
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = HORIZONTAL,
) -> Model:
    """Return four walls about a rectangle, interlocked at the corners, open at the top, on a base.

    Parameters
    ----------
    length, width : float
        Outer dimensions along X and Y, m; multiples of half the block length.
    openings : mapping of str to sequence of Opening
        For "front" (y = 0), "back", "left" (x = 0) and "right": (left, sill, width, height), m, as for
        :func:`wall`, from the corner with the smaller x or y.
    joint, courses, block_length, block_height, unit_weight, direction
        As for :func:`facade`; the default direction is X.
    """
    refuse_wall(courses, block_length, length=length, width=width, block_height=block_height)
    t = block_length / 2
    if min(length, width) < 2 * block_length:
        refuse([f"length {length:g} m and width {width:g} m leave no room for corners: expected at least "
                f"{2 * block_length:g} m, two blocks"])  # fmt: skip
    sides = {  # axis, across, and whether the even courses have the quoins where the wall begins
        "front": (0, (0.0, t), True),
        "back": (0, (width - t, width), not _odd(width, t)),
        "left": (1, (0.0, t), False),
        "right": (1, (length - t, length), _odd(length, t)),
    }
    if not isinstance(openings, Mapping):
        refuse([f"openings are {openings!r}, expected those of each side by its name, {', '.join(sides)}"])
    refuse(f"openings are given for {name!r}, expected one of {', '.join(sides)}"
           for name in openings if name not in sides)  # fmt: skip
    bond, blocks = Bond(block_length, block_height, courses), []
    for name, (axis, across, first) in sides.items():
        holes = openings_of(openings.get(name, ()))
        pieces = bond.pieces(name, _spans((length, width)[axis], t, first), int(first), holes)
        blocks += bond.boxes(pieces, axis, across, unit_weight)
    ground = base((0.0, length), (0.0, width), block_height)
    return model_of(blocks, [ground], joint, direction, "tower")


def _odd(length: float, t: float) -> bool:
    """Whether a wall has an odd number of half blocks: its quoins are then at one end in each course."""
    return round(length / t) % 2 == 1


def _spans(length: float, t: float, first: bool) -> list[tuple[float, float]]:
    """Where the even and the odd courses of a wall between two corners run; `first`: the even ones from 0."""
    odd = _odd(length, t)
    return [(0.0, length - t * odd), (t, length - t * (not odd))][:: 1 if first else -1]


@plain_numbers
def buttressed_wall(
    joint: Joint,
    *,
    length: float,
    courses: int,
    buttress_length: float,
    buttress_courses: int | None = None,
    position: float | None = None,
    bonded: bool = True,
    block_length: float = 0.8,
    block_height: float = 0.4,
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = (0.0, 1.0, 0.0),
) -> Model:
    """Return a wall along X with a buttress behind it (+Y), on a base; both are half a block thick.

    A bonded buttress runs through the wall in every second course; one that is not bonded stands against the
    wall, which it props through a joint without tension but does not hold back.

    Parameters
    ----------
    joint : Joint
        Joint of all interfaces, the base included.
    length : float
        Of the wall, m; a multiple of half the block length.
    courses : int
        Number of courses of the wall.
    buttress_length : float
        Of the buttress from the back of the wall along Y, m; a multiple of half the block length.
    buttress_courses : int, optional
        Number of courses of the buttress; those of the wall if left out.
    position : float, optional
        From the end of the wall to the buttress, m, a multiple of half the block length; by default the
        buttress is in the middle, a quarter of a block to the left where it cannot be.
    bonded : bool
        Whether the buttress is bonded to the wall.
    block_length, block_height : float
        Dimensions of a block, m; wall and buttress are block_length / 2 thick.
    unit_weight : float
        N/m3.
    direction : sequence of float
        Direction of the live load, which is the weight; default: the wall leans on the buttress.
    """
    refuse_wall(courses, block_length, length=length, buttress_length=buttress_length,
                block_height=block_height)  # fmt: skip
    t = block_length / 2
    top = courses if buttress_courses is None else buttress_courses
    x = (round(length / t) - 1) // 2 * t if position is None else position
    problems = []
    if not 1 <= top <= courses:
        problems.append(f"buttress courses is {top!r}, expected 1 to {courses}, the courses of the wall")
    if not multiple(x, t) or not 0.0 <= x <= length - t:
        problems.append(f"position is {x!r}, expected a multiple of {t:g} m from 0 to {length - t:g} m")
    refuse(problems)
    bond, end = Bond(block_length, block_height, courses), t + buttress_length
    through = {course: [(x, x + t)] for course in range(0, top, 2)} if bonded else {}
    blocks = bond.boxes(bond.pieces("wall", [(0.0, length)] * 2, 1, gaps=through), 0, (0.0, t), unit_weight)
    behind = bond._replace(courses=top).pieces("buttress", [(0.0 if bonded else t, end), (t, end)], 1)
    blocks += bond.boxes(behind, 1, (x, x + t), unit_weight)
    ground = base((0.0, length), (0.0, end), block_height)
    return model_of(blocks, [ground], joint, direction, "wall with buttress")

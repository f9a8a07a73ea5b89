"""Walls in running bond, alone or as a facade with its return walls."""

from __future__ import annotations

from collections.abc import Sequence

from limitblocks.joints import Joint
from limitblocks.model import Model
from limitblocks.structures.bond import Bond, Opening, Piece
from limitblocks.structures.build import (
    HORIZONTAL,
    UNIT_WEIGHT,
    base,
    model_of,
    refuse,
    refuse_not_positive,
    span_box,
)


def wall(
    joint: Joint,
    *,
    length: float,
    courses: int,
    block_length: float = 0.4,
    block_height: float = 0.2,
    thickness: float = 0.2,
    openings: Sequence[Opening | tuple[float, float, float, float]] = (),
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = HORIZONTAL,
) -> Model:
    """Return a wall in running bond on a base, in the plane X, Z, with half blocks at its ends.

    Parameters
    ----------
    joint : Joint
        Joint of all interfaces, the base included.
    length : float
        Along X, m; a multiple of half the block length.
    courses : int
        Number of courses.
    block_length, block_height, thickness : float
        Dimensions of a block along X, Z and Y, m.
    openings : sequence of Opening
        (left, sill, width, height) in m, from the lower left corner, on the grid of half blocks and courses.
        Each is bridged by a lintel one course high that bears on half a block at either side.
    unit_weight : float
        N/m3.
    direction : sequence of float
        Direction of the live load, which is the weight.
    """
    _refuse_dimensions(courses, block_length, length=length, block_height=block_height, thickness=thickness)
    bond = Bond(block_length, block_height, courses)
    pieces = bond.pieces("wall", [(0.0, length)] * 2, 0, [Opening(*opening) for opening in openings])
    y = (-thickness / 2, thickness / 2)
    blocks = [span_box(p.name, (p.start, p.end), y, _heights(p, block_height), unit_weight) for p in pieces]
    return model_of(blocks, [base((0.0, length), y, block_height)], joint, direction, "wall")


FACADE_OPENINGS = (Opening(1.2, 0.0, 1.2, 2.4), Opening(4.0, 1.2, 1.2, 1.2))


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
        (left, sill, width, height) in the facade, m, as for :func:`wall`.
    unit_weight : float
        N/m3.
    direction : sequence of float
        Direction of the live load, which is the weight; default: outwards, away from the return walls.
    """
    _refuse_dimensions(
        courses, block_length, length=length, return_length=return_length, block_height=block_height
    )
    t = block_length / 2
    if length <= 2 * block_length or return_length < block_length:
        refuse([f"length {length:g} m and return length {return_length:g} m leave no room for corners"])
    bond = Bond(block_length, block_height, courses)
    front = [(0.0, length), (t, length - t)]
    back = [(t, return_length), (0.0, return_length)]
    blocks = [
        span_box(p.name, (p.start, p.end), (0.0, t), _heights(p, block_height), unit_weight)
        for p in bond.pieces("facade", front, 1, [Opening(*opening) for opening in openings])
    ]
    for side, x in (("left", (0.0, t)), ("right", (length - t, length))):
        blocks += [
            span_box(p.name, x, (p.start, p.end), _heights(p, block_height), unit_weight)
            for p in bond.pieces(side, back, 0)
        ]
    ground = base((0.0, length), (0.0, return_length), block_height)
    return model_of(blocks, [ground], joint, direction, "facade")


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
    joint : Joint
        Joint of all interfaces, the base included.
    length, return_length : float
        Outer dimensions along X and Y, m; multiples of half the block length.
    courses : int
        Number of courses.
    block_length, block_height : float
        Dimensions of a block, m; the walls are block_length / 2 thick.
    unit_weight : float
        N/m3.
    direction : sequence of float
        Direction of the live load, which is the weight.
    """
    _refuse_dimensions(
        courses, block_length, length=length, return_length=return_length, block_height=block_height
    )
    t = block_length / 2
    if min(length, return_length) < block_length:
        refuse([f"length {length:g} m and return length {return_length:g} m leave no room for the corner"])
    bond = Bond(block_length, block_height, courses)
    blocks = [
        span_box(p.name, (p.start, p.end), (0.0, t), _heights(p, block_height), unit_weight)
        for p in bond.pieces("front", [(0.0, length), (t, length)], 1)
    ]
    blocks += [
        span_box(p.name, (0.0, t), (p.start, p.end), _heights(p, block_height), unit_weight)
        for p in bond.pieces("side", [(t, return_length), (0.0, return_length)], 0)
    ]
    ground = base((0.0, length), (0.0, return_length), block_height)
    return model_of(blocks, [ground], joint, direction, "corner")


def _heights(piece: Piece, course_height: float) -> tuple[float, float]:
    return piece.course * course_height, (piece.course + 1) * course_height


def _refuse_dimensions(courses: int, block_length: float, **lengths: float) -> None:
    """Raise ModelError unless all is positive and the horizontal lengths are multiples of half a block."""
    refuse_not_positive(block_length=block_length, **lengths)
    half = block_length / 2
    horizontal = [lengths[name] for name in ("length", "return_length") if name in lengths]
    problems = [f"length {value:g} m is not a multiple of {half:g} m, half a block"
                for value in horizontal if abs(value / half - round(value / half)) > 1e-6]  # fmt: skip
    refuse(problems + ([] if courses >= 1 else [f"courses is {courses!r}, expected at least one"]))

"""Beams of stone: a portal, and a lintel that overhangs the end of a wall."""

from __future__ import annotations

from collections.abc import Sequence

from limitblocks.arrays import real
from limitblocks.joints import Joint
from limitblocks.model import Model
from limitblocks.structures.bond import Bond, Piece, refuse_wall
from limitblocks.structures.build import (
    HORIZONTAL,
    UNIT_WEIGHT,
    base,
    model_of,
    pier,
    plain_numbers,
    refuse,
    refuse_fewer,
    refuse_not_positive,
    span_box,
)


@plain_numbers
def portal(
    joint: Joint,
    *,
    span: float,
    pier_width: float,
    pier_blocks: int,
    block_height: float = 0.4,
    lintel_height: float = 0.4,
    depth: float = 0.5,
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = HORIZONTAL,
) -> Model:
    """Return two piers of single blocks and a lintel across them, in the plane X, Z, on a base.

    Parameters
    ----------
    joint : Joint
        Joint of all interfaces, the base included.
    span : float
        Clear distance of the piers, m.
    pier_width, depth : float
        Along X and Y, m; the lintel covers both piers.
    pier_blocks : int
        Number of blocks in each pier.
    block_height, lintel_height : float
        m.
    unit_weight : float
        N/m3.
    direction : sequence of float
        Direction of the live load, which is the weight.
    """
    refuse_not_positive(
        span=span, pier_width=pier_width, block_height=block_height, lintel_height=lintel_height, depth=depth
    )
    refuse_fewer(1, pier_blocks=pier_blocks)
    end, top, y = span + 2 * pier_width, pier_blocks * block_height, (-depth / 2, depth / 2)
    left = pier("left pier", (0.0, pier_width), y, pier_blocks, block_height, unit_weight)
    right = pier("right pier", (end - pier_width, end), y, pier_blocks, block_height, unit_weight)
    lintel = span_box("lintel", (0.0, end), y, (top, top + lintel_height), unit_weight)
    return model_of([*left, *right, lintel], [base((0.0, end), y, block_height)], joint, direction, "portal")


@plain_numbers
def eccentric_lintel(
    joint: Joint,
    *,
    length: float = 2.4,
    courses: int = 2,
    bearing: float = 0.8,
    overhang: float = 0.8,
    load_length: float = 0.4,
    load_height: float = 0.3,
    eccentricity: float = 0.0,
    block_length: float = 0.8,
    block_height: float = 0.3,
    thickness: float = 0.8,
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = (0.0, 1.0, 0.0),
) -> Model:
    """Return a wall whose lintel overhangs one end and carries a stone at its tip, on a base.

    The lintel lies on the wall, is held down by one course above it, and projects in X. Pushed out of plane,
    lintel and stone twist the joints about the bearing, which govern.

    Parameters
    ----------
    joint : Joint
        Joint of all interfaces, the base included.
    length : float
        Of the wall along X, m; a multiple of half the block length.
    courses : int
        Courses below the lintel.
    bearing, overhang : float
        Of the lintel on the wall (a multiple of half the block length, less than the wall) and beyond it, m.
    load_length, load_height : float
        Of the stone at the tip along X and Z, m.
    eccentricity : float
        Of the stone from the middle of the wall along Y, m; less than the thickness.
    block_length, block_height, thickness : float
        Dimensions of a wall block along X, Z and Y, m.
    unit_weight : float
        N/m3.
    direction : sequence of float
        Direction of the live load, which is the weight; default: out of plane.
    """
    refuse_wall(courses, block_length, length=length, bearing=bearing, overhang=overhang,
                load_length=load_length, load_height=load_height, block_height=block_height,
                thickness=thickness)  # fmt: skip
    problems = []
    if bearing >= length:
        problems.append(f"bearing is {bearing!r}, expected less than the length {length!r}")
    if load_length > overhang:
        problems.append(f"load length is {load_length!r}, expected at most the overhang {overhang!r}")
    if not abs(real(eccentricity)) < thickness:
        problems.append(f"eccentricity is {eccentricity!r}, expected less than the thickness {thickness!r}")
    refuse(problems)
    bond, y = Bond(block_length, block_height, courses + 2), (-thickness / 2, thickness / 2)
    top, tip = (courses + 1) * block_height, length + overhang
    pieces = [p for p in bond.pieces("wall", [(0.0, length)] * 2, 0) if p.course != courses]
    pieces += [p for p in bond.pieces("wall", [(0.0, length - bearing)] * 2, 0) if p.course == courses]
    pieces += [Piece("lintel", courses, length - bearing, tip)]
    blocks = bond.boxes(pieces, 0, y, unit_weight)
    off = (y[0] + eccentricity, y[1] + eccentricity)
    load = span_box("load", (tip - load_length, tip), off, (top, top + load_height), unit_weight)
    ground = base((0.0, length), y, block_height)
    return model_of([*blocks, load], [ground], joint, direction, "eccentric lintel")

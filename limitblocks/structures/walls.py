"""Walls in running bond, of one leaf or of two that headers tie together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from limitblocks.joints import Joint
from limitblocks.model import Model
from limitblocks.structures.bond import Bond, Opening, Piece, multiple, openings_of, refuse_wall
from limitblocks.structures.build import (
    HORIZONTAL,
    UNIT_WEIGHT,
    base,
    model_of,
    plain_numbers,
    refuse,
    refuse_fewer,
)


@plain_numbers
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
    refuse_wall(courses, block_length, length=length, block_height=block_height, thickness=thickness)
    bond, y = Bond(block_length, block_height, courses), (-thickness / 2, thickness / 2)
    pieces = bond.pieces("wall", [(0.0, length)] * 2, 0, openings_of(openings))
    blocks = bond.boxes(pieces, 0, y, unit_weight)
    return model_of(blocks, [base((0.0, length), y, block_height)], joint, direction, "wall")


@plain_numbers
def two_leaf_wall(
    joint: Joint,
    *,
    length: float,
    courses: int,
    header_spacing: float | None = None,
    header_courses: int = 2,
    collar: Joint | None = None,
    block_length: float = 0.4,
    block_height: float = 0.2,
    thickness: float = 0.2,
    openings: Sequence[Opening | tuple[float, float, float, float]] = (),
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = (0.0, 1.0, 0.0),
) -> Model:
    """Return a wall of two leaves in running bond, side by side, tied by headers through both, on a base.

    Pushed out of plane, leaves without headers rock each by itself, load factor thickness / height; a wall of
    one piece would reach twice that.

    Parameters
    ----------
    joint : Joint
        Joint of all interfaces but the collar joint, the base included.
    length : float
        Along X, m; a multiple of half the block length.
    courses : int
        Number of courses.
    header_spacing : float, optional
        Distance of the headers of a course, m, a multiple of half the block length; centred in the wall. Left
        out: no headers. A header is half a block long and takes the place of a stretcher's half in both
        leaves; where an opening or a lintel is in its way it is left out.
    header_courses : int
        Every how many courses there are headers: 2 for the second, fourth, ... course.
    collar : Joint, optional
        Joint between the two leaves. Left out: nothing passes from one to the other but through headers.
    block_length, block_height, thickness : float
        Dimensions of a block along X, Z and Y, m; the wall is twice as thick.
    openings : sequence of Opening
        (left, sill, width, height) in m, as for :func:`wall`; each leaf has a lintel of its own.
    unit_weight : float
        N/m3.
    direction : sequence of float
        Direction of the live load, which is the weight; default: out of plane.
    """
    refuse_wall(courses, block_length, length=length, block_height=block_height, thickness=thickness)
    bond, holes = Bond(block_length, block_height, courses), openings_of(openings)
    refuse_fewer(1, header_courses=header_courses)
    gaps = {} if header_spacing is None else _headers(bond, length, header_spacing, header_courses, holes)
    blocks = []
    for leaf, y in (("front", (-thickness, 0.0)), ("back", (0.0, thickness))):
        pieces = bond.pieces(leaf, [(0.0, length)] * 2, 0, holes, gaps)
        blocks += bond.boxes(pieces, 0, y, unit_weight)
    headers = [
        Piece(f"header {course + 1}.{k + 1}", course, *span)
        for course, spans in gaps.items()
        for k, span in enumerate(spans)
    ]
    y = (-thickness, thickness)
    blocks += bond.boxes(headers, 0, y, unit_weight)
    model = model_of(blocks, [base((0.0, length), y, block_height)], joint, direction, "two-leaf wall")
    kept = [
        replace(contact, joint=collar) if across else contact
        for contact in model.interfaces
        if not (across := abs(contact.axes[2, 1]) > 0.5) or collar is not None
    ]
    return replace(model, interfaces=kept)


def _headers(
    bond: Bond, length: float, spacing: float, every: int, openings: Sequence[Opening]
) -> Mapping[int, list[tuple[float, float]]]:
    """Spans of the headers by course, from 0; ModelError if they are off the grid of half blocks."""
    half = bond.block_length / 2
    if not multiple(spacing, half) or round(spacing / half) < 2:
        refuse([f"header spacing is {spacing!r}, expected a multiple of {half:g} m, half a block, and at "
                "least one block"])  # fmt: skip
    places, step = round(length / half), round(spacing / half)
    starts = [k * half for k in range((places - 1) % step // 2, places, step)]
    return {
        course: [
            (x, x + half)
            for x in starts
            if not any(a < x + half / 2 < b for a, b in bond.taken(openings, course))
        ]
        for course in range(every - 1, bond.courses, every)
    }

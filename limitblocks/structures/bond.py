"""Running bond: one course cut into blocks at its head joints, around openings and their lintels."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from limitblocks.errors import ModelError
from limitblocks.geometry import Block
from limitblocks.structures.build import refuse, refuse_fewer, refuse_many, refuse_not_positive, span_box

SAME = 1e-6  # of a block: lengths closer than this are equal
#: On the grid of half blocks.
HORIZONTAL_LENGTHS = ("length", "width", "return_length", "buttress_length", "bearing")


class Opening(NamedTuple):
    """Rectangular opening: left edge and sill from the wall's lower left corner, width and height, m."""

    left: float
    sill: float
    width: float
    height: float


def openings_of(given: Iterable[Sequence[float]]) -> list[Opening]:
    """Return openings as such; ModelError where one is not four numbers."""
    try:
        return [Opening(*map(float, one)) for one in given]
    except (OverflowError, TypeError, ValueError):
        raise ModelError(f"openings are {given!r}, expected (left, sill, width, height) in m each") from None


class Piece(NamedTuple):
    """A block of a wall: name, course from 0, first and last abscissa along the wall, m."""

    name: str
    course: int
    start: float
    end: float


class Bond(NamedTuple):
    """Running bond on a grid of half blocks: block length and course height, m; number of courses."""

    block_length: float
    course_height: float
    courses: int

    def pieces(
        self,
        prefix: str,
        ends: Sequence[tuple[float, float]],
        shift: int,
        openings: Sequence[Opening] = (),
        gaps: Mapping[int, Sequence[tuple[float, float]]] = MappingProxyType({}),
    ) -> list[Piece]:
        """Return the blocks of a wall, from the lowest course up and from left to right.

        Parameters
        ----------
        prefix : str
            Beginning of the block names; they go on with course and place, or `lintel` and its number.
        ends : sequence of (float, float)
            Abscissae between which the even and the odd courses (from 0) run, m.
        shift : int
            Parity of the courses whose head joints lie half a block off the multiples of the block length.
        openings : sequence of Opening
            Holes; each is bridged by a lintel one course high that bears on half a block at either side,
            unless it reaches the top of the wall.
        gaps : mapping of int to sequence of (float, float)
            Spans left free in a course, from 0, for blocks of another bond, m.
        """
        refuse(problem for opening in openings for problem in self._opening_problems(opening))
        pieces = []
        for course in range(self.courses):
            start, end = ends[course % 2]
            holes, lintels = self._interruptions(course, openings)
            holes += gaps.get(course, ())
            _refuse_clash(f"{prefix} course {course + 1}", start, end, [*holes, *lintels.values()])
            pieces += [Piece(f"{prefix} lintel {k + 1}", course, *span) for k, span in lintels.items()]
            offset = 0.5 * self.block_length * ((course + shift) % 2 == 0)
            cuts = self._joints(start, end, offset, [*holes, *lintels.values()])
            pieces += [Piece(f"{prefix} {course + 1}.{k + 1}", course, *span) for k, span in enumerate(cuts)]
        return pieces

    def boxes(
        self, pieces: Iterable[Piece], axis: int, across: Sequence[float], unit_weight: float
    ) -> list[Block]:
        """Return the blocks of a wall along X (`axis` 0) or Y (1) between two values `across` it, m."""
        h, boxes = self.course_height, []
        for p in pieces:
            x, y = ((p.start, p.end), across) if axis == 0 else (across, (p.start, p.end))
            boxes.append(span_box(p.name, x, y, (p.course * h, (p.course + 1) * h), unit_weight))
        return boxes

    def taken(self, openings: Sequence[Opening], course: int) -> list[tuple[float, float]]:
        """Return the spans of openings and lintels in a course, from 0."""
        holes, lintels = self._interruptions(course, openings)
        return [*holes, *lintels.values()]

    def _interruptions(
        self, course: int, openings: Sequence[Opening]
    ) -> tuple[list[tuple[float, float]], dict[int, tuple[float, float]]]:
        """Where the bond of a course is interrupted: by openings, and by the lintels of numbered openings."""
        holes, lintels = [], {}
        for number, opening in enumerate(openings):
            sill, head = (
                round(z / self.course_height) for z in (opening.sill, opening.sill + opening.height)
            )
            left, right = opening.left, opening.left + opening.width
            if sill <= course < head:
                holes.append((left, right))
            elif course == head:
                lintels[number] = (left - self.block_length / 2, right + self.block_length / 2)
        return holes, lintels

    def _joints(
        self, start: float, end: float, offset: float, taken: Sequence[tuple[float, float]]
    ) -> list[tuple[float, float]]:
        """Spans between head joints at offset + k block lengths, from start to end, outside `taken`."""
        grid = offset + self.block_length * np.arange(-1, round(end / self.block_length) + 2)
        edges = np.sort([start, end, *grid[(grid > start) & (grid < end)], *np.ravel(list(taken))])
        spans = zip(edges.tolist(), edges[1:].tolist(), strict=False)
        least = SAME * self.block_length
        return [(a, b) for a, b in spans if b - a > least and not any(c < (a + b) / 2 < d for c, d in taken)]

    def _opening_problems(self, opening: Opening) -> list[str]:
        half, height = self.block_length / 2, self.course_height
        units = (half, height, half, height)
        problems = [
            f"{opening}: {name} is {value:g}, expected a multiple of {unit:g}"
            for name, value, unit in zip(Opening._fields, opening, units, strict=True)
            if not multiple(value, unit)
        ]
        if min(opening.width, opening.height) <= 0.0 or opening.sill < 0.0:
            problems.append(f"{opening}: expected positive width and height, and a sill at or above the base")
        if opening.sill + opening.height > (self.courses + SAME) * height:
            problems.append(f"{opening}: the head is above the wall, {self.courses * height:g} m high")
        return problems


def refuse_wall(courses: int, block_length: float, **lengths: float) -> None:
    """Raise ModelError unless all is positive and the horizontal lengths are multiples of half a block."""
    refuse_not_positive(block_length=block_length, **lengths)
    half = block_length / 2
    on_grid = {name: lengths[name] for name in HORIZONTAL_LENGTHS if name in lengths}
    refuse_many(block_length, **on_grid)
    refuse(f"{name.replace('_', ' ')} {value:g} m is not a positive multiple of {half:g} m, half a block"
           for name, value in on_grid.items()
           if not multiple(value, half) or value < half / 2)  # fmt: skip
    refuse_fewer(1, courses=courses)


def multiple(value: float, unit: float) -> bool:
    """Whether `value` is a multiple of `unit`, nought among them; what is not finite is none."""
    return bool(np.isfinite(value)) and abs(value / unit - round(value / unit)) <= SAME


def _refuse_clash(where: str, start: float, end: float, spans: Sequence[tuple[float, float]]) -> None:
    """Raise ModelError where openings and lintels of one course overlap or leave the wall."""
    last = start
    for left, right in sorted(spans):
        if left < last - SAME or right > end + SAME:
            raise ModelError(
                f"{where}: an opening or lintel from {left:g} to {right:g} m overlaps another "
                f"or leaves the wall, {start:g} to {end:g} m"
            )
        last = right

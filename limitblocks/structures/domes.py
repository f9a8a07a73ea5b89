"""Spherical domes: courses of stones about the Z axis, and two lunes of a dome that stand by themselves."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from limitblocks.arrays import Array, real
from limitblocks.geometry import Block
from limitblocks.joints import Joint
from limitblocks.model import Model
from limitblocks.structures.build import (
    HORIZONTAL,
    UNIT_WEIGHT,
    model_of,
    plain_numbers,
    refuse,
    refuse_fewer,
    refuse_not_positive,
)
from limitblocks.structures.convex import cut, hull
from limitblocks.structures.rings import circular


@plain_numbers
def dome(
    joint: Joint,
    *,
    radius: float,
    thickness: float,
    courses: int,
    stones: int,
    embrace: float = np.pi,
    oculus: float = 0.0,
    running_bond: bool = True,
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = HORIZONTAL,
) -> Model:
    """Return a spherical dome of courses of equal stones on a ring of supports.

    Stones are cut by planes, so that they are convex and touch exactly. Their sides lie in meridian planes.
    A bed joint is the cone of the sphere's radii, approximated by planes that touch it in the middle of the
    stones below it: in running bond a stone rests with two planes on two stones. Intrados and extrados of a
    stone are planes through the circles of radius +- thickness / 2 in its own middle: a section through the
    middle of the stones is an arch of straight voussoirs.

    Parameters
    ----------
    joint : Joint
        Joint of all interfaces, the springing included.
    radius, thickness : float
        To the centreline, and of the dome, m.
    courses : int
        Number of courses, named `course.place` from the springing up, the closing stone, `key`, not counted.
    stones : int
        Number of stones in every course, at least 4.
    embrace : float
        Angle between opposite springings, rad; pi, the default and the largest, is a hemisphere.
    oculus : float
        Angle that an opening at the crown spans, rad; 0: closed by a key as wide as a course is high.
    running_bond : bool
        Whether the stones of a course lie half a stone off those below; else meridian joints go through.
    unit_weight : float
        N/m3.
    direction : sequence of float
        Direction of the live load, which is the weight.
    """
    refuse_not_positive(radius=radius, thickness=thickness, embrace=embrace)
    refuse_fewer(1, courses=courses)
    refuse_fewer(4, stones=stones)
    _refuse_sphere(radius, thickness, embrace, oculus)
    polar = _beds(embrace, oculus, courses)
    slopes = 1 / np.tan(polar)
    if running_bond and (slopes[1:] * np.cos(np.pi / stones) <= slopes[:-1]).any():
        refuse([f"stones is {stones!r}, expected more for {courses} courses: at the ends of a stone the plane"
                " of its upper bed would cross those of its lower bed"])  # fmt: skip
    polar = np.concatenate([[2 * polar[0] - polar[1]], polar])  # course 0 are the supports
    half, shell = np.pi / stones, (radius - thickness / 2, radius + thickness / 2)
    turn = half if running_bond else 0.0
    blocks = []
    for course, beds in enumerate(pairwise(polar.tolist())):
        weight, kind = (unit_weight, "") if course else (None, "support ")
        for k in range(stones):
            middle = 2 * half * k + turn * (course % 2)
            # the supports have no stones below them
            below = [middle] if not course or not running_bond else [middle - half, middle + half]
            name = f"{kind}{course or ''}{'.' if course else ''}{k + 1}"
            blocks.append(_stone(name, middle, half, beds, below, shell, weight))
    supports, blocks = blocks[:stones], blocks[stones:]
    if not oculus:
        azimuths = 2 * half * np.arange(float(stones)) + turn * (courses % 2)
        blocks.append(_key(float(polar[-1]), np.asarray(azimuths), shell, unit_weight))
    return model_of(blocks, supports, joint, direction, "dome")


@plain_numbers
def dome_lunes(
    joint: Joint,
    *,
    radius: float,
    thickness: float,
    voussoirs: int,
    angle: float = 0.1,
    embrace: float = np.pi,
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = HORIZONTAL,
) -> Model:
    """Return two opposite lunes of a spherical dome, an arch in the plane X, Z that narrows to its crown.

    A dome cracked along its meridians stands like this, without hoop forces (Heyman 1967). The key is as wide
    as the joints beside it.

    Parameters
    ----------
    joint : Joint
        Joint of all interfaces, the springings included.
    radius, thickness : float
        To the centreline, and of the dome, m.
    voussoirs : int
        Number of voussoirs of both lunes and the key, an odd number of at least 3.
    angle : float
        Between the meridian planes of a lune, rad; less than pi.
    embrace : float
        Angle between the springings, rad, up to pi.
    unit_weight : float
        N/m3.
    direction : sequence of float
        Direction of the live load, which is the weight.
    """
    refuse_not_positive(angle=angle)
    refuse_fewer(3, voussoirs=voussoirs)
    problems = []
    if voussoirs % 2 == 0:
        problems.append(f"voussoirs is {voussoirs!r}, expected an odd number of at least 3")
    if angle >= np.pi:
        problems.append(f"angle is {angle!r}, expected less than pi rad")
    refuse(problems)
    ring, spread = circular(radius, thickness, voussoirs, embrace), np.tan(angle / 2)
    outlines = {f"voussoir {k + 1}": outline for k, outline in enumerate(ring.voussoirs())}
    outlines |= {f"{side} support": outline for side, outline in ring.skewbacks().items()}
    blocks = [
        hull(name, _between_meridians(outline, spread), None if "support" in name else unit_weight)
        for name, outline in outlines.items()
    ]
    return model_of(blocks[:-2], blocks[-2:], joint, direction, "lunes of a dome")


def _beds(embrace: float, oculus: float, courses: int) -> Array:
    """Polar angles of the beds, from the springing up; half the key is half as high as a course."""
    bottom = embrace / 2
    return np.linspace(bottom, oculus / 2 if oculus else bottom / (2 * courses + 1), courses + 1)


def _between_meridians(outline: Array, spread: float) -> Array:
    """Corners of what an outline (n, 2) in X, Z cuts out between the planes y = +- spread x."""
    x, z = outline.T
    return np.concatenate([np.column_stack([x, side * spread * np.abs(x), z]) for side in (-1, 1)])


def _stone(
    name: str,
    middle: float,
    half: float,
    beds: tuple[float, float],
    below: Sequence[float],
    shell: tuple[float, float],
    unit_weight: float | None,
) -> Block:
    """Stone of the half width `half` about the azimuth `middle`, between beds at two polar angles.

    `below` are the azimuths at which the planes of its lower bed touch their cone.
    """
    normals: list[Array] = [_out(np.pi / 2, middle + sign * (half + np.pi / 2)) for sign in (-1, 1)]
    normals += [-_bed(beds[0], azimuth) for azimuth in below] + [_bed(beds[1], middle)]
    outward = _out((beds[0] + beds[1]) / 2, middle)
    low, high = np.cos((beds[0] - beds[1]) / 2) * np.array(shell)  # a chord is nearer to the centre
    offsets = [*np.zeros(len(normals)), -low, high]
    return cut(name, [*normals, -outward, outward], offsets, (low + high) / 2 * outward, unit_weight)


def _key(polar: float, azimuths: Array, shell: tuple[float, float], unit_weight: float) -> Block:
    """Closing stone on the planes that touch the cone of a polar angle at `azimuths`."""
    up = np.array([0.0, 0.0, 1.0])
    low, high = np.cos(polar) * np.array(shell)
    beds = [-_bed(polar, azimuth) for azimuth in azimuths.tolist()]
    return cut(
        "key", [*beds, -up, up], [*np.zeros(len(beds)), -low, high], (low + high) / 2 * up, unit_weight
    )


def _out(polar: float, azimuth: float) -> Array:
    """Unit vector from the centre at a polar angle from the zenith and an azimuth."""
    level = np.sin(polar)
    return np.array([level * np.cos(azimuth), level * np.sin(azimuth), np.cos(polar)])


def _bed(polar: float, azimuth: float) -> Array:
    """Upward unit normal of the plane that touches the cone of radii at a polar angle."""
    return _out(polar - np.pi / 2, azimuth)


def _refuse_sphere(radius: float, thickness: float, embrace: float, oculus: float) -> None:
    problems = []
    if thickness >= 2 * radius:
        problems.append(f"thickness is {thickness!r}, expected less than twice the radius {radius!r}")
    if embrace > np.pi:
        problems.append(f"embrace is {embrace!r}, expected an angle up to pi (a hemisphere) in rad")
    if not 0.0 <= real(oculus) < embrace:
        problems.append(f"oculus is {oculus!r}, expected an angle from 0 to less than {embrace!r}")
    refuse(problems)

"""A wedge on two planes: a V groove, level or plunging, upright or tilted."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from limitblocks.geometry import Block
from limitblocks.joints import Joint
from limitblocks.model import Model
from limitblocks.structures.build import (
    HORIZONTAL,
    UNIT_WEIGHT,
    model_of,
    plain_numbers,
    refuse,
    refuse_not_positive,
)
from limitblocks.structures.convex import hull


@plain_numbers
def wedge(
    joint: Joint,
    *,
    half_angle: float,
    height: float = 1.0,
    length: float = 2.0,
    plunge: float = 0.0,
    tilt: float = 0.0,
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = HORIZONTAL,
) -> Model:
    """Return a triangular prism that rests on the two planes of a V groove and can slide along it.

    Both planes push against each other through the wedge, which multiplies the friction by
    K = cos(tilt) / sin(half_angle), the wedge factor. Without dilatancy the load factor along X is
    tan(atan(mu K) - plunge): mu / sin(half_angle) in an upright, level groove. With associated flow that
    groove lets go at mu / sqrt(sin^2 w - mu^2 cos^2 w), w the half angle, and not at all where tan w <= mu.
    Source: Hoek and Bray (1981), Rock Slope Engineering, 3rd ed., chapter 8: F = K tan(phi) / tan(plunge).

    It slides rather than turns if the groove is long, length > load factor * height / 3 where it is upright.

    Parameters
    ----------
    joint : Joint
        Joint of both planes.
    half_angle : float
        Between either plane and the bisector of the groove, rad, less than pi/2.
    height, length : float
        Of the wedge along the bisector, and along the groove, m.
    plunge : float
        Angle by which the groove falls towards +X, rad.
    tilt : float
        Angle by which the bisector leans out of the vertical plane through the groove, rad; less than
        pi/2 - half_angle, or the wedge rests on one plane only.
    unit_weight : float
        N/m3.
    direction : sequence of float
        Direction of the live load, which is the weight.
    """
    refuse_not_positive(half_angle=half_angle, height=height, length=length)
    problems = [] if half_angle < np.pi / 2 else [f"half angle is {half_angle!r}, expected less than pi/2"]
    if not abs(plunge) < np.pi / 2:
        problems.append(f"plunge is {plunge!r}, expected an angle between -pi/2 and pi/2")
    if not abs(tilt) < np.pi / 2 - half_angle:
        problems.append(f"tilt is {tilt!r}, expected less than pi/2 - half angle {half_angle!r}")
    refuse(problems)
    a, t, p = height * np.tan(half_angle), tilt, plunge
    about_x = np.array([(1, 0, 0), (0, np.cos(t), -np.sin(t)), (0, np.sin(t), np.cos(t))])
    about_y = np.array([(np.cos(p), 0, np.sin(p)), (0, 1, 0), (-np.sin(p), 0, np.cos(p))])

    def prism(name: str, section: npt.ArrayLike, unit_weight: float | None = None) -> Block:
        corners = [(x, y, z) for x in (-length / 2, length / 2) for y, z in np.asarray(section, dtype=float)]
        return hull(name, corners @ (about_y @ about_x).T, unit_weight)

    planes = [
        prism("left plane", [(0, 0), (a, height), (a, 0)]),
        prism("right plane", [(0, 0), (-a, height), (-a, 0)]),
    ]
    stone = prism("wedge", [(0, 0), (a, height), (-a, height)], unit_weight)
    return model_of([stone], planes, joint, direction, "wedge")

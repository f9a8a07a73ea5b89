"""Voussoir arches."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from limitblocks.arrays import Array
from limitblocks.joints import Joint
from limitblocks.model import Model
from limitblocks.structures.build import (
    HORIZONTAL,
    UNIT_WEIGHT,
    model_of,
    prism,
    refuse,
    refuse_not_positive,
)


def arch(
    joint: Joint,
    *,
    radius: float,
    thickness: float,
    voussoirs: int,
    embrace: float = np.pi,
    depth: float = 1.0,
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = HORIZONTAL,
) -> Model:
    """Return a circular arch of equal voussoirs with radial joints on two supports, in the plane X, Z.

    The corners of the voussoirs lie on the circles of radius +- thickness / 2; their edges are straight.

    Parameters
    ----------
    joint : Joint
        Joint of all interfaces, the springings included.
    radius : float
        To the centreline, m.
    thickness : float
        m, less than twice the radius.
    voussoirs : int
        Number of voussoirs, named from `voussoir 1` at the left (-X) springing.
    embrace : float
        Angle between the springings, rad; pi, the default and the largest, is a semicircle.
    depth : float
        Dimension along Y, m.
    unit_weight : float
        N/m3.
    direction : sequence of float
        Direction of the live load, which is the weight.
    """
    refuse_not_positive(radius=radius, thickness=thickness, embrace=embrace, depth=depth)
    problems = [] if voussoirs >= 2 else [f"voussoirs is {voussoirs!r}, expected at least 2"]
    if thickness >= 2 * radius:
        problems.append(f"thickness is {thickness!r}, expected less than twice the radius {radius!r}")
    if embrace > np.pi:
        problems.append(f"embrace is {embrace!r}, expected an angle up to pi (a semicircle) in rad")
    refuse(problems)
    joints = np.linspace(-embrace / 2, embrace / 2, voussoirs + 1)
    inner, outer = (_on_circle(radius + side * thickness / 2, joints) for side in (-1, 1))
    blocks = [
        prism(f"voussoir {k + 1}", (inner[k], inner[k + 1], outer[k + 1], outer[k]), depth, unit_weight)
        for k in range(voussoirs)
    ]
    below = thickness * np.array(
        [-np.cos(embrace / 2), -np.sin(embrace / 2)]
    )  # tangent at the left springing
    left = [outer[0] + below, inner[0] + below, inner[0], outer[0]]
    right = np.array(left[::-1]) * (-1.0, 1.0)
    supports = [prism("left support", left, depth), prism("right support", right, depth)]
    return model_of(blocks, supports, joint, direction, f"arch of {voussoirs} voussoirs")


def _on_circle(radius: float, angles: Array) -> Array:
    """Points (x, z) on a circle about the origin at `angles` from the crown, clockwise; shape (n, 2)."""
    return radius * np.column_stack([np.sin(angles), np.cos(angles)])

"""Voussoir arches."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from limitblocks.arrays import Array
from limitblocks.geometry import Block
from limitblocks.joints import Joint
from limitblocks.model import Model
from limitblocks.structures.build import (
    HORIZONTAL,
    UNIT_WEIGHT,
    base,
    model_of,
    pier,
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
    refuse_not_positive(depth=depth)
    ring = Ring.checked(radius, thickness, voussoirs, embrace)
    blocks = ring_blocks(ring, depth, unit_weight)
    supports = [prism(f"{side} support", outline, depth) for side, outline in ring.skewbacks().items()]
    return model_of(blocks, supports, joint, direction, f"arch of {voussoirs} voussoirs")


def arch_on_piers(
    joint: Joint,
    *,
    radius: float,
    thickness: float,
    voussoirs: int,
    pier_width: float,
    pier_blocks: int,
    block_height: float = 0.4,
    depth: float = 1.0,
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = HORIZONTAL,
) -> Model:
    """Return a semicircular arch on two piers of single blocks, in the plane X, Z, on a base.

    The piers begin flush with the intrados and stand out beyond the extrados.

    Parameters
    ----------
    joint : Joint
        Joint of all interfaces, springings and base included.
    radius, thickness : float
        To the centreline, and of the ring, m.
    voussoirs : int
        Number of voussoirs, named from `voussoir 1` at the left (-X) springing.
    pier_width : float
        Along X, m; at least the thickness.
    pier_blocks : int
        Number of blocks in each pier.
    block_height : float
        Of the pier blocks, m.
    depth : float
        Dimension along Y, m.
    unit_weight : float
        N/m3.
    direction : sequence of float
        Direction of the live load, which is the weight.
    """
    refuse_not_positive(pier_width=pier_width, block_height=block_height, depth=depth)
    ring = Ring.checked(radius, thickness, voussoirs, np.pi)
    problems = [] if pier_blocks >= 1 else [f"pier blocks is {pier_blocks!r}, expected at least 1"]
    if pier_width < thickness:
        problems.append(f"pier width is {pier_width!r}, expected at least the thickness {thickness!r}")
    refuse(problems)
    inner = radius - thickness / 2
    outer, y = inner + pier_width, (-depth / 2, depth / 2)
    piers = [
        block
        for side, x in (("left", (-outer, -inner)), ("right", (inner, outer)))
        for block in pier(f"{side} pier", x, y, pier_blocks, block_height, unit_weight)
    ]
    arch_blocks = ring_blocks(ring, depth, unit_weight, height=pier_blocks * block_height)
    ground = base((-outer, outer), y, block_height)
    return model_of([*piers, *arch_blocks], [ground], joint, direction, "arch on piers")


class Ring(NamedTuple):
    """Ring of equal voussoirs with straight edges; points are (x, z) about the centre, m."""

    inner: Array
    outer: Array

    @classmethod
    def checked(cls, radius: float, thickness: float, voussoirs: int, embrace: float) -> Ring:
        """Return the ring, or raise ModelError naming everything that makes it impossible."""
        refuse_not_positive(radius=radius, thickness=thickness, embrace=embrace)
        problems = [] if voussoirs >= 2 else [f"voussoirs is {voussoirs!r}, expected at least 2"]
        if thickness >= 2 * radius:
            problems.append(f"thickness is {thickness!r}, expected less than twice the radius {radius!r}")
        if embrace > np.pi:
            problems.append(f"embrace is {embrace!r}, expected an angle up to pi (a semicircle) in rad")
        refuse(problems)
        joints = np.linspace(-embrace / 2, embrace / 2, voussoirs + 1)
        return cls(*(_on_circle(radius + side * thickness / 2, joints) for side in (-1, 1)))

    def voussoirs(self) -> list[Array]:
        """Return the outlines from the left springing to the right, (4, 2) each."""
        a, b = self.inner, self.outer
        return [np.array([a[k], a[k + 1], b[k + 1], b[k]]) for k in range(len(a) - 1)]

    def skewbacks(self) -> dict[str, Array]:
        """Return the outlines of supports below the left and the right springing, (4, 2) each."""
        across = self.outer[0] - self.inner[0]
        below = np.array([across[1], -across[0]])  # tangent at the left springing, downwards
        below *= -np.sign(below[1])
        left = np.array([self.outer[0] + below, self.inner[0] + below, self.inner[0], self.outer[0]])
        return {"left": left, "right": left[::-1] * (-1.0, 1.0)}


def ring_blocks(ring: Ring, depth: float, unit_weight: float, height: float = 0.0) -> list[Block]:
    """Return the voussoirs of a ring whose centre is at z = `height`."""
    return [
        prism(f"voussoir {k + 1}", np.add(outline, (0.0, height)), depth, unit_weight)
        for k, outline in enumerate(ring.voussoirs())
    ]


def _on_circle(radius: float, angles: Array) -> Array:
    """Points (x, z) on a circle about the origin at `angles` from the crown, clockwise; shape (n, 2)."""
    return radius * np.column_stack([np.sin(angles), np.cos(angles)])

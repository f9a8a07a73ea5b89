"""Point contacts at the corners of an interface (Livesley 1978), with Coulomb cones or polygons."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.joints.base import (
    YieldRows,
    checked_choice,
    checked_count,
    checked_friction,
    friction_words,
    strength_words,
)
from limitblocks.joints.cutting_planes import farthest
from limitblocks.joints.queries import Queries
from limitblocks.joints.question import OUTSIDE, Question
from limitblocks.joints.rows import shear_directions
from limitblocks.problem import Mode


@dataclass(frozen=True, repr=False)
class PointContact(Queries):
    """Forces at the polygon's corners, each within its Coulomb cone ||(V1, V2)|| <= -mu N.

    Livesley's model, used by most rigid-block codes:

    - shear and hinging of a convex polygon are exact for infinite compressive strength;
    - torsion is overestimated, because the pressure is free to gather at the corners: mu |N| d/2 on a
      rectangle of diagonal d, 1.85 to 1.94 times that under uniform pressure for aspect ratios 1 to 4,
      on an equilateral triangle 2.17, on a regular hexagon 1.64 times;
    - more points change nothing: a force anywhere in a convex polygon can be shared among the corners
      with the same resultants, each share within its cone, so that refining does not reduce torsion;
    - there is no cohesion and no limit of compression: they would depend on how many points share them.

    Parameters
    ----------
    friction : float
        Friction coefficient mu >= 0. With zero friction the points carry N only.
    points : int
        Points on each side, its first corner included; 1 is the corners alone.
    cone : {"exact", "inner", "outer"}
        The Coulomb circle of each point itself, or a polygon within it or around it: safe or unsafe with
        associated flow. Without dilatancy polygons give an interval of load factors, on neither side.
    sides : int
        Sides of the inner or outer polygon, at least 3: too weak by up to 1 - cos(pi/sides), or too strong
        by up to 1/cos(pi/sides) - 1.

    Raises
    ------
    ModelError
        If a number is out of range or a word unknown.
    """

    friction: float
    points: int = 1
    cone: Literal["exact", "inner", "outer"] = "exact"
    sides: int = 8

    def __post_init__(self) -> None:
        checked_friction(self.friction)
        checked_count("points", self.points, 1)
        checked_choice("cone", self.cone, ("exact", "inner", "outer"))
        checked_count("sides", self.sides, 3)
        if self.cone == "exact" and self.sides != 8:
            raise ModelError(f"sides is {self.sides}, but cone='exact' is round; choose 'inner' or 'outer'")

    def in_words(self) -> str:
        """Return the joint in words."""
        shape = {"exact": "", "inner": " by an inner polygon", "outer": " by an outer polygon"}[self.cone]
        sides = f" of {self.sides} sides" if shape else ""
        where = "forces at the corners" if self.points == 1 else f"{self.points} forces on each side"
        strengths = strength_words(0.0, 0.0, None)
        return f"{friction_words(self.friction)}{shape}{sides}, {strengths}, {where} of each contact area"

    def assumed(self) -> tuple[str, ...]:
        """Return a sentence for each assumption."""
        polygons = {
            "exact": "Each force is limited by Coulomb's cone itself.",
            "inner": "Each force is limited by a polygon within Coulomb's cone, safe with associated flow.",
            "outer": "Each force is limited by a polygon around Coulomb's cone, unsafe with associated flow.",
        }
        return (
            "Joints carry forces at points of their contact areas (Livesley 1978): shear and hinging are "
            "exact where nothing crushes.",
            "Torsion is overestimated, because the pressure is free to gather at the corners: 1.85 to 1.94 "
            "times that under uniform pressure on rectangles of aspect ratios 1 to 4.",
            polygons[self.cone],
            "Joints do not crush and have no cohesion.",
        )

    def yield_rows(self, polygons: Array, stress_unit: float = 1.0) -> YieldRows:
        """Return the rows for polygons of shape (m, n, 2); see :class:`~limitblocks.joints.base.Joint`.

        The generalised stresses are (V1, V2, N) of point 1, of point 2, and so on.
        """
        points = contact_points(polygons, self.points)
        m, n, _ = points.shape
        resultants = point_resultants(points)
        if self.friction == 0.0:
            resultants = resultants[:, :, 2::3]
            rows, flow, sliding = -np.eye(n), -np.eye(n), 0
        else:
            opening = np.kron(np.eye(n), [[0.0, 0.0, -1.0]])
            slip = np.kron(np.eye(n), _coulomb(self.friction, self.cone, self.sides))
            rows, sliding = np.vstack([opening, slip]), len(slip)
            flow = rows.copy()
            flow[n:, 2::3] = 0.0  # zero dilatancy: sliding does not open the point
        conic = self.cone == "exact"
        return YieldRows(
            F=np.broadcast_to(rows, (m, *rows.shape)),
            g=np.zeros((m, len(rows))),
            G=np.broadcast_to(flow, (m, *flow.shape)),
            pivot=np.zeros((m, len(rows))),
            half_sides=np.abs(polygons).max(axis=1),
            resultants=resultants,
            linear=n if conic else n + sliding,
            cones=(3,) * (sliding // 3) if conic else (),
            modes=(Mode.OPEN,) * n + (Mode.SLIP,) * sliding,
            friction=self.friction,
        )

    def _largest(self, question: Question, Q: Array, d: Array) -> float:
        given = Q / question.unit
        held = given * [0, 0, 1, 0, 0, 0]
        if held[2] > OUTSIDE:
            return np.nan
        if (given - held).any() and not farthest(question.rows, held, given - held)[0] >= 1.0 - OUTSIDE:
            return np.nan
        return farthest(question.rows, given, d / question.unit)[0]

    def _active(self, question: Question, Q: Array, tolerance: float) -> tuple[str, ...]:
        """Modes of one mechanism at Q, because the forces of the points are not unique."""
        held = Q * [0, 0, 1, 0, 0, 0] / question.unit
        d = Q / question.unit - held
        if held[2] > OUTSIDE or not d.any():
            return (Mode.OPEN,) if held[2] > OUTSIDE else ()
        t, work = farthest(question.rows, held, d)
        if held[2] >= -OUTSIDE:
            return () if t > 1.0 else (Mode.OPEN,)
        if t > 1.0 + tolerance:
            return ()
        moving = work > tolerance * work.max(initial=0.0)
        return tuple(dict.fromkeys(m for m, moves in zip(question.modes, moving, strict=True) if moves))


def _coulomb(friction: float, cone: str, sides: int) -> Array:
    """Rows of ||(V1, V2)|| <= -mu N: the cone (3, 3), or planes (sides, 3)."""
    if cone == "exact":
        return np.array([[0.0, 0.0, -friction], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    d = shear_directions(cone, sides)
    return np.column_stack([-d, np.full(sides, -friction)])


def contact_points(polygons: Array, per_side: int) -> Array:
    """Points (m, n per_side, 2) at equal distances on each side of polygons (m, n, 2), corners included."""
    step = np.arange(per_side)[:, None] / per_side
    start, side = polygons[:, :, None], (np.roll(polygons, -1, axis=1) - polygons)[:, :, None]
    return np.asarray((start + step * side).reshape(len(polygons), -1, 2))


def point_resultants(points: Array) -> Array:
    """Matrices (m, 6, 3 n) that turn forces at points (m, n, 2) into Q: r x f about the centroid."""
    m, n, _ = points.shape
    x1, x2 = points[..., 0], points[..., 1]
    matrix = np.zeros((m, 6, n, 3))
    matrix[:, 0, :, 0] = matrix[:, 1, :, 1] = matrix[:, 2, :, 2] = 1.0
    matrix[:, 3, :, 2] = x2
    matrix[:, 4, :, 2] = -x1
    matrix[:, 5, :, 0] = -x2
    matrix[:, 5, :, 1] = x1
    return matrix.reshape(m, 6, 3 * n)

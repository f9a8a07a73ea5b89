"""Torsion of a convex polygon under uniform pressure, from within and from without."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from itertools import product
from typing import Literal

import numpy as np

from limitblocks.arrays import Array
from limitblocks.geometry import Interface
from limitblocks.geometry.polygon import areas
from limitblocks.joints.base import (
    YieldRows,
    checked_choice,
    checked_count,
    checked_friction,
    checked_stress,
    friction_words,
    strength_words,
)
from limitblocks.joints.interaction import effective_areas
from limitblocks.joints.limit_surface import (
    directions,
    dissipation,
    inner_polytope,
    outer_polytope,
    unique_shapes,
)
from limitblocks.joints.queries import Queries
from limitblocks.joints.rows import Rows, frictional, hinge_gradients, hinging, stacked
from limitblocks.joints.stress_block import CRUSHING
from limitblocks.joints.torsion import torsion_constant, torsion_integrals

SIGNS = (1.0, -1.0)
SIGNS_2 = np.array(list(product(SIGNS, SIGNS)))


@dataclass(frozen=True, repr=False)
class ExactTorsion(Queries):
    """The exact limit surface (V1, V2, T) of uniform pressure, with bending and hinging, from one side.

    The exact yield set meant here has (V1, V2, T) within mu |N| times the limit surface of the whole polygon
    (Goyal, Ruina & Papadopoulos 1991), |T| within the strength of the effective area (Eqs 19-20 and their
    generalisation, `limitblocks.joints.interaction.effective_areas`), and N, M1, M2 within hinging.
    Two linear programs, one on each side, bracket its static load factor:

    - side="inner" is safe: the convex hull of points of the limit surface. `discretisation_error` is how
      much stronger the exact surface can be, 6 to 8 % by default, falling as 1 / fineness^2;
    - side="outer" is unsafe: tangent planes of the limit surface, too strong by no more than the same error
      (and exact in pure shear along the axes and in pure torsion);
    - under bending the effective rectangle's T is convex in each quadrant of the eccentricities, so the set
      is *not* convex and cannot be refined. Inner: its tangent plane at the centre, exact without
      bending and below it at a hinge. Outer: its convex hull, Eq. (30) and the plane through T0 and Table 4's
      A and C, exact at the corners of each quadrant. `bending_error` is the distance between the two over T0,
      15 to 18 % for aspect ratios 1 to 3, less beyond;
    - other polygons: inner, uniform pressure on the largest copy of the effective area at e = 0 that fits
      about the point of action, without bending, too: exact there if half a turn leaves the area as it is,
      24 % below torsion alone on a triangle; outer, Eq. (30) on the bounding rectangles along the sides;
    - shear and bending reduce torsion independently, as in the paper. With eccentricity e the shear force of
      pure sliding acts at e, so this errs on either side by up to mu |N| |e| in T;
    - areas in several convex pieces: each piece is bracketed, not how they share the pressure. Associated
      flow gathers it where its lever is longest: the torsion of the whole is too strong with either side;
    - no cohesion: it would act on an effective area that depends on the state.

    Parameters
    ----------
    friction : float
        Friction coefficient mu >= 0. With zero friction the interface carries N, M1, M2 only.
    fineness : int
        8 fineness^2 planes stand for the limit surface; at least 1.
    side : {"inner", "outer"}
        Safe or unsafe.
    compressive_strength : float, optional
        Effective strength fcef, Pa, of hinging, Eq. (39), whose moments are up to 1 + sqrt(-N / (A fcef))
        times those of the stress block; infinite unless given. Torsion and shear are not reduced.

    Raises
    ------
    ModelError
        If a number is out of range or a word unknown.
    """

    friction: float
    fineness: int = 4
    side: Literal["inner", "outer"] = "inner"
    compressive_strength: float | None = None

    def __post_init__(self) -> None:
        checked_friction(self.friction)
        checked_count("fineness", self.fineness, 1)
        checked_choice("side", self.side, ("inner", "outer"))
        if self.compressive_strength is not None:
            checked_stress("compressive strength", self.compressive_strength, positive=True, unlimited=True)

    @property
    def _from(self) -> str:
        return "within" if self.side == "inner" else "without"

    def in_words(self) -> str:
        """Return the joint in words."""
        side = f"from {self._from}, {'safe' if self.side == 'inner' else 'unsafe'}"
        strengths = strength_words(0.0, 0.0, self.compressive_strength)
        return f"{friction_words(self.friction)}, {strengths}, torsion by the exact limit surface {side}"

    def assumed(self) -> tuple[str, ...]:
        """Return a sentence for each assumption."""
        return (
            "Shear and torsion are limited by the exact limit surface of uniform pressure (Goyal, Ruina & "
            f"Papadopoulos 1991), by {8 * self.fineness**2} planes from {self._from}.",
            "Torsion under bending is that of the effective area, Eqs (19)-(20), by planes from there, too.",
            "Shear and bending reduce torsion independently of each other; there is no cohesion.",
            *((CRUSHING,) if self.compressive_strength is not None else ()),
        )

    def yield_rows(self, polygons: Array, stress_unit: float = 1.0) -> YieldRows:
        """Return the rows for polygons of shape (m, n, 2); see :class:`~limitblocks.joints.base.Joint`."""
        groups = [hinging(polygons, self.compressive_strength, stress_unit=stress_unit)]
        if self.friction > 0.0:
            groups = self._frictional_rows(polygons) + groups
        return stacked(groups, np.abs(polygons).max(axis=1), self.friction, self.friction > 0.0)

    def discretisation_error(self, interface: Interface) -> float:
        """Gap of the (V1, V2, T) polytopes of an `interface`.

        inner >= exact / (1 + gap), outer <= exact (1 + gap).
        """
        return inner_polytope(interface.polygon, self.fineness).gap

    def bending_error(self, interface: Interface) -> float:
        """Largest difference of torsion, over T0, between both planes of an `interface` under bending.

        Largest at a corner of the four quadrants of a rectangle; sampled on other polygons.
        """
        polygon = interface.polygon
        share = np.linspace(0.0, 1.0, 101)[:, None, None]
        boundary = polygon + share * (np.roll(polygon, -1, axis=0) - polygon)
        e = (share[..., None] * boundary).reshape(-1, 2)
        states = np.column_stack([-np.ones(len(e)), -e[:, 1], e[:, 0]])  # N, M1, M2 of a unit force at e
        top, bottom = (-(states @ bending_planes(polygon, side).T).max(axis=1) for side in ("outer", "inner"))
        whole = torsion_constant(polygon)
        return float((np.minimum(top, whole) - np.minimum(bottom, whole)).max() / whole)

    def _frictional_rows(self, polygons: Array) -> list[Rows]:
        """Planes of the limit surface and of torsion under bending, computed once for each shape."""
        first, shape_of = unique_shapes(polygons)
        tables: dict[str, list[Array]] = defaultdict(list)
        for polygon in polygons[first]:
            for mode, (normals, offsets) in self._surfaces(polygon).items():
                surface = np.zeros((len(offsets), 6))
                surface[:, [0, 1, 5]], surface[:, 2] = normals, self.friction * offsets
                tables[mode].append(surface)
            planes = self.friction * bending_planes(polygon, self.side)
            twist = np.repeat(SIGNS, len(planes))
            bending = np.column_stack([np.zeros((len(twist), 2)), np.tile(planes, (2, 1)), twist])
            tables["moment-twist"].append(bending / np.abs(polygon).max(axis=0).sum())
        return [
            frictional(mode, -_of_one_length(planes_of)[shape_of], np.zeros(1))
            for mode, planes_of in tables.items()
        ]

    def _surfaces(self, polygon: Array) -> dict[str, tuple[Array, Array]]:
        """Normals (k, 3) and offsets (k,) of the planes of the limit surface by failure mode."""
        if self.side == "inner":
            hull = inner_polytope(polygon, self.fineness)
            return {"slip-twist": (hull.normals, hull.offsets)}
        around = outer_polytope(polygon, self.fineness)
        axes = directions(1)  # with these tangent planes pure shear along the axes and pure torsion are exact
        pure = {"slip": axes[axes[:, 2] == 0], "twist": axes[axes[:, 2] != 0] / torsion_constant(polygon)}
        tangents = {mode: (normals, dissipation(polygon, normals)) for mode, normals in pure.items()}
        return tangents | {"slip-twist": (around.normals, around.offsets)}


def _of_one_length(tables: list[Array]) -> Array:
    """Stack tables (k, 6) as (u, largest k, 6); shorter ones repeat some of their rows."""
    longest = max(map(len, tables))
    return np.stack([table[np.arange(longest) % len(table)] for table in tables])


def bending_planes(polygon: Array, side: str) -> Array:
    """Planes (k, 3), m, of torsion under bending: |T| + mu planes @ (N, M1, M2) <= 0.

    Inner, on a rectangle: c_T(l1 - |e1|, l2 - |e2|) is convex, as the mean of hypot(x1, x2) over it. With
    the parts T1, T2 of Eqs (9)-(10) its tangent plane at e = 0 is T2 (1 - |e1| / l1) + T1 (1 - |e2| / l2).
    Other polygons: if e is the fraction q of the way to the boundary, the copy of the effective area S at
    e = 0, (1 - q) S about e, fits into the polygon: the plane is c_T(S) times hinging.

    Outer: the effective area is convex and symmetric about e, between the bounds of the polygon in any two
    axes and their images, so that its mean of |x1| + |x2| is at most half the sum of the distances from e to
    the nearer bounds: Eq. (30) on the bounding rectangle along each side. On a rectangle it has its own two
    sides only, and the other facet of the convex hull (see ExactTorsion).
    """
    sides = np.roll(polygon, -1, axis=0) - polygon
    along = sides / np.hypot(sides[:, 0], sides[:, 1])[:, None]
    frames = np.stack([along, along[:, ::-1] * [-1.0, 1.0]], axis=1)  # rows: along the side, inwards
    l1, l2 = np.abs(polygon @ frames[0].T).max(axis=0).tolist()
    if len(polygon) == 4 and areas(polygon) > 4 * l1 * l2 * (1 - 1e-9):
        return _rectangle_planes(l1, l2, side) @ _resultant_turn(frames[0])
    if side == "inner":
        (symmetric,) = np.ravel(effective_areas(polygon, (0.0, 0.0)))
        return np.asarray(torsion_constant(symmetric) * hinge_gradients(polygon[None])[0, :, 2:5])
    turned = [polygon @ frame.T for frame in frames]
    boxes = [_box_planes(p.max(axis=0), -p.min(axis=0)) for p in turned]
    return np.concatenate([box @ _resultant_turn(f) for box, f in zip(boxes, frames, strict=True)])


def _rectangle_planes(l1: float, l2: float, side: str) -> Array:
    """Planes (4 or 8, 3) of a rectangle along its axes."""
    half = np.array([l1, l2])
    rectangle = half * [(1, -1), (1, 1), (-1, 1), (-1, -1)]
    twist = torsion_integrals(rectangle, (0.0, 0.0))
    T1, T2 = twist.T1 / (4 * l1 * l2), twist.T2 / (4 * l1 * l2)
    if side == "inner":
        return np.column_stack([np.full(4, T1 + T2), np.array([T1 / l2, T2 / l1]) * SIGNS_2])
    facet = (T1 + T2 - half / 2) / half[::-1]  # from T0 to the points A and C of Table 4
    return np.concatenate([_box_planes(half, half), np.column_stack([np.full(4, T1 + T2), facet * SIGNS_2])])


def _box_planes(high: Array, low: Array) -> Array:
    """Eq. (30) as planes (4, 3) for bounds at distances `high` and `low` (2,) from the centroid."""
    # e1 |N| = M2 and e2 |N| = -M1
    levers = np.where(SIGNS_2 > 0, high, low).sum(axis=1)
    return np.column_stack([levers, -SIGNS_2[:, 1], SIGNS_2[:, 0]]) / 2


def _resultant_turn(frame: Array) -> Array:
    """Matrix (3, 3) that turns (N, M1, M2) into axes of rows `frame` (2, 2)."""
    turn = np.eye(3)
    turn[1:, 1:] = frame
    return turn

"""The yield surface of Orduña & Lourenço (2005, Part I, Section 4), with round or polygonal friction."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import Any, Literal

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.geometry.polygon import TIE, along_longest_side, areas
from limitblocks.joints.base import (
    YieldRows,
    checked_choice,
    checked_count,
    checked_friction,
    checked_stress,
    friction_words,
    strength_words,
    stress_words,
)
from limitblocks.joints.key_states import key_state_rows
from limitblocks.joints.queries import Queries
from limitblocks.joints.rows import Rows, frictional, hinging, shear_directions, stacked
from limitblocks.joints.stress_block import CRUSHING
from limitblocks.joints.torsion import rectangle_torsion_constant, torsion_constants

SIGNS = (1.0, -1.0)
# Signs of (V1, V2, N, M1, M2, T) in each row of the yield functions; `_Planes.rows` puts the factors.
TWIST = np.array([(0, 0, 1, 0, 0, t) for t in SIGNS])  # Eq. (23)
MOMENT_TWIST = np.array([(0, 0, 1, a, b, t) for a, b, t in product(SIGNS, SIGNS, SIGNS)])  # Eq. (30)
SLIP_FORCE = 1.3  # of V0: where the planes (27)-(29) meet the axis T = 0
ROUNDING = 1e-9  # relative: what a cohesion, friction times tension, may be off by


_SLIP_WORDS = {
    "exact": "Coulomb's circle",
    "paper": "the paper's octagon",
    "inner": "a polygon of {} sides within Coulomb's circle",
    "outer": "a polygon of {} sides around Coulomb's circle",
}
_POLYGON = "without dilatancy a polygon has an interval of load factors, on neither side of the circle's"
_SLIP_ASSUMED = {
    "exact": "Shear is limited by Coulomb's circle, which is exact.",
    "paper": "Shear is limited by the paper's octagon around Coulomb's circle: up to 8.2 % too strong; "
    f"{_POLYGON}.",
    "inner": f"Shear is limited by a polygon within Coulomb's circle, safe with associated flow; {_POLYGON}.",
    "outer": "Shear is limited by a polygon around Coulomb's circle, unsafe with associated flow; "
    f"{_POLYGON}.",
}


@dataclass(frozen=True, repr=False)
class OrdunaLourenco(Queries):
    """Yield surface of Orduña & Lourenço (2005): Eqs (23)-(30) and (36) or (39) on a convex polygon.

    Planes for twist (2), bending with torsion (8; four a side on other polygons than quadrilaterals) and
    hinging (one a side), and cones for slip (1) and shear with torsion (2): Coulomb's circle, where the paper
    puts an octagon. An engineering approximation:

    - the circle is exact for shear, with any flow. The paper's octagon, Eqs (24)-(26), is drawn around it:
      slip "paper", 38 planes on a quadrilateral, with associated flow up to 1/cos(22.5 deg) - 1 = 8.2 %
      too strong between its eight contact directions;
    - without dilatancy no polygon, inner ones included, is on a safe side: as a joint slides along the
      contact direction of a side, its shear force may be anywhere on that side, up to mu |N| tan(pi/sides)
      across the slip. The answer is then an interval of load factors: a wedge pushed along a groove of half
      angle w needs mu / sin w, and the octagon allows less and more;
    - Eqs (27)-(29) neglect the aspect ratio of the interface: against uniform pressure on a rectangle they
      overestimate torsion near pure shear (by 0.3 T0 at V0) and may underestimate it in between, by up to
      0.18 T0;
    - Eqs (23) and (30) overestimate torsion under bending except when a hinge forms, by up to 31 % of the
      effective rectangle's strength or 0.23 T0;
    - the rectangle of Eqs (31)-(32) that stands for another quadrilateral has 0.63 to 1.27 times its torsion,
      the most on slender ones that are nearly triangles; its sides are along and across the longest one, as
      :func:`limitblocks.find_interfaces` has the axes, however the axes of the interface lie;
    - on them Eq. (30) as printed cuts the corners of the hinging polygon, where Eq. (36) is exact: moments
      are divided by the largest |x1| + |x2| of a corner, which is l1 + l2 on a rectangle;
    - other polygons have planes through T0 and the states of Table 4, and so no axes: on regular ones of 5 to
      24 sides torsion under bending is from 0.13 T0 too weak to 0.12 T0 too strong, exact at a hinge;
    - shear and bending reduce torsion independently of each other;
    - with a compressive strength, Eq. (39) reduces the moment strength to zero at N = -A fcef; that is the
      exact stress block for bending about one axis of a rectangle. Elsewhere the moment is up to
      1 + sqrt(-N / (A fcef)) times that of the stress block, on any convex polygon: so much towards a corner
      of a triangle; along the diagonal of a rectangle 1.28 times at a tenth of A fcef, and up to 1.5 times at
      a half. Areas divided into convex pieces have the errors of each: none towards a side of one divided
      into rectangles. Torsion and shear are not reduced by crushing;
    - cohesion acts on the whole area whatever the eccentricity, which overestimates it once a joint opens.

    Parameters
    ----------
    friction : float
        Friction coefficient mu >= 0. With zero friction and cohesion the interface carries N, M1, M2 only.
    compressive_strength : float, optional
        Effective strength fcef, Pa (Eqs 41-42: :func:`limitblocks.joints.effective_strength`);
        infinite unless given.
    slip : {"exact", "paper", "inner", "outer"}
        The Coulomb circle of Eqs (24)-(29) itself (second-order cones), as the paper's octagon, or as a
        polygon within it or around it. In Eqs (27)-(29) the shear force is measured by the same circle or
        polygon. With associated flow "inner" is safe for shear, "outer" and "paper" are unsafe; without
        dilatancy only "exact" has one answer. Polygons keep `bounds` a linear program, and are slower.
    sides : int
        Sides of the inner or outer polygon, at least 3; with associated flow too weak by up to
        1 - cos(pi/sides), or too strong by up to 1/cos(pi/sides) - 1.
    cohesion, tensile_strength : float
        Pa; mu |N| becomes mu |N| + A cohesion in Eqs (23)-(30), and N becomes N - A tensile_strength in
        hinging. With friction the tensile strength counts up to cohesion / mu, where Coulomb's law ends: none
        without cohesion.

    Raises
    ------
    ModelError
        If a number is out of range or a word unknown.
    """

    friction: float
    compressive_strength: float | None = None
    slip: Literal["exact", "paper", "inner", "outer"] = "exact"
    sides: int = 8
    cohesion: float = 0.0
    tensile_strength: float = 0.0

    def __post_init__(self) -> None:
        checked_friction(self.friction)
        if self.compressive_strength is not None:
            checked_stress("compressive strength", self.compressive_strength, positive=True, unlimited=True)
        checked_choice("slip", self.slip, ("exact", "paper", "inner", "outer"))
        checked_count("sides", self.sides, 3)
        if self.slip in ("exact", "paper") and self.sides != 8:
            shape = "a circle" if self.slip == "exact" else "an octagon"
            raise ModelError(
                f"sides is {self.sides}, but slip={self.slip!r} is {shape}; choose slip='inner' or 'outer'"
            )
        checked_stress("cohesion", self.cohesion)
        checked_stress("tensile strength", self.tensile_strength)

    def in_words(self) -> str:
        """Return the joint in words."""
        strengths = strength_words(self.cohesion, self.tensile_strength, self.compressive_strength)
        shear = f"shear and torsion by {_SLIP_WORDS[self.slip].format(self.sides)}"
        return f"{friction_words(self.friction)}, {strengths}, {shear}"

    def assumed(self) -> tuple[str, ...]:
        """Return a sentence for each assumption."""
        crushing = (
            "Joints do not crush: a hinge is at the very edge of a contact area."
            if self.compressive_strength is None
            else CRUSHING
        )
        cohesion = "Cohesion acts on the whole area whatever the eccentricity, which overestimates it."
        tension = (
            f"Of the tensile strength {stress_words(self.counted_tension)} counts, cohesion over friction, "
            "where Coulomb's law ends."
        )
        return (
            "Joints slide, twist and hinge by the yield surface of Orduña & Lourenço (2005), Part I, "
            "Eqs (23)-(30) and (36) or (39).",
            _SLIP_ASSUMED[self.slip],
            "Near pure shear torsion is overestimated by up to 0.3 of the torsional strength under uniform "
            "pressure on a rectangle; in between it may be underestimated by up to 0.18 of it, "
            "Eqs (27)-(29).",
            "Under bending torsion is overestimated, except where a hinge forms, by up to 31 % of the "
            "strength of the effective rectangle, Eqs (23) and (30).",
            "Shear and bending reduce torsion independently of each other.",
            crushing,
            *((cohesion,) if self.cohesion else ()),
            *((tension,) if self.counted_tension < self.tensile_strength else ()),
        )

    @property
    def counted_tension(self) -> float:
        """Tensile strength that counts, Pa: beyond cohesion / mu no hinge would open, as Eq. (30) twists."""
        less = self.friction * self.tensile_strength > self.cohesion * (1.0 + ROUNDING)
        return self.cohesion / self.friction if less else self.tensile_strength

    def yield_rows(self, polygons: Array, stress_unit: float = 1.0) -> YieldRows:
        """Return the rows for polygons of shape (m, n, 2); see :class:`~limitblocks.joints.base.Joint`."""
        groups = [hinging(polygons, self.compressive_strength, self.counted_tension, stress_unit)]
        shear = self.friction > 0.0 or self.cohesion > 0.0
        if shear:
            groups = self._frictional_rows(polygons, stress_unit) + groups
        return stacked(groups, np.abs(polygons).max(axis=1), self.friction, shear)

    def _frictional_rows(self, polygons: Array, stress_unit: float) -> list[Rows]:
        """Eqs (23)-(30) with the flow of Tables 3 and 5."""
        cohesion = self.cohesion / stress_unit * areas(polygons)

        def rows(
            mode: str, table: Array, share: Any, moment: Any = 0.0, torsion: Any = 0.0, size: int = 0
        ) -> Rows:
            factors = np.broadcast_arrays(1.0, 1.0, share * self.friction, moment, moment, torsion, cohesion)
            scale = np.stack(factors, axis=-1)[:, None, :]
            g = share * table[:, 2] * scale[..., 6]
            return frictional(mode, -table * scale[..., :6], g, size)

        if polygons.shape[1] == 4:
            turn = _along_a_side(polygons)
            turned = polygons @ turn.mT
            half_sides = equivalent_half_sides(turned)
            constants = rectangle_torsion_constant(half_sides[:, 0], half_sides[:, 1])  # Eq. (17)
            # off rectangles corners lie outside |x1| + |x2| = l1 + l2, where Eq. (30) would forbid hinging
            per_corner = 1.0 / np.abs(turned).sum(axis=2).max(axis=1)
            factors = self.friction / 2 * per_corner, 1.0 / half_sides.sum(axis=1)
            bending = rows("moment-twist", MOMENT_TWIST, 0.5, *factors)
            bending.F[..., 3:5] = bending.F[..., 3:5] @ turn
        else:
            constants = torsion_constants(polygons)
            table = key_state_rows(polygons) * (0.0, 0.0, *[self.friction] * 3, 1.0)
            bending = frictional("moment-twist", -table, cohesion[:, None])
        per_torsion = 1.0 / constants
        slip, slip_twist, size = _circle_tables(self.slip, self.sides)
        return [
            rows("twist", TWIST, 1.0, torsion=per_torsion),
            rows("slip", slip, 1.0, size=size),
            rows("slip-twist", slip_twist, SLIP_FORCE, torsion=per_torsion, size=size),
            bending,
        ]


def _circle_tables(slip: str, sides: int) -> tuple[Array, Array, int]:
    """Signs of the slip and the slip-twist rows, and the size of the cones they are (0: planes)."""
    if slip == "exact":  # cones (-mu N - T / c_T, V1, V2); yield rows are minus these tables
        V = [(-1, 0, 0, 0, 0, 0), (0, -1, 0, 0, 0, 0)]
        twisted = [row for t in SIGNS for row in ((0, 0, 1, 0, 0, t), *V)]
        return np.array([(0, 0, 1, 0, 0, 0), *V], dtype=float), np.array(twisted, dtype=float), 3
    d = shear_directions(slip, sides)
    planes = [(d1, d2, 1, 0, 0, 0) for d1, d2 in d]  # Eqs (24)-(26)
    twisted = [(d1, d2, 1, 0, 0, t) for (d1, d2), t in product(d, SIGNS)]  # Eqs (27)-(29)
    return np.array(planes), np.array(twisted), 0


def _along_a_side(polygons: Array) -> Array:
    """Turns (m, 2, 2) from the axes of polygons (m, n, 2) to those along their longest sides."""
    _, turn = along_longest_side(polygons, np.broadcast_to(np.eye(2, 3), (len(polygons), 2, 3)))
    return np.where(np.abs(turn[:, :1, 1:]) <= TIE, np.eye(2), turn)  # to the last bit where they are these


def equivalent_half_sides(polygons: Array) -> Array:
    """Half sides (m, 2) of the rectangle that stands for each quadrilateral (m, 4, 2).

    Eqs (31)-(32), for the first vertex that makes them largest: it gives the order (+,-), (+,+), (-,+), (-,-)
    that they presuppose.
    """
    turns = np.stack([np.roll(polygons, -k, axis=1) for k in range(4)])
    x1, x2 = turns[..., 0], turns[..., 1]
    l1 = (x1[..., 0] + x1[..., 1] - x1[..., 2] - x1[..., 3]) / 4
    l2 = (x2[..., 1] + x2[..., 2] - x2[..., 0] - x2[..., 3]) / 4
    first = np.minimum(l1, l2).argmax(axis=0)
    return np.asarray(np.stack([l1, l2], axis=-1)[first, np.arange(len(polygons))])

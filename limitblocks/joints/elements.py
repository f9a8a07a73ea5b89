"""Ties, dowels and guides between two blocks: interfaces that flow as they yield, without friction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from limitblocks.arrays import Array, real
from limitblocks.errors import ModelError, refuse_kind
from limitblocks.geometry.polygon import areas
from limitblocks.joints.base import YieldRows, checked_stress, stress_words
from limitblocks.problem import Mode


@dataclass(frozen=True)
class Tie:
    """A tie along the normal of its interface: tension from 0 to strength x area, no compression.

    Rigid-plastic: it elongates at its strength, and goes slack where its ends approach; the flow is
    associated. It acts along one line: where on the line its interface lies makes no difference.

    Parameters
    ----------
    strength : float
        Tension per area of the interface at which it yields, is pulled out or debonds, Pa, > 0.
    length : float
        Distance between its anchors, m; for pictures only.
    prestress : float
        Part of the tension, Pa, that is a dead load already (:func:`limitblocks.practice.reinforced`): the
        interface carries what is left, and N is the tension beyond the prestress.

    Raises
    ------
    ModelError
        If the strength is not finite and positive, the length negative, or the prestress not from 0 to less
        than the strength.
    """

    strength: float
    length: float = 0.0
    prestress: float = 0.0
    friction = 0.0

    def __post_init__(self) -> None:
        checked_stress("strength of a tie", self.strength, positive=True)
        if not 0.0 <= real(self.length) < np.inf:
            raise ModelError(f"length of a tie is {self.length!r} m, expected a finite length >= 0")
        if not 0.0 <= real(self.prestress) < self.strength:
            most = f"expected 0 to less than its strength, {self.strength:g} Pa"
            raise ModelError(f"prestress of a tie is {self.prestress!r} Pa, {most}")

    @property
    def word(self) -> str:
        """What it is called: a strip is a tie across a joint, without length."""
        return "tie" if self.length else "strip"

    def in_words(self) -> str:
        """Return the joint in words."""
        long = f", {self.length:.4g} m from anchor to anchor" if self.length else ""
        tight = f", prestress {stress_words(self.prestress)}" if self.prestress else ""
        most = f"tension up to {stress_words(self.strength)} on its section"
        return f"{self.word}, {most}, no compression{tight}{long}"

    def assumed(self) -> tuple[str, ...]:
        """Return a sentence for each assumption."""
        what = f"{self.word.capitalize()}s"
        return (
            f"{what} are rigid until they yield, yield without end at one force, and go slack as their ends "
            "approach.",
            f"{what} act along one line and do not bend around blocks; their anchors or bond hold the force "
            "at which they yield.",
        )

    def yield_rows(self, polygons: Array, stress_unit: float = 1.0) -> YieldRows:
        """Return 0 <= N <= (strength - prestress) x area; see :class:`~limitblocks.joints.base.Joint`."""
        most = areas(polygons) * (self.strength - self.prestress) / stress_unit
        g = np.stack([np.zeros_like(most), most], axis=1)
        return _rows(polygons, np.array([[1.0], [-1.0]]), g, [2], (Mode.SLACK, Mode.YIELD))


@dataclass(frozen=True)
class Backfill(Tie):
    """Passive resistance of fill to a block that moves into it: held from behind, up to strength x area.

    A tie without length or prestress whose `strength`, Pa, is the passive pressure; the area of its interface
    is the projection of the faces that press the fill.
    """

    @property
    def word(self) -> str:
        """What it is called."""
        return "fill"

    def in_words(self) -> str:
        """Return the joint in words."""
        return f"passive resistance of fill, up to {stress_words(self.strength)}"

    def assumed(self) -> tuple[str, ...]:
        """Return a sentence for each assumption."""
        return (
            "Fill resists blocks that move into it with its whole passive pressure at once, along the deck "
            "and without friction, and follows none that moves away.",
        )


@dataclass(frozen=True)
class Dowel:
    """A dowel or stitch across an interface: shear ||(V1, V2)|| <= strength x area, associated flow.

    Parameters
    ----------
    strength : float
        Shear per area of its interface at which it yields or tears out, Pa, > 0.

    Raises
    ------
    ModelError
        If the strength is not finite and positive.
    """

    strength: float
    word = "dowel"
    friction = 0.0

    def __post_init__(self) -> None:
        checked_stress("strength of a dowel", self.strength, positive=True)

    def in_words(self) -> str:
        """Return the joint in words."""
        return f"dowel, shear up to {stress_words(self.strength)} on its section"

    def assumed(self) -> tuple[str, ...]:
        """Return a sentence for each assumption."""
        return (
            "Dowels carry shear, the same in all directions, and neither tension nor compression; they yield "
            "without end.",
        )

    def yield_rows(self, polygons: Array, stress_unit: float = 1.0) -> YieldRows:
        """Return the cone of V1, V2; see :class:`~limitblocks.joints.base.Joint`."""
        g = np.zeros((len(polygons), 3))
        g[:, 0] = areas(polygons) * self.strength / stress_unit
        return _rows(polygons, np.eye(3)[:, 1:], g, [0, 1], (Mode.YIELD,) * 3, cones=(3,))


@dataclass(frozen=True)
class Guide:
    """A bilateral guide that lets block j move along s1 of its interface, or not at all, and nothing else.

    It carries V2, N, M1, M2 and T of either sign, and V1 where it does not slide: each force up to
    strength x area, each moment up to that times the root of the area. Where a solution uses its strength
    nowhere, it is one of a rigid guide: the rows are slack.

    Parameters
    ----------
    strength : float
        Force per area, Pa, > 0; far above what acts.
    slides : bool
        Whether block j can move along s1; else both blocks are one body.

    Raises
    ------
    ModelError
        If the strength is not finite and positive, or `slides` neither true nor false.
    """

    strength: float
    slides: bool = True
    word = "guide"
    friction = 0.0

    def __post_init__(self) -> None:
        checked_stress("strength of a guide", self.strength, positive=True)
        refuse_kind(self.slides, bool, "slides of a guide")

    def in_words(self) -> str:
        """Return the joint in words."""
        return f"guide, {'free to slide along one direction and rigid otherwise' if self.slides else 'rigid'}"

    def assumed(self) -> tuple[str, ...]:
        """Return a sentence for each assumption."""
        if not self.slides:
            return ("Rigid guides hold two blocks together as one body.",)
        return ("Guides hold a block against all motion but one translation, without friction.",)

    def yield_rows(self, polygons: Array, stress_unit: float = 1.0) -> YieldRows:
        """Return two rows for each resultant it carries; see :class:`~limitblocks.joints.base.Joint`."""
        area, carried = areas(polygons), [0, 1, 2, 3, 4, 5][self.slides :]
        most = (area * self.strength / stress_unit)[:, None] * np.ones(len(carried))
        most[:, -3:] *= np.sqrt(area)[:, None]
        each = np.eye(len(carried))
        F, g = np.concatenate([each, -each]), np.concatenate([most, most], axis=1)
        return _rows(polygons, F, g, carried, (Mode.YIELD,) * len(F))


def _rows(
    polygons: Array,
    F: Array,
    g: Array,
    carried: list[int],
    modes: tuple[Mode, ...],
    cones: tuple[int, ...] = (),
) -> YieldRows:
    """Rows F (r, s) and g (m, r) on the resultants that are `carried`, with the associated flow."""
    (m, r), resultants = g.shape, np.eye(6)[:, carried]
    rows = np.broadcast_to(F, (m, *F.shape))
    return YieldRows(
        F=rows,
        g=g,
        G=rows,
        pivot=np.zeros((m, r)),
        half_sides=np.abs(polygons).max(axis=1),
        resultants=np.broadcast_to(resultants, (m, *resultants.shape)),
        linear=r - sum(cones),
        cones=cones,
        modes=modes,
        friction=0.0,
    )

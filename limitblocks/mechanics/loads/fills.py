"""Weight and thrust of fill on what lies below it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.geometry import Block
from limitblocks.geometry.neighbours import bounds_of
from limitblocks.mechanics.loads.exposed import open_to_the_sky
from limitblocks.mechanics.loads.faces import integrals, part_where
from limitblocks.mechanics.loads.load import (
    Load,
    Place,
    Vector,
    along,
    horizontal,
    keep,
    names_of,
    number,
    of,
    place,
    position,
    some,
    unit_vector,
)
from limitblocks.shown import coordinate, coordinates

UP = np.array([0.0, 0.0, 1.0])
_NONE = 1e-12  # of a block's size cubed: less fill is what rounding leaves between shadows that meet


@dataclass(frozen=True)
class Fill:
    """Weight of fill of `unit_weight` (N/m3) up to `level` (m) on top of `blocks`; all free ones if empty.

    Where these are given, only `beyond` a place (x, y) in plan, m, `towards` a horizontal direction.
    """

    unit_weight: float
    level: float
    blocks: tuple[str, ...] = ()
    coefficient: float = 0.0
    beyond: Place | None = None
    towards: Vector | None = None

    def __post_init__(self) -> None:
        keep(
            self,
            unit_weight=number(self.unit_weight, "fill: unit weight", "N/m3", above=0.0),
            level=number(self.level, "fill: level", "m"),
            coefficient=number(self.coefficient, "fill: earth pressure", "1", least=0.0),
        )
        if (self.beyond is None) != (self.towards is None):
            raise ModelError("fill: beyond a place and towards a direction are given together, or neither")
        if self.towards is not None:
            horizontal(self.towards, "fill: towards")

    def on(self, blocks: Sequence[Block]) -> Array:
        """Return forces and moments at the centroids, shape (n, 6)."""
        load, lowest = np.zeros((len(blocks), 6)), np.inf
        for k, face, weight, first in self.on_faces(blocks):
            normal = blocks[k].normals[face]
            # vertical stress p and horizontal stress K p act on the face; its area is the plan's over n_z
            traction = np.array([*(self.coefficient * normal[:2] / normal[2]), 1.0])
            load[k] -= np.concatenate([weight * traction, np.cross(first, traction)])
            lowest = min(lowest, float(blocks[k].vertices[list(blocks[k].faces[face]), 2].min()))
        if not load.any():
            raise ModelError(
                f"fill: level {self.level:g} m leaves no fill on any block: all faces lie above it (the "
                f"lowest at {lowest:g} m) or below other blocks{self._side and f', or not {self._side}'}"
            )
        return load

    def in_words(self) -> str:
        """Return the term in words."""
        said = f"fill of {self.unit_weight / 1e3:.4g} kN/m³ up to Z = {coordinate(self.level)} m"
        said += f" on {some(self.blocks) if self.blocks else 'all blocks'}"
        said += self._side and f", {self._side}"
        if not self.coefficient:
            return said
        return (
            f"{said}, coefficient of horizontal earth pressure {self.coefficient:.4g} on faces that slope, "
            "none on upright ones"
        )

    @property
    def _side(self) -> str:
        """Where the fill ends sideways, in words."""
        if self.beyond is None or self.towards is None:
            return ""
        return f"beyond {coordinates(self.beyond)} m in plan {along(self.towards)}"

    def on_faces(self, blocks: Sequence[Block]) -> Iterator[tuple[int, int, float, Array]]:
        """Yield block, upward face, weight on it (N), and its first moments about the centroid (N m)."""
        named = [position(name, blocks) for name in dict.fromkeys(self.blocks)]
        bounds = bounds_of([block.vertices for block in blocks])
        for k in named or range(len(blocks)):
            block = blocks[k]
            for face in np.flatnonzero(block.normals[:, 2] > 1e-6).tolist():
                corners = block.vertices[list(block.faces[face])]
                under, _ = part_where(corners, self.level - corners[:, 2])
                if self.beyond is not None and self.towards is not None and len(under):
                    under, _ = part_where(under, (under[:, :2] - np.array(self.beyond)) @ self.towards[:2])
                weight, first = 0.0, np.zeros(3)
                for ring in open_to_the_sky(under, block, face, self.level, blocks, bounds):
                    stress = self.unit_weight * (self.level - ring[:, 2])
                    p, px = integrals(ring - block.centroid, stress, UP)
                    weight, first = weight + p, first + px
                some_fill = weight > _NONE * self.unit_weight * block.size**3
                yield k, face, weight * some_fill, first * some_fill


def fill(
    unit_weight: float,
    level: float,
    *,
    blocks: str | Sequence[str] = (),
    earth_pressure: float = 0.0,
    beyond: Sequence[float] | None = None,
    towards: Sequence[float] | None = None,
) -> Load:
    """Return the weight of fill up to a level on the blocks below it, such as over the extrados of an arch.

    On each face that looks upwards rests the fill right above it, up to the level. Assumed: the weight goes
    straight down and does not spread; the fill has no strength and takes no load; its mass does not count in
    mass-proportional loads. The parts of a face above the level, or with a free block between it and
    the level, get none; supports cover nothing. With an earth pressure coefficient K, the horizontal stress K
    times the vertical stress acts on the same faces, on their projections on vertical planes; a vertical face
    gets none, use :func:`pressure` for it. Fill that only lies behind a wall ends at a vertical plane, that
    `beyond` a place and square to the direction `towards` the fill: faces, or parts of them, on the other
    side get none. Resultants and moments are exact integrals.

    Parameters
    ----------
    unit_weight : float
        N/m3.
    level : float
        Height Z of its horizontal surface, m.
    blocks : str or sequence of str
        Blocks that it rests on; all free blocks unless given.
    earth_pressure : float
        Coefficient K of horizontal earth pressure, >= 0.
    beyond : sequence of float
        Place (x, y) in plan, m, on the plane where the fill ends, such as of the crest of a retaining wall.
    towards : sequence of float
        Horizontal direction from there to the fill; given together.

    Raises
    ------
    ModelError
        If a number is out of range. Where the load meets its blocks (as a Model is made): if a block is not
        free, or no block gets any fill.
    """
    side = (
        None if beyond is None else place(beyond, "fill: beyond"),
        None if towards is None else unit_vector(towards, "fill: towards"),
    )
    return of(Fill(unit_weight, level, names_of(blocks), earth_pressure, *side))

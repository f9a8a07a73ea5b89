"""Loads on faces: pressure, and fill on top."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from limitblocks.arrays import Array, Indices
from limitblocks.errors import ModelError, sequence_of
from limitblocks.geometry import Block
from limitblocks.geometry.neighbours import bounds_of
from limitblocks.mechanics.loads.exposed import open_to_the_sky
from limitblocks.mechanics.loads.faces import faces_through, faces_towards, integrals, part_where
from limitblocks.mechanics.loads.load import (
    Load,
    Vector,
    number,
    of,
    position,
    some,
    triple,
    unit_vector,
    vector,
)
from limitblocks.shown import coordinate, coordinates

UP = np.array([0.0, 0.0, 1.0])
_NONE = 1e-12  # of a block's size cubed: less fill is what rounding leaves between shadows that meet


@dataclass(frozen=True)
class Pressure:
    """Pressure on one face of each block of `blocks`: `pressure` + `unit_weight` times depth below `level`.

    The face is the one `facing` a direction, or the one with the point `at` on it.
    """

    blocks: tuple[str, ...]
    pressure: float = 0.0
    unit_weight: float = 0.0
    level: float = 0.0
    facing: Vector | None = None
    at: Vector | None = None

    def __post_init__(self) -> None:
        _keep(
            self,
            pressure=number(self.pressure, "pressure", "Pa"),
            unit_weight=number(self.unit_weight, "pressure: unit weight", "N/m3", least=0.0),
            level=number(self.level, "pressure: level", "m"),
        )
        if not self.blocks:
            raise ModelError("pressure names no block, expected at least one")
        if len(set(self.blocks)) < len(self.blocks):
            raise ModelError(f"pressure names a block twice in {self.blocks}, expected each once")
        if (self.facing is None) == (self.at is None):
            raise ModelError("pressure: give either the direction that the face looks to or a point on it")
        if self.at is not None and len(self.blocks) > 1:
            raise ModelError(
                f"pressure: one point is given for {len(self.blocks)} blocks, expected a direction"
            )
        if self.pressure == 0.0 and self.unit_weight == 0.0:
            raise ModelError("pressure is zero, expected a pressure in Pa or a unit weight in N/m3")

    def on(self, blocks: Sequence[Block]) -> Array:
        """Return forces and moments at the centroids, shape (n, 6)."""
        load, lowest = np.zeros((len(blocks), 6)), np.inf
        for k in (position(name, blocks) for name in self.blocks):
            block = blocks[k]
            for face in self._faces(block).tolist():
                normal, about = block.normals[face], block.centroid
                corners = block.vertices[list(block.faces[face])]
                total, first = integrals(corners - about, np.full(len(corners), self.pressure), normal)
                wet, depth = part_where(corners, self.level - corners[:, 2])
                more, further = integrals(wet - about, self.unit_weight * depth, normal)
                load[k, :3] -= (total + more) * normal
                load[k, 3:] -= np.cross(first + further, normal)
                lowest = min(lowest, float(corners[:, 2].min()))
        if self.unit_weight > 0.0 and self.level <= lowest:
            raise ModelError(
                f"pressure: level {self.level:g} m is below every face; the lowest is at {lowest:g} m"
            )
        return load

    def in_words(self) -> str:
        """Return the term in words."""
        where = f"at {coordinates(self.at)} m" if self.at else f"facing {triple(self.facing or ())}"
        linear = f"{self.unit_weight / 1e3:.4g} kN/m³ times the depth below Z = {coordinate(self.level)} m"
        parts = [f"{self.pressure / 1e3:.4g} kPa"] * bool(self.pressure) + [linear] * bool(self.unit_weight)
        return f"a pressure of {' plus '.join(parts)} on the face {where} of {some(self.blocks)}"

    def _faces(self, block: Block) -> Indices:
        if self.at is not None:
            return faces_through(block, self.at)
        return faces_towards(block, unit_vector(self.facing or (), "pressure: facing"))


@dataclass(frozen=True)
class Fill:
    """Weight of fill of `unit_weight` (N/m3) up to `level` (m) on top of `blocks`; all free ones if empty."""

    unit_weight: float
    level: float
    blocks: tuple[str, ...] = ()
    coefficient: float = 0.0

    def __post_init__(self) -> None:
        _keep(
            self,
            unit_weight=number(self.unit_weight, "fill: unit weight", "N/m3", above=0.0),
            level=number(self.level, "fill: level", "m"),
            coefficient=number(self.coefficient, "fill: earth pressure", "1", least=0.0),
        )

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
                f"lowest at {lowest:g} m) or below other blocks"
            )
        return load

    def in_words(self) -> str:
        """Return the term in words."""
        said = f"fill of {self.unit_weight / 1e3:.4g} kN/m³ up to Z = {coordinate(self.level)} m"
        said += f" on {some(self.blocks) if self.blocks else 'all blocks'}"
        if not self.coefficient:
            return said
        return (
            f"{said}, coefficient of horizontal earth pressure {self.coefficient:.4g} on faces that slope, "
            "none on upright ones"
        )

    def on_faces(self, blocks: Sequence[Block]) -> Iterator[tuple[int, int, float, Array]]:
        """Yield block, upward face, weight on it (N), and its first moments about the centroid (N m)."""
        named = [position(name, blocks) for name in dict.fromkeys(self.blocks)]
        bounds = bounds_of([block.vertices for block in blocks])
        for k in named or range(len(blocks)):
            block = blocks[k]
            for face in np.flatnonzero(block.normals[:, 2] > 1e-6).tolist():
                corners = block.vertices[list(block.faces[face])]
                under, _ = part_where(corners, self.level - corners[:, 2])
                weight, first = 0.0, np.zeros(3)
                for ring in open_to_the_sky(under, block, face, self.level, blocks, bounds):
                    stress = self.unit_weight * (self.level - ring[:, 2])
                    p, px = integrals(ring - block.centroid, stress, UP)
                    weight, first = weight + p, first + px
                some_fill = weight > _NONE * self.unit_weight * block.size**3
                yield k, face, weight * some_fill, first * some_fill


def pressure(
    blocks: str | Sequence[str],
    pressure: float = 0.0,
    *,
    facing: Sequence[float] | None = None,
    at: Sequence[float] | None = None,
    unit_weight: float = 0.0,
    level: float | None = None,
) -> Load:
    """Return a pressure on a whole face of one or more blocks, normal to the face and into the block.

    Several faces of a block in one plane, such as those around a hole, are one.
    It is ``pressure + unit_weight * max(level - z, 0)``; resultant and moment are exact. Whether something
    else covers the face does not matter. A pressure that grows upwards is a difference of two loads.

    Parameters
    ----------
    blocks : str or sequence of str
        Names of the blocks.
    pressure : float
        Uniform part, Pa; negative pulls.
    facing : sequence of float
        The face is the one whose outward normal is closest to this direction, within 45 degrees.
    at : sequence of float
        Or: the face is the one on which this point lies, m; for a single block.
    unit_weight : float
        Of a liquid or another linear pressure, N/m3.
    level : float
        Height Z of its surface, m; needed with a unit weight.

    Raises
    ------
    ModelError
        If a number is out of range or missing. Where the load meets its blocks (as a Model is made): if a
        block is not free, no face or more than one is meant, or every face lies above the level.
    """
    if unit_weight and level is None:
        raise ModelError(
            "pressure: a unit weight is given without a level, expected the Z of its surface in m"
        )
    if level is not None and not unit_weight:
        raise ModelError(
            f"pressure: a level, {level!r} m, is given without a unit weight, expected one in N/m3"
        )
    return of(
        Pressure(
            _names(blocks),
            pressure,
            unit_weight,
            0.0 if level is None else level,
            None if facing is None else unit_vector(facing, "pressure: facing"),
            None if at is None else vector(at, "pressure: at"),
        )
    )


def fill(
    unit_weight: float, level: float, *, blocks: str | Sequence[str] = (), earth_pressure: float = 0.0
) -> Load:
    """Return the weight of fill up to a level on the blocks below it, such as over the extrados of an arch.

    On each face that looks upwards rests the fill right above it, up to the level. Assumed: the weight goes
    straight down and does not spread; the fill has no strength and takes no load; its mass does not count in
    mass-proportional loads. The parts of a face above the level, or with a free block between it and
    the level, get none; supports cover nothing. With an earth pressure coefficient K, the horizontal stress K
    times the vertical stress acts on the same faces, on their projections on vertical planes; a vertical face
    gets none, use :func:`pressure` for it. Resultants and moments are exact integrals.

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

    Raises
    ------
    ModelError
        If a number is out of range. Where the load meets its blocks (as a Model is made): if a block is not
        free, or no block gets any fill.
    """
    return of(Fill(unit_weight, level, _names(blocks), earth_pressure))


def _names(blocks: str | Sequence[str]) -> tuple[str, ...]:
    return (blocks,) if isinstance(blocks, str) else sequence_of("blocks", blocks, str)


def _keep(term: object, **values: float) -> None:
    """Keep numbers as floats in a frozen term, as the model file gives them back."""
    for name, value in values.items():
        object.__setattr__(term, name, value)

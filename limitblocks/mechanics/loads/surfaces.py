"""Pressure on faces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from limitblocks.arrays import Array, Indices
from limitblocks.errors import ModelError
from limitblocks.geometry import Block
from limitblocks.mechanics.loads.faces import faces_through, faces_towards, integrals, part_where
from limitblocks.mechanics.loads.load import (
    Load,
    Vector,
    keep,
    names_of,
    number,
    of,
    position,
    some,
    triple,
    unit_vector,
    vector,
)
from limitblocks.shown import coordinate, coordinates


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
        keep(
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

    Faces that share edges and lie within 3 degrees of one plane, such as those around a hole, are one.
    It is ``pressure + unit_weight * max(level - z, 0)``; resultant and moment are exact. Whether something
    else covers the face does not matter. A pressure that grows upwards is a difference of two loads.

    Parameters
    ----------
    blocks : str or sequence of str
        Names of the blocks.
    pressure : float
        Uniform part, Pa; negative pulls.
    facing : sequence of float
        The face is the one whose outward normal is closest to this direction, within 45 degrees; it has at
        least 2/3 of what looks so.
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
            names_of(blocks),
            pressure,
            unit_weight,
            0.0 if level is None else level,
            None if facing is None else unit_vector(facing, "pressure: facing"),
            None if at is None else vector(at, "pressure: at"),
        )
    )

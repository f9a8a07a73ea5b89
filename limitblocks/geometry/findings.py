"""What contact detection may see beside the interfaces."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class NearMiss:
    """Faces of two blocks that would touch if they were a little closer or more parallel.

    Attributes
    ----------
    block_i, block_j : str
    gap : float
        Largest distance between the two planes over the area, m; negative where they interpenetrate.
    angle : float
        Angle between the two planes, rad.
    area : float
        Area common to both faces, m2.
    """

    block_i: str
    block_j: str
    gap: float
    angle: float
    area: float

    def __str__(self) -> str:
        return (
            f"{self.block_i}|{self.block_j} (gap {self.gap:.3g} m, {self.angle:.3g} rad, {self.area:.3g} m2)"
        )


@dataclass(frozen=True)
class Overlap:
    """Two blocks that interpenetrate deeper than tolerated.

    Attributes
    ----------
    block_i, block_j : str
    depth : float
        Of two convex blocks the least translation that separates them. Otherwise the mean thickness of the
        common part, twice its volume over its surface; of several parts the largest, m.
    volume : float
        Common volume, m3.
    tolerance : float
        Depth that would be tolerated, m.
    share : float
        Common volume over that of the smaller block.
    """

    block_i: str
    block_j: str
    depth: float
    volume: float
    tolerance: float
    share: float = float("nan")

    def __str__(self) -> str:
        return (
            f"blocks {self.block_i!r} and {self.block_j!r} overlap by {self.volume:.3g} m3, "
            f"{self.depth:.3g} m deep; at most {self.tolerance:.3g} m is tolerated"
        )


@dataclass(frozen=True)
class Sliver:
    """Contact that was dropped because it is too small, or as a strip because it is too narrow.

    Attributes
    ----------
    block_i, block_j : str
    area : float
        m2.
    width : float
        Mean width, the area over half the perimeter, m.
    """

    block_i: str
    block_j: str
    area: float
    width: float

    def __str__(self) -> str:
        return f"{self.block_i}|{self.block_j} ({self.area:.3g} m2, {self.width:.3g} m wide)"


@dataclass(frozen=True)
class Through:
    """Faces of two blocks within the tolerances that do not touch, because a third block lies between them.

    Attributes
    ----------
    block_i, block_j : str
    between : str
        Block that holds them apart.
    gap : float
        Largest distance between the two faces, m.
    """

    block_i: str
    block_j: str
    between: str
    gap: float

    def __str__(self) -> str:
        return f"{self.block_i}|{self.block_j} (through {self.between}, gap {self.gap:.3g} m)"

"""What contact detection found: interfaces, and what is worth a look beside them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from limitblocks.geometry.interface import Interface

_SHOWN = 8


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
        Common volume, m3; nan when it cannot be told.
    tolerance : float
        Depth that would be tolerated, m.
    """

    block_i: str
    block_j: str
    depth: float
    volume: float
    tolerance: float

    def __str__(self) -> str:
        return (
            f"blocks {self.block_i!r} and {self.block_j!r} overlap by {self.volume:.3g} m3, "
            f"{self.depth:.3g} m deep; at most {self.tolerance:.3g} m is tolerated"
        )


@dataclass(frozen=True)
class Sliver:
    """Contact that was dropped because it is too small.

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
class Contacts:
    """Interfaces between blocks, and what contact detection saw beside them.

    Attributes
    ----------
    interfaces : tuple of Interface
    near_misses : tuple of NearMiss
        Faces beyond the tolerances, up to ten times; of blocks that do not overlap.
    overlaps : tuple of Overlap
    isolated : tuple of str
        Blocks without any interface.
    slivers : tuple of Sliver
    """

    interfaces: tuple[Interface, ...]
    near_misses: tuple[NearMiss, ...]
    overlaps: tuple[Overlap, ...]
    isolated: tuple[str, ...]
    slivers: tuple[Sliver, ...]

    @property
    def warnings(self) -> list[str]:
        """A line for each kind of thing found beside the interfaces, and for each overlap."""
        lines = [str(overlap) for overlap in self.overlaps[:_SHOWN]]
        if len(self.overlaps) > _SHOWN:
            lines.append(f"and {len(self.overlaps) - _SHOWN} more overlaps")
        lines += self._line("no interface between blocks that nearly touch", self.near_misses)
        lines += self._line("blocks without any interface", self.isolated)
        return lines + self._line("contacts left out because they are too small", self.slivers)

    @staticmethod
    def _line(words: str, things: Sequence[object]) -> list[str]:
        """Return one line that names the first of what was found; none when nothing was."""
        more = f" and {len(things) - _SHOWN} more" if len(things) > _SHOWN else ""
        return [f"{words}: {', '.join(map(str, things[:_SHOWN]))}{more}"] if things else []

    def to_dict(self) -> dict[str, Any]:
        """Return all as plain numbers, lists and text, the interfaces without their joint; SI units."""
        beside = {
            name: [asdict(one) for one in getattr(self, name)]
            for name in ("near_misses", "overlaps", "slivers")
        }
        interfaces = [
            {
                "block_i": one.block_i,
                "block_j": one.block_j,
                "centroid": one.centroid.tolist(),
                "axes": one.axes.tolist(),
                "polygon": one.polygon.tolist(),
            }
            for one in self.interfaces
        ]
        return {"interfaces": interfaces, "isolated": list(self.isolated)} | beside

    def __str__(self) -> str:
        counts = (
            (self.interfaces, "interfaces"),
            (self.near_misses, "near misses"),
            (self.overlaps, "overlaps"),
            (self.isolated, "isolated blocks"),
            (self.slivers, "slivers"),
        )
        return ", ".join(f"{len(things)} {words}" for things, words in counts)

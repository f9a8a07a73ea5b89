"""What contact detection found: interfaces, and what is worth a look beside them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from limitblocks.errors import GeometryError
from limitblocks.geometry.accuracy import Tolerances, millimetres, too_coarse
from limitblocks.geometry.interface import Interface
from limitblocks.shown import Shown

_SHOWN = 8
_DEFAULT = Tolerances()
#: Accuracy, in block lengths, that is roundoff.
_EXACT = 1e-7


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


@dataclass(frozen=True, repr=False)
class Contacts(Shown):
    """Interfaces between blocks, and what contact detection saw beside them.

    Attributes
    ----------
    interfaces : tuple of Interface
    near_misses : tuple of NearMiss
        Faces a little beyond the tolerances; of blocks that do not overlap.
    overlaps : tuple of Overlap
    isolated : tuple of str
        Blocks without any interface.
    slivers : tuple of Sliver
        Contacts of too small an area.
    strips : tuple of Sliver
        Contacts no wider than the least width.
    through : tuple of Through
    tolerances : Tolerances
        Those that were used.
    length : float
        Block length, m; 0 of fewer than two blocks.
    facets : int
        Pairs of faces through which two blocks touch, the median over the blocks that do.
    chosen : bool
        Whether the gap was chosen by the accuracy, not given.
    """

    interfaces: tuple[Interface, ...]
    near_misses: tuple[NearMiss, ...]
    overlaps: tuple[Overlap, ...]
    isolated: tuple[str, ...]
    slivers: tuple[Sliver, ...]
    strips: tuple[Sliver, ...] = ()
    through: tuple[Through, ...] = ()
    tolerances: Tolerances = _DEFAULT
    length: float = 0.0
    facets: int = 0
    chosen: bool = True

    @property
    def faults(self) -> tuple[str, ...]:
        """A sentence for each thing that makes the interfaces no answer, with its remedy."""
        overlaps = (f"{overlap}{self._remedy(overlap)}" for overlap in self.overlaps)
        return (*overlaps, *([self._coarse] if self._coarse and self.chosen else []))

    def require(self) -> None:
        """Raise GeometryError with all `faults`; do nothing where there is none."""
        if self.faults:
            raise GeometryError(*self.faults)

    def _remedy(self, overlap: Overlap) -> str:
        if overlap.tolerance < self.tolerances.gap * self.length:
            return ", half the thickness of the thinner one; draw them apart, or as one"
        if overlap.depth > 0.05 * self.length:
            return "; draw them apart"
        return f"; draw them apart, or give gap={1.1 * overlap.depth / self.length:.2g} (block lengths)"

    @property
    def _coarse(self) -> str:
        return too_coarse(self.tolerances.accuracy, self.length, self.facets)

    @property
    def accuracy(self) -> str:
        """A sentence on how accurate the faces are and which tolerances were used."""
        size, known = self.tolerances.accuracy, "too few joints to tell how accurate the faces are"
        if size is not None:
            good = f"are good to about {millimetres(size * self.length)}" if size > _EXACT else "meet exactly"
            known = f"the faces that touch {good}"
        return f"{known}; {self.tolerances.in_words(self.length)}"

    @property
    def nothing(self) -> list[str]:
        """The line that nothing was found; none where something was."""
        return [] if self.warnings else ["nothing found beside the interfaces with these tolerances"]

    @property
    def warnings(self) -> list[str]:
        """A line for each kind of thing found beside the interfaces, and for each overlap."""
        lines = [self._coarse] if self._coarse else []
        lines += [f"{overlap}{self._remedy(overlap)}" for overlap in self.overlaps[:_SHOWN]]
        if len(self.overlaps) > _SHOWN:
            lines.append(f"and {len(self.overlaps) - _SHOWN} more overlaps")
        lines += self._line("no interface between blocks that nearly touch", self.near_misses)
        lines += self._line("blocks without any interface", self.isolated)
        lines += self._line("contacts left out because they are too small", self.slivers)
        lines += self._line("strips left out because they are too narrow", self.strips)
        return lines + self._line("no contact where a third block lies between", self.through)

    @staticmethod
    def _line(words: str, things: Sequence[object]) -> list[str]:
        """Return one line that names the first of what was found; none when nothing was."""
        more = f" and {len(things) - _SHOWN} more" if len(things) > _SHOWN else ""
        return [f"{words}: {', '.join(map(str, things[:_SHOWN]))}{more}"] if things else []

    def to_dict(self) -> dict[str, Any]:
        """Return all as plain numbers, lists and text, the interfaces without their joint; SI units."""
        beside = {
            name: [asdict(one) for one in getattr(self, name)]
            for name in ("near_misses", "overlaps", "slivers", "strips", "through")
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
        used = {"tolerances": self.tolerances.to_dict(), "block_length": self.length}
        return {"interfaces": interfaces, "isolated": list(self.isolated)} | used | beside

    def __str__(self) -> str:
        counts = (
            (self.interfaces, "interfaces"),
            (self.near_misses, "near misses"),
            (self.overlaps, "overlaps"),
            (self.isolated, "isolated blocks"),
            (self.slivers, "slivers"),
            (self.strips, "strips"),
            (self.through, "contacts through a block"),
        )
        return ", ".join(f"{len(things)} {words}" for things, words in counts)

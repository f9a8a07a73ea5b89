"""What contact detection found: interfaces, and what is worth a look beside them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from limitblocks.errors import GeometryError, few
from limitblocks.geometry.accuracy import Tolerances, millimetres, too_coarse
from limitblocks.geometry.findings import NearMiss, Overlap, Sliver, Through
from limitblocks.geometry.interface import PLACE, Interface
from limitblocks.shown import Shown, kept, many

_SHOWN = 8
_DEFAULT = Tolerances()
#: Accuracy, in block lengths, that is roundoff.
_EXACT = 1e-7
#: Share of the smaller block in an overlap beyond which it is within the other.
_TWICE = 0.9
#: Blocks within another from which on it is a frame, not a stone drawn twice.
_MANY = 4


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
        coarse = [self._coarse] if self._coarse and self.chosen else []
        return (*self._remedy_of_all, *self._overlap_words, *coarse)

    def require(self) -> None:
        """Raise GeometryError with all `faults`; do nothing where there is none."""
        if self.faults:
            raise GeometryError(*self.faults)

    @property
    def _overlap_words(self) -> list[str]:
        """A line for each block that holds many others, and for each other overlap, with its remedy."""
        pairs = [(one.block_i, one.block_j) for one in self.overlaps if one.share > _TWICE]
        holds = {name: count for name, count in Counter(sum(pairs, ())).items() if count >= _MANY}
        frames = [
            f"block {name!r} holds {count} others: a frame, or the outline of the whole? leave it out, in a "
            "drawing by its layer: layers (--layers) names those to take"
            for name, count in holds.items()
        ]
        rest = [one for one in self.overlaps if not holds.keys() & {one.block_i, one.block_j}]
        return frames + [f"{overlap}{self._remedy(overlap)}" for overlap in rest]

    def _remedy(self, overlap: Overlap) -> str:
        if overlap.share > _TWICE:
            return ": one is within the other, or drawn twice; delete one"
        if overlap.tolerance < self.tolerances.gap * self.length:
            return ", half the thickness of the thinner one; draw them apart, or as one"
        gap = self._gap_for(overlap)
        option = f"--gap {gap:.2g}, " * (len(self.overlaps) == 1)  # else in the line of all
        return "; draw them apart" + (f", or give gap={gap:.2g} ({option}block lengths)" if gap else "")

    def _gap_for(self, overlap: Overlap) -> float:
        """Return the gap that takes two blocks as touching that overlap; zero where none should."""
        thin = overlap.tolerance < self.tolerances.gap * self.length
        deep = overlap.depth > 0.05 * self.length
        return 0.0 if thin or deep else 1.1 * overlap.depth / self.length

    @property
    def touching(self) -> float:
        """The gap, in block lengths, that takes blocks that overlap a little as touching; 0 if none do."""
        return max(map(self._gap_for, self.overlaps), default=0.0)

    @property
    def _remedy_of_all(self) -> list[str]:
        """The line with one remedy of several overlaps; none where there is none, or one overlap."""
        gaps = [gap for gap in map(self._gap_for, self.overlaps) if gap]
        if len(self.overlaps) < 2 or not gaps:
            return []
        count, gap = len(self.overlaps), f"{self.touching:.2g}"
        deepest = max(one.depth for one in self.overlaps if self._gap_for(one))
        these = "" if len(gaps) == count else f"{len(gaps)} of them "
        return [
            f"{count} pairs of blocks overlap, {these}by up to {deepest:.3g} m: draw them apart, or give "
            f"gap={gap} (--gap {gap}, block lengths) to take {'these' if these else 'them'} as touching"
        ]

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
        return [] if self._found else ["nothing found beside the interfaces with these tolerances"]

    @property
    def warnings(self) -> list[str]:
        """A line for each kind of thing found beside the interfaces, and for each overlap."""
        return self._found

    @property
    def _found(self) -> list[str]:
        lines = [self._coarse] if self._coarse else []
        lines += [*self._remedy_of_all]
        lines += self._overlap_words[:_SHOWN]
        if len(self._overlap_words) > _SHOWN:
            lines.append(f"and {len(self._overlap_words) - _SHOWN} more overlaps")
        lines += self.near_words
        lines += self._line("blocks without any interface", self.isolated)
        lines += self._line("contacts left out because they are too small", self.slivers)
        lines += self._line("strips left out because they are too narrow", self.strips)
        return lines + self._line("no contact where a third block lies between", self.through)

    @property
    def near_words(self) -> list[str]:
        """The line that names the blocks that nearly touch; none where none do."""
        return self._line("no interface between blocks that nearly touch", self._near_pairs)

    @property
    def _near_pairs(self) -> list[str]:
        """The largest near miss of each pair of blocks, with the number of the others."""
        pairs: dict[tuple[str, str], list[NearMiss]] = {}
        for one in self.near_misses:
            pairs.setdefault((one.block_i, one.block_j), []).append(one)
        return [
            f"{max(faces, key=lambda one: one.area)}"
            + (f" and {many(len(faces) - 1, 'more face')}" if len(faces) > 1 else "")
            for faces in pairs.values()
        ]

    @staticmethod
    def _line(words: str, things: Sequence[object]) -> list[str]:
        """Return one line that names the first of what was found; none when nothing was."""
        return [f"{words}: {few(things)}"] if things else []

    def to_dict(self) -> dict[str, Any]:
        """Return all as plain numbers, lists and text, the interfaces without their joint; SI units."""
        return {
            "interfaces": [kept(one, *PLACE) for one in self.interfaces],
            **kept(self, "isolated", "tolerances"),
            "block_length": self.length,
            **kept(self, "near_misses", "overlaps", "slivers", "strips", "through"),
        }

    def __str__(self) -> str:
        counts = (
            (self.interfaces, "interface"),
            (self.near_misses, "near miss", "near misses"),
            (self.overlaps, "overlap"),
            (self.isolated, "isolated block"),
            (self.slivers, "sliver"),
            (self.strips, "strip"),
            (self.through, "contact through a block", "contacts through a block"),
        )
        return ", ".join(many(len(things), *words) for things, *words in counts)

"""Blocks that are likely to be supports, and the words that choose them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from limitblocks.errors import ModelError
from limitblocks.geometry import Block, select
from limitblocks.io.guesses import SUPPORT_WORDS
from limitblocks.shown import coordinate

_NAMED = 8  # blocks at most that are chosen one by one


@dataclass(frozen=True)
class LikelySupports:
    """Blocks that may be supports.

    Attributes
    ----------
    chosen_by : tuple of str
        What chooses them, as for :func:`limitblocks.files.select`.
    blocks : tuple of str
        Their names.
    reason : str
    """

    chosen_by: tuple[str, ...]
    blocks: tuple[str, ...]
    reason: str

    def __str__(self) -> str:
        some = ", ".join(self.blocks[:4]) + (" ..." if len(self.blocks) > 4 else "")
        return f"{' '.join(map(repr, self.chosen_by))}: {len(self.blocks)} ({some}), {self.reason}"


def likely_supports(blocks: Sequence[Block]) -> tuple[LikelySupports, ...]:
    """Return what may be the supports, the likeliest first: by layer, by name, by place."""
    if len(blocks) < 2:
        return ()
    layers = dict.fromkeys(block.layer for block in blocks if SUPPORT_WORDS.search(block.layer))
    found = [_chosen(blocks, (f"layer:{layer}",), "by the name of the layer") for layer in layers]
    names = [block.name for block in blocks if SUPPORT_WORDS.search(block.name)]
    if names:
        found.append(_chosen(blocks, _choice(blocks, names), "by name"))
    found.append(_lowest(blocks))
    distinct = {one.blocks: one for one in reversed(found) if one and len(one.blocks) < len(blocks)}
    return tuple(reversed(distinct.values()))


def _chosen(blocks: Sequence[Block], by: tuple[str, ...], reason: str) -> LikelySupports | None:
    try:
        return LikelySupports(by, select(blocks, by), reason) if by else None
    except ModelError:  # a name with the letters of a pattern
        return None


def _choice(blocks: Sequence[Block], names: Sequence[str]) -> tuple[str, ...]:
    """Return what chooses the blocks of these names and no other: a pattern, or the names if they are few."""
    first, last = min(names), max(names)
    same = next((k for k, (a, b) in enumerate(zip(first, last, strict=False)) if a != b), len(first))
    pattern = f"{first[:same]}*"
    if len(names) > 1 and len(pattern) > 3:
        one = _chosen(blocks, (f"name:{pattern}",), "")
        if one and one.blocks == tuple(names):
            return one.chosen_by
    return tuple(names) if len(names) <= _NAMED else ()


def _lowest(blocks: Sequence[Block]) -> LikelySupports | None:
    """Return the blocks that reach down to the lowest level, by a height where this chooses just them."""
    bottom, top = (np.array([f(block.vertices[:, 2]) for block in blocks]) for f in (np.min, np.max))
    tolerance = 0.02 * float(np.median([block.size for block in blocks]))
    lowest = bottom <= bottom.min() + tolerance
    names = [block.name for block, low in zip(blocks, lowest, strict=True) if low]
    bound, above = float(top[lowest].max()), top[~lowest]
    reason = f"they reach down to the lowest level, Z = {coordinate(bottom.min())} m"
    if len(above) and bound < above.min() - 1e-6:
        digits = float(f"{bound + min(tolerance, (above.min() - bound) / 2.0):.3g}")
        if bound <= digits < above.min():
            return _chosen(blocks, (f"z<{digits:g}",), reason)
    return _chosen(blocks, _choice(blocks, names), reason)

"""Slips in ties, strips and dowels: their section, what they carry, and those given twice."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from limitblocks.arrays import Array
from limitblocks.geometry import Interface, Tolerances
from limitblocks.geometry.accuracy import block_length, millimetres
from limitblocks.geometry.polygon import areas
from limitblocks.joints import Backfill, Dowel, Tie
from limitblocks.model import Model
from limitblocks.shown import coordinates

#: Strength of a tie, Pa, below which it may be in MPa or its force in kN: oak has 5e7.
_SOFT = 1e6
#: Section of a tie, m2, above which it may be in mm2: 0.25 m across.
_THICK = 5e-2


def of_ties(model: Model) -> Iterator[str]:
    """Return what is asked about ties, strips and dowels of a model."""
    yield from _of_sections(model)
    yield from _of_doubles(model)


def _of_sections(model: Model) -> Iterator[str]:
    """What is asked about the sections of ties and what they carry."""
    for tie in model.interfaces:
        if isinstance(tie.joint, Tie) and tie.joint.length:
            section, strength = float(areas(tie.polygon)), tie.joint.strength
            if section > _THICK:
                small = f"{section:.4g} mm2 = {section / 1e6:.4g} m2"
                yield f"{tie.name}: its section is {section:.4g} m2: mm2? {small}"
            if strength < _SOFT:
                what = f"it carries {section * strength:.4g} N, {strength:.4g} Pa on its section"
                yield f"{tie.name}: {what}: MPa, or kN?"


def _of_doubles(model: Model) -> Iterator[str]:
    """What is asked about ties, strips or dowels of the same blocks and anchors: they add up."""
    gap = (model.tolerances or Tolerances()).gap * block_length(model.blocks)
    met: dict[tuple[str, tuple[str, ...]], list[Array]] = {}
    for one in model.interfaces:
        if not isinstance(one.joint, Tie | Dowel) or isinstance(one.joint, Backfill):
            continue  # faces of a block that lean both ways have fill at one point
        ends = sorted([one.block_i, one.block_j])
        others, own = met.setdefault((one.joint.word, tuple(ends)), []), _anchors(one)
        if any(np.linalg.norm(own - other, axis=1).max() <= gap for other in others):
            where = " and ".join(coordinates(at) for at in np.unique(own, axis=0).tolist())
            same = f"as another between the same blocks, within {millimetres(gap)}"
            yield f"{one.name}: it is at {where} m, {same}: given twice? they add up"
        others.append(own)


def _anchors(one: Interface) -> Array:
    """Anchors (2, 3) of a tie, or twice the centroid, in the order of the names of its blocks."""
    half = getattr(one.joint, "length", 0.0) / 2.0 * one.axes[2]
    ends = np.array([one.centroid - half, one.centroid + half])
    return ends if one.block_i < one.block_j else ends[::-1]

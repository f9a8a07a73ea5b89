"""Slips in ties, strips and dowels: section, what they carry, anchors, lost prestress, those given twice."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from limitblocks.analysis.anchors import anchors_off
from limitblocks.arrays import Array
from limitblocks.errors import few
from limitblocks.geometry import Interface, Tolerances
from limitblocks.geometry.accuracy import block_length, millimetres
from limitblocks.geometry.polygon import areas
from limitblocks.joints import Backfill, Dowel, Tie
from limitblocks.mechanics.loads.forces import PointForce
from limitblocks.model import Model
from limitblocks.shown import coordinates

#: Strength of a tie, Pa, below which it may be in MPa or its force in kN: oak has 5e7.
_SOFT = 1e6
#: Section of a tie, m2, above which it may be in mm2: 0.25 m across.
_THICK = 5e-2
#: Width of a strip or dowel, m, above which it may be in mm.
_WIDE = 4.0
#: Share of a prestress by which the dead loads may differ by rounding, and distance of its place there, m.
_OTHER, _BESIDE = 1e-6, 1e-6


def of_ties(model: Model) -> Iterator[str]:
    """Return what is asked about ties, strips and dowels of a model."""
    yield from _of_sections(model)
    for one in model.interfaces:
        yield from anchors_off(model, one)
    yield from _of_prestress(model)
    yield from _of_doubles(model)
    yield from _of_fill_twice(model)


def _of_sections(model: Model) -> Iterator[str]:
    """What is asked about the sections of ties and what they carry, and the widths of strips and dowels."""
    for tie in model.interfaces:
        if not isinstance(tie.joint, Tie | Dowel) or isinstance(tie.joint, Backfill):
            continue  # fill is as wide as the face that presses it
        section, strength = float(areas(tie.polygon)), tie.joint.strength
        if not getattr(tie.joint, "length", 0.0):
            width = float(np.sqrt(section))
            if width > _WIDE:
                yield f"{tie.name}: it is {width:.4g} m wide: mm? {width:.4g} mm = {width / 1e3:.4g} m"
            continue
        if section > _THICK:
            small = f"{section:.4g} mm2 = {section / 1e6:.4g} m2"
            yield f"{tie.name}: its section is {section:.4g} m2: mm2? {small}"
        if strength < _SOFT:
            what = f"it carries {section * strength:.4g} N, {strength:.4g} Pa on its section"
            yield f"{tie.name}: {what}: MPa, or kN?"


def _of_prestress(model: Model) -> Iterator[str]:
    """What is asked about ties whose prestress the dead loads lack or have another one."""
    free = {block.name for block in model.free_blocks}
    forces = [(factor, term) for factor, term in model.dead.terms if isinstance(term, PointForce)]
    pulls = [
        (tie.name, name, tie.centroid, sign * tie.joint.prestress * float(areas(tie.polygon)) * tie.axes[2])
        for tie in model.interfaces
        if isinstance(tie.joint, Tie) and tie.joint.prestress
        for name, sign in ((tie.block_i, 1.0), (tie.block_j, -1.0))
        if name in free
    ]

    def there(name: str, at: Array, block: str, place: Any) -> bool:
        return name == block and float(np.abs(at - place).max()) <= _BESIDE

    for tie, name, at, own in pulls:
        wanted = sum(pull for _, block, place, pull in pulls if there(name, at, block, place))
        found = sum(k * np.array(term.force) for k, term in forces if there(name, at, term.block, term.at))
        if np.linalg.norm(found - wanted) > _OTHER * np.linalg.norm(own):
            pull = f"the dead loads pull {name!r} with {np.linalg.norm(found):.4g} N there"
            yield (
                f"{tie}: it has a prestress of {np.linalg.norm(own):.4g} N, and {pull}: changed after "
                "limitblocks.practice.reinforced?"
            )


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


def _of_fill_twice(model: Model) -> Iterator[str]:
    """What is asked about passive fill that holds a face of a block, towards one side, more than once."""
    gap = (model.tolerances or Tolerances()).gap * block_length(model.blocks)
    met: dict[str, list[Interface]] = {}
    again = []
    for one in model.interfaces:
        if not isinstance(one.joint, Backfill):
            continue
        others = met.setdefault(one.block_i, [])
        if any(
            np.linalg.norm(one.centroid - other.centroid) <= gap and one.axes[2] @ other.axes[2] > 0.5
            for other in others
        ):
            again.append(one.block_i)
        others.append(one)
    if again:
        names = [*map(repr, dict.fromkeys(again))]
        yield f"fill resists {few(names)} twice at one place: passive_fill (backfill) given twice? it adds up"


def _anchors(one: Interface) -> Array:
    """Anchors (2, 3) of a tie, or twice the centroid, in the order of the names of its blocks."""
    half = getattr(one.joint, "length", 0.0) / 2.0 * one.axes[2]
    ends = np.array([one.centroid - half, one.centroid + half])
    return ends if one.block_i < one.block_j else ends[::-1]

"""Slips in fill: an angle for its coefficient, given twice, pressing both sides of a wall that retains it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations

import numpy as np

from limitblocks.arrays import Array
from limitblocks.geometry import Block
from limitblocks.joints import Backfill
from limitblocks.mechanics.loads.faces import integrals
from limitblocks.mechanics.loads.fills import UP, Fill
from limitblocks.mechanics.loads.load import some
from limitblocks.model import Model
from limitblocks.shown import coordinate

#: Levels and ends of fill, m, that are nearer are the same: a message shows no more.
_SAME = 1e-3
#: Share of the thrust on one side of a block that is asked about where as much acts on the other one.
_MUCH = 0.1
#: Unit weight, N/m3, that neither water nor soil has: concrete has 2.5e4.
HEAVY_FILL = 3e4
#: Coefficient of earth pressure that may be an angle in degrees: dense sand on a rough wall has 18.
_ANGLE = 20.0
#: Height of fill above a structure, m, beyond which it may be in mm: deep culverts have 40.
_DEEP = 50.0
#: Cosine from which fill counts as on the other side.
_TOWARDS = 1e-6
_ROUNDED = 1e-9  # of the fill on a face: less is missing by rounding


def of_fills(model: Model) -> Iterator[str]:
    """Return what is asked about the fill of a model."""
    fills = [term for _, term in model.dead.terms + model.live.terms if isinstance(term, Fill)]
    for coefficient in sorted({fill.coefficient for fill in fills}):
        yield from of_earth_pressure(coefficient)
    top = max((block.vertices[:, 2].max() for block in model.free_blocks), default=0.0)
    for level in sorted({fill.level for fill in fills if fill.level > top + _DEEP}):
        deep = f"{level - top:.4g} m above the structure"
        yield f"fill up to Z = {coordinate(level)} m is {deep}: millimetres? see units"
    yield from _twice(model)
    yield from _on_both_sides(model)
    yield from of_resisting(model)


def of_earth_pressure(coefficient: float) -> list[str]:
    """Return the question for a coefficient of earth pressure that no soil has."""
    if coefficient < _ANGLE:
        return []
    said = f"coefficient of earth pressure is {coefficient:g}"
    if coefficient >= 90.0:
        return [f"{said}, more than of any soil"]
    sine = np.sin(np.radians(coefficient))
    active = (1.0 - sine) / (1.0 + sine)
    return [f"{said}: degrees? {coefficient:g} deg are {active:.3g}, passive {1.0 / active:.3g} (Rankine)"]


def _on_both_sides(model: Model) -> Iterator[str]:
    """Return what is asked about blocks that part the fill and are pressed by it from both sides."""
    blocks = model.free_blocks
    for _, term in model.dead.terms + model.live.terms:
        if not isinstance(term, Fill) or not term.coefficient:
            continue
        thrusts: dict[int, list[Array]] = {}
        parted = set()
        for k, face, weight, _ in term.on_faces(blocks):
            normal = blocks[k].normals[face]
            thrusts.setdefault(k, []).append(term.coefficient * weight * normal[:2] / normal[2])
            if not weight or abs(weight - _above(blocks[k], face, term)) > _ROUNDED * weight:
                parted.add(k)
        lost = {k: back for k in parted if (back := _cancelled(np.array(thrusts[k])))}
        if lost:
            what = f"{sum(lost.values()) / 1e3:.4g} kN of its earth pressure cancel"
            yield (
                f"fill presses {some([blocks[k].name for k in sorted(lost)])} from both sides, where {what}: "
                "is there fill on both? If on one, say beyond which place and towards where"
            )


def of_resisting(model: Model) -> Iterator[str]:
    """Return what is asked about passive fill on that side of a block where the fill of the model is not."""
    fills = [term for _, term in model.dead.terms if isinstance(term, Fill)]
    if not fills or not all(term.towards for term in fills):
        return
    ways = np.array([term.towards for term in fills])
    held = [one for one in model.interfaces if isinstance(one.joint, Backfill)]
    aside = [one.block_i for one in held if (ways @ one.axes[2] > _TOWARDS).all()]  # it points off its fill
    if aside:
        yield (
            f"fill resists {some([*dict.fromkeys(aside)])} from the other side than that of the fill among "
            f"the dead loads, {fills[0].in_words()}: give passive_fill the same beyond and towards"
        )


def _above(block: Block, face: int, fill: Fill) -> float:
    """Weight of the fill over a whole face that nothing covers, N."""
    corners = block.vertices[list(block.faces[face])]
    return integrals(corners, fill.unit_weight * (fill.level - corners[:, 2]), UP)[0]


def _cancelled(thrusts: Array) -> float:
    """Thrust against the largest one, N, if it is much beside what acts along that one; thrusts (n, 2)."""
    sizes = np.linalg.norm(thrusts, axis=1)
    along = thrusts @ thrusts[sizes.argmax()] / (sizes.max() or 1.0)
    back = -float(along.clip(max=0.0).sum())
    return back if back > _MUCH * along.clip(0.0).sum() else 0.0


def _twice(model: Model) -> Iterator[str]:
    """Return what is asked about fill that the dead load has twice, up to one level on the same faces.

    Two that differ, and together weigh what one fill may, are its parts, as earth and the water in it.
    """
    fills = [(factor, term) for factor, term in model.dead.terms if isinstance(term, Fill)]
    for (a, one), (b, other) in combinations(fills, 2):
        weights = a * one.unit_weight, b * other.unit_weight
        if weights[0] != weights[1] and abs(sum(weights)) <= HEAVY_FILL * max(abs(a), abs(b)):
            continue
        if _one_side(one, other) and a * b > 0.0 and abs(one.level - other.level) <= _SAME:
            blocks = model.free_blocks
            if both := _faces(one, blocks) & _faces(other, blocks):
                names = dict.fromkeys(blocks[k].name for k, _ in sorted(both))
                yield (
                    f"the dead load has fill up to Z = {coordinate(one.level)} m on {some([*names])} twice, "
                    f"of {weights[0]:.4g} and {weights[1]:.4g} N/m3: one of them?"
                )


def _one_side(one: Fill, other: Fill) -> bool:
    """Return whether both end nowhere, or at one plane and towards the same side."""
    if not (one.beyond and one.towards and other.beyond and other.towards):
        return one.beyond == other.beyond
    between = np.subtract(other.beyond, one.beyond) @ one.towards[:2]
    return bool(abs(between) <= _SAME and np.allclose(one.towards, other.towards, rtol=0.0, atol=_SAME))


def _faces(fill: Fill, blocks: Sequence[Block]) -> set[tuple[int, int]]:
    return {(k, face) for k, face, weight, _ in fill.on_faces(blocks) if weight}

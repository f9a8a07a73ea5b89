"""Slips in magnitude: what a colleague would ask on seeing a number."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from limitblocks.analysis.magnitudes_of_fills import HEAVY_FILL, of_fills
from limitblocks.analysis.magnitudes_of_size import of_place, of_size
from limitblocks.analysis.magnitudes_of_ties import of_ties
from limitblocks.analysis.magnitudes_of_weight import of_weights
from limitblocks.geometry import Block, Tolerances
from limitblocks.geometry.accuracy import block_length
from limitblocks.geometry.distance import distance
from limitblocks.joints import OrdunaLourenco
from limitblocks.joints.base import joint_of
from limitblocks.mechanics.loads.fills import Fill
from limitblocks.mechanics.loads.forces import AddedMass, MassProportional, PointForce
from limitblocks.mechanics.loads.load import Load, some
from limitblocks.mechanics.loads.surfaces import Pressure
from limitblocks.model import Model
from limitblocks.shown import coordinates, many

#: Friction coefficient from which on it may be an angle in degrees: 71.6 degrees.
_STEEP = 3.0
#: Strengths and cohesions, Pa, below which they may be in MPa: mud mortar has 1e4 and 1e3.
_WEAK = {"compressive_strength": 1e4, "tensile_strength": 1e2, "cohesion": 1e2}
#: Unit weights, N/m3, below which they may be in kN/m3, or densities in kg/m3: cork has 1200, pumice 5000.
_KILO, _DENSITY = 5e2, 5e3
#: Unit weight, N/m3, and strength, Pa, that no masonry has: platinum weighs 2.1e5, basalt bears 4e8.
_HEAVY, _STRONG = 2.2e5, 1e9
#: Unit weights, N/m3, below which fill and what presses a face may be densities in kg/m3: expanded clay has
#: 2500, the active pressure of soil under water grows by 1400 a metre.
_OF_FILL, _OF_PRESSURE = 2.5e3, 1.2e3
#: Ground acceleration at life safety, m/s2, below which it may be in g: .05 g, the most of the calmest zone.
_CALM = 0.49
#: One beyond which it may have been given in m/s2 for g: .7 g, twice that of zone 1 (OPCM 3519/2006).
_FIERCE = 6.9
#: Dead force on a block, N and over its weight, below which it may be in kN: a hand pulls with more.
_FAINT, _FAINT_SHARE = 1e2, 1e-2
#: Distance of a force's line from the centroid of its block, over the size of the block: a bracket has 1.
_ASTRAY = 3.0
#: Share of the median volume below which a block may be debris.
_DEBRIS = 1e-4


def questions(model: Model) -> list[str]:
    """Return a question, with what was probably meant, for each number of a model that is hardly meant."""
    joints = dict.fromkeys(joint_of(interface) for interface in model.interfaces)
    asked = [*_of_loads(model), *(question for joint in joints for question in _of_joint(joint))]
    for weight in sorted({block.unit_weight for block in model.free_blocks if block.unit_weight}):
        asked += _of_weight(weight)
    corners = np.concatenate([block.vertices for block in model.blocks])
    size = float(np.ptp(corners, axis=0).max())
    return [
        *asked,
        *of_weights(model),
        *_of_forces(model, size),
        *of_fills(model),
        *of_ties(model),
        *of_size(size),
        *of_place(corners, size),
    ]


def weightless(model: Model) -> list[str]:
    """Return the names of the free blocks that weigh nothing."""
    return [block.name for block in model.free_blocks if not block.unit_weight]


def of_volumes(blocks: Sequence[Block]) -> list[str]:
    """Return the question for blocks so much smaller than the others that they may be debris."""
    middle = float(np.median([block.volume for block in blocks]))
    small = [block for block in blocks if block.volume < _DEBRIS * middle]
    if not small:
        return []
    least = min(small, key=lambda block: block.volume)
    return [
        f"{many(len(small), 'block')} smaller than {_DEBRIS:g} of the median, {middle:.3g} m3: debris? "
        f"The smallest is {least.name!r}, {least.volume:.2g} m3"
    ]


def of_fill(weight: float, density: float = _OF_FILL) -> list[str]:
    """Return the question for the unit weight of fill, N/m3, or of what presses a face as a liquid does.

    Below `density` it may be one; 1 is the load whose factor is the unit weight.
    """
    if weight > HEAVY_FILL:
        return [
            f"fill or pressure: unit weight is {weight:g} N/m3, more than of concrete: in N/m3? see units"
        ]
    asked = [] if weight == 1.0 or weight >= density else _of_weight(weight)
    return [f"fill or pressure: {question}" for question in asked]


def of_ground(a_g: float) -> list[str]:
    """Return the question for the ground acceleration of a site at life safety, m/s2."""
    if a_g < _CALM:
        return [f"a_g is {a_g:.3g} m/s2, {a_g / 9.81:.2g} g: g? {a_g:.3g} g = {9.81 * a_g:.3g} m/s2"]
    if a_g > _FIERCE:
        g = a_g / 9.81
        return [f"a_g is {a_g:.3g} m/s2, {g:.3g} g: m/s2? {g:.3g} m/s2 = {g / 9.81:.3g} g"]
    return []


def of_limit_states(grounds: Mapping[str, float]) -> list[str]:
    """Return the questions for ground accelerations, m/s2, of limit states from the frequent to the rare."""
    return [
        f"a_g at {rare} is {grounds[rare]:.3g} m/s2, at {often} {grounds[often]:.3g} m/s2, more: exchanged?"
        for often, rare in pairwise(grounds)
        if grounds[rare] < grounds[often]
    ]


def _of_loads(model: Model) -> Iterator[str]:
    if names := weightless(model):
        yield f"without weight: {some(names)}"
    for _, term in model.dead.terms + model.live.terms:
        if isinstance(term, Fill):
            yield from of_fill(term.unit_weight)
        elif isinstance(term, Pressure) and term.unit_weight:
            yield from of_fill(term.unit_weight, _OF_PRESSURE)
    if not model.dead.terms:
        yield "no dead load: the structure has no weight to stabilise it"
    if any(isinstance(term, MassProportional) for _, term in model.live.terms):
        loads = {"dead": _masses(model.dead), "live": _masses(model.live)}
        for one, other in (("dead", "live"), ("live", "dead")):
            for block, at in sorted(loads[one] - loads[other]):
                where = f"the mass fixed to {block!r} at {coordinates(at)} m"
                yield f"{where} acts in the {one} load alone: give it in the {other} load, too"


def _of_forces(model: Model, size: float) -> Iterator[str]:
    """What is asked about forces and masses on the blocks of a structure of this size, m."""
    blocks = {block.name: block for block in model.blocks}
    gap = (model.tolerances or Tolerances()).gap * block_length(model.blocks)
    tied = {  # the prestress of a tie acts half way between its anchors, in whatever block is there
        (name, tuple(own.centroid.tolist()))
        for own in model.interfaces
        if getattr(own.joint, "prestress", 0.0)
        for name in (own.block_i, own.block_j)
    }
    for load, word in ((model.dead, "dead"), (model.live, "live")):
        for factor, term in load.terms:
            if not isinstance(term, AddedMass | PointForce):
                continue
            block, on = blocks[term.block], f"the {word} load has {term.in_words()}"
            force = np.multiply(term.direction, term.weight) if isinstance(term, AddedMass) else term.force
            most = float(np.linalg.norm(force))
            acts = abs(factor) * most
            weight = block.weight if block.unit_weight else 0.0
            if word == "dead" and 0.0 < acts < min(_FAINT, _FAINT_SHARE * weight):
                yield f"{on}: {acts:.3g} N on a block of {weight:.3g} N; kN? see units"
            arm = np.subtract(term.at, block.centroid)
            if isinstance(term, PointForce) and most:  # where on its line it acts makes no difference
                arm = np.cross(arm, force) / most
            if (away := float(np.linalg.norm(arm))) > size:
                whole = f"the structure is {size:.4g} m large"
                yield f"{on}: that is {away:.4g} m off the centroid of the block, {whole}; see units"
            elif (term.block, term.at) not in tied and (there := _other_block(term, blocks, gap)):
                yield f"{on}: that is in block {there!r}"
            elif isinstance(term, PointForce) and away > _ASTRAY * block.size:
                yield f"{on}: that is {away:.4g} m off the centroid of the block, {block.size:.4g} m large"


def _other_block(term: AddedMass | PointForce, blocks: dict[str, Block], gap: float) -> str:
    """Name of the block that a term acts in or on where it is not its own."""
    at = np.array(term.at)

    def there(block: Block) -> bool:
        low, high = block.vertices.min(axis=0) - gap, block.vertices.max(axis=0) + gap
        return bool((low <= at).all() and (at <= high).all()) and distance(block, at) <= gap

    if there(blocks[term.block]):
        return ""
    return next((name for name, block in blocks.items() if there(block)), "")


def _masses(load: Load) -> set[tuple[str, tuple[float, ...]]]:
    return {(term.block, term.at) for _, term in load.terms if isinstance(term, AddedMass)}


def _of_joint(joint: Any) -> Iterator[str]:
    friction = joint.friction
    if friction >= _STEEP:
        angle = f"degrees? tan {friction:g} deg = {np.tan(np.radians(friction)):.3g}"
        yield f"friction is {friction:g}: {angle if friction < 90.0 else 'a coefficient is below 2'}"
    for name, least in _WEAK.items():
        value = getattr(joint, name, None)
        if value and value < least:
            yield f"{name.replace('_', ' ')} is {value:g} Pa: MPa? {value:g} MPa = {1e6 * value:g} Pa"
        if value and _STRONG < value < np.inf:
            yield f"{name.replace('_', ' ')} is {value:g} Pa, more than any stone bears: in Pa? see units"
    if isinstance(joint, OrdunaLourenco) and joint.counted_tension < joint.tensile_strength:
        counts = f"of it {joint.counted_tension:.3g} Pa counts, cohesion / friction"
        yield f"tensile strength is {joint.tensile_strength:g} Pa: {counts}; more cohesion?"


def _of_weight(weight: float) -> list[str]:
    if weight < _KILO:
        return [f"unit weight is {weight:g} N/m3: kN/m3? {weight:g} kN/m3 = {1e3 * weight:g} N/m3"]
    if weight < _DENSITY:
        return [f"unit weight is {weight:g} N/m3: kg/m3? {weight:g} kg/m3 weigh {9.81 * weight:.4g} N/m3"]
    if weight > _HEAVY:
        return [f"unit weight is {weight:g} N/m3, more than any material weighs: in N/m3? see units"]
    return []

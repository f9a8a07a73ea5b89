"""Random small models, each from its seed alone: blocks of 1 mm to 10 m, weights over up to 16 decades.

Interfaces are made by hand where faces coincide exactly, so that no case is hard by an accident of geometry.
"""

from dataclasses import dataclass

import numpy as np
import shapes
from closed_forms import known, standing
from coulomb import Truth
from draw import Draw
from kinds import KINDS, SHARES

import limitblocks as lb


@dataclass(frozen=True)
class Case:
    """A model, how it was made, and its truth where a formula gives it."""

    seed: int
    kind: str
    model: lb.Model
    known: Truth | None


def mass_direction(draw):
    """Direction of a mass-proportional load: mostly level, now and then along an axis or anywhere."""
    word = draw.rng.choice(["level", "x", "up", "down", "any"], p=[0.7, 0.15, 0.03, 0.02, 0.1])
    angle = draw.uniform(0.0, 2 * np.pi)
    given = {"x": (1.0, 0, 0), "up": (0, 0, 1.0), "down": (0, 0, -1.0)}
    if word == "any":
        return tuple(draw.rng.normal(size=3))
    return given.get(word, (np.cos(angle), np.sin(angle), 0.0))


def case(seed):
    """Return the case of a seed."""
    draw = Draw(seed)
    kind = str(draw.rng.choice(list(KINDS), p=SHARES))
    parts = KINDS[kind](draw)
    parts.interfaces = [shapes.turned(one) if draw.either(0.3) else one for one in parts.interfaces]
    direction = (0.0, 1.0, 0.0) if kind == "groove" else mass_direction(draw)
    live, pushed = lb.mass_proportional(direction), kind not in {"groove", "paper"} and draw.either(0.12)
    if pushed:  # on one block, of the order of its weight
        free = [block for block in parts.blocks if block.name not in parts.supports]
        block = free[draw.count(0, len(free) - 1)]
        corner = block.vertices[draw.count(0, len(block.vertices) - 1)]
        at = block.centroid + draw.uniform(0.0, 0.9) * (corner - block.centroid)
        live = lb.loads.force(block.name, np.multiply(block.weight, direction), at)
    model = lb.Model(parts.blocks, parts.supports, parts.interfaces, lb.self_weight(), live, f"{kind} {seed}")
    truth = None
    if parts.carried is not None and not pushed:
        unit = np.asarray(direction) / np.linalg.norm(direction)
        truth = standing(model, parts.carried, unit)
    elif parts.known is not None:
        most = parts.known()
        truth = known(-most, most)
    return Case(seed, kind + (" pushed" if pushed else ""), model, truth)

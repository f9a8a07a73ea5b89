"""Random numbers of one case, and the parts that make up a model."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import shapes

import limitblocks as lb

SIZE_SPREADS = (0.3, 1.0, 2.0)  # decades to either side of 0.1 m: the widest reaches from 1 mm to 10 m
WEIGHT_SPREADS = (0.0, 2.0, 8.0)  # decades to either side of 1 N


@dataclass
class Parts:
    """Blocks with their supports; `carried` names what stands on each interface of a forest, or is None."""

    blocks: list
    supports: list
    interfaces: list
    carried: list | None = None
    known: Callable | None = None


class Draw:
    """Random numbers of one case: sizes, weights and frictions from spreads drawn once."""

    def __init__(self, seed):
        self.rng = np.random.default_rng(seed)
        self.size_spread = self.rng.choice(SIZE_SPREADS)
        self.weight_spread = self.rng.choice(WEIGHT_SPREADS)
        self.least_friction = self.rng.choice([0.05, 0.3])
        self.slippery = self.rng.choice([0.0, 0.0, 0.3])
        self.kind_of_joint = lb.PointContact

    def size(self):
        return 0.1 * 10 ** self.rng.uniform(-self.size_spread, self.size_spread)

    def sides(self):
        return self.size() * self.rng.uniform(0.4, 1.6, 3)

    def weight(self):
        return 10 ** self.rng.uniform(-self.weight_spread, self.weight_spread)

    def joint(self):
        if self.rng.random() < self.slippery:
            return self.kind_of_joint(10 ** self.rng.uniform(-6, -2))
        return self.kind_of_joint(self.rng.uniform(self.least_friction, 1.5))

    def uniform(self, *ends):
        return self.rng.uniform(*ends)

    def count(self, least, most):
        return int(self.rng.integers(least, most + 1))

    def either(self, share=0.5):
        return bool(self.rng.random() < share)


def floor_under(boxes, name="floor"):
    """Box below z = 0 that reaches under all boxes {name: (low, high)}."""
    low = np.min([low for low, _ in boxes.values()], axis=0)
    high = np.max([high for _, high in boxes.values()], axis=0)
    margin = 0.1 * (high - low).max()
    return {name: ((low[0] - margin, low[1] - margin, -margin), (high[0] + margin, high[1] + margin, 0.0))}


def assembled(draw, boxes, supports=()):
    """Parts of boxes {name: (low, high)} that touch each other and the floor."""
    supports = {**floor_under(boxes), **{name: boxes[name] for name in supports}}
    everything = {**supports, **{name: ends for name, ends in boxes.items() if name not in supports}}
    blocks = [
        shapes.box(name, *ends, None if name in supports else draw.weight())
        for name, ends in everything.items()
    ]
    interfaces = [
        one
        for one in shapes.touching(everything, draw.joint)
        if not {one.block_i, one.block_j} <= set(supports)
    ]
    order = draw.rng.permutation(len(interfaces))
    return Parts(blocks, list(supports), [interfaces[k] for k in order])


def moved(parts, turn, shift=(0.0, 0.0, 0.0)):
    blocks = [block.moved(turn, shift) for block in parts.blocks]
    interfaces = [
        replace(one, centroid=turn @ one.centroid + shift, axes=one.axes @ turn.T) for one in parts.interfaces
    ]
    return replace(parts, blocks=blocks, interfaces=interfaces)


def rotation(axis, angle):
    x, y, z = axis
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def named(prefix, parts):
    blocks = [replace(block, name=prefix + block.name) for block in parts.blocks]
    interfaces = [
        replace(one, block_i=prefix + one.block_i, block_j=prefix + one.block_j) for one in parts.interfaces
    ]
    carried = parts.carried and [{prefix + name for name in names} for names in parts.carried]
    return Parts(blocks, [prefix + name for name in parts.supports], interfaces, carried)

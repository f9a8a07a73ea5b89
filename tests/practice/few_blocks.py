"""Blocks that slide or rock, for tests of capacity curves."""

from stones import model_of

import limitblocks as lb
from limitblocks.practice import displaced

H = 1.0


def toe_corner(model, height=H):
    """The upper corner above the toe."""
    vertices = model.free_blocks[0].vertices
    return vertices[(vertices[:, 0] > 0) & (vertices[:, 2] > height / 2)][0]


def sliding_block(friction=0.1, size=1.0):
    """A flat block on a base of the same plan: it slides before it rocks."""
    stones = [
        lb.Block.box("base", (size, size, 0.2), (0, 0, -0.1)),
        lb.Block.box("block", (size, size, 0.3), (0, 0, 0.15), 20e3),
    ]
    return model_of(stones, ["base"], lb.PointContact(friction))


def moved(assembly, displacements):
    """The structure after screws (n, 6) of its blocks."""
    return displaced.moved(assembly, assembly.at_rest.then(displacements))

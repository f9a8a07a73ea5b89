"""Arches and beams whose supports settle, for tests of settlements until collapse."""

from stones import model_of

import limitblocks as lb

WEIGHT = 20e3
SPREAD = (1.0, 0.0, 0.0)


def arch(voussoirs, thickness, joint=None):
    ring = lb.structures.arch(
        joint or lb.PointContact(0.8),
        radius=1.0,
        thickness=thickness,
        voussoirs=voussoirs,
        unit_weight=WEIGHT,
    )
    return ring, sum(block.weight for block in ring.free_blocks)


def beam_on(supports, ends, joint):
    """A beam between two `ends`, m, on supports from x to x."""
    stones = [lb.Block.box(name, (b - a, 1, 1), ((a + b) / 2, 0, -0.5)) for name, (a, b) in supports.items()]
    a, b = ends
    stones.append(lb.Block.box("beam", (b - a, 1, 0.5), ((a + b) / 2, 0, 0.25), WEIGHT))
    return model_of(stones, list(supports), joint)

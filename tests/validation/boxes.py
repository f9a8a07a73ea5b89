"""Boxes whose load factors are known in closed form."""

from dataclasses import replace

import limitblocks as lb


def leaves(joint, between, b=0.12, height=2.4):
    """Two leaves side by side in Y, their common joint `between` or none."""
    blocks = [
        lb.Block.box("base", (1.0, 1.0, 0.2), (0, 0, -0.1)),
        lb.Block.box("inner", (1.0, b, height), (0, -b / 2, height / 2), 20e3),
        lb.Block.box("outer", (1.0, b, height), (0, b / 2, height / 2), 20e3),
    ]
    interfaces = lb.find_interfaces(blocks, joint)
    vertical = {"inner", "outer"}
    kept = [i for i in interfaces if {i.block_i, i.block_j} != vertical]
    if between is not None:
        kept += [replace(i, joint=between) for i in interfaces if {i.block_i, i.block_j} == vertical]
    return lb.Model(blocks, ["base"], kept, lb.self_weight(), lb.mass_proportional((0, 1, 0)))

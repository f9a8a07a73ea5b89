"""Anchors of ties, strips and dowels: in or on the blocks that hold them."""

from __future__ import annotations

from collections.abc import Iterator

from limitblocks.geometry import Interface, Tolerances
from limitblocks.geometry.accuracy import block_length, millimetres
from limitblocks.geometry.distance import distance
from limitblocks.joints import Backfill, Dowel, Tie
from limitblocks.mechanics.loads.load import some
from limitblocks.model import Model

BESIDE = 1e-3  # of the size of a joint or block: a point farther from it is not on it


def anchors_off(model: Model, own: Interface) -> Iterator[str]:
    """Yield a sentence for each anchor of a tie, strip or dowel that is off its free block.

    That of a tie by more than the gap of contacts. An end of a tie in a support stands for the ground, a rock
    or a frame that is not drawn, and may lie anywhere. A strip or dowel is on the joint that it was made of.
    """
    joint = own.joint
    if not isinstance(joint, Tie | Dowel) or isinstance(joint, Backfill):
        return
    used = model.tolerances or Tolerances()
    gap = used.gap * block_length(model.blocks)
    length = joint.length if isinstance(joint, Tie) else 0.0
    half = length / 2.0 * own.axes[2]
    ends = {own.block_i: own.centroid - half, own.block_j: own.centroid + half}
    for block in model.free_blocks:
        if block.name not in ends:
            continue
        most = gap if length else max(gap, BESIDE * block.size)
        if (away := distance(block, ends[block.name])) > most:
            at = ", ".join(f"{x:.4g}" for x in ends[block.name])
            off = f"at ({at}) is {millimetres(away)} off block {block.name!r}, expected"
            if not length:
                yield f"{own.name}: its place {off} on a joint of this model, within {millimetres(most)}"
                continue
            there = [one.name for one in model.blocks if distance(one, ends[block.name]) <= most]
            yield (
                f"{own.name}: its anchor {off} in or on it, within {millimetres(most)}; in a support it may "
                "lie anywhere" + f"; that point is in {some(there)}" * bool(there)
            )

"""Anchors of ties: in or on the blocks that hold them."""

from __future__ import annotations

from collections.abc import Iterator

from limitblocks.geometry import Interface, Tolerances
from limitblocks.geometry.accuracy import block_length, millimetres
from limitblocks.geometry.distance import distance
from limitblocks.joints import Tie
from limitblocks.mechanics.loads.load import some
from limitblocks.model import Model


def anchors_off(model: Model, tie: Interface) -> Iterator[str]:
    """Yield a sentence for each anchor of a tie that is off its free block by more than the gap of contacts.

    An end in a support stands for the ground, a rock or a frame that is not drawn, and may lie anywhere.
    """
    joint = tie.joint
    if not isinstance(joint, Tie) or not joint.length:
        return
    used = model.tolerances or Tolerances()
    most = used.gap * block_length(model.blocks)
    half = joint.length / 2.0 * tie.axes[2]
    ends = {tie.block_i: tie.centroid - half, tie.block_j: tie.centroid + half}
    for block in model.free_blocks:
        if block.name in ends and (away := distance(block, ends[block.name])) > most:
            at = ", ".join(f"{x:.4g}" for x in ends[block.name])
            there = [one.name for one in model.blocks if distance(one, ends[block.name]) <= most]
            yield (
                f"{tie.name}: its anchor at ({at}) is {millimetres(away)} off block {block.name!r}, expected "
                f"in or on it, within {millimetres(most)}; in a support it may lie anywhere"
                + f"; that point is in {some(there)}"
                * bool(there)
            )

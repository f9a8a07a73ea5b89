"""Joints that are drawn open: blocks that touch nothing, and the gap with which they would."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from limitblocks.arrays import Array, tied
from limitblocks.errors import ModelError, few
from limitblocks.geometry import Block, Contacts, Interface, find_contacts
from limitblocks.geometry.accuracy import millimetres
from limitblocks.geometry.distance import beside
from limitblocks.geometry.ends import ends_of
from limitblocks.model import Model
from limitblocks.shown import many

#: Gaps, in block lengths, that are tried where blocks have no interface.
_WIDER = (0.01, 0.02, 0.05, 0.1)
#: Cosine of the angle within which a face is that of an interface: above that of any tolerance.
_FACING = 0.7


def open_joints(contacts: Contacts, blocks: Sequence[Block]) -> list[str]:
    """Return the line that says which gap lets blocks touch that have no interface; none where none does."""
    for gap in _WIDER * bool(contacts.isolated):
        wide = find_contacts(blocks, None, gap=gap, width=contacts.tolerances.width)
        tied = len(contacts.isolated) - len(wide.isolated)
        if tied > 0:
            alone = set(contacts.isolated)
            among = [one for one in wide.interfaces if alone & {one.block_i, one.block_j}]
            apart = _distance(among, blocks)
            drawn = (
                f"are the joints drawn open? They are typically {millimetres(apart)} wide"
                if apart >= 0.0
                else f"the blocks typically overlap by {millimetres(-apart)}"
            )
            return [
                f"{many(tied, 'block')} without any interface would touch with gap={gap:g} (block lengths, "
                f"{millimetres(gap * wide.length)}; import --gap {gap:g}): {drawn}"
            ]
    return []


def joined(contacts: Contacts, blocks: Sequence[Block], *rest: Any) -> Model:
    """Return the model; where it is wrong, the error tells of the joints that are drawn open, too."""
    try:
        return Model(blocks, *rest)
    except ModelError as error:
        apart = open_joints(contacts, blocks) or _open_beds(contacts, blocks)
        raise ModelError(*error.problems, *apart) from None


def _open_beds(contacts: Contacts, blocks: Sequence[Block]) -> list[str]:
    """Return the line that names joints drawn open between groups of blocks that touch; none if none are."""
    own = tied(ends_of(blocks, contacts.interfaces), len(blocks))
    for gap in _WIDER * bool(own.any()):
        wide = find_contacts(blocks, None, gap=gap, width=contacts.tolerances.width)
        i, j = own[ends_of(blocks, wide.interfaces)].T
        across = [wide.interfaces[k] for k in np.flatnonzero(i != j)]
        if across:
            names, apart = few([one.name for one in across]), _distance(across, blocks)
            return [
                f"{names} would touch with gap={gap:g} (block lengths, {millimetres(gap * wide.length)}; "
                f"import --gap {gap:g}): are these joints drawn open? They are typically "
                f"{millimetres(apart)} wide"
            ]
    return []


def _distance(interfaces: Sequence[Interface], blocks: Sequence[Block]) -> float:
    """Return the median distance, m, between the two faces that interfaces are of."""
    named = {block.name: block for block in blocks}
    beyond = [
        _beyond(named[one.block_i], one.axes[2], one.centroid)
        + _beyond(named[one.block_j], -one.axes[2], one.centroid)
        for one in interfaces
    ]
    return -float(np.median(beyond))


def _beyond(block: Block, normal: Array, point: Array) -> float:
    """Return how far beyond `point` along `normal` the face nearest to it is that looks there, m."""
    faces = np.flatnonzero(block.normals @ normal > _FACING)
    heights = block.offsets[faces] - block.normals[faces] @ point
    away = np.hypot(heights, [beside(block, k, point) for k in faces.tolist()])
    return float(heights[away.argmin()])

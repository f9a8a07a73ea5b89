"""Interfaces that lie on no face of their blocks: given by hand, or of a displaced structure."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from limitblocks.arrays import Array, Indices, repeated
from limitblocks.geometry.accuracy import Tolerances, block_length, millimetres
from limitblocks.geometry.block import Block
from limitblocks.geometry.ends import ends_of
from limitblocks.geometry.interface import Interface
from limitblocks.geometry.neighbours import bounds_of


def off_faces(blocks: Sequence[Block], interfaces: Sequence[Interface], used: Tolerances) -> tuple[str, ...]:
    """Return a sentence for each interface and block where it lies on no face, beyond tolerances of contacts.

    Ties, dowels, fills and guides, whose joints have a `word`, need no face.
    """
    some = [one for one in interfaces if not getattr(one.joint, "word", "")]
    if not some:
        return ()
    gap, ends = used.gap * block_length(blocks), ends_of(blocks, some)
    distance, angle = _nearest(blocks, some, ends.ravel(), gap, used.angle)
    distance = np.maximum(distance, _outside(blocks, some, ends))
    off = np.flatnonzero((distance > gap) | (angle > used.angle))
    of = ends.ravel().tolist()
    return tuple(
        f"{some[k // 2].name} is {millimetres(distance[k])} and {angle[k]:.2g} rad off the faces of "
        f"{blocks[of[k]].name!r}"
        for k in off.tolist()
    )


def _nearest(
    blocks: Sequence[Block], interfaces: Sequence[Interface], ends: Indices, gap: float, angle: float
) -> tuple[Array, Array]:
    """Distance of the centroid, m, and angle, rad, to the plane of the nearest face of each end, (2 m,)."""
    number = np.array([len(block.offsets) for block in blocks])
    owner, k = repeated(number[ends])
    face = (np.cumsum(number) - number)[ends][owner] + k
    normal = np.concatenate([block.normals for block in blocks])[face]
    offset = np.concatenate([block.offsets for block in blocks])[face]
    outward = np.concatenate([(one.axes[2], -one.axes[2]) for one in interfaces])[owner]
    at = np.repeat([one.centroid for one in interfaces], 2, axis=0)[owner]
    distance = np.abs((normal * at).sum(axis=1) - offset)
    turned = 2.0 * np.arcsin(np.minimum(np.linalg.norm(normal - outward, axis=1) / 2.0, 1.0))
    order = np.lexsort((np.maximum(distance / gap, turned / angle), owner))
    nearest = order[np.searchsorted(owner, np.arange(len(ends)))]
    return distance[nearest], turned[nearest]


def _outside(blocks: Sequence[Block], interfaces: Sequence[Interface], ends: Indices) -> Array:
    """How far corners of each interface lie outside the bounds of both its blocks, m, shape (2 m,)."""
    least, most = (bound[:, None] for bound in bounds_of([one.corners for one in interfaces]))
    low, high = (bound[ends] for bound in bounds_of([one.vertices for one in blocks]))
    return np.asarray(np.maximum(low - least, most - high).max(axis=2).ravel())

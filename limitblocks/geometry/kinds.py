"""Patches by what they are: contacts, near misses, slivers, strips, faces held apart by a third block."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import shapely

from limitblocks.arrays import Indices
from limitblocks.geometry.accuracy import Tolerances
from limitblocks.geometry.faces import FaceTable
from limitblocks.geometry.patches import Patches, covering, mean_width
from limitblocks.geometry.through import between


class Kinds(NamedTuple):
    """Patches that are contacts, near misses, slivers, strips, and held apart by a block, `third` (m,)."""

    meant: Patches
    apart: Patches
    small: Patches
    narrow: Patches
    held: Patches
    third: Indices


def sorted_by_kind(faces: FaceTable, seen: Patches, used: Tolerances, length: float, reach: float) -> Kinds:
    """Return patches by what they are, with the tolerances `used`; near misses within a `reach`, m."""
    size = np.abs(seen.gap)
    touching = (size <= used.gap * length) & (seen.angle <= used.angle)
    whole = shapely.area(seen.shape) > seen.least
    wide = whole & ((mean_width(seen.shape) > used.width * length) | covering(faces, seen))
    near = whole & (touching | (size <= reach))
    third = np.full(len(near), -1)
    third[near] = between(faces, seen.of(near), seen.of(touching & whole))
    held = touching & wide & (third >= 0)
    return Kinds(
        meant=seen.of(touching & wide & (third < 0)),
        apart=seen.of(~touching & near & (third < 0)),
        small=seen.of(touching & ~whole),
        narrow=seen.of(touching & whole & ~wide),
        held=seen.of(held),
        third=third[held],
    )

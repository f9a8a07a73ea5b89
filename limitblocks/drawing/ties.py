"""Ties as lines from anchor to anchor."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from limitblocks.arrays import Array
from limitblocks.geometry.ends import ends_of
from limitblocks.joints import Backfill, Guide, Tie
from limitblocks.model import Model


class TieLine(NamedTuple):
    """A tie: its place among the interfaces, its blocks i and j, its anchors (2, 3), m."""

    interface: int
    blocks: tuple[int, int]
    anchors: Array


def tie_lines(model: Model) -> list[TieLine]:
    """Return the ties of a model that have a length; the first anchor of each is in block i."""
    ends = ends_of(model.blocks, model.interfaces).tolist()
    return [
        TieLine(k, (i, j), one.centroid + np.outer([-0.5, 0.5], one.joint.length * one.axes[2]))
        for k, (one, (i, j)) in enumerate(zip(model.interfaces, ends, strict=True))
        if isinstance(one.joint, Tie) and one.joint.length > 0.0
    ]


def moved(model: Model, line: TieLine, displacements: Array) -> Array:
    """Return the anchors (2, 3) of a tie where displacements (n, 6) of the blocks take them, linearly."""
    own = displacements[list(line.blocks)]
    centres = np.array([model.blocks[k].centroid for k in line.blocks])
    return np.asarray(line.anchors + own[:, :3] + np.cross(own[:, 3:], line.anchors - centres))


def has_area(model: Model) -> list[bool]:
    """Return of each interface whether its polygon is drawn: neither of a guide, fill nor a long tie."""
    lines = {line.interface for line in tie_lines(model)}
    kinds = [isinstance(one.joint, Guide | Backfill) for one in model.interfaces]
    return [k not in lines and not bare for k, bare in enumerate(kinds)]

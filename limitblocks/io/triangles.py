"""Faces of a block as triangles."""

from __future__ import annotations

import numpy as np

from limitblocks.arrays import Indices
from limitblocks.geometry import Block


def triangles(block: Block) -> tuple[Indices, Indices]:
    """Return the vertices (t, 3), counter-clockwise from outside, and the face (t,) of each triangle."""
    fans = [(face[0], face[k], face[k + 1]) for face in block.faces for k in range(1, len(face) - 1)]
    counts = [len(face) - 2 for face in block.faces]
    return np.array(fans, dtype=np.int64), np.repeat(np.arange(len(counts)), counts)

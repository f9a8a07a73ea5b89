"""Stones with a foot of any outline, and the page that says how far off their strengths are."""

from pathlib import Path

import numpy as np
from stones import model_of

import limitblocks as lb

DOCS = (Path(__file__).parents[2] / "docs/choosing-a-joint.md").read_text(encoding="utf-8")
SQUARE = np.array([(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)])


def prism(outline, height):
    """A stone with a foot of any outline on the ground."""
    foot = lb.Block.prism("foot", outline, (0.0, height), 20e3, along="z")
    return [lb.Block.box("ground", (20.0, 20.0, 1.0), (0.0, 0.0, -0.5)), foot]


def shaft(outline, hole, height):
    """A stone with a hole, `hole` times its outline about the origin, on the ground."""
    n = len(outline)
    around = np.concatenate([np.multiply(outline, by) for by in (1.0, hole)])
    corners = np.concatenate([np.column_stack([around, np.full(2 * n, z)]) for z in (0.0, height)])
    faces = []
    for k in range(n):
        j = (k + 1) % n
        faces += [(k, j, 2 * n + j, 2 * n + k), (n + j, n + k, 3 * n + k, 3 * n + j)]
        faces += [(j, k, n + k, n + j), (2 * n + k, 2 * n + j, 3 * n + j, 3 * n + k)]
    foot = lb.Block("foot", corners, faces, 20e3)
    return [lb.Block.box("ground", (20.0, 20.0, 1.0), (0.0, 0.0, -0.5)), foot]


def pushed(blocks, joint, direction):
    return model_of(blocks, ["ground"], joint, (*direction, 0.0))

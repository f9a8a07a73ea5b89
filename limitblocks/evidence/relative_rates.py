"""How interfaces move in a mechanism."""

from __future__ import annotations

import numpy as np

from limitblocks.arrays import Array, Indices
from limitblocks.geometry.ends import ends_of
from limitblocks.model import Model

MOVING = 1e-3  # of the largest displacement rate: less counts as standing still


def relative_rates(model: Model, rates: Array) -> Array:
    """Relative displacement rates v + w x r of block j to block i, local axes, shape (m, 6)."""
    axes = np.stack([interface.axes for interface in model.interfaces])
    centroid = np.stack([interface.centroid for interface in model.interfaces])
    centres = np.stack([block.centroid for block in model.blocks])
    i, j = ends_of(model.blocks, model.interfaces).T

    def at(k: Indices) -> Array:
        v, w = rates[k, :3], rates[k, 3:]
        return np.stack([v + np.cross(w, centroid - centres[k]), w], axis=1)

    return np.asarray(((at(j) - at(i)) @ axes.swapaxes(1, 2)).reshape(-1, 6))


def speeds(model: Model, rates: Array) -> Array:
    """Displacement rates of blocks, rotations times their sizes, the same in all axes, shape (n,)."""
    sizes = np.array([block.size for block in model.blocks])
    return np.asarray(np.linalg.norm(rates[:, :3], axis=1) + sizes * np.linalg.norm(rates[:, 3:], axis=1))


def largest_rate(model: Model, rates: Array) -> float:
    """Largest displacement rate of the mechanism, rotations times the size of the block."""
    return float(speeds(model, rates).max())

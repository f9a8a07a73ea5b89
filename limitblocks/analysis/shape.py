"""A model with its corners moved by a field."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from limitblocks.arrays import Array, read_only
from limitblocks.geometry import Interface
from limitblocks.geometry.polygon import centroids
from limitblocks.model import Model

Field = Callable[[Array], Array]


def moved(model: Model, field: Field, t: float) -> Model:
    """Return the model with the corners of blocks and interfaces moved by t field(r)."""
    blocks = [
        replace(block, vertices=block.vertices + t * np.asarray(field(block.vertices)))
        for block in model.blocks
    ]
    return replace(model, blocks=blocks, interfaces=[_carried(i, field, t) for i in model.interfaces])


def _carried(interface: Interface, field: Field, t: float) -> Interface:
    """The interface with its corners moved, its first axis turned as little as its plane."""
    corners = interface.centroid + interface.polygon @ interface.axes[:2]
    corners = corners + t * np.asarray(field(corners))
    middle = corners.mean(axis=0)
    arms = corners - middle
    normal = np.cross(arms, np.roll(arms, -1, axis=0)).sum(axis=0)
    normal /= np.linalg.norm(normal)
    first = interface.axes[0] - (interface.axes[0] @ normal) * normal
    first /= np.linalg.norm(first)
    axes = np.stack([first, np.cross(normal, first), normal])
    flat = arms @ axes[:2].T
    centre = centroids(flat)
    return replace(
        interface, centroid=middle + centre @ axes[:2], axes=axes, polygon=read_only(flat - centre)
    )

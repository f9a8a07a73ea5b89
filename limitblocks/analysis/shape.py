"""A model with its corners moved by a field."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from limitblocks.arrays import Array, read_only, reals_if_any
from limitblocks.errors import ModelError
from limitblocks.geometry import Interface
from limitblocks.geometry.polygon import centroids
from limitblocks.joints import Backfill, Dowel, Tie
from limitblocks.model import Model

Field = Callable[[Array], Array]


def moved(model: Model, field: Field, t: float) -> Model:
    """Return the model with the corners of blocks and interfaces moved by t field(r)."""
    blocks = [replace(block, vertices=_shifted(block.vertices, field, t)) for block in model.blocks]
    return replace(model, blocks=blocks, interfaces=[_carried(i, field, t) for i in model.interfaces])


def _shifted(points: Array, field: Field, t: float) -> Array:
    """Points (k, 3) moved by t field(points); ModelError where that is no displacement of each."""
    if not callable(field):
        raise ModelError(
            f"field is {field!r}, expected a function of points (k, 3) that gives their displacements"
        )
    given = field(points)
    shift = reals_if_any(given)
    if shift.shape != points.shape or not np.isfinite(shift).all():
        was = f"shape {shift.shape}" if shift.size else repr(given)
        raise ModelError(
            f"field gives {was} for points {points.shape}, expected finite numbers of that shape"
        )
    return points + t * shift


def _carried(interface: Interface, field: Field, t: float) -> Interface:
    """The interface with its corners moved, its first axis turned as little as its plane.

    A tie stays between its anchors; it keeps its section, as strips, dowels and fill do.
    """

    def at(points: Array) -> Array:
        return _shifted(points, field, t)

    joint, old = interface.joint, interface.axes
    if isinstance(joint, Tie) and joint.length:
        ends = at(interface.centroid + np.outer((-0.5, 0.5), joint.length * old[2]))
        axes, long = _turned(old[0], ends[1] - ends[0])
        joint = replace(joint, length=long)
        return replace(interface, centroid=ends.mean(axis=0), axes=axes, joint=joint)
    corners = at(interface.centroid + interface.polygon @ old[:2])
    middle = corners.mean(axis=0)
    arms = corners - middle
    axes, _ = _turned(old[0], np.cross(arms, np.roll(arms, -1, axis=0)).sum(axis=0))
    if isinstance(joint, Tie | Dowel):
        return replace(interface, centroid=middle, axes=old if isinstance(joint, Backfill) else axes)
    flat = arms @ axes[:2].T
    centre = centroids(flat)
    return replace(
        interface, centroid=middle + centre @ axes[:2], axes=axes, polygon=read_only(flat - centre)
    )


def _turned(first: Array, normal: Array) -> tuple[Array, float]:
    """Axes about a normal of any length, the first one turned as little as may be, and that length."""
    size = float(np.linalg.norm(normal))
    normal = normal / size
    first = first - (first @ normal) * normal
    first = first / np.linalg.norm(first)
    return np.stack([first, np.cross(normal, first), normal]), size

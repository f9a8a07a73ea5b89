"""From which side a structure is seen, and the axes for it."""

from __future__ import annotations

from typing import Any

import numpy as np

from limitblocks.arrays import Array
from limitblocks.drawing.ties import tie_lines
from limitblocks.drawing.view import PLANES, towards, view_of
from limitblocks.errors import LimitBlocksError
from limitblocks.model import Model, checked_model
from limitblocks.plots.drawing import Canvas
from limitblocks.plots.style import new_axes, room


def canvas(model: Model, ax: Any, plane: str | None, rates: Array | None = None) -> Canvas:
    """Return `ax`, or new Axes, with the view of `model`.

    Without a plane, `ax` decides; without `ax` too, models whose contacts and loads lie in one vertical plane
    are drawn in elevation, others axonometrically, from the side to which displacement `rates` move them.
    """
    checked_model(model)
    if plane not in (None, "3d", *PLANES):
        known = ", ".join(map(repr, (*PLANES, "3d")))
        raise LimitBlocksError(f"plane is {plane!r}, expected one of {known}")
    if ax is not None and getattr(ax, "name", None) not in ("3d", "rectilinear"):
        raise LimitBlocksError(f"ax is {ax!r}, expected plain or 3d Axes of matplotlib")
    if ax is not None and plane is not None and (ax.name == "3d") != (plane == "3d"):
        raise LimitBlocksError(f"plane is {plane!r}, but ax has the projection {ax.name!r}; leave one out")
    plane = plane or ("3d" if ax is not None and ax.name == "3d" else _plane(model, ax is not None))
    if plane != "3d":
        return Canvas(ax or new_axes(size=_size(model, PLANES[plane])), PLANES[plane], False, False)
    own = ax is None
    if own:
        ax = new_axes("3d")
        x, y, _ = towards(model, rates)
        ax.view_init(elev=22.0, azim=float(np.degrees(np.arctan2(y, x))))
    ax.computed_zorder = False
    elev, azim = np.radians([ax.elev, ax.azim])
    eye = np.array([np.cos(elev) * np.cos(azim), np.cos(elev) * np.sin(azim), np.sin(elev)])
    return Canvas(ax, view_of(eye), True, own)


def _plane(model: Model, flat: bool) -> str:
    """Name of the elevation in which contacts and live load lie, or else 3d, or xz if it must be `flat`.

    The free blocks must be of one depth, too: a spiral stair is no wall.
    """
    vectors = np.stack([interface.axes[2] for interface in model.interfaces])
    live = model.live.on(model.free_blocks)[:, :3]
    live = live / max(float(np.abs(live).max()), np.finfo(float).tiny)
    out = np.abs(np.concatenate([vectors, live])).max(axis=0) < 1e-6
    ends = np.array([(b.vertices.min(axis=0), b.vertices.max(axis=0)) for b in model.free_blocks])
    out &= np.ptp(ends, axis=0).max(axis=0) < 1e-6 * np.ptp(ends)
    return "xz" if out[1] else "yz" if out[0] else "xz" if flat else "3d"


def _size(model: Model, view: Array) -> tuple[float, float]:
    """Size of a figure, inches, whose shape is that of the structure."""
    ends = [line.anchors for line in tie_lines(model)]
    corners = np.concatenate([*(block.vertices for block in model.blocks), *ends])
    wide, high = np.ptp(corners @ view[:2].T, axis=0)
    most = room() - 0.6
    width = float(np.clip(0.7 * room() * wide / high, 0.7 * most, most))
    return width + 0.6, float(np.clip(width * high / wide, 1.2, room())) + 1.0

"""Structures and mechanisms."""

from __future__ import annotations

from typing import Any

import numpy as np

from limitblocks.analysis.interface_states import Collapse, collapse_of
from limitblocks.analysis.results import LoadPath
from limitblocks.arrays import Array
from limitblocks.errors import LimitBlocksError
from limitblocks.model import Model
from limitblocks.plots.drawing import Canvas, canvas
from limitblocks.plots.style import EDGE, MOVING, STONE, SUPPORT

DRAWN = 0.08  # largest displacement drawn, over the diagonal of the structure
TURN = 0.25  # largest rotation drawn, rad: the drawing is linear in it
STILL = 1e-3  # of the largest displacement rate: less counts as standing still


def structure(model: Model, ax: Any = None, *, plane: str | None = None, names: bool = False) -> Any:
    """Draw the blocks; supports are hatched in elevation, dark in 3D.

    Parameters
    ----------
    model : Model
        The structure.
    ax : Axes, optional
        Where to draw: plain Axes for an elevation, 3d Axes for an axonometric drawing.
    plane : {"xz", "yz", "xy", "3d"}, optional
        The first two letters of an elevation run to the right and up. Without it, `ax` decides; without both,
        models whose contacts and live load lie in a vertical plane are drawn in that plane, others in 3D.
    names : bool
        Write each block's name at its centroid.

    Returns
    -------
    Axes
        Coordinates in m, equal scales.

    Raises
    ------
    LimitBlocksError
        If the plane is unknown or does not fit `ax`.
    """
    drawn = canvas(model, ax, plane)
    draw_structure(drawn, model)
    if names:
        for block in model.blocks:
            place = block.centroid if drawn.spatial else drawn.flat(block.centroid)
            style = {"ha": "center", "va": "center", "fontsize": "x-small", "clip_on": True, "zorder": 2e4}
            drawn.ax.text(*place.tolist(), block.name, **style)
    return drawn.ax


def draw_structure(drawn: Canvas, model: Model, **style: Any) -> None:
    """Draw the blocks where they stand, and the frame."""
    points = [block.vertices for block in model.blocks]
    colours = [SUPPORT if block.name in model.supports else STONE for block in model.blocks]
    drawn.blocks(points, [block.faces for block in model.blocks], colours, **style)
    drawn.frame(np.concatenate(points))


def mechanism(
    model: Model,
    result: Collapse | LoadPath,
    ax: Any = None,
    *,
    scale: float | None = None,
    plane: str | None = None,
) -> Any:
    """Draw the blocks displaced as in the mechanism of `result`, and the moving ones before in outline.

    The displacement rates of a point r off the centroid of its block are v + w x r, and the drawing is linear
    in them: rotated blocks are drawn a little too large.

    Parameters
    ----------
    model : Model
        The structure.
    result : Bounds, Nonassociated or LoadPath
        Of this model. A load path counts by its collapse.
    ax, plane
        As for :func:`structure`.
    scale : float, optional
        Displacement drawn over displacement rate, m/m, where the live load does the work 1 N m; written above
        the drawing. Without it the largest displacement drawn is 8 % of the diagonal of the structure, or
        the largest rotation 0.25 rad, whichever is less.

    Raises
    ------
    LimitBlocksError
        If the result has no mechanism or belongs to another model, the scale is no positive number, or the
        plane does not fit `ax`.
    """
    rates = collapse_of(model, result).displacement_rates
    shifts = [
        rate[:3] + np.cross(rate[3:], block.vertices - block.centroid)
        for block, rate in zip(model.blocks, rates, strict=True)
    ]
    sizes = np.array([np.linalg.norm(shift, axis=1).max() for shift in shifts])
    if not (np.isfinite(sizes).all() and sizes.max() > 0.0):
        raise LimitBlocksError(
            f"this {type(result).__name__} has no mechanism to draw: no block has a displacement rate"
        )
    factor = _default_scale(model, sizes, rates) if scale is None else scale
    if not (np.isfinite(factor) and factor > 0.0):
        raise LimitBlocksError(f"scale is {scale!r}, expected a finite number > 0")
    drawn = canvas(model, ax, plane)
    moving = sizes > STILL * sizes.max()
    before = [block.vertices for block in model.blocks]
    after = [p + factor * shift for p, shift in zip(before, shifts, strict=True)]
    colours = np.where(moving, MOVING, STONE)
    colours[[block.name in model.supports for block in model.blocks]] = SUPPORT
    drawn.blocks(after, [block.faces for block in model.blocks], colours.tolist())
    outline = [before[k] for k in np.flatnonzero(moving)]
    drawn.outline(outline, colors=EDGE, linewidths=0.8, linestyles=(0, (4, 2.5)))
    drawn.frame(np.concatenate(before + after))
    said = f"displacement rates × {factor:.3g}; largest drawn {factor * sizes.max():.2g} m"
    drawn.ax.set_title(said, fontsize="small")
    return drawn.ax


def _default_scale(model: Model, sizes: Array, rates: Array) -> float:
    points = np.concatenate([block.vertices for block in model.blocks])
    diagonal = float(np.linalg.norm(np.ptp(points, axis=0)))
    turn = float(np.linalg.norm(rates[:, 3:], axis=1).max())
    return min(DRAWN * diagonal / float(sizes.max()), TURN / turn if turn > 0.0 else np.inf)

"""Structures and mechanisms."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from limitblocks.arrays import Array
from limitblocks.drawing.motion import STILL, displaced, magnification, travel
from limitblocks.drawing.ties import moved, tie_lines
from limitblocks.errors import LimitBlocksError
from limitblocks.evidence.interface_states import Collapse, collapse_of
from limitblocks.evidence.load_path_result import LoadPath
from limitblocks.mechanics.loads.load import resultant
from limitblocks.model import Model
from limitblocks.plots.drawing import Canvas
from limitblocks.plots.style import EDGE, MOVING, STONE, SUPPORT, VERMILION, number
from limitblocks.plots.views import canvas

LIVE = 0.12  # length of the arrow of the live load, over the diagonal


def structure(
    model: Model, ax: Any = None, *, plane: str | None = None, names: bool = False, live: bool = True
) -> Any:
    """Draw the blocks, and ties as lines; supports are hatched in elevation, dark in 3D.

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
    live : bool
        Show by an arrow above the structure which way the resultant of the live load points.

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
    draw_ties(drawn, [line.anchors for line in tie_lines(model)])
    if live:
        _draw_live(drawn, model, [block.vertices for block in model.blocks])
    if names:
        for block in model.blocks:
            drawn.text(block.centroid, block.name, ha="center", fontsize="small")
    return drawn.ax


def draw_structure(drawn: Canvas, model: Model, **style: Any) -> None:
    """Draw the blocks where they stand, and the frame."""
    points = [block.vertices for block in model.blocks]
    colours = np.where(model.free, STONE, SUPPORT).tolist()
    drawn.blocks(points, [block.faces for block in model.blocks], colours, **style)
    drawn.frame(np.concatenate([*points, *(line.anchors for line in tie_lines(model))]))


def draw_ties(drawn: Canvas, lines: Sequence[Array], **style: Any) -> None:
    """Draw ties from anchor to anchor (2, 3)."""
    if lines:
        drawn.lines(lines, **({"colors": EDGE, "linewidths": 1.4} | style))
        drawn.beyond.append(np.concatenate(lines))


def _draw_live(drawn: Canvas, model: Model, shapes: list[Array]) -> None:
    """Draw the direction of the live load above the structure, where it has one, and the frame."""
    points = np.concatenate(shapes)
    force = resultant(model.live, model.free_blocks)
    force = force if drawn.spatial else force @ drawn.view[:2].T @ drawn.view[:2]
    size = float(np.linalg.norm(force))
    if size == 0.0:
        drawn.frame(points)
        return
    diagonal = float(np.linalg.norm(np.ptp(points, axis=0)))
    vector = LIVE * diagonal * force / size
    up = np.array([0.0, 0.0, 1.0]) if drawn.spatial else drawn.view[1]
    middle = (points.max(axis=0) + points.min(axis=0)) / 2
    height = float((points @ drawn.view[1]).max() - middle @ drawn.view[1]) / float(up @ drawn.view[1])
    centre = middle + up * (height + 0.04 * diagonal + abs(float(vector @ drawn.view[1])) / 2)
    tail = centre - vector / 2
    drawn.arrows(tail[None], vector[None], color=VERMILION)
    label = centre + up * (0.015 * diagonal + abs(float(vector @ drawn.view[1])) / 2)
    drawn.text(label, "live", color=VERMILION, ha="center", va="bottom")
    drawn.beyond.append(np.stack([tail, tail + vector, label + 0.04 * diagonal * up]))
    drawn.frame(points)


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
    sizes = travel(model.blocks, rates)
    if not (np.isfinite(sizes).all() and sizes.max() > 0.0):
        raise LimitBlocksError(
            f"this {type(result).__name__} has no mechanism to draw: no block has a displacement rate"
        )
    factor = magnification(model.blocks, rates) if scale is None else scale
    if not (np.isfinite(factor) and factor > 0.0):
        raise LimitBlocksError(f"scale is {scale!r}, expected a finite number > 0")
    drawn = canvas(model, ax, plane, rates)
    moving = sizes > STILL * sizes.max()
    before = [block.vertices for block in model.blocks]
    after = [
        block.vertices + displaced(block, factor * rate)
        for block, rate in zip(model.blocks, rates, strict=True)
    ]
    colours = np.where(moving, MOVING, STONE)
    colours[~model.free] = SUPPORT
    drawn.blocks(after, [block.faces for block in model.blocks], colours.tolist())
    outline = [before[k] for k in np.flatnonzero(moving)]
    draw_ties(drawn, [moved(model, line, factor * rates) for line in tie_lines(model)])
    drawn.outline(outline, colors=EDGE, linewidths=0.8, linestyles=(0, (4, 2.5)))
    _draw_live(drawn, model, before + after)
    largest = f"{factor * sizes.max():.2g} m"
    drawn.title(f"mechanism: largest displacement drawn {largest},\ndisplacement rates × {number(factor)}")
    return drawn.ax

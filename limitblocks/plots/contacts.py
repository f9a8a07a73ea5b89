"""What contacts carry and do: forces, the line of thrust, interface states."""

from __future__ import annotations

from collections import Counter
from typing import Any

import numpy as np

from limitblocks.arrays import Array
from limitblocks.drawing.chains import Joint, chains, crowded, joints_between, thrust
from limitblocks.drawing.ties import has_area, tie_lines
from limitblocks.errors import ModelError
from limitblocks.evidence import interface_states as states
from limitblocks.evidence.load_path_result import LoadPath
from limitblocks.joints import Guide
from limitblocks.model import Model
from limitblocks.plots.drawing import Canvas
from limitblocks.plots.structures import draw_structure, draw_ties
from limitblocks.plots.style import (
    BLACK,
    BLUE,
    GREEN,
    ORANGE,
    PALE,
    PURPLE,
    SKY,
    VERMILION,
    YELLOW,
    in_newtons,
)
from limitblocks.plots.views import canvas
from limitblocks.shown import many

LONGEST = 0.15  # arrow of the largest force, over the diagonal of the structure
LEVEL = 1e-9  # of the size of the structure: heights as near as that differ by rounding
SHORTEST = 1e-2  # of the largest force: less is not drawn
STICK = "#8c8c8c"
# Colours of the states, widths of their lines so that print in grey tells some apart.
COLOURS = {
    "stick": (STICK, 1.0),
    "open": (ORANGE, 2.2),
    "slide": (BLUE, 2.6),
    "twist": (GREEN, 2.6),
    "slide-twist": (SKY, 2.6),
    "hinge": (VERMILION, 2.6),
    "hinge-slide": (PURPLE, 2.6),
    "hinge-twist": (YELLOW, 2.6),
    "hinge-slide-twist": ("#7b4a12", 2.6),
    "crush": (BLACK, 3.4),
    "yield": ("#a6093d", 3.0),
    "slack": (PALE, 1.4),
}


def forces(
    model: Model, result: states.Collapse | LoadPath, ax: Any = None, *, plane: str | None = None
) -> Any:
    """Draw the contact forces as arrows from the points where they act.

    Each arrow is the force on the upper of the two blocks (on block j, if their centroids are level); the
    other block feels the opposite. Forces below 1 % of the largest are left out.

    Parameters
    ----------
    model : Model
        The structure.
    result : Bounds, Nonassociated or LoadPath
        Of this model; the largest force is written above the drawing.
    ax, plane
        As for :func:`structure`.

    Raises
    ------
    LimitBlocksError
        If the result belongs to another model or has no forces to draw.
    """
    interfaces = states.interface_states(model, result)
    drawn = canvas(model, ax, plane)
    _pale(drawn, model)
    points = np.concatenate([block.vertices for block in model.blocks])
    level = LEVEL * float(np.ptp(points, axis=0).max())
    height = {block.name: block.centroid[2] for block in model.blocks}
    up = [height[i.block_i] > height[i.block_j] + level for i in model.interfaces]
    vectors = np.where(np.array(up)[:, None], -interfaces.force, interfaces.force)
    sizes = np.linalg.norm(vectors, axis=1)
    shown = sizes > SHORTEST * sizes.max()
    longest = LONGEST * float(np.linalg.norm(np.ptp(points, axis=0)))
    length = longest / max(float(sizes.max()), np.finfo(float).tiny)
    tails = applied(interfaces)[shown]
    drawn.arrows(tails, length * vectors[shown], color=BLUE)
    drawn.plot(tails, "o", color=BLACK, markersize=1.2 if drawn.spatial else 2.0)
    drawn.frame(np.concatenate([points, tails + length * vectors[shown]]))
    drawn.title(f"contact forces; longest arrow {in_newtons(sizes.max())}")
    return drawn.ax


def applied(interfaces: states.InterfaceStates) -> Array:
    """Where the contact forces act: centres of pressure, or centroids without pressure; (m, 3)."""
    return np.where(
        np.isnan(interfaces.centre_of_pressure), interfaces.centroid, interfaces.centre_of_pressure
    )


def thrust_line(
    model: Model, result: states.Collapse | LoadPath, ax: Any = None, *, plane: str | None = None
) -> Any:
    """Draw the line of thrust of an arch, a column or another chain of blocks, and its hinges.

    The line joins the centres of pressure, (e1, e2) = (-M2, M1) / N off the centroids, in the order of the
    blocks; it breaks at an interface without a normal force. The pieces of a joint in one plane, as of a
    hollow shaft or a stone on two feet, count as one, pressed where their resultant acts.

    Parameters
    ----------
    model : Model
        Its free blocks are a chain: none touches others in more than two joints, and they do not form a
        ring. The faces of a joint in several planes, as a step, are as many joints. Ties, strips, dowels and
        passive fill do not count.
    result : Bounds, Nonassociated or LoadPath
        Of this model.
    ax, plane
        As for :func:`structure`.

    Raises
    ------
    ModelError
        If the blocks are not a chain.
    LimitBlocksError
        If the result belongs to another model.
    """
    interfaces = states.interface_states(model, result)
    order = chain(model)
    drawn = canvas(model, ax, plane)
    _pale(drawn, model)
    line = thrust(interfaces, order)
    drawn.plot(line, "-", color=VERMILION, linewidth=1.6, label="line of thrust")
    hinges = line[[any("hinge" in interfaces.state[k] for k in joint) for joint in order]]
    if len(hinges):
        style = {"markerfacecolor": "white", "markeredgecolor": BLACK, "markersize": 5.5}
        drawn.plot(hinges, "o", label="hinge", **style)
    drawn.legend()
    return drawn.ax


def chain(model: Model) -> list[Joint]:
    """Joints, by the places of their interfaces, in the order of a chain; ModelError if they are none."""
    if block := crowded(model):
        raise ModelError(
            f"block {block[0]!r} has {many(block[1], 'joint')}, each in one plane; "
            "a line of thrust needs a chain of blocks, at most two each"
        )
    lines = chains(model)
    if len(lines) != 1 or len(lines[0]) < len(joints_between(model)):
        raise ModelError("the blocks form more than one chain, or a ring; a line of thrust needs one chain")
    return lines[0]


def interface_states(
    model: Model, result: states.Collapse | LoadPath, ax: Any = None, *, plane: str | None = None
) -> Any:
    """Draw each interface in the colour of its state: stick, slide, twist, hinge, crush, open, yield, slack.

    Ties are lines from anchor to anchor.

    Dots are the centres of pressure of hinges. The legend counts the interfaces of each state.

    Parameters
    ----------
    model : Model
        The structure.
    result : Bounds, Nonassociated or LoadPath
        Of this model; see :func:`limitblocks.interface_states`.
    ax, plane
        As for :func:`structure`.

    Raises
    ------
    LimitBlocksError
        If the result belongs to another model.
    """
    interfaces = states.interface_states(model, result)
    drawn = canvas(model, ax, plane)
    _pale(drawn, model)
    ties, drawable = tie_lines(model), has_area(model)
    shapes = {k: one.corners for k, one in enumerate(model.interfaces) if drawable[k]}
    guides = {k for k, one in enumerate(model.interfaces) if isinstance(one.joint, Guide)}
    counted = Counter(state for k, state in enumerate(interfaces.state) if k not in guides)
    for state in sorted(counted, key=[*COLOURS, *sorted(counted)].index):
        colour, width = COLOURS.get(state, COLOURS["crush"])
        these = [shapes[k] for k, own in enumerate(interfaces.state) if own == state and k in shapes]
        tied = [line.anchors for line in ties if interfaces.state[line.interface] == state]
        style = {
            "facecolors": colour,
            "edgecolors": colour,
            "linewidths": width if not drawn.spatial else 0.6,
        }
        alpha = {"alpha": 0.35 if state == "stick" else 0.85} if drawn.spatial else {}
        label = f"{state} ({counted[state]})"
        if these:
            drawn.polygons(these, label=label, **style, **alpha)
        draw_ties(drawn, tied, colors=colour, linewidths=max(width, 1.4), label="" if these else label)
    hinges = interfaces.centre_of_pressure[["hinge" in state for state in interfaces.state]]
    if len(hinges):
        drawn.plot(hinges, "o", color=BLACK, markersize=2.5, zorder=2e4, label="thrust at a hinge")
    drawn.legend()
    return drawn.ax


def _pale(drawn: Canvas, model: Model) -> None:
    """The structure as a background for what is drawn over it."""
    draw_ties(drawn, [line.anchors for line in tie_lines(model)], colors=PALE)
    draw_structure(drawn, model, edgecolor=PALE, alpha=0.25 if drawn.spatial else 1.0)

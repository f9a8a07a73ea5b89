"""What governs the load factor: blocks and interfaces in the colour of their sensitivity."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import to_hex

from limitblocks.arrays import Array
from limitblocks.errors import refuse_kind
from limitblocks.evidence.sensitivity_result import Sensitivities
from limitblocks.model import Model, refuse_other
from limitblocks.plots.style import EDGE, PALE, SUPPORT, number
from limitblocks.plots.views import canvas

COLOURS = "RdBu"  # red lowers the load factor, blue raises it; told apart by the colour-blind
WIDEST = 4.0  # line of the interface that matters most
NONE = 1e-3  # of the largest: an interface that matters less is a thin line
ROUNDING = 1e-6  # of the load factor: what bounds are known to, no change


def sensitivity(
    model: Model, sensitivities: Sensitivities, ax: Any = None, *, plane: str | None = None
) -> Any:
    """Draw what governs the load factor: blocks by their unit weight, interfaces by their friction.

    Blue raises the load factor where the datum grows, red lowers it; the deepest colour is the largest change
    per relative change of the datum, of blocks and of interfaces each for itself. Interfaces that matter are
    drawn wider.

    Parameters
    ----------
    model : Model
        The structure.
    sensitivities : Sensitivities
        Of this model.
    ax, plane
        As for :func:`structure`.

    Raises
    ------
    LimitBlocksError
        If the sensitivities belong to another model.
    """
    refuse_kind(sensitivities, Sensitivities, "sensitivities")
    refuse_other(model, sensitivities)
    drawn = canvas(model, ax, plane)
    blocks, joints = (
        np.where(np.abs(values) > ROUNDING * abs(sensitivities.load_factor), values, 0.0)
        for values in (sensitivities.of_blocks, sensitivities.of_interfaces)
    )
    colours = np.where(model.free, _colours(blocks), SUPPORT)
    points = [block.vertices for block in model.blocks]
    drawn.blocks(points, [block.faces for block in model.blocks], colours.tolist(), edgecolor=PALE)
    largest = float(np.abs(joints).max(initial=0.0))
    for interface, value, colour in zip(model.interfaces, joints, _colours(joints), strict=True):
        share = abs(value) / largest if largest else 0.0
        matters = share > NONE
        style = {"facecolors": colour, "edgecolors": colour if matters else EDGE}
        drawn.polygons([interface.corners], linewidths=0.4 + (WIDEST - 0.4) * share, **style)
    drawn.frame(np.concatenate(points))
    most = [number(float(np.abs(v).max(initial=0.0))) for v in (blocks, joints)]
    drawn.title(
        "change of the load factor per relative change, red less, blue more:\n"
        f"unit weights up to {most[0]}, friction up to {most[1]}"
    )
    return drawn.ax


def _colours(values: Array) -> Array:
    """Colours (k,) of values, the largest in size the deepest."""
    share = values / (float(np.abs(values).max(initial=0.0)) or 1.0)
    return np.array([to_hex(colour) for colour in colormaps[COLOURS]((share + 1.0) / 2.0)])

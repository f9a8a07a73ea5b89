"""What contact detection saw beside the interfaces, on the structure."""

from __future__ import annotations

from typing import Any

import numpy as np

from limitblocks.analysis.diagnosis import diagnose
from limitblocks.model import Model
from limitblocks.plots.structures import draw_structure
from limitblocks.plots.style import BLACK, BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION
from limitblocks.plots.views import canvas

#: Kinds of findings between two blocks, as attributes of Diagnosis, with their colours.
_KINDS = {
    "interfaces": ("contact without an interface", PURPLE),
    "near_misses": ("near miss", BLUE),
    "overlaps": ("overlap", VERMILION),
    "through": ("block between", ORANGE),
    "strips": ("strip", GREEN),
    "slivers": ("sliver", SKY),
}


def findings(model: Model, ax: Any = None, *, plane: str | None = None) -> Any:
    """Draw what :func:`limitblocks.diagnose` finds: a line between the two blocks, or a mark.

    Parameters
    ----------
    model : Model
    ax, plane
        As for :func:`structure`.

    Returns
    -------
    Axes
        The title says how accurate the faces are, and that nothing was found where nothing was.
    """
    diagnosis = diagnose(model)
    drawn = canvas(model, ax, plane)
    draw_structure(drawn, model, alpha=0.5)
    middle = {block.name: block.centroid for block in model.blocks}
    for kind, (word, colour) in _KINDS.items():
        pairs = [np.array([middle[one.block_i], middle[one.block_j]]) for one in getattr(diagnosis, kind)]
        if pairs:
            drawn.lines(pairs, colors=colour, linewidths=2.0, label=f"{word} ({len(pairs)})")
    for names, mark, word in (
        (diagnosis.isolated, "x", "isolated"),
        (diagnosis.uncarried, "v", "held by friction alone"),
    ):
        if names:
            points = np.array([middle[name] for name in names])
            drawn.plot(points, mark, color=BLACK, label=f"{word} ({len(points)})")
    drawn.title("\n".join([diagnosis.accuracy, *diagnosis.nothing]))
    if not diagnosis.nothing:
        drawn.legend()
    return drawn.ax

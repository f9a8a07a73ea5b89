"""Texts of a figure that run into each other or out of it, by their extents on the page."""

from itertools import combinations

import numpy as np
from matplotlib.text import Text
from mpl_toolkits.mplot3d.art3d import Text3D

TOUCH = 1.0  # points by which boxes may overlap: ascenders and descenders leave room
OUT = 2.0  # points by which a text may stand out of the figure


def texts(figure):
    """Visible texts that say something, but for ticks beyond the limits of their axis."""
    figure.canvas.draw()
    beyond = set()
    for axes in figure.axes:
        for axis in (getattr(axes, name, None) for name in ("xaxis", "yaxis")):
            if axis is None or getattr(axes, "name", "") == "3d":
                continue
            low, high = sorted(axis.get_view_interval())
            room = 1e-9 * max(abs(low), abs(high))
            for tick in (*axis.get_major_ticks(), *axis.get_minor_ticks()):
                if not low - room <= tick.get_loc() <= high + room:
                    beyond |= {tick.label1, tick.label2}
    drawn = (one for one in figure.findobj(Text) if one.get_visible() and one.get_text().strip())
    return [one for one in drawn if one not in beyond and is_drawn(one)]


def is_drawn(one):
    """Whether the axes that a text belongs to show it: those switched off show no ticks and labels."""
    axes = one.axes
    if isinstance(one, Text3D):  # placed by the projection while it is drawn: its extent is not known
        return False
    if axes is None or getattr(axes, "_axis3don", axes.axison):
        return True
    return one in {axes.title, *axes.texts}


def collisions(figure):
    """Pairs of texts that overlap, and texts outside the figure."""
    renderer = figure.canvas.get_renderer()
    point = figure.dpi / 72
    boxes = [(one.get_text(), one.get_window_extent(renderer)) for one in texts(figure)]
    found = []
    for (a, first), (b, second) in combinations(boxes, 2):
        wide = min(first.x1, second.x1) - max(first.x0, second.x0)
        high = min(first.y1, second.y1) - max(first.y0, second.y0)
        if min(wide, high) > TOUCH * point:
            found.append((a, b))
    page = figure.bbox
    for word, box in boxes:
        out = max(page.x0 - box.x0, page.y0 - box.y0, box.x1 - page.x1, box.y1 - page.y1)
        if out > OUT * point and np.isfinite(out):
            found.append((word, "outside the figure"))
    return found

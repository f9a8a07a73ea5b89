"""Texts of a figure that run into each other or out of it, by their extents on the page."""

from itertools import combinations

import numpy as np
from matplotlib.text import Text
from mpl_toolkits.mplot3d.art3d import Text3D

TOUCH = 1.0  # points by which boxes may overlap: ascenders and descenders leave room
OUT = 2.0  # points by which a text may stand out of the figure


def texts(figure):
    """Visible texts that say something, but for ticks beyond the limits of their axis, and in 3D."""
    figure.canvas.draw()
    left_out = {text for axes in figure.axes for text in _not_drawn(axes)}
    drawn = (one for one in figure.findobj(Text) if one.get_visible() and one.get_text().strip())
    return [one for one in drawn if one not in left_out and not isinstance(one, Text3D)]


def _not_drawn(axes):
    """Ticks and labels that are off or beyond the limits; in 3D those that only the drawing places."""
    solid = getattr(axes, "name", "") == "3d"
    for name in ("xaxis", "yaxis", "zaxis"):
        axis = getattr(axes, name, None)
        if axis is None:
            continue
        off = solid or not axes.axison or not axis.get_visible()
        along = axis.get_transform().transform  # of a logarithmic axis the logarithm
        low, high = sorted(along(axis.get_view_interval()))
        room = 1e-9 * (high - low)
        for tick in (*axis.get_major_ticks(), *axis.get_minor_ticks()):
            if off or not low - room <= along([tick.get_loc()])[0] <= high + room:
                yield from (tick.label1, tick.label2)
        if off:
            yield from (axis.label, axis.get_offset_text())


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

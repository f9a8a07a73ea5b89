"""Texts of a figure that run into each other or out of it, by their extents on the page."""

from itertools import combinations

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text
from mpl_toolkits.mplot3d.art3d import Text3D

TOUCH = 1.0  # points by which boxes may overlap: ascenders and descenders leave room
OUT = 2.0  # points by which a text may stand out of the figure


def _canvas(figure):
    """The canvas of a figure, one of pixels where it has none yet."""
    return figure.canvas if hasattr(figure.canvas, "get_renderer") else FigureCanvasAgg(figure)


def texts(figure):
    """Visible texts that say something, but for ticks beyond the limits of their axis, and in 3D."""
    _canvas(figure).draw()
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


def too_small(figure, least=7.0):
    """Texts below `least` points, as they are on the page."""
    return [(one.get_text(), one.get_fontsize()) for one in texts(figure) if one.get_fontsize() < least]


def covered(figure):
    """Legends and words written into axes that a line or a marker of them runs through."""
    _canvas(figure).draw()
    renderer, point = _canvas(figure).get_renderer(), figure.dpi / 72
    found = []
    for axes in figure.axes:
        if getattr(axes, "name", "") == "3d":
            continue
        words = [(one.get_text(), one.get_window_extent(renderer)) for one in axes.texts if one.get_visible()]
        legend = axes.get_legend()
        words += [("legend", legend.get_window_extent(renderer))] if legend else []
        for line in axes.lines:
            path = line.get_transform().transform_path(line.get_path())
            marks = line.get_marker() not in (None, "None", "")
            joined = line.get_linestyle() not in ("None", "")
            for word, box in words:
                inner = box.padded(-TOUCH * point)
                if (joined and path.intersects_bbox(inner, filled=False)) or (
                    marks and inner.count_contains(path.vertices)
                ):
                    found.append((word, f"covers {line.get_label()}"))
    return found


def collisions(figure):
    """Pairs of texts that overlap, and texts outside the figure."""
    renderer = _canvas(figure).get_renderer()
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

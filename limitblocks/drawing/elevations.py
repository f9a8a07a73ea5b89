"""Front, side and plan of a structure at one scale, with its overall dimensions."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from limitblocks.arrays import Array
from limitblocks.drawing import sheet
from limitblocks.drawing.sheet import WIDTH, Group, Label, Shape, Sheet
from limitblocks.drawing.silhouette import hulls
from limitblocks.drawing.ties import tie_lines
from limitblocks.drawing.view import PLANES
from limitblocks.model import Model

_TITLES = {"xz": "Front, seen along +Y", "yz": "Side, seen along -X", "xy": "Plan, seen from above"}
_LEFT, _RIGHT, _ABOVE, _BELOW = 95.0, 15.0, 40.0, 75.0  # room around a view for its title and dimensions
_OFF, _TICK = 30.0, 7.0  # distance of a line of dimensions from the view, and half the length of its ends
_TITLE = 220.0  # from the middle of a view to that of the next, so that their titles do not meet
_TALLEST = 560.0  # of the views, user units
_FINE = 1e-4  # of the size of the model, a tenth of a user unit: polygons as near as that are one


class _View(NamedTuple):
    """Polygons (k, 2) on the page, m, back to front, those of supports told apart; what is dimensioned.

    `ties` (t, 2, 2) are the anchors of ties.
    """

    plane: str
    polygons: list[tuple[Array, bool]]
    ties: Array
    low: Array
    high: Array
    free_low: Array
    free_high: Array


def elevations(model: Model) -> Sheet:
    """Return front, side and plan of `model` with its ties; dimensioned are the free blocks, as a whole."""
    front, side, plan = (_view(model, plane) for plane in PLANES)
    across = (front.high - front.low)[0], (side.high - side.low)[0]
    up = (front.high - front.low)[1], (plan.high - plan.low)[1]
    room = WIDTH - 2 * (_LEFT + _RIGHT)
    room -= max(_TITLE / 2 - _RIGHT - room / sum(across) * across[1] / 2, 0.0)  # of a narrow side view
    scale = float(min(room / sum(across), _TALLEST / sum(up)))
    spare = (room - scale * sum(across)) / 2
    below = _ABOVE + scale * up[0] + _BELOW
    middle = spare + _LEFT + scale * across[0] / 2
    beside = max(middle + scale * across[0] / 2 + _RIGHT + _LEFT, middle + _TITLE - scale * across[1] / 2)
    corners = {"xz": (spare + _LEFT, _ABOVE), "yz": (beside, _ABOVE), "xy": (spare + _LEFT, below + _ABOVE)}
    groups: list[Group] = []
    labels: list[Label] = []
    for view in (front, side, plan):
        more = _placed(view, scale, *corners[view.plane])
        groups += more[0]
        labels += more[1]
    said = ", ".join(f"{word} {length(size)}" for word, size in dimensions(model).items())
    text = f"Blocks that can move measure {said}."
    height = below + _ABOVE + scale * up[1] + _BELOW
    return Sheet("views", "Views", text, float(height), tuple(groups), tuple(labels))


def dimensions(model: Model) -> dict[str, float]:
    """Return the overall sizes, m, of the blocks that can move, along X, Y and Z."""
    points = np.concatenate([block.vertices for block in model.free_blocks])
    return dict(zip(("X", "Y", "Z"), np.ptp(points, axis=0).tolist(), strict=True))


def length(metres: float) -> str:
    """Return a length as text."""
    return f"{metres:.4g} m"


def _view(model: Model, plane: str) -> _View:
    view, supports = PLANES[plane], set(model.supports)
    order = sorted(model.blocks, key=lambda block: float((block.vertices @ view[2]).max()))
    corners = [block.vertices for block in model.blocks]
    grid = _FINE * float(np.ptp(np.concatenate(corners), axis=0).max())
    # of courses or columns one behind the other, one drawing says enough: that of the nearest
    seen: dict[tuple[tuple[float, ...], ...], tuple[Array, bool]] = {}
    for block, hull in zip(order, hulls([block.vertices for block in order], view), strict=True):
        key = tuple(sorted(map(tuple, ((hull / grid).round() + 0.0).tolist())))
        seen.pop(key, None)
        seen[key] = hull, block.name in supports
    anchors = np.array([line.anchors for line in tie_lines(model)]).reshape(-1, 2, 3)
    points = np.concatenate([*corners, anchors.reshape(-1, 3)]) @ view[:2].T
    free = np.concatenate([block.vertices for block in model.free_blocks]) @ view[:2].T
    ends = points.min(axis=0), points.max(axis=0), free.min(axis=0), free.max(axis=0)
    return _View(plane, list(seen.values()), anchors @ view[:2].T, *ends)


def _placed(view: _View, scale: float, left: float, top: float) -> tuple[list[Group], list[Label]]:
    def on_page(flat: Array) -> Array:
        return np.asarray((flat - [view.low[0], view.high[1]]) * [scale, -scale] + [left, top])

    blocks = [
        Group("support" if held else "still", "", (Shape(sheet.path(on_page(polygon)), "f0"),))
        for polygon, held in view.polygons
    ]
    ties = tuple(Shape(sheet.path(on_page(ends), closed=False)) for ends in view.ties)
    if ties:
        blocks.append(Group("tie-stick", "", ties))
    (x0, y1), (x1, y0) = on_page(np.array([view.free_low, view.free_high])).tolist()
    bottom = float(on_page(view.low[None])[0, 1]) + _OFF
    edge = left - _OFF
    size = (view.free_high - view.free_low).tolist()
    level = [[(x0, bottom), (x1, bottom)], *([(x, bottom - _TICK), (x, bottom + _TICK)] for x in (x0, x1))]
    upright = [[(edge, y0), (edge, y1)], *([(edge - _TICK, y), (edge + _TICK, y)] for y in (y0, y1))]
    lines = tuple(Shape(sheet.path(np.array(line), closed=False)) for line in (*level, *upright))
    middle = left + scale * (view.high - view.low)[0] / 2
    names = [name.upper() for name in view.plane]
    labels = [
        Label(float(middle), top - 18.0, _TITLES[view.plane], "middle title"),
        Label((x0 + x1) / 2, bottom + 24.0, f"{names[0]}: {length(size[0])}", "middle"),
        Label(edge - 12.0, (y0 + y1) / 2, f"{names[1]}: {length(size[1])}", "middle", upwards=True),
    ]
    return [*blocks, Group("dimension", "", lines)], labels

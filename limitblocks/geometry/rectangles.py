"""Plane areas whose sides all lie along two perpendicular directions, divided into rectangles."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely

from limitblocks.arrays import Array, Indices

#: Sums of squared areas closer than this, relative to them, count as equal.
_TIE = 1e-6


def rectangles(shape: Any, axes: Array, tolerance: float) -> list[Any]:
    """Divide an area with perpendicular sides into rectangles; none where sides are neither along nor across.

    All cuts run in one direction: the one that leaves fewer rectangles, as pressure that is free to gather in
    more of them twists too well; of as many the more even ones, by their squared areas; then across `axes`.

    Parameters
    ----------
    shape : shapely polygon
    axes : Array, shape (2, 2)
        Plane axes, columns, that move with the area: they settle ties and the order of the rectangles.
    tolerance : float
        Corners as near to a line along a side are on it, m.
    """
    points, ring = shapely.get_coordinates(shapely.get_rings(shape), return_index=True)
    sides = (np.diff(points, axis=0) @ axes @ (1.0, 1j))[np.diff(ring) == 0]
    # the fourth power is the same along and across; its branch is where hardly a pair of axes lies
    angle = np.angle((-1j * sides**4 / np.abs(sides) ** 3).sum()) / 4.0 + np.pi / 8.0
    frame = axes @ np.array([(np.cos(angle), -np.sin(angle)), (np.sin(angle), np.cos(angle))])
    flat = points @ frame
    on_lines, places = zip(*(_lines(along, tolerance) for along in flat.T), strict=True)
    snapped = np.column_stack([lines[k] for lines, k in zip(on_lines, places, strict=True)])
    steps = np.diff(np.column_stack(places), axis=0)[np.diff(ring) == 0]
    if (steps != 0).all(axis=1).any() or np.abs(snapped - flat).max() > tolerance:
        return []
    x, y = ((lines[1:] + lines[:-1]) / 2.0 for lines in on_lines)
    inside = shapely.contains_xy(shapely.set_coordinates(shape, snapped), x[:, None], y)
    if not inside.any():  # all narrower than the tolerance
        return []
    boxes = _fewest(inside, *on_lines)
    x, y = on_lines[0][boxes[:, :2]], on_lines[1][boxes[:, 2:]]
    corners = np.stack([x[:, [0, 1, 1, 0]], y[:, [0, 0, 1, 1]]], axis=-1) @ frame.T
    return list(shapely.polygons(corners))


def _lines(values: Array, tolerance: float) -> tuple[Array, Indices]:
    """Return the mean of each group of values with no gap beyond `tolerance`, and the group of each."""
    order = np.argsort(values, kind="stable")
    group = np.empty(len(values), dtype=np.intp)
    group[order] = np.cumsum(np.diff(values[order], prepend=values[order[0]]) > tolerance)
    return np.bincount(group, values) / np.bincount(group), group


def _fewest(inside: Any, x: Array, y: Array) -> Indices:
    """Return rectangles (p, 4), first and last line in x, then in y, of the cells that are `inside`."""
    across, along = _runs(inside), _runs(inside.T)[:, [2, 3, 0, 1]]
    uneven, other = (
        (len(b), (((x[b[:, 1]] - x[b[:, 0]]) * (y[b[:, 3]] - y[b[:, 2]])) ** 2).sum())
        for b in (across, along)
    )
    return along if (other[0], other[1] * (1.0 + _TIE)) < uneven else across


def _runs(inside: Any) -> Indices:
    """Return rows from and to, columns from and to, of runs of cells alike in rows that follow each other."""
    started: dict[tuple[int, int], int] = {}
    boxes: list[tuple[int, int, int, int]] = []
    for row, cells in enumerate([*inside, np.zeros(inside.shape[1], dtype=bool)]):
        ends = np.flatnonzero(np.diff(cells, prepend=False, append=False)).reshape(-1, 2)
        runs = [(first, last) for first, last in ends.tolist()]
        boxes += [(start, row, *run) for run, start in started.items() if run not in runs]
        started = {run: started.get(run, row) for run in runs}
    return np.array(sorted(boxes), dtype=np.intp)

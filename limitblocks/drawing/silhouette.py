"""The outline of bodies as seen, as one."""

from __future__ import annotations

from collections.abc import Sequence

import shapely

from limitblocks.arrays import Array


def hulls(points: Sequence[Array], view: Array) -> list[Array]:
    """Return the corners (k, 2) on the page of each convex body with vertices `points` (n, 3)."""
    shapes = shapely.convex_hull([shapely.multipoints(one @ view[:2].T) for one in points])
    # seen from the edge a hull is a line, which has no last corner to leave out
    ends = [None if shape.geom_type == "LineString" else -1 for shape in shapes]
    return [shapely.get_coordinates(shape)[:end] for shape, end in zip(shapes, ends, strict=True)]


def outlines(points: Sequence[Array], view: Array, slack: float) -> list[Array]:
    """Return the closed rings (k, 2) around convex bodies on the page; gaps below twice `slack` are closed.

    `view` has the rows right, up and towards the eye.
    """
    shapes = shapely.convex_hull([shapely.multipoints(one @ view[:2].T) for one in points])
    whole = shapely.union_all(shapely.buffer(shapes, slack, join_style="mitre"))
    rings = [ring for part in shapely.get_parts(whole) for ring in (part.exterior, *part.interiors)]
    return [shapely.get_coordinates(ring) for ring in rings]

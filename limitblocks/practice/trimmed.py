"""Opened joints that slid: what of their area both faces still share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import shapely

from limitblocks.arrays import Array, read_only
from limitblocks.geometry import Block
from limitblocks.geometry.patches import common_areas, common_part
from limitblocks.geometry.pieces import convex_pieces
from limitblocks.geometry.polygon import along_longest_side, centroids
from limitblocks.practice.contact import CLOSED, DisplacedContacts, seated
from limitblocks.practice.displaced import placed
from limitblocks.practice.resting import face_at, tilted

GRID = 1e-13  # of the size of the structure: the places of an overlay
OFF = 1e-6  # of the size of the structure: a corner as far beyond the rim of a face is off it


def trimmed(own: DisplacedContacts, blocks: Sequence[Block], size: float) -> list[DisplacedContacts]:
    """Return an opened joint where its closed corners are on both faces, in convex pieces.

    It is whole as long as they all are; where some are not, its area is cut to that of both faces. None is
    left once the hull of its closed corners is off. `size` is that of the structure, m.
    """
    closed = own.ways[:, 2] <= 10.0 * CLOSED * size
    if not closed.any():
        return [own]
    seen, point = own.half_way[0], own.rest[closed].mean(axis=0)
    faces = [
        face_at(blocks[k], out, point, seen[:2])
        for k, out in zip(own.ends[0], (own.axes_i[0, 2], -own.axes_j[0, 2]), strict=True)
    ]
    shared = common_part([face for face in faces if not face.is_empty], GRID * size)
    corners = shapely.points(own.rest[closed] @ seen[:2].T)
    if shapely.distance(shapely.MultiPoint(corners).convex_hull, shared) > OFF * size:
        return []
    if (shapely.distance(corners, shared) <= OFF * size).all():
        return [own]
    whole, least = shapely.Polygon(own.interface.corners @ seen[:2].T), np.array([(OFF * size) ** 2])
    (left,) = common_areas(np.array([whole]), np.array([shared]), least, OFF * size)
    parts = np.array([part for part in shapely.get_parts(left) if part.area > least[0]])
    pieces, _ = convex_pieces(parts, np.tile([1.0, 0.0], (len(parts), 1)), np.zeros(len(parts)), OFF * size)
    return [_on(own, blocks, size, np.array(piece.normalize().exterior.coords)[:0:-1]) for piece in pieces]


def _on(own: DisplacedContacts, blocks: Sequence[Block], size: float, flat: Array) -> DisplacedContacts:
    """Return the contact with corners (k, 2) seen along the axes half way between both faces."""
    seen, turned_i, turned_j = own.half_way[0], own.axes_i[0], own.axes_j[0]
    points = flat @ seen[:2]
    on_i, on_j = (
        points + ((there[0] - points) @ normal / (seen[2] @ normal))[:, None] * seen[2]
        for there, normal in ((own.on_i, turned_i[2]), (own.on_j, turned_j[2]))
    )
    _, turn, first = about_centroid(on_i @ turned_i[:2].T, turned_i[:2])
    axes_i = np.concatenate([turn @ turned_i[:2], turned_i[2:]])
    on_i, on_j = (np.roll(on, -first, axis=0) for on in (on_i, on_j))
    polygon = on_i @ axes_i[:2].T
    interface = replace(own.interface, polygon=read_only(polygon - centroids(polygon[None])[0]))
    axes = {"axes_i": axes_i[None], "axes_j": tilted(axes_i, turned_j[2])[None]}
    none = np.full((len(on_i), 1, 2), np.nan)
    on = {"on_i": on_i, "on_j": on_j, "rims_i": none, "rims_j": none}
    return seated(placed(replace(own, interfaces=(interface,), **on, **axes), blocks), blocks, size)


def about_centroid(polygon: Array, plane: Array) -> tuple[Array, Array, int]:
    """Return the centroid (2,) of a polygon, the turn (2, 2) to its longest side, and its first vertex."""
    first, turn = along_longest_side(polygon[None], plane[None])
    return centroids(polygon[None])[0], turn[0], int(first[0])

"""Which of many convex bodies hides which, seen from afar: the painter's order."""

from __future__ import annotations

from collections.abc import Sequence
from heapq import heapify, heappop, heappush
from typing import NamedTuple

import numpy as np
import shapely

from limitblocks.arrays import Array, Indices
from limitblocks.drawing.view import view_of
from limitblocks.geometry import polyhedron

TOUCHING = 1e-6  # of a body's size: less overlap on the page is none
INTERPENETRATION = 1e-2  # of a body's size: deeper, and no plane counts as separating


class Body(NamedTuple):
    """Block as placed: vertices (n, 3), unit normals (m, 3) and offsets (m,) of its faces."""

    points: Array
    normals: Array
    offsets: Array


def placed(points: Array, faces: polyhedron.Faces) -> Body:
    """Return the body of vertices `points` (n, 3) and `faces`."""
    mesh = polyhedron.mesh(faces)
    return Body(points, *polyhedron.face_planes(points, mesh, polyhedron.shape(points, mesh).area_vectors))


def painting_order(bodies: Sequence[Body], eye: Array) -> list[int]:
    """Return the order, back to front, in which convex bodies hide each other rightly.

    Of two bodies that overlap on the page, a face plane that separates them tells which is in front.
    Bodies in a ring of such pairs, or that interpenetrate, go by their depth.
    """
    if len(bodies) < 2:
        return list(range(len(bodies)))
    depth = np.array([float((body.points @ eye).mean()) for body in bodies])
    nearer: list[list[int]] = [[] for _ in bodies]
    waiting = [0] * len(bodies)
    for back, front in _hiding(bodies, eye, depth).tolist():
        nearer[back].append(front)
        waiting[front] += 1
    ready = [(depth[k], k) for k in range(len(bodies)) if not waiting[k]]
    heapify(ready)
    farthest = np.argsort(-depth).tolist()
    order: dict[int, None] = {}
    while len(order) < len(bodies):
        # in a ring nothing is ready: the farthest body goes first
        k = heappop(ready)[1] if ready else farthest.pop()
        if k in order:
            continue
        order[k] = None
        for front in nearer[k]:
            waiting[front] -= 1
            if not waiting[front]:
                heappush(ready, (depth[front], front))
    return list(order)


def _hiding(bodies: Sequence[Body], eye: Array, depth: Array) -> Indices:
    """Pairs (back, front) of bodies that overlap on the page, shape (p, 2)."""
    plane = view_of(eye)[:2].T
    hulls = shapely.convex_hull([shapely.multipoints(body.points @ plane) for body in bodies])
    # bodies that only touch on the page hide nothing: as pairs they could close rings
    size = np.array([np.ptp(body.points, axis=0).max() for body in bodies])
    inner = shapely.buffer(hulls, -TOUCHING * size, join_style="mitre")
    pairs = shapely.STRtree(inner).query(inner, predicate="intersects").T
    pairs = pairs[pairs[:, 0] < pairs[:, 1]]
    gaps, facing = _separation(bodies, pairs, eye)
    others, away = _separation(bodies, pairs[:, ::-1], eye)
    swapped = np.where(gaps >= others, facing <= 0.0, away > 0.0)  # the first body is in front
    deep = np.maximum(gaps, others) < -INTERPENETRATION * size[pairs].min(axis=1)
    swapped = np.where(deep, depth[pairs[:, 0]] > depth[pairs[:, 1]], swapped)
    return np.asarray(np.where(swapped[:, None], pairs[:, ::-1], pairs))


def _separation(bodies: Sequence[Body], pairs: Indices, eye: Array) -> tuple[Array, Array]:
    """Of the face of the first body of each pair that separates it best from the second: the gap, (p,).

    And the component of its normal towards the eye, (p,).
    """
    gaps, facing = np.zeros(len(pairs)), np.zeros(len(pairs))
    kinds = np.array([(len(body.normals), len(body.points)) for body in bodies])
    shapes = np.column_stack([kinds[pairs[:, 0], 0], kinds[pairs[:, 1], 1]])
    for shape in np.unique(shapes, axis=0):
        group = np.flatnonzero((shapes == shape).all(axis=1))
        normals = np.array([bodies[i].normals for i in pairs[group, 0]])
        offsets = np.array([bodies[i].offsets for i in pairs[group, 0]])
        points = np.array([bodies[j].points for j in pairs[group, 1]])
        apart = (normals @ points.swapaxes(1, 2)).min(axis=2) - offsets
        best = apart.argmax(axis=1)
        row = np.arange(len(group))
        gaps[group], facing[group] = apart[row, best], normals[row, best] @ eye
    return gaps, facing

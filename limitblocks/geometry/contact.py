"""Contact detection: the plane polygons through which blocks touch."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import shapely

from limitblocks.arrays import Array, Indices
from limitblocks.errors import ModelError
from limitblocks.geometry import polygon, polyhedron
from limitblocks.geometry.block import Block
from limitblocks.geometry.interface import Interface
from limitblocks.geometry.neighbours import overlapping_boxes
from limitblocks.geometry.overlap import refuse_overlaps

#: Least area of an interface, relative to the block length squared and to the smaller of the two faces.
SLIVER = 1e-3
#: Distance, relative to the root of an interface's area, below which vertices coincide or are collinear.
VERTEX_TOLERANCE = 1e-6


class _Faces(NamedTuple):
    """All faces of all blocks, one after the other: m faces, e face corners.

    `corners` (e, 3) and `first`, `count` (m,) say where each face's corners are; `middle` and `normal` are
    (m, 3); `low`, `high` (m, 3) bound the face; `start` and `number` (blocks,) say where each block's faces are.
    """

    corners: Array
    first: Indices
    count: Indices
    middle: Array
    normal: Array
    low: Array
    high: Array
    start: Indices
    number: Indices


class _Patches(NamedTuple):
    """Contact polygons in the plane midway between their faces: m face pairs `a`, `b`.

    `origin` (m, 3) and `frame` (m, 3, 3), rows t1, t2 and the normal out of the first block, place the plane
    coordinates of `shape` (m,), shapely polygons.
    """

    a: Indices
    b: Indices
    origin: Array
    frame: Array
    shape: Any


def find_interfaces(
    blocks: Sequence[Block], joint: object, *, gap: float = 1e-3, angle: float = 1e-2
) -> tuple[Interface, ...]:
    """Return the interfaces between plane faces of `blocks` that touch, in the order of blocks, then of faces.

    Two faces touch when their normals are opposed within `angle` and, at the centroid of the polygon common to
    both, their planes lie within `gap` block lengths; block length is the median over the blocks of the cube
    root of their volume. The interface lies midway between the two planes. Polygons with an area below 1e-3 of
    both the block length squared and the smaller face are dropped. Contacts at an edge or a vertex give none.

    Block i is the earlier of the two in `blocks`. Local axes: n points out of block i; s1 runs along the longest
    side of the polygon, traversed counter-clockwise about n; s2 = n x s1. Of sides equal within 1e-6 the one
    with the largest component along global X counts, then Y, then Z. The polygon has no collinear vertices and
    its last side, from the last vertex to the first, is the longest: a rectangle has the vertex order (+,-),
    (+,+), (-,+), (-,-) that Eqs (31)-(32) presuppose.

    Parameters
    ----------
    blocks : sequence of Block
    joint : object
        Given to every interface; a joint of :mod:`limitblocks.joints`.
    gap : float
        Tolerance on gaps and on interpenetration, in block lengths.
    angle : float
        Tolerance on opposed normals, rad.

    Raises
    ------
    ModelError
        Two blocks have the same name, or a tolerance is out of range.
    GeometryError
        Blocks interpenetrate deeper than the gap tolerance; lists all such pairs.
    """
    _refuse_bad_input(blocks, gap, angle)
    if len(blocks) < 2:
        return ()
    length = float(np.median(np.cbrt([block.volume for block in blocks])))
    tolerance = gap * length
    centre = np.mean([block.vertices[0] for block in blocks], axis=0)
    points = [block.vertices - centre for block in blocks]
    low, high = (
        np.array([bound(axis=0) for bound in bounds]) for bounds in zip(*[(p.min, p.max) for p in points])
    )
    pairs = overlapping_boxes(low - tolerance, high + tolerance)
    i, j = pairs.T
    deep = (np.minimum(high[i], high[j]) - np.maximum(low[i], low[j]) > tolerance).all(axis=1)
    refuse_overlaps(blocks, points, pairs[deep], tolerance)
    faces = _all_faces(blocks, points)
    patches = _clip(faces, *_opposed(faces, pairs, tolerance, angle), length)
    return _interfaces(blocks, centre, faces, _within(faces, patches, tolerance), joint)


def _refuse_bad_input(blocks: Sequence[Block], gap: float, angle: float) -> None:
    repeated = [name for name, times in Counter(block.name for block in blocks).items() if times > 1]
    faults = [f"several blocks are named {name!r}; names must be unique" for name in repeated]
    if not 0.0 < gap < 1.0:
        faults.append(f"gap is {gap!r}; a tolerance between 0 and 1 block lengths is needed")
    if not 0.0 < angle < np.pi / 4:
        faults.append(f"angle is {angle!r}; a tolerance between 0 and pi/4 rad is needed")
    if faults:
        raise ModelError(*faults)


def _all_faces(blocks: Sequence[Block], points: Sequence[Array]) -> _Faces:
    meshes = [polyhedron.mesh(block.faces) for block in blocks]
    corners = np.concatenate([body[mesh.start] for body, mesh in zip(points, meshes, strict=True)])
    count = np.array([len(face) for block in blocks for face in block.faces])
    first = np.cumsum(count) - count
    number = np.array([len(block.faces) for block in blocks])
    return _Faces(
        corners=corners,
        first=first,
        count=count,
        middle=np.add.reduceat(corners, first) / count[:, None],
        normal=np.concatenate([block.normals for block in blocks]),
        low=np.minimum.reduceat(corners, first),
        high=np.maximum.reduceat(corners, first),
        start=np.cumsum(number) - number,
        number=number,
    )


def _ranges(counts: Indices) -> tuple[Indices, Indices]:
    """Return for each count k its position, k times, and the numbers 0..k-1."""
    owner = np.repeat(np.arange(len(counts)), counts)
    return owner, np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)


def _opposed(faces: _Faces, pairs: Indices, tolerance: float, angle: float) -> tuple[Indices, Indices]:
    """Return the face pairs of `pairs` of blocks that may touch: opposed, close, with overlapping bounds."""
    i, j = pairs.T
    pair, k = _ranges(faces.number[i] * faces.number[j])
    a = faces.start[i][pair] + k // faces.number[j][pair]
    b = faces.start[j][pair] + k % faces.number[j][pair]
    away = faces.normal[a] + faces.normal[b]
    keep = np.einsum("ij,ij->i", away, away) <= (2.0 * np.sin(angle / 2.0)) ** 2
    a, b = a[keep], b[keep]
    keep = (faces.low[a] <= faces.high[b] + tolerance).all(axis=1)
    keep &= (faces.low[b] <= faces.high[a] + tolerance).all(axis=1)
    a, b = a[keep], b[keep]
    # within the angle, no part of face b is nearer to plane a than this
    slack = tolerance + angle * np.linalg.norm(faces.high[b] - faces.low[b], axis=1)
    keep = np.abs(np.einsum("ij,ij->i", faces.middle[b] - faces.middle[a], faces.normal[a])) <= slack
    return a[keep], b[keep]


def _clip(faces: _Faces, a: Indices, b: Indices, length: float) -> _Patches:
    """Return the polygons common to faces `a` and `b`, projected on the plane midway between them."""
    normal = faces.normal[a] - faces.normal[b]
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    t1 = np.cross(np.eye(3)[np.abs(normal).argmin(axis=1)], normal)
    t1 /= np.linalg.norm(t1, axis=1)[:, None]
    frame = np.stack([t1, np.cross(normal, t1), normal], axis=1)
    origin = faces.middle[a]
    first, second = (_projected(faces, face, origin, frame) for face in (a, b))
    # a common part that is not one polygon (a line, a point, nothing) has no area
    parts, pair = shapely.get_parts(shapely.intersection(first, second), return_index=True)
    least = SLIVER * np.minimum(length**2, np.minimum(shapely.area(first), shapely.area(second)))
    keep = shapely.area(parts) > least[pair]
    pair = pair[keep]
    return _Patches(a[pair], b[pair], origin[pair], frame[pair], parts[keep])


def _projected(faces: _Faces, face: Indices, origin: Array, frame: Array) -> Any:
    """Return `face` (m,) as shapely polygons in the coordinates of the first two axes of `frame` about `origin`."""
    owner, k = _ranges(faces.count[face])
    arms = faces.corners[faces.first[face][owner] + k] - origin[owner]
    return shapely.polygons(
        shapely.linearrings(np.einsum("kij,kj->ki", frame[owner, :2], arms), indices=owner)
    )


def _within(faces: _Faces, patches: _Patches, tolerance: float) -> _Patches:
    """Return the patches whose planes lie within `tolerance` at the centroid, with their origin moved midway."""
    middle = shapely.get_coordinates(shapely.centroid(patches.shape))
    normal = patches.frame[:, 2]
    place = patches.origin + np.einsum("ki,kij->kj", middle, patches.frame[:, :2])
    heights = [
        np.einsum("ij,ij->i", faces.middle[f] - place, faces.normal[f])
        / np.einsum("ij,ij->i", normal, faces.normal[f])
        for f in (patches.a, patches.b)
    ]
    keep = np.abs(heights[1] - heights[0]) <= tolerance
    origin = patches.origin + (heights[0] + heights[1])[:, None] / 2.0 * normal
    return _Patches(*(field[keep] for field in patches._replace(origin=origin)))


def _interfaces(
    blocks: Sequence[Block], centre: Array, faces: _Faces, patches: _Patches, joint: object
) -> tuple[Interface, ...]:
    names = [block.name for block in blocks]
    of = np.repeat(np.arange(len(blocks)), faces.number)
    rings = shapely.get_exterior_ring(patches.shape)
    rings = np.where(shapely.is_ccw(rings), rings, shapely.reverse(rings))
    points, owner = shapely.get_coordinates(rings, return_index=True)
    last = np.append(np.diff(owner) > 0, True)  # repeats the first vertex of its ring
    tolerance = VERTEX_TOLERANCE * np.sqrt(shapely.area(patches.shape))
    points, owner = polygon.clean(points[~last[: len(owner)]], owner[~last[: len(owner)]], tolerance)
    counts = np.bincount(owner, minlength=len(patches.a))
    found: dict[int, Interface] = {}
    for n in np.unique(counts):
        group = np.flatnonzero(counts == n)
        stack = points[counts[owner] == n].reshape(-1, n, 2)
        arrays = _local(stack, centre + patches.origin[group], patches.frame[group])
        sides = zip(of[patches.a[group]], of[patches.b[group]], strict=True)
        for k, (i, j), *values in zip(group, sides, *arrays, strict=True):
            found[k] = Interface(names[i], names[j], *values, joint)
    return tuple(found[k] for k in range(len(found)))


def _local(stack: Array, origin: Array, frame: Array) -> tuple[Array, Array, Array]:
    """Return centroids (m, 3), axes (m, 3, 3) and local polygons (m, n, 2), read-only, of polygons (m, n, 2)."""
    rows, n = np.arange(len(stack)), stack.shape[1]
    middle = polygon.centroids(stack)
    longest = polygon.longest_side(stack, frame[:, :2])
    # the polygon starts where its longest side ends
    ordered = stack[rows[:, None], (longest[:, None] + 1 + np.arange(n)) % n] - middle[:, None]
    s1 = ordered[:, 0] - ordered[:, -1]
    s1 /= np.hypot(s1[:, 0], s1[:, 1])[:, None]
    turn = np.stack([s1, np.stack([-s1[:, 1], s1[:, 0]], axis=1)], axis=1)
    axes = np.concatenate([turn @ frame[:, :2], frame[:, 2:]], axis=1)
    centroid = origin + np.einsum("ki,kij->kj", middle, frame[:, :2])
    arrays = centroid, axes, ordered @ turn.swapaxes(1, 2)
    for array in arrays:
        array.flags.writeable = False
    return arrays

"""Contact detection: the plane polygons through which blocks touch."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from operator import itemgetter
from typing import Any, NamedTuple

import numpy as np
import shapely

from limitblocks.arrays import Array, Indices
from limitblocks.errors import ModelError
from limitblocks.geometry import polygon
from limitblocks.geometry.block import Block
from limitblocks.geometry.faces import FaceTable, all_faces, opposed, ranges
from limitblocks.geometry.interface import Interface
from limitblocks.geometry.neighbours import overlapping_boxes
from limitblocks.geometry.overlap import refuse_overlaps

#: Least area of an interface, relative to the block length squared and to the smaller of the two faces.
SLIVER = 1e-3
#: Grid of the corners of interfaces, relative to the block length.
GRID = 1e-11
#: Distance from the line through its neighbours, relative to the root of the area, of a needless vertex.
VERTEX_TOLERANCE = 1e-6


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
    """Return the interfaces between plane faces of `blocks` that touch, ordered by blocks, then faces.

    Two faces touch when their normals are opposed within `angle` and, at the centroid of the polygon common
    to both, their planes lie within `gap` block lengths. Block length is the median over the blocks of the
    cube root of their volume. The interface lies midway between the two planes. Polygons with an area below
    1e-3 of the block length squared and of the smaller face, whichever is less, are dropped. Contacts along
    an edge or at a vertex give no interface.

    Block i is the earlier of the two in `blocks`. Local axes: n points out of block i; s1 runs along the
    longest side of the polygon, traversed counter-clockwise about n; s2 = n x s1. Of sides equal within 1e-6
    the one with the largest component along global X counts, then Y, then Z. The polygon has no collinear
    vertices, and the side from its last vertex to its first is the longest: a rectangle has the vertex order
    (+,-), (+,+), (-,+), (-,-) that Eqs (31)-(32) presuppose.

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
        Blocks have the same name, or a tolerance is out of range.
    GeometryError
        Blocks interpenetrate deeper than the gap tolerance; lists all such pairs.
    """
    _refuse_bad_input(blocks, gap, angle)
    if len(blocks) < 2:
        return ()
    length = float(np.median(np.cbrt([block.volume for block in blocks])))
    centre = np.mean([block.vertices[0] for block in blocks], axis=0)
    points = [block.vertices - centre for block in blocks]
    pairs = _neighbours(blocks, points, gap * length)
    faces = all_faces(blocks, points)
    patches = _clip(faces, *opposed(faces, pairs, gap * length, angle), length)
    return _interfaces(blocks, centre, faces, _within(faces, patches, gap * length), joint)


def _neighbours(blocks: Sequence[Block], points: Sequence[Array], tolerance: float) -> Indices:
    """Return the pairs (p, 2) of blocks whose bounds touch within `tolerance`, none of which may overlap."""
    low = np.array([body.min(axis=0) for body in points])
    high = np.array([body.max(axis=0) for body in points])
    pairs = overlapping_boxes(low - tolerance, high + tolerance)
    i, j = pairs.T
    deep = (np.minimum(high[i] - low[j], high[j] - low[i]) > tolerance).all(axis=1)
    refuse_overlaps(blocks, points, pairs[deep], tolerance)
    return pairs


def _refuse_bad_input(blocks: Sequence[Block], gap: float, angle: float) -> None:
    repeated = [name for name, times in Counter(block.name for block in blocks).items() if times > 1]
    faults = [f"several blocks are named {name!r}; names must be unique" for name in repeated]
    if not 0.0 < gap < 1.0:
        faults.append(f"gap is {gap!r}; a tolerance between 0 and 1 block lengths is needed")
    if not 0.0 < angle < np.pi / 4:
        faults.append(f"angle is {angle!r}; a tolerance between 0 and pi/4 rad is needed")
    if faults:
        raise ModelError(*faults)


def _clip(faces: FaceTable, a: Indices, b: Indices, length: float) -> _Patches:
    """Return the polygons common to faces `a` and `b`, projected on the plane midway between them."""
    normal = faces.normal[a] - faces.normal[b]
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    t1 = np.cross(np.eye(3)[np.abs(normal).argmin(axis=1)], normal)
    t1 /= np.linalg.norm(t1, axis=1)[:, None]
    frame = np.stack([t1, np.cross(normal, t1), normal], axis=1)
    origin = faces.middle[a]
    first, second = (_projected(faces, face, origin, frame) for face in (a, b))
    least = SLIVER * np.minimum(length**2, np.minimum(faces.area[a], faces.area[b]))
    bounds = np.stack([shapely.bounds(first), shapely.bounds(second)])
    extent = np.maximum(bounds[..., 2:].min(axis=0) - bounds[..., :2].max(axis=0), 0.0)
    near = np.flatnonzero(extent.prod(axis=1) > least)  # spares clipping faces that meet at an edge
    # a common part that is not one polygon (a line, a point, nothing) has no area
    # without a grid the intersection of two faces equal but for rounding can be a point
    common = shapely.intersection(first[near], second[near], grid_size=GRID * length)
    parts, pair = shapely.get_parts(common, return_index=True)
    keep = shapely.area(parts) > least[near[pair]]
    pair = near[pair[keep]]
    return _Patches(a[pair], b[pair], origin[pair], frame[pair], parts[keep])


def _projected(faces: FaceTable, face: Indices, origin: Array, frame: Array) -> Any:
    """Return `face` (m,) as shapely polygons in the first two axes of `frame` about `origin`."""
    owner, k = ranges(faces.sides[face])
    arms = faces.corners[faces.first[face][owner] + k] - origin[owner]
    points = np.einsum("kij,kj->ki", frame[owner, :2], arms)
    return shapely.polygons(shapely.linearrings(points, indices=owner))


def _within(faces: FaceTable, patches: _Patches, tolerance: float) -> _Patches:
    """Return the patches whose planes lie within `tolerance` at the centroid, moved midway."""
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
    blocks: Sequence[Block], centre: Array, faces: FaceTable, patches: _Patches, joint: object
) -> tuple[Interface, ...]:
    names = [block.name for block in blocks]
    rings = shapely.get_exterior_ring(patches.shape)
    rings = np.where(shapely.is_ccw(rings), rings, shapely.reverse(rings))
    points, owner = shapely.get_coordinates(rings, return_index=True)
    keep = np.diff(owner, append=-1) == 0  # the last vertex of a ring repeats its first
    tolerance = VERTEX_TOLERANCE * np.sqrt(shapely.area(patches.shape))
    points, owner = polygon.clean(points[keep], owner[keep], tolerance)
    counts = np.bincount(owner, minlength=len(patches.a))
    found: list[tuple[int, Interface]] = []
    for n in np.unique(counts):
        group = np.flatnonzero(counts == n)
        stack = points[counts[owner] == n].reshape(-1, n, 2)
        arrays = _local(stack, centre + patches.origin[group], patches.frame[group])
        ends = faces.block[patches.a[group]], faces.block[patches.b[group]]
        for k, i, j, c, t, p in zip(group.tolist(), *ends, *arrays, strict=True):
            found.append((k, Interface(names[i], names[j], c, t, p, joint)))
    return tuple(interface for _, interface in sorted(found, key=itemgetter(0)))


def _local(stack: Array, origin: Array, frame: Array) -> tuple[Array, Array, Array]:
    """Return read-only centroids (m, 3), axes (m, 3, 3), local polygons (m, n, 2) of a stack (m, n, 2)."""
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

"""Contact detection: the plane polygons through which blocks touch."""

from __future__ import annotations

import logging
from collections import Counter
from collections.abc import Sequence
from operator import itemgetter

import numpy as np
import shapely

from limitblocks.arrays import Array, Indices
from limitblocks.errors import ModelError, sequence_of
from limitblocks.geometry import polygon
from limitblocks.geometry.accuracy import ANGLE, GAP, Accuracy, Tolerances, block_length, chosen
from limitblocks.geometry.block import Block
from limitblocks.geometry.contacts import Contacts
from limitblocks.geometry.faces import FaceTable, all_faces, opposed
from limitblocks.geometry.findings import NearMiss, Overlap, Sliver, Through
from limitblocks.geometry.interface import Interface
from limitblocks.geometry.kinds import sorted_by_kind
from limitblocks.geometry.neighbours import neighbours
from limitblocks.geometry.overlap import find_overlaps
from limitblocks.geometry.patches import Patches, mean_width, patches, pieces_of

_log = logging.getLogger("limitblocks")
#: Distance from the line through its neighbours, relative to the root of the area, of a needless vertex.
VERTEX_TOLERANCE = 1e-6
#: Times the tolerances of blocks drawn exactly, and times those in use, that bound near misses.
NEAR, NEARLY = 10.0, 2.0


def find_interfaces(
    blocks: Sequence[Block],
    joint: object,
    *,
    gap: float | None = None,
    angle: float | None = None,
    width: float | None = None,
) -> tuple[Interface, ...]:
    """Return the interfaces between plane faces of `blocks` that touch, ordered by blocks, then faces.

    Two faces touch when their normals are opposed within `angle` and their planes lie within `gap` block
    lengths at every corner of the area common to both. Faces of a block that share an edge and lie in one
    plane, within half of both tolerances, count as one face. Block length is the median over the blocks of
    the cube root of their volume. The interface lies midway between the two planes. Areas below 1e-3 of the
    block length squared and of the smaller face, whichever is less, are dropped, and strips narrower than
    `width`: where stones meet at an edge they would be shear keys that are not there. Faces between which
    a third block lies do not touch. Contacts along an edge or at a vertex give no interface. Faces that
    nearly touch are logged as a warning; :func:`find_contacts` lists them and all that was dropped.

    Tolerances that are not given are chosen by the accuracy that the faces themselves show: half the
    variation of the gap over a joint, the median over all joints. The gap is six times this, the angle eight
    times the median angle between faces that touch, but at least 1e-3 block lengths and 1e-2 rad, which is
    what blocks drawn exactly get; the width is the gap. :class:`Tolerances` says what was used.

    A convex area is one interface. Any other is divided into convex polygons, an interface each: rectangles
    where its sides lie along two perpendicular directions. Corners within `gap` block lengths of the line
    through their neighbours, and holes as small, are left out of it first. The division does not depend on
    the place of the blocks or their order.

    Block i is the earlier of the two in `blocks`. Local axes: n points out of block i; s1 runs along the
    longest side of the polygon, traversed counter-clockwise about n; s2 = n x s1. Of sides equal within 1e-6
    the one with the largest component along global X counts, then Y, then Z; where they are at less than 60
    degrees, as the legs of an isosceles trapezoid, s1 runs along their mean. The polygon has no collinear
    vertices, and the side from its last vertex to its first is the longest: a rectangle has the vertex order
    (+,-), (+,+), (-,+), (-,-) that Eqs (31)-(32) presuppose.

    Parameters
    ----------
    blocks : sequence of Block
    joint : object
        Given to every interface, a joint of :mod:`limitblocks.joints`; or a function that gives the joint of
        two blocks, such as :meth:`limitblocks.joints.Materials.between`.
    gap : float, optional
        Tolerance on gaps and on interpenetration, in block lengths.
    angle : float, optional
        Tolerance on opposed normals, rad.
    width : float, optional
        Least mean width of an interface, in block lengths.

    Raises
    ------
    ModelError
        Blocks have the same name, or a tolerance is out of range.
    GeometryError
        Blocks interpenetrate deeper than the gap tolerance, or than half the mean thickness of the thinner
        one; lists all such pairs. Or no gap is given and the blocks are so inaccurate that load factors would
        be wrong by more than 1 %: an accuracy beyond 2e-3 block lengths.
    """
    contacts = find_contacts(blocks, joint, gap=gap, angle=angle, width=width)
    contacts.require()
    for line in contacts.near_words:
        _log.warning("%s", line)
    return contacts.interfaces


def find_contacts(
    blocks: Sequence[Block],
    joint: object,
    *,
    gap: float | None = None,
    angle: float | None = None,
    width: float | None = None,
) -> Contacts:
    """Return the interfaces of :func:`find_interfaces` and what was seen beside them.

    Near misses lie beyond a tolerance, but within 1e-2 block lengths and 0.1 rad, or twice both tolerances
    where that is more. Slivers are contacts whose area is too small for an interface, strips those too
    narrow. Blocks that overlap, and what is too inaccurate, are listed, not refused.

    Parameters
    ----------
    blocks, joint, gap, angle, width
        As for :func:`find_interfaces`.

    Raises
    ------
    ModelError
        Blocks have the same name, or a tolerance is out of range.
    """
    blocks = _checked(blocks, joint)
    names = [block.name for block in blocks]
    if len(blocks) < 2:
        return Contacts((), (), (), tuple(names), (), tolerances=chosen(gap, angle, width))
    length = block_length(blocks)
    centre = np.mean([block.vertices[0] for block in blocks], axis=0)
    points = [block.vertices - centre for block in blocks]
    every = neighbours(points, NEAR * GAP * length)
    used = chosen(gap, angle, width, Accuracy.of(blocks, points, every))
    tolerance, reach = used.gap * length, max(NEAR * GAP, NEARLY * used.gap) * length
    pairs = every if reach <= NEAR * GAP * length else neighbours(points, reach)
    overlaps = find_overlaps(blocks, points, pairs, tolerance)
    faces = all_faces(blocks, points, tolerance / 2.0, used.angle / 2.0)
    turn = min(max(NEAR * ANGLE, NEARLY * used.angle), np.pi / 4)
    facing = patches(faces, *opposed(faces, pairs, reach, turn), length)
    seen = sorted_by_kind(faces, facing, used, length, reach)
    pieces = pieces_of(faces, seen.meant, np.array(names), tolerance)
    ends = np.column_stack([faces.block[seen.meant.a], faces.block[seen.meant.b]])
    return Contacts(
        _interfaces(blocks, centre, faces, pieces, joint),
        _near_misses(names, faces, seen.apart, overlaps),
        overlaps,
        tuple(names[k] for k in np.setdiff1d(np.arange(len(names)), ends)),
        _slivers(names, faces, seen.small),
        strips=_slivers(names, faces, seen.narrow),
        through=_through(names, faces, seen.held, seen.third),
        tolerances=used,
        length=length,
        facets=int(np.median(np.unique(ends, axis=0, return_counts=True)[1])) if len(ends) else 0,
        chosen=gap is None,
    )


def nearly_tied(blocks: Sequence[Block], loose: set[str], used: Tolerances | None) -> str:
    """Return the nearest miss between loose blocks and others, as a clause; empty where there is none.

    Where its faces are too far from parallel, the clause gives the tolerances that take it as touching.
    """
    asked = {key: getattr(used, key, None) for key in ("gap", "angle", "width")}
    found = find_contacts(blocks, None, **asked)
    across = [one for one in found.near_misses if (one.block_i in loose) != (one.block_j in loose)]
    if not across:
        return ""
    nearest = min(across, key=lambda one: abs(one.gap))
    angle, gap = 1.1 * nearest.angle, 1.1 * abs(nearest.gap) / found.length
    wider = [f"--angle {angle:.2g}"] + [f"--gap {gap:.2g}"] * (gap > found.tolerances.gap)
    remedy = f", which import {' '.join(wider)} takes as touching"
    return f"; nearly touching: {nearest}{remedy * (nearest.angle > found.tolerances.angle)}"


def _checked(blocks: Sequence[Block], joint: object) -> tuple[Block, ...]:
    if isinstance(joint, type):
        raise ModelError(
            f"joint is the class {joint.__name__}, expected one made of it: {joint.__name__}(...)"
        )
    blocks = sequence_of("blocks", blocks, Block)
    repeated = [name for name, times in Counter(block.name for block in blocks).items() if times > 1]
    if repeated:
        raise ModelError(*(f"several blocks are named {name!r}; names must be unique" for name in repeated))
    return blocks


def _ends(names: Sequence[str], faces: FaceTable, patches: Patches) -> list[tuple[str, str]]:
    blocks = faces.block[patches.a].tolist(), faces.block[patches.b].tolist()
    return [(names[i], names[j]) for i, j in zip(*blocks, strict=True)]


def _near_misses(
    names: Sequence[str], faces: FaceTable, almost: Patches, overlaps: Sequence[Overlap]
) -> tuple[NearMiss, ...]:
    within = {(one.block_i, one.block_j) for one in overlaps}
    numbers = np.column_stack([almost.gap, almost.angle, shapely.area(almost.shape)]).tolist()
    rows = zip(_ends(names, faces, almost), numbers, strict=True)
    return tuple(NearMiss(*ends, *values) for ends, values in rows if ends not in within)


def _slivers(names: Sequence[str], faces: FaceTable, patches: Patches) -> tuple[Sliver, ...]:
    numbers = np.column_stack([shapely.area(patches.shape), mean_width(patches.shape)]).tolist()
    return tuple(Sliver(*ends, *row) for ends, row in zip(_ends(names, faces, patches), numbers, strict=True))


def _through(names: Sequence[str], faces: FaceTable, patches: Patches, third: Indices) -> tuple[Through, ...]:
    gaps, rows = patches.gap.tolist(), zip(_ends(names, faces, patches), third.tolist(), strict=True)
    return tuple(Through(*ends, names[k], gap) for (ends, k), gap in zip(rows, gaps, strict=True))


def _interfaces(
    blocks: Sequence[Block], centre: Array, faces: FaceTable, patches: Patches, joint: object
) -> tuple[Interface, ...]:
    """Return an interface for each convex patch, in their order."""
    rings = shapely.get_exterior_ring(patches.shape)
    rings = np.where(shapely.is_ccw(rings), rings, shapely.reverse(rings))
    points, owner = shapely.get_coordinates(rings, return_index=True)
    keep = np.diff(owner, append=-1) == 0  # the last vertex of a ring repeats its first
    tolerance = VERTEX_TOLERANCE * np.sqrt(shapely.area(patches.shape))
    points, owner = polygon.clean(points[keep], owner[keep], tolerance)
    counts = np.bincount(owner, minlength=len(patches.a))
    made: list[tuple[int, Interface]] = []
    for n in np.unique(counts):
        group = np.flatnonzero(counts == n)
        stack = points[counts[owner] == n].reshape(-1, n, 2)
        arrays = _local(stack, centre + patches.origin[group], patches.frame[group])
        ends = faces.block[patches.a[group]], faces.block[patches.b[group]]
        for k, i, j, c, t, p in zip(group.tolist(), *ends, *arrays, strict=True):
            a, b = blocks[i], blocks[j]
            law = joint(a, b) if callable(joint) else joint
            made.append((k, Interface(a.name, b.name, c, t, p, law)))
    return tuple(interface for _, interface in sorted(made, key=itemgetter(0)))


def _local(stack: Array, origin: Array, frame: Array) -> tuple[Array, Array, Array]:
    """Return read-only centroids (m, 3), axes (m, 3, 3), local polygons (m, n, 2) of a stack (m, n, 2)."""
    rows, n = np.arange(len(stack)), stack.shape[1]
    middle = polygon.centroids(stack)
    first, turn = polygon.along_longest_side(stack, frame[:, :2])
    ordered = stack[rows[:, None], (first[:, None] + np.arange(n)) % n] - middle[:, None]
    axes = np.concatenate([turn @ frame[:, :2], frame[:, 2:]], axis=1)
    centroid = origin + np.einsum("ki,kij->kj", middle, frame[:, :2])
    arrays = centroid, axes, ordered @ turn.swapaxes(1, 2)
    for array in arrays:
        array.flags.writeable = False
    return arrays

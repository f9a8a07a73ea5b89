"""Polygons of several solids told apart: each closed surface is a solid."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from limitblocks.arrays import Array, Indices, tied
from limitblocks.geometry.coplanar import area_vectors
from limitblocks.geometry.cracks import clusters, edges_of, renumbered, sides_of
from limitblocks.geometry.mend import WELD
from limitblocks.geometry.neighbours import bounds_of
from limitblocks.geometry.polyhedron import Faces
from limitblocks.io.solid import Solid


def solids(name: str, layer: str, vertices: npt.ArrayLike, faces: Sequence[Sequence[int]]) -> list[Solid]:
    """Return the solids that `faces` over `vertices` (n, 3) enclose, all of one name and layer.

    Faces belong to one solid that share edges by their indices, else by the places of their vertices. Where
    touching solids share edges, a solid ends where its surface closes, in the order of the faces. What does
    not close is left together, for :func:`limitblocks.geometry.mend.mended` to say what is wrong. Cavities
    are faces of the solid around them: surfaces that point inward inside one that points outward.
    """
    points = np.asarray(vertices, dtype=np.float64).reshape(-1, 3)
    return [Solid(name, layer, points[one.vertices], one.faces) for one in surfaces(name, points, faces)]


def worded(
    name: str,
    points: Array,
    faces: Sequence[Sequence[int]],
    owner: Sequence[int],
    words: Sequence[Mapping[str, Any]],
) -> list[Solid]:
    """Return the solids as `solids` does, each with the words that most of its faces have.

    `owner` has for each face the place of its words, keys of :data:`limitblocks.io.solid.WORDS`, in `words`.
    """
    found = surfaces(name, points, faces)
    most = [Counter(owner[k] for k in one.which).most_common(1)[0][0] for one in found]
    return [
        Solid(name, vertices=points[one.vertices], faces=one.faces, **words[k])
        for one, k in zip(found, most, strict=True)
    ]


class Surface(NamedTuple):
    """A closed surface: its vertices among those given, its faces over these, and which ones they are."""

    vertices: Indices
    faces: Faces
    which: Sequence[int]


def surfaces(name: str, points: Array, faces: Sequence[Sequence[int]]) -> list[Surface]:
    """Return the surface of each solid that `faces` over `points` (n, 3) enclose; see `solids`."""
    loops = tuple(map(tuple, faces))
    if not loops:
        return []
    groups = _groups(name, points, loops) if _in_range(points, loops) else [list(range(len(loops)))]
    if len(groups) > 1:
        groups = _with_cavities(points, loops, groups)
    bodies = []
    for group in groups:
        used, number = np.unique(np.concatenate([loops[k] for k in group]), return_inverse=True)
        if len(groups) == 1:
            return [Surface(np.arange(len(points)), loops, range(len(loops)))]
        ends = np.cumsum([len(loops[k]) for k in group])[:-1]
        parts = tuple(tuple(part.tolist()) for part in np.split(number.reshape(-1), ends))
        bodies.append(Surface(used, parts, group))
    return bodies


def _in_range(points: Array, loops: Faces) -> bool:
    """Return whether the faces can be told apart at all; what is wrong with one solid is said of it later."""
    try:
        corners = np.concatenate([np.asarray(loop, dtype=np.int64) for loop in loops])
    except OverflowError:
        return False
    sound = len(corners) > 0 and corners.min() >= 0 and corners.max() < len(points)
    return (
        bool(sound) and min(map(len, loops)) > 0 and bool((np.abs(points[np.unique(corners)]) < 1e30).all())
    )


def _groups(name: str, points: Array, loops: Faces) -> list[list[int]]:
    """Return the faces of each solid."""
    corners = np.concatenate(loops)
    used = np.unique(corners)
    if len(used) < len(corners):  # else each face has vertices of its own
        parts, closed = _parts(loops)
        if closed.all():
            return parts
    number = np.zeros(len(points), dtype=np.int64)
    distinct, place = np.unique(points[used], axis=0, return_inverse=True)
    number[used] = place.reshape(-1)
    exact = renumbered(loops, number)
    parts, closed = _parts(exact)
    if closed.all():
        return parts
    near = clusters(name, distinct, WELD * float(np.ptp(distinct, axis=0).max()))
    for welded in (exact, renumbered(loops, near[number])):
        by_order = _by_order(welded)
        if by_order:
            return by_order
    parts, closed = _parts(renumbered(loops, near[number]))
    rest = [k for part, whole in zip(parts, closed, strict=True) if not whole for k in part]
    return [part for part, whole in zip(parts, closed, strict=True) if whole] + ([rest] if rest else [])


def _parts(loops: Faces) -> tuple[list[list[int]], npt.NDArray[np.bool_]]:
    """Return the faces that edges tie together, and whether each edge of them belongs to two of them."""
    sides, owner = sides_of(loops)
    _, edge, uses = edges_of(sides)
    order = np.argsort(edge, kind="stable")
    same = np.flatnonzero(np.diff(edge[order]) == 0)
    part = tied(np.column_stack([owner[order[same]], owner[order[same + 1]]]), len(loops))
    count = int(part.max(initial=-1)) + 1
    closed = np.ones(count, dtype=bool)
    closed[part[owner[uses[edge] != 2]]] = False
    by_part = np.argsort(part, kind="stable")
    members = np.split(by_part, np.cumsum(np.bincount(part, minlength=count))[:-1])
    return [group.tolist() for group in members], closed


def _by_order(loops: Faces) -> list[list[int]]:
    """Return the runs of faces that close one after the other; nothing where the last stays open."""
    sides, owner = sides_of(loops)
    _, edge, _ = edges_of(sides)
    starts = np.flatnonzero(np.diff(owner, prepend=-1))
    groups: list[list[int]] = [[]]
    rim: set[int] = set()
    for face, sides in enumerate(np.split(edge, starts[1:])):
        groups[-1].append(face)
        rim.symmetric_difference_update(sides.tolist())
        if not rim:
            groups.append([])
    return groups[:-1] if not groups[-1] else []


def _with_cavities(points: Array, loops: Faces, groups: list[list[int]]) -> list[list[int]]:
    """Return the groups, those that point inward inside another put to it: they are its cavities."""
    shells = [tuple(loops[k] for k in group) for group in groups]
    bodies = [points[np.unique(np.concatenate(shell))] for shell in shells]
    low, high = bounds_of(bodies)
    volumes = np.array([_flux(points, shell) for shell in shells])
    if len(groups) == 2 and volumes.sum() < 0.0:  # a hollow block inside out, which is turned later
        volumes = -volumes
    whole = {int(k): list(groups[k]) for k in np.flatnonzero(volumes >= 0.0)}
    for k in np.flatnonzero(volumes < 0.0).tolist():
        around = (volumes > -volumes[k]) & (low < low[k]).all(axis=1) & (high > high[k]).all(axis=1)
        if whole and around.any():
            whole[int(np.where(around, volumes, np.inf).argmin())] += groups[k]
        else:
            whole[k] = list(groups[k])
    return [whole[k] for k in sorted(whole)]


def _flux(points: Array, shell: Faces) -> float:
    """Return three times the signed volume of a shell."""
    arms = points[[loop[0] for loop in shell]] - points[shell[0][0]]
    return float((area_vectors(points, shell) * arms).sum())


def soup(loops: Sequence[Array]) -> tuple[Array, list[range]]:
    """Return vertices (n, 3) and faces of polygons given by their corners (k, 3), which share no vertex."""
    ends = np.cumsum([len(loop) for loop in loops])
    return np.concatenate(loops), [
        range(end - len(loop), end) for end, loop in zip(ends.tolist(), loops, strict=True)
    ]

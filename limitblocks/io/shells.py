"""Polygons of several solids told apart: each closed surface is a solid."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from limitblocks.arrays import Array, Indices, tied
from limitblocks.geometry.coplanar import area_vectors
from limitblocks.geometry.cracks import clusters, edges_of, renumbered, sides_of
from limitblocks.geometry.mend import WELD, closes
from limitblocks.geometry.neighbours import bounds_of
from limitblocks.geometry.polyhedron import Faces, compacted
from limitblocks.geometry.surface import winding
from limitblocks.io.solid import Solid

#: Parts of faces over vertices, and which of them are closed.
_Split = Callable[[Array, Faces], tuple[list[list[int]], list[bool]]]


def solids(name: str, layer: str, vertices: npt.ArrayLike, faces: Sequence[Sequence[int]]) -> list[Solid]:
    """Return the solids that `faces` over `vertices` (n, 3) enclose, all of one name and layer.

    Faces belong to one solid that share edges by their indices, else by the places of their vertices. Where
    touching solids share edges, a solid ends where its surface closes, in the order of the faces. A part that
    does not close is a solid where mending closes it. What is left over is left together, for
    :func:`limitblocks.geometry.mend.mended` to say what is wrong. Cavities
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

    `owner` has for each face the place of its words, keys of `limitblocks.geometry.block.WORDS`, in `words`.
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
    if len(groups) == 1:
        return [Surface(np.arange(len(points)), loops, range(len(loops)))]
    return [Surface(*compacted(tuple(loops[k] for k in group)), group) for group in groups]


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
    """Return the faces of each solid; those of which no way makes solids are one."""
    found: list[list[int]] = []
    left = list(range(len(loops)))
    for split, number in _ways(name, points, loops):
        parts, closed = split(points, renumbered(tuple(loops[k] for k in left), number))
        rest: list[int] = []
        for part, whole in zip(parts, closed, strict=True):
            faces = [left[k] for k in part]
            if whole or closes(points, [loops[k] for k in faces]):
                found.append(faces)
            else:
                rest += faces
        if not rest:
            return sorted(found)
        left = sorted(rest)
    return sorted([*found, left])


def _ways(name: str, points: Array, loops: Faces) -> Iterator[tuple[_Split, Indices]]:
    """Yield ways to tell solids apart, each with the vertex that stands for every one of `points`."""
    corners = np.concatenate(loops)
    used = np.unique(corners)
    number = np.arange(len(points))
    if len(used) < len(corners):  # else each face has vertices of its own
        yield _parts, number
    distinct, first, place = np.unique(points[used], axis=0, return_index=True, return_inverse=True)
    exact = number.copy()
    exact[used] = used[first][place.reshape(-1)]
    yield _parts, exact
    yield _by_order, exact
    near = clusters(name, distinct, WELD * float(np.ptp(distinct, axis=0).max()))
    number[used] = used[first][near][place.reshape(-1)]
    yield _parts, number
    yield _by_order, number


def _parts(points: Array, loops: Faces) -> tuple[list[list[int]], list[bool]]:
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
    return [group.tolist() for group in members], closed.tolist()


def _by_order(points: Array, loops: Faces) -> tuple[list[list[int]], list[bool]]:
    """Return the runs of faces that close one after the other, and what is between them; see `_Split`.

    A run closes where the sides without a second face are those from before it again.
    """
    sides, owner = sides_of(loops)
    _, edge, uses = edges_of(sides)
    mark = np.random.default_rng(0).integers(2**63, size=len(uses))[edge]
    mark[sides[:, 0] == sides[:, 1]] = 0
    starts = np.flatnonzero(np.diff(owner, prepend=-1))
    rims = np.bitwise_xor.accumulate(np.bitwise_xor.reduceat(mark, starts))
    runs: list[list[int]] = []
    between: list[list[int]] = []  # before each run, and after the last
    begin, seen = 0, {0: 0}
    for k, rim in enumerate(rims.tolist(), 1):
        start = seen.get(rim)
        if start is not None and not _flat(points, loops[start:k]):
            between.append(list(range(begin, start)))
            runs.append(list(range(start, k)))
            begin, seen = k, {}
        seen[rim] = k
    between.append(list(range(begin, len(loops))))
    between = _put_to(runs, between, loops)
    runs = _once(runs, loops)
    return [*runs, *between], [True] * len(runs) + [False] * len(between)


def _once(runs: list[list[int]], loops: Faces) -> list[list[int]]:
    """Return the runs, those with the same faces as one: a solid whose faces are all drawn twice."""
    same: dict[frozenset[frozenset[int]], list[int]] = {}
    for run in runs:
        same.setdefault(frozenset(frozenset(loops[f]) for f in run), []).extend(run)
    return list(same.values())


def _flat(points: Array, loops: Faces) -> bool:
    """Return whether faces lie in one plane: two sides of a joint, or faces without area."""
    corners = points[np.unique(np.concatenate(loops))]
    arms = corners - corners[0]
    return bool(np.linalg.matrix_rank(arms, tol=WELD * np.abs(arms).max()) < 3)


def _put_to(runs: list[list[int]], between: list[list[int]], loops: Faces) -> list[list[int]]:
    """Put what is between runs to the one beside it where it is too little for a solid; return the others.

    Faces without area, and those that repeat one of the run, count for nothing.
    """
    others = []
    for k, faces in enumerate(between):
        beside = []
        for run in runs[max(k - 1, 0) : k + 1] if faces else ():
            known = {frozenset(loops[f]) for f in run}
            new = sum(len(set(loops[f])) > 2 and frozenset(loops[f]) not in known for f in faces)
            beside.append((new, run))
        new, run = min(beside, key=lambda one: one[0], default=(4, faces))
        if new < 4:
            run.extend(faces)
        elif faces:
            others.append(faces)
    return others


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
        hosts = [
            j for j in np.flatnonzero(around).tolist() if winding(bodies[k][0], _fans(points, shells[j]))
        ]
        if hosts:
            whole[min(hosts, key=volumes.__getitem__)] += groups[k]
        else:
            whole[k] = list(groups[k])
    return [whole[k] for k in sorted(whole)]


def _fans(points: Array, shell: Faces) -> Array:
    """Return triangles (t, 3, 3) from the first corner of each face; those outside it count negative."""
    return points[[(loop[0], *pair) for loop in shell for pair in itertools.pairwise(loop[1:])]]


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

"""A block from the polygons of one solid as other programs write them: welded, closed, turned outward."""

from __future__ import annotations

import operator
import reprlib
from collections.abc import Iterable, Sequence

import numpy as np
import numpy.typing as npt

from limitblocks.arrays import Array, Indices, tied
from limitblocks.errors import GeometryError
from limitblocks.geometry import coplanar
from limitblocks.geometry.block import Block
from limitblocks.geometry.cracks import closed, clusters, edges_of, open_sides, renumbered, sides_of, tidy
from limitblocks.geometry.given import wrong
from limitblocks.geometry.polyhedron import PLANE_TOLERANCE, Faces, compacted, odd_places
from limitblocks.geometry.twisted import Twisted, fitted, triangulated, warps
from limitblocks.shown import many

#: Distance, relative to the block's size, below which two vertices are one.
WELD = 1e-6
#: Width, relative to the block's size, of a crack between faces that is closed.
CRACK = 5e-4
#: Plane faces of a block; a finer mesh costs time and says nothing more.
_MOST_FACES = 5000
_MOST_POLYGONS = 200_000  # before those in one plane are merged


def mended(
    name: str,
    vertices: npt.ArrayLike,
    faces: Iterable[Sequence[int]],
    twisted: Twisted = "refuse",
) -> tuple[Block, tuple[str, ...]]:
    """Return the block enclosed by the polygons of one solid, and what had to be mended, a line each.

    Vertices within 1e-6 of the block's size become one; faces without area and repeated faces go; cracks up
    to 5e-4 of the size are closed, with vertices that lie on the edge of another face; faces are turned
    counter-clockwise seen from outside; adjacent faces in one plane become one face. What every triangle file
    needs (equal vertices, triangles in one plane) is not worth a note.

    Parameters
    ----------
    name : str
        Name of the block.
    vertices : array_like, shape (n, 3)
        Global axes, m.
    faces : iterable of sequences of int
        Vertex indices around each face, in either sense.
    twisted : {"refuse", "triangulate", "fit"}
        What becomes of faces whose corners lie in no plane, within 1e-3 of the block's size: an error;
        triangles; or planes that fit the corners best, into which the vertices go.

    Raises
    ------
    TwistedFaces
        Faces lie in no plane, and are to be refused or cannot be fitted.
    GeometryError
        The polygons do not enclose one solid, or it is no block; names the block and the place.
    """
    points, loops = _checked(name, vertices, faces)
    given = points
    notes: list[str] = []
    size = float(np.ptp(points, axis=0).max())
    points, loops = _closed_up(name, points, loops, size, notes)
    if not loops:
        wrong(name, f"no face has an area; a solid is needed{odd_places(given)}")
    loops = _outward(name, points, loops, notes)
    loops, warp = coplanar.merged(points, loops, size, _MOST_FACES)
    if len(loops) > _MOST_FACES:
        wrong(
            name,
            f"it has more than {_MOST_FACES} plane faces, the most that are taken; make the mesh "
            "coarser, as by decimation in the program that wrote it",
        )
    if warp > WELD * size:
        notes.append(f"faces made of several pieces are flat within {warp:.2g} m, and taken as flat")
    points, loops = _untwisted(name, points, loops, size, twisted, notes)
    used, rings = compacted(loops)
    block = Block(name, points[used], rings)
    return block, tuple(f"block {name!r}: {note}" for note in notes)


class TwistedFaces(GeometryError):
    """Faces of a block lie in no plane; `distance` is how far a corner is out of its plane at most, m."""

    def __init__(self, problem: str, distance: float) -> None:
        super().__init__(problem)
        self.distance = distance


def closes(vertices: npt.ArrayLike, faces: Iterable[Sequence[int]]) -> bool:
    """Return whether polygons are one closed surface once vertices are welded and cracks closed."""
    try:
        points, loops = _checked("", vertices, faces)
        _, loops = _closed_up("", points, loops, float(np.ptp(points, axis=0).max()), [])
    except GeometryError:
        return False
    sides, owner = sides_of(loops)
    _, edge, uses = edges_of(sides)
    if not loops or (uses != 2).any():
        return False
    return not tied(owner[np.argsort(edge, kind="stable")].reshape(-1, 2), len(loops)).any()


def _closed_up(name: str, points: Array, loops: Faces, size: float, notes: list[str]) -> tuple[Array, Faces]:
    """Return vertices and faces welded, without what has no area or repeats, and with cracks closed."""
    points, loops = _welded(name, points, loops, WELD * size, notes)
    loops = coplanar.divided(points, tidy(loops, notes))
    if open_sides(loops).size:
        points, loops = closed(name, points, loops, CRACK * size, notes)
    return points, loops


def _checked(name: str, vertices: npt.ArrayLike, faces: Iterable[Sequence[int]]) -> tuple[Array, Faces]:
    """Return the vertices that faces use, and the faces."""
    try:
        points = np.asarray(vertices, dtype=np.float64)
        loops = tuple(tuple(map(operator.index, face)) for face in faces)
    except (TypeError, ValueError, OverflowError):
        wrong(name, f"{reprlib.repr(faces)} are not faces over vertices of shape (n, 3)")
    if points.ndim != 2 or points.shape[1] != 3:
        wrong(name, f"vertices: shape {points.shape} given; shape (n, 3) is needed")
    if len(loops) > _MOST_POLYGONS:
        wrong(name, f"it has {len(loops)} faces; at most {_MOST_POLYGONS} are taken, make the mesh coarser")
    for k, loop in enumerate(loops):
        if loop and not 0 <= min(loop) <= max(loop) < len(points):
            wrong(name, f"face {k} = {reprlib.repr(loop)}: vertex indices run from 0 to {len(points) - 1}")
    used = np.unique([vertex for loop in loops for vertex in loop]).astype(np.int64)
    if len(used) < 4:
        wrong(name, f"its {len(loops)} faces have {len(used)} vertices; a solid has at least 4")
    if not (np.abs(points[used]) <= 1e30).all():
        k = used[np.argwhere(~(np.abs(points[used]) <= 1e30))[0, 0]]
        wrong(name, f"vertex {k} is {_place(points[k])}; finite numbers up to 1e30 are needed")
    number = np.zeros(len(points), dtype=np.int64)
    number[used] = np.arange(len(used))
    return points[used], renumbered(loops, number)


def _welded(
    name: str, points: Array, loops: Faces, tolerance: float, notes: list[str]
) -> tuple[Array, Faces]:
    """Return the distinct vertices, and the faces over them."""
    distinct, number = np.unique(points, axis=0, return_inverse=True)
    target = clusters(name, distinct, tolerance)
    moved = np.linalg.norm(distinct - distinct[target], axis=1).max()
    if moved > 0.0:
        merged = int((target != np.arange(len(target))).sum())
        notes.append(f"vertices up to {moved:.2g} m from another one merged with it: {merged}")
    return distinct, renumbered(loops, target[number.reshape(-1)])


def _outward(name: str, points: Array, loops: Faces, notes: list[str]) -> Faces:
    """Return the faces turned outward, after a check that they enclose one solid."""
    sides, owner = sides_of(loops)
    edges, edge, uses = edges_of(sides)
    _refuse_open(name, points, edges, uses)
    first, second = np.argsort(edge, kind="stable").reshape(-1, 2).T
    f, g, m = owner[first], owner[second], len(loops)
    turned = np.where(sides[first, 0] == sides[second, 0], m, 0)
    # each face appears twice, as given and turned: what is tied together has one sense
    ties = np.concatenate([f, f + m]), np.concatenate([g + turned, (g + turned + m) % (2 * m)])
    part = tied(np.column_stack(ties), 2 * m)
    if (part[:m] == part[m:]).any():
        wrong(
            name, "the faces have no inner and outer side, as on a Moebius strip; a closed surface is needed"
        )
    # one label of each shell, that of most of its faces as given
    shell, labels = np.unique(np.minimum(part[:m], part[m:]), return_inverse=True)
    flip = part[:m] != shell[labels]
    flip ^= (np.bincount(labels, flip) * 2 > np.bincount(labels))[labels]
    arms = points[[loop[0] for loop in loops]] - points.mean(axis=0)
    volumes = np.einsum("ij,ij->i", coplanar.area_vectors(points, loops), arms) * np.where(flip, -1.0, 1.0)
    volume = np.bincount(labels, volumes)
    outer = np.abs(volume).argmax()
    if np.sum(volume * volume[outer] > 0.0) > 1:
        wrong(name, f"it has {len(shell)} separate closed surfaces; one is needed, split it into blocks")
    flip ^= volume[outer] < 0.0
    if flip.any():
        whole = f"{flip.sum()} of {m} faces turned"
        notes.append("all faces pointed inward and are turned" if flip.all() else whole)
    return tuple(loop[::-1] if t else loop for loop, t in zip(loops, flip, strict=True))


def _refuse_open(name: str, points: Array, edges: Indices, uses: Indices) -> None:
    for odd, word in ((uses > 2, "faces meet wrongly"), (uses == 1, "the surface is open")):
        if odd.any():
            a, b = points[edges[odd.argmax()]]
            wrong(
                name,
                f"{word}: edges that belong to {many(int(uses[odd.argmax()]), 'face')}: {odd.sum()}, the "
                f"first from {_place(a)} to {_place(b)}; each edge of a solid belongs to 2 faces",
            )


def _untwisted(
    name: str, points: Array, loops: Faces, size: float, twisted: Twisted, notes: list[str]
) -> tuple[Array, Faces]:
    """Return vertices and faces, all plane; notes what was done to those that were not."""
    off = warps(points, loops)
    which = np.flatnonzero(off > PLANE_TOLERANCE * size)
    if not len(which):
        return points, loops
    places = ", ".join(_place(points[vertex]) for vertex in loops[int(off.argmax())][:4])
    if np.isinf(off.max()):
        wrong(name, f"a face crosses itself, and has no area: {places}, ...; list its corners in turn")
    said = f"twisted faces: {len(which)} of {len(loops)}, corners up to {off.max():.3g} m out of their planes"
    if twisted == "triangulate":
        notes.append(f"{said}, divided into triangles")
        return points, triangulated(points, loops, which)
    placed = fitted(points, loops, PLANE_TOLERANCE * size) if twisted == "fit" else None
    if placed is not None:
        moved = np.linalg.norm(placed - points, axis=1).max()
        notes.append(f"{said}, made plane: vertices moved by up to {moved:.3g} m")
        return placed, loops
    why = (
        "; no planes fit, " if twisted == "fit" else f"; at most {PLANE_TOLERANCE * size:.3g} m is allowed, "
    )
    remedy = "triangulate" if twisted == "fit" else "triangulate or fit"
    raise TwistedFaces(
        f"block {name!r}: {said}, the worst is {places}, ...{why}ask for --twisted {remedy} (twisted=...)",
        float(off.max()),
    )


def _place(point: Array) -> str:
    return f"({', '.join(f'{value:.6g}' for value in point)})"

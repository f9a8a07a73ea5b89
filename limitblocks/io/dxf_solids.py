"""Polygons of the solids that a DXF drawing can hold: meshes, polyfaces, 3D faces, bodies."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import LimitBlocksError, ModelError
from limitblocks.io.dxf import Part
from limitblocks.io.imported import Solid

Polygons = tuple[Array, Sequence[Sequence[int]]]

#: Distance between corners of 3D faces that are one vertex, over the extent of the faces.
_SAME = 1e-7


def polygons(part: Part) -> list[Polygons] | None:
    """Return the polygons of the solids that an entity is; None where it is none.

    Raises
    ------
    ModelError
        The entity is a solid that cannot be read; names it and says what to do.
    """
    kind, entity = part.kind, part.entity
    if kind == "MESH":
        return [(part.placed(entity.vertices), [tuple(face) for face in entity.faces])]
    if kind == "POLYLINE" and (entity.is_poly_face_mesh or entity.is_polygon_mesh):
        from ezdxf.render import MeshBuilder

        mesh = MeshBuilder.from_polyface(entity)
        return [(part.placed(mesh.vertices), mesh.faces)]
    if kind in ("3DSOLID", "BODY"):
        return [_soup([part.placed(face) for face in faces]) for faces in _body(part)]
    return None


def _soup(loops: Sequence[Array]) -> Polygons:
    """Return polygons that share no vertices."""
    ends = np.cumsum([len(loop) for loop in loops])
    return np.concatenate(loops), [
        range(end - len(loop), end) for end, loop in zip(ends.tolist(), loops, strict=True)
    ]


def _body(part: Part) -> list[list[Any]]:
    """Return the faces of each lump of an ACIS body."""
    from ezdxf.acis.api import load_dxf
    from ezdxf.acis.mesh import flat_polygon_faces_from_body

    try:
        bodies = load_dxf(part.entity)
        lumps = [lump for body in bodies for lump in flat_polygon_faces_from_body(body)]
        faces = [face for body in bodies for face in _faces(body)]
    except LimitBlocksError:
        raise
    except Exception as error:
        raise _unreadable(part, f"its data is not sound ({type(error).__name__})") from None
    if not any(lumps):
        raise _unreadable(part, "it has no plane faces with straight edges")
    if sum(map(len, lumps)) < len(faces):
        raise _unreadable(part, "it has faces that are not plane or edges that are not straight")
    # ezdxf takes the first loop of a face and no other
    if any(not getattr(face.loop, "next_loop", face.loop).is_none for face in faces):
        raise _unreadable(part, "it has faces with holes")
    return [lump for lump in lumps if lump]


def _unreadable(part: Part, why: str) -> ModelError:
    return ModelError(
        f"{part.kind} {part.handle} on layer {part.layer!r}: {why}; in the CAD program, convert it to a mesh "
        "(MESHSMOOTH, or EXPLODE a copy to faces) and save again"
    )


def _faces(body: Any) -> Iterator[Any]:
    lump = body.lump
    while not lump.is_none:
        face = lump.shell.face
        while not face.is_none:
            yield face
            face = face.next_face
        lump = lump.next_lump


def from_3d_faces(parts: Iterable[Part]) -> list[Solid]:
    """Return solids of single 3D faces, those of one layer and block reference together.

    Programs write the faces of one solid one after the other: a solid ends where its surface closes, so that
    solids that touch stay apart. Where that fails, faces that share vertices are one solid.
    """
    groups: dict[tuple[str, int], list[Part]] = {}
    for part in parts:
        groups.setdefault((part.layer, part.reference), []).append(part)
    return [solid for group in groups.values() for solid in _group(group)]


def _group(parts: Sequence[Part]) -> list[Solid]:
    corners = [part.placed(part.entity.wcs_vertices()) for part in parts]
    points, faces = _soup(corners)
    spread = float(np.ptp(points, axis=0).max()) if np.isfinite(points).all() else 1.0
    grid = np.round((points - points[0]) / ((spread or 1.0) * _SAME))
    _, number = np.unique(grid, axis=0, return_inverse=True)
    loops = [tuple(number.reshape(-1)[list(face)].tolist()) for face in faces]
    found = _closed_in_turn(loops)
    if found is None:
        found = _connected(loops)
    return [
        Solid(parts[members[0]].name, parts[members[0]].layer, points, [faces[k] for k in members])
        for members in found
    ]


def _closed_in_turn(loops: Sequence[Sequence[int]]) -> list[list[int]] | None:
    """Return runs of faces that each close a surface; None where the last run does not."""
    runs: list[list[int]] = [[]]
    uses: Counter[frozenset[int]] = Counter()
    odd: set[frozenset[int]] = set()
    for k, loop in enumerate(loops):
        runs[-1].append(k)
        for j in range(len(loop)):
            side = frozenset((loop[j - 1], loop[j]))
            if len(side) == 2:
                uses[side] += 1
                odd ^= {side}
        if not odd and uses:
            runs.append([])
            uses.clear()
    return None if runs.pop() else runs


def _connected(loops: Sequence[Sequence[int]]) -> list[list[int]]:
    """Return groups of faces that share vertices."""
    from scipy import sparse

    face = np.repeat(np.arange(len(loops)), [len(loop) for loop in loops])
    vertex = np.concatenate([np.asarray(loop) for loop in loops])
    n, m = len(loops), int(vertex.max()) + 1
    graph = sparse.coo_array((np.ones(len(face)), (face, n + vertex)), shape=(n + m, n + m))
    _, part = sparse.csgraph.connected_components(graph, directed=False)
    return [np.flatnonzero(part[:n] == label).tolist() for label in dict.fromkeys(part[:n].tolist())]

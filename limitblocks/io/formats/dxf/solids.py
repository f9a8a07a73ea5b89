"""Polygons of the solids that a DXF drawing can hold: meshes, polyfaces, 3D faces, bodies."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from limitblocks.errors import LimitBlocksError, ModelError
from limitblocks.io.formats.dxf.part import Part
from limitblocks.io.shells import soup, worded
from limitblocks.io.solid import Polygons, Solid, turned

#: MESHSMOOTH smooths what it makes, unless told otherwise.
_TO_MESH = "convert it to a mesh (MESHSMOOTH, then smoothness none (0), or EXPLODE a copy to faces)"


def polygons(part: Part) -> list[Polygons] | None:
    """Return the polygons of the solids that an entity is; None where it is none.

    Raises
    ------
    ModelError
        The entity is a solid that cannot be read; names it and says what to do.
    """
    kind, entity = part.kind, part.entity
    if kind == "MESH":
        if entity.dxf.subdivision_levels > 0:
            raise _unreadable(part, "it is smoothed, without plane faces", "set its smoothness to none (0)")
        return [(part.placed(entity.vertices), [tuple(face) for face in entity.faces])]
    if kind == "POLYLINE" and (entity.is_poly_face_mesh or entity.is_polygon_mesh):
        from ezdxf.render.mesh import MeshBuilder

        mesh = MeshBuilder.from_polyface(entity)
        return [(part.placed(mesh.vertices), mesh.faces)]
    if kind in ("3DSOLID", "BODY"):
        return [soup([part.placed(face) for face in faces]) for faces in _body(part)]
    return None


def _body(part: Part) -> list[list[Any]]:
    """Return the faces of each lump of an ACIS body."""
    from ezdxf.acis.dxf import load_dxf
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


def _unreadable(part: Part, why: str, cure: str = _TO_MESH) -> ModelError:
    return ModelError(
        f"{part.kind} {part.handle} on layer {part.layer!r}: {why}; in the CAD program, {cure} and save again"
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
    """Return the solids of single 3D faces, those of one layer and block reference together.

    Groups, colour and material of a solid are those of most of its faces.
    """
    groups: dict[tuple[str, int], list[Part]] = {}
    for part in parts:
        groups.setdefault((part.layer, part.reference), []).append(part)
    bodies = []
    for group in groups.values():
        points, faces = soup([part.placed(part.entity.wcs_vertices()) for part in group])
        words = [part.words | {"layer": part.layer} for part in group]
        loops = turned(faces, group[0].matrix)
        bodies += worded(group[0].name, points, loops, range(len(group)), words)
    return bodies

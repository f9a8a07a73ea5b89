"""Polygons of Rhino geometry: meshes as they are, polysurfaces by the straight edges of their plane faces."""

from __future__ import annotations

from collections.abc import Sequence
from types import ModuleType
from typing import Any

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.io.imported import refuse_many
from limitblocks.io.shells import soup

Polygons = tuple[Array, Sequence[Sequence[int]]]

#: Distance from a plane or a line, over the size of the solid, that still counts as straight.
_STRAIGHT = 1e-6
_CURED = "run Mesh on it in Rhino, or save it with a shaded view so that render meshes are in the file"


def polygons(rhino3dm: ModuleType, geometry: Any) -> Polygons | None:
    """Return the polygons of a geometry; None where it is no solid, such as a curve or a text.

    Raises
    ------
    ModelError
        It is a solid that cannot be read; says what to do.
    """
    if isinstance(geometry, rhino3dm.Mesh):
        return _mesh(geometry)
    if isinstance(geometry, rhino3dm.Extrusion):
        brep = geometry.ToBrep(True)
        if brep is None:
            raise ModelError("extrusion cannot be read; convert it to a polysurface in Rhino")
        return _brep(rhino3dm, brep)
    if isinstance(geometry, rhino3dm.Brep):
        return _brep(rhino3dm, geometry)
    if isinstance(geometry, rhino3dm.SubD):
        raise ModelError("is a SubD, which has no plane faces; convert it to a mesh in Rhino")
    return None


def _mesh(mesh: Any) -> Polygons:
    refuse_many(faces=len(mesh.Faces))
    # the same vertex twice at the end: a triangle
    faces = [tuple(dict.fromkeys(mesh.Faces[k])) for k in range(len(mesh.Faces))]
    points = [(point.X, point.Y, point.Z) for point in mesh.Vertices.ToPoint3dArray()]
    return np.array(points, dtype=np.float64).reshape(-1, 3), faces


def _brep(rhino3dm: ModuleType, brep: Any) -> Polygons:
    refuse_many(faces=len(brep.Faces))
    if not brep.IsSolid:
        raise ModelError(f"polysurface of {len(brep.Faces)} faces is open; join and cap it in Rhino")
    box = brep.GetBoundingBox()
    tolerance = _STRAIGHT * max(
        box.Max.X - box.Min.X, box.Max.Y - box.Min.Y, box.Max.Z - box.Min.Z, np.finfo(float).tiny
    )
    outlines = []
    for face in brep.Faces:
        if len(face.Loops) > 1:
            raise ModelError("has a face with a hole; run Mesh on it in Rhino")
        outline = _outline(face, tolerance)
        if outline is None:
            return _render_mesh(rhino3dm, brep)
        outlines.append(outline)
    return soup(outlines)


def _outline(face: Any, tolerance: float) -> Array | None:
    """Return the corners (n, 3) of a plane face with straight edges; None for another one."""
    if not face.IsPlanar(tolerance):
        return None
    edges = list(face.DuplicateFace(False).Edges)
    if not all(edge.IsLinear(tolerance) for edge in edges):
        return None
    ends = np.array([[_xyz(edge.PointAtStart), _xyz(edge.PointAtEnd)] for edge in edges])
    corners, left = [ends[0, 0], ends[0, 1]], list(range(1, len(edges)))
    while left:
        gaps = np.linalg.norm(ends[left] - corners[-1], axis=2)
        k, end = np.unravel_index(gaps.argmin(), gaps.shape)
        if gaps[k, end] > 10.0 * tolerance:
            return None
        corners.append(ends[left.pop(int(k)), 1 - end])
    loop = np.array(corners[:-1])
    u, v = face.Domain(0), face.Domain(1)
    normal = np.array(_xyz(face.NormalAt((u.T0 + u.T1) / 2, (v.T0 + v.T1) / 2)))
    inward = bool(np.cross(loop, np.roll(loop, -1, axis=0)).sum(axis=0) @ normal < 0.0) != bool(
        face.OrientationIsReversed
    )
    return loop[::-1] if inward else loop


def _xyz(point: Any) -> tuple[float, float, float]:
    return point.X, point.Y, point.Z


def _render_mesh(rhino3dm: ModuleType, brep: Any) -> Polygons:
    """Return the triangles that Rhino drew a curved polysurface with."""
    meshes = [face.GetMesh(rhino3dm.MeshType.Any) for face in brep.Faces]
    if any(mesh is None for mesh in meshes):
        raise ModelError(f"has curved faces or edges and no render mesh; {_CURED}")
    shapes = [_mesh(mesh) for mesh in meshes]
    return soup([points[list(face)] for points, faces in shapes for face in faces])

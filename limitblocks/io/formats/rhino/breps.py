"""Polygons of Rhino geometry: meshes as they are, polysurfaces by the straight edges of their plane faces."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.geometry.coplanar import axes_along
from limitblocks.io.imported import refuse_many
from limitblocks.io.shells import soup
from limitblocks.io.solid import Polygons

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
    outlines: list[Array] = []
    for face in brep.Faces:
        parts = _face(face, tolerance)
        if parts is None:
            return _render_mesh(rhino3dm, brep)
        outlines += parts
    return soup(outlines)


def _face(face: Any, tolerance: float) -> list[Array] | None:
    """Return the polygons of corners (n, 3) that a plane face is, triangles where it has holes.

    None for a face that is not plane, or has edges that are not straight.
    """
    if not face.IsPlanar(tolerance):
        return None
    edges = list(face.DuplicateFace(False).Edges)
    if not all(edge.IsLinear(tolerance) for edge in edges):
        return None
    rings = _rings(np.array([[_xyz(edge.PointAtStart), _xyz(edge.PointAtEnd)] for edge in edges]), tolerance)
    if rings is None:
        return None
    u, v = face.Domain(0), face.Domain(1)
    normal = np.array(_xyz(face.NormalAt((u.T0 + u.T1) / 2, (v.T0 + v.T1) / 2)))
    normal *= -1.0 if face.OrientationIsReversed else 1.0
    rings = [ring if _area(ring, normal) > 0.0 else ring[::-1] for ring in rings]
    return rings if len(rings) == 1 else _with_holes(rings, normal)


def _rings(ends: Array, tolerance: float) -> list[Array] | None:
    """Return the closed loops of corners (n, 3) of sides with `ends` (e, 2, 3); None where one stays open."""
    rings: list[Array] = []
    left = list(range(len(ends)))
    while left:
        first = ends[left.pop(0)]
        corners = [first[0], first[1]]
        while np.linalg.norm(corners[-1] - corners[0]) > 10.0 * tolerance or len(corners) < 4:
            gaps = np.linalg.norm(ends[left] - corners[-1], axis=2)
            if not left or gaps.min() > 10.0 * tolerance:
                return None
            k, end = np.unravel_index(gaps.argmin(), gaps.shape)
            corners.append(ends[left.pop(int(k)), 1 - end])
        rings.append(np.array(corners[:-1]))
    return rings


def _area(ring: Array, normal: Array) -> float:
    """Return twice the area of a loop as seen against `normal`."""
    return float(np.cross(ring - ring[0], np.roll(ring, -1, axis=0) - ring[0]).sum(axis=0) @ normal)


def _with_holes(rings: list[Array], normal: Array) -> list[Array]:
    """Return triangles of a plane face, the largest of whose loops is the outline and the others holes."""
    from manifold3d import triangulate

    rings = sorted(rings, key=lambda ring: -_area(ring, normal))
    rings = [rings[0], *(ring[::-1] for ring in rings[1:])]
    corners, axes = np.concatenate(rings), axes_along(normal)
    return [corners[trio] for trio in triangulate([ring[:, axes] for ring in rings])]


def _xyz(point: Any) -> tuple[float, float, float]:
    return point.X, point.Y, point.Z


def _render_mesh(rhino3dm: ModuleType, brep: Any) -> Polygons:
    """Return the triangles that Rhino drew a curved polysurface with."""
    meshes = [face.GetMesh(rhino3dm.MeshType.Any) for face in brep.Faces]
    if any(mesh is None for mesh in meshes):
        raise ModelError(f"has curved faces or edges and no render mesh; {_CURED}")
    shapes = [_mesh(mesh) for mesh in meshes]
    return soup([points[list(face)] for points, faces in shapes for face in faces])

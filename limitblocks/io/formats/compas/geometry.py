"""Geometry in COMPAS JSON as arrays: meshes, polyhedra, boxes, frames, transformations."""

from __future__ import annotations

import reprlib
from collections.abc import Mapping
from typing import Any

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.geometry import Block
from limitblocks.io.solid import Polygons, placed


def polygons(data: Mapping[str, Any]) -> Polygons | None:
    """Return vertices (n, 3) and faces of a mesh, polyhedron or box; None where `data` is none of them.

    Raises
    ------
    ModelError
        It is one, but its numbers are wrong.
    """
    if isinstance(data.get("vertex"), dict) and isinstance(data.get("face"), dict):
        return _mesh(data)
    if isinstance(data.get("vertices"), list) and isinstance(data.get("faces"), list):
        points = [numbers(unwrapped(vertex), 3) for vertex in data["vertices"]]
        return np.array(points).reshape(-1, 3), data["faces"]
    if "xsize" in data and "frame" in data:
        sides = numbers([data["xsize"], data.get("ysize"), data.get("zsize")], 3)
        box = Block.box("box", sides, (0.0, 0.0, 0.0))
        where = frame(data["frame"])
        return placed(box.vertices, where), box.faces
    return None


def unwrapped(value: Any) -> Any:
    """Return the data of an object, or the value itself."""
    return value.get("data", value.get("value")) if isinstance(value, dict) and "dtype" in value else value


def numbers(values: Any, count: int) -> list[float]:
    """Return `count` numbers; text and truth values are none."""
    sound = isinstance(values, list) and len(values) == count
    if not sound or any(isinstance(v, bool) or not isinstance(v, int | float) for v in values):
        raise ModelError(f"expected {count} numbers, not {reprlib.repr(values)}")
    return [float(value) for value in values]


def frame(value: Any) -> Array:
    """Return the matrix (4, 4) that takes coordinates in a frame to global ones; None is the identity."""
    if value is None:
        return np.eye(4)
    data = unwrapped(value)
    if not isinstance(data, dict):
        raise ModelError(f"expected a frame, not {reprlib.repr(value)}")
    point, x, y = (np.array(numbers(unwrapped(data.get(k)), 3)) for k in ("point", "xaxis", "yaxis"))
    z = np.cross(x, y)
    if not np.linalg.norm(z) > 0.0:
        raise ModelError(f"axes {x.tolist()} and {y.tolist()} of a frame are parallel")
    axes = np.array([x, np.cross(z, x), z])
    where = np.eye(4)
    where[:3, :3] = (axes / np.linalg.norm(axes, axis=1)[:, None]).T
    where[:3, 3] = point
    return where


def transformation(value: Any) -> Array:
    """Return the matrix (4, 4) of a transformation; None is the identity.

    Raises
    ------
    ModelError
        It is no affine map.
    """
    if value is None:
        return np.eye(4)
    data = unwrapped(value)
    rows = data.get("matrix") if isinstance(data, dict) else None
    if not isinstance(rows, list) or len(rows) != 4:
        raise ModelError(f"expected a transformation with a matrix of 4 rows, not {reprlib.repr(value)}")
    matrix = np.array([numbers(row, 4) for row in rows])
    if np.abs(matrix[3] - (0.0, 0.0, 0.0, 1.0)).max() > 1e-12:
        raise ModelError(f"last row of a transformation is {matrix[3].tolist()}; expected 0, 0, 0, 1")
    return matrix


def _mesh(data: Mapping[str, Any]) -> Polygons:
    defaults = data.get("default_vertex_attributes") or data.get("dva") or {}
    number = {str(key): k for k, key in enumerate(data["vertex"])}
    points = []
    for key, given in data["vertex"].items():
        if not isinstance(given, dict):
            raise ModelError(f"vertex {key} of a mesh is {reprlib.repr(given)}; expected x, y and z")
        points.append(numbers([given.get(axis, defaults.get(axis, 0.0)) for axis in "xyz"], 3))
    faces = []
    for key, loop in data["face"].items():
        if not isinstance(loop, list) or any(str(vertex) not in number for vertex in loop):
            raise ModelError(
                f"face {key} of a mesh is {reprlib.repr(loop)}; expected a list of its vertex keys"
            )
        faces.append([number[str(vertex)] for vertex in loop])
    return np.array(points).reshape(-1, 3), faces

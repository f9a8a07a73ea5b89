"""A block: a rigid polyhedron with planar faces."""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from limitblocks.arrays import Array, Indices, Sealed, read_only
from limitblocks.errors import ModelError
from limitblocks.geometry import given, polyhedron, surface
from limitblocks.geometry.polyhedron import Faces, Mesh, Shape

_CORNERS = np.array([(x, y, z) for z in (-0.5, 0.5) for y in (-0.5, 0.5) for x in (-0.5, 0.5)])
AXES = ("x", "y", "z")
WORDS = ("layer", "material", "groups", "colour")  # what a block says of itself beside shape and weight
_BOX_FACES = ((0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6))


@dataclass(frozen=True, eq=False, repr=False)
class Block(Sealed):
    """Rigid polyhedron with planar faces; it may be non-convex, with holes through it and cavities inside.

    Parameters
    ----------
    name : str
        Name, unique in a model.
    vertices : array_like, shape (n, 3)
        Vertices in global axes, m; kept as a read-only copy.
    faces : sequence of sequences of int
        Vertex indices of each face, counter-clockwise seen from outside: a loop that does not cross itself.
        A planar face with a hole is given as several faces in one plane.
    unit_weight : float or None
        Weight per volume, N/m3; None when it is not given, as for supports.
    layer, material : str
        Where the block is in a drawing, and what it is made of; empty if nothing is known. Only words: the
        numbers of a material are the unit weight and the joints.
    groups : sequence of str
        Groups of a drawing that it belongs to.
    colour : str
        "#rrggbb" that a drawing gives it; empty for none.

    Raises
    ------
    ModelError
        The name is empty, a word is no text, the colour is none, or the unit weight is not a finite number
        >= 0.
    GeometryError
        The faces are not the closed surface of one piece with planar faces. A vertex may lie out of the
        plane of a face by 1e-3 of the block's size.
    """

    name: str
    vertices: Array
    faces: Faces
    unit_weight: float | None = None
    layer: str = ""
    material: str = ""
    groups: Sequence[str] = ()
    colour: str = ""

    def __post_init__(self) -> None:
        given.require_name(self.name)
        for key, word in given.words(self.name, self.words).items():
            object.__setattr__(self, key, word)
        object.__setattr__(self, "vertices", given.numbers(self.name, "vertices", self.vertices, (None, 3)))
        object.__setattr__(self, "faces", given.faces_of(self.name, self.faces))
        fault = polyhedron.mesh_fault(self.faces, len(self.vertices))
        if not fault:
            fault = polyhedron.shape_fault(self._points, self.mesh, self._shape)
            fault += polyhedron.odd_places(self.vertices) if fault else ""
        fault = fault or polyhedron.plane_fault(self._points, self.mesh, self.size, self._planes)
        fault = fault or surface.loop_fault(self._points, self.mesh, self.normals)
        if not fault and not self.convex:
            fault = surface.surface_fault(self._points, self.mesh, self.normals, self.size)
        if fault:
            given.wrong(self.name, fault)

    @classmethod
    def box(
        cls, name: str, size: npt.ArrayLike, at: npt.ArrayLike, unit_weight: float | None = None
    ) -> Block:
        """Return the box of dimensions `size` (3,), m, along the global axes, with its centre `at` (3,), m.

        `name` and `unit_weight`, N/m3, are those of the block; a support needs no weight.

        Raises
        ------
        GeometryError
            A dimension is not positive, or a number is not finite.
        """
        sides = given.numbers(name, "size", size, (3,))
        if sides.min() <= 0.0:
            given.wrong(name, f"size is {tuple(sides.tolist())}; all three dimensions must be positive")
        return cls(name, given.numbers(name, "at", at, (3,)) + _CORNERS * sides, _BOX_FACES, unit_weight)

    @classmethod
    def prism(
        cls,
        name: str,
        outline: npt.ArrayLike,
        between: npt.ArrayLike,
        unit_weight: float | None = None,
        along: str = "y",
    ) -> Block:
        """Return the prism of an outline (n, 2), m, `between` two places (2,) `along` an axis, m.

        The outline is in the other two axes in the order of the alphabet, "y": X and Z, turning either way.
        `name` and `unit_weight`, N/m3, are those of the block; a support needs no weight.

        Raises
        ------
        GeometryError
            The outline has no area or crosses itself, the places are not in order, or a number is not finite.
        """
        points = given.numbers(name, "outline", outline, (None, 2))
        low, high = given.numbers(name, "between", between, (2,)).tolist()
        if along not in AXES:
            given.wrong(name, f"along is {along!r}; x, y or z is needed")
        if not low < high:
            given.wrong(name, f"between is ({low:g}, {high:g}); the lesser place comes first")
        return cls(name, *polyhedron.prism(points, low, high, AXES.index(along)), unit_weight)

    def __repr__(self) -> str:
        return f"<block {self.name!r}: size {self.size:.4g} m, volume {self.volume:.4g} m3>"

    @cached_property
    def size(self) -> float:
        """Longest side of a box, however it lies, m; of others that of a box with their second moment."""
        return float(np.sqrt(12.0 * np.linalg.norm(self._shape.second, 2)))  # of a box it is side**2 / 12

    @property
    def volume(self) -> float:
        """Volume, m3."""
        return self._shape.volume

    @cached_property
    def centroid(self) -> Array:
        """Centroid, global axes, shape (3,), m."""
        return read_only(self._origin + self._shape.centroid)

    @property
    def weight(self) -> float:
        """Weight, N.

        Raises
        ------
        ModelError
            The unit weight was not given.
        """
        if self.unit_weight is None:
            raise ModelError(f"block {self.name!r} has no unit weight; give unit_weight in N/m3")
        return self.unit_weight * self.volume

    @cached_property
    def convex(self) -> bool:
        """Whether the block is convex: no vertex above a face by more than 1e-4 of its size."""
        return polyhedron.is_convex(self._points, self.mesh, self.size, self._planes)

    @cached_property
    def mesh(self) -> Mesh:
        """Half-edges of the faces."""
        return polyhedron.mesh(self.faces)

    @cached_property
    def triangles(self) -> Indices:
        """Vertex indices of triangles that divide the faces, counter-clockwise from outside, shape (t, 3)."""
        return surface.triangles(self._points, self.mesh, self.normals)[0]

    @cached_property
    def areas(self) -> Array:
        """Areas of the faces, shape (m,), m2."""
        return read_only(np.linalg.norm(self._shape.area_vectors, axis=1))

    @cached_property
    def normals(self) -> Array:
        """Unit normals of the faces, outward, shape (m, 3)."""
        return read_only(self._planes[0])

    @cached_property
    def offsets(self) -> Array:
        """Offsets of the face planes `normals @ x = offsets`, global axes, shape (m,), m."""
        return read_only(self._planes[1] + self.normals @ self._origin)

    @property
    def words(self) -> dict[str, Any]:
        """Unit weight, layer, material, groups and colour, as :meth:`labelled` takes them."""
        return {key: getattr(self, key) for key in ("unit_weight", *WORDS)}

    def moved(self, rotation: npt.ArrayLike, translation: npt.ArrayLike) -> Block:
        """Return a copy with vertices `rotation @ x + translation`.

        Parameters
        ----------
        rotation : array_like, shape (3, 3)
            Proper orthonormal matrix; rotates about the global origin.
        translation : array_like, shape (3,)
            m.

        Raises
        ------
        GeometryError
            `rotation` is not a proper rotation, or a number is not finite.
        """
        turn = given.numbers(self.name, "rotation", rotation, (3, 3))
        if np.abs(turn @ turn.T - np.eye(3)).max() > 1e-9 or np.linalg.det(turn) < 0.0:
            given.wrong(
                self.name, f"rotation {turn.tolist()} is not proper; R R^T = I and det R = 1 are needed"
            )
        shift = given.numbers(self.name, "translation", translation, (3,))
        return replace(self, vertices=self.vertices @ turn.T + shift)

    def labelled(self, **words: Any) -> Block:
        """Return the same body with another `unit_weight`, `layer`, `material`, `groups` or `colour`.

        Raises
        ------
        ModelError
            As for a new block.
        """
        block = copy(self)  # with what was computed of its shape
        block.__dict__.update(given.words(self.name, words))
        return block

    @cached_property
    def _origin(self) -> Array:
        return np.asarray(self.vertices.mean(axis=0))

    @cached_property
    def _points(self) -> Array:
        return self.vertices - self._origin

    @cached_property
    def _planes(self) -> tuple[Array, Array]:
        return polyhedron.face_planes(self._points, self.mesh, self._shape.area_vectors)

    @cached_property
    def _shape(self) -> Shape:
        return polyhedron.shape(self._points, self.mesh)

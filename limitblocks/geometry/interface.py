"""An interface: the plane polygon through which two blocks touch, with its local axes."""

from __future__ import annotations

import reprlib
from dataclasses import dataclass

import numpy as np

from limitblocks.arrays import Array, Sealed, read_only, reals
from limitblocks.errors import GeometryError, ModelError
from limitblocks.geometry.polygon import areas

#: What a file keeps of an interface beside its joint.
PLACE = ("block_i", "block_j", "centroid", "axes", "polygon")


@dataclass(frozen=True, eq=False, repr=False)
class Interface(Sealed):
    """Plane contact polygon between block i and block j (the paper's Fig. 10).

    Attributes
    ----------
    block_i, block_j : str
        Names of the two blocks; the normal points out of block i.
    centroid : Array, shape (3,)
        Centroid of the polygon, global axes, m.
    axes : Array, shape (3, 3)
        Rows s1, s2, n: right-handed unit vectors; `axes @ v` turns a global vector into local
        components (the matrix T_k^g of Eq. 44).
    polygon : Array, shape (n, 2)
        Vertices in local coordinates (x1, x2) about the centroid, counter-clockwise about n, m.
    joint : object
        What the interface can carry; a joint of :mod:`limitblocks.joints`.
    """

    block_i: str
    block_j: str
    centroid: Array
    axes: Array
    polygon: Array
    joint: object

    def __post_init__(self) -> None:
        for key in ("block_i", "block_j"):
            if not isinstance(getattr(self, key), str):
                raise ModelError(
                    f"{key} of an interface is {getattr(self, key)!r}, expected the name of a block"
                )
        for key in ("centroid", "axes", "polygon"):
            values = getattr(self, key)
            if isinstance(values, np.ndarray) and values.dtype == np.float64:  # thousands are made in a row
                continue
            try:
                object.__setattr__(self, key, read_only(reals(values)))
            except (TypeError, ValueError):
                raise GeometryError(
                    f"interface {self.name}: {key} is {reprlib.repr(values)}, expected numbers, m"
                ) from None

    def __repr__(self) -> str:
        return f"<interface {self.name!r}: area {areas(self.polygon):.4g} m2>"

    @property
    def corners(self) -> Array:
        """Vertices in global axes, m, shape (n, 3)."""
        return np.asarray(self.centroid + self.polygon @ self.axes[:2])

    @property
    def name(self) -> str:
        """Text that names the interface in messages and reports."""
        word = getattr(self.joint, "word", "")  # of a tie or dowel
        return f"{word} {self.block_i}|{self.block_j}".lstrip()

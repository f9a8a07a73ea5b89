"""The matrices of a convex program, as Clarabel takes them."""

from __future__ import annotations

from dataclasses import dataclass

from scipy import sparse

from limitblocks.arrays import Array
from limitblocks.problem import Cones


@dataclass(frozen=True, eq=False)
class Conic:
    """The least c.v + v^T W v / 2 with b - A v zero in its first rows, in K in all others; no W is zero."""

    c: Array
    A: sparse.csc_array
    b: Array
    cones: Cones
    W: Array | None = None

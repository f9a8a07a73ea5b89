"""Exact limit surface (V1, V2, T) of an interface under uniform normal stress; inner and outer polytopes.

Source: Goyal, Ruina & Papadopoulos (1991), "Planar sliding with dry friction, part 1: limit surface and
moment function", Wear 143; the strengths are Eqs (6)-(15) of Orduña & Lourenço (2005). All is per unit
mu |N|: under uniform pressure the set of admissible (V1, V2, T) grows in proportion.
T is about the centroid.

The dissipation is the support function of the set, so its gradients are points of the limit surface and its
values place tangent planes. No symmetry of the polygon is assumed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.spatial import ConvexHull

from limitblocks.arrays import Array, Indices, read_only
from limitblocks.errors import ModelError
from limitblocks.joints.torsion import (
    Region,
    as_region,
    normalised_edges,
    torsion_constant,
    torsion_integrals,
)

FARTHEST = 1e30  # distance of the twisting centre, in sizes, that stands for a translation


@dataclass(frozen=True, eq=False)
class LimitPolytope:
    """Polytope ``normals @ (V1, V2, T) + offsets * mu N <= 0`` of stress resultants.

    Attributes
    ----------
    normals : Array, shape (k, 3)
        Outward normals, of unit length in the axes (V1, V2, T / c_T); the third column is in 1/m.
    offsets : Array, shape (k,)
        Positive distances of the planes, no unit.
    gap : float
        Discretisation error: exact set within (1 + gap) times the inner polytope, and outer polytope within
        (1 + gap) times the exact set.
    """

    normals: Array
    offsets: Array
    gap: float


def dissipation(region: Region, strain_rates: Any) -> Array:
    """Dissipation rate per unit mu |N|: the mean over the area of ``|ds + dthn n x r|``, r from the centroid.

    Parameters
    ----------
    region : Region
        Interface, m; see :func:`limitblocks.joints.torsion.as_region`.
    strain_rates : array (..., 3)
        (ds1, ds2, dthn), m/s and 1/s.

    Returns
    -------
    Array, shape (...,)
        m/s; convex and homogeneous of degree one in the strain rates.
    """
    return _support(region, strain_rates)[0]


def limit_points(region: Region, strain_rates: Any) -> Array:
    """Points (..., 3) of the limit surface, (V1, V2, T) / (mu |N|), where it is normal to the strain rates.

    This is the gradient of :func:`dissipation`; parameters as there. T is in m.

    Raises
    ------
    ModelError
        If a strain rate is zero: it names no direction.
    """
    if not np.asarray(strain_rates, dtype=float).any(axis=-1).all():
        raise ModelError("a strain rate (ds1, ds2, dthn) is zero; a limit point needs a direction")
    return _support(region, strain_rates)[1]


def _support(region: Region, strain_rates: Any) -> tuple[Array, Array]:
    """Dissipation and its gradient: the strain rates are a twist dthn about the centre n x ds / dthn."""
    shape = as_region(region)
    _, centroid, size = normalised_edges(shape)
    rates = np.asarray(strain_rates, dtype=float)
    slip = np.hypot(rates[..., 0], rates[..., 1])
    sign = np.where(rates[..., 2] < 0, -1.0, 1.0)
    twist = np.maximum(np.abs(rates[..., 2]), np.maximum(slip / (FARTHEST * size), np.finfo(float).tiny))
    arm = np.stack([-rates[..., 1], rates[..., 0]], axis=-1) / (sign * twist)[..., None]
    twists = torsion_integrals(shape, centroid + arm)
    points = sign[..., None] * np.stack([twists.V1, twists.V2, twists.T_reference], axis=-1) / shape.area
    return np.asarray(twist * twists.T / shape.area), np.asarray(points)


def directions(fineness: int) -> Array:
    """Well-spread unit vectors (4 fineness^2 + 2, 3): an octahedron, its faces cut in fineness^2 triangles.

    They contain the six axes; neighbours are some 90 deg / fineness apart.
    """
    if fineness < 1:
        raise ModelError(f"fineness is {fineness}; expected a whole number of at least 1")
    grid = np.stack(np.meshgrid(*3 * [np.arange(-fineness, fineness + 1)]), axis=-1).reshape(-1, 3)
    grid = grid[np.abs(grid).sum(axis=1) == fineness]
    spread = np.sin(grid * (np.pi / 2 / fineness))  # evens out the angles that the flat faces would give
    return np.asarray(spread / np.linalg.norm(spread, axis=1, keepdims=True))


def inner_polytope(region: Region, fineness: int = 4) -> LimitPolytope:
    """Convex hull of points of the limit surface: safe, never stronger than the exact set.

    Parameters
    ----------
    region : Region
        Interface, m.
    fineness : int
        4 fineness^2 + 2 points; the gap falls as 1 / fineness^2.

    Returns
    -------
    LimitPolytope
        8 fineness^2 rows: 128 with a gap of 6 to 8 % by default.
    """
    normals, inner, outer = _facets(region, fineness)
    return _polytope(normals, inner, inner, outer)


def outer_polytope(region: Region, fineness: int = 4) -> LimitPolytope:
    """Tangent planes parallel to the facets of :func:`inner_polytope`: never weaker than the exact set."""
    normals, inner, outer = _facets(region, fineness)
    return _polytope(normals, outer, inner, outer)


def _facets(region: Region, fineness: int) -> tuple[Array, Array, Array]:
    """Normals (k, 3) of the inner hull, its offsets, and the offsets of the parallel tangent planes."""
    shape = as_region(region)
    axes = np.array([1.0, 1.0, torsion_constant(shape)])
    hull = ConvexHull(limit_points(shape, directions(fineness) / axes) / axes)
    normals = hull.equations[:, :3] / axes
    return normals, -hull.equations[:, 3], dissipation(shape, normals)


def _polytope(normals: Array, offsets: Array, inner: Array, outer: Array) -> LimitPolytope:
    return LimitPolytope(read_only(normals), read_only(offsets), float((outer / inner).max() - 1))


def unique_shapes(polygons: Array) -> tuple[Indices, Indices]:
    """Find equal polygons of a stack, so that each shape is computed once.

    Parameters
    ----------
    polygons : Array, shape (m, n, 2)
        Vertices about the centroids, m; equal means the same vertices from any first one on, in nine digits
        of the largest coordinate of the stack.

    Returns
    -------
    first, shape_of : Indices, shapes (u,) and (m,)
        Index of the first polygon of each shape; ``polygons[first][shape_of]`` repeats them all.
    """
    m, n, _ = polygons.shape
    rounded = np.round(polygons / np.abs(polygons).max(initial=1e-300), 9)
    start = np.lexsort(np.moveaxis(rounded[..., ::-1], -1, 0), axis=1)[:, :1]
    order = (start + np.arange(n)) % n
    turned = np.take_along_axis(rounded, order[..., None], axis=1).reshape(m, 2 * n)
    _, first, shape_of = np.unique(turned, axis=0, return_index=True, return_inverse=True)
    return first, shape_of

"""Interaction of torsion with shear and bending, as curves that can be computed and plotted by themselves.

Source: Orduña & Lourenço (2005), Part I, Sections 3 and 4 ("the paper"), Eqs (16)-(30), (41) and (42), on
rectangles; the effective area of other convex polygons is this library's. N <= 0 in compression.
"""

from __future__ import annotations

from numbers import Real
from typing import Any

import numpy as np
import shapely
from scipy.special import hyp2f1
from shapely import Polygon

from limitblocks.arrays import Array
from limitblocks.errors import GeometryError, ModelError
from limitblocks.geometry.polygon import cross
from limitblocks.joints.torsion import (
    Region,
    as_region,
    normalised_edges,
    plastic_centre,
    rectangle_torsion_constant,
    torsion_constant,
    torsion_integrals,
)

STRENGTH_RANGE = (1e4, 60e6)  # Pa: Eq. (42) is for concrete up to 60 N/mm2; below, it is a slip of units
HINGE = 1e-9  # relative distance from the boundary that counts as on it
GRID = 1e-14  # of the size of a polygon: the places of an overlay


def shear_strength(friction: float, N: Any) -> Array:
    """Shear strength V0 = -mu N, N (Eq. 18), zero in tension; times c_T it is T0, N m (Eq. 16)."""
    return np.asarray(friction * np.maximum(-np.asarray(N, dtype=float), 0.0))


# ------------------------------------------------------------------------------------ torsion and shear


def torsion_shear_curve(region: Region, direction: Any, distances: Any) -> tuple[Array, Array]:
    """Return V / V0 and T / T0 for a twisting centre that moves away along a line (Fig. 7).

    Parameters
    ----------
    region : Region
        Interface, m.
    direction : array (2,)
        Direction, of any length, from the plastic centre.
    distances : array (k,)
        Distances of the twisting centre from the plastic centre, m; infinity is pure shear.

    Returns
    -------
    tuple of Array, shapes (k,)
        Resultant shear force over mu |N|, and torsion about the centroid over the strength in pure torsion.
    """
    shape, unit = as_region(region), np.asarray(direction, dtype=float)
    unit, distance = unit / np.linalg.norm(unit), np.asarray(distances, dtype=float)
    centre = plastic_centre(shape)
    farthest = 1e30 * np.sqrt(shape.area)
    twists = torsion_integrals(shape, centre + np.minimum(distance, farthest)[..., None] * unit)
    strength = torsion_constant(shape, centre) * shape.area
    return np.hypot(twists.V1, twists.V2) / shape.area, twists.T_reference / strength


def slender_along(distance: Any) -> tuple[Array, Array]:
    """V / V0 and T / T0 of a rectangle of aspect ratio l2 / l1 -> 0, the twisting centre moving along x1.

    `distance` s is that of the twisting centre over l1. The stress is across the segment and changes sign at
    the centre: V / V0 = s and T / T0 = 1 - s^2 up to s = 1, then pure shear. The lower curve of Fig. 7.
    """
    s = np.minimum(np.abs(np.asarray(distance, dtype=float)), 1.0)
    return s, 1 - s**2


def slender_across(distance: Any) -> tuple[Array, Array]:
    """V / V0 and T / T0 of a rectangle of aspect ratio l2 / l1 -> infinity, the centre moving along x1.

    `distance` s is that of the twisting centre over l2. Over the segment |y| <= 1 the stress along x2 is
    s / sqrt(s^2 + y^2), that along x1 has the moment y^2 / sqrt(s^2 + y^2), so that V / V0 = s asinh(1 / s)
    and T / T0 = sqrt(1 + s^2) - s^2 asinh(1 / s). The upper curve of Fig. 7.
    """
    s = np.clip(np.abs(np.asarray(distance, dtype=float)), 1e-100, 1e100)
    V = s * np.arcsinh(1 / s)
    # the closed form of T cancels for s > 1; there the same integral as a hypergeometric function
    far = hyp2f1(0.5, 1.5, 2.5, -1 / np.maximum(s, 1) ** 2) * 2 / (3 * s)
    return V, np.where(s > 1, far, np.hypot(1, s) - s * V)


def approximate_torsion_shear(shear_ratio: Any) -> Array:
    """T / T0 of the paper's planes at V / V0 along a contact direction, Eqs (23)-(29); zero for V > V0.

    Neither safe nor unsafe: near V / V0 = 0.5 it lies between the exact curves of Fig. 7, near pure shear
    above all of them (0.3 against 0).
    """
    ratio = np.abs(np.asarray(shear_ratio, dtype=float))
    return np.where(ratio <= 1, np.minimum(1.0, 1.3 - ratio), 0.0)


# ---------------------------------------------------------------------------------- torsion and bending


def eccentricity(N: Any, M1: Any, M2: Any) -> Array:
    """Point of action (e1, e2) = (-M2, M1) / N of the normal force, (..., 2), m; ModelError unless N < 0."""
    N, M1, M2 = np.broadcast_arrays(*(np.asarray(value, dtype=float) for value in (N, M1, M2)))
    if not (N < 0).all():
        raise ModelError(f"normal force N is {N.max():g} N; an eccentricity needs compression, N < 0")
    return np.stack([-M2 / N, M1 / N], axis=-1)


def effective_half_sides(l1: Any, l2: Any, N: Any, M1: Any, M2: Any) -> Array:
    """Half sides (..., 2) of the effective rectangle, m: l - |e|, Eqs (19) and (20) for either sign of e.

    One is zero at a hinge, both beyond it, where no stress state exists.
    """
    sides = np.stack(np.broadcast_arrays(l1, l2), axis=-1)
    e = np.abs(eccentricity(N, M1, M2))
    beyond = (e > sides * (1 + HINGE)).any(axis=-1, keepdims=True)
    return np.where(beyond, 0.0, np.maximum(sides - e, 0.0))


def rectangle_torsion_bending(l1: Any, l2: Any, friction: float, N: Any, M1: Any, M2: Any) -> Array:
    """Torsion strength of a rectangle under N, M1, M2 by the effective rectangle, N m (Fig. 8b).

    Eqs (16) and (17) on the half sides of Eqs (19) and (20). At a hinge it is the limit of Eq. (22).
    """
    half_sides = effective_half_sides(l1, l2, N, M1, M2)
    return shear_strength(friction, N) * rectangle_torsion_constant(half_sides[..., 0], half_sides[..., 1])


def approximate_torsion_bending(l1: Any, l2: Any, friction: float, N: Any, M1: Any, M2: Any) -> Array:
    """Torsion strength of a rectangle by the paper's planes, N m: the least of Eqs (23) and (30).

    Never below :func:`rectangle_torsion_bending` and equal to it at a hinge; zero beyond.
    """
    N, M1, M2 = (np.asarray(value, dtype=float) for value in (N, M1, M2))
    twist = shear_strength(friction, N) * rectangle_torsion_constant(l1, l2)
    plane = -friction / 2 * (np.abs(M1) + np.abs(M2) + N * (l1 + l2))
    stands = (np.abs(M1) <= -l2 * N * (1 + HINGE)) & (np.abs(M2) <= -l1 * N * (1 + HINGE))
    return np.where(stands, np.maximum(np.minimum(twist, plane), 0.0), 0.0)


def effective_areas(polygon: Region, eccentricities: Any) -> Any:
    """Effective area of a convex polygon: the part that is symmetric about the point of action.

    It is the intersection of the polygon with its reflection through (e1, e2). This is convex and centrally
    symmetric, so that its centroid and its plastic centre are both (e1, e2); on rectangles it is the
    effective rectangle of Eqs (19) and (20). Uniform pressure on it is in equilibrium with N, M1, M2, so with
    infinite compressive strength it underestimates: pressure gathered in far corners can carry more
    torsion, and a polygon without central symmetry is not used whole even at e = 0 (an equilateral triangle
    keeps 76 % of its c_T).

    Parameters
    ----------
    polygon : Region
        Convex polygon, m; otherwise GeometryError.
    eccentricities : array (..., 2)
        Points of action from the centroid, m. At the boundary they are moved 2e-9 of the way inwards.

    Returns
    -------
    object array (...,) of shapely geometries
        In the axes of the polygon; empty beyond a hinge.
    """
    shape = as_region(polygon)
    centroid = shapely.get_coordinates(shape.centroid)[0]
    edges, _, size = normalised_edges(shape)
    p, side = edges[:, 0], edges[:, 1] - edges[:, 0]
    if not (cross(side, p[:, None] - p) >= -HINGE).all():
        raise GeometryError("an effective area needs a convex polygon without holes")
    e = np.asarray(eccentricities, dtype=float)
    gauge = (cross(e[..., None, :] / size, side) / cross(p, side)).max(axis=-1)  # 1 on the boundary
    inside = np.where(np.abs(gauge - 1) < HINGE, 1 - 2 * HINGE, 1.0)[..., None] * e
    reflected = shapely.polygons(2 * (centroid + inside)[..., None, :] - centroid - size * p)
    # without a grid GEOS 3.14 can lose all that polygons share which are one but for rounding errors
    common = shapely.convex_hull(shapely.intersection(shape, reflected, grid_size=GRID * size))
    return np.where(gauge < 1 + HINGE, common, Polygon())


def torsion_bending(polygon: Region, friction: float, N: Any, M1: Any, M2: Any) -> Array:
    """Torsion strength of a convex polygon under N, M1, M2, N m: uniform pressure on its effective area.

    Equals :func:`rectangle_torsion_bending` on rectangles; a hinge keeps half its half length as in Eq. (22).
    """
    areas = np.asarray(effective_areas(polygon, eccentricity(N, M1, M2)))
    constants = [_torsion_constant_or_limit(area) for area in areas.ravel()]
    return np.asarray(shear_strength(friction, N) * np.reshape(constants, areas.shape))


def _torsion_constant_or_limit(area: Any) -> float:
    """Torsion constant of an effective area that may have shrunk to a segment, a point or nothing, m."""
    if area.is_empty:
        return 0.0
    x1, x2, y1, y2 = (area.bounds[i] for i in (0, 2, 1, 3))
    length = float(np.hypot(x2 - x1, y2 - y1))
    return torsion_constant(area) if area.area > 10 * HINGE * length**2 else length / 4


# ----------------------------------------------------------------------------------------- compression


def effective_strength(fc: float) -> float:
    """Effective compressive strength fcef = ve fc, Pa, from fc in Pa: ve = 0.7 - fc / 200 MPa (Eqs 41, 42).

    Raises
    ------
    ModelError
        No number, or outside 0.01 to 60 MPa. The formula is Nielsen's (1999) for concrete up to 60 MPa; it is
        no more than borrowed for masonry, and beyond 70 MPa it would let a stronger material carry less.
    """
    low, high = STRENGTH_RANGE
    if not isinstance(fc, Real):
        raise ModelError(f"compressive strength fc is {fc!r}, expected a number in Pa")
    if not low <= fc <= high:
        raise ModelError(f"compressive strength fc is {fc:g} Pa; Eq. (42) holds from {low:g} to {high:g} Pa")
    return (0.7 - fc / 200e6) * fc

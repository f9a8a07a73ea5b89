"""Plastic torsion of frictional interfaces of any shape under uniform normal stress.

Source: Orduña & Lourenço (2005), Part I, Sections 2 and 3 ("the paper"), Eqs (1)-(18). A polygon is the
signed sum over its edges of right triangles with a vertex at the twisting centre, two triangles an edge, on
either side of the foot of the perpendicular; so it may have holes and parts, and the centre may be anywhere.

Sign: a positive torsion has the stress ``tau = mu |sigma| n x (r - c) / |r - c|`` (Eqs 4 and 5). Two signs of
the text as we have it are wrong: Eq. (12) is -V1 of Eq. (7); Eq. (14) needs b - c ln, or T1 + T2 = T fails.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Any, TypeAlias

import numpy as np
import shapely
from shapely import MultiPolygon, Polygon
from shapely.geometry.polygon import orient

from limitblocks.arrays import Array, reals_if_any
from limitblocks.errors import GeometryError
from limitblocks.geometry.polygon import areas, centroids, cross, stacked

Region: TypeAlias = Array | Sequence[Array] | Polygon | MultiPolygon

FAR = 3.0  # beyond so many sizes from the centroid the edge sums would cancel: quadrature instead
GAUSS = 12  # points per direction; relative error (FAR + sqrt(FAR**2 - 1))**(-2 * GAUSS) = 4e-19
TINY = 1e-200  # floor of denominators whose numerators vanish faster


@dataclass(frozen=True, eq=False)
class TorsionIntegrals:
    """Resultants of the limit shear stress per unit ``mu |sigma|``, arrays of the shape of the centres.

    V1, V2: shear forces, m2, Eqs (7) and (8). T, T1, T2: torsion about the twisting centre and its parts by
    tau1 and tau2, m3, Eqs (6), (9) and (10). T_reference: torsion about the reference point, m3.
    """

    V1: Array
    V2: Array
    T: Array
    T1: Array
    T2: Array
    T_reference: Array


def as_region(region: Region) -> Any:
    """Return `region` as a valid shapely Polygon or MultiPolygon.

    Several rings are joined by the even-odd rule: a ring inside another is a hole, one outside it a part.
    Raises GeometryError for fewer than three vertices, NaN, self-intersection or no area.
    """
    if isinstance(region, Polygon | MultiPolygon):
        return _checked(region)
    rings = [region] if np.ndim(region[0]) == 1 else region
    return _checked(reduce(shapely.symmetric_difference, [_ring(ring) for ring in rings]))


def _ring(given: Any) -> Any:
    vertices = reals_if_any(given)
    if vertices.ndim != 2 or len(vertices) < 3 or vertices.shape[1] != 2 or not np.isfinite(vertices).all():
        raise GeometryError(f"a polygon is a finite array of shape (n >= 3, 2); got {given!r}")
    return _checked(Polygon(vertices))


def _checked(shape: Any) -> Any:
    if not shape.is_valid:
        raise GeometryError(f"the interface polygon must be simple, but: {shapely.is_valid_reason(shape)}")
    if not shape.area > 1e-14 * shape.length**2:
        raise GeometryError(f"the interface polygon must have an area; it has {shape.area:g} m2")
    return shape


def normalised_edges(region: Region) -> tuple[Array, Array, float]:
    """Return the edges (E, 2, 2) about the centroid over the size, the centroid (2,) and the size, m.

    The size is the largest distance of a vertex from the centroid; the interior lies left of every edge.
    """
    shape = as_region(region)
    parts = [orient(part) for part in shapely.get_parts(shape)]
    rings = [shapely.get_coordinates(ring) for part in parts for ring in (part.exterior, *part.interiors)]
    edges = np.concatenate([np.stack([ring[:-1], ring[1:]], axis=1) for ring in rings])
    centroid = shapely.get_coordinates(shape.centroid)[0]
    edges = edges[(edges[:, 0] != edges[:, 1]).any(axis=1)] - centroid
    size = float(np.hypot(edges[..., 0], edges[..., 1]).max())
    return edges / size, centroid, size


def _legs(p: Array, q: Array) -> tuple[Array, ...]:
    """Legs a (..., 1), b (..., 2), hypotenuses c of both triangles of each edge; normal m, direction d."""
    length = np.hypot(q[..., 0] - p[..., 0], q[..., 1] - p[..., 1])
    d = (q - p) / np.maximum(length, TINY)[..., None]
    m = np.stack([d[..., 1], -d[..., 0]], axis=-1)
    a = cross(p, d)[..., None]
    b = np.stack([(p * d).sum(-1), (q * d).sum(-1)], axis=-1)
    return a, b, np.hypot(a, b), m, d


def _edge_sums(p: Array, q: Array) -> Array:
    """V1, V2, T, T1, T2 stacked (5, ...) of the edges pq (..., E, 2), the twisting centre at the origin."""
    a, b, c, m, d = _legs(p, q)
    log = np.arcsinh(b / np.maximum(np.abs(a), TINY))  # ln((b + c) / a), odd in b
    rise = b**2 / np.maximum(c + np.abs(a), TINY)  # c - |a| without cancellation
    triangles = (
        (a * b * c + a**3 * log) / 6,  # Eq. (11)
        a**2 * log / 2,  # Eq. (13)
        a * rise / 2,  # Eq. (12)
        a**3 * log / 3,  # Eq. (15)
        a**2 * rise / 3,  # the mixed moment by which Eqs (14) and (15) turn to the axes x1, x2
    )
    # the triangle to the edge's end less the one to its start
    T, s_m, s_d, j_mm, j_md = (np.diff(triangle, axis=-1) for triangle in triangles)
    s = s_m * m + s_d * d
    j = j_mm * m**2 + 2 * j_md * m * d + (T - j_mm) * d**2
    return np.asarray(np.stack([-s[..., 1], s[..., 0], T[..., 0], j[..., 1], j[..., 0]]).sum(-1))


def _quadrature(edges: Array, centres: Array) -> Array:
    """V1, V2, T, T1, T2 and T about the origin (6, k) for centres (k, 2) outside the circle of radius 1.

    Gauss points on the fan of triangles from the origin; the parts of the fan outside the polygon cancel.
    """
    node, weight = np.polynomial.legendre.leggauss(GAUSS)
    s, t = np.meshgrid((1 + node) / 2, (1 + node) / 2)
    p, q = edges[:, 0], edges[:, 1]
    x = (s[..., None, None] * (p + t[..., None, None] * (q - p))).reshape(-1, 2)
    area = (np.outer(weight, weight)[..., None] / 4 * s[..., None] * cross(p, q)).ravel()
    rel = x - centres[:, None]
    dist, rho = np.hypot(rel[..., 0], rel[..., 1]), np.hypot(centres[:, 0], centres[:, 1])[:, None]
    along, square = centres @ x.T / rho, (x**2).sum(-1)
    # r . (r - c)/|r - c| less its constant part -r . c/|c|, which has no moment about the centroid
    turning = (square - along * (2 * rho * along - square) / (rho + dist)) / dist
    unit = rel / dist[..., None]
    torques = (dist, rel[..., 1] * unit[..., 1], rel[..., 0] * unit[..., 0], turning)
    return np.stack([field @ area for field in (-unit[..., 1], unit[..., 0], *torques)])


def torsion_integrals(region: Region, centres: Any, reference: Any = None) -> TorsionIntegrals:
    """Integrate the limit shear stress of a twist about each centre, Eqs (6)-(15).

    Parameters
    ----------
    region : Region
        Ring (n, 2), several rings, or shapely geometry, m.
    centres : array (..., 2)
        Twisting centres: inside, outside, on an edge, on a vertex, or far away, m.
    reference : array (2,), optional
        Point to which `T_reference` belongs; the centroid unless given, m.

    Returns
    -------
    TorsionIntegrals
        Per unit ``mu |sigma|``. Relative accuracy at any distance of the centre, measured: V and T 1e-13,
        T_reference 1e-11 up to an aspect ratio of 100; 1e-11 and 1e-9 at 10,000.
    """
    edges, centroid, size = normalised_edges(region)
    places = (np.asarray(centres, dtype=float) - centroid) / size
    x = places.reshape(-1, 2)
    far = np.hypot(x[:, 0], x[:, 1]) > FAR
    values = np.empty((6, len(x)))
    near = x[~far, None]
    values[:5, ~far] = _edge_sums(edges[:, 0] - near, edges[:, 1] - near)
    values[5, ~far] = values[2, ~far] + cross(x[~far], values[:2, ~far].T)
    values[:, far] = _quadrature(edges, x[far])
    values *= np.array([size**2] * 2 + [size**3] * 4)[:, None]
    lever = np.zeros(2) if reference is None else centroid - np.asarray(reference, dtype=float)
    values[5] += cross(lever, values[:2].T)
    return TorsionIntegrals(*values.reshape(6, *places.shape[:-1]))


def torsion_constant(region: Region, centre: Any = None) -> float:
    """Torsion constant ``c_T = T0 / (mu |N|)`` about `centre`, the centroid unless given, m (Eqs 6 and 16).

    The strength in pure torsion belongs to the plastic centre: ``torsion_constant(p, plastic_centre(p))``.
    There V = 0, so that T is the same about every point. Both agree for centrally symmetric polygons.
    """
    shape = as_region(region)
    centre = shapely.get_coordinates(shape.centroid)[0] if centre is None else centre
    return float(torsion_integrals(shape, centre).T) / float(shape.area)


def torsion_constants(polygons: Any) -> Array:
    """Torsion constants (...,) about the centroids of `polygons` (..., n, 2), m (Eqs 6 and 16).

    Repeat a vertex to bring polygons to the same n.

    Raises
    ------
    GeometryError
        If a polygon has no area, or they are no vertices; whether it crosses itself is not checked.
    """
    polygons = stacked(polygons)
    area = areas(polygons)
    flat = ~(np.abs(area) > 1e-14 * np.ptp(polygons, axis=-2).sum(-1) ** 2)
    if flat.any():
        raise GeometryError(
            f"interface polygon {flat.argmax()} must have an area; it has {area[flat][0]:g} m2"
        )
    start = polygons - centroids(polygons)[..., None, :]
    return np.asarray(_edge_sums(start, np.roll(start, -1, axis=-2))[2] / area)


def rectangle_torsion_constant(l1: Any, l2: Any) -> Array:
    """Torsion constant of rectangles of half sides l1, l2 >= 0 (broadcast), m (Eq. 17).

    The limit l1 -> 0 is l2 / 2, which is Eq. (22); a point has none.
    """

    def ln_term(a: Array, b: Array) -> Array:  # a^2 / b ln((b + c) / a)
        slope = np.maximum(b / np.maximum(a, TINY), 1e-9)
        return np.asarray(a * np.arcsinh(slope) / slope)

    l1, l2 = np.asarray(l1, dtype=float), np.asarray(l2, dtype=float)
    return np.asarray((np.hypot(l1, l2) + ln_term(l1, l2) / 2 + ln_term(l2, l1) / 2) / 3)


def plastic_centre(region: Region) -> Array:
    """Centre of plastic torsion (2,), m: the twisting centre without shear force, V1 = V2 = 0 (Section 2).

    It minimises the convex T(c) of Eq. (6), so it is unique: the geometric median of the area. Newton's
    method with exact derivatives, until the step is below 1e-14 sizes.
    """
    edges, centroid, size = normalised_edges(region)
    c = np.zeros(2)
    for _ in range(100):
        gradient, hessian = _derivatives(edges - c)
        step = -np.linalg.solve(hessian, gradient)
        while _derivatives(edges - c - step)[0] @ step > -gradient @ step / 2:  # far beyond the minimum
            step /= 2
        c = c + step
        if np.hypot(*step) < 1e-14:
            break
    return np.asarray(centroid + size * c)


def _derivatives(edges: Array) -> tuple[Array, Array]:
    """Gradient (2,) and Hessian (2, 2) of T by the twisting centre, at the origin of the edges (E, 2, 2).

    The gradient is -(integral of u), u = (r - c) / |r - c|; the Hessian is the boundary integral of u m^T.
    """
    p, q = edges[:, 0], edges[:, 1]
    V1, V2 = _edge_sums(p, q)[:2]
    a, b, c, m, d = _legs(p, q)
    log = np.arcsinh(b / np.maximum(np.abs(a), TINY))
    along_edge = a * np.diff(log, axis=-1) * m + np.diff(c, axis=-1) * d
    return np.array([-V2, V1]), along_edge.T @ m

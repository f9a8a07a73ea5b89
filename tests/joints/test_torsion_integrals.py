"""Eqs (6)-(15) over any polygon against ray casting, closed forms and limits."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad
from shapely import MultiPolygon, Polygon

from limitblocks.errors import GeometryError
from limitblocks.joints.torsion import as_region, torsion_integrals

SQUARE = np.array([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)])
ELL = np.array([(0, 0), (3, 0), (3, 1), (1, 1), (1, 4), (0, 4.0)])
NAMES = ("V1", "V2", "T", "T1", "T2", "T_reference")


def star(seed, n=8):
    """A star-shaped polygon, as a rule not convex."""
    rng = np.random.default_rng(seed)
    angle = (np.arange(n) + rng.uniform(0, 0.8, n)) * 2 * np.pi / n
    return rng.uniform(0.3, 1.5, (n, 1)) * np.stack([np.cos(angle), np.sin(angle)], axis=1) + [0.4, -0.2]


HOLED = [ELL, np.array([(0.2, 0.2), (0.7, 0.3), (0.4, 0.8)]), np.add(SQUARE, (4, 4))]


def by_rays(rings, centre, reference):
    """V1, V2, T, T1, T2, T_reference by ray casting: even-odd radii along a ray, adaptive rule over rays."""
    rings = [np.asarray(ring, float) - centre for ring in rings]
    p, q = np.concatenate(rings), np.concatenate([np.roll(ring, -1, axis=0) for ring in rings])
    vertex = p[np.hypot(*p.T) > 1e-12]
    breaks = np.unique(np.r_[0, np.mod(np.arctan2(vertex[:, 1], vertex[:, 0]), 2 * np.pi), 2 * np.pi])
    edge = q - p

    def moment(angle, power):
        """Integral of r^power dr over the parts of the ray inside."""
        u = np.array([np.cos(angle), np.sin(angle)])
        across = u[0] * edge[:, 1] - u[1] * edge[:, 0]
        across[across == 0] = np.nan
        radius = (p[:, 0] * edge[:, 1] - p[:, 1] * edge[:, 0]) / across
        place = (p[:, 0] * u[1] - p[:, 1] * u[0]) / across
        radii = np.sort(radius[(radius > 0) & (place >= 0) & (place < 1)])[::-1]
        return (radii[::2] ** (power + 1)).sum() / (power + 1) - (radii[1::2] ** (power + 1)).sum() / (
            power + 1
        )

    integrands = (
        lambda t: -np.sin(t) * moment(t, 1),
        lambda t: np.cos(t) * moment(t, 1),
        lambda t: moment(t, 2),
        lambda t: np.sin(t) ** 2 * moment(t, 2),
        lambda t: np.cos(t) ** 2 * moment(t, 2),
    )
    V1, V2, T, T1, T2 = (
        sum(quad(f, lo, hi, epsabs=1e-12, epsrel=1e-11)[0] for lo, hi in pairwise(breaks) if hi - lo > 1e-12)
        for f in integrands
    )
    lever = np.asarray(centre) - reference
    return np.array([V1, V2, T, T1, T2, T + lever[0] * V2 - lever[1] * V1])


def values(region, centres, reference=None):
    result = torsion_integrals(region, centres, reference)
    return np.stack([getattr(result, name) for name in NAMES])


@pytest.mark.parametrize(
    ("rings", "centre"),
    [
        ([SQUARE], (0.1, 0.2)),
        ([ELL], (0.5, 0.5)),
        ([ELL], (2.0, 3.0)),  # outside, in the notch
        ([ELL], (1.0, 1.0)),  # the re-entrant vertex
        ([ELL], (1.0, 2.5)),  # on an edge
        ([ELL], (2.0, 4.0)),  # on the lines of an edge and outside
        ([star(1)], (0.3, -0.1)),
        ([star(2)], (-1.5, 1.0)),
        ([star(3, 12)], (6.0, 7.0)),  # far: quadrature
        (HOLED, (0.4, 0.4)),  # in the hole
        (HOLED, (2.5, 2.5)),  # between the parts
    ],
)
def test_polygons_against_ray_casting(rings, centre):
    reference = np.array([0.3, 0.7])
    expected = by_rays(rings, centre, reference)
    np.testing.assert_allclose(values(rings, centre, reference), expected, rtol=1e-8, atol=1e-9)


def test_shapely_rings_and_order_of_vertices_agree():
    first = values(HOLED, (0.1, 0.2))
    shape = MultiPolygon([Polygon(HOLED[0], [HOLED[1]]), Polygon(HOLED[2])])
    for same in (shape, [ring[::-1] for ring in HOLED], [np.repeat(ring, 2, axis=0) for ring in HOLED]):
        np.testing.assert_allclose(values(same, (0.1, 0.2)), first, rtol=1e-13)
    np.testing.assert_allclose(values(as_region(shape.reverse()), (0.1, 0.2)), first, rtol=1e-13)


def triangle(a, b):
    """Eqs (11)-(15) with the signs of V1 and of Eq. (14) put right; twisting centre at the corner."""
    c = np.hypot(a, b)
    ln = np.log((b + c) / a)
    T2 = a**3 * ln / 3
    T1 = a / (6 * c) * (b**3 + a**2 * (b - c * ln))
    return -(a * c - a**2) / 2, a**2 * ln / 2, (a * b * c + a**3 * ln) / 6, T1, T2


@pytest.mark.parametrize(("a", "b"), [(1.0, 1.0), (2.0, 0.3), (0.2, 5.0)])
def test_right_triangle_is_eqs_11_to_15(a, b):
    result = values(np.array([(0, 0), (a, 0), (a, b)]), (0.0, 0.0))[:5]
    np.testing.assert_allclose(result, triangle(a, b), rtol=1e-12)


def test_printed_sign_of_eq_14_contradicts_t1_plus_t2():
    a, b, c = 3.0, 4.0, 5.0
    ln = np.log((b + c) / a)
    printed = a / (6 * c) * (b**3 + a**2 * (b + c * ln))
    _, _, T, T1, T2 = triangle(a, b)
    assert pytest.approx(T, rel=1e-14) == T1 + T2
    assert printed + T2 != pytest.approx(T, rel=0.1)


@pytest.mark.parametrize("slender", [1e-3, 1e-5])
def test_limits_of_a_and_b(slender):
    """To first order T = a b^2 / 6 for a -> 0 and a^2 b / 3 for b -> 0: rods of linear density."""
    T_a = values(np.array([(0, 0), (slender, 0), (slender, 1.0)]), (0.0, 0.0))[2]
    T_b = values(np.array([(0, 0), (1.0, 0), (1.0, slender)]), (0.0, 0.0))[2]
    assert T_a == pytest.approx(slender / 6, rel=10 * slender**2 * np.log(1 / slender))
    assert T_b == pytest.approx(slender / 3, rel=slender**2)


@pytest.mark.parametrize("place", [(0.5, 0.2), (0.5, 0.5), (0.5, 0.8), (1.0, 0.5)])  # edge, vertex, edge line
def test_centre_on_the_boundary_is_the_limit_of_its_neighbours(place):
    for shift in (1e-7, 1e-12, 1e-18, 1e-200):
        around = np.array(place) + shift * np.array([(1, 0), (-1, 0), (0, 1), (0, -1), (0, 0)])
        result = values(SQUARE, around)
        assert np.isfinite(result).all()
        np.testing.assert_allclose(
            result, result[:, -1:] * np.ones(5), rtol=20 * shift + 1e-12, atol=1e-13 + 20 * shift
        )


def test_centre_at_a_vertex_of_the_square():
    """Two right triangles of legs 1 and 1: T = (sqrt 2 + asinh 1) / 3 (Eq. 11)."""
    assert values(SQUARE, (0.5, 0.5))[2] == pytest.approx((np.sqrt(2) + np.arcsinh(1)) / 3, rel=1e-14)


@pytest.mark.parametrize("region", [SQUARE, ELL, HOLED, star(5)], ids=["square", "ell", "holed", "star"])
def test_far_centres_follow_the_expansion_in_second_moments(region):
    """Far along x: T about the centroid -> (integral of y^2) / distance, V2 -> -area."""
    shape = as_region(region)
    x0, y0 = shape.centroid.x, shape.centroid.y
    rings = [np.array(part.exterior.coords) for part in getattr(shape, "geoms", [shape])]
    holes = [np.array(hole.coords) for part in getattr(shape, "geoms", [shape]) for hole in part.interiors]
    second = sum(abs(_second_moment(ring - [x0, y0])) for ring in rings)
    second -= sum(abs(_second_moment(hole - [x0, y0])) for hole in holes)
    for distance in (1e6, 1e9, 1e15):
        V1, V2, T, _, _, T_centroid = values(region, (x0 + distance, y0))
        assert pytest.approx(-shape.area, rel=1e-11) == V2
        assert abs(V1) < 10 / distance**2 * shape.area + 1e-14
        assert pytest.approx(shape.area * distance, rel=1e-9) == T
        assert T_centroid == pytest.approx(second / distance, rel=20 / distance + 1e-12)


def _second_moment(ring):
    """Integral of y^2 over a closed ring, signed."""
    (x, y), (u, v) = ring[:-1].T, ring[1:].T
    return ((x * v - u * y) * (y**2 + y * v + v**2)).sum() / 12


def test_exact_and_quadrature_agree_where_they_meet(monkeypatch):
    angle = np.linspace(0, 6, 7)
    size = np.hypot(*(star(4) - as_region(star(4)).centroid.coords[0]).T).max()
    centres = as_region(star(4)).centroid.coords[0] + 2.9 * size * np.stack(
        [np.cos(angle), np.sin(angle)], axis=1
    )
    exact = values(star(4), centres)
    monkeypatch.setattr("limitblocks.joints.torsion.FAR", 2.8)
    np.testing.assert_allclose(values(star(4), centres), exact, rtol=1e-11, atol=1e-12)


def test_t1_and_t2_add_up_and_any_shape_of_centres_is_kept():
    centres = np.random.default_rng(0).normal(size=(3, 4, 2)) * 4
    V1, _, T, T1, T2, _ = values(ELL, centres)
    assert V1.shape == (3, 4)
    np.testing.assert_allclose(T1 + T2, T, rtol=1e-13)


def test_scaling_translation_rotation_and_mirror():
    centres = np.random.default_rng(1).normal(size=(20, 2)) * 4
    V1, V2, T, T1, T2, T_c = values(ELL, centres)
    scaled = values(1024 * ELL, 1024 * centres) / 1024.0 ** np.array([2, 2, 3, 3, 3, 3])[:, None]
    np.testing.assert_allclose(scaled, [V1, V2, T, T1, T2, T_c], rtol=1e-14)
    np.testing.assert_allclose(
        values(np.add(ELL, (7, 3)), np.add(centres, (7, 3))), [V1, V2, T, T1, T2, T_c], rtol=1e-11, atol=1e-12
    )
    quarter = np.array([(0, 1), (-1, 0)])  # row vectors: (x, y) -> (-y, x)
    np.testing.assert_allclose(
        values(ELL @ quarter, centres @ quarter), [-V2, V1, T, T2, T1, T_c], rtol=1e-11, atol=1e-12
    )
    mirrored = values(ELL * [-1, 1], centres * [-1, 1])  # the twist keeps its sense
    np.testing.assert_allclose(mirrored, [V1, -V2, T, T1, T2, T_c], rtol=1e-11, atol=1e-12)


@pytest.mark.parametrize(
    ("region", "message"),
    [
        ([(0, 0), (1, 1), (1, 0), (0, 1)], "must be simple.*Self-intersection"),
        ([(0, 0), (1, 0), (2, 0)], "must"),
        ([(0, 0), (1, 0), (1, 1e-20), (0, 1e-20)], "must"),
        ([(0, 0), (1, 0)], r"shape \(n >= 3, 2\)"),
        ([(0, 0, 0), (1, 0, 0), (1, 1, 0)], r"shape \(n >= 3, 2\)"),
        ([(0, 0), (1, 0), (np.nan, 1)], "finite"),
        (Polygon([(0, 0), (1, 1), (1, 0), (0, 1)]), "must be simple"),
        (Polygon(), "must have an area"),
    ],
)
def test_impossible_polygons_are_named(region, message):
    with pytest.raises(GeometryError, match=message):
        torsion_integrals(region, (0.0, 0.0))

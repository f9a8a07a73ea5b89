"""Interaction curves of Sections 3 and 4 of the paper."""

import numpy as np
import pytest

from limitblocks.errors import GeometryError, ModelError
from limitblocks.geometry.polygon import areas
from limitblocks.joints.interaction import (
    approximate_torsion_bending,
    approximate_torsion_shear,
    eccentricity,
    effective_areas,
    effective_half_sides,
    effective_strength,
    rectangle_torsion_bending,
    shear_strength,
    slender_across,
    slender_along,
    torsion_bending,
    torsion_shear_curve,
)
from limitblocks.joints.torsion import torsion_constant

SQUARE = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
L1, L2, MU, N = 0.15, 0.10, 0.7, -240.0  # Figs 8(b) and 12
RECTANGLE = SQUARE * [L1, L2]
POINTS = {  # Table 4: M1, M2, T
    "A": (-L2 * N, 0.0, -MU * N * L1 / 2),
    "B": (-L2 * N, -L1 * N, 0.0),
    "C": (0.0, -L1 * N, -MU * N * L2 / 2),
}


def moments(count, reach=1.0):
    """M1, M2 with the point of action in the rectangle, in all quadrants."""
    e = np.random.default_rng(0).uniform(-reach, reach, (count, 2)) * [L1, L2]
    return N * e[:, 1], -N * e[:, 0]


def test_unit_square_values():
    """Reading notes, section 4: unit square, the centre moves along x2."""
    V, T = torsion_shear_curve(SQUARE / 2, (0, 3), [0, 0.2, 0.5, 1, np.inf])
    np.testing.assert_allclose(V, [0, 0.34855, 0.79023, 0.95344, 1], atol=1e-5)
    np.testing.assert_allclose(T, [1, 0.90943, 0.51783, 0.23519, 0], atol=1e-5)


@pytest.mark.parametrize(("ratio", "bound"), [(1e-4, slender_along), (1e4, slender_across)])
def test_bounding_curves_are_the_slender_limits(ratio, bound):
    s = np.array([0, 0.1, 0.5, 0.9, 0.999, 1.2, 2, 10, np.inf])
    rectangle = SQUARE * ([1, ratio] if ratio < 1 else [1 / ratio, 1])
    np.testing.assert_allclose(torsion_shear_curve(rectangle, (1, 0), s), bound(s), atol=2e-4)


def test_bounding_curves_against_quadrature_of_the_segment():
    node, weight = np.polynomial.legendre.leggauss(200)
    for s in (0.3, 0.99999, 1.00001, 3.0):
        r = np.hypot(s, node)
        expected = weight @ (s / r) / 2, weight @ (node**2 / r)
        np.testing.assert_allclose(slender_across(s), expected, rtol=1e-9)
    np.testing.assert_allclose(slender_across(1e6)[1], 2 / 3e6, rtol=1e-9)


@pytest.mark.parametrize("ratio", [0.1, 0.5, 1.0, 2.0, 10.0])
def test_family_of_fig_7_lies_between_its_bounds(ratio):
    V, T = torsion_shear_curve(SQUARE * [1, ratio], (1, 0), np.logspace(-3, 3, 100) * max(1, ratio))
    upper = slender_across(np.r_[0, np.logspace(-8, 8, 4000)])
    assert (T >= 1 - V**2 - 1e-12).all()
    assert (np.interp(V, *upper) + 1e-5 >= T).all()
    assert (np.diff(V) > 0).all()
    assert (np.diff(T) < 0).all()


def test_planes_of_eqs_23_to_29():
    """Above the lower curve everywhere, by 0.3 at pure shear; below the upper one in the middle."""
    V = np.linspace(0, 1, 101)
    above = approximate_torsion_shear(V) - (1 - V**2)
    assert above.min() >= 0
    assert above[-1] == pytest.approx(0.3)
    upper = np.interp(V, *slender_across(np.r_[0, np.logspace(-8, 8, 4000)]))
    assert (approximate_torsion_shear(V) - upper).min() < -0.17
    np.testing.assert_array_equal(approximate_torsion_shear([0.3, -1.0, 1.1]), [1, 1.3 - 1, 0])


def test_strengths_without_bending():
    """Eqs (16) and (18); T0 = 16.26 N m in Fig. 12. Nothing in tension."""
    np.testing.assert_allclose(shear_strength(MU, [N, 0, 10]), [168, 0, 0])
    assert rectangle_torsion_bending(L1, L2, MU, N, 0, 0) == pytest.approx(16.26, abs=0.005)
    assert approximate_torsion_bending(L1, L2, MU, N, 0, 0) == pytest.approx(16.26, abs=0.005)


@pytest.mark.parametrize("point", POINTS)
def test_table_4(point):
    M1, M2, T = POINTS[point]
    for s1, s2 in ((1, 1), (-1, 1), (1, -1), (-1, -1)):
        assert rectangle_torsion_bending(L1, L2, MU, N, s1 * M1, s2 * M2) == pytest.approx(T, abs=1e-12)
        assert approximate_torsion_bending(L1, L2, MU, N, s1 * M1, s2 * M2) == pytest.approx(T, abs=1e-12)
        assert torsion_bending(RECTANGLE, MU, N, s1 * M1, s2 * M2) == pytest.approx(T, abs=1e-7)


def test_eq_30_is_exact_on_the_hinge_lines_and_above_elsewhere():
    M1, M2 = moments(500)
    assert (
        approximate_torsion_bending(L1, L2, MU, N, M1, M2) >= rectangle_torsion_bending(L1, L2, MU, N, M1, M2)
    ).all()
    for line in ((np.full(500, -L2 * N), M2), (M1, np.full(500, L1 * N))):
        exact = rectangle_torsion_bending(L1, L2, MU, N, *line)
        np.testing.assert_allclose(approximate_torsion_bending(L1, L2, MU, N, *line), exact, atol=1e-12)
        # Eq. (22) with the effective half side
        e = np.abs(eccentricity(N, *line))
        half = np.where(np.isclose(e[:, 0], L1), L2 - e[:, 1], L1 - e[:, 0])
        np.testing.assert_allclose(exact, -MU * N * half / 2, atol=1e-12)


def test_beyond_a_hinge_there_is_no_strength():
    for strength in (rectangle_torsion_bending, approximate_torsion_bending):
        for sign in (1.0001, -1.0001):
            assert strength(L1, L2, MU, N, sign * L2 * N, 0) == strength(L1, L2, MU, N, 0, sign * L1 * N) == 0
    assert torsion_bending(RECTANGLE, MU, N, 1.0001 * L2 * N, 0) == 0
    np.testing.assert_array_equal(effective_half_sides(L1, L2, N, 1.0001 * L2 * N, 0), [0, 0])


def test_effective_rectangle():
    """Eqs (19) and (20)."""
    M1, M2 = moments(50)
    sides = effective_half_sides(L1, L2, N, M1, M2)
    np.testing.assert_allclose(sides, np.c_[L1 - np.abs(M2 / N), L2 - np.abs(M1 / N)], rtol=1e-12)
    areas = [area.area for area in effective_areas(RECTANGLE, eccentricity(N, M1, M2))]
    np.testing.assert_allclose(areas, 4 * sides.prod(axis=1), rtol=1e-12)


def test_eq_21_needs_the_cube_of_the_force():
    """As printed, N^2 over two moments is 1 / m2; with |N|^3 it is the stress that balances N."""
    M1, M2 = 10.0, -20.0
    moments_left = (-L1 * N - abs(M2)) * (-L2 * N - abs(M1))
    stress = -N / (4 * effective_half_sides(L1, L2, N, M1, M2).prod())
    assert stress == pytest.approx(abs(N) ** 3 / (4 * moments_left), rel=1e-12)


def test_rectangle_is_a_case_of_the_general_polygon():
    M1, M2 = moments(100, 0.99)
    exact = rectangle_torsion_bending(L1, L2, MU, N, M1, M2)
    np.testing.assert_allclose(torsion_bending(RECTANGLE, MU, N, M1, M2), exact, rtol=1e-11)


HEXAGON = np.array([(np.cos(t), 0.6 * np.sin(t)) for t in np.arange(6) * np.pi / 3])
TRIANGLE = np.array([(0.0, 0.0), (4.0, 0.0), (0.0, 1.0)])


@pytest.mark.parametrize("polygon", [HEXAGON, TRIANGLE], ids=["hexagon", "triangle"])
def test_effective_area_is_symmetric_about_the_point_of_action(polygon):
    centroid = polygon.mean(axis=0)
    weights = np.random.default_rng(2).dirichlet(np.ones(len(polygon)), 30)
    e = weights @ polygon - centroid
    for point, area in zip(e, effective_areas(polygon, e), strict=True):
        np.testing.assert_allclose(area.centroid.coords[0], centroid + point, atol=1e-12)
        assert area.convex_hull.area == pytest.approx(area.area, rel=1e-9)
    moment = torsion_bending(polygon, 1.0, -1.0, -e[:, 1], e[:, 0])
    assert (moment > 0).all()
    assert (moment <= torsion_constant(polygon)).all()


def test_hexagon_without_bending_is_used_whole_and_a_triangle_is_not():
    assert torsion_bending(HEXAGON, 0.5, -2.0, 0, 0) == pytest.approx(torsion_constant(HEXAGON), rel=1e-12)
    # the median cut of a triangle: a hexagon of two thirds of its area
    assert effective_areas(TRIANGLE, (0, 0)).item().area == pytest.approx(2 / 3 * 2, rel=1e-12)


def test_hinge_on_an_oblique_side():
    """Only the nearer part of the side and its reflection carry: T = mu |N| times half the smaller part."""
    centroid, length = TRIANGLE.mean(axis=0), np.hypot(4, 1)
    for part in (0.0, 0.1, 0.5, 0.8, 1.0):
        e = TRIANGLE[1] * (1 - part) + TRIANGLE[2] * part - centroid
        expected = 0.7 * 5 * min(part, 1 - part) * length / 2
        assert torsion_bending(TRIANGLE, 0.7, -5.0, -5 * e[1], 5 * e[0]) == pytest.approx(expected, abs=1e-7)


@pytest.mark.parametrize("beyond", [0.0, 5e-10])
@pytest.mark.parametrize("slender", [1.0, 1e-6])
def test_a_hinge_is_one_whatever_rounding_says(slender, beyond):
    """Eq. (22), with a corner of the polygon given twice, and on a strip a micrometre wide."""
    rectangle = RECTANGLE[[0, 1, 1, 2, 3]] * [1.0, slender]
    l2 = L2 * slender
    N = -np.arange(1.0, 30.0) / 7.0
    hinge = 0.6 * -N * L1 / 2
    assert np.allclose(
        rectangle_torsion_bending(L1, l2, 0.6, N, -N * l2 * (1 + beyond), 0.0), hinge, rtol=1e-8
    )
    assert np.allclose(
        torsion_bending(rectangle, 0.6, N[:3], -N[:3] * l2 * (1 + beyond), 0.0), hinge[:3], rtol=1e-7
    )


def test_effective_strength_is_eqs_41_and_42():
    assert effective_strength(20e6) == pytest.approx((0.7 - 20 / 200) * 20e6, rel=1e-15)
    assert effective_strength(60e6) == pytest.approx(0.4 * 60e6, rel=1e-15)
    for fc in (0.0, -1e6, 20.0, 60.1e6, np.inf, np.nan):
        with pytest.raises(ModelError, match=r"strength fc is .* Pa.*from 10000 to 6e\+07 Pa"):
            effective_strength(fc)
    with pytest.raises(ModelError, match="strength fc is '3e6', expected a number in Pa"):
        effective_strength("3e6")


def test_impossible_questions_are_named():
    with pytest.raises(ModelError, match="normal force N is 0 N"):
        eccentricity([N, 0.0], 1.0, 1.0)
    ell = np.array([(0, 0), (3, 0), (3, 1), (1, 1), (1, 4), (0, 4.0)])
    with pytest.raises(GeometryError, match="convex"):
        effective_areas(ell, (0, 0))


def test_a_polygon_symmetric_but_for_rounding_errors_is_effective_whole():
    """GEOS 3.14 gives points, without an area, for some of these parallelograms and their reflections."""
    rng = np.random.default_rng(0)
    corners = SQUARE * rng.uniform(0.3, 1.0, (4000, 1, 2)) @ rng.normal(size=(4000, 2, 2))
    corners += rng.normal(0.0, 1e-15, corners.shape)
    wide = np.abs(areas(corners)) > 0.3
    parallelograms = [p if areas(p) > 0.0 else p[::-1] for p in corners[wide]]
    found = [effective_areas(p, (0.0, 0.0)).item() for p in parallelograms]
    np.testing.assert_allclose([one.area for one in found], [areas(p) for p in parallelograms], rtol=1e-9)

"""The limit surface (Goyal, Ruina & Papadopoulos 1991): support function, gradient, polytopes."""

import numpy as np
import pytest

from limitblocks.errors import GeometryError, ModelError
from limitblocks.joints.limit_surface import (
    directions,
    dissipation,
    inner_polytope,
    limit_points,
    outer_polytope,
    unique_shapes,
)
from limitblocks.joints.torsion import rectangle_torsion_constant, torsion_constant

RECTANGLE = np.array([(-0.15, -0.1), (0.15, -0.1), (0.15, 0.1), (-0.15, 0.1)])
TRIANGLE = np.array([(0.0, 0.0), (4.0, 0.0), (0.0, 1.0)])
ELL = np.array([(0, 0), (3, 0), (3, 1), (1, 1), (1, 4), (0, 4.0)])
FRAME = [ELL, np.array([(0.2, 0.2), (0.7, 0.3), (0.4, 0.8)])]
REGIONS = {
    "rectangle": RECTANGLE,
    "triangle": TRIANGLE,
    "ell": ELL,
    "frame": FRAME,
    "thin": RECTANGLE * [1, 0.01],
}

every_region = pytest.mark.parametrize("region", REGIONS.values(), ids=REGIONS)


def some_rates(seed, count=200):
    """Strain rates of all directions, some nearly translations, some nearly twists."""
    rng = np.random.default_rng(seed)
    return rng.normal(size=(count, 3)) * 10.0 ** rng.uniform(-3, 3, (count, 3))


def test_dissipation_is_the_mean_slip_of_the_rectangle():
    """Against 24 x 24 Gauss points; the centre of twist is outside, so that the integrand is smooth."""
    node, weight = np.polynomial.legendre.leggauss(24)
    x, y = np.meshgrid(0.15 * node, 0.1 * node)
    for rates in ((1.0, 0.4, 2.0), (-0.3, 1.0, -3.0), (0.2, 0.0, 0.0)):
        slip = np.hypot(rates[0] - rates[2] * y, rates[1] + rates[2] * x)
        assert dissipation(RECTANGLE, rates) == pytest.approx(weight @ slip @ weight / 4, rel=1e-12)


def test_pure_slip_and_pure_twist():
    rates = [(3.0, 4.0, 0.0), (0.0, 0.0, 2.0), (0.0, 0.0, -2.0), (0.0, 0.0, 0.0)]
    c_T = rectangle_torsion_constant(0.15, 0.1)
    np.testing.assert_allclose(
        dissipation(RECTANGLE, rates), [5.0, 2 * c_T, 2 * c_T, 0.0], rtol=1e-14, atol=1e-200
    )
    np.testing.assert_allclose(
        limit_points(RECTANGLE, rates[:3]), [(0.6, 0.8, 0), (0, 0, c_T), (0, 0, -c_T)], rtol=1e-14, atol=1e-15
    )


@every_region
def test_gradient_against_finite_differences(region):
    rates = some_rates(0, 40)
    length = torsion_constant(region)
    points = limit_points(region, rates)
    for i, step in enumerate((1.0, 1.0, 1 / length)):
        h = 1e-5 * dissipation(region, rates)[:, None] * step * np.eye(3)[i]
        central = (dissipation(region, rates + h) - dissipation(region, rates - h)) / (2 * h[:, i])
        np.testing.assert_allclose(points[:, i] * step, central * step, atol=2e-8)


@every_region
def test_support_function(region):
    """Degree one, even, convex; the gradient attains it, and no point of the set exceeds it (normality)."""
    rates, points = some_rates(1), limit_points(region, some_rates(1))
    D = dissipation(region, rates)
    np.testing.assert_allclose(dissipation(region, -3 * rates), 3 * D, rtol=1e-13)
    np.testing.assert_allclose((points * rates).sum(axis=1), D, rtol=1e-11)
    assert (points @ rates.T <= D * (1 + 1e-11)).all()
    assert (dissipation(region, (rates[::2] + rates[1::2]) / 2) <= (D[::2] + D[1::2]) / 2 * (1 + 1e-12)).all()


@every_region
def test_inner_exact_outer(region):
    inner, outer = inner_polytope(region), outer_polytope(region)
    points = limit_points(region, some_rates(2, 1000))
    reach = points @ inner.normals.T
    assert (reach <= outer.offsets + 1e-12).all()
    assert (reach.max(axis=1) >= 0).all()
    assert (reach <= (1 + inner.gap) * inner.offsets + 1e-12).all()
    # every exact boundary point is on or outside the inner hull
    assert ((reach / inner.offsets).max(axis=1) >= 1 - 1e-12).all()
    # planes of both are parallel; outer never inside, and never beyond the gap
    np.testing.assert_array_equal(inner.normals, outer.normals)
    assert (inner.offsets <= outer.offsets * (1 + 1e-12)).all()
    assert 0 < inner.gap == outer.gap < 0.09


@every_region
def test_gap_falls_as_the_square_of_the_fineness(region):
    gaps = np.array([inner_polytope(region, fineness).gap for fineness in (4, 8, 16)])
    assert (gaps[:-1] / gaps[1:] > 3).all()
    assert (gaps * [16, 64, 256] < 2).all()


def test_strengths_along_the_axes_are_met_by_both():
    """Even an octahedron is exact in pure shear along the axes and in pure torsion of a rectangle."""
    c_T = rectangle_torsion_constant(0.15, 0.1)
    pure = np.array([(1, 0, 0), (0, -1, 0), (0, 0, c_T)])
    for fineness in (1, 3):
        polytope = inner_polytope(RECTANGLE, fineness)
        np.testing.assert_allclose(
            (pure @ polytope.normals.T / polytope.offsets).max(axis=1), 1.0, rtol=1e-12
        )


def test_polytopes_scale_move_and_turn_with_the_polygon():
    base = inner_polytope(ELL)
    for moved, factor in ((1024 * ELL, 1024), (np.add(ELL, (7, -3)), 1)):
        same = inner_polytope(moved)
        reach = limit_points(moved, some_rates(3) / [1, 1, factor]) / [1, 1, factor]
        np.testing.assert_allclose(reach, limit_points(ELL, some_rates(3)), rtol=1e-9, atol=1e-11)
        assert same.gap == pytest.approx(base.gap, rel=1e-6)
    turn = np.array([(0.8, 0.6), (-0.6, 0.8)])
    rates = some_rates(4)
    turned = limit_points(ELL @ turn, np.c_[rates[:, :2] @ turn, rates[:, 2]])
    points = limit_points(ELL, rates)
    np.testing.assert_allclose(turned, np.c_[points[:, :2] @ turn, points[:, 2]], rtol=1e-9, atol=1e-11)


def test_directions_are_unit_and_well_spread():
    for fineness in (1, 2, 5):
        d = directions(fineness)
        assert d.shape == (4 * fineness**2 + 2, 3)
        np.testing.assert_allclose(np.linalg.norm(d, axis=1), 1.0)
        nearest = np.sort(d @ d.T, axis=1)[:, -2]
        assert np.degrees(np.arccos(nearest)).min() > 50 / fineness


def test_unique_shapes():
    turned = np.roll(RECTANGLE, 1, axis=0)
    stack = np.stack([RECTANGLE, RECTANGLE * 2, turned, RECTANGLE, RECTANGLE * 2])
    stack += 1e-13 * np.random.default_rng(0).normal(size=stack.shape)
    first, shape_of = unique_shapes(stack)
    assert sorted(first) == [0, 1]
    np.testing.assert_array_equal(first[shape_of], [0, 1, 0, 0, 1])
    assert len(unique_shapes(np.zeros((0, 4, 2)))[0]) == 0


def test_errors_name_the_value():
    with pytest.raises(ModelError, match="strain rate"):
        limit_points(RECTANGLE, [(1, 0, 0), (0, 0, 0)])
    with pytest.raises(ModelError, match="fineness is 0"):
        inner_polytope(RECTANGLE, 0)
    with pytest.raises(GeometryError, match="must"):
        outer_polytope(RECTANGLE * [1, 0])

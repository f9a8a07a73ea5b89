"""Torsion constants, Eqs (16) and (17), and plastic centres."""

import numpy as np
import pytest
from scipy.optimize import minimize

from limitblocks.errors import GeometryError
from limitblocks.joints import areas
from limitblocks.joints.torsion import (
    plastic_centre,
    rectangle_torsion_constant,
    torsion_constant,
    torsion_constants,
    torsion_integrals,
)

SQUARE = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
TRIANGLE = np.array([(0.0, 0.0), (4.0, 0.0), (0.0, 1.0)])
ELL = np.array([(0, 0), (3, 0), (3, 1), (1, 1), (1, 4), (0, 4.0)])


@pytest.mark.parametrize(("l1", "l2"), [(1.0, 1.0), (0.15, 0.10), (3.0, 0.01), (1e-5, 2.0)])
def test_rectangle_is_eq_17(l1, l2):
    c = np.hypot(l1, l2)
    eq_17 = (c + l1**2 / (2 * l2) * np.log((l2 + c) / l1) + l2**2 / (2 * l1) * np.log((l1 + c) / l2)) / 3
    assert rectangle_torsion_constant(l1, l2) == pytest.approx(eq_17, rel=1e-10)
    assert torsion_constant(SQUARE * [l1, l2]) == pytest.approx(eq_17, rel=1e-10)


def test_rectangle_limits_are_eq_22():
    values = rectangle_torsion_constant([0.0, 3.0, 0.0, 1e-300, 1e-8], [3.0, 0.0, 0.0, 3.0, 3.0])
    np.testing.assert_allclose(values, [1.5, 1.5, 0.0, 1.5, 1.5], rtol=1e-14)


def regular(n):
    angle = np.arange(n) * 2 * np.pi / n
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


@pytest.mark.parametrize("n", [3, 5, 6])
def test_regular_polygons(n):
    """2 n right triangles of legs a = cos(pi/n), b = sin(pi/n), Eq. (11)."""
    a, b = np.cos(np.pi / n), np.sin(np.pi / n)
    expected = 2 * n * (a * b + a**3 * np.log((b + 1) / a)) / 6 / (n * a * b)
    assert torsion_constant(regular(n)) == pytest.approx(expected, rel=1e-13)


def test_a_list_of_corners_is_an_array():
    """One polygon of 2 x 2 m, and a stack of it and one of 4 x 4 m."""
    c_T = (np.sqrt(2) + np.arcsinh(1)) / 6  # of a square of side 1
    assert areas(SQUARE.tolist()) == pytest.approx(4.0)
    assert torsion_constants(SQUARE.tolist()) == pytest.approx(2 * c_T)
    stack = [SQUARE.tolist(), (2 * SQUARE).tolist()]
    np.testing.assert_allclose(areas(stack), [4.0, 16.0])
    np.testing.assert_allclose(torsion_constants(stack), [2 * c_T, 4 * c_T])


@pytest.mark.parametrize(
    "wrong", [[SQUARE.tolist(), TRIANGLE.tolist()], [1.0, 2.0], SQUARE[:2], "square", None]
)
def test_what_is_no_polygon_is_refused(wrong):
    for ask in (areas, torsion_constants):
        with pytest.raises(
            GeometryError, match=r"expected an array of shape \(\.\.\., n, 2\): repeat a vertex"
        ):
            ask(wrong)


def test_circle():
    """Disc: 2 R / 3; a 1000-gon is inscribed and smaller by some (pi / 1000)^2 / 3."""
    assert torsion_constant(regular(1000)) == pytest.approx(2 / 3, rel=(np.pi / 1000) ** 2 / 2)


def test_stack_is_the_single_ones():
    padded = np.array([(0, 0), (4, 0), (0, 1), (0, 1), (0, 1), (0, 1.0)])
    stack = np.array([ELL, ELL[::-1] * 2 + [5, 6], padded, ELL * [1, -3]])
    np.testing.assert_allclose(
        torsion_constants(stack),
        [torsion_constant(p) for p in (stack[0], stack[1], TRIANGLE, stack[3])],
        rtol=1e-13,
    )


def test_stack_names_the_polygon_without_area():
    with pytest.raises(GeometryError, match="polygon 1 must have an area"):
        torsion_constants(np.array([SQUARE, SQUARE * [1, 0]]))


REGIONS = {
    "triangle": TRIANGLE,
    "ell": ELL,
    "sliver": TRIANGLE * [1, 1e-4],
    "parts of unequal size": [SQUARE, np.add(2 * SQUARE, (12, 1))],
    "parts far apart": [SQUARE, np.add(SQUARE, (1000, 0)), np.add(0.9 * SQUARE, (200, 0))],
    "frame": [3 * SQUARE, np.add(SQUARE, (1, 0.5))],
}


@pytest.mark.parametrize("region", REGIONS.values(), ids=REGIONS)
def test_plastic_centre_has_no_shear_and_least_torsion(region):
    centre = plastic_centre(region)
    there = torsion_integrals(region, centre)
    area = torsion_integrals(region, (1e12, 0.0)).V2
    assert np.hypot(there.V1, there.V2) <= 1e-12 * abs(area)
    assert there.T_reference == pytest.approx(there.T, rel=1e-9)
    around = torsion_integrals(region, centre + np.random.default_rng(0).normal(size=(50, 2)))
    assert (around.T >= there.T).all()


@pytest.mark.parametrize("region", [SQUARE * [1, 5] + [3, 4], regular(7) * 2 + 1])
def test_plastic_centre_of_symmetric_polygons_is_the_centroid(region):
    np.testing.assert_allclose(plastic_centre(region), region.mean(axis=0), atol=1e-13)


def test_plastic_centre_of_the_triangle_by_search():
    search = minimize(
        lambda c: torsion_integrals(TRIANGLE, c).T,
        (1.0, 0.3),
        method="Nelder-Mead",
        options={"xatol": 1e-9, "fatol": 1e-16},
    )
    np.testing.assert_allclose(plastic_centre(TRIANGLE), search.x, atol=1e-6)
    assert torsion_constant(TRIANGLE, plastic_centre(TRIANGLE)) < torsion_constant(TRIANGLE)

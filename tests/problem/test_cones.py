"""Products of the cone K against dense definitions: Jordan algebra of one second-order cone at a time."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from limitblocks.problem import Cones
from limitblocks.problem.barrier import central, curvature, spread
from limitblocks.problem.cones import rays

CONES = Cones(2, ((2, 3), (1, 4)))
PARTS = [slice(2, 5), slice(5, 8), slice(8, 12)]
NUMBERS = st.integers(-40, 40).map(lambda k: k / 10)
VECTORS = st.lists(NUMBERS, min_size=12, max_size=12).map(np.array)


@st.composite
def interior(draw):
    """A vector inside K, at least 0.1 from its boundary."""
    v = draw(VECTORS)
    v[:2] = np.abs(v[:2]) + 0.1
    for part in PARTS:
        v[part.start] = np.linalg.norm(v[part][1:]) + 0.1 + abs(v[part.start])
    return v


def dense_arrow(w):
    matrix = w[0] * np.eye(len(w))
    matrix[0], matrix[:, 0] = w, w
    return matrix


@given(VECTORS, VECTORS)
def test_product_and_arrow(a, b):
    expected = a * b
    for part in PARTS:
        expected[part] = dense_arrow(a[part]) @ b[part]
    np.testing.assert_allclose(CONES.product(a, b), expected, atol=1e-12)
    data, rows, columns = CONES.arrow_entries(a)
    np.testing.assert_allclose(np.bincount(rows, data * b[columns], len(a)), expected, atol=1e-12)


@given(VECTORS)
def test_the_identity_of_the_product(a):
    np.testing.assert_array_equal(CONES.product(CONES.identity, a), a)


@given(interior(), VECTORS)
def test_longest_against_bisection(v, dv):
    def inside(t):
        return CONES.margin(v + t * dv).min() >= 0.0

    t = CONES.longest(v, dv)
    if np.isinf(t):
        assert CONES.margin(v + 1e6 * dv).min() >= -1e-6
        return
    low, high = 0.0, 2 * t + 1.0
    assert not inside(high)
    for _ in range(80):
        middle = (low + high) / 2
        low, high = (middle, high) if inside(middle) else (low, middle)
    assert t == pytest.approx(low, rel=1e-6)


@pytest.mark.parametrize(
    ("dv", "expected"),
    [
        ((-1, 0, 0), 1.0),
        ((0, 1, 0), 1.0),
        ((0, -1, 0), 3.0),
        ((1, 1, 0), np.inf),  # parallel to the boundary
        ((-1, 1, 0), 0.5),
        ((0, 0, 0), np.inf),
    ],
)
def test_longest_by_hand(dv, expected):
    """From (2, 1, 0), which is 1 inside the boundary t = ||z||."""
    start = np.array((2, 1, 0), float)
    assert Cones(0, ((1, 3),)).longest(start, np.array(dv, float)) == pytest.approx(expected)


def test_of_sizes_puts_equal_neighbours_together():
    assert Cones.of_sizes(2, [3, 3, 4]) == CONES
    assert Cones.of_sizes(1, []) == Cones(1)
    assert (CONES.degree, CONES.height) == (5, 12)
    np.testing.assert_array_equal(CONES.heads, [0, 1, 2, 5, 8])
    np.testing.assert_array_equal(CONES.member, [0, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4, 4])


@given(VECTORS)
def test_margin_and_norm(a):
    cones = [(a[p][0] - np.linalg.norm(a[p][1:]), np.linalg.norm(a[p])) for p in PARTS]
    margins, norms = np.transpose(cones)
    np.testing.assert_allclose(CONES.margin(a), [*a[:2], *margins], atol=1e-12)
    np.testing.assert_allclose(CONES.norm(a), [*np.abs(a[:2]), *norms], atol=1e-12)


@given(interior(), VECTORS)
def test_share_is_one_over_the_longest_step(held, rest):
    """The least s with s held + rest in K is 1/t, t the longest step from held along rest, row by row."""
    shares = CONES.share(held, rest)
    t = CONES.longest(held, rest)
    assert shares.max() == pytest.approx(min(1.0, 1.0 / t) if t > 0.0 else 1.0, abs=1e-7)


def test_share_of_nothing_held():
    cones = Cones(1, ((1, 3),))
    np.testing.assert_array_equal(cones.share(np.zeros(4), np.array([-1.0, 0, 0, 0])), [1.0, 0.0])
    np.testing.assert_array_equal(cones.share(np.full(4, 1e-9), np.array([-1e-3, 0, 0, 0]), 1e-6), [1.0, 0.0])


@pytest.mark.parametrize("size", [2, 3, 4])
def test_rays_lie_on_the_boundary_in_the_planes_of_two_axes(size):
    result = rays(size, 8)
    np.testing.assert_allclose(result[:, 0], np.linalg.norm(result[:, 1:], axis=1), atol=1e-15)
    assert (np.count_nonzero(np.abs(result[:, 1:]) > 1e-12, axis=1) <= 2).all()
    assert len(result) == {2: 2, 3: 8, 4: 24}[size]


@given(VECTORS, st.floats(1e-9, 10.0))
def test_central_pairs_differ_by_v_and_multiply_to_the_identity(v, product):
    products = product * CONES.identity
    s, y = central(CONES, v, products)
    np.testing.assert_allclose(s - y, v, atol=1e-12)
    np.testing.assert_allclose(CONES.product(s, y), products, atol=1e-9)
    assert CONES.margin(s).min() > 0.0
    assert CONES.margin(y).min() > 0.0


@given(interior(), VECTORS)
def test_curvature_is_that_of_the_logarithmic_barrier(v, a):
    """The change along a of the gradient of -log v of rows and -log(t^2 - z.z) / 2 of cones."""

    def gradient(w):
        slope = np.concatenate([-1.0 / w[:2], np.zeros(len(w) - 2)])
        for part in PARTS:
            t, z = w[part][0], w[part][1:]
            slope[part] = np.append(-t, z) / (t * t - z @ z)
        return slope

    h = 1e-6
    expected = (gradient(v + h * a) - gradient(v - h * a)) / (2.0 * h)
    size = np.abs(expected).max(initial=1.0)
    np.testing.assert_allclose(curvature(CONES, v, a), expected, atol=1e-6 * size)


@given(VECTORS, st.sampled_from([1.0, 1e9]))
def test_the_nearest_point_leaves_a_rest_in_the_polar_cone(v, size):
    """Moreau: v = n + r with n in K, r in -K and n . r = 0; also where nothing flows beside a large head."""
    v = v * size
    n = CONES.nearest(v)
    for part in PARTS:
        r = v[part] - n[part]
        least = 1e-12 * np.abs(v).max(initial=1.0)
        assert np.linalg.norm(n[part][1:]) <= n[part][0] + least
        assert np.linalg.norm(r[1:]) <= -r[0] + least
        assert abs(n[part] @ r) <= least * np.abs(v).max(initial=1.0)


def test_a_large_head_without_flow_is_its_own_nearest_point():
    v = np.array([0.0, 0.0, 9.0, 0.0, 0.0, 9.0, 0.0, 0.0, 9.0, 0.0, 0.0, 0.0])
    assert (CONES.nearest(v) == v).all()


@pytest.mark.parametrize(("product", "off"), [(10.0, 10.0), (0.01, 100.0), (np.nan, np.inf), (-1.0, np.inf)])
def test_the_spread_is_that_of_the_product_that_is_farthest_off_its_target(product, off):
    s = np.array([1.0, product])
    assert spread(Cones(2), s, np.array([4.0, 2.0]), np.full(2, 2.0)) == pytest.approx(np.log(off))

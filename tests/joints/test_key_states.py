"""Torsion under bending of polygons that are no quadrilaterals, which the paper leaves open."""

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.geometry.polygon import areas, centroids
from limitblocks.joints.interaction import effective_areas
from limitblocks.joints.key_states import key_state_planes
from limitblocks.joints.torsion import torsion_constant

MU, SHARE = 0.6, np.array([0.0, 0.3, 0.5, 0.7, 0.85, 0.95])


def regular(sides):
    angles = 2.0 * np.pi * np.arange(sides) / sides
    return np.column_stack([np.cos(angles), np.sin(angles)])


def torsion(polygon, points, joint=None):
    """Largest T over mu |N| of a force at each point (k, 2) of a polygon about its centroid."""
    rows = (joint or lb.OrdunaLourenco(MU, slip="paper")).yield_rows(polygon[None])
    states = np.array([(0.0, 0.0, -1.0, -e2, e1, 0.0) for e1, e2 in points])  # e1 = -M2 / N, e2 = M1 / N
    twists = rows.F[0, :, 5] < -1e-12
    return (states @ rows.F[0, twists].T / -rows.F[0, twists, 5]).min(axis=1) / MU


def around(polygon, shares=SHARE):
    """Points (k, 2) all around at shares of the way from the centroid to the boundary."""
    ends = np.linspace(0.0, 1.0, 9, endpoint=False)[:, None, None]
    boundary = (polygon + ends * (np.roll(polygon, -1, axis=0) - polygon)).reshape(-1, 2)
    return (shares[:, None, None] * boundary).reshape(-1, 2)


def irregular(seed):
    rng = np.random.default_rng(seed)
    angles = np.sort(rng.uniform(0.0, 2.0 * np.pi, rng.integers(5, 10)))
    polygon = np.column_stack([np.cos(angles), 0.6 * np.sin(angles)])
    return polygon - centroids(polygon)


@pytest.mark.parametrize("sides", [3, 5, 6, 8, 12])
def test_the_states_of_table_4_are_on_the_surface(sides):
    """Pressure on all of it: Eq. (16). Along a side of length l: a mean distance of l / 4 from its middle."""
    polygon = regular(sides)
    length = 2.0 * np.sin(np.pi / sides)
    assert torsion(polygon, [(0.0, 0.0)]) == pytest.approx(torsion_constant(polygon))
    assert torsion(polygon, polygon) == pytest.approx(0.0, abs=1e-9)
    assert torsion(polygon, (polygon + np.roll(polygon, -1, axis=0)) / 2.0) == pytest.approx(length / 4.0)


@pytest.mark.parametrize("sides", [3, 5, 6])
def test_torsion_alone_and_with_shear_has_the_constant_of_the_polygon(sides):
    """Eq. (23), and Eqs (27)-(29) without shear: |T| / c_T."""
    rows = lb.OrdunaLourenco(MU).yield_rows(regular(sides)[None])
    modes = np.array([str(mode) for mode in rows.modes])
    for mode, per_row in (("twist", 1), ("slip-twist", 3)):
        own = np.abs(rows.F[0, modes == mode, 5][::per_row])
        assert own == pytest.approx(np.full(2, 1.0 / torsion_constant(regular(sides))))


def test_cohesion_is_so_much_normal_force_more():
    """Mu |N| becomes mu |N| + A cohesion in all rows but those of hinging."""
    polygon, cohesion = regular(6), 0.3
    joined = lb.OrdunaLourenco(MU, cohesion=cohesion).yield_rows(polygon[None])
    dry = lb.OrdunaLourenco(MU).yield_rows(polygon[None])
    Q = np.array([0.1, -0.2, -1.0, 0.2, 0.3, 0.15])
    pressed = Q - np.array([0.0, 0.0, areas(polygon) * cohesion / MU, 0.0, 0.0, 0.0])
    own = np.array([str(mode) != "hinge" for mode in dry.modes])
    values = [(rows.F[0] @ state + rows.g[0])[own] for rows, state in ((joined, Q), (dry, pressed))]
    assert values[0] == pytest.approx(values[1])


@pytest.mark.parametrize("seed", range(8))
def test_the_axes_and_the_first_vertex_do_not_matter(seed):
    polygon = irregular(seed)
    points = around(polygon)
    expected = torsion(polygon, points)
    c, s = np.cos(seed + 1.0), np.sin(seed + 1.0)
    turn = np.array([(c, s), (-s, c)])
    np.testing.assert_allclose(
        torsion(np.roll(polygon @ turn, seed, axis=0), points @ turn), expected, atol=1e-9
    )
    mirrored = (polygon * (1, -1))[::-1]
    np.testing.assert_allclose(torsion(mirrored, points * (1, -1)), expected, atol=1e-9)


@pytest.mark.parametrize("sides", [6, 8])
def test_a_pier_that_bends_as_it_twists_does_not_ask_how_it_stands_to_the_axes(sides):
    def load_factor(angle):
        c, s = np.cos(angle), np.sin(angle)
        turn = np.array([(c, -s), (s, c)])
        corners = regular(sides) @ turn.T
        stones = [
            lb.Block.box("ground", (4.0, 4.0, 1.0), (0.0, 0.0, -0.5)),
            lb.Block.prism("pier", corners, (0.0, 1.0), 20e3, along="z"),
        ]
        beside = lb.loads.force("pier", (0.0, 0.0, -1e5), (*(turn @ (0.9, 0.3)), 1.0))
        twist = lb.loads.moment("pier", (0.0, 0.0, 1e4))
        interfaces = lb.find_interfaces(stones, lb.OrdunaLourenco(MU))
        return lb.bounds(lb.Model(stones, ["ground"], interfaces, lb.self_weight() + beside, twist)).lower

    expected = load_factor(0.0)
    assert [load_factor(angle) for angle in (0.4, np.pi / 2.0)] == pytest.approx([expected] * 2, rel=1e-7)


@pytest.mark.parametrize("seed", range(3))
def test_it_is_within_the_planes_that_bound_the_effective_area_from_without(seed):
    polygon = irregular(seed)
    points = around(polygon, SHARE[1:])
    outside = torsion(polygon, points, lb.joints.ExactTorsion(MU, side="outer"))
    assert (torsion(polygon, points) <= outside * (1.0 + 1e-9)).all()


def test_regular_polygons_against_the_effective_area():
    """The figures of the docstring of OrdunaLourenco."""
    over, under = [], []
    for sides in (5, 8, 24):
        polygon = regular(sides)
        points = around(polygon)
        exact = np.array([torsion_constant(area) for area in effective_areas(polygon, points)])
        off = (torsion(polygon, points) - exact) / torsion_constant(polygon)
        over.append(off.max())
        under.append(off.min())
    assert 0.1 < max(over) < 0.12
    assert -0.13 < min(under) < -0.12


@pytest.mark.parametrize("cut", [1e-2, 1e-6, 1e-9, 1e-14])
def test_a_corner_cut_off_leaves_the_other_states(cut):
    """Half way from c_T to the middle of a side, l / 2; a polygon with fewer facets has c_T for it."""
    square = np.array([(1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)])
    five = np.concatenate([square[:1], [(1.0, 1.0 - cut), (1.0 - cut, 1.0)], square[2:]])
    constant = torsion_constant(square)
    assert torsion(five, [(0.5, 0.0)])[0] == pytest.approx((constant + 0.5) / 2.0, rel=cut + 1e-9)
    planes = key_state_planes(np.stack([regular(5), five]))
    assert planes[..., 0].min(axis=1) == pytest.approx([torsion_constant(regular(5)), constant], rel=cut)
    assert np.abs(planes).max() < 2.0  # no row runs away
    alone = key_state_planes(five[None])[0]
    assert len(np.unique(alone, axis=0)) == len(alone)

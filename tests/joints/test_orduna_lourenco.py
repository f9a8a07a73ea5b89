"""The paper's yield surface: equations against rows, flow rules, crushing, relatives of the octagon."""

import numpy as np
import pytest
from rectangles import AREA, COMPRESSION, L1, L2, MU, PAPER, RECTANGLE, SLIPS, N, states, yield_functions

import limitblocks as lb
from limitblocks.geometry.polygon import along_longest_side, areas, centroids
from limitblocks.joints.interaction import rectangle_torsion_bending
from limitblocks.joints.orduna_lourenco import equivalent_half_sides
from limitblocks.joints.torsion import rectangle_torsion_constant, torsion_constants

HEXAGON = np.array([(np.cos(t), 0.6 * np.sin(t)) for t in np.arange(6) * np.pi / 3])


TRAPEZIUM = np.array([(2.0, -1.0), (0.5, 1.0), (-0.7, 1.0), (-2.0, -1.0)])


every_joint = pytest.mark.parametrize("joint", SLIPS.values(), ids=SLIPS)


def rows_by_mode(joint, Q):
    """-(F Q + g) of planes and ||z|| - t of cones, the largest of each mode, for states Q (k, 6)."""
    rows = joint.yield_rows(RECTANGLE[None])
    value = Q @ rows.F[0].T + rows.g[0]
    result, k = {}, 0
    for size in (*([1] * rows.linear), *rows.cones):
        margin = value[:, k] - np.linalg.norm(value[:, k + 1 : k + size], axis=1)
        result.setdefault(rows.modes[k], []).append(-margin)
        k += size
    return {mode: np.max(values, axis=0) for mode, values in result.items()}


def test_row_counts():
    """Reading notes, section 2: 38 on a quadrilateral; on others 26 and five a side."""
    modes = PAPER.yield_rows(RECTANGLE[None]).modes
    counts = [modes.count(mode) for mode in ("twist", "slip", "slip-twist", "moment-twist", "hinge")]
    assert (counts, len(modes)) == ([2, 8, 16, 8, 4], 38)
    assert len(PAPER.yield_rows(HEXAGON[None]).modes) == 56
    for joint, linear, cones in (
        (SLIPS["inner"], 2 + 12 + 24 + 8 + 4, 0),
        (SLIPS["exact"], 2 + 8 + 4, 3),
        (SLIPS["crush"], 34, 4),
        (SLIPS["cones"], 10, 7),
        (lb.OrdunaLourenco(0.0), 4, 0),
        (lb.OrdunaLourenco(0.0, compressive_strength=1e6), 0, 4),
    ):
        rows = joint.yield_rows(RECTANGLE[None])
        assert (rows.linear, rows.cones) == (linear, (3,) * cones)
        assert len(rows.modes) == rows.F.shape[1] == linear + 3 * cones


def test_rows_are_the_printed_equations():
    Q = states(200)
    expected = yield_functions(Q)
    for mode, values in rows_by_mode(PAPER, Q).items():
        np.testing.assert_allclose(values, expected[mode], atol=1e-9, err_msg=mode)
    expected = yield_functions(Q, np.hypot)
    for mode, values in rows_by_mode(SLIPS["exact"], Q).items():
        np.testing.assert_allclose(values, expected[mode], atol=1e-9, err_msg=mode)


@pytest.mark.parametrize(
    ("M1", "M2", "T"), [(L2, 0, MU * L1 / 2), (L2, L1, 0), (0, L1, MU * L2 / 2)], ids=["A", "B", "C"]
)
def test_table_4_lies_on_eq_30_and_on_the_surface(M1, M2, T):
    Q = -N * np.array([(0, 0, -1, a * M1, b * M2, c * T) for a in (1, -1) for b in (1, -1) for c in (1, -1)])
    result = rows_by_mode(PAPER, Q / -N)
    np.testing.assert_allclose(result["moment-twist"], 0, atol=1e-12)
    assert max(values.max() for values in result.values()) <= 1e-12
    interface = lb.joints.interface(RECTANGLE, None)
    for state in Q:
        assert "moment-twist" in PAPER.active_modes(interface, state)
        assert PAPER.utilisation(interface, state) == pytest.approx(1, abs=1e-12)


def test_torsion_strength_of_fig_12():
    for joint in SLIPS.values():
        plain = type(joint)(MU, slip=joint.slip, sides=joint.sides)
        torsion = plain.strength(lb.joints.interface(RECTANGLE, plain), (0, 0, 0, 0, 0, 1), COMPRESSION)
        assert torsion == pytest.approx(16.26, abs=0.005)
        assert torsion == pytest.approx(rectangle_torsion_bending(L1, L2, MU, N, 0, 0), rel=1e-13)


def _torsion_over_even_pressure(corners):
    """Torsion over that under uniform pressure of polygons x1 + 1j x2, (m, n), along their longest sides."""
    polygons = np.stack([corners.real, corners.imag], axis=2)
    _, turn = along_longest_side(polygons, np.broadcast_to(np.eye(3)[:2], (len(polygons), 2, 3)))
    polygons = polygons @ turn.swapaxes(1, 2)
    polygons = polygons - centroids(polygons)[:, None]
    strength = -1.0 / lb.OrdunaLourenco(1.0).yield_rows(polygons).F[:, 0, 5]
    return strength / torsion_constants(polygons)


def test_torsion_of_quadrilaterals_by_their_rectangle():
    rng = np.random.default_rng(2)
    angles = np.sort(rng.uniform(0, 2 * np.pi, (20000, 4)), axis=1)
    ellipses = rng.uniform(0.02, 1, (20000, 1)) * np.cos(angles) + 1j * np.sin(angles)
    area = areas(np.stack([ellipses.real, ellipses.imag], axis=2))
    any_one = _torsion_over_even_pressure(ellipses[area > 1e-3])
    assert 0.63 < any_one.min() < 0.7
    assert 1.2 < any_one.max() < 1.27
    height, top = (x.ravel() for x in np.meshgrid(1j * np.geomspace(0.2, 5, 25), np.linspace(1e-6, 1, 21)))
    base = np.ones_like(top)
    trapezoids = _torsion_over_even_pressure(np.stack([-base, base, top + height, -top + height], axis=1))
    assert 0.76 < trapezoids.min() < 0.77
    assert 1.18 < trapezoids.max() < 1.19
    lean = 2 * top + height
    leaning = _torsion_over_even_pressure(np.stack([-base, base, base + lean, -base + lean], axis=1))
    assert leaning.max() < 1.0 + 1e-12


@pytest.mark.parametrize("sides", [3, 5, 6, "trapezium"])
def test_a_force_at_a_corner_is_within_the_surface_of_any_polygon(sides):
    """There it hinges, which Eq. (30) must not forbid: it is within up to the corner and not beyond it."""
    if sides == "trapezium":
        polygon = np.array([(-0.5, -0.2), (0.5, -0.2), (0.2, 0.2), (-0.2, 0.2)])
    else:
        angles = 0.1 + 2.0 * np.pi * np.arange(sides) / sides
        polygon = np.column_stack([np.cos(angles), np.sin(angles)])
    polygon = polygon - centroids(polygon[None])[0]
    rows = lb.OrdunaLourenco(0.6, slip="paper").yield_rows(polygon[None])
    for corner in polygon:
        for share, within in ((1.0 - 1e-9, True), (1.0 + 1e-6, False)):
            e1, e2 = share * corner
            Q = np.array([0.0, 0.0, -1.0, -e2, e1, 0.0])  # e1 = -M2 / N, e2 = M1 / N
            assert ((rows.F[0] @ Q + rows.g[0]).min() >= 0.0) == within


@pytest.mark.parametrize("sides", range(3, 10))
def test_a_force_at_a_corner_may_grow_without_limit(sides):
    polygon = np.array([(np.cos(t), 0.6 * np.sin(t)) for t in 0.3 + np.arange(sides) * 2 * np.pi / sides])
    interface = lb.joints.interface(polygon, None)
    forces = [(0, 0, -1, -e2, e1, 0) for e1, e2 in interface.polygon]
    assert {lb.OrdunaLourenco(0.6).strength(interface, force) for force in forces} == {np.inf}


def test_vertex_order_does_not_matter():
    """Eqs (31)-(32) presuppose (+,-), (+,+), (-,+), (-,-); other first vertices are turned to it."""
    for polygon in (RECTANGLE, TRAPEZIUM):
        for k in range(4):
            turned = np.roll(polygon, k, axis=0)
            np.testing.assert_allclose(
                equivalent_half_sides(turned[None]), equivalent_half_sides(polygon[None])
            )


@pytest.mark.parametrize("half_sides", [(L1, L2), (L1, L1)])
@pytest.mark.parametrize("angle", [0.0, 0.2, np.pi / 4, np.pi / 2, 2.5])
def test_a_rectangle_is_as_strong_however_its_axes_lie(angle, half_sides):
    """Eq. (17), and Eq. (30) at e1 = l1 / 2 along the rectangle."""
    l1, l2 = half_sides
    out = np.array([np.cos(angle), np.sin(angle)])
    rectangle = np.array([(l1, -l2), (l1, l2), (-l1, l2), (-l1, -l2)]) @ [out, [-out[1], out[0]]]
    e1, e2 = l1 / 2 * out
    interface, twist = lb.joints.interface(rectangle, None), (0, 0, 0, 0, 0, 1)
    strengths = [PAPER.strength(interface, twist, (0, 0, N, e2 * N * k, -e1 * N * k, 0)) for k in (0, 1)]
    c_T = float(rectangle_torsion_constant(l1, l2))
    assert strengths == pytest.approx([-MU * N * c_T, -MU * N * (l1 / 2 + l2) / 2], rel=1e-12)


@pytest.mark.parametrize("sides", [3, 4, 8, 12, 17])
def test_inner_and_outer_polygons_enclose_the_circle(sides):
    interface = lb.joints.interface(RECTANGLE, None)
    inner, outer = (lb.OrdunaLourenco(MU, slip=slip, sides=sides) for slip in ("inner", "outer"))
    exact = lb.OrdunaLourenco(MU, slip="exact")
    limit = np.cos(np.pi / sides)
    ratios = []
    for angle in np.linspace(0, 2 * np.pi, 97):
        for T in (0.0, 0.05, -0.05):
            d = (np.cos(angle), np.sin(angle), 0, 0, 0, T)
            low, true, high = (j.strength(interface, d, COMPRESSION) for j in (inner, exact, outer))
            assert low <= true * (1 + 1e-12)
            assert true <= high * (1 + 1e-12)
            if T == 0.0:
                assert true == pytest.approx(-MU * N, rel=1e-13)
                ratios.append((low / true, true / high))
    assert min(min(pair) for pair in ratios) >= limit - 1e-12
    assert np.min(ratios, axis=0)[1] == pytest.approx(limit, abs=0.01)
    assert ratios[0] == pytest.approx((1, 1), abs=1e-12)  # along V1 both are exact


def test_gap_of_the_polygons_falls_as_the_square_of_their_sides():
    gaps = [1 - np.cos(np.pi / sides) for sides in (8, 16, 32)]
    interface, values = lb.joints.interface(RECTANGLE, None), []
    for sides in (8, 16, 32):
        angle = np.pi / sides
        d = (np.cos(angle), np.sin(angle), 0, 0, 0, 0)
        joint = lb.OrdunaLourenco(MU, slip="inner", sides=sides)
        values.append(1 - joint.strength(interface, d, COMPRESSION) / (-MU * N))
    np.testing.assert_allclose(values, gaps, rtol=1e-9)
    assert values[0] / values[1] == pytest.approx(4, rel=0.02)


def test_paper_octagon_is_too_strong_by_eight_per_cent():
    interface, angle = lb.joints.interface(RECTANGLE, None), np.pi / 8
    d = (np.cos(angle), np.sin(angle), 0, 0, 0, 0)
    strength = PAPER.strength(interface, d, COMPRESSION)
    assert strength / (-MU * N) == pytest.approx(1 / np.cos(np.pi / 8), rel=1e-12)
    assert 1 / np.cos(np.pi / 8) == pytest.approx(1.082, abs=5e-4)
    outer = lb.OrdunaLourenco(MU, slip="outer")
    for Q in states(40):
        assert outer.utilisation(interface, Q) == pytest.approx(PAPER.utilisation(interface, Q))


@every_joint
def test_the_set_is_convex_and_holds_the_compression_ray(joint):
    interface = lb.joints.interface(RECTANGLE, joint)
    surface = []
    for Q in states(40):
        held = (0, 0, Q[2], 0, 0, 0)
        surface.append(held + (Q - held) * joint.strength(interface, Q - held, held))
    surface = np.array(surface)
    for Q in (surface[::2] + surface[1::2]) / 2:
        assert joint.utilisation(interface, Q) <= 1 + 1e-9
    limit = np.inf if joint.compressive_strength is None else joint.compressive_strength * AREA
    for force in (1e-6, 1.0, 1e3):
        assert joint.utilisation(interface, (0, 0, -force, 0, 0, 0)) == pytest.approx(force / limit)
    assert joint.strength(interface, (0, 0, -1, 0, 0, 0)) == pytest.approx(limit, rel=1e-9)


@every_joint
def test_scaling_is_exact(joint):
    """Forces by 8, lengths by 4: stresses by 1/2, moments by 32."""
    big = lb.joints.interface(4 * RECTANGLE, None)
    settings = {"slip": joint.slip, "sides": joint.sides, "cohesion": joint.cohesion / 2}
    if joint.compressive_strength is not None:
        settings["compressive_strength"] = joint.compressive_strength / 2
    same = lb.OrdunaLourenco(MU, tensile_strength=joint.tensile_strength / 2, **settings)
    for Q in states(20):
        scaled = Q * 8 * np.array([1, 1, 1, 4, 4, 4])
        assert same.utilisation(big, scaled) == pytest.approx(
            joint.utilisation(lb.joints.interface(RECTANGLE, None), Q), rel=1e-11
        )


def test_stack_is_the_single_ones_and_the_stress_unit_divides():
    polygons = np.stack([RECTANGLE, 2 * RECTANGLE, TRAPEZIUM])
    joint = SLIPS["bonded"]
    rows = joint.yield_rows(polygons)
    for k, polygon in enumerate(polygons):
        np.testing.assert_allclose(rows.F[k], joint.yield_rows(polygon[None]).F[0], rtol=1e-13)
        np.testing.assert_allclose(rows.g[k], joint.yield_rows(polygon[None]).g[0], rtol=1e-13)
    weaker = lb.OrdunaLourenco(MU, 2e3, slip="exact", cohesion=3e2, tensile_strength=1e2)
    for name in ("F", "g"):
        ours = getattr(joint.yield_rows(polygons, 10.0), name)
        np.testing.assert_allclose(ours, getattr(weaker.yield_rows(polygons), name), rtol=1e-13)


def test_zero_friction_carries_normal_force_and_bending_only():
    interface = lb.joints.interface(RECTANGLE, None)
    for joint in (lb.OrdunaLourenco(0.0), lb.OrdunaLourenco(0.0, compressive_strength=1e6)):
        assert joint.strength(interface, (0, 0, 0, 0, 0, 1), COMPRESSION) == 0
        assert joint.utilisation(interface, (1, 0, N, 0, 0, 0)) == np.inf
        assert joint.flow_directions(interface, COMPRESSION).shape == (4, 6)
        with pytest.raises(lb.ModelError, match="outside the yield set already"):
            joint.strength(interface, (0, 0, -1, 0, 0, 0), (1, 0, N, 0, 0, 0))
    moment = lb.OrdunaLourenco(0.0).strength(interface, (0, 0, 0, 1, 0, 0), COMPRESSION)
    assert moment == pytest.approx(-N * L2, rel=1e-12)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"friction": -0.1}, "friction is -0.1"),
        ({"friction": np.nan}, "friction is nan"),
        ({"friction": 0.6, "compressive_strength": 0.0}, "compressive strength is 0.0 Pa.*None"),
        ({"friction": 0.6, "compressive_strength": np.inf}, "compressive strength is inf"),
        ({"friction": 0.6, "slip": "circle"}, "slip is 'circle', expected one of 'exact', 'paper'"),
        ({"friction": 0.6, "slip": "inner", "sides": 2}, "sides is 2, expected a whole number of at least 3"),
        ({"friction": 0.6, "slip": "inner", "sides": 6.5}, "sides is 6.5"),
        ({"friction": 0.6, "sides": 12}, "sides is 12, but slip='exact' is a circle"),
        ({"friction": 0.6, "slip": "paper", "sides": 12}, "sides is 12, but slip='paper' is an octagon"),
        ({"friction": 0.6, "cohesion": -1.0}, "cohesion is -1.0 Pa, expected a finite stress >= 0"),
        ({"friction": 0.6, "tensile_strength": np.nan}, "tensile strength is nan"),
    ],
)
def test_bad_settings_are_named(settings, message):
    with pytest.raises(lb.ModelError, match=message):
        lb.OrdunaLourenco(**settings)


def test_axes_along_the_sides_but_for_rounding_leave_equation_30_as_it_is():
    """Its planes have M1 and M2 alike: factors that differ by rounding would tell mirror images apart."""
    joint = lb.OrdunaLourenco(0.6)
    dome = lb.structures.dome(joint, radius=2.0, thickness=0.3, courses=3, stones=8)
    rows = joint.yield_rows(np.array([own.polygon for own in dome.interfaces if len(own.polygon) == 4])).F
    bending = np.abs(rows[(rows[..., 3] != 0.0) & (rows[..., 4] != 0.0) & (rows[..., 5] != 0.0)])
    assert len(bending) == 8 * len(rows)
    assert (bending[:, 3] == bending[:, 4]).all()

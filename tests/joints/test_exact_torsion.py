"""ExactTorsion: inner <= exact <= outer for the limit surface and for torsion under bending."""

import numpy as np
import pytest
from rectangles import L1, L2, MU, RECTANGLE, SQUARE, N
from scipy.optimize import brentq

import limitblocks as lb
from limitblocks.joints.exact_torsion import bending_planes
from limitblocks.joints.interaction import rectangle_torsion_bending, torsion_bending, torsion_shear_curve
from limitblocks.joints.limit_surface import limit_points
from limitblocks.joints.torsion import rectangle_torsion_constant, torsion_constant

COMPRESSION = np.array([0, 0, N, 0, 0, 0])
TURN = np.array([(0.8, 0.6), (-0.6, 0.8)])
POLYGONS = {
    "rectangle": RECTANGLE,
    "square": SQUARE,
    "turned": 10 * RECTANGLE @ TURN,
    "hexagon": np.array([(np.cos(t), 0.6 * np.sin(t)) for t in np.arange(6) * np.pi / 3]),
    "triangle": np.array([(0.0, 0.0), (4.0, 0.0), (0.0, 1.0)]),
    "trapezium": np.array([(-2.0, -1.0), (2.0, -1.0), (0.5, 1.0), (-0.7, 1.0)]),
    "thin rhombus": np.array([(0.0, -0.1), (3.0, 0.0), (0.0, 0.1), (-3.0, 0.0)]),
    "kite": np.array([(0.0, -0.3), (3.0, 0.0), (0.0, 0.5), (-0.4, 0.0)]),
    "pentagon": np.array([(np.cos(t), np.sin(t)) for t in np.arange(5) * 2 * np.pi / 5]),
}
every_polygon = pytest.mark.parametrize("polygon", POLYGONS.values(), ids=POLYGONS)


def sides(**settings):
    return lb.joints.ExactTorsion(MU, side="inner", **settings), lb.joints.ExactTorsion(
        MU, side="outer", **settings
    )


@every_polygon
def test_limit_surface_is_between_inner_and_outer(polygon):
    interface = lb.joints.interface(polygon, None)
    inner, outer = sides()
    gap = inner.discretisation_error(interface)
    rng = np.random.default_rng(0)
    scale = torsion_constant(interface.polygon)
    points = limit_points(interface.polygon, rng.normal(size=(40, 3)) / [1, 1, scale])
    for V1, V2, T in -MU * N * points:
        Q = np.add(COMPRESSION, [V1, V2, 0, 0, 0, T])
        low, high = 1 / inner.utilisation(interface, Q), 1 / outer.utilisation(interface, Q)
        assert high >= 1 - 1e-9
        assert high <= (1 + gap) * (1 + 1e-9)
        # without bending the inner planes of bending may cut T off where e = 0 has no symmetric polygon
        if interface.polygon.shape == (4, 2) and np.allclose(interface.polygon.mean(axis=0), 0):
            assert 1 / (1 + gap) * (1 - 1e-9) <= low
        assert low <= 1 + 1e-9
    assert 0 < gap < 0.09


def test_gap_falls_as_the_square_of_the_fineness():
    interface = lb.joints.interface(RECTANGLE, None)
    gaps = np.array(
        [lb.joints.ExactTorsion(MU, fineness).discretisation_error(interface) for fineness in (4, 8, 16)]
    )
    assert (gaps[:-1] / gaps[1:] > 3).all()
    assert gaps[2] < 0.006


@every_polygon
def test_torsion_under_bending_is_between_inner_and_outer(polygon):
    """Against uniform pressure on the effective area; everywhere in the polygon and at hinges."""
    polygon = lb.joints.interface(polygon, None).polygon
    rng = np.random.default_rng(1)
    corners = np.concatenate([polygon, (polygon + np.roll(polygon, -1, axis=0)) / 2])
    e = np.concatenate([rng.dirichlet(np.full(len(polygon), 0.5), 150) @ polygon, (1 - 1e-9) * corners])
    states = np.column_stack([-np.ones(len(e)), -e[:, 1], e[:, 0]])
    exact = torsion_bending(polygon, 1.0, *states.T)
    inner, outer = (-(states @ bending_planes(polygon, side).T).max(axis=1) for side in ("inner", "outer"))
    size = torsion_constant(polygon)
    assert (inner <= exact + 1e-6 * size).all()
    assert (exact <= outer + 1e-6 * size).all()


@pytest.mark.parametrize("name", ["hexagon", "triangle", "trapezium", "thin rhombus", "kite", "pentagon"])
def test_outer_planes_are_eq_30_on_the_bounding_rectangles_along_the_sides(name):
    """The least half sum of the distances to the nearer bounds, along a side and across it."""
    polygon = lb.joints.interface(POLYGONS[name], None).polygon
    e = np.random.default_rng(1).dirichlet(np.full(len(polygon), 0.5), 150) @ polygon
    boxes = []
    for side in np.roll(polygon, -1, axis=0) - polygon:
        ways = np.array([side, [-side[1], side[0]]]) / np.hypot(*side)
        corners, at = polygon @ ways.T, e @ ways.T
        boxes.append(np.minimum(corners.max(axis=0) - at, at - corners.min(axis=0)).sum(axis=1) / 2)
    states = np.column_stack([-np.ones(len(e)), -e[:, 1], e[:, 0]])
    outer = -(states @ bending_planes(polygon, "outer").T).max(axis=1)
    assert outer == pytest.approx(np.min(boxes, axis=0), rel=1e-9)


def test_rectangle_planes_touch_the_exact_surface():
    """Inner without bending and at the corners; outer without bending and at A, B, C of Table 4."""
    interface = lb.joints.interface(RECTANGLE, None)
    inner, outer = sides(fineness=2)
    T = (0, 0, 0, 0, 0, 1)
    for e1, e2, touching in (
        (0, 0, (inner, outer)),
        (0, L2, (outer,)),
        (L1, 0, (outer,)),
        (L1, L2, (inner, outer)),
    ):
        Q = np.add(COMPRESSION, [0, 0, 0, N * e2, -N * e1, 0])
        exact = rectangle_torsion_bending(L1, L2, MU, N, *Q[3:5])
        for joint in touching:
            assert joint.strength(interface, T, Q) == pytest.approx(exact, abs=1e-9)


def test_pure_strengths_are_exact_on_both_sides():
    """Shear along the axes and torsion; the outer planes that give them bear the names of pure modes."""
    interface = lb.joints.interface(RECTANGLE, None)
    for d, mode, expected in (
        ((1, 0, 0, 0, 0, 0), "slip", -MU * N),
        ((0, -1, 0, 0, 0, 0), "slip", -MU * N),
        ((0, 0, 0, 0, 0, 1), "twist", -MU * N * rectangle_torsion_constant(L1, L2)),
    ):
        for joint in sides(fineness=3):
            strength = joint.strength(interface, d, COMPRESSION)
            assert strength == pytest.approx(expected, rel=1e-12)
            modes = joint.active_modes(interface, COMPRESSION + strength * np.array(d))
            assert ("slip-twist" if joint.side == "inner" else mode) in modes


def test_effective_rectangle_is_not_convex_and_its_hull_is_outer():
    """Between A and C the exact torsion sags below the chord; the outer planes are on the chord."""
    A, C = np.array([-L2 * N, 0.0]), np.array([0.0, -L1 * N])
    middle = (A + C) / 2
    chord = (rectangle_torsion_bending(L1, L2, MU, N, *A) + rectangle_torsion_bending(L1, L2, MU, N, *C)) / 2
    sag = rectangle_torsion_bending(L1, L2, MU, N, *middle) / chord
    assert sag < 0.8
    outer = lb.joints.ExactTorsion(MU, side="outer").strength(
        lb.joints.interface(RECTANGLE, None), (0, 0, 0, 0, 0, 1), np.add(COMPRESSION, [0, 0, 0, *middle, 0])
    )
    assert outer == pytest.approx(chord, rel=1e-9)


def test_bending_error_is_the_number_in_the_docstring():
    for ratio in (1.0, 1.5, 2.0, 3.0):
        interface = lb.joints.interface(SQUARE * [ratio, 1], None)
        error = lb.joints.ExactTorsion(MU).bending_error(interface)
        assert 0.15 < error < 0.18
        c_T, twist = rectangle_torsion_constant(ratio, 1.0), bending_planes(interface.polygon, "inner")
        T1, T2 = abs(twist[0, 1]) * 1.0, abs(twist[0, 2]) * ratio
        assert pytest.approx(c_T, rel=1e-12) == T1 + T2
        assert error == pytest.approx(max(ratio / 2 - T2, 1 / 2 - T1) / c_T, rel=1e-9)


def test_bending_error_between_corner_and_mid_side():
    """A parallelogram hinged at (0, h): inside none, outside Eq. (30) on both boxes is more than T0."""
    a, s, h = 3.0, 1.0, 1.0
    corners = [(-a - s, -h), (a - s, -h), (a + s, h), (-a + s, h)]
    own = lb.joints.interface(corners, lb.joints.ExactTorsion(MU))
    along, slanted = (a + s) / 2, ((a - s) * h + (a + s) * s) / 2 / np.hypot(s, h)
    assert min(along, slanted) > torsion_constant(own.polygon)
    assert own.joint.bending_error(own) == pytest.approx(1.0, rel=1e-9)


def test_planes_turn_with_the_rectangle():
    inner, outer = sides(fineness=3)
    e, states = np.array([0.06, -0.03]), []
    for polygon, point in ((RECTANGLE, e), (RECTANGLE @ TURN, e @ TURN)):
        states.append(
            (
                lb.joints.interface(polygon, None),
                np.add(COMPRESSION, [0, 0, 0, N * point[1], -N * point[0], 0]),
            )
        )
    for joint in (inner, outer):
        plain, turned = (joint.strength(i, (0, 0, 0, 0, 0, 1), Q) for i, Q in states)
        assert plain == pytest.approx(turned, rel=1e-9)


def test_stack_of_shapes_is_the_single_ones_scaled():
    polygons = np.stack([RECTANGLE, POLYGONS["trapezium"], 1024 * RECTANGLE, RECTANGLE, SQUARE])
    for joint in sides(fineness=2, compressive_strength=1e6):
        rows = joint.yield_rows(polygons)
        assert len({rows.F.shape[1], len(rows.modes), rows.linear + sum(rows.cones)}) == 1
        np.testing.assert_allclose(rows.F[0], rows.F[3], rtol=1e-12, atol=1e-14)
        for k in (1, 2, 4):
            alone = joint.yield_rows(polygons[k][None])
            for Q in np.random.default_rng(k).normal(size=(20, 6)):
                Q[2] = -abs(Q[2])
                both = (rows.F[k] @ Q)[: rows.linear].min(), (alone.F[0] @ Q)[: alone.linear].min()
                assert both[0] == pytest.approx(both[1], rel=1e-9)
    exact = [
        lb.joints.ExactTorsion(MU).utilisation(lb.joints.interface(p, None), q)
        for p, q in (
            (RECTANGLE, np.array([90, 40, N, 3, 5, 4.0])),
            (1024 * RECTANGLE, np.array([90, 40, N, 3072, 5120, 4096.0])),
        )
    ]
    assert exact[0] == pytest.approx(exact[1], rel=1e-9)


def test_the_set_is_convex():
    interface = lb.joints.interface(POLYGONS["trapezium"], None)
    joint = lb.joints.ExactTorsion(MU, fineness=2)
    rng = np.random.default_rng(3)
    held, surface = np.array([0, 0, -1.0, 0, 0, 0]), []
    for _ in range(40):
        d = rng.normal(size=6) * [1, 1, 0, 1, 1, 1]
        surface.append(held + d * joint.strength(interface, d, held))
    for Q in np.add(surface[::2], surface[1::2]) / 2:
        assert joint.utilisation(interface, Q) <= 1 + 1e-9
    assert joint.utilisation(interface, 1e3 * held) == 0
    assert joint.strength(interface, held) == np.inf


def test_flow_has_no_dilatancy_and_turns_about_the_point_of_action():
    joint = lb.joints.ExactTorsion(MU, fineness=1, compressive_strength=1e5)
    interface = lb.joints.interface(RECTANGLE, None)
    Q = np.add(COMPRESSION, [5, 3, 0, 8.0, -12.0, 2.0])
    flow = joint.flow_directions(interface, Q, turning="centre of pressure")
    rows = joint.yield_rows(RECTANGLE[None])
    modes = np.array(rows.modes[: rows.linear])
    assert not flow[: rows.linear, 2:5].any()
    turning = flow[: rows.linear][modes == "moment-twist"]
    np.testing.assert_allclose(
        turning[:, :2] / turning[:, 5:], np.tile([Q[3] / N, Q[4] / N], (8, 1)), rtol=1e-9
    )
    np.testing.assert_allclose(flow[rows.linear :, 2], 1 + 2 * N / (4 * L1 * L2 * 1e5), rtol=1e-9)
    assert flow.shape == (rows.linear + 4, 6)


def test_zero_friction_and_crushing():
    interface = lb.joints.interface(RECTANGLE, None)
    assert lb.joints.ExactTorsion(0.0).strength(interface, (0, 0, 0, 0, 0, 1), COMPRESSION) == 0
    moment = lb.joints.ExactTorsion(MU, compressive_strength=2e4).strength(
        interface, (0, 0, 0, 1, 0, 0), COMPRESSION
    )
    assert moment == pytest.approx(-N * L2 * (1 + N / (4 * L1 * L2 * 2e4)), rel=1e-12)


# ------------------------------------------------------------------------------------- in a structure


def pushed_aside(joint, lever):
    """A block 0.3 x 0.2 on a base, pushed along Y in the plane of its joint, `lever` off its centre."""
    blocks = [
        lb.Block.box("base", (1, 1, 0.1), (0, 0, -0.05)),
        lb.Block.box("stone", (0.3, 0.2, 0.1), (0, 0, 0.05), 20e3),
    ]
    live = lb.loads.force("stone", (0.0, 120.0, 0.0), at=(lever, 0.0, 0.0))
    return lb.Model(blocks, ["base"], lb.find_interfaces(blocks, joint), lb.self_weight(), live)


@pytest.mark.parametrize("lever", [0.03, 0.1, 0.5])
def test_two_programs_bracket_the_load_factor_of_a_block_that_twists(lever):
    """Exact: the twisting centre for which T / V is the lever."""

    def ratios(distance):
        V, T = torsion_shear_curve(RECTANGLE, (1, 0), distance)
        return float(V), float(T) * float(rectangle_torsion_constant(L1, L2))

    distance = brentq(lambda s: ratios(s)[1] - lever * ratios(s)[0], 1e-6, 1e3, xtol=1e-14)
    exact = MU * ratios(distance)[0]  # weight 120 N
    gaps = []
    for fineness in (2, 4):
        inner, outer = sides(fineness=fineness)
        low, high = lb.bounds(pushed_aside(inner, lever)), lb.bounds(pushed_aside(outer, lever))
        assert low.lower <= exact * (1 + 1e-7)
        assert high.upper >= exact * (1 - 1e-7)
        gap = inner.discretisation_error(lb.joints.interface(RECTANGLE, None))
        assert high.upper <= low.lower * (1 + gap) ** 2
        gaps.append(high.upper / low.lower - 1)
    assert gaps[1] < gaps[0]
    assert gaps[1] < 0.06


def test_bracket_with_bending_holds_the_effective_rectangle():
    """Two stones, the upper one pushed at its corner: shear, bending and torsion together."""
    blocks = [
        lb.Block.box("base", (1, 1, 0.1), (0, 0, -0.05)),
        lb.Block.box("low", (0.3, 0.3, 0.2), (0, 0, 0.1), 20e3),
        lb.Block.box("high", (0.3, 0.3, 0.2), (0, 0, 0.3), 20e3),
    ]
    live = lb.loads.force("high", (0.0, 100.0, 0.0), at=(0.15, 0.0, 0.3)) + lb.loads.moment(
        "high", (0, 0, 20.0)
    )

    def model(joint):
        return lb.Model(blocks, ["base"], lb.find_interfaces(blocks, joint), lb.self_weight(), live)

    inner, outer = (lb.bounds(model(joint)) for joint in sides(fineness=3))
    assert inner.lower < outer.upper < 1.35 * inner.lower
    T = abs(inner.stress_resultants[1, 5])
    Q = inner.stress_resultants[1]
    assert rectangle_torsion_bending(0.15, 0.15, MU, Q[2], Q[3], Q[4]) >= T - 1e-6


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"friction": -1.0}, "friction is -1.0"),
        ({"friction": 0.6, "fineness": 0}, "fineness is 0, expected a whole number of at least 1"),
        ({"friction": 0.6, "fineness": True}, "fineness is True"),
        ({"friction": 0.6, "side": "middle"}, "side is 'middle', expected one of 'inner', 'outer'"),
        ({"friction": 0.6, "compressive_strength": -1.0}, "compressive strength is -1.0 Pa"),
    ],
)
def test_bad_settings_are_named(settings, message):
    with pytest.raises(lb.ModelError, match=message):
        lb.joints.ExactTorsion(**settings)


def test_torsion_alone_of_a_triangle_is_that_of_its_effective_area():
    """At e = 0 that is the hexagon on the thirds of the sides, of the same inradius r. The mean distance from
    the centre of a regular polygon of n sides is (r / 3) (sec a + log(sec a + tan a) / tan a), a = pi / n."""
    angle = 2 * np.pi * np.arange(3) / 3
    inner, outer = sides()
    interface = lb.joints.interface(np.column_stack([np.cos(angle), np.sin(angle)]), inner)
    twist = {"direction": (0, 0, 0, 0, 0, 1), "given": (0, 0, -1.0, 0, 0, 0)}

    def constant(n, inradius=0.5):
        sec, tan = 1 / np.cos(np.pi / n), np.tan(np.pi / n)
        return inradius / 3 * (sec + np.log(sec + tan) / tan)

    assert outer.strength(interface, **twist) == pytest.approx(MU * constant(3), rel=1e-9)
    assert inner.strength(interface, **twist) == pytest.approx(MU * constant(6), rel=1e-9)

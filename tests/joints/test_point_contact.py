"""Point contacts: torsion, refinement, inner and outer cones, queries by cutting planes."""

import numpy as np
import pytest
from rectangles import L1, L2, MU, RECTANGLE, SQUARE, N

import limitblocks as lb
from limitblocks.joints.cutting_planes import farthest
from limitblocks.joints.forces_at_points import used
from limitblocks.joints.torsion import rectangle_torsion_constant

TRIANGLE = np.array([(0.0, 0.0), (4.0, 0.0), (0.0, 1.0)])
COMPRESSION = np.array([0, 0, N, 0, 0, 0])
TORSION = (0, 0, 0, 0, 0, 1)


@pytest.mark.parametrize(("ratio", "excess"), [(1, 1.85), (2, 1.88), (4, 1.94)])
def test_torsion_is_mu_n_times_half_the_diagonal(ratio, excess):
    interface = lb.joints.interface(SQUARE * [ratio, 1], None)
    torsion = lb.PointContact(MU).strength(interface, TORSION, COMPRESSION)
    assert torsion == pytest.approx(-MU * N * np.hypot(ratio, 1), rel=1e-9)
    assert torsion / (-MU * N * rectangle_torsion_constant(ratio, 1)) == pytest.approx(excess, abs=0.01)


@pytest.mark.parametrize(("sides", "excess"), [(3, 2.17), (6, 1.64)])
def test_torsion_of_a_regular_polygon(sides, excess):
    """mu N R at its corners; under uniform pressure Eq. (11) over the half sectors of legs a and b."""
    angles = 2 * np.pi * np.arange(sides) / sides
    interface = lb.joints.interface(np.stack([np.cos(angles), np.sin(angles)], axis=1), None)
    torsion = lb.PointContact(MU).strength(interface, TORSION, COMPRESSION)
    a, b = np.cos(np.pi / sides), np.sin(np.pi / sides)
    uniform = (1 + a**2 / b * np.log((b + 1) / a)) / 3
    assert torsion == pytest.approx(-MU * N, rel=1e-9)
    assert torsion / (-MU * N * uniform) == pytest.approx(excess, abs=0.005)


@pytest.mark.parametrize("points", [2, 3, 5])
def test_refining_changes_nothing(points):
    corners, finer = lb.PointContact(MU), lb.PointContact(MU, points=points)
    rng = np.random.default_rng(points)
    for polygon in (RECTANGLE, TRIANGLE):
        interface = lb.joints.interface(polygon, None)
        for d in rng.normal(size=(4, 6)) * [1, 1, 0, 0.1, 0.1, 0.1]:
            assert finer.strength(interface, d, COMPRESSION) == pytest.approx(
                corners.strength(interface, d, COMPRESSION), rel=1e-8
            )


def test_any_force_within_the_polygon_is_carried_by_the_corners():
    """The reason: share it by barycentric weights."""
    interface, joint = lb.joints.interface(TRIANGLE, None), lb.PointContact(MU)
    rng = np.random.default_rng(0)
    for weights in rng.dirichlet(np.ones(3), 10):
        (x1, x2), angle = weights @ interface.polygon, rng.uniform(0, 2 * np.pi)
        V1, V2 = -MU * N * np.cos(angle), -MU * N * np.sin(angle)
        Q = np.array([V1, V2, N, x2 * N, -x1 * N, x1 * V2 - x2 * V1])
        assert joint.utilisation(interface, Q) <= 1 + 1e-9


@pytest.mark.parametrize("polygon", [RECTANGLE, TRIANGLE], ids=["rectangle", "triangle"])
def test_shear_and_hinging_are_exact(polygon):
    interface, joint = lb.joints.interface(polygon, None), lb.PointContact(MU)
    hinging = lb.OrdunaLourenco(MU)
    for angle in np.linspace(0, 6, 13):
        d = (np.cos(angle), np.sin(angle), 0, 0, 0, 0)
        assert joint.strength(interface, d, COMPRESSION) == pytest.approx(-MU * N, rel=1e-9)
        d = (0, 0, 0, np.cos(angle), np.sin(angle), 0)
        expected = hinging.strength(interface, d, COMPRESSION)
        assert joint.strength(interface, d, COMPRESSION) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("sides", [4, 8, 24])
def test_inner_and_outer_enclose_the_cones(sides):
    interface, limit = lb.joints.interface(RECTANGLE, None), np.cos(np.pi / sides)
    exact = lb.PointContact(MU)
    for d in np.random.default_rng(sides).normal(size=(6, 6)) * [1, 1, 0, 0.01, 0.01, 0.1]:
        low, true, high = (
            joint.strength(interface, d, COMPRESSION)
            for joint in (
                lb.PointContact(MU, cone="inner", sides=sides),
                exact,
                lb.PointContact(MU, cone="outer", sides=sides),
            )
        )
        assert low <= true * (1 + 1e-9)
        assert true <= high * (1 + 1e-9)
    for cone, factor in (("inner", limit), ("outer", 1 / limit)):
        rows = lb.PointContact(MU, cone=cone, sides=sides).yield_rows(RECTANGLE[None])
        assert (rows.linear, rows.cones, len(rows.modes)) == (4 + 4 * sides, (), 4 + 4 * sides)
        angle = np.pi / sides
        worst = (np.cos(angle), np.sin(angle), 0, 0, 0, 0)
        strength = lb.PointContact(MU, cone=cone, sides=sides).strength(interface, worst, COMPRESSION)
        assert strength == pytest.approx(-MU * N * factor, rel=1e-9)


@pytest.mark.parametrize("angle", [0.0, 0.1, np.pi / 16])
def test_a_force_in_the_cone_grows_without_limit_and_one_beyond_it_to_the_cone(angle):
    """From N = -1: f mu t = mu (1 + t) is at t = 1 / (f - 1), at none where f <= 1."""
    interface = lb.joints.interface(SQUARE, lb.PointContact(MU))
    for f, t in ((0.99, np.inf), (1.0, np.inf), (1.001, 1000.0)):
        along = (f * MU * np.cos(angle), f * MU * np.sin(angle), -1, 0, 0, 0)
        assert interface.joint.strength(interface, along, (0, 0, -1, 0, 0, 0)) == pytest.approx(t, rel=1e-6)


def test_convexity_scaling_and_the_compression_ray():
    interface, joint = lb.joints.interface(RECTANGLE, None), lb.PointContact(MU)
    directions = np.random.default_rng(5).normal(size=(12, 6)) * [1, 1, 0, 0.1, 0.1, 0.1]
    surface = [COMPRESSION + d * joint.strength(interface, d, COMPRESSION) for d in directions]
    for Q in np.add(surface[::2], surface[1::2]) / 2:
        assert joint.utilisation(interface, Q) <= 1 + 1e-8
    Q = surface[0]
    big = Q * 8 * np.array([1, 1, 1, 4, 4, 4])
    assert joint.utilisation(lb.joints.interface(4 * RECTANGLE, None), big) == pytest.approx(1, rel=1e-8)
    assert joint.utilisation(interface, COMPRESSION) == 0
    assert joint.utilisation(interface, (0, 0, 1, 0, 0, 0)) == np.inf
    assert joint.strength(interface, (0, 0, -1, 0, 0, 0)) == np.inf
    assert joint.strength(interface, (0.5, 0, -1, 0, 0, 0)) == np.inf
    assert joint.strength(interface, (0, 0, 1, 0, 0, 0), COMPRESSION) == pytest.approx(-N, rel=1e-9)
    assert joint.strength(interface, (0, 0, 1, 0, 0, 0)) == 0


@pytest.mark.parametrize(
    ("state", "modes"),
    [
        ((100, 0, N, 1, 1, 0), ()),
        ((-MU * N, 0, N, 0, 0, 0), ("slip",)),
        ((0, 0, N, -L2 * N, 0, 0), ("open",)),
        ((0, 0, N, 0, 0, -MU * N * np.hypot(L1, L2)), ("slip",)),
        ((0, 0, 1, 0, 0, 0), ("open",)),
        ((1, 0, 0, 0, 0, 0), ("open",)),
        (COMPRESSION, ()),
        (np.zeros(6), ()),
    ],
)
def test_active_modes_of_a_mechanism(state, modes):
    assert lb.PointContact(MU).active_modes(lb.joints.interface(RECTANGLE, None), state) == modes


def test_zero_friction():
    interface, joint = lb.joints.interface(RECTANGLE, None), lb.PointContact(0.0)
    assert joint.strength(interface, (0, 0, 0, 1, 0, 0), COMPRESSION) == pytest.approx(-N * L2, rel=1e-9)
    assert joint.strength(interface, TORSION, COMPRESSION) == 0
    with pytest.raises(lb.ModelError, match="outside the yield set already"):
        joint.strength(interface, TORSION, np.add(COMPRESSION, [1, 0, 0, 0, 0, 0]))


def test_answer_satisfies_the_cones_to_1e_10():
    rows = lb.PointContact(MU, points=2).yield_rows(SQUARE[None])
    t, rates = farthest(rows, np.array([0, 0, -1.0, 0.2, 0.1, 0]), np.array([0.3, -0.4, 0, 0.1, 0, 0.9]))
    assert 0 < t < 2
    assert rates.shape == (16,)
    assert (rates >= 0).all()


@pytest.mark.parametrize("share", [1e-2, 2e-4])
def test_a_direction_just_outside_the_cones_has_a_limit(share):
    """Force that grows along (mu (1 + share) t, -t) from -1 slips where mu (1 + share) t = mu (1 + t)."""
    joint, along = lb.PointContact(MU), MU * (1.0 + share)
    interface, angle = lb.joints.interface(SQUARE, None), np.pi / 16  # between the first planes
    direction = (along * np.cos(angle), along * np.sin(angle), -1, 0, 0, 0)
    assert joint.strength(interface, direction, (0, 0, -1, 0, 0, 0)) == pytest.approx(1 / share, rel=1e-4)
    assert joint.strength(interface, (0, 0, -1, 0, 0, 0), (0, 0, -1, 0, 0, 0)) == np.inf


def test_noise_in_a_stress_state_does_not_stop_the_solver():
    """The noise a solver leaves in the out-of-plane resultants of a plane wall."""
    interface = lb.joints.interface(RECTANGLE, None)
    rng = np.random.default_rng(3)
    for size in (1e-9, 1e-12, 1e-16):
        for noise in rng.normal(size=(8, 6)) * size * -N * [1, 1, 0, L1, L1, L1]:
            for Q, share in (
                ((-MU * N, 0, N, 0, -2e-3 * N * L1, 0), 1.0),  # the axial force near the middle can slide
                ((-0.5 * MU * N, 0, N, 0, 0, 0), 0.5),
                ((0, 0, N, 0.3 * N * L2, 0, 0), 0.3),
            ):
                values = lb.PointContact(MU).utilisation(interface, np.add(Q, noise))
                assert values == pytest.approx(share, abs=20 * size + 1e-8)


def test_utilisation_of_every_interface_of_a_wall():
    """A stress state of the static theorem is within every yield set; HiGHS's presolve gave up on one."""
    model = lb.structures.ferris_tin_loi_wall(1, lb.PointContact(0.6))
    result = lb.bounds(model)
    used = [
        i.joint.utilisation(i, Q) for i, Q in zip(model.interfaces, result.stress_resultants, strict=True)
    ]
    carries = np.abs(result.stress_resultants[:, 2]) > 1e-3 * model.free_blocks[0].weight
    assert np.all(np.array(used)[carries] <= 1 + 1e-5)
    assert max(np.array(used)[carries]) == pytest.approx(1, abs=1e-5)  # it collapses


def test_an_interface_that_carries_rounding_alone():
    """HiGHS gave up on such states, 4e-11 N: V2 over mu |N|, or M1 over |N| times the half side."""
    polygon = np.array([(0.3, -0.1), (0.3, 0.1), (-0.3, 0.1), (-0.3, -0.1)])
    V2, N2, M1 = 5.51144723e-12, -3.90941282e-11, 5.87182741e-13
    result = lb.PointContact(0.6).utilisation(
        lb.joints.interface(polygon, None), (3e-28, V2, N2, M1, -7e-28, 9e-29)
    )
    assert result == pytest.approx(max(V2 / (0.6 * -N2), M1 / (0.1 * -N2)), rel=1e-7)


def test_given_stresses_outside_are_refused_even_if_the_direction_leads_inside():
    interface, joint = lb.joints.interface(RECTANGLE, None), lb.PointContact(MU)
    for given in (-COMPRESSION, COMPRESSION - [1.01 * MU * N, 0, 0, 0, 0, 0]):
        with pytest.raises(lb.ModelError, match="outside the yield set already"):
            joint.strength(interface, COMPRESSION, given)
    # on the surface, back through the cone: the whole diameter
    given = COMPRESSION - [MU * N, 0, 0, 0, 0, 0]
    assert joint.strength(interface, (-1, 0, 0, 0, 0, 0), given) == pytest.approx(-2 * MU * N, rel=1e-8)


def test_multipliers_are_those_of_the_mechanism():
    """Turning about an edge opens two points and slides none; sliding slides the points and opens none."""
    rows = lb.PointContact(MU).yield_rows(SQUARE[None])
    held = np.array([0, 0, -1.0, 0, 0, 0])
    for d, opens in ((np.eye(6)[3], True), (np.eye(6)[0], False), (np.eye(6)[5], False)):
        _, rates = farthest(rows, held, d)
        opening, slip = rates[:4].max(), rates[4:].max()
        assert min(opening, slip) <= 1e-6 * max(opening, slip)
        assert (opening > slip) == opens


def test_no_flow_in_stress_resultants():
    with pytest.raises(lb.ModelError, match="no flow directions"):
        lb.PointContact(MU).flow_directions(lb.joints.interface(RECTANGLE, None), COMPRESSION)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"friction": -0.1}, "friction is -0.1"),
        ({"friction": 0.6, "points": 0}, "points is 0, expected a whole number of at least 1"),
        ({"friction": 0.6, "cone": "paper"}, "cone is 'paper', expected one of 'exact', 'inner', 'outer'"),
        ({"friction": 0.6, "sides": 2}, "sides is 2"),
        ({"friction": 0.6, "sides": 12}, "sides is 12, but cone='exact' is round"),
    ],
)
def test_bad_settings_are_named(settings, message):
    with pytest.raises(lb.ModelError, match=message):
        lb.PointContact(**settings)


@pytest.mark.parametrize("sides", [3, 4, 10, 11, "pentagon"])
def test_compression_has_no_limit_on_any_polygon(sides):
    """Each corner presses as much as it is asked to, without shear."""
    if sides == "pentagon":
        polygon = np.array([(1.7, 0.26), (1.41, 0.64), (-1.69, 0.29), (-0.52, -1.03), (1.4, -0.65)])
    else:
        angle = 2 * np.pi * np.arange(sides) / sides
        polygon = np.column_stack([np.cos(angle), 0.6 * np.sin(angle)])
    for height in (0.5, 1.0, 5 / 3):
        interface = lb.joints.interface(polygon * [1, height], None)
        assert lb.PointContact(0.6).strength(interface, (0, 0, -1, 0, 0, 0)) == np.inf


def test_points_all_at_once_by_closed_forms():
    """On a rectangle: |V| / mu N, |e1| / l1, |T| / (mu N d / 2); points between change nothing."""
    mu, l1, l2 = 0.5, 2.0, 1.0
    Q = np.array(
        [
            (0.06, 0.08, -1, 0, 0, 0),
            (0, 0, -1, 0, 0.5, 0),
            (0, 0, -1, 0.5, 0.5, 0),
            (0, 0, -1, 0, 0, 0.3),
            (0, 0, -1, 0, 0, 0),
            (0.6, 0, -1, 0, 0, 0),
        ]
    )
    expected = [0.1 / mu, 0.5 / l1, 0.5 / l2, 0.3 / (mu * np.hypot(l1, l2)), 0.0, 1.0]
    rectangle = np.array([(l1, l2), (-l1, l2), (-l1, -l2), (l1, -l2)])
    for points in (1, 3):
        rows = lb.PointContact(mu, points).yield_rows(np.repeat(rectangle[None], len(Q), axis=0))
        assert used(rows, Q) == pytest.approx(expected, rel=1e-6, abs=1e-12)

"""Questions to one interface: closed forms against bisection, meanings of the answers, bad input."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import limitblocks as lb
from limitblocks.problem import Cones

CONE = Cones(0, ((1, 3),))
MU, N = 0.7, -240.0
RECTANGLE = np.array([(0.15, -0.1), (0.15, 0.1), (-0.15, 0.1), (-0.15, -0.1)])
JOINTS = [
    lb.OrdunaLourenco(MU, slip="paper"),
    lb.OrdunaLourenco(MU, 2e4),
    lb.joints.ExactTorsion(MU, fineness=2),
    lb.PointContact(MU),
]
every_joint = pytest.mark.parametrize("joint", JOINTS, ids=repr)


@given(st.lists(st.integers(-5000, 5000).map(lambda k: k / 1000), min_size=6, max_size=6))
def test_reach_within_a_cone_against_bisection(numbers):
    a, z1, z2, b, w1, w2 = numbers
    value, slope = np.array([abs(a) + np.hypot(z1, z2), z1, z2]), np.array([b, w1, w2])

    def margin(t):
        return value[0] + t * slope[0] - np.hypot(*(value[1:] + t * slope[1:]))

    t = CONE.longest(value, slope)
    size = np.abs(value).max() + np.abs(slope).max()
    if np.isinf(t):
        assert margin(1e6) >= -1e-9 * 1e6 * size
    else:
        assert margin(t) == pytest.approx(0, abs=1e-9 * size * (1 + t))
        assert margin(t + 1e-3 * (1 + t)) < 1e-7 * size * (1 + t)


def test_reach_at_the_apex_and_along_the_boundary():
    for value, slope, expected in (
        ((0, 0, 0), (1, 1, 0), np.inf),
        ((0, 0, 0), (1, 1.1, 0), 0),
        ((0, 0, 0), (-1, 0, 0), 0),
        ((1, 1, 0), (1, 1, 0), np.inf),
        ((1, 1, 0), (-1, -1, 0), 1),
        ((1, 1, 0), (0, 0, 1), 0),
        ((1, 1, 0), (0, -1, 0), 2),
        ((1, 0, 0), (-0.5, 0, 0), 2),
    ):
        assert CONE.longest(np.array(value, float), np.array(slope, float)) == pytest.approx(expected)


@every_joint
def test_strength_and_utilisation_say_the_same(joint):
    interface = lb.joints.interface(RECTANGLE, joint)
    rng = np.random.default_rng(0)
    for d in rng.normal(size=(8, 6)) * [1, 1, 0, 0.1, 0.1, 0.1]:
        held = np.array([0, 0, N, 0, 0, 0])
        t = joint.strength(interface, d, held)
        assert joint.strength(interface, 100 * d, held) == pytest.approx(t / 100, rel=1e-8)
        for share in (0.3, 1.0, 2.5):
            assert joint.utilisation(interface, held + share * t * d) == pytest.approx(share, rel=1e-7)
        assert joint.active_modes(interface, held + t * d)
        assert joint.active_modes(interface, held + 0.9 * t * d) == ()
        with pytest.raises(lb.ModelError, match="outside the yield set already"):
            joint.strength(interface, d, held + 1.01 * t * d)
    assert joint.utilisation(interface, (1, 0, 0, 0, 0, 0)) == np.inf
    assert joint.utilisation(interface, np.zeros(6)) == 0
    assert joint.active_modes(interface, np.zeros(6)) == ()


def test_active_modes_by_name():
    interface = lb.joints.interface(RECTANGLE, None)
    c_T = 0.0968105
    joint, held = lb.OrdunaLourenco(MU), np.array([0, 0, N, 0, 0, 0])
    limit = -MU * N
    for state, modes in (
        ((limit, 0, 0, 0, 0, 0), ("slip",)),
        ((0, 0, 0, 0, 0, c_T * limit), ("twist",)),
        ((0.65 * limit, 0, 0, 0, 0, 0.65 * c_T * limit), ("slip-twist",)),
        ((0, 0, 0, -0.1 * N, 0, 0.075 * limit), ("moment-twist", "hinge")),
        ((0, 0, 0, 0, 0.15 * N, 0), ("hinge",)),
    ):
        assert joint.active_modes(interface, held + state, tolerance=1e-5) == modes
    crushing = lb.OrdunaLourenco(MU, compressive_strength=1e4)
    assert crushing.active_modes(interface, (0, 0, -600, 0, 0, 0)) == ("crush",)
    assert crushing.utilisation(interface, (0, 0, -601, 0, 0, 0)) == np.inf


@every_joint
def test_questions_in_any_units(joint):
    """Tiny and huge forces: the answers scale, unless there is a strength."""
    if getattr(joint, "compressive_strength", None):
        return
    interface, Q = lb.joints.interface(RECTANGLE, None), np.array([50, 30, N, 4, -6, 5.0])
    small, usual, large = (joint.utilisation(interface, factor * Q) for factor in (1e-9, 1.0, 1e9))
    assert [small, large] == pytest.approx([usual, usual], rel=1e-9)


def test_interface_for_teaching():
    interface = lb.joints.interface(np.add(RECTANGLE[::-1], (3, 4)), JOINTS[0])
    np.testing.assert_allclose(interface.polygon.mean(axis=0), 0, atol=1e-15)
    x, y = interface.polygon.T
    assert (x * np.roll(y, -1) - np.roll(x, -1) * y).sum() / 2 == pytest.approx(0.06)
    assert interface.joint is JOINTS[0]


@pytest.mark.parametrize(
    ("polygon", "message"),
    [
        ([(0, 0), (1, 1), (1, 0), (0, 1)], "must be simple.*Self-intersection"),
        ([(0, 0), (1, 0), (2, 0)], "must"),
        ([(0, 0), (1, 0)], "n >= 3"),
        ([(0, 0), (1, 0), (np.nan, 1)], "finite"),
        ([(0, 0), (3, 0), (3, 1), (1, 1), (1, 4), (0, 4)], "must be convex"),
    ],
)
def test_bad_polygons_are_named(polygon, message):
    with pytest.raises(lb.errors.GeometryError, match=message):
        lb.joints.interface(polygon, JOINTS[0])


def test_bad_questions_are_named():
    interface, joint = lb.joints.interface(RECTANGLE, None), JOINTS[0]
    with pytest.raises(lb.ModelError, match="direction is zero"):
        joint.strength(interface, np.zeros(6))
    with pytest.raises(lb.ModelError, match=r"direction is .*expected six finite numbers"):
        joint.strength(interface, (1, 2, 3))
    with pytest.raises(lb.ModelError, match=r"given is .*expected six finite numbers"):
        joint.strength(interface, (1, 0, 0, 0, 0, 0), (0, 0, np.nan, 0, 0, 0))
    with pytest.raises(lb.ModelError, match="Q is"):
        joint.utilisation(interface, [1])


@pytest.mark.parametrize("ask", ["strength", "utilisation", "active_modes", "flow_directions"])
def test_a_polygon_is_no_interface(ask):
    with pytest.raises(lb.ModelError, match="interface is a list, expected Interface"):
        getattr(JOINTS[0], ask)([(0, 0), (1, 0), (1, 1), (0, 1)], (0, 0, -1, 0, 0, 1))


def test_given_stresses_that_crush_are_refused_whatever_the_direction():
    """2e5 N on 1 m2 of 1e5 Pa; without friction there is no shear to ask for."""
    joint = lb.OrdunaLourenco(0.0, compressive_strength=1e5)
    face = lb.joints.interface([(0, 0), (1, 0), (1, 1), (0, 1)], joint)
    for direction in ((1, 0, 0, 0, 0, 0), (0, 0, 0, 1, 0, 0)):
        with pytest.raises(lb.ModelError, match="outside the yield set already"):
            joint.strength(face, direction, (0, 0, -2e5, 0, 0, 0))
    assert joint.strength(face, (1, 0, 0, 0, 0, 0), (0, 0, -5e4, 0, 0, 0)) == 0.0


def test_words_name_what_is_not_default():
    assert repr(lb.OrdunaLourenco(0.6)) == "OrdunaLourenco(friction=0.6)"
    assert repr(lb.OrdunaLourenco(0.6, 2e6, slip="paper")) == (
        "OrdunaLourenco(friction=0.6, compressive_strength=2000000.0, slip='paper')"
    )
    assert repr(lb.PointContact(0.7)) == "PointContact(friction=0.7)"
    assert repr(lb.joints.ExactTorsion(0.7, side="outer")) == "ExactTorsion(friction=0.7, side='outer')"


@every_joint
def test_joints_are_hashable_settings_that_a_file_can_hold(joint, tmp_path):
    assert hash(joint) == hash(type(joint)(**vars(joint)))
    model = lb.structures.block(joint, width=0.5, height=1.0)
    again = lb.read(model.save(tmp_path / "model.json"))
    assert again.interfaces[0].joint == joint
    assert again.digest == model.digest


def test_what_the_normal_force_uses_by_itself_counts_beside_a_small_shear():
    """1 m2 of 1e5 Pa in compression and 1e4 Pa in tension; the shear of 1 N has thousands of times that."""
    joint = lb.OrdunaLourenco(0.6, compressive_strength=1e5, cohesion=1e4, tensile_strength=1e4)
    face = lb.joints.interface([(0, 0), (1, 0), (1, 1), (0, 1)], joint)
    for N, share in ((-9e4, 0.9), (5e3, 0.5)):
        for shear in (0.0, 1.0):
            assert joint.utilisation(face, (shear, 0, N, 0, 0, 0)) == pytest.approx(share, rel=1e-9)

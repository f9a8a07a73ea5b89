"""States strictly within a cone: in equilibrium, in proportion, found where there is little room."""

import numpy as np
import pytest

import limitblocks as lb
from limitblocks import structures
from limitblocks.analysis import splitting
from limitblocks.analysis.scales import scaled
from limitblocks.analysis.splitting import Splitting
from limitblocks.problem import Cones

JOINTS = [lb.PointContact(0.6), lb.OrdunaLourenco(0.6), lb.OrdunaLourenco(0.6, compressive_strength=1e7)]


def wall(joint):
    return scaled(structures.wall(joint, length=2.0, courses=6, direction=(1.0, 1.0, 0.0)).problem)


def stack(fraction):
    """The harmonic stack: at fraction one of its largest overhang it stands without any margin."""
    joint = lb.PointContact(0.6)
    return scaled(structures.overhang(joint, count=3, length=1.0, height=0.3, fraction=fraction).problem)


def test_the_nearest_point_of_a_cone_leaves_a_normal_of_it():
    """Moreau: z = P(z) - n with P(z) and n in K, which is its own dual, and P(z).n = 0."""
    cones = Cones(3, ((4, 3), (2, 2)))
    for z in np.random.default_rng(1).normal(size=(50, cones.height)):
        near = cones.nearest(z)
        assert cones.margin(near).min() >= -1e-12
        assert cones.margin(near - z).min() >= -1e-12
        assert near @ (near - z) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("joint", JOINTS)
def test_stresses_carry_the_dead_loads_strictly_within_yield(joint):
    p = wall(joint)
    x = Splitting(p).stresses()
    assert p.C.T @ x == pytest.approx(p.dead, abs=1e-10)
    assert p.cones.margin(p.F @ x + p.g).min() > 0.0


@pytest.mark.parametrize("joint", JOINTS)
def test_a_mechanism_opens_every_joint_in_proportion(joint):
    p = wall(joint)
    amount = np.zeros(p.F.shape[0])
    amount[p.cones.heads] = np.linspace(0.1, 1.0, p.cones.degree)
    u, y = Splitting(p).mechanism(amount)
    assert p.C @ u == pytest.approx(-p.F.T @ y, abs=1e-6)
    assert (p.cones.margin(y) > splitting.SHARE * amount[p.cones.heads]).all()


def test_little_room_is_found_by_asking_for_less_and_less(monkeypatch):
    p = stack(1.0 - 1e-3)
    x = Splitting(p).stresses()
    assert p.cones.margin(p.F @ x + p.g).min() > 0.0
    monkeypatch.setattr(splitting, "LESS", 1.0)
    assert Splitting(p).stresses() is None


def test_no_stresses_are_found_where_the_stack_falls():
    assert Splitting(stack(1.01)).stresses() is None


def test_room_that_is_asked_for_is_enough_to_prove_a_tower():
    """Mixed states leave their error over their room between the bounds: a hundredth of it left 2e-8."""
    found = lb.bounds(structures.EXAMPLES["tower"](lb.PointContact(0.6)))
    assert found.proven
    assert found.upper - found.lower <= 1e-8 * found.upper

"""What the bounds must satisfy whatever the structure: invariance, monotony, virtual work, equilibrium."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from stones import imbalance

import limitblocks as lb
from limitblocks import structures
from limitblocks.mechanics.loads import MassProportional

JOINTS = [lb.OrdunaLourenco(0.55), lb.PointContact(0.55)]


@pytest.fixture(params=JOINTS, ids=lambda joint: type(joint).__name__, scope="module")
def reference(request):
    """A corner of two walls pushed askew, so that all six stress resultants are at work, with its bounds."""
    model = structures.facade(
        request.param,
        length=2.4,
        courses=3,
        return_length=1.2,
        openings=[(0.8, 0.0, 0.8, 0.4)],
        direction=(0.4, -1.0, 0.1),
    )
    return model, lb.bounds(model)


STILL = np.eye(3)


def rebuilt(model, blocks, turn=STILL):
    """`model` with other blocks: interfaces are found again and the loads turned."""

    def turned(load):
        return lb.loads.Load(
            tuple((k, MassProportional(tuple(turn @ term.direction))) for k, term in load.terms)
        )

    interfaces = lb.find_interfaces(blocks, model.interfaces[0].joint)
    return lb.Model(blocks, model.supports, interfaces, turned(model.dead), turned(model.live))


def assert_same(found, expected):
    assert found.lower == pytest.approx(expected.lower, rel=2e-6)
    assert found.upper == pytest.approx(expected.upper, rel=2e-6)


@pytest.mark.parametrize("seed", range(3))
def test_rigid_motion(reference, seed):
    model, expected = reference
    random = np.random.default_rng(seed)
    turn = Rotation.random(random_state=seed).as_matrix()
    shift = random.uniform(-10, 10, 3)
    assert_same(lb.bounds(rebuilt(model, [b.moved(turn, shift) for b in model.blocks], turn)), expected)


def test_shift_of_a_thousand_kilometres(reference):
    model, expected = reference
    moved = [block.moved(np.eye(3), (1e6, -1e6, 1e6)) for block in model.blocks]
    assert_same(lb.bounds(rebuilt(model, moved)), expected)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_mirror(reference, axis):
    model, expected = reference
    mirror = np.diag([-1.0 if k == axis else 1.0 for k in range(3)])
    blocks = [
        replace(block, vertices=block.vertices @ mirror, faces=[face[::-1] for face in block.faces])
        for block in model.blocks
    ]
    assert_same(lb.bounds(rebuilt(model, blocks, mirror)), expected)


@pytest.mark.parametrize("seed", range(2))
def test_order_of_the_blocks(reference, seed):
    model, expected = reference
    order = np.random.default_rng(seed).permutation(len(model.blocks))
    assert_same(lb.bounds(rebuilt(model, [model.blocks[k] for k in order])), expected)


@pytest.mark.parametrize(
    ("length", "force"), [(1e3, 1e-3), (1e-3, 1e-6), (1e3, 1.0)], ids=["kN mm", "MN km", "N mm"]
)
def test_units(reference, length, force):
    model, expected = reference
    blocks = [
        replace(
            block,
            vertices=block.vertices * length,
            unit_weight=block.unit_weight and block.unit_weight * force / length**3,
        )
        for block in model.blocks
    ]
    found = lb.bounds(rebuilt(model, blocks))
    assert_same(found, expected)


def test_load_factor_is_inverse_to_the_live_load(reference):
    model, expected = reference
    found = lb.bounds(replace(model, live=1e5 * model.live))
    assert 1e5 * found.lower == pytest.approx(expected.lower, rel=2e-6)


@pytest.mark.parametrize("joint_type", [lb.OrdunaLourenco, lb.PointContact])
def test_monotone_in_friction(joint_type):
    found = [
        lb.bounds(
            structures.facade(joint_type(mu), length=2.4, courses=3, return_length=1.2, openings=[])
        ).lower
        for mu in (0.0, 0.1, 0.3, 0.5, 0.8)
    ]
    assert all(low <= high + 1e-6 for low, high in pairwise(found))
    assert found[0] == pytest.approx(0.0, abs=1e-6)
    assert found[-1] > found[1]


@settings(max_examples=15)
@given(b=st.floats(0.2, 2.0), h=st.floats(0.2, 2.0), mu=st.floats(0.0, 1.5), angle=st.floats(0.0, 2 * np.pi))
def test_static_is_at_most_kinematic(b, h, mu, angle):
    direction = (np.cos(angle), np.sin(angle), 0.0)
    model = structures.column(lb.PointContact(mu), count=2, width=b, height=h, depth=0.7, direction=direction)
    found = lb.bounds(model)
    assert found.lower <= found.upper + 1e-6 * max(1.0, found.upper)
    assert found.gap < 1e-6


@settings(max_examples=20)
@given(seed=st.integers(0, 10_000))
def test_virtual_work(seed):
    """F.du = Q.dq with dq from rigid-body motion and F from statics, both by hand (Eq. 46 corrected)."""
    random = np.random.default_rng(seed)
    turn = Rotation.random(random_state=seed).as_matrix()
    model = structures.column(JOINTS[0], count=3, width=0.5, height=0.3, depth=0.4)
    shift = random.uniform(-5, 5, 3)
    model = rebuilt(model, [block.moved(turn, shift) for block in model.blocks])
    problem = model.problem
    place = {name: k for k, name in enumerate(problem.blocks)}
    centroid = {block.name: block.centroid for block in model.blocks}
    u = random.uniform(-1, 1, (len(place), 6))
    Q = random.uniform(-1, 1, (len(model.interfaces), 6))
    F = np.zeros_like(u)
    work = 0.0
    for interface, q in zip(model.interfaces, Q, strict=True):
        f, m = interface.axes.T @ q[:3], interface.axes.T @ q[3:]
        rates = np.zeros(6)
        for name, sign in ((interface.block_i, -1.0), (interface.block_j, 1.0)):
            if name not in place:
                continue
            r = interface.centroid - centroid[name]
            v, w = u[place[name], :3], u[place[name], 3:]
            rates += sign * np.concatenate([interface.axes @ (v + np.cross(w, r)), interface.axes @ w])
            F[place[name]] += sign * np.concatenate([f, m + np.cross(r, f)])
        work += q @ rates
    assert F.ravel() @ u.ravel() == pytest.approx(work, abs=1e-12)
    loads, stresses = problem.units.loads, problem.stress_units  # C in their units, u the dual of loads
    C = problem.C / stresses[:, None] * loads
    assert C @ u.ravel() @ Q.ravel() == pytest.approx(work, abs=1e-12)
    assert C.T @ Q.ravel() == pytest.approx(F.ravel(), abs=1e-12)


def test_stress_resultants_balance_the_loads_of_every_block(reference):
    model, found = reference
    weight = np.mean([block.weight for block in model.free_blocks])
    assert np.abs(imbalance(model, found.lower, found.stress_resultants)).max() < 1e-5 * weight


def test_stress_resultants_are_compressive_and_within_the_coulomb_cone(reference):
    model, found = reference
    V, N = np.hypot(*found.stress_resultants[:, :2].T), found.stress_resultants[:, 2]
    weight = np.mean([block.weight for block in model.free_blocks])
    assert N.max() < 1e-6 * weight
    assert (V + 0.55 * N).max() < 1e-5 * weight


def test_mechanism_gives_the_upper_bound_by_its_own_work(reference):
    """Dry joints dissipate nothing in associated flow: live work one, dead work minus the load factor."""
    model, found = reference
    u = found.displacement_rates[model.free]
    assert np.sum(model.live.on(model.free_blocks) * u) == pytest.approx(1.0, rel=1e-6)
    assert -np.sum(model.dead.on(model.free_blocks) * u) == pytest.approx(found.upper, rel=1e-6)
    assert not found.displacement_rates[~model.free].any()


def test_result_arrays_are_read_only(reference):
    _, found = reference
    for name in ("stress_resultants", "generalised_stresses", "displacement_rates", "flow_multipliers"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(found, name)[0] = 0.0

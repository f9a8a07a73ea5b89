"""Flow rule, Tables 3, 5 and 6: signs, zero dilatancy, the associated limit, and its derivative."""

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.problem.flow import SMALL_NORMAL_FORCE, dilatancy_share, plastic_potential, turning

MU = 0.5
JOINTS = [
    lb.OrdunaLourenco(MU, slip="paper"),
    lb.OrdunaLourenco(MU),
    lb.OrdunaLourenco(MU, compressive_strength=1e6),
    lb.ExactTorsion(MU, fineness=2),
    lb.PointContact(MU),
]
every_joint = pytest.mark.parametrize("joint", JOINTS, ids=repr)
SIDES = (0.8, 0.5)


def problem_of(joint):
    return lb.structures.block(joint, width=SIDES[0], depth=SIDES[1], height=0.6).problem


def compressed(problem, seed=0):
    """A state with N = -1 block weight and moments well within the interface."""
    random = np.random.default_rng(seed)
    if problem.C.shape[0] == 6:
        return np.array([0.1, -0.2, -1.0, 0.2, -0.1, 0.05]) * (1 + 0.3 * random.uniform(size=6))
    return random.uniform(-1, 1, problem.C.shape[0])


def strain_rates(problem, G):
    """Rates (ds1, ds2, dn, dth1, dth2, dthn) of a unit multiplier of each row whose stresses are Q."""
    return -G.toarray() @ np.linalg.pinv(problem.resultants.toarray())


@every_joint
def test_dilatancy_equal_to_friction_is_associated(joint):
    problem = problem_of(joint)
    G = plastic_potential(problem, compressed(problem), MU)
    np.testing.assert_allclose(G.toarray(), problem.F.toarray(), atol=1e-13)


@every_joint
def test_in_between_the_flows_are_mixed_in_proportion(joint):
    problem = problem_of(joint)
    x = compressed(problem)
    zero, half = (plastic_potential(problem, x, d).toarray() for d in (0.0, MU / 2))
    np.testing.assert_allclose(half, (zero + problem.F.toarray()) / 2, atol=1e-13)
    np.testing.assert_array_equal(dilatancy_share(problem, MU / 2), 0.5)


@every_joint
@pytest.mark.parametrize("dilatancy", [-1e-9, MU + 1e-9, np.nan, np.inf])
def test_dilatancy_out_of_range_is_refused(joint, dilatancy):
    problem = problem_of(joint)
    with pytest.raises(lb.ModelError, match=r"expected 0 to the least friction coefficient, 0\.5"):
        plastic_potential(problem, compressed(problem), dilatancy)


@every_joint
def test_friction_modes_do_not_lift_without_dilatancy_and_the_others_are_associated(joint):
    problem = problem_of(joint)
    G = plastic_potential(problem, compressed(problem)).toarray()
    lifting = np.abs(problem.resultants.toarray()[2:5]).max(axis=0) > 0  # N, M1, M2 or corner forces
    tangential = np.abs(problem.resultants.toarray()[:2]).max(axis=0) > 0
    free = np.array([mode in {"open", "hinge", "crush"} for mode in problem.row_mode])
    assert free.any()
    assert not free.all()
    np.testing.assert_array_equal(G[~free][:, lifting & ~tangential], 0.0)
    np.testing.assert_array_equal(G[free], problem.F.toarray()[free])


@pytest.mark.parametrize("dilatancy", [0.0, 0.2, MU])
def test_slip_lifts_by_the_dilatancy(dilatancy):
    """dn = dilatancy |ds|, and positive dn opens (Table 3 and its associated counterpart)."""
    problem = problem_of(JOINTS[0])
    flow = -plastic_potential(problem, compressed(problem), dilatancy).toarray()
    slip = np.array([mode == "slip" for mode in problem.row_mode])
    np.testing.assert_allclose(flow[slip, 2], dilatancy * np.hypot(*flow[slip, :2].T), atol=1e-15)
    point = problem_of(JOINTS[4])
    G = plastic_potential(point, compressed(point), dilatancy).toarray()
    t, z1, z2 = point.cones.linear + np.arange(3)
    normal = int(np.flatnonzero(point.F.toarray()[t])[0])
    across = [int(np.flatnonzero(point.F.toarray()[row])[0]) for row in (z1, z2)]
    direction = np.array([0.6, -0.8])  # of V; the multipliers are (1, -direction)
    rates = -G.T[:, [t, z1, z2]] @ np.concatenate([[1.0], -direction])
    assert rates[normal] == pytest.approx(dilatancy)
    np.testing.assert_allclose(rates[across], direction)


def test_every_mode_flows_the_way_its_stress_pushes():
    """Flow of a row with the gradient of the paper's function: V.ds > 0, T dthn > 0, hinging opens."""
    problem = problem_of(JOINTS[0])
    gradient = -problem.F.toarray()
    flow = -plastic_potential(problem, np.array([0, 0, -1.0, 0, 0, 0])).toarray()
    for mode, row, dq in zip(problem.row_mode, gradient, flow, strict=True):
        assert row[2] > 0.0  # more compression is farther from yield
        if mode == "hinge":
            assert dq[2] == 1.0
        else:
            np.testing.assert_array_equal(dq[[0, 1, 5]], row[[0, 1, 5]])


def test_table_5_turns_about_the_eccentricity():
    """dq = dthn (M1/N, M2/N, 0, 0, 0, 1), both signs of T: no slip at (e1, e2) = (-M2/N, M1/N)."""
    problem = problem_of(JOINTS[0])
    Q = np.array([0.0, 0.0, -2.0, 0.3, -0.4, 0.1])
    flow = -plastic_potential(problem, Q).toarray()
    rows = [k for k, mode in enumerate(problem.row_mode) if mode == "moment-twist"]
    assert len(rows) == 8
    close = {"rtol": 2 * (SMALL_NORMAL_FORCE / 2.0) ** 2}  # N / (N^2 + eps^2) stands for 1 / N
    e1, e2 = 0.4 / -2.0, 0.3 / -2.0
    for dq in flow[rows]:
        ds1, ds2, dn, dth1, dth2, dthn = dq
        np.testing.assert_allclose([ds1, ds2], np.multiply(dthn, [0.3 / -2.0, -0.4 / -2.0]), **close)
        np.testing.assert_allclose([ds1 - dthn * e2, ds2 + dthn * e1], 0.0, atol=1e-6)
        assert dn == dth1 == dth2 == 0.0
    assert {np.sign(dq[5]) for dq in flow[rows]} == {1.0, -1.0}


def test_the_centre_stays_near_the_interface_where_the_quotient_is_noise():
    problem = problem_of(JOINTS[0])
    rows = [k for k, mode in enumerate(problem.row_mode) if mode == "moment-twist"]
    for N in (0.0, -1e-9, -1e-3, 1e-3):
        flow = -plastic_potential(problem, np.array([0, 0, N, 50.0, -80.0, 0])).toarray()[rows]
        centre = np.abs(flow[:, [1, 0]] / flow[:, [5]])  # |e1|, |e2|
        assert (centre <= 1.5 * problem.reach[0] + 1e-12).all()


@every_joint
@pytest.mark.parametrize("dilatancy", [0.0, 0.2, MU])
@pytest.mark.parametrize("seed", range(3))
def test_turning_is_the_derivative_of_the_flow(joint, dilatancy, seed):
    problem = problem_of(joint)
    x = compressed(problem, seed)
    y = np.random.default_rng(seed).uniform(size=len(problem.g))
    step = 1e-6

    def flow(stresses):
        return -plastic_potential(problem, stresses, dilatancy).T @ y

    columns = [(flow(x + step * e) - flow(x - step * e)) / (2 * step) for e in np.eye(len(x))]
    found = turning(problem, x, y, dilatancy).toarray()
    np.testing.assert_allclose(found, np.transpose(columns), atol=1e-7 * max(1.0, np.abs(found).max()))
    turns = problem.pivot.any() and dilatancy < MU
    assert (np.abs(found).max() > 1e-3) == turns

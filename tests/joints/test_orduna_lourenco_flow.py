"""Flow directions of the paper's joint: Tables 3 and 5, normality, dilatancy."""

import numpy as np
import pytest
from rectangles import (
    C_T,
    L1,
    L2,
    MU,
    PAPER,
    RECTANGLE,
    SLIPS,
    N,
    finite_differences,
    states,
    yield_functions,
)

import limitblocks as lb


def test_tables_3_and_5_and_hinging():
    joint, interface = PAPER, lb.joints.interface(RECTANGLE, None)
    Q = np.array([10.0, -20.0, N, 8.0, -12.0, 3.0])
    flow = joint.flow_directions(interface, Q, turning="centre of pressure")
    modes = np.array(joint.yield_rows(RECTANGLE[None]).modes)
    half = np.sqrt(0.5)
    assert flow.shape == (38, 6)
    expected = {(s, 0) for s in (1, -1)} | {(0, s) for s in (1, -1)}
    expected |= {(a * half, b * half) for a in (1, -1) for b in (1, -1)}
    slip, slip_twist = flow[modes == "slip"], flow[modes == "slip-twist"]
    assert {tuple(v) for v in np.round(slip[:, :2], 12)} == {tuple(np.round(v, 12)) for v in expected}
    assert not slip[:, 2:].any()
    assert not slip_twist[:, 2:5].any()
    np.testing.assert_allclose(abs(slip_twist[:, 5]), 1 / C_T)
    turning = flow[modes == "moment-twist"]
    e1, e2 = -Q[4] / N, Q[3] / N
    per_twist = turning / turning[:, 5:]
    np.testing.assert_allclose(per_twist, np.tile([e2, -e1, 0, 0, 0, 1], (8, 1)), atol=1e-12)
    np.testing.assert_allclose(per_twist[:, :2], np.tile([Q[3] / N, Q[4] / N], (8, 1)))  # as printed
    hinge = flow[modes == "hinge"]
    np.testing.assert_allclose(np.sort(hinge[:, 3]), [-1 / L2, 0, 0, 1 / L2])
    np.testing.assert_allclose(hinge[:, 2], 1)


def test_point_of_action_without_normal_force_is_bounded():
    joint, interface = PAPER, lb.joints.interface(RECTANGLE, None)
    for Q in ((0, 0, force, 5, -3, 0) for force in (0.0, -1e-12, -1.0)):
        flow = joint.flow_directions(interface, Q)
        turning = flow[26:34] / flow[26:34, 5:]
        assert (abs(turning[:, :2]) <= [L2 + 1e-12, L1 + 1e-12]).all()


@pytest.mark.parametrize("name", ["paper", "exact"])
def test_associated_flow_is_the_gradient_by_finite_differences(name):
    joint, interface = SLIPS[name], lb.joints.interface(RECTANGLE, None)

    def functions(Q):
        values = yield_functions(Q, None if name == "paper" else np.hypot)
        return np.array([values["slip"], values["slip-twist"], values["moment-twist"]])

    plain = lb.OrdunaLourenco(MU, slip=joint.slip)
    for Q in states(10):
        flow = plain.flow_directions(interface, Q, dilatancy=MU)
        gradient = finite_differences(functions, Q)
        for row in gradient:  # the active one of each mode is among the rows, up to its length
            parallel = flow @ row / np.linalg.norm(flow, axis=1) / np.linalg.norm(row)
            assert parallel.max() == pytest.approx(1, abs=1e-9)


def test_dilatancy_is_between_zero_and_friction():
    joint, interface = PAPER, lb.joints.interface(RECTANGLE, None)
    Q = states(1)[0]
    none, half, full = (joint.flow_directions(interface, Q, d) for d in (0.0, MU / 2, MU))
    np.testing.assert_allclose(half, (none + full) / 2, atol=1e-12)
    np.testing.assert_allclose(full, -joint.yield_rows(RECTANGLE[None]).F[0], atol=1e-12)
    np.testing.assert_allclose(half[2:10, 2], MU / 2)  # slip opens by the tangent
    for dilatancy in (-0.1, MU + 0.01, np.nan):
        with pytest.raises(
            lb.ModelError, match=r"dilatancy is .* expected 0 to the least friction coefficient, 0.7"
        ):
            joint.flow_directions(interface, Q, dilatancy)

"""Every residual of the checker has the size that its definition says, where all is known in closed form.

A block of weight W, half as high as wide, is pushed by alpha W and slides at alpha = mu. What acts on it,
its measure, is W + alpha W; the live load does the work 1, which is worth alpha. Forces are over W, rates
and multipliers over 1 / W.
"""

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.evidence.claim import Claim
from limitblocks.problem import ASSOCIATED

MU, A, W, STRENGTH = 0.25, 1.0, 80e3, 100e3  # half side m, N, Pa
TORSION = A * (np.sqrt(2.0) + np.log1p(np.sqrt(2.0))) / 3.0  # of a square under uniform pressure, over mu W
RESTING, SLIDING = (0.0, 0.0, -1.0, 0.0, 0.0, 0.0), (MU, 0.0, -1.0, 0.0, MU * A / 2, 0.0)
PLANES, CONES, POINTS = (lb.OrdunaLourenco(MU, slip="paper"), lb.OrdunaLourenco(MU), lb.PointContact(MU))
CRUSHING = lb.OrdunaLourenco(MU, compressive_strength=STRENGTH)


def judged(joint, *, base=SLIDING, rates=(1.0, 0.0, 0.0), rows=None, dead=RESTING, points=None, **given):
    """Residuals of a claim by its forces at the base, the block's velocity, and multipliers of rows."""
    model = lb.structures.block(joint, width=2 * A, depth=2 * A, height=A, unit_weight=W / (4 * A**3))
    p = model.problem
    y, u = np.zeros(len(p.g)), np.zeros((2, 6))
    for (mode, of_mode), value in (rows or {}).items():
        y[np.flatnonzero([one == mode for one in p.row_mode])[of_mode]] = value / W
    u[model.free, :3] = np.divide(rates, W)
    dead = p.resultants.T @ (np.array(dead) * W) / (4 if points is not None else 1)
    x = None if points is None else W * np.ravel(points)
    claim = Claim(MU, W * np.array([base]), u, y, generalised_stresses=x, dead_load_stresses=dead, **given)
    return lb.check_mcp(model, claim).residuals


SLIP = {("slip", 0): 1.0, ("slip", 1): -1.0}  # of the cone: its head, and against V1


def test_the_closed_form_has_no_residual():
    assert judged(CONES, rows=SLIP).worst.value < 1e-15


@pytest.mark.parametrize(
    ("joint", "base", "violation"),
    [
        pytest.param(PLANES, (1.2 * MU, 0, -1, 0, 0, 0), 0.2 * MU, id="slip, plane"),
        pytest.param(CONES, (0.6 * 1.2 * MU, 0.8 * 1.2 * MU, -1, 0, 0, 0), 0.2 * MU, id="slip, cone"),
        pytest.param(CONES, (0, 0, -1, 0, 0, 1.2 * MU * TORSION), 0.2 * MU, id="twist"),
        pytest.param(PLANES, (MU, 0, -1, 0, 0, MU * TORSION), 0.7 * MU, id="slip-twist, plane"),
        pytest.param(CONES, (0.6 * MU, -0.8 * MU, -1, 0, 0, -MU * TORSION), 0.7 * MU, id="slip-twist, cone"),
        pytest.param(CONES, (0, 0, -1, 0.9 * A, -0.9 * A, 0.5 * MU * A), 0.2 * MU, id="moment-twist"),
        pytest.param(CONES, (0, 0, -1, 0, 1.2 * A, 0), 0.2, id="hinge"),
        pytest.param(CRUSHING, (0, 0, -1, 0, A, 0), None, id="crush"),
    ],
)
def test_yield_is_the_violation_over_what_acts_on_the_block(joint, base, violation):
    """Eqs (23) to (30), (36) and (39): a row's violation is a force."""
    if violation is None:  # s = 0 in ||(U - s, 2 N sqrt(U / a))|| <= U + s, a = A fcef: here U is 2^16 N
        unit, a = 2.0**16, 4 * A**2 * STRENGTH
        violation = (np.hypot(unit, 2.0 * W * np.sqrt(unit / a)) - unit) / W
    assert judged(joint, base=base, rows=SLIP)["yield"] == pytest.approx(violation / (1 + MU), rel=1e-12)


def test_yield_of_points_is_that_of_the_worst():
    points = [(-MU / 4, 0.0, -0.25), (1.2 * MU / 4, 0.0, -0.25), (0.0, 0.0, -0.25), (0.0, 0.0, -0.25)]
    base = lb.structures.block(POINTS, width=2 * A, depth=2 * A, height=A).problem.resultants @ np.ravel(
        points
    )
    found = judged(POINTS, base=base, points=points)
    assert found["yield"] == pytest.approx(0.2 * MU / 4 / (1 + MU), rel=1e-12)
    points[1] = (0.0, 0.0, 0.25)  # pulls: its opening row lacks N, its cone mu N
    base = lb.structures.block(POINTS, width=2 * A, depth=2 * A, height=A).problem.resultants @ np.ravel(
        points
    )
    assert judged(POINTS, base=base, points=points)["yield"] == pytest.approx(0.25 / (1 + MU), rel=1e-12)


@pytest.mark.parametrize(
    ("base", "unbalanced"),
    [((1.04 * MU, 0, -1, 0, MU * A / 2, 0), 0.04 * MU), ((MU, 0, -0.96, 0, MU * A / 2, 0), 0.04)],
)
def test_equilibrium_is_the_unbalanced_force_over_what_acts_on_the_block(base, unbalanced):
    assert judged(CONES, base=base, rows=SLIP)["equilibrium"] == pytest.approx(unbalanced / (1 + MU))


def test_flow_is_what_the_force_does_on_the_gap_over_the_power_of_the_live_load():
    """It rises by 0.03 where it slides by 1."""
    assert judged(CONES, rates=(1, 0, 0.03), rows=SLIP)["flow"] == pytest.approx(0.03 * (1 + MU) / MU)


def test_normalisation_is_the_work_of_the_live_load_less_one():
    assert judged(CONES, rates=(0.93, 0, 0), rows=SLIP)["normalisation"] == pytest.approx(0.07)


@pytest.mark.parametrize(
    "rows",
    [{("hinge", 2): -0.03}, {("slip-twist", 3): 0.04, ("slip-twist", 4): 0.0, ("slip-twist", 5): 0.07}],
    ids=["plane", "cone"],
)
def test_multipliers_outside_their_cone_are_worth_their_force(rows):
    """A multiplier of -0.03; one with 0.07 across to 0.04 along its cone's axis."""
    assert judged(CONES, rows=SLIP | rows)["multipliers"] == pytest.approx(0.03 * (1 + MU) / MU)


@pytest.mark.parametrize(
    ("rows", "product"),
    [({("twist", 0): 0.03}, MU), ({("slip-twist", 0): 0.03}, MU * np.hypot(1.3, 1.0))],
    ids=["plane", "cone"],
)
def test_complementarity_is_yield_function_times_multiplier(rows, product):
    """Slack mu at a plane of twist; (1.3 mu, mu, 0) o (y, 0, 0) at a cone of slip-twist, Eqs (27) to (29)."""
    assert judged(CONES, rows=SLIP | rows)["complementarity"] == pytest.approx(0.03 * product / MU)


def test_dissipation_is_the_power_that_an_interface_gives():
    """Slip along the shear force, not against it: it gives the power mu 1, all that the live load has."""
    assert judged(CONES, rows={("slip", 0): 1.0, ("slip", 1): 0.4})["dissipation"] == pytest.approx(0.4)


@pytest.mark.parametrize(
    ("dead", "value"), [((0, 0, -1.03, 0, 0, 0), 0.03), ((0, 0, -1, 0, 0, 1.2 * MU * TORSION), None)]
)
def test_standing_is_the_worst_static_residual_of_the_dead_loads(dead, value):
    """Its measure is W, or of the torsion that is out of balance, its share in A."""
    expected = 1.2 * MU * TORSION / A if value is None else value
    assert judged(CONES, rows=SLIP, dead=dead)["standing"] == pytest.approx(expected)


def test_power_and_gap_of_bounds_are_over_the_load_factor():
    """Rising by mu as it slides, W does the power mu; a tenth more is no upper bound that it proves."""
    associated = {"rates": (1, 0, MU), "rows": SLIP, "dilatancy": ASSOCIATED}
    found = judged(CONES, **associated, upper=1.1 * MU)
    assert (found["power"], found["gap"]) == (pytest.approx(0.1), pytest.approx(0.1))
    assert judged(CONES, **associated, upper=MU).worst.value < 1e-15


def test_violations_of_bounds_are_worth_what_they_do_on_the_other_state():
    """Rates 0.07 too small: V and N do mu each on what the slip lacks, the live load mu on its own lack."""
    slow = {"rates": (0.93, 0, 0.93 * MU), "rows": SLIP, "dilatancy": ASSOCIATED}
    assert judged(CONES, **slow, upper=MU)["worth"] == pytest.approx(3 * 0.07)

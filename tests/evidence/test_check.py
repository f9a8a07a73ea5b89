"""The MCP checker on hand-made solutions: a sliding block, true and mutilated in every way."""

import json
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.evidence.check import check_mcp
from limitblocks.evidence.claim import Claim
from limitblocks.evidence.mechanism import find_mechanism
from limitblocks.problem import Flow

MU, B, H, DEPTH = 0.3, 2.0, 1.0, 1.5
WEIGHT = 20e3 * B * H * DEPTH


@pytest.fixture(scope="module", params=["paper", "exact"])
def model(request):
    """A block that slides at a load factor equal to the friction coefficient, mu < b / h."""
    joint = lb.OrdunaLourenco(MU, slip=request.param)
    return lb.structures.block(joint, width=B, height=H, depth=DEPTH)


@pytest.fixture(scope="module")
def claim(model):
    """The exact solution: V = mu W under N = -W, overturning moment mu W h / 2, sliding along X."""
    interface = model.interfaces[0]
    at = interface.centroid - next(b for b in model.blocks if b.name == interface.block_j).centroid
    # Q acts from block i on block j: it balances gravity and the push at the centroid of block j.
    force = np.array([-MU * WEIGHT, 0.0, WEIGHT])
    sign = -1.0  # C = T (u_j - u_i), F = C^T Q: the loads on j equal Q on j in the axes of the interface
    Q = np.concatenate([interface.axes @ (sign * force), interface.axes @ (sign * -np.cross(at, force))])
    rates = np.zeros((2, 6))
    rates[model.free, 0] = 1.0 / WEIGHT
    return Claim(MU, Q[None], displacement_rates=rates, digest=model.digest)


def failing(model, claim):
    check = check_mcp(model, claim)
    return {entry.name for entry in check.residuals.above(check.tolerance)}


def test_the_closed_form_passes(model, claim):
    check = check_mcp(model, claim)
    assert check.passed
    check.require()


def test_bounds_are_judged_by_their_own_tolerance():
    """A block that rocks at b / h, its upper bound raised by 1e-7: within 1e-6, not within 1e-8."""
    rocking = lb.structures.block(lb.PointContact(0.6), width=0.2, height=1.0)
    bounds = lb.bounds(rocking)
    wide = replace(bounds, upper=bounds.upper * (1 + 1e-7), proof=replace(bounds.proof, static="not asked"))
    check = check_mcp(rocking, wide)
    assert check.passed
    assert 0.9e-7 < check.worst.value < 1.1e-7
    assert check.tolerance == check.usual == 1e-6
    assert not check_mcp(rocking, wide, tolerance=1e-8).passed
    assert check_mcp(rocking, lb.nonassociated(rocking)).tolerance == 1e-8


def test_a_mechanism_is_found_for_the_stress_state_alone(model, claim):
    check = check_mcp(model, replace(claim, displacement_rates=None))
    assert check.mechanism_found
    assert check.passed


def test_no_mechanism_is_found_for_stresses_that_are_no_numbers(model):
    problem = model.problem
    u, y = find_mechanism(Flow(problem), np.full(problem.C.shape[0], np.nan))
    assert u.shape == problem.live.shape
    assert y.shape == problem.g.shape
    assert np.isnan(u).all()
    assert np.isnan(y).all()


@pytest.mark.parametrize(
    ("change", "name"),
    [
        (lambda c: replace(c, load_factor=1.01 * c.load_factor), "equilibrium"),
        (lambda c: replace(c, stress_resultants=1.01 * c.stress_resultants), "equilibrium"),
        (lambda c: replace(c, stress_resultants=-c.stress_resultants), "yield"),
        (lambda c: replace(c, displacement_rates=-c.displacement_rates), "normalisation"),
        (lambda c: replace(c, displacement_rates=1.01 * c.displacement_rates), "normalisation"),
        (lambda c: replace(c, displacement_rates=0.0 * c.displacement_rates), "normalisation"),
        (lambda c: replace(c, load_factor=-c.load_factor), "equilibrium"),
    ],
)
def test_each_mutilation_is_named(model, claim, change, name):
    assert name in failing(model, change(claim))


def test_an_associated_mechanism_is_no_zero_dilatancy_solution(model, claim):
    lifting = claim.displacement_rates.copy()
    lifting[:, 2] = MU * lifting[:, 0]  # rises as it slides, as the associated flow wants
    associated = replace(claim, displacement_rates=lifting)
    assert failing(model, associated) == {"flow"}
    judged = check_mcp(model, associated).residuals.to_dict()
    both = replace(associated, upper=MU)  # an upper bound is of associated flow alone
    assert check_mcp(model, both).residuals.to_dict() == judged
    assert check_mcp(model, replace(associated, dilatancy=MU)).passed


def test_a_yield_violation_of_one_per_cent_is_named(model, claim):
    Q = claim.stress_resultants.copy()
    Q[0, :2] *= 1.01
    assert "yield" in failing(model, replace(claim, load_factor=1.01 * MU, stress_resultants=Q))


def test_a_multiplier_of_the_wrong_sign_is_named(model, claim):
    bounds = lb.bounds(model)
    result = Claim(
        bounds.upper,
        bounds.stress_resultants,
        bounds.displacement_rates,
        bounds.flow_multipliers,
        bounds.generalised_stresses,
        dilatancy=MU,
    )
    assert failing(model, result) == set()
    assert "multipliers" in failing(model, replace(result, flow_multipliers=-result.flow_multipliers))


def test_a_result_of_another_model_is_refused(model, claim):
    other = lb.structures.block(lb.OrdunaLourenco(MU + 1e-6), width=B, height=H, depth=DEPTH)
    with pytest.raises(lb.ModelError, match="belongs to model"):
        check_mcp(other, claim)
    perturbed = lb.structures.block(lb.OrdunaLourenco(MU), width=B, height=1.001 * H, depth=DEPTH)
    assert "equilibrium" in failing(perturbed, replace(claim, digest=""))


@pytest.mark.parametrize("name", ["stress_resultants", "displacement_rates", "flow_multipliers"])
def test_a_wrong_shape_is_an_error_that_names_it(model, claim, name):
    with pytest.raises(lb.ModelError, match=name):
        check_mcp(model, replace(claim, **{name: np.zeros((7, 6))}))


def test_a_moving_support_is_an_error(model, claim):
    moving = claim.displacement_rates + 1.0
    with pytest.raises(lb.ModelError, match="move the support"):
        check_mcp(model, replace(claim, displacement_rates=moving))


def test_a_failed_check_raises_and_names_every_residual(model, claim):
    with pytest.raises(lb.errors.CheckFailed, match="equilibrium"):
        check_mcp(model, replace(claim, load_factor=0.0)).require()


def test_the_checker_runs_without_the_solver_stack():
    code = (
        "import sys; sys.modules.update(cvxpy=None, clarabel=None, osqp=None)\n"
        "import types; package = types.ModuleType('limitblocks'); package.__path__ = [sys.argv[1]]\n"
        "sys.modules['limitblocks'] = package\n"
        "import limitblocks.evidence.check"
    )
    folder = lb.__path__[0]
    subprocess.run([sys.executable, "-c", code, folder], check=True)


@pytest.mark.parametrize(
    ("factors", "said"),
    [
        ((1.0,) * 6, None),
        ((1e-3,) * 6, "1000 times the stress resultants would be in equilibrium: another unit of force?"),
        (
            (-1.0,) * 6,
            "-1 times the stress resultants would be in equilibrium: N is negative in compression?",
        ),
        ((1.0, 1.0, -1.0, 1.0, 1.0, 1.0), "no interface is compressed: N is negative in compression"),
        ((0.9, 1.0, 1.0, 1.0, 1.0, 1.0), None),  # wrong, and by no convention
    ],
)
def test_another_unit_or_sign_than_ours_is_asked_about(model, claim, factors, said):
    Q = claim.stress_resultants * np.array(factors)
    remarks = check_mcp(model, replace(claim, stress_resultants=Q)).remarks
    asked = [one for one in remarks if "equilibrium" in one or "compressed" in one]
    assert [one.startswith(said) for one in asked] == [True] if said else not asked


def test_an_interface_named_the_other_way_round_is_told_so(model, claim, tmp_path):
    interface = model.interfaces[0]
    here, there = interface.block_i, interface.block_j
    forces = {f"{there}|{here}": claim.stress_resultants[0].tolist()}
    file = tmp_path / "claim.json"
    file.write_text(json.dumps({"load_factor": MU, "stress_resultants": forces}))
    with pytest.raises(lb.ModelError, match=rf"but '{here}\|{there}': forces on '{here}', n out of it"):
        lb.read_result(file, model)

"""Bounds as theorems: they contain exact load factors, falsified claims are refused."""

from dataclasses import replace

import numpy as np
import pytest
from lintels import JOINTS, lintel
from stones import model_of

import limitblocks as lb
from limitblocks import structures
from limitblocks.analysis.certified import RESERVE
from limitblocks.evidence.proof import Proof, Prover, acting_at, proof_of
from limitblocks.problem import State


@pytest.fixture(scope="module", params=JOINTS)
def model(request):
    return lintel(request.param)


@pytest.fixture(scope="module")
def pair(model):
    return lb.bounds(model)


def state_of(model, pair):
    rates = pair.displacement_rates[model.free].ravel()
    return State(pair.lower, pair.generalised_stresses, rates, pair.flow_multipliers)


def test_bounds_are_proven_to_1e_8(model, pair):
    assert pair.proven
    assert pair.lower < pair.upper
    assert pair.upper - pair.lower <= 1e-8 * pair.upper
    proof = proof_of(model.problem, state_of(model, pair), pair.dead_load_stresses)
    assert proof.complete
    assert proof.lower == pair.lower
    assert proof.upper < pair.upper  # room for a machine that sums in another order
    assert proof_of(model.problem, state_of(model, pair), pair.dead_load_stresses, RESERVE).complete
    check = lb.check_mcp(model, pair, tolerance=1e-6)
    assert check.passed
    (told,) = [entry.meaning for entry in check.residuals.entries if entry.name == "proof"]
    assert f"proven are {proof.lower:.17g} and {proof.upper:.17g}" in told


def test_units_of_force_change_no_digit_of_a_proof():
    """Powers of two, block by block: the room at a joint is measured by what acts there."""
    model = structures.wall(lb.OrdunaLourenco(0.6), length=2.0, courses=6)
    pair, problem = lb.bounds(model), model.problem
    shift = 2.0 ** np.random.default_rng(1).integers(-9, 10, len(problem.blocks))
    given = state_of(model, pair), pair.dead_load_stresses
    other = problem.measured(problem.units.block_force * shift)
    assert proof_of(other, *given, reserve=1.5) == proof_of(problem, *given, reserve=1.5)
    ways = [spanning_tree_of(p, *given) for p in (problem, other)]
    np.testing.assert_array_equal(*ways)


def spanning_tree_of(problem, si, dead):
    acting = acting_at(problem, problem.dimensionless(si))
    return Prover(problem, dead / problem.stress_units, acting).static.tree.interface


@pytest.mark.parametrize("mu", [0.125, 0.5, 0.625])
@pytest.mark.parametrize("joint", [lb.PointContact, lb.OrdunaLourenco])
def test_interval_contains_an_exact_load_factor(joint, mu):
    """A cube on a floor, all numbers exact in binary: it slides at exactly mu, Coulomb."""
    blocks = [
        lb.Block.box("floor", (3.0, 3.0, 1.0), (0.5, 0.5, -0.5), 16.0),
        lb.Block.box("cube", (1.0, 1.0, 1.0), (0.5, 0.5, 0.5), 16.0),
    ]
    model = model_of(blocks, ["floor"], joint(mu))
    found = lb.bounds(model)
    assert found.proven
    assert found.lower <= mu <= found.upper
    assert found.upper - found.lower < 1e-10


def one_stress_more(x, share):
    nudged = x.copy()
    nudged[int(np.abs(x).argmax())] *= 1.0 + share
    return nudged


def falsified(pair, model):
    """False claims of proven bounds, each in one respect."""
    x, u, y = pair.generalised_stresses, pair.displacement_rates, pair.flow_multipliers
    Q, units = model.problem.resultants, model.problem.units.resultants

    def beyond_yield(share):
        """Stresses whose F x + g the multipliers say is out of K, by the largest part in one."""
        push = model.problem.F.T @ (y / model.problem.multiplier_units)
        k = int(np.abs(push * x / model.problem.stress_units).argmax())
        beyond = x.copy()
        beyond[k] -= share * np.abs(x[k]) * np.sign(push[k])
        return beyond

    def stresses(x):
        own = Q @ (x / model.problem.stress_units) * units
        return {"generalised_stresses": x, "stress_resultants": own.reshape(-1, 6)}

    moving = int(np.abs(u).max(axis=1).argmax())
    one = np.zeros_like(u)
    one[moving, 2] = 1e-4 * np.abs(u).max()
    most = int(np.abs(y).argmax())
    less = y.copy()
    less[most] *= -1.0
    width = pair.upper - pair.lower
    wide = {"lower": pair.upper + width, "upper": pair.upper + 2 * width}
    return {
        "a greater lower bound": {"lower": pair.upper + width},
        "a lower bound above the truth by 1e-7": {"lower": pair.lower * (1.0 + 1e-7)},
        "a lesser upper bound": {"upper": pair.lower - width},
        "the bounds exchanged": {"lower": pair.upper, "upper": pair.lower},
        "an interval above": wide,
        "an interval below": {"lower": pair.lower - 3 * width, "upper": pair.lower - 2 * width},
        "one stress beyond yield": stresses(beyond_yield(1e-2)),
        "all stresses more": stresses(x * (1.0 + 1e-4)),
        "one rate more": {"displacement_rates": u + one},
        "one multiplier reversed": {"flow_multipliers": less},
        "all multipliers less": {"flow_multipliers": y * (1.0 - 1e-4)},
        "no multipliers": {"flow_multipliers": 0.0 * y},
        "the mechanism reversed": {"displacement_rates": -u, "flow_multipliers": -y},
        "half the mechanism": {
            "displacement_rates": u / 2,
            "flow_multipliers": y / 2,
            "upper": pair.upper / 2,
        },
    }


def test_falsified_proofs_are_refused(model, pair):
    for word, change in falsified(pair, model).items():
        claim = replace(pair, **change)
        assert claim.proven  # it still says so
        residuals = lb.check_mcp(model, claim, tolerance=1e-6).residuals
        assert residuals["proof"] == np.inf, word


def test_one_stress_a_little_more_is_refused_even_where_the_interval_is_true(model, pair):
    """Joints with room carry an imbalance of 1e-4 to the supports, so that exact states remain near."""
    p, x = model.problem, pair.generalised_stresses
    nudged = one_stress_more(x, 1e-4)
    own = (p.resultants @ (nudged / p.stress_units) * p.units.resultants).reshape(-1, 6)
    claim = replace(pair, generalised_stresses=nudged, stress_resultants=own)
    check = lb.check_mcp(model, claim, tolerance=1e-6)
    assert not check.passed
    assert check.residuals["equilibrium"] > 1e-5


def wedged(joint):
    """A stone between two walls."""
    blocks = [
        lb.Block.box("left", (1.0, 1.0, 1.0), (-0.5, 0.5, 0.5), 2e4),
        lb.Block.box("stone", (1.0, 1.0, 1.0), (0.5, 0.5, 0.5), 2e4),
        lb.Block.box("right", (1.0, 1.0, 1.0), (1.5, 0.5, 0.5), 2e4),
        lb.Block.box("floor", (1.0, 1.0, 1.0), (0.5, 0.5, -0.5), 2e4),
    ]
    return model_of(blocks, ["left", "right", "floor"], joint, (0.0, 0.0, -1.0))


def test_opening_mechanism_exists_where_nothing_can_be_wedged():
    from limitblocks.analysis.scales import scaled
    from limitblocks.analysis.splitting import Splitting

    def opens(model):
        p = scaled(model.problem)
        return Splitting(p).mechanism(p.cones.identity) is not None

    assert not opens(wedged(lb.OrdunaLourenco(0.6)))  # pressed between the walls
    assert not opens(wedged(lb.PointContact(0.6)))
    assert opens(wedged(lb.OrdunaLourenco(0.6, compressive_strength=1e6)))  # crushing pays for any motion
    assert opens(structures.ferris_tin_loi_wall(1, lb.PointContact(0.6)))


def test_joints_that_lack_nothing_are_opened_too():
    """Most joints of a lintel need no room: opened by nothing they have none for rounding errors."""
    assert lb.bounds(lb.structures.eccentric_lintel(lb.OrdunaLourenco(0.6))).proven


def test_what_is_not_proven_says_why():
    """Friction 0 on the floor: no stress state is strictly within yield."""
    blocks = [
        lb.Block.box("floor", (3.0, 3.0, 1.0), (0.5, 0.5, -0.5), 16.0),
        lb.Block.box("cube", (1.0, 1.0, 1.0), (0.5, 0.5, 0.5), 16.0),
    ]
    touching = lb.find_interfaces(blocks, lb.PointContact(0.0))
    push = lb.mass_proportional((1.0, 0.0, 0.0))
    model = lb.Model(blocks, ["floor"], touching, lb.self_weight(), push)
    found = lb.bounds(model)
    assert not found.proven
    assert abs(found.lower) < 1e-6
    assert "no lower bound proven" in found.proof.static
    assert "cube" in found.proof.static
    assert lb.check_mcp(
        lb.Model(blocks, ["floor"], touching, lb.self_weight(), push), found, tolerance=1e-6
    ).passed


def test_half_a_proof_is_none():
    proof = Proof(1.0, np.inf, "", "no upper bound proven")
    assert not proof.complete
    assert proof.width == np.inf
    assert proof.to_dict()["upper"] is None
    assert "no upper bound proven" in str(proof)

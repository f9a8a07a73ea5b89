"""Open joints that cohesion lets carry shear: forces that rounding leaves normal to them are no strength."""

from dataclasses import replace

import numpy as np
import pytest
from images import image
from true_claims import DEPTH, MU, B, H, changed, determinate, error_of, moving, state_of

import limitblocks as lb
from limitblocks import structures
from limitblocks.analysis.nonassociated.start import state_of as solution_of
from limitblocks.evidence.backward_error import backward_error
from limitblocks.problem import Flow

STRENGTH = 8e3  # Pa
PUSHED = {
    "lintel": structures.eccentric_lintel(lb.OrdunaLourenco(0.21, cohesion=1.2e3)),
    "loaded lintel": structures.eccentric_lintel(
        lb.OrdunaLourenco(0.86, cohesion=1.4e3), eccentricity=0.2, direction=(0.5, 0.5, -0.7)
    ),
    "corner": structures.corner(
        lb.OrdunaLourenco(0.68, cohesion=49e3),
        length=1.6,
        return_length=1.6,
        courses=4,
        direction=(0.5, 0.5, -0.7),
    ),
    "tower": structures.tower(
        lb.OrdunaLourenco(0.6, cohesion=22.5e3), length=1.6, width=1.6, courses=4, direction=(-1.0, 0.0, 0.0)
    ),
    "buttressed wall": structures.buttressed_wall(
        lb.OrdunaLourenco(0.3, cohesion=10e3),
        length=2.4,
        courses=4,
        buttress_length=0.8,
        direction=(0.0, -1.0, 0.0),
    ),
}


@pytest.mark.parametrize("name", PUSHED)
def test_answers_with_cohesion_are_exact_for_a_model_nearby(name):
    found = lb.nonassociated(PUSHED[name])
    assert found.converged
    assert found.backward_error.value <= 1e-8
    assert not any("only for a model changed" in remark for remark in found.remarks)
    claim = lb.check_mcp(PUSHED[name], found)
    assert claim.passed
    assert claim.backward_error.value <= 1e-8


@pytest.mark.parametrize("shift", [(0.0, 0.0, 0.0), (1e3, -7e2, 3e2), (5e5, 4.6e6, 1e2)])
def test_wherever_a_structure_stands_a_joint_torn_off_asks_for_no_other_strength(shift):
    """One at its tensile strength hinges about all edges, and none has a normal force to scale."""
    joint = lb.OrdunaLourenco(0.6, cohesion=1e3, tensile_strength=1e3)
    corner = structures.corner(joint, length=2.4, return_length=2.4, courses=5)
    model = image(corner, shift=shift)
    found = lb.nonassociated(model)
    assert found.load_factor == pytest.approx(lb.nonassociated(corner).load_factor, rel=1e-4)
    assert found.backward_error.value <= 1e-8
    assert found.remarks == ()
    assert lb.check_mcp(model, found).backward_error.value <= 1e-8


@pytest.mark.parametrize("share", [1.0, 1 + 1e-4, 0.99, 1.2])
def test_a_block_that_slides_at_another_strength(share):
    """Friction and cohesion change together: (mu N + A c)' / (mu N + A c) - 1."""
    model = structures.block(lb.OrdunaLourenco(MU, cohesion=STRENGTH), width=B, height=H, depth=DEPTH)
    exact = MU + STRENGTH * B * DEPTH / model.free_blocks[0].weight
    truth = determinate(model, exact, moving(model, block_1=np.array([1.0, 0, 0, 0, 0, 0])))
    p, state = model.problem, state_of(model, truth)
    a = share * state.load_factor
    x = np.linalg.solve(p.C.T.toarray(), p.dead + a * p.live)
    error = error_of(model, changed(model, truth, load_factor=a, x=x, u=state.u, y=state.y))
    assert error.value == pytest.approx(abs(share - 1), rel=1e-6, abs=1e-12)


@pytest.mark.parametrize("size", [1e-6, 1e-3])
def test_a_force_across_an_open_joint_is_told_where_it_is_more_than_rounding(size):
    """Under loads that balance it, a normal force of `size` keeps a joint that opens from yield."""
    model = PUSHED["lintel"]
    problem = model.problem
    state = solution_of(model, problem, lb.nonassociated(model))
    normal = problem.resultants[2::6].indices
    opens = (np.abs(state.x[normal]) < 1e-9) & ((problem.C @ state.u)[normal] > 1e-3)
    x = state.x.copy()
    x[normal[np.flatnonzero(opens)[0]]] -= size
    loaded = replace(problem, dead=problem.balance @ x - state.load_factor * problem.live)
    assert 0.1 * size < backward_error(Flow(loaded), replace(state, x=x)).value < 10.0 * size

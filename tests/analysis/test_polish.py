"""The polish: rounding from rough states, any flow rule, and never a worse state than the one given."""

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.analysis import polish as polishing
from limitblocks.analysis.nonassociated import path as paths
from limitblocks.analysis.nonassociated.least_norm import least_state
from limitblocks.analysis.nonassociated.tracking import track
from limitblocks.analysis.polish import Kind, classified, defect, polish
from limitblocks.problem import ASSOCIATED, Cones, Flow, State, Turning

JOINTS = [lb.OrdunaLourenco(0.6), lb.OrdunaLourenco(0.6, compressive_strength=3e5), lb.PointContact(0.6)]
FLOWS = {
    "associated": {"dilatancy": ASSOCIATED},
    "zero dilatancy": {},
    "some dilatancy": {"dilatancy": 0.2},
    "table 5": {"turning": Turning.PRESSURE},
}


def noisy(state, size):
    """The state with every number off by up to `size`, as a solver leaves it."""
    random = np.random.default_rng(0)
    off = [v + size * random.uniform(-1.0, 1.0, v.shape) for v in (state.x, state.u, state.y)]
    return State(state.load_factor + size, *off)


@pytest.mark.parametrize("joint", JOINTS, ids=repr)
@pytest.mark.parametrize("flow", FLOWS)
def test_a_rough_state_is_polished_to_rounding(joint, flow, monkeypatch):
    # pivots may end where slack and multiplier of a row are both zero; the polish needs one that is not
    monkeypatch.setattr(paths, "pivoted", lambda flow, state, **_: state)
    monkeypatch.setattr(paths, "TRIED", 1e-3)
    problem = lb.structures.wall(joint, length=0.8, courses=3, direction=(0.8, 0.6, 0)).problem
    rule = Flow(problem, **FLOWS[flow])
    solution, path = track(rule, least_state(problem, problem.compliance).x, problem.compliance)
    assert path.residual <= 1e-10
    rough = noisy(solution, 1e-5)
    assert defect(rule, rough) > 1e-6
    assert defect(rule, polish(rule, rough)) <= 1e-10


@pytest.mark.parametrize("joint", [JOINTS[0], JOINTS[2]], ids=repr)
def test_where_it_is_plain_which_planes_yield_one_step_ends_at_rounding(joint, monkeypatch):
    """The equations are linear then; without refinement the proximal term leaves a part of the first step."""
    problem = lb.structures.arch(joint, radius=5.0, thickness=1.0, voussoirs=15).problem
    flow, made = Flow(problem), []
    solution, _ = track(flow, least_state(problem, problem.compliance).x, problem.compliance)
    factors = polishing.factors_in_order
    monkeypatch.setattr(polishing, "factors_in_order", lambda *given: (made.append(1), factors(*given))[1])
    assert defect(flow, polish(flow, noisy(solution, 1e-6), until=1e-13)) <= 1e-13
    assert len(made) == 1


def test_the_polish_returns_what_it_cannot_better():
    problem = lb.structures.wall(JOINTS[0], length=0.8, courses=3).problem
    flow, random = Flow(problem), np.random.default_rng(1)
    far = State(1.0, *(random.normal(size=n) for n in (*problem.C.shape, problem.cones.height)))
    assert defect(flow, polish(flow, far)) <= defect(flow, far)


def test_a_solution_stays_as_it_is():
    problem = lb.structures.block(lb.OrdunaLourenco(0.4), width=1.0, height=1.0).problem
    flow = Flow(problem)
    state, _ = track(flow, least_state(problem, problem.compliance).x, problem.compliance)
    assert polish(flow, state, until=1e-9) is state


def test_rows_and_cones_are_read_off_eigenvalue_by_eigenvalue():
    cones = Cones(2, ((3, 3),))
    s = np.array([1.0, 1e-9, 5.0, 3.0, 0.0, 1.0, 1.0, 0.0, 1e-9, 0.0, 0.0])
    y = np.array([1e-9, 1.0, 1e-9, 0.0, 0.0, 2.0, -2.0, 0.0, 5.0, 3.0, 0.0])
    found = classified(cones, s, y)
    assert list(found.kind) == [Kind.FREE, Kind.TIGHT, Kind.FREE, Kind.BOUNDARY, Kind.TIGHT]
    assert list(found.rows) == [1, 5, 6, 7, 8, 9, 10]
    assert list(found.on_boundary) == [5, 6, 7]

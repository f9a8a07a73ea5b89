"""The closing step: complementary pivots close what the polish alone leaves open, and harm nothing."""

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.analysis import pivot
from limitblocks.analysis.nonassociated import path
from limitblocks.analysis.nonassociated.least_norm import least_state
from limitblocks.analysis.nonassociated.means import MEANS
from limitblocks.analysis.nonassociated.tracking import track
from limitblocks.analysis.pivot import pivoted
from limitblocks.analysis.polish import defect, polish
from limitblocks.problem import Flow, State, Turning

CRUSHING = lb.OrdunaLourenco(0.6, compressive_strength=3e5)
LINTELS = [
    lb.structures.eccentric_lintel(joint, eccentricity=off, direction=(1.0, 0.0, 0.0))
    for joint in (lb.OrdunaLourenco(0.6), CRUSHING)
    for off in (0.05, 0.1, 0.15, 0.2)
]


def test_the_load_path_is_closed_early_where_it_is_not_plain_what_yields(monkeypatch):
    """Without pivots on the way paths go on until next to nothing is left of the barrier."""

    def points():
        found = [lb.nonassociated(one, means=MEANS[:1], confirm=False) for one in LINTELS]
        return sum(len(one.history) for one in found)

    with_them = points()
    monkeypatch.setattr(path, "pivoted", lambda flow, state, **_: state)
    assert with_them <= 0.6 * points()


@pytest.mark.parametrize("joint", [lb.OrdunaLourenco(0.6), CRUSHING, lb.PointContact(0.6)], ids=repr)
@pytest.mark.parametrize("about", Turning)
@pytest.mark.parametrize("dilatancy", [0.0, 0.2])
def test_a_state_off_a_solution_is_taken_to_one(joint, about, dilatancy):
    problem = lb.structures.wall(joint, length=0.8, courses=3, direction=(0.8, 0.6, 0)).problem
    flow = Flow(problem, dilatancy, about)
    solution, _ = track(flow, least_state(problem, problem.compliance).x, problem.compliance)
    random = np.random.default_rng(1)
    off = (v + 1e-5 * random.uniform(-1.0, 1.0, v.shape) for v in (solution.x, solution.u, solution.y))
    rough = State(solution.load_factor + 1e-5, *off)
    assert defect(flow, rough) > 1e-6
    assert defect(flow, pivoted(flow, rough)) <= 1e-8


def test_steps_close_without_newtons_method(monkeypatch):
    """The proximal term fades from step to step."""
    monkeypatch.setattr(pivot, "polished", lambda _, state, left, **__: (state, left))
    problem = lb.structures.wall(lb.PointContact(0.6), length=1.6, courses=4).problem
    flow = Flow(problem)
    solution, _ = track(flow, least_state(problem, problem.compliance).x, problem.compliance)
    random = np.random.default_rng(0)
    off = (v + 1e-3 * random.uniform(-1.0, 1.0, v.shape) for v in (solution.x, solution.u, solution.y))
    rough = State(solution.load_factor + 1e-3, *off)
    assert defect(flow, pivoted(flow, rough)) <= 1e-8


def test_a_block_that_slides_and_tips_at_once():
    """Friction 0.5 and half a width over half a height 0.5: both yield, one of them at rest."""
    problem = lb.structures.block(lb.PointContact(0.5), width=1.0, height=2.0).problem
    flow = Flow(problem)
    x0 = least_state(problem, problem.compliance).x
    early, _ = track(flow, x0, problem.compliance, budget=12)
    found = pivoted(flow, early)
    assert defect(flow, found) <= 1e-8
    assert abs(found.load_factor / problem.units.live - 0.5) < 1e-8


def test_what_it_cannot_better_it_returns():
    problem = lb.structures.wall(CRUSHING, length=0.8, courses=3).problem
    flow, random = Flow(problem), np.random.default_rng(1)
    far = State(1.0, *(random.normal(size=n) for n in (*problem.C.shape, problem.cones.height)))
    assert defect(flow, pivoted(flow, far)) <= defect(flow, far)


def test_nothing_is_done_where_too_many_rows_are_open():
    problem = lb.structures.wall(CRUSHING, length=0.8, courses=3).problem
    flow = Flow(problem)
    early, _ = track(flow, least_state(problem, problem.compliance).x, problem.compliance, budget=12)
    assert pivoted(flow, early, largest=0) is early


@pytest.mark.parametrize("number", [np.nan, np.inf, 1e300])
@pytest.mark.parametrize("part", ["x", "u", "y"])
@pytest.mark.parametrize("joint", [CRUSHING, lb.PointContact(0.6)], ids=repr)
def test_a_state_that_ran_away_stays_where_it_is(joint, part, number):
    problem = lb.structures.block(joint, width=1.0, height=2.0).problem
    flow = Flow(problem, turning=Turning.PRESSURE)
    state = State(0.5, *(np.ones(n) for n in (*problem.C.shape, problem.cones.height)))
    getattr(state, part)[1] = number
    assert pivoted(flow, state) is state
    assert np.isfinite(defect(flow, polish(flow, state))) or polish(flow, state) is state


@pytest.mark.parametrize("columns", [1, pivot.COLUMNS, 2 * pivot.COLUMNS + 1])
def test_as_many_columns_as_there_are_are_solved(columns):
    problem = lb.structures.wall(lb.PointContact(0.6), length=0.8, courses=3).problem
    x = least_state(problem, problem.compliance).x
    still = State(0.0, x, np.zeros(problem.C.shape[1]), np.zeros(len(problem.g)))
    linear = pivot._Linearised(Flow(problem), still, 1e-4)
    J, _ = linear._system
    right = np.random.default_rng(0).normal(size=(J.shape[0], columns))
    left = right - J @ linear._refined(right)
    assert np.abs(left).max() <= 1e-9

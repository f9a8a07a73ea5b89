"""Rounds of the fixed point that close paths which wind, and the ways of large models."""

import re
from dataclasses import replace

import numpy as np
import pytest
from paths import start

import limitblocks as lb
from limitblocks.analysis.nonassociated import closing, each_way, ways
from limitblocks.analysis.nonassociated.fixed_point import NearestStresses
from limitblocks.analysis.nonassociated.means import (
    LARGE_MEANS,
    LARGE_PLANAR_MEANS,
    LARGEST_MEANS,
    MEANS,
    REDUCED_MEANS,
    SOFTENING,
    SPATIAL_MEANS,
    Means,
)
from limitblocks.analysis.nonassociated.path_equations import Barrier
from limitblocks.analysis.nonassociated.start import bracket, load_scale, own_units, start_stresses
from limitblocks.analysis.polish import defect
from limitblocks.analysis.stability import dead_load_state
from limitblocks.problem import Flow, State
from tests.analysis.paths import follow


def corner():
    return lb.structures.corner(
        lb.OrdunaLourenco(0.6), length=2.4, return_length=2.4, courses=4, direction=(1.0, 0.0, 0.0)
    )


def test_rounds_close_a_path_that_was_stopped():
    """The state is off by the compliance left, by more than Newton's method can mend."""
    model = corner()
    problem = own_units(model, bracket(model))
    flow = Flow(problem, softening=SOFTENING)
    x0, scale = start_stresses(model, Flow(problem), problem.compliance, None), bracket(model).associated
    first = LARGE_MEANS[0]
    stopped = Means(first.barrier, first.seed, 60)
    power = load_scale(problem, scale) / len(problem.blocks)
    state, _ = follow(flow, x0, problem.compliance, means=[stopped], power=power)
    assert defect(flow, state) > 1e-3
    found, rounds = closing.closed(flow, NearestStresses(problem), state, 1e-8)
    assert defect(flow, found) <= 1e-8
    assert rounds < 20


@pytest.mark.parametrize(
    ("first", "factor", "rounds"), [(1.0, 0.5, 2), (1.0, 0.35, 41), (1.0, 0.1, 41), (1e-9, 0.9, 18)]
)
def test_rounds_go_on_where_the_gap_falls_fast_enough(first, factor, rounds, monkeypatch):
    """To .4 a round or within the tolerance, until that is rounding: .4^40 and 1e-9 .4^17, below 2.2e-16."""
    model = lb.structures.block(lb.PointContact(0.5), width=1.0, height=1.0)
    flow, gaps = Flow(model.problem), iter(first * factor**k for k in range(rounds))
    x = dead_load_state(model.problem)
    slack = model.problem.F @ x + model.problem.g
    nothing = np.zeros(model.problem.C.shape[1])

    class Still:
        def find(self, x, _):
            return 1.0, x

    monkeypatch.setattr(
        closing, "frozen_mechanism", lambda *_: (nothing, next(gaps) * slack / (slack @ slack))
    )
    start = State(1.0, x, nothing, 0.0 * slack)
    assert closing.closed(flow, Still(), start, 1e-8)[1] == rounds


def test_rounds_on_a_line_are_extrapolated_to_where_they_stand_still():
    """Each takes a tenth of the way to the end: x <- x + .1 (end - x), that is, closed form of Aitken."""
    end, way = np.array([1.0, -2.0, 3.0]), np.array([0.5, 1.0, -4.0])
    after = [end + 0.9**k * way for k in range(3)]
    rounds = [(after[k], after[k] - after[k - 1]) for k in (1, 2)]
    weights = np.array([1.0, 2.0, 5.0])
    assert np.allclose(closing.ahead(rounds[1], rounds[0], weights), end, atol=1e-12)
    assert (closing.ahead(rounds[0], None, weights) == after[1]).all()


def test_extrapolated_rounds_need_three_quarters_at_most_and_mechanisms_exist_beyond_yield(monkeypatch):
    """Of this corner 7 where 15 are needed without."""
    joint = lb.OrdunaLourenco(0.6)
    model = lb.structures.corner(joint, length=2.4, return_length=2.4, courses=4, direction=(0.0, 1.0, 0.0))
    problem = own_units(model, bracket(model))
    flow = Flow(problem)
    x0 = start_stresses(model, Flow(problem), problem.compliance, None)
    assert closing.frozen_mechanism(flow, -x0) is not None  # tension: no gap were least
    power = load_scale(problem, bracket(model).associated) / len(problem.blocks)
    state, _ = follow(flow, x0, problem.compliance, means=[Means(Barrier(), 2, 35)], power=power)
    nearest, needed = NearestStresses(problem), []
    for ahead in (closing.ahead, lambda now, *_: now[0]):
        monkeypatch.setattr(closing, "ahead", ahead)
        found, rounds = closing.closed(flow, nearest, state, 1e-8)
        assert defect(flow, found) <= 1e-8
        needed.append(rounds)
    assert needed[0] < 0.75 * needed[1]


def test_pivots_close_rounds_near_a_solution(monkeypatch):
    """Six rounds in place of 16: of groin vaults that are treated as large."""
    monkeypatch.setattr(ways, "LARGE", 10)

    def rounds():
        frictions = map(lb.OrdunaLourenco, (0.54, 0.56))
        found = [lb.nonassociated(lb.structures.EXAMPLES["groin_vault"](one)).how for one in frictions]
        assert all("of the fixed point" in how for how in found)
        return sum(int(re.search(r"(\d+) rounds? of", how)[1]) for how in found)

    with_pivots = rounds()
    monkeypatch.setattr(closing, "pivoted", lambda flow, state: state)
    assert with_pivots < 0.5 * rounds()


def test_pivots_are_not_tried_far_from_a_solution(monkeypatch):
    """Where rounds of this corner end they would change nothing."""

    def never(*_):
        raise AssertionError("pivots cost more than the round")

    monkeypatch.setattr(ways, "LARGE", 10)
    monkeypatch.setattr(closing, "pivoted", never)
    assert lb.nonassociated(lb.structures.EXAMPLES["corner"](lb.OrdunaLourenco(0.7))).converged


@pytest.mark.parametrize(("budget", "begin"), [(5, 0), (100, 1)])
def test_rounds_begin_where_less_is_left_than_the_loads(budget, begin, monkeypatch):
    """The path of this corner is at a residual of 16 after five factorisations, and at .48 after 100."""
    begun = []

    def closed(flow, _nearest, state, _tolerance):
        begun.append(defect(flow, state))
        return state, 0

    monkeypatch.setattr(ways, "LARGE", 10)
    monkeypatch.setattr(ways, "LARGE_MEANS", (LARGE_MEANS[0]._replace(budget=budget),))
    monkeypatch.setattr(closing, "closed", closed)
    lb.nonassociated(corner(), throw=False)
    assert len(begun) == begin
    assert max(begun, default=0.0) < 1.0


def test_the_first_path_is_followed_alone_where_rounds_do_not_begin(monkeypatch):
    """That of the load path is asked for; the next one would solve the corner."""
    first, *others = LARGE_MEANS
    monkeypatch.setattr(ways, "LARGE", 10)
    monkeypatch.setattr(ways, "LARGE_MEANS", (first._replace(budget=5), *others))
    flow, x0, _ = start(corner())
    scale = load_scale(flow.problem, bracket(corner()).associated)
    given = each_way.Given(flow, x0, scale, 1e-8, lambda _: None)
    state, how = ways.first_to_solve(given, MEANS, first=True)
    assert "small barrier" in how
    assert defect(flow, state) > 1.0


def test_a_large_model_is_solved_by_a_short_path_and_rounds(monkeypatch):
    monkeypatch.setattr(ways, "LARGE", 10)
    model = corner()
    found = lb.nonassociated(model)
    assert found.how.endswith("rounds of the fixed point")
    assert lb.check_mcp(model, found).passed
    assert any("need not be that of the load path" in remark for remark in found.remarks)
    assert found.frictionless <= found.load_factor <= found.associated * (1 + 1e-6)


def test_a_large_model_follows_the_means_that_are_given(monkeypatch):
    monkeypatch.setattr(ways, "LARGE", 10)
    own = [Means(Barrier(0.5, 2.0), 3, 300), Means(Barrier(0.5, 2.0), 4, 300)]
    assert "barrier 0.5 (large barrier), power 2, seed 3" in lb.nonassociated(corner(), means=own).how


def test_the_last_path_of_a_large_model_is_followed_where_the_one_before_ends(monkeypatch):
    """A dome of 289 (no crushing, out) takes a minute to show that it is needed: here the others are cut."""
    *others, last = LARGE_MEANS
    monkeypatch.setattr(ways, "LARGE", 10)
    monkeypatch.setattr(ways, "LARGE_MEANS", (*(one._replace(budget=1) for one in others), last))
    monkeypatch.setattr(closing, "closed", lambda _flow, _nearest, state, _tolerance: (state, 0))
    assert lb.nonassociated(corner()).how == "tracked path, barrier 3 (large barrier), power 2, seed 2"


@pytest.mark.parametrize("rounds", [True, False])
def test_rounds_close_a_path_of_a_large_model_on_its_way(rounds, monkeypatch):
    """The path of this vault closes in 274 factorisations with them, and in 738 without."""
    vault = lb.structures.EXAMPLES["groin_vault"](lb.OrdunaLourenco(0.7))
    model = replace(vault, live=lb.mass_proportional((1.0, 1.0, 0.0)))
    problem = own_units(model, bracket(model))
    flow = Flow(problem)
    x0 = start_stresses(model, Flow(problem), problem.compliance, None)
    power = load_scale(problem, bracket(model).associated) / len(problem.blocks)
    one = Means(Barrier(3.0, 2.0, 1e-8), 0, 300)
    way = closing.Closing(flow, 1e-8) if rounds else None
    _, (info,) = follow(flow, x0, problem.compliance, means=[one], power=power, closing=way)
    assert info.closed is rounds
    assert way is None or (way.solution is not None and way.how.endswith("rounds of the fixed point"))


@pytest.mark.parametrize(
    ("budget", "end"), [(20, "of the fixed point, in the plane"), (1500, "seed 1, in the plane")]
)
def test_a_large_wall_in_its_plane_has_a_larger_barrier_and_rounds_before_increments(
    budget, end, monkeypatch
):
    def never(*_):
        raise AssertionError("increments cost too much")

    first, larger = LARGE_PLANAR_MEANS
    monkeypatch.setattr(ways, "LARGE_IN_PLANE", 10)
    monkeypatch.setattr(
        ways, "LARGE_PLANAR_MEANS", (first._replace(budget=1), larger._replace(budget=budget))
    )
    monkeypatch.setattr(each_way.Given, "increments", never)
    model = lb.structures.wall(lb.PointContact(0.6), length=2.4, courses=6)
    found = lb.nonassociated(model)
    assert found.how.startswith("tracked path, barrier 3 ")
    assert found.how.endswith(end)
    assert lb.check_mcp(model, found).passed


@pytest.mark.parametrize(
    ("blocks", "in_space", "reduced", "means"),
    [
        (100, True, False, SPATIAL_MEANS),
        (101, True, False, LARGE_MEANS),
        (100, True, True, REDUCED_MEANS),
        (300, True, False, LARGE_MEANS),
        (301, True, False, LARGEST_MEANS),
        (101, True, True, LARGE_MEANS),
        (301, True, True, LARGE_MEANS),
        (500, False, True, REDUCED_MEANS),
        (501, False, True, LARGE_PLANAR_MEANS),
    ],
)
def test_the_number_of_blocks_says_which_means_are_followed(blocks, in_space, reduced, means):
    assert ways.own_means(blocks, in_space, True, reduced) == means
    if in_space:  # a flow that can give power has further ways of its own
        assert ways.own_means(blocks, in_space, False, reduced) == (REDUCED_MEANS if reduced else MEANS)


def test_beyond_three_hundred_blocks_one_barrier_goes_on(monkeypatch):
    """With a thirtieth of its budget, 133 factorisations, and no rounds."""
    further = LARGEST_MEANS[1]._replace(budget=LARGEST_MEANS[1].budget // 30)
    monkeypatch.setattr(ways, "LARGE", 10)
    monkeypatch.setattr(ways, "LARGEST", 20)
    monkeypatch.setattr(ways, "LARGEST_MEANS", (LARGEST_MEANS[0]._replace(budget=1), further))
    monkeypatch.setattr(closing, "closed", lambda _flow, _nearest, state, _tolerance: (state, 0))
    assert lb.nonassociated(corner()).how == "tracked path, barrier 3 (large barrier), power 2, seed 1"


def test_rounds_that_are_interrupted_give_the_end_of_the_path(monkeypatch):
    def pressed(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(ways, "LARGE", 10)
    monkeypatch.setattr(closing, "closed", pressed)
    with pytest.raises(lb.NotConverged, match="interrupted") as caught:
        lb.nonassociated(corner())
    assert caught.value.result.status is lb.results.Status.INTERRUPTED


def test_a_large_model_ends_where_its_backward_error_is_small_enough(monkeypatch):
    """A ten-thousandth of the way back from a solution to the end of the path is exact for a model nearby."""
    whole, ends = closing.closed, []

    def rough(flow, nearest, state, tolerance):
        found, rounds = whole(flow, nearest, state, tolerance)
        mixed = [b + 1e-4 * (a - b) for a, b in zip(parts(state), parts(found), strict=True)]
        ends.append(lb.problem.State(*mixed))
        return ends[-1], rounds

    monkeypatch.setattr(ways, "LARGE", 10)
    monkeypatch.setattr(closing, "closed", rough)
    found = lb.nonassociated(corner(), backward_error=1e-3)
    assert len(ends) == 1
    assert found.status is lb.results.Status.NEARBY
    assert found.backward_error.value <= 1e-3


def parts(state):
    return state.load_factor, state.x, state.u, state.y


def test_pivots_close_the_end_of_a_path_that_ran_out_of_budget(monkeypatch):
    """Of vaults that crush, stopped one factorisation before their path is closed on its way."""

    def closes(friction):
        joint = lb.OrdunaLourenco(friction, compressive_strength=0.3e6)
        size = {"radius": 1.5, "thickness": 0.4, "length": 1.8, "courses": 7, "stones": 3}
        vault = lb.structures.barrel_vault(joint, **size, direction=(1.0, 1.0, 0.0))
        path = MEANS[0]._replace(patience=None)
        whole = lb.nonassociated(vault, means=[path], confirm=False, throw=False)
        short = path._replace(budget=whole.history[-2].inner - 1)
        return lb.nonassociated(vault, means=[short], confirm=False, throw=False).converged

    vaults = (0.58, 0.585)
    with_pivots = sum(map(closes, vaults))
    monkeypatch.setattr(each_way, "pivoted", lambda flow, state: state)
    assert sum(map(closes, vaults)) < with_pivots

"""States within the tolerance on the way to a solution with another load factor."""

from dataclasses import replace

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.analysis.load_factor_range import sampling
from limitblocks.analysis.nonassociated import finished, path, settling, ways
from limitblocks.analysis.nonassociated.loop import nonassociated
from limitblocks.analysis.nonassociated.means import LOW
from limitblocks.analysis.nonassociated.path_equations import Barrier
from limitblocks.analysis.nonassociated.path_record import CLOSED, UNSETTLED, Tracked
from limitblocks.practice import displaced
from limitblocks.practice.advance import advanced
from limitblocks.practice.capacity_result import Control
from limitblocks.practice.touching import pressed_in, touching
from limitblocks.problem import Flow, State
from limitblocks.structures import EXAMPLES

Status = lb.results.Status
LARGE = [lb.settings.Means(lb.settings.Barrier(0.2, 2.0, LOW), seed=2, budget=800)]


def corner_moved(by):
    """A corner of two walls, moved along its mechanism: it almost jams."""
    push = (0.0, -1.0, 0.0)
    model = replace(EXAMPLES["corner"](lb.PointContact(0.8)), live=lb.mass_proportional(push))
    first = nonassociated(model, confirm=False)
    fastest = model.blocks[int((first.displacement_rates[:, :3] @ push).argmax())]
    control = Control(fastest.name, fastest.centroid, push)
    assembly = displaced.assembly_of(model)
    assembly = pressed_in(assembly, list(range(len(model.interfaces))), first.stress_resultants)
    there = advanced(assembly, control, first.displacement_rates, by)
    return touching(there.assembly)[0]


@pytest.fixture(scope="module")
def moved_corner():
    return corner_moved(2e-6)


def followed(model):
    return nonassociated(model, means=LARGE, confirm=False, throw=False)


def test_a_path_ends_only_where_its_state_is_exact_for_a_model_nearby(moved_corner, monkeypatch):
    found = followed(moved_corner)
    assert found.converged is (found.backward_error.value <= 1e-4)
    monkeypatch.setattr(settling.Settling, "ends", lambda self: self.left <= 1e-8)
    early = followed(moved_corner)  # the first state within the tolerance
    assert early.converged
    assert early.backward_error.value > 0.1
    assert early.load_factor > 1.05 * found.load_factor


def test_states_within_the_tolerance_that_are_exact_for_no_model_are_polished_now_and_then(
    moved_corner, monkeypatch
):
    """Not at every point."""
    lefts, polished = [], path.polished

    def counted(flow, state, left, **options):
        lefts.append(left)
        return polished(flow, state, left, **options)

    monkeypatch.setattr(path, "polished", counted)
    found = followed(moved_corner)
    assert 2 <= sum(left <= 1e-8 for left in lefts) <= 10
    assert len(found.history) > 100


def test_a_load_factor_that_still_changes_is_no_answer(moved_corner, monkeypatch):
    monkeypatch.setattr(path, "FURTHER", 100)
    with pytest.raises(lb.NotConverged, match="the load factor still changed as its path was followed on"):
        nonassociated(moved_corner, means=LARGE, confirm=False)
    found = followed(moved_corner)
    assert found.status is Status.UNSETTLED
    assert found.residuals.worst.value <= 1e-8


def test_a_path_stopped_on_the_way_is_no_answer_unless_it_is_exact_nearby(moved_corner, monkeypatch):
    def stop(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(settling.Settling, "stands_still", stop)
    found = followed(moved_corner)
    assert found.residuals.worst.value <= 1e-8
    assert found.status is Status.INTERRUPTED
    assert found.backward_error.value > 0.1
    monkeypatch.setattr(finished, "far_off", lambda *_: ())
    assert followed(moved_corner).status is Status.CONVERGED


def test_a_path_that_falls_beyond_the_tolerance_is_followed_to_its_end():
    """Nothing changes any more once it is exact for a model nearby."""
    found = followed(corner_moved(1.5e-5))
    assert found.converged
    assert found.backward_error.value <= 1e-4


@pytest.mark.parametrize(("change", "ends"), [(0.9e-4, True), (-1.1e-4, False)])
def test_a_load_factor_that_stands_still_ends_a_path(moved_corner, change, ends):
    p = moved_corner.problem
    still, a = settling.Settling(Flow(p)), 0.3
    state = State(a, np.zeros(p.C.shape[0]), np.zeros(p.C.shape[1]), np.zeros(len(p.g)))
    for k in range(0, settling.SOON, 10):
        assert not still.stands_still(state, 50 + k)
    last = replace(state, load_factor=a * (1.0 + change))
    assert still.stands_still(last, 50 + settling.SOON) is ends is not still.changes
    later = 50 + settling.SOON + settling.LATER  # it changed once, and then no more
    assert ends or not still.stands_still(last, later - 1)
    assert ends or not still.stands_still(last, 50 + settling.SOON + 65)  # as long as it stood in a facade
    assert still.stands_still(last, later)
    assert not still.changes


def test_a_state_of_another_load_factor_than_the_last_is_no_end(moved_corner):
    p = moved_corner.problem
    state = State(0.3, np.zeros(p.C.shape[0]), np.zeros(p.C.shape[1]), np.zeros(len(p.g)))
    still = settling.Settling(Flow(p), best=replace(state, load_factor=0.3003))
    assert not still.stands_still(state, 50)
    assert not still.stands_still(state, 50 + settling.SOON)
    still.best = state
    assert still.stands_still(state, 50 + settling.SOON)


@pytest.mark.parametrize(("before", "exact"), [(True, False), (True, True), (False, False)])
def test_after_an_unsettled_path_only_what_is_exact_nearby_is_an_answer(
    moved_corner, before, exact, monkeypatch
):
    """Rounds and pivots lead to a state within the tolerance and follow no load factor."""

    def given_ways(given, means, reduced):
        state, how = given.tracked(means[0])
        if before:
            yield state, f"{how}, {UNSETTLED}"
        yield state, f"{how}, 3 rounds of the fixed point"

    monkeypatch.setattr(settling.Settling, "ends", lambda self: self.left <= 1e-8)
    monkeypatch.setattr(ways, "_ways", given_ways)
    if exact:
        monkeypatch.setattr(ways, "exact_nearby", lambda *_: True)
    found = followed(moved_corner)
    assert found.residuals.worst.value <= 1e-8
    assert found.backward_error.value > 0.1
    refused = before and not exact
    assert found.status is (Status.UNSETTLED if refused else Status.CONVERGED)
    assert (UNSETTLED in found.how) is refused


@pytest.mark.parametrize(("end", "refused"), [(CLOSED, False), (UNSETTLED, True)])
def test_a_range_is_not_sampled_where_a_load_factor_still_changes(moved_corner, end, refused, monkeypatch):
    p = moved_corner.problem
    state = State(0.3, np.zeros(p.C.shape[0]), np.zeros(p.C.shape[1]), np.zeros(len(p.g)))
    went = Tracked(Barrier(), 1, end, 1e-9, 100, 0, ())
    monkeypatch.setattr(sampling, "track", lambda *_, **__: (state, went))
    monkeypatch.setattr(sampling, "polish", lambda _, one: one)
    sampler = sampling.Sampler(Flow(p), state.x, None, 1.0, lambda _: None)
    assert next(sampler.ways(0)).go() is (None if refused else state)


def test_a_smaller_residual_is_judged_again_once_it_is_that_of_a_polish(moved_corner, monkeypatch):
    p, asked = moved_corner.problem, []
    monkeypatch.setattr(settling, "exact_nearby", lambda *_: bool(asked.append(1)))
    found = settling.Settling(Flow(p), last=0.3)
    state = State(0.3, np.zeros(p.C.shape[0]), np.zeros(p.C.shape[1]), np.zeros(len(p.g)))
    for residual, count in ((5e-9, 1), (2e-10, 1), (3e-11, 2), (2e-11, 2), (2e-12, 3)):
        found.keep(state, state, residual)
        assert not found.ends()
        assert len(asked) == count

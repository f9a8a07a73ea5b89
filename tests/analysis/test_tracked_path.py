"""One tracked path: a fold, and a case for each further means."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from paths import start

import limitblocks as lb
from limitblocks import structures
from limitblocks.analysis.nonassociated import closing, each_way, finished, tracking
from limitblocks.analysis.nonassociated import increment as increments
from limitblocks.analysis.nonassociated import path as walking
from limitblocks.analysis.nonassociated.increment import NO_BARRIER, faded, increment
from limitblocks.analysis.nonassociated.means import MEANS, Means
from limitblocks.analysis.nonassociated.path import Walk
from limitblocks.analysis.nonassociated.path_equations import Barrier, inner
from limitblocks.analysis.nonassociated.path_record import Progress, winds
from limitblocks.analysis.nonassociated.path_start import path_from
from limitblocks.analysis.nonassociated.start import load_scale
from limitblocks.analysis.nonassociated.tracking import track
from limitblocks.analysis.polish import defect, polish
from limitblocks.evidence import backward_error


def load_factor(model, state):
    return model.problem.in_si(state).load_factor


def pushed(name, joint, direction):
    return replace(structures.EXAMPLES[name](joint), live=lb.mass_proportional(direction))


def test_a_path_is_followed_through_its_folds_by_the_determinant_alone(monkeypatch):
    begin = start(pushed("pavilion_vault", lb.PointContact(0.7), (1, 1, 0)))
    barrier = Barrier(0.02, 2.0)
    _, path = track(*begin, barrier=barrier, seed=1, budget=250)
    assert path.closed
    assert np.count_nonzero(np.diff([point.sign for point in path.points])) >= 2
    thetas = [point.theta for point in path.points]
    assert np.diff(thetas).max() > 0.0  # theta had to grow on the way

    def by_angle(walk, _sign, turn):
        if walk.base is None:
            return -1.0
        return float(np.sign(inner(walk.path.cones, walk.z, turn, walk.base.tangent)))

    monkeypatch.setattr(Walk, "_heading", by_angle)
    _, path = track(*begin, barrier=barrier, seed=1, budget=250)
    assert not path.closed


@pytest.fixture(scope="module")
def lintel():
    """The begin of an increment of an eccentric lintel that crushes, and 1 / tau of an elastic one."""
    model = structures.eccentric_lintel(lb.OrdunaLourenco(0.6, compressive_strength=0.3e6), eccentricity=0.1)
    flow, x0, weights = start(model)
    power = load_scale(flow.problem, lb.bounds(model).upper) / len(model.free_blocks)
    path = path_from(flow, x0, weights, Barrier(0.01, floor=0.0), 0, power)
    return path, weights, float(path.elastic[0] / weights[0])


def test_an_increment_far_beyond_the_elastic_part_begins_farther_back(lintel, monkeypatch):
    path, weights, rho = lintel
    assert increment(path, weights, 1e-4 * rho, left=1e-5).increment is not None
    monkeypatch.setattr(increments, "SPANS", increments.SPANS[:1])
    assert increment(path, weights, 1e-4 * rho, left=1e-5).increment is None


def test_what_is_left_of_the_barrier_can_fade_later(lintel):
    path, weights, rho = lintel
    coarse = increment(path, weights, 0.1 * rho, left=1e-5)
    fine = increment(path, weights, 0.1 * rho)
    assert coarse.increment.left == pytest.approx(1e-5, rel=0.01)
    assert fine.increment.left == pytest.approx(NO_BARRIER, rel=0.01)
    assert coarse.factorisations < fine.factorisations
    later = faded(coarse.increment)
    assert later.increment.left == pytest.approx(NO_BARRIER, rel=0.01)
    assert later.increment.end.load_factor == pytest.approx(fine.increment.end.load_factor, rel=1e-6)


def test_means_of_the_small_barrier_come_before_increments(monkeypatch):
    model = structures.ferris_tin_loi_wall(1, lb.PointContact(0.65))
    monkeypatch.setattr(each_way.Given, "increments", None)  # not asked for
    means = (Means(Barrier(), 0, 1), Means(Barrier(0.02, 2.0), 1, 300))
    assert "small barrier" not in lb.nonassociated(model, means=means).how


def test_an_end_below_a_tenth_of_the_tolerance_is_not_polished(monkeypatch):
    flow, *given = start(structures.block(lb.PointContact(0.4), width=1.0, height=1.0))
    end = track(flow, *given)[0]
    end = replace(end, u=end.u * (1.0 + 3e-10))  # of the work of the live load
    left = defect(flow, end)
    assert left > 1e-10
    monkeypatch.setattr(each_way, "polished", None)  # not asked for
    wide, narrow = (each_way.Given(flow, end.x, 1.0, share * left, print) for share in (11.0, 9.0))
    assert wide.polished(end, "path") == (end, "path")
    with pytest.raises(TypeError):
        narrow.polished(end, "path")


def test_rounds_of_the_fixed_point_close_what_small_barriers_leave_open(monkeypatch):
    monkeypatch.setattr(
        "limitblocks.analysis.in_plane.mirror_of", lambda problem: None
    )  # one half comes before
    door = [(1.2, 0.0, 0.8, 1.2)]
    joint = lb.OrdunaLourenco(0.6, compressive_strength=0.3e6)
    model = structures.facade(
        joint, length=3.2, courses=5, return_length=1.6, openings=door, direction=(1, 1, 0)
    )
    assert not lb.nonassociated(model, means=MEANS[:1], throw=False).converged
    found = lb.nonassociated(model, means=(MEANS[0], Means(Barrier(3.0), 1, 1)))
    assert found.how.endswith("rounds of the fixed point")
    assert any("need not be that of the load path" in remark for remark in found.remarks)


def test_pivots_close_what_rounds_leave_open(monkeypatch):
    """One round in place of two."""
    model = pushed("buttressed_wall", lb.OrdunaLourenco(0.6), (1, 1, 0))
    means = (Means(Barrier(), 1, 40), Means(Barrier(), 1, 1))
    assert lb.nonassociated(model, means=means).how.endswith("1 round of the fixed point")
    monkeypatch.setattr(closing, "pivoted", partial(polish, patience=2))
    assert lb.nonassociated(model, means=means).how.endswith("rounds of the fixed point")


def test_pivots_make_a_state_within_the_tolerance_exact():
    """Without them its backward error is 1e-3, and it only stands still."""
    model = pushed("buttressed_wall", lb.OrdunaLourenco(0.7), (1, 1, 0))
    found = lb.nonassociated(model, means=MEANS[2:], confirm=False)
    assert found.residuals.worst.value <= 1e-10
    assert found.backward_error.value <= 1e-10


def test_paths_start_where_rows_begin_to_yield(monkeypatch):
    """The same load factors in fewer factorisations than from an elastic step a fifth as long."""
    pushes = {"wall": (0, 1, 0), "segmental_arch": (1, 0, 0), "pointed_arch": (0, 1, 0)}
    models = [pushed(name, lb.OrdunaLourenco(0.7), push) for name, push in pushes.items()]

    def followed():
        found = [lb.nonassociated(model, means=MEANS[:1], confirm=False) for model in models]
        return [one.load_factor for one in found], sum(one.history[-2].inner for one in found)

    near, fewer = followed()
    monkeypatch.setattr(walking, "START", 1.0)
    monkeypatch.setattr(Walk, "first", 0.3)
    far, more = followed()
    assert near == pytest.approx(far, rel=1e-6)
    assert fewer < 0.95 * more


@pytest.mark.parametrize(
    ("name", "direction", "means"), [("pavilion_vault", (1, 0, 0), 2), ("tower", (1, 1, 0), 3)]
)
def test_each_means_closes_what_the_one_before_it_leaves_open(name, direction, means):
    model = pushed(name, lb.OrdunaLourenco(0.7), direction)
    before, one = MEANS[means - 2 : means - 1], MEANS[means - 1 : means]
    assert not lb.nonassociated(model, means=before, throw=False).converged
    found = lb.nonassociated(model, means=one)
    assert found.residuals.worst.value <= 1e-8
    barrier, seed, *_ = MEANS[means - 1]
    large = barrier.size > Barrier().size
    size = f"barrier {barrier.size:g}" + " (large barrier)" * large
    assert f"{size}, power {barrier.power:g}, seed {seed}" in found.how
    assert any("not that of the load path" in remark for remark in found.remarks) == large


@pytest.mark.parametrize(("floor", "closes"), [(MEANS[2].barrier.floor, True), (Barrier().floor, False)])
def test_little_compliance_is_left_at_the_end_of_a_large_barrier(floor, closes):
    """The floor of the small barrier leaves this wall of two leaves open after as many factorisations."""
    joint, last = lb.OrdunaLourenco(0.7, compressive_strength=0.3e6), MEANS[2]
    model, means = (
        pushed("two_leaf_wall", joint, (1, 1, 0)),
        [last._replace(barrier=replace(last.barrier, floor=floor))],
    )
    assert lb.nonassociated(model, means=means, confirm=False, throw=False).converged == closes


def test_a_path_that_winds_is_given_up():
    begin = start(pushed("buttressed_wall", lb.OrdunaLourenco(0.7), (1, 1, 0)))
    _, patient = track(*begin, seed=1, budget=300)
    _, given_up = track(*begin, seed=1, budget=300, patience=100)
    assert (patient.end, given_up.end) == ("budget", "winds")
    assert given_up.factorisations < 250
    falling = start(pushed("cantilever_stair", lb.OrdunaLourenco(0.7), (1, 0, 0)))
    assert track(*falling, seed=1, budget=300, patience=100)[1].closed


@pytest.mark.parametrize(
    ("last", "patience", "given_up"),
    [(0.5, 20, True), (0.3, 20, False), (0.5, 40, False), (0.5, None, False)],
)
def test_theta_has_to_fall_to_a_third_in_as_many_factorisations_as_there_is_patience_for(
    last, patience, given_up
):
    """It was 1 after 10 factorisations; what it grew to since does not count."""
    thetas = np.array([1.0, last, 1.2])
    points = list(map(Progress, thetas, 3 * [0.0], 3 * [1.0], (10, 20, 30), np.minimum.accumulate(thetas)))
    assert winds(points, 35, patience) == given_up


def test_a_path_ends_at_the_first_point_that_is_a_solution_as_it_is(monkeypatch):
    """The residual of a point falls with theta; that of the point before the end is above the tolerance."""
    monkeypatch.setattr(walking, "polished", lambda _flow, state, left, **_: (state, left))
    monkeypatch.setattr(walking, "pivoted", lambda _flow, state, **_: state)
    model = structures.ferris_tin_loi_wall(3, lb.OrdunaLourenco(0.65))
    _, path = track(*start(model), barrier=Barrier(3.0, 2.0, 1e-10), seed=1, budget=100)
    before, last = path.points[-2:]
    assert path.closed
    assert path.residual <= 1e-8 < path.residual * before.theta / last.theta


def test_an_interrupted_path_leaves_its_best_state():
    model = structures.ferris_tin_loi_wall(1, lb.PointContact(0.65))
    seen = []

    def press(iteration):
        seen.append(iteration)
        if len(seen) == 10:
            raise KeyboardInterrupt

    with pytest.raises(lb.NotConverged, match="interrupted: flow residual") as caught:
        lb.nonassociated(model, progress=press)
    found = caught.value.result
    assert found.status.name == "INTERRUPTED"
    assert found.load_factor == seen[8].load_factor  # the last point that was accepted as a whole
    assert found.how.endswith("interrupted")


@pytest.mark.parametrize(
    ("analysis", "options"),
    [(lb.nonassociated, {}), (lb.nonassociated, {"method": "fixed point"}), (lb.load_path, {})],
)
@pytest.mark.parametrize("patience", [3, np.inf])
def test_a_progress_that_stops_again_and_again_leaves_the_best_state(analysis, options, patience):
    """As one with a time limit does: it is told of the end as well, or of nothing else after its limit."""
    model = structures.ferris_tin_loi_wall(1, lb.PointContact(0.65))
    seen = []

    def press(iteration):
        seen.append(iteration)
        if len(seen) > patience or iteration.kind == "polish":
            raise KeyboardInterrupt

    path = analysis(model, progress=press, throw=False, **options)
    found = path if analysis is lb.nonassociated else path.collapse
    assert found.status is (lb.results.Status.CONVERGED if patience > 3 else lb.results.Status.INTERRUPTED)
    assert seen[-1].kind == "polish"
    assert found.load_factor == pytest.approx(seen[-1].load_factor, rel=1e-12)


@pytest.mark.parametrize("points", [20, 29, 38])
def test_an_interrupted_path_leaves_its_last_point_where_that_is_nearer_than_what_was_polished(
    monkeypatch, points
):
    """A facade of 508 blocks stopped after 70 s was left at 9e-5; its path had come to 4e-6."""
    walks, seen = [], []
    monkeypatch.setattr(tracking, "Walk", lambda *given: walks.append(Walk(*given)) or walks[-1])

    def press(point):
        seen.append(point)
        if len(seen) == points:
            raise KeyboardInterrupt

    begin = start(pushed("tower", lb.PointContact(0.8), (1, 1, 0)))
    state, path = track(*begin, progress=press)
    assert path.interrupted
    assert path.residual == defect(begin[0], state) <= defect(begin[0], walks[0].state)


@pytest.mark.parametrize(("part", "known"), [("backward_error", False), ("fixed_point_change", True)])
def test_an_answer_is_kept_that_is_interrupted_while_its_evidence_is_gathered(monkeypatch, part, known):
    """The wall's answer, and all residuals of it within the tolerance, but not all that speaks for it."""
    model = structures.ferris_tin_loi_wall(1, lb.PointContact(0.65))
    whole = lb.nonassociated(model)
    assert lb.check_mcp(model, whole).passed  # its module is loaded before what it imports is changed

    def press(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr({"backward_error": backward_error, "fixed_point_change": finished}[part], part, press)
    with pytest.raises(lb.NotConverged, match="interrupted") as caught:
        lb.nonassociated(model)
    found = caught.value.result
    assert found.status is lb.results.Status.INTERRUPTED
    assert found.load_factor == whole.load_factor
    assert found.residuals.worst.value <= 1e-8
    assert np.isfinite(found.backward_error.value) == known
    assert found.fixed_point_change is None
    assert any(remark.startswith("this state solves the equations") for remark in found.remarks)


def test_a_path_out_of_budget_says_so_and_leaves_its_best_state():
    seen = []
    begin = start(structures.ferris_tin_loi_wall(1, lb.PointContact(0.65)))
    _, path = track(*begin, budget=10, progress=seen.append)
    assert path.end == "budget"
    assert not path.closed
    assert np.isfinite(path.residual)
    assert tuple(seen) == path.points


def test_the_means_begin_with_the_small_barrier():
    assert MEANS[0].barrier == Barrier()
    assert len(set(MEANS)) == len(MEANS)

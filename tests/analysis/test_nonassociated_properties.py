"""Properties of the non-associated answer: bracket, associated limit, invariance, restart, honesty."""

import logging
from dataclasses import replace

import numpy as np
import pytest

import limitblocks as lb
from limitblocks import structures
from limitblocks.analysis.nonassociated import each_way
from limitblocks.analysis.nonassociated.means import Means
from limitblocks.analysis.nonassociated.path_equations import Barrier
from limitblocks.analysis.scales import unmoved

MU = 0.65
KINDS = [lb.OrdunaLourenco, lb.PointContact]
WALLS = [{"friction": mu, "courses": courses} for mu in (0.5, 0.65, 0.8) for courses in (3, 4)]
NAMES = ["equilibrium", "yield", "flow", "normalisation", "multipliers", "complementarity", "dissipation"]


def wall(kind, scale=1.0, unit_weight=20e3, direction=(1, 0, 0), friction=MU, courses=4):
    return structures.wall(
        kind(friction),
        length=1.2 * scale,
        courses=courses,
        block_length=0.4 * scale,
        block_height=0.2 * scale,
        thickness=0.2 * scale,
        unit_weight=unit_weight,
        direction=direction,
    )


@pytest.fixture(scope="module", params=KINDS, ids=lambda kind: kind.__name__)
def kind(request):
    return request.param


@pytest.fixture(scope="module")
def reference(kind):
    model = wall(kind)
    return model, lb.nonassociated(model)


def corner(kind):
    """Two short walls that meet, pushed out of the plane of one: blocks slide, twist and rock."""
    return structures.facade(
        kind(MU), length=2.0, courses=2, return_length=0.8, openings=[], direction=(0, 1, 0)
    )


def test_the_answer_is_within_its_bracket(reference):
    model, found = reference
    bounds = lb.bounds(model)
    assert found.frictionless - 1e-6 <= found.load_factor <= found.associated + 1e-6
    assert found.associated == bounds.upper
    assert found.frictionless == pytest.approx(0.0, abs=1e-9)
    assert str(found).startswith("non-associated load factor ")
    assert "(frictionless)" in str(found)


@pytest.mark.parametrize("build", [wall, corner], ids=["wall", "corner"])
def test_dilatancy_equal_to_friction_gives_the_associated_value(kind, build):
    model = build(kind)
    found, bounds = lb.nonassociated(model, dilatancy=MU), lb.bounds(model)
    assert found.load_factor == pytest.approx(bounds.lower, abs=1e-6)
    assert found.load_factor == pytest.approx(bounds.upper, abs=1e-6)


@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.9])
def test_every_dilatancy_gives_a_checked_answer_within_the_bracket(kind, share, reference):
    """No theorem says that the answer grows with the dilatancy, but on this wall it does not fall."""
    model, zero = reference
    found = lb.nonassociated(model, dilatancy=share * MU)
    assert found.dilatancy == share * MU
    assert lb.check_mcp(model, found).worst.value <= 1e-6
    assert zero.load_factor - 1e-4 <= found.load_factor <= found.associated + 1e-6


@pytest.mark.parametrize("dilatancy", [-0.1, MU + 1e-6, np.nan])
@pytest.mark.parametrize("analysis", [lb.nonassociated, lb.load_path])
def test_dilatancy_out_of_range_is_refused(reference, dilatancy, analysis):
    with pytest.raises(lb.ModelError, match="dilatancy is"):
        analysis(reference[0], dilatancy=dilatancy)


@pytest.mark.parametrize(
    "change", [{"scale": 1e-3}, {"scale": 1e3}, {"unit_weight": 20.0}, {"unit_weight": 20e9}], ids=str
)
def test_units_change_nothing(kind, reference, change):
    """Up to rounding, which decides where in an interval of solutions the path is closed."""
    found = lb.nonassociated(wall(kind, **change))
    assert found.load_factor == pytest.approx(reference[1].load_factor, abs=1e-6)


@pytest.mark.parametrize(
    "change", [{"scale": 2.0**-10}, {"scale": 2.0**10}, {"unit_weight": 20e3 * 2.0**20}], ids=str
)
def test_units_that_round_alike_change_nothing_at_all(kind, change):
    for one in WALLS:
        was, now = (lb.nonassociated(wall(kind, **one, **by), confirm=False) for by in ({}, change))
        assert now.load_factor == pytest.approx(was.load_factor, rel=1e-12)


def test_a_mirror_image_has_the_same_answer(kind, reference):
    """The wall is its own image. With weights that differ by row its path may end at another solution."""
    even = (Means(Barrier(), 0, 300),)
    found, image = (lb.nonassociated(wall(kind, direction=(x, 0, 0)), means=even) for x in (1, -1))
    assert image.load_factor == pytest.approx(found.load_factor, abs=1e-8)
    other = lb.nonassociated(wall(kind, direction=(-1, 0, 0)))
    assert other.load_factor == pytest.approx(reference[1].load_factor, abs=1e-3)


def test_a_live_load_twice_as_large_has_half_the_load_factor(reference):
    model, found = reference
    twice = lb.nonassociated(replace(model, live=2.0 * model.live))
    assert twice.load_factor == pytest.approx(found.load_factor / 2, abs=1e-4)


def test_restart_converges_at_once(reference):
    model, found = reference
    again = lb.nonassociated(model, start=found)
    assert [one.kind for one in again.history] == ["polish"]
    assert again.load_factor == pytest.approx(found.load_factor, abs=1e-6)
    assert again.residuals.worst.value <= 1e-6


@pytest.mark.parametrize("analysis", [lb.nonassociated, lb.load_path])
def test_a_start_from_another_model_is_refused(kind, reference, analysis):
    other = wall(kind, unit_weight=21e3)
    with pytest.raises(lb.ModelError, match="belongs to model"):
        analysis(other, start=reference[1])


def test_progress_and_history_have_every_residual(kind):
    seen = []
    found = lb.nonassociated(wall(kind), progress=seen.append)
    assert tuple(seen) == found.history
    assert all(isinstance(iteration, lb.results.Iteration) for iteration in seen)
    *path, end = seen
    assert end.kind == "polish"
    assert list(end.residuals) == NAMES
    for point in path:
        assert point.kind == "path"
        assert point.residuals == {"theta": point.step_size}
        assert 0.0 < point.step_size <= 1.2


def test_iterations_within_another_analysis_are_logged(kind, caplog):
    model = wall(kind)
    with caplog.at_level(logging.DEBUG, "limitblocks.iterations"):
        found = lb.nonassociated(model)
        assert tuple(record.msg for record in caplog.records) == found.history
        assert caplog.messages[-1] == f"polish: load factor {found.load_factor:.6g}"
        caplog.clear()
        lb.practice.adequacy(model, lb.practice.PartialFactors(1.0, 1.0, 1.0), without_dilatancy=True)
    assert {record.msg.kind for record in caplog.records} == {"path", "polish"}


def test_the_answer_says_which_path_it_was(reference):
    assert reference[1].how.startswith("tracked path, small barrier")


SHORT = {
    lb.nonassociated: {"means": (Means(Barrier(), 0, 1),)},
    lb.load_path: {"settings": lb.settings.Settings(budget=1)},
}


@pytest.mark.parametrize("analysis", SHORT)
def test_a_short_budget_returns_the_best_state_and_says_so(reference, analysis):
    model, _ = reference
    found = analysis(model, throw=False, **SHORT[analysis])
    found = getattr(found, "collapse", found)
    assert found.status is lb.results.Status.OUT_OF_STEPS
    assert not found.converged
    assert "not converged" in str(found)
    assert found.residuals.worst.value > 1e-6
    assert not lb.check_mcp(model, found).passed


@pytest.mark.parametrize("analysis", SHORT)
def test_not_converged_carries_the_best_result(reference, analysis):
    model, _ = reference
    with pytest.raises(lb.NotConverged, match=r"no solution within 1e-08: .* residual") as caught:
        analysis(model, **SHORT[analysis])
    result = caught.value.result
    assert isinstance(result, lb.results.Nonassociated)
    assert result.residuals.worst.name in str(caught.value)
    assert "result" not in str(caught.value)  # a capacity curve quotes it where no error is to be had
    assert "ask stability first" in " ".join(caught.value.__notes__)
    assert result.residuals.worst.value > 1e-6


def test_further_means_are_tried_in_turn(reference, monkeypatch):
    model, _ = reference
    means = (Means(Barrier(), 0, 1), Means(Barrier(1.0, 2.0), 1, 300))
    assert lb.nonassociated(model, means=means).how.startswith("increments of the load path")
    monkeypatch.setattr(
        each_way.Given, "increments", lambda at: (unmoved(at.flow.problem, 0.0, at.x0), "none")
    )
    found = lb.nonassociated(model, means=means)
    assert found.converged
    assert "barrier 1 (large barrier), power 2, seed 1" in found.how


def test_dead_loads_that_fall_are_refused(kind):
    falling = structures.overhang(kind(0.7), count=3, length=1.0, height=0.4, fraction=1.01)
    with pytest.raises(lb.errors.NoEquilibrium):
        lb.nonassociated(falling)


def test_the_mechanism_does_unit_work_and_supports_stand_still(reference):
    model, found = reference
    work = np.sum(model.live.on(model.free_blocks) * found.displacement_rates[model.free])
    assert work == pytest.approx(1.0, abs=1e-6)
    assert not found.displacement_rates[~model.free].any()
    with pytest.raises(ValueError, match="read-only"):
        found.stress_resultants[0] = 0.0

"""Paths of a symmetric structure in one of its halves, accepted where they solve the whole."""

from dataclasses import replace

import pytest

import limitblocks as lb
from limitblocks.analysis.nonassociated import each_way, ways
from limitblocks.analysis.nonassociated.in_the_plane import flow_in_plane
from limitblocks.analysis.nonassociated.means import LARGE_MEANS, MEANS, REDUCED_MEANS, Means
from limitblocks.analysis.nonassociated.path_equations import Barrier
from limitblocks.analysis.nonassociated.start import flow_of, load_scale
from limitblocks.problem.plane import Planar
from tests.analysis.paths import follow

SECOND = (Means(Barrier(), 1, 1), Means(Barrier(0.02, 2.0), 1, 300))  # the first path is stopped at once


def symmetric_facade(**changes):
    size = {"length": 3.2, "courses": 3, "return_length": 1.6, "openings": ()}
    return lb.structures.facade(lb.PointContact(0.6), **(size | changes))


def test_one_half_closes_a_dome_that_the_whole_leaves_open():
    """Pushed along, the whole ends at a residual of 1e-4 after all means; in the half two are enough."""
    model = lb.structures.EXAMPLES["dome"](lb.PointContact(0.7))
    found = lb.nonassociated(model, means=MEANS[:2])
    assert found.how == "tracked path, barrier 0.02, power 2, seed 1, compliance faded first, in one half"
    assert lb.check_mcp(model, found).passed
    assert any("leave symmetry on the way" in remark for remark in found.remarks)
    assert any("compliance fades before the barrier" in remark for remark in found.remarks)
    assert found.load_factor <= found.associated * (1 + 1e-6)


def test_one_half_comes_after_the_first_path_and_only_of_what_is_symmetric():
    model = symmetric_facade()
    assert lb.nonassociated(model, means=SECOND).how.endswith("in one half")
    assert "half" not in lb.nonassociated(model).how  # the first path closes
    assert "half" not in lb.nonassociated(symmetric_facade(direction=(1.0, 1.0, 0.0)), means=SECOND).how


def test_of_a_large_model_one_half_comes_before_rounds(monkeypatch):
    model = symmetric_facade()
    monkeypatch.setattr(ways, "LARGE", len(model.free_blocks) - 1)
    monkeypatch.setattr(ways, "LARGE_MEANS", (SECOND[0], *LARGE_MEANS[1:]))
    found = lb.nonassociated(model)
    assert found.how.startswith("tracked path, small barrier, power 1, seed 1")
    assert found.how.endswith("in one half")
    assert lb.check_mcp(model, found).passed


@pytest.mark.parametrize(("share", "half"), [(1e-6, True), (1e-2, False)])
def test_a_half_that_is_just_above_the_tolerance_is_polished_in_the_whole(share, half, monkeypatch):
    lift = Planar.lifted

    def coarse(plane, state):
        up = lift(plane, state)
        return replace(up, x=(1.0 + share) * up.x)

    model = symmetric_facade()
    lb.bounds(model)  # known from now on
    monkeypatch.setattr(Planar, "lifted", coarse)
    found = lb.nonassociated(model, means=SECOND)
    assert found.how.endswith("in one half") is half
    assert lb.check_mcp(model, found).passed


def test_a_half_that_is_wrong_is_refused_and_the_whole_solved(monkeypatch):
    lift = Planar.lifted

    def broken(plane, state):
        up = lift(plane, state)
        return replace(up, x=1.001 * up.x)

    model = symmetric_facade()
    lb.bounds(model)  # known from now on
    monkeypatch.setattr(Planar, "lifted", broken)
    found = lb.nonassociated(model, means=SECOND)
    assert found.converged
    assert "half" not in found.how


HALVES = [
    ("dome, oculus", lb.OrdunaLourenco(0.6), (1, 0, 0)), ("dome, oculus", lb.OrdunaLourenco(0.6), (0, 1, 0)),
    ("dome", lb.PointContact(0.6), (0, 1, 0)), ("pavilion_vault", lb.OrdunaLourenco(0.6), (1, 0, 0)),
]  # fmt: skip


@pytest.mark.parametrize(
    ("opening", "seed", "sooner"), [(0.3, 0, True), (1.0, 0, False), (0.3, 1, False), (0.3, 2, False)]
)
def test_a_large_barrier_closes_sooner_with_a_share_of_it_where_joints_open_and_no_weights(
    opening, seed, sooner
):
    """Four halves in 286 factorisations; with the whole of it there 421, with random weights 353 to 374."""
    barrier, own, *_ = LARGE_MEANS[1]
    assert (barrier.opening, own) == (0.3, 0)
    one, taken = Means(replace(barrier, opening=opening), seed, 1000), []
    for name, joint, push in HALVES:
        model = replace(lb.structures.EXAMPLES[name](joint), live=lb.mass_proportional(push))
        flow, enclosing = flow_of(model, 0.0, "centroid")
        half = flow_in_plane(model, flow, flow.problem.compliance, None, half=True)
        power = load_scale(half.flow.problem, enclosing.associated) / len(half.flow.problem.blocks)
        _, (info,) = follow(half.flow, half.x0, half.weights, means=[one], power=power)
        assert info.closed
        taken.append(info.factorisations)
    assert (sum(taken) < 320) is sooner


@pytest.mark.parametrize(("seed", "one_answer"), [(REDUCED_MEANS[1].seed, True), (MEANS[1].seed, False)])
def test_a_square_vault_has_one_answer_along_both_sides(seed, one_answer):
    """The path with power 2; random weights would close one of the two halves alone, elsewhere."""
    found = []
    for direction in ((1, 0, 0), (0, 1, 0)):
        vault = lb.structures.EXAMPLES["pavilion_vault"](lb.PointContact(0.7))
        model = replace(vault, live=lb.mass_proportional(direction))
        flow, enclosing = flow_of(model, 0.0, "centroid")
        half = flow_in_plane(model, flow, flow.problem.compliance, None, half=True)
        power = load_scale(half.flow.problem, enclosing.associated) / len(half.flow.problem.blocks)
        means = [REDUCED_MEANS[1]._replace(seed=seed)]
        state, (info,) = follow(half.flow, half.x0, half.weights, means=means, power=power)
        found.append((info.closed, state.load_factor / flow.problem.units.live))
    (one, other), answers = zip(*found, strict=True)
    assert (one and other and answers[0] == pytest.approx(answers[1], rel=1e-6)) is one_answer


def test_a_half_that_is_interrupted_says_so(monkeypatch):
    seen = []

    def press(iteration):
        seen.append(iteration)
        if len(seen) == 6:
            raise KeyboardInterrupt

    with pytest.raises(lb.NotConverged, match="interrupted") as caught:
        lb.nonassociated(symmetric_facade(), means=SECOND, progress=press)
    assert caught.value.result.status is lb.results.Status.INTERRUPTED


def test_a_polish_that_is_interrupted_gives_the_end_of_the_path(monkeypatch):
    """Of a half that solves nothing in the whole: steps of least norm may take long."""

    def pressed(*_):
        raise KeyboardInterrupt

    lift, model = Planar.lifted, symmetric_facade()
    lb.bounds(model)  # known from now on
    monkeypatch.setattr(Planar, "lifted", lambda *half: replace(lift(*half), x=(1 + 1e-6) * lift(*half).x))
    monkeypatch.setattr(each_way, "pivoted", pressed)
    with pytest.raises(lb.NotConverged, match="interrupted") as caught:
        lb.nonassociated(model, means=SECOND)
    assert caught.value.result.how.endswith("in one half, interrupted")


def test_a_path_in_one_half_is_followed_where_the_whole_one_is_given_up():
    facade = lb.structures.EXAMPLES["facade"](lb.OrdunaLourenco(0.6))
    model = replace(facade, live=lb.mass_proportional((0.0, 1.0, 0.0)))
    found = lb.nonassociated(model, confirm=False)
    assert found.how.startswith("tracked path, small barrier, power 1, seed 1")
    assert found.how.endswith("in one half")


def test_of_what_one_half_leaves_open_the_whole_is_tried_by_increments_and_the_outer_loop(monkeypatch):
    """In one half neither is: the further paths of the whole come first."""
    model, stopped, tried = symmetric_facade(), SECOND[0], []

    def nothing(given):
        tried.append(len(given.flow.problem.live))
        return given.start, "nothing"

    monkeypatch.setattr(each_way.Given, "increments", nothing)
    monkeypatch.setattr(each_way.Given, "frozen", nothing)
    monkeypatch.setattr(each_way.Given, "closed_in_rounds", lambda given, *_: (given.start, "nothing"))
    assert not lb.nonassociated(model, means=(stopped, stopped), throw=False).converged
    assert tried == 2 * [len(model.problem.live)]

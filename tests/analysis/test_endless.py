"""Increments that end short of collapse: one push without end leads on, if not far."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import limitblocks as lb
from limitblocks import structures
from limitblocks.analysis.nonassociated import each_way, loaded
from limitblocks.analysis.nonassociated.loading import CLIMBS
from limitblocks.analysis.nonassociated.path_record import INTERRUPTED, UNSETTLED
from limitblocks.analysis.nonassociated.start import state_of
from limitblocks.problem import Flow


def wall():
    return structures.wall(lb.PointContact(0.65), length=1.6, courses=6)


def corner():
    return structures.corner(lb.OrdunaLourenco(0.6), length=1.6, return_length=1.6, courses=2)


def solution():
    """A problem and the state that solves it."""
    model = wall()
    found = lb.nonassociated(model)
    flow = Flow(model.problem)
    return flow, state_of(model, model.problem, found)


@pytest.mark.parametrize(("build", "budget"), [(wall, 300), (corner, 400)], ids=["in the plane", "in space"])
def test_a_push_without_end_leads_from_the_last_increment_to_a_collapse(build, budget, monkeypatch):
    model, short = build(), lb.settings.Settings(budget=budget)
    path, whole = lb.load_path(model, settings=short), lb.load_path(build())
    assert "then" not in whole.collapse.how
    assert path.collapse.how.startswith("increments of the load path, then ")
    assert lb.check_mcp(model, path.collapse).passed
    ends = path.steps[-2].load_factor
    said = f"have used up their {budget} factorisations"
    for remarks in (path.remarks, path.collapse.remarks):
        (remark,) = (one for one in remarks if said in one)
        assert f"they end at load factor {ends:.6g}, and one push without end" in remark
    assert path.collapse.load_factor == pytest.approx(ends, rel=loaded.FAR)
    assert path.collapse.load_factor == pytest.approx(whole.collapse.load_factor, rel=0.03)
    monkeypatch.setattr(loaded, "_ways", lambda *_: iter(()))
    with pytest.raises(lb.NotConverged, match="no solution") as caught:
        lb.load_path(build(), settings=short)
    assert said in str(caught.value.__notes__)


def test_increments_that_end_far_from_every_collapse_stay_open():
    """After 120 factorisations the load factor is .27; collapses are at .56."""
    with pytest.raises(lb.NotConverged):
        lb.load_path(wall(), settings=lb.settings.Settings(budget=120))


@pytest.mark.parametrize("softer", [1.0, 5.0])
def test_a_push_without_end_has_the_stiffness_of_the_increments(softer, monkeypatch):
    seen, model = [], corner()

    def ways(given, last):
        seen.append(given.flow.problem.compliance)
        yield given.start, "nothing"

    monkeypatch.setattr(loaded, "_ways", ways)
    short = lb.settings.Settings(budget=60)
    for stiffness in ((1e6, 1e6), (1e6, 1e6 / softer)):
        lb.load_path(model, stiffness=stiffness, settings=short, throw=False)
    ratio = seen[1] / seen[0]
    shear = abs(model.problem.resultants).T @ np.tile([1, 1, 0, 0, 0, 1], len(model.interfaces)) > 0
    assert ratio[shear] / ratio[~shear][0] == pytest.approx(softer)


def met(monkeypatch, *ends, began=True):
    """What `endless` takes of ends that are solutions, at these shares of the last load factor."""
    flow, state = solution()
    given = SimpleNamespace(flow=flow, tolerance=1e-6)
    monkeypatch.setattr(loaded, "mcp_residuals", lambda *_: SimpleNamespace(worst=SimpleNamespace(value=0.0)))
    tried = []

    def ways(*_):
        for share, how in ends:
            tried.append(how)
            yield replace(state, load_factor=share * state.load_factor), how

    monkeypatch.setattr(loaded, "_ways", ways)
    found = loaded.endless(given, state, began)
    return (None if found is None else found[1]), tried


def test_the_first_with_the_same_load_factor_is_taken(monkeypatch):
    assert met(monkeypatch, (1.05, "a"), (1.0005, "b"), (1.0, "c")) == ("b", ["a", "b"])


def test_else_the_nearest(monkeypatch):
    assert met(monkeypatch, (1.05, "a"), (0.98, "b"), (1.03, "c"))[0] == "b"


def test_but_none_that_is_far(monkeypatch):
    assert met(monkeypatch, (1.11, "a"), (0.89, "b"))[0] is None


def test_where_no_increment_began_it_is_the_first_however_far(monkeypatch):
    assert met(monkeypatch, (1.4, "a"), (1.05, "b"), began=False) == ("a", ["a"])


def test_nor_one_whose_load_factor_still_changes(monkeypatch):
    assert met(monkeypatch, (1.0, f"a, {UNSETTLED}"), (0.95, "b"))[0] == "b"


def test_nor_one_that_is_no_solution():
    flow, state = solution()
    given = each_way.Given(flow, state.x, 1.0, 1e-8, lambda _: None)
    moved = replace(state, x=1.001 * state.x)
    endless_ways = iter([(moved, "moved"), (state, "as it is")])
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(loaded, "_ways", lambda *_: endless_ways)
        assert loaded.endless(given, moved)[1] == "as it is"


def test_the_user_stops_it_unless_a_solution_is_known(monkeypatch):
    stopped = f"b, {INTERRUPTED}"
    assert met(monkeypatch, (1.05, "a"), (1.0, stopped)) == ("a", ["a", stopped])
    with pytest.raises(KeyboardInterrupt):
        met(monkeypatch, (1.2, "a"), (1.0, stopped))


def test_a_push_without_end_that_the_user_stops_leaves_the_increments():
    model = corner()

    def press(iteration):
        if iteration.kind == "path":
            raise KeyboardInterrupt

    with pytest.raises(lb.NotConverged, match="interrupted") as caught:
        lb.load_path(model, settings=lb.settings.Settings(budget=300), progress=press)
    assert caught.value.result.how == "increments of the load path, interrupted"


def test_loads_that_climb_without_limit_are_pushed_no_farther(monkeypatch):
    flow, state = solution()
    one = SimpleNamespace(start=state.x)
    monkeypatch.setattr(loaded, "pushed", lambda *_: ((one,), state, CLIMBS))
    monkeypatch.setattr(loaded, "endless", None)  # not asked for
    weights = flow.problem.compliance
    found = loaded.loaded(flow, state.x, weights, 1e-8, lb.settings.Settings(), 1.0, print, 1.0)
    assert (found.why, found.beyond) == (CLIMBS, False)


@pytest.mark.parametrize("joint", [lb.PointContact, lb.OrdunaLourenco])
@pytest.mark.parametrize("head", [0.0, 0.6])
def test_where_no_increment_begins_one_push_without_end_leads_from_the_permanent_loads(joint, head):
    """Two cubes on ice side by side, one of them lifted: nothing is strictly within yield between them."""
    stones = [lb.Block.box("ground", (6, 2, 0.2), (0, 0, -0.1))]
    stones += [lb.Block.box(f"cube {k}", (1, 1, 1), (k, 0, 0.5), 20e3) for k in range(2)]
    faces = [
        replace(one, joint=joint(0.0 if "ground" in (one.block_i, one.block_j) else head))
        for one in lb.find_interfaces(stones, joint(head))
    ]
    lift = lb.loads.force("cube 0", (0, 0, 10e3), (0, 0, 0.5))
    model = lb.Model(stones, ["ground"], faces, lb.self_weight(), lift)
    path = lb.load_path(model)
    assert path.load_factor == pytest.approx(2.0, rel=1e-8)  # 20 kN over 10 kN
    assert lb.check_mcp(model, path).passed
    assert any("one push without end" in said for said in path.remarks)
    assert str(path).count("one push without end") == 1

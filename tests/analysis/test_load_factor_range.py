"""The set of certified load factors of block models whose set is known in closed form."""

import json
from dataclasses import replace

import numpy as np
import pytest
from stones import pair
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks import structures
from limitblocks.analysis.load_factor_range import faces, search, wedging
from limitblocks.analysis.load_factor_range.answers import merged, remarks
from limitblocks.analysis.load_factor_range.exact import exact_extreme
from limitblocks.analysis.load_factor_range.mechanisms import Mechanisms
from limitblocks.analysis.load_factor_range.run import _task
from limitblocks.analysis.nonassociated.start import flow_of, state_of
from limitblocks.analysis.polish import defect
from limitblocks.analysis.programs import Solution
from limitblocks.cli import app
from limitblocks.evidence.range_answer import Origin
from limitblocks.evidence.residuals import TOLERANCE
from limitblocks.practice import dowel, reinforced
from limitblocks.problem import Flow, State, Turning

FEW = {"paths": 3, "mechanisms": 3}
ALONG = lb.mass_proportional((1, 0, 0))


def square(friction):
    return lb.PointContact(friction, cone="outer", sides=4)


def pair_range(behind, front, between):
    """Both slide; the joint between them, which does not, carries P and any V up to its friction.

    a = (m1 (1 + V) + m2 (1 - V)) / 2 and P = m2 (1 - V) - a, over the weight of a block, |V| <= m3 P.
    """
    total, less = behind + front, front - behind
    V = np.array([between * less / (2 + between * total), -between * less / (2 - between * total)])
    return (total - less * V) / 2


def jammed(more=(), live=ALONG):
    """A cube between floor and ceiling."""
    stones = [
        lb.Block.box("floor", (9.0, 1.0, 0.2), (3, 0, -0.1)),
        lb.Block.box("ceiling", (1.0, 1.0, 0.2), (0, 0, 1.1)),
        lb.Block.box("block", (1.0, 1.0, 1.0), (0, 0, 0.5), 20e3),
        *more,
    ]
    interfaces = lb.find_interfaces(stones, lb.PointContact(0.3))
    return lb.Model(stones, ["floor", "ceiling"], interfaces, lb.self_weight(), live)


@pytest.fixture(scope="module")
def pushed():
    return pair(*map(lb.PointContact, (0.2, 0.5, 0.6)))


@pytest.fixture(scope="module")
def of_pushed(pushed):
    return lb.load_factor_range(pushed, **FEW)


def test_pushed_pair_has_an_interval(of_pushed):
    found = of_pushed
    low, high = pair_range(0.2, 0.5, 0.6)
    assert found.certified == pytest.approx((low, high), rel=1e-6)
    assert found.intervals == (pytest.approx((low, high), rel=1e-6),)
    assert (low + high) / 2 in found
    assert high + 0.01 not in found
    assert low < found.reached[0] < found.reached[1] < high
    assert found.load_path.load_factor in found
    assert not found.wedging.wedged  # and still the load factor is not unique
    assert all(answer.check.passed for answer in found.answers)


def test_paths_of_a_planar_model_are_followed_in_its_plane(of_pushed):
    others = [one for one in of_pushed.answers if one.origin is Origin.REACHED]
    assert others
    assert all(one.solution.how.endswith("in the plane") for one in others)


def test_an_answer_off_the_load_path_is_reached_and_said_to_be_none_of_it(pushed, monkeypatch):
    """A path with a large barrier starts from the permanent loads, as those of the sampler do."""
    large = replace(lb.nonassociated(pushed), how="tracked path, barrier 3 (large barrier), power 2, seed 1")
    monkeypatch.setattr(search, "nonassociated", lambda *_, **__: large)
    found = lb.load_factor_range(pushed, paths=1, mechanisms=0)
    assert found.load_path.origin is Origin.REACHED
    assert found.reached[0] <= large.load_factor <= found.reached[1]
    assert "not that of the load path (tracked path, barrier 3" in str(found)


@pytest.mark.parametrize("answer", [0, -1])
def test_an_answer_is_saved_and_checked_again(answer, pushed, of_pushed, tmp_path):
    model, one = pushed, of_pushed.answers[answer]
    file = lb.files.write_result(one.solution, tmp_path / "answer.json")
    assert lb.check_mcp(model, lb.read_result(file, model)).passed
    claim = replace(lb.read_result(file, model), load_factor=1.01 * one.load_factor)
    assert not lb.check_mcp(model, claim).passed


def test_values_between_two_answers_of_a_mechanism_are_answers(pushed):
    """Convexity: the mean of the stresses of both ends, with the mechanism of the one path."""
    found = lb.load_factor_range(pushed, paths=1, mechanisms=0)
    low, high = (answer.solution for answer in (found.answers[0], found.answers[-1]))
    mean = [
        (getattr(low, name) + getattr(high, name)) / 2
        for name in ("load_factor", "stress_resultants", "generalised_stresses")
    ]
    claim = lb.results.Claim(
        mean[0], mean[1], high.displacement_rates, high.flow_multipliers, generalised_stresses=mean[2]
    )
    assert lb.check_mcp(pushed, claim).passed


def test_a_jammed_block_has_no_greatest_load_factor():
    """mu (1 + 2 P/W) for every force P of the ceiling, as long as it does not turn about a corner."""
    found = lb.load_factor_range(jammed(), paths=2, mechanisms=0)
    assert found.unlimited
    assert found.wedging.wedged
    assert set(found.wedging.interfaces) == {i.name for i in jammed().interfaces}
    assert found.certified[1] == np.inf
    assert 0.3 * (1 - 1e-6) <= found.certified[0] < 0.5
    assert found.answers[-1].load_factor > 1.0
    assert found.answers[-1].check.passed


def test_what_stands_beside_a_wedged_block_is_not_wedged():
    aside = lb.Block.box("aside", (1.0, 1.0, 1.0), (4, 0, 0.5), 20e3)
    found = wedging.wedging(jammed([aside]).problem)
    assert set(found.interfaces) == {"floor|block", "ceiling|block"}


def test_drawn_mechanisms_find_what_no_path_leads_to():
    """Wedged at a corner of floor and ceiling, the cube turns about it at no load: nothing slips there.

    W b/2 about both axes is balanced by the friction of the wedging force P, up to mu P h.
    """
    model = jammed()
    found = lb.load_factor_range(model, paths=1, mechanisms=4)
    assert found.certified[0] == pytest.approx(0.0, abs=1e-6)
    assert found.answers[0].check.passed
    assert found.answers[0].thrust == pytest.approx(0.0, abs=1e-6)
    assert found.reached[0] >= 0.3 * (1 - 1e-6)
    flow, _ = flow_of(model, 0.0, Turning.CENTROID)
    rays = [faces.ray(flow, state_of(model, flow.problem, one.solution)) for one in found.answers[:2]]
    assert rays[0] is None  # what wedges it at a corner carries no thrust
    assert flow.problem.C.T @ rays[1] == pytest.approx(flow.problem.live, abs=1e-8)


def test_no_mechanism_and_no_stresses_to_begin_with(pushed):
    flow, _ = flow_of(pushed, 0.0, Turning.CENTROID)
    most = lb.bounds(pushed).upper * flow.problem.units.live
    drawn = Mechanisms(flow, (1.1 * most, 1.2 * most), 0)  # nothing within yield
    assert drawn.solution() is None
    drawn._chain = lambda: np.zeros(0, dtype=int)  # no block moves
    assert drawn.solution() is None


@pytest.mark.parametrize(("rough", "certified"), [(1e-5, True), (10.0, False)])
def test_an_end_that_a_solver_leaves_rough_is_polished(rough, certified, pushed, of_pushed, monkeypatch):
    flow, _ = flow_of(pushed, 0.0, Turning.CENTROID)
    a, x, u, y = vars(state_of(pushed, flow.problem, of_pushed.load_path.solution)).values()
    off = rough * np.random.default_rng(0).normal(size=len(x))
    monkeypatch.setattr(faces, "answers", lambda *_: [Solution("none", "solved", (), ())])
    found = faces.proven(flow, None, lambda: (a, x + off, u, y))
    assert defect(flow, State(a, x + off, u, y)) > TOLERANCE
    assert (found is not None) == certified
    assert found is None or defect(flow, found) <= TOLERANCE


def test_whether_it_can_be_wedged_is_undecided_where_no_solver_answers(pushed, monkeypatch):
    nothing = Solution("none", "failed", (np.full(pushed.problem.C.shape[0], np.nan),), ())
    monkeypatch.setattr(wedging, "solved", lambda *_: nothing)
    with pytest.raises(lb.errors.SolverFailure, match="whether the structure can be wedged is undecided"):
        wedging.wedging(pushed.problem)


def test_a_structure_that_can_be_wedged_may_have_one_load_factor():
    """The cube jams, and the block beside it, alone pushed, slides at mu."""
    beside = lb.Block.box("beside", (1.0, 1.0, 0.5), (4, 0, 0.25), 20e3)
    push = lb.loads.force("beside", (10e3, 0, 0), at=(4, 0, 0.25))
    found = lb.load_factor_range(jammed([beside], push), paths=1, mechanisms=3)
    assert found.wedging.wedged
    assert found.certified == pytest.approx((0.3, 0.3), rel=1e-6)
    origins = [answer.origin for answer in found.answers]
    assert len(set(origins)) == len(origins)  # one number is one answer, though its last digits differ
    assert not found.unlimited


def test_exact_programs_agree_with_closed_forms_and_search():
    """A groove of 60 degrees on each side, friction in squares: mu / (sin w +- mu cos w)."""
    mu, w = 0.5, np.pi / 3
    model = structures.wedge(square(mu), half_angle=w)
    found = lb.load_factor_range(model, exact=True, paths=1, mechanisms=0)
    for extreme, sign, value in zip((found.least, found.greatest), (1, -1), found.certified, strict=True):
        expected = mu / (np.sin(w) + sign * mu * np.cos(w))
        assert extreme.proven
        assert extreme.load_factor == pytest.approx(expected, rel=1e-6)
        assert value == pytest.approx(expected, rel=1e-6)
    assert "(proven)" in str(found)


def test_what_exact_programs_find_is_certified_too():
    """Pushed askew the pair carries the associated load factor, beyond which there is none; paths less."""
    model = replace(pair(square(0.4), square(1.0), square(1.0)), live=lb.mass_proportional((0.8, 0.6, 0)))
    task = _task(model, *flow_of(model, 0.0, Turning.CENTROID), None)
    search.walked(task, 1, 0, np.inf)
    unit, most = task.flow.problem.units.live, lb.bounds(model).upper
    assert task.collected.greatest.state.load_factor / unit < 0.95 * most
    found = search.extreme(task, -1.0, 60.0)
    assert found.proven
    assert found.load_factor == pytest.approx(most, rel=1e-6)
    assert task.collected.greatest.state.load_factor / unit == pytest.approx(most, rel=1e-6)


def test_exact_programs_end_no_earlier_than_the_certified_answers(monkeypatch):
    """A program without a solution leaves what the paths found."""
    model = structures.wedge(square(0.5), half_angle=np.pi / 3)
    exact = search.exact_extreme
    monkeypatch.setattr(search, "exact_extreme", lambda *given: exact(*given)._replace(state=None))
    found = lb.load_factor_range(model, exact=True, paths=1, mechanisms=0)
    assert (found.least.load_factor, found.greatest.load_factor) == found.certified


def test_exact_programs_pass_over_solutions_below_zero():
    """Stone one slides at 0.6; two, pushed aside by W / 4, only if lifted: mu (1 + 2 a) = 1/4 + a / 2."""
    W, mu = 20e3, 0.5
    stones = [lb.Block.box("floor", (6.0, 1.0, 0.2), (0, 0, -0.1))]
    stones += [
        lb.Block.box(name, (1.0, 1.0, 0.4), (x, 0, 0.2), W / 0.4) for name, x in (("one", -1.5), ("two", 1.5))
    ]
    dead = lb.self_weight() + lb.loads.force("two", (W / 4, 0, 0), at=(1.5, 0, 0))
    live = lb.loads.force("one", (W * mu / 0.6, 0, 0), at=(-1.5, 0, 0))
    live += lb.loads.force("two", (W / 2, 0, -2 * W), at=(1.5, 0, 0))
    model = lb.Model(stones, ["floor"], lb.find_interfaces(stones, square(mu)), dead, live)
    task = _task(model, *flow_of(model, 0.0, Turning.CENTROID), None)
    search.drawn(task, 20, 0, np.inf)
    unit = task.flow.problem.units.live
    assert task.collected.least.state.load_factor / unit == pytest.approx((1 / 4 - mu) / (2 * mu - 1 / 2))
    for sense in (1.0, -1.0):
        found = search.extreme(task, sense, 60.0)
        assert found.proven
        assert found.load_factor == pytest.approx(0.6)


def test_exact_programs_are_refused_for_round_friction():
    with pytest.raises(lb.ModelError, match="exact=True needs joints of planes"):
        lb.load_factor_range(structures.block(lb.PointContact(0.3), width=1.0, height=0.5), exact=True)


def test_a_dowel_is_named_where_exact_programs_are_refused():
    """Its strength is the same in all directions, whatever the joints are."""
    own = structures.block(square(0.3), width=1.0, height=0.5)
    pin = dowel(own.interfaces[0], own.interfaces[0].centroid.tolist(), diameter=0.02, capacity=1e3)
    with pytest.raises(lb.ModelError, match="dowels"):
        lb.load_factor_range(reinforced(own, pin), exact=True)


def test_numbers_out_of_range_are_refused():
    with pytest.raises(lb.ModelError, match="paths is 0"):
        lb.load_factor_range(jammed(), paths=0)


def test_an_exact_program_without_time_has_no_bound():
    model = structures.wedge(square(0.5), half_angle=np.pi / 3)
    found = exact_extreme(Flow(model.problem), (0.0, np.inf), 1.0, 1e-9)
    assert found.state is None
    assert found.bound == -np.inf


def test_the_time_limit_leaves_what_there_is():
    found = lb.load_factor_range(structures.ferris_tin_loi_wall(1, lb.PointContact(0.65)), time_limit=1e-3)
    assert not found.complete
    assert found.load_path is None
    assert np.isnan(found.reached).all()
    assert "nothing reached from permanent-load states; nothing certified" in str(found)
    assert "stopped early, by the time limit or by hand" in str(found)


def test_with_table_5_there_are_paths_alone():
    model = structures.block(lb.OrdunaLourenco(0.3), width=1.0, height=0.5)
    found = lb.load_factor_range(model, turning="centre of pressure", paths=2)
    assert found.turning is Turning.PRESSURE
    assert found.mechanisms == (0, 0)
    assert "paths alone" in str(found)
    assert found.certified == pytest.approx((0.3, 0.3), rel=1e-6)


def test_few_blocks_at_low_thrust_are_named(of_pushed):
    assert not any(answer.local for answer in of_pushed.answers)
    local = replace(of_pushed.answers[0], share=0.02, thrust=0.1)
    assert local.mechanism.startswith("few blocks at low thrust, behind, front")
    assert not replace(local, share=0.5).local
    assert not replace(local, thrust=0.9).local


def test_a_report_tells_the_three_ranges_apart(pushed, of_pushed):
    text = lb.report(pushed, of_pushed).markdown
    for part in ("load factor α of the load path", "Reached", "Certified", "every value solves"):
        assert part in text
    jsonschema = pytest.importorskip("jsonschema")
    document = json.loads(lb.report(pushed, of_pushed).json)
    jsonschema.validate(document, lb.files.report_schema())


def test_intervals_that_touch_are_one():
    intervals = [(3, 4), (0, 1), (1, 2), (0, 0.5), (2.25, 2.5)]
    assert merged(intervals, 0.0) == [(0, 2), (2.25, 2.5), (3, 4)]
    assert merged(intervals, 0.25) == [(0, 2.5), (3, 4)]


def test_the_command_prints_the_three_ranges(pushed, tmp_path):
    file, output = pushed.save(tmp_path / "pair.json"), tmp_path / "range.json"
    options = ["--paths", "1", "--mechanisms", "0", "--output", str(output)]
    done = CliRunner().invoke(app, ["range", str(file), *options])
    assert done.exit_code == 0, done.output
    for part in ("Reached", "Certified", "Certified load factors"):
        assert part in done.stdout
    assert json.loads(output.read_text())["analysis"] == "range"
    done = CliRunner().invoke(app, ["check", str(file), str(output)])
    found = lb.read_result(output, pushed)
    assert (done.exit_code, done.stdout.count("load factor ")) == (0, len(found.answers))
    with pytest.raises(lb.ModelError, match=r"LoadFactorRange has no load_factor.*one of its answers"):
        lb.check_mcp(pushed, found)


def test_what_the_answer_and_both_ends_remark_is_said_once(pushed, of_pushed):
    def remarking(*said):
        one = of_pushed.answers[0]
        return replace(one, check=replace(one.check, remarks=said))

    first, ends = remarking("of the answer"), [remarking("of an end"), remarking("of an end", "too")]
    said = remarks(Flow(pushed.problem), first, ends)
    assert said[-3:] == ("of the answer", "of an end", "too")

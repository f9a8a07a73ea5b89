import json
import re
from dataclasses import replace

import numpy as np
import pytest
from stones import model_of, portal_stones

import limitblocks as lb
from limitblocks.evidence.backward_error import unknown
from limitblocks.evidence.ending import Status
from limitblocks.evidence.load_path_result import LoadPath, PathStep
from limitblocks.evidence.results import Iteration, Nonassociated
from limitblocks.problem import Turning
from limitblocks.reports import curve
from limitblocks.reports.rows import backward, comparison
from limitblocks.reports.sections import section
from limitblocks.reports.terminal import print_result
from limitblocks.reports.words import at_most


def portal(name="lintel"):
    blocks = portal_stones("left <leg>", name)
    return model_of(blocks, ["ground"], lb.OrdunaLourenco(0.6))


MODEL = portal()
BOUNDS = lb.bounds(MODEL)
STATE = ("stress_resultants", "generalised_stresses", "displacement_rates", "flow_multipliers", "residuals")
STATE += ("dead_load_stresses",)
RESULT = Nonassociated(
    load_factor=0.2412345678,
    frictionless=0.125,
    associated=0.25,
    backward_error=lb.check_mcp(MODEL, BOUNDS).backward_error,
    status=Status.CONVERGED,
    how="tracked path",
    history=(Iteration(0.25, "step", 1.0, {"flow": 1e-9}, 1, 0),),
    dilatancy=0.0,
    turning=Turning.CENTROID,
    remarks=(),
    tolerance=1e-8,
    digest=MODEL.digest,
    **{name: getattr(BOUNDS, name) for name in STATE},
)


def load_path(loads=(0.0, 0.1, 0.26, 0.2412345678), scale=1.0, end=RESULT):
    rates = 1e3 * scale * end.displacement_rates
    steps = [
        PathStep(load, end.stress_resultants, k * rates, (), {"equilibrium": 1e-9, "yield": 2e-9}, "step")
        for k, load in enumerate(loads)
    ]
    active = tuple((f"a{k}|b", "hinging") for k in range(6))
    steps[-1] = replace(steps[-1], active=active)
    return LoadPath(tuple(steps), end)


PATH = load_path()
CHECK = lb.check_mcp(MODEL, RESULT)


def words(html):
    return " ".join(re.sub(r"<[^>]+>", " ", html).split())


def test_every_result_has_its_section_and_one_mechanism_is_drawn():
    html = lb.report(MODEL, BOUNDS, RESULT, PATH, CHECK).html
    text = words(html)
    for part in (
        "Associated bounds",
        "Non-associated solution",
        "Load path",
        "Check",
        "0.2412346",
        "Peak 0.2600000",
        "do not lift",
        "a3|b hinging and 2 more",
        "worst residual",
        "is not unique",
        "Displacements before collapse are relative to the compliance of the joints",
    ):
        assert part in text, part
    assert html.count('class="moving"><title>') > 0
    assert html.count('<svg class="mechanism"') == 1
    drawing = html.index('<svg class="mechanism"')
    assert html.index('id="viewer"') < drawing < html.index("<h2>Side by side")  # where the picture is
    assert re.findall('<svg class="([a-z]+)"', html) == ["mechanism", "views", "curve"]
    assert "left <leg>" not in html


def test_answers_stand_side_by_side_with_what_they_mean():
    rows = comparison(lb.report(MODEL, BOUNDS, RESULT, PATH, CHECK).sections)
    values = {name: value for name, value, _ in rows}
    assert values == {
        "Frictionless": "0.1250000",
        "Non-associated": "0.2412346",
        "Load path": "0.2412346",
        "Associated": at_most(BOUNDS.upper),  # no solution is higher
    }
    assert list(values) == ["Frictionless", "Non-associated", "Load path", "Associated"]
    assert comparison(lb.report(MODEL, BOUNDS, CHECK).sections) == ()
    assert "Side by side" not in lb.report(MODEL, BOUNDS).html
    content = json.loads(lb.report(MODEL, RESULT).json)
    (side,) = [one for one in content["chapters"] if one["title"] == "Side by side"]
    rows = side["parts"][0]["table"]["rows"]
    assert [row[0] for row in rows] == ["Frictionless", "Non-associated", "Associated"]


def test_every_solution_stands_side_by_side():
    """The second of a kind was left out, so that the load factor to design with could be missing."""
    lifting = replace(RESULT, dilatancy=0.3, load_factor=0.245)
    other = replace(RESULT, load_factor=0.22)
    report = lb.report(MODEL, lifting, RESULT, other, RESULT, load_path(end=lifting))
    names, values, _ = zip(*comparison(report.sections), strict=True)
    assert names == (
        *("Frictionless", "Non-associated, dilatancy 0.3", "Non-associated", "Non-associated"),
        *("Load path, dilatancy 0.3", "Associated"),
    )
    assert values == ("0.1250000", "0.2450000", "0.2412346", "0.2200000", "0.2450000", "0.2500000")


def test_limits_that_a_file_says_give_way_to_those_computed():
    """The least and the most of a file, which nothing checks, took the place of proven ones."""
    read = replace(RESULT, from_file=True, frictionless=0.2, associated=0.9)
    for others in ((read, RESULT, BOUNDS), (BOUNDS, read, RESULT), (RESULT, read)):
        values = {name: value for name, value, _ in comparison([section(MODEL, one) for one in others])}
        assert (values["Frictionless"], values["Associated"][:6]) == ("0.1250000", "0.2500")
    alone = {name: row for name, *row in comparison([section(MODEL, read)])}
    assert alone["Associated"] == ["0.9000000", "as the file says, not computed here"]


def test_missing_limits_are_said_in_words():
    why = "without friction the dead loads do not stand"
    result = replace(RESULT, frictionless=np.nan, unclaimed=why, associated=np.inf)
    report = lb.report(MODEL, result)
    text = words(report.html)
    assert f"Frictionless not claimed {why}" in text
    assert "Associated unlimited dilating joints jam" in text
    content = json.loads(report.json, parse_constant=pytest.fail)
    assert content["results"][0]["associated"] is None


def test_a_lower_end_that_is_no_theorem_is_not_claimed(capsys):
    """In every format, and beside a result that has one."""
    why = "with this turning a joint can give power"
    turned = replace(RESULT, turning=Turning.PRESSURE, frictionless=np.nan, unclaimed=why)
    for results in ((RESULT, turned), (turned, RESULT), (load_path(end=turned),)):
        rows = {
            name: (value, meaning) for name, value, meaning in comparison(lb.report(MODEL, *results).sections)
        }
        assert rows["Frictionless"] == ("not claimed", why)
    report = lb.report(MODEL, turned)
    assert f"Frictionless not claimed {why}" in words(report.html)
    assert f"| Frictionless | not claimed | {why} |" in report.markdown
    content = json.loads(report.json)
    assert (content["results"][0]["frictionless"], content["results"][0]["unclaimed"]) == (None, why)
    print_result(MODEL, turned)
    assert re.search(r"Frictionless +not claimed", capsys.readouterr().out)
    print_result(MODEL, RESULT)
    assert "not claimed" not in capsys.readouterr().out + words(lb.report(MODEL, RESULT).html)


def test_what_did_not_converge_is_not_sold_as_a_solution():
    stalled = replace(RESULT, status=Status.OUT_OF_STEPS, tolerance=1e-12)
    for made in (stalled, load_path(end=stalled)):
        text = words(lb.report(MODEL, made).html)
        assert "not converged, so not proven" in text
        assert Status.OUT_OF_STEPS.value in text
        assert "do not yet satisfy" in text or "is not yet a collapse" in text
        assert "no load factor to design with" in text


def test_failed_check_is_told_apart():
    failed = lb.check_mcp(MODEL, replace(RESULT, load_factor=0.26))
    html = lb.report(MODEL, failed).html
    assert '<span class="number">failed</span>' in html
    assert 'class="fail">FAIL' in html


def test_results_of_other_models_are_refused():
    for result in (RESULT, PATH):
        with pytest.raises(lb.LimitBlocksError, match="belongs to model"):
            lb.report(portal("beam"), result)
    with pytest.raises(
        lb.LimitBlocksError,
        match=r"expected a result: Adequacy, Bounds, CapacityCurve, Check, .*, Nonassociated",
    ):
        lb.report(MODEL, "result")


def test_curve_goes_through_every_step():
    drawn = curve.path_curve(MODEL, PATH)
    assert "along X, m" in drawn.x_label
    assert len(drawn.dots) == len(PATH.steps)
    y = np.array([dot[1] for dot in drawn.dots])
    loads = np.array([step.load_factor for step in PATH.steps])
    assert np.allclose(np.diff(y), -np.diff(loads) / 0.26 * 280.0, atol=0.2)  # 280 units high
    assert drawn.dots[0][:2] == (110.0, 300.0)
    for ticks in (drawn.x_ticks, drawn.y_ticks):
        assert 3 <= len(ticks) <= 11
    assert [tick.text for tick in drawn.y_ticks][:3] == ["0", "0.05", "0.1"]


def test_convergence_is_drawn_by_decades():
    worst = (1.0, 1e-2, 3e-5, 1e-8)
    stages = [Iteration(0.2, "step", 1.0, {"flow": one, "yield": one / 10}, 1, 0) for one in worst]
    drawn = curve.convergence_curve(stages)
    y = np.array([dot[1] for dot in drawn.dots])
    assert np.allclose(y, 20.0 - np.log10(worst) / 8 * 280.0, atol=0.1)  # 280 units high, from 1e0 to 1e-8
    assert [tick.text for tick in drawn.y_ticks] == [f"1e{k}" for k in range(-8, 1)]
    assert [tick.text for tick in drawn.x_ticks] == ["0", "1", "2", "3", "4"]
    assert curve.convergence_curve(stages[:1]) is None
    assert curve.convergence_curve([replace(one, residuals={}) for one in stages]) is None
    report = lb.report(MODEL, replace(RESULT, history=tuple(stages)))
    assert "Largest residual of each step" in report.html
    points = [Iteration(0.2, "path", one, {"theta": one}, 1, 0) for one in worst]
    tracked = curve.convergence_curve(points)
    assert tracked.title.startswith("Theta along the path")
    assert tracked.y_label == "theta"
    assert tracked.dots[1][2] == "stage 2, path: theta 1.0e-02"


def test_curve_falls_back_on_steps_and_needs_two():
    assert curve.path_curve(MODEL, load_path(scale=0.0)).x_label == "step"
    assert curve.path_curve(MODEL, load_path((0.0,))) is None
    flat = curve.path_curve(MODEL, load_path((0.0, 0.0)))
    assert all(np.isfinite(dot[:2]).all() for dot in flat.dots)
    back = curve.path_curve(MODEL, load_path(scale=-1.0))
    assert {tick.text for tick in back.x_ticks} >= {"0"}
    assert "<svg" in lb.report(MODEL, load_path((0.0,))).html


def test_a_figure_says_once_what_is_dashed():
    """Its text and its caption said so both, which Markdown and the terminal print one after the other."""
    block = lb.structures.block(lb.PointContact(0.6), width=0.4, height=1.0)
    assert lb.report(block, lb.bounds(block)).text.count("Dashed") == 1


def test_a_backward_error_that_was_not_found_claims_no_model():
    """It said: inf, exact for a model changed by as much."""
    assert backward(unknown())[1:] == ("inf", "no changed model was found of which this state is exact")


def test_a_range_without_an_answer_says_none():
    model = lb.structures.block(lb.PointContact(0.5), width=1.0, height=1.0)
    found = replace(lb.load_factor_range(model, paths=1, mechanisms=0), answers=(), load_path=None)
    said = lb.report(model, found).text
    assert re.search(r"Certified +none", said)
    assert re.search(r"Reached +none", said)
    assert "nan" not in said

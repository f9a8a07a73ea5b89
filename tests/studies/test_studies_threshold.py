"""Least and largest values for which the loads stand, against closed forms."""

import json

import numpy as np
import pytest

import limitblocks as lb
from limitblocks import studies
from limitblocks.analysis.stability import standing_margin
from limitblocks.studies import threshold as searched

GAMMA, H, PUSH = 20e3, 2.0, 4e3


def wall(width, push=PUSH, joint=None):
    blocks = [
        lb.Block.box("ground", (9, 5, 0.2), (0, 0, -0.1)),
        lb.Block.box("wall", (width, 1, H), (0, 0, H / 2), GAMMA),
    ]
    interfaces = lb.find_interfaces(blocks, joint or lb.PointContact(5.0))
    dead = lb.self_weight() + lb.loads.force("wall", (push, 0, 0), (0, 0, H / 2))
    return lb.Model(blocks, ["ground"], interfaces, dead, lb.mass_proportional((1, 0, 0)))


def test_least_width_of_a_pushed_wall():
    """gamma b h b / 2 = P h / 2: b = sqrt(P / gamma)."""
    threshold = studies.minimum(wall, 0.1, 2.0, parameter="width")
    low, high = threshold.bracket
    assert high - low <= threshold.tolerance == pytest.approx(1.9e-6)
    assert threshold.value == threshold.stands == high
    assert low - 2e-6 <= np.sqrt(PUSH / GAMMA) <= high + 2e-6
    assert len(threshold.trials) < 25  # a smooth margin: not twenty halvings and two ends


def test_least_width_with_a_load_factor():
    """gamma b h b / 2 = (P + a gamma b h) h / 2: b^2 - a h b - P / gamma = 0."""
    a = 0.1
    threshold = studies.minimum(wall, 0.1, 2.0, load_factor=a)
    width = (a * H + np.sqrt((a * H) ** 2 + 4 * PUSH / GAMMA)) / 2
    assert threshold.value == pytest.approx(width, abs=4e-6)
    assert lb.bounds(wall(width)).lower == pytest.approx(a, rel=1e-4)


def test_largest_push():
    threshold = studies.maximum(lambda push: wall(1.0, push), 0.0, 1e6, parameter="push", tolerance=1.0)
    assert threshold.value == pytest.approx(GAMMA, abs=2.0)
    assert threshold.stands < threshold.falls
    assert "push" in str(threshold)


def test_ends_of_the_bracket_stand_and_fall():
    threshold = studies.minimum(wall, 0.1, 2.0, tolerance=1e-3)
    lb.bounds(wall(threshold.stands))
    with pytest.raises(lb.errors.NoEquilibrium):
        lb.bounds(wall(threshold.falls))


def test_both_ends_are_told_apart_as_text():
    found = studies.Threshold("width", 1.0672131, 1.0672124, 1e-6, 0.0, ())
    assert "width 1.0672131 stands, 1.0672124 falls" in str(found)
    assert "push 0.3 stands, 0.4 falls" in str(studies.Threshold("push", 0.3, 0.4, 0.1, 0.0, ()))


def test_sliding():
    """mu gamma b h = P."""
    mu = 0.3
    threshold = studies.minimum(lambda b: wall(b, joint=lb.OrdunaLourenco(mu)), 0.05, 2.0)
    assert threshold.value == pytest.approx(max(PUSH / (mu * GAMMA * H), np.sqrt(PUSH / GAMMA)), abs=1e-5)


def test_margin_of_a_pushed_wall():
    """Low friction: V <= mu N decides."""
    mu = 0.3
    for push in (0.0, 6e3, 11e3, 14e3):
        model = wall(1.0, push, joint=lb.PointContact(mu))
        margin = standing_margin(model)
        assert np.sign(margin) == np.sign(mu * GAMMA * H - push)


def test_margin_has_no_units():
    """The same structure, three times as large and of stone seven times as heavy, has the same margin."""
    small = wall(0.7)
    blocks = [lb.Block(b.name, 3 * b.vertices, b.faces, 7 * (b.unit_weight or 0.0)) for b in small.blocks]
    dead = lb.self_weight() + lb.loads.force("wall", (27 * 7 * PUSH, 0, 0), (0, 0, 3 * H / 2))
    large = lb.Model(blocks, ["ground"], lb.find_interfaces(blocks, lb.PointContact(5.0)), dead, small.live)
    assert standing_margin(large) == pytest.approx(standing_margin(small), rel=1e-6)


def test_margin_is_continuous_across_the_threshold():
    width = np.sqrt(PUSH / GAMMA)
    margins = np.array([standing_margin(wall(width * (1 + s))) for s in (-1e-4, -1e-6, 0.0, 1e-6, 1e-4)])
    assert (np.diff(margins) > 0).all()
    assert np.abs(margins).max() < 1e-3


def test_frictionless_joints_have_no_margin_but_yes_and_no():
    for push, stands in ((0.0, True), (1.0, False)):
        margin = standing_margin(wall(1.0, push, joint=lb.OrdunaLourenco(0.0)))
        assert (margin >= 0.0) is stands
    assert margin == -1.0


def test_numbers_and_csv(tmp_path):
    tried = []
    threshold = studies.minimum(wall, 0.1, 2.0, parameter="width", tolerance=1e-2, progress=tried.append)
    assert tried == [value for value, _ in threshold.trials]
    rows = threshold.rows()
    stands = [row["stands"] for row in rows]
    assert stands == sorted(stands)
    assert len(threshold.table().splitlines()) == 1 + len(rows)
    assert threshold.write_csv(tmp_path / "a.csv").read_text().splitlines()[0] == "width,margin,stands"
    written = json.loads(lb.files.write_result(threshold, tmp_path / "a.json").read_text())
    assert written["bracket"] == list(threshold.bracket)


@pytest.mark.parametrize(
    ("low", "high", "more", "said"),
    [
        (1.0, 2.0, {}, "at low, value = 1, the loads stand"),
        (0.1, 0.2, {}, "at high, value = 0.2, the loads fall"),
        (2.0, 1.0, {}, "low < high"),
        (0.1, np.inf, {}, "low < high"),
        (-1.0, 2.0, {}, "value = -1"),
        (0.1, 2.0, {"tolerance": 0.0}, "tolerance is 0.0"),
        (0.1, 2.0, {"tolerance": np.nan}, "tolerance is nan"),
    ],
)
def test_wrong_search_is_refused(low, high, more, said):
    with pytest.raises(lb.ModelError, match=said):
        studies.minimum(wall, low, high, **more)


def test_a_maker_that_gives_no_model_is_told():
    with pytest.raises(lb.ModelError, match="value = 1: model is a float, expected a Model"):
        lb.studies.minimum(lambda value: value, 1, 2)


def least_of(monkeypatch, margin, **given):
    """The least value from 0 to 1 that stands by `margin`, which remarks the value that it is of."""
    tried, model = [], wall(1.0)
    monkeypatch.setattr(
        searched, "remarked_margin", lambda *_: (margin(tried[-1]), (f"remark of {tried[-1]:g}",))
    )
    return studies.minimum(lambda _: model, 0.0, 1.0, progress=tried.append, **given)


def test_what_lacks_less_than_the_tolerance_of_residuals_stands(monkeypatch):
    """From .3 on 5e-9 are missing, of 1e-8; what is remarked is of the safe end."""
    found = least_of(monkeypatch, lambda value: -1.0 if value < 0.3 else -5e-9, tolerance=0.01)
    assert found.falls < 0.3 <= found.stands
    assert [row["stands"] for row in found.rows()] == [row["value"] >= 0.3 for row in found.rows()]
    assert found.remarks == (f"remark of {found.stands:g}",)


def test_no_least_value_where_more_falls_again(monkeypatch):
    """It stands from .4 to .5 and from .65 on: .4 is no value from which on it does."""

    def margin(value):
        return 1.0 if 0.4 <= value < 0.5 or value >= 0.65 else -1.0

    with pytest.raises(lb.errors.SolverFailure, match="standing and falling change more than once"):
        least_of(monkeypatch, margin, tolerance=0.4)

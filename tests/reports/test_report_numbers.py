"""Numbers of reports: rounded to the safe side, and compared with a demand."""

from dataclasses import replace

import pytest
from stones import model_of, portal_stones

import limitblocks as lb
from limitblocks.reports import terminal
from limitblocks.reports.answer import Answer, verdict
from limitblocks.reports.words import at_least, at_most


def test_large_numbers_are_never_rounded_up(capsys):
    """A block slides at its friction coefficient: .47789 is no .4779, nor 4.6866 m/s² 4.687; .5 stays .5."""
    for friction, said, pushed, most in (
        (0.47789, "0.4778", "4.686", "0.4779 g = 4.687"),
        (0.5, "0.5000", "4.903", "0.5000 g = 4.904"),
    ):
        stone = [
            lb.Block.box("ground", (3, 1, 1), (0, 0, -0.5)),
            lb.Block.box("stone", (2, 1, 1), (0, 0, 0.5), 2e4),
        ]
        model = model_of(stone, ["ground"], lb.OrdunaLourenco(friction))
        solved = lb.nonassociated(model)
        made = lb.report(model, solved, demand=2 * friction)
        assert made.to_dict()["chapters"][0]["parts"][0]["headline"]["number"] == said
        assert f"{said} g = {pushed} m/s²" in " ".join(made.text.split())
        assert f"the load factor {said} is" in made.text
        upper = " ".join(lb.report(model, lb.bounds(model), demand=2 * friction).text.split())
        assert f"≤ {most[:6]} load factor" in upper  # what nothing exceeds is not said to be less
        assert f"{most} m/s²" in upper
        assert f"upper estimate of the load factor {most[:6]} is" in upper
        terminal.print_result(model, solved)
        assert capsys.readouterr().out.split()[0] == said


def test_forces_that_cancel_have_no_resultant_and_no_arrow():
    """100.1 + 200.2 - 300.3 is -5.7e-14 in a computer, which was told as 5.7e-17 kN along -X."""
    model = model_of(portal_stones(), ["ground"], lb.OrdunaLourenco(0.6))
    pushes = {"left": 100.1, "right": 200.2, "lintel": -300.3}
    live = sum(lb.loads.force(name, (push, 0, 0), (0, 0, 1)) for name, push in pushes.items())
    assert live.on(model.free_blocks)[:, 0].sum() != 0.0  # a control
    balanced = replace(model, live=live)
    report = lb.report(balanced, lb.bounds(balanced))
    assert report.facts["live_resultant"] == "no resultant force"
    assert report.scene["live"] is None
    assert [name for name, *_ in report.picture.axes] == ["X", "Y", "Z"]
    assert not lb.plots.structure(balanced).texts
    with pytest.raises(lb.ModelError, match="add up to no force"):
        lb.practice.capacity_curve(balanced)
    pushed = lb.report(model, lb.bounds(model))
    assert pushed.scene["live"] == [1, 0, 0]
    weight = 2 * 20.0 + 24.0
    assert pushed.facts["live_resultant"] == f"{weight:g} kN along +X, components ({weight:g}, 0, 0) kN"


def test_a_demand_is_told_as_it_was_stated():
    """.25 is .99997 times .250006; rounded to four digits the demand was the load factor."""
    said = verdict(Answer(0.25, True, ""), 0.250006).text
    assert "the load factor 0.2500 is 0.999 times the demand 0.250006: the demand is not reached" in said


@pytest.mark.parametrize("dilatancy", [0.0, 0.3, 0.5])
def test_a_load_factor_with_dilatancy_is_not_told_as_one_without(dilatancy, tmp_path):
    """A block slides at its friction coefficient, .5; where it lifts by as much, that is associated flow."""
    stone = [
        lb.Block.box("ground", (3, 1, 1), (0, 0, -0.5)),
        lb.Block.box("stone", (2, 1, 1), (0, 0, 0.5), 2e4),
    ]
    model = model_of(stone, ["ground"], lb.OrdunaLourenco(0.5))
    solved = lb.nonassociated(model, dilatancy=dilatancy)
    read = lb.files.read_result(solved.save(tmp_path / "r.json"), model)
    for result in (solved, read):
        first = " ".join(lb.report(model, result).text.split("Model\n=====")[0].split())
        assert "0.5000 load factor" in first
        assert ("as in real masonry" in first) == (dilatancy == 0.0)
        assert (f"dilatancy {dilatancy:g}: a horizontal" in first) == (dilatancy > 0.0)
        assert ("can give a smaller one" in first) == (dilatancy > 0.0)


@pytest.mark.parametrize(
    ("bound", "least", "most"),
    [
        (0.47788986, "0.4778898", "0.4778899"),
        (0.4999999999999, "0.5000000", "0.5000000"),  # rounding of a computer is none of the bound
        (12.34567891, "12.34567", "12.34568"),
        (-0.47788986, "-0.4778899", "-0.4778898"),
        (1234567.8, "1234567", "1234568"),  # no point without a digit behind it
    ],
)
def test_bounds_in_tables_are_rounded_away_from_the_load_factor(bound, least, most):
    assert (at_least(bound), at_most(bound)) == (least, most)


@pytest.mark.parametrize(
    ("load_factor", "demand", "shown", "reached"),
    [
        (0.21, 0.20, "1.05", "the demand is reached"),
        (0.1, 0.2, "0.500", "the demand is not reached"),
        (0.19999, 0.2, "0.999", "the demand is not reached"),  # never rounded up to 1
        (0.2, 0.2, "1.00", "the demand is reached"),
        (0.2 * (1 - 3e-13), 0.2, "0.999", "the demand is not reached"),  # nor in the last digits
        (0.3, 0.1, "3.00", "the demand is reached"),  # 2.9999999999999996 in a computer
    ],
)
def test_a_demand_gives_a_ratio_and_a_verdict(load_factor, demand, shown, reached):
    found = verdict(Answer(load_factor, True, ""), demand)
    assert found.ratio == load_factor / demand
    assert f"is {shown} times the demand {demand:.4g}: {reached}." in found.text
    assert "no statement of compliance" in found.text
    upper = verdict(Answer(load_factor, False, ""), demand).text
    assert ("is open" in upper) == (load_factor >= demand)


def test_below_zero_no_demand_can_be_met():
    for certified in (True, False):
        found = verdict(Answer(-1.355, certified, ""), 0.1)
        assert "-1.355 is below zero: in this state the structure falls" in found.text
        assert "the demand 0.1 cannot be met" in found.text
        assert "times" not in found.text

"""Ties, strips, dowels and water from the shell: load factors by hand, wrong places and numbers."""

import json
from dataclasses import replace

import pytest
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks import cli
from limitblocks.practice import PartialFactors, design_model
from limitblocks.practice.places import joints_named

B, H, W, MU = 0.5, 5.0, 50e3, 0.6
F = 8e3  # N: what a tie, strip or dowel carries
ENDS = ("--anchor", "block 1", 0, 0, 4.5, "--anchor", "base,-6,0,4.5")
ROD = ("--area", 1e-4, "--strength", 235e6)
STRIP = ("--width", 0.1, "--capacity", F)


def run(*arguments):
    return CliRunner().invoke(cli.app, [str(one) for one in arguments])


@pytest.fixture
def wall(tmp_path):
    """Its heel is at x = 0, its toe at x = B."""
    joint = lb.PointContact(MU)
    return lb.structures.block(joint, width=B, height=H).save(tmp_path / "wall.json")


def moments(height):
    return (W * B / 2 + F * height) / (W * H / 2)


@pytest.mark.parametrize(
    ("asked", "expected"),
    [
        (("tie", *ENDS, *ROD, "--pull-out", F), moments(4.5)),
        (
            ("tie", *ENDS, "--area", 1e-5, "--strength", 2e8, "--number-of", 4, "--prestress", 2e3),
            moments(4.5),
        ),
        (("strip", "--point", 0, 0, 0, *STRIP), moments(B)),
        (("strip", "--point", "0,0,0", *STRIP, "--interface", "base|block 1"), moments(B)),
        (("strip", "--point", "0,0,0", *STRIP, "--interface", "block 1|base"), moments(B)),
    ],
)
def test_what_holds_a_wall_is_in_the_model_written(wall, tmp_path, asked, expected):
    verb, *options = asked
    done = run(verb, wall, *options, "-o", tmp_path / "held.json")
    assert (done.exit_code, done.stderr) == (0, "")
    assert f"with a {verb} " in done.stdout
    answer = json.loads(run("bounds", tmp_path / "held.json", "--json").stdout)
    assert answer["lower"] == pytest.approx(expected, rel=1e-6)


def test_a_dowel_holds_a_block_that_slides(tmp_path):
    low = lb.structures.block(lb.PointContact(0.2), width=5.0, height=0.5).save(tmp_path / "low.json")
    dowel = ("--point", 2, 0, 0, "--diameter", 0.02, "--capacity", F)
    assert run("dowel", low, *dowel, "-o", tmp_path / "held.json").exit_code == 0
    assert lb.bounds(lb.read(tmp_path / "held.json")).upper == pytest.approx(0.2 + F / W, rel=1e-6)


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (("tie", *ENDS, *ROD, "--strength", 0), "tie block 1|base: strength is 0.0"),
        (("tie", *ENDS, "--anchor", "base", "0,0,0", *ROD), "3 given, expected 2"),
        (("tie", "--anchor", "block 2,0,0,4.5", *ENDS[5:], *ROD), "did you mean 'block 1'?"),
        (("tie", "--anchor", "block 1,-1,0,4.5", *ENDS[5:], *ROD), "1 m off block 'block 1'"),
        (
            ("tie", "--anchor", "block 1,0,0", *ENDS[5:], *ROD),
            "'block 1,0,0': expected a block and 3 numbers",
        ),
        (("strip", "--point", 0, 0, 1, *STRIP), "not on the joint, 1 m off it"),
        (("strip", "--point", 0, 0, 0, *STRIP, "--interface", "block 2|base"), "there are base|block 1"),
    ],
)
def test_what_is_wrong_is_named_and_nothing_written(wall, tmp_path, asked, said):
    verb, *options = asked
    done = run(verb, wall, *options, "-o", tmp_path / "held.json")
    assert done.exit_code == 2
    assert said in done.stderr
    assert not (tmp_path / "held.json").exists()


def test_a_model_is_replaced_only_if_told_and_slips_are_asked_about(wall, tmp_path):
    asked = ("tie", wall, *ENDS, "--area", 1e-4, "--strength", 235, "-o", tmp_path / "held.json")
    assert "235 Pa on its section: MPa, or kN?" in run(*asked).stderr
    again = run(*asked)
    assert (again.exit_code, "exists" in again.stderr) == (2, True)
    assert run(*asked, "--force").exit_code == 0
    assert "reads or writes, too" in run(*asked[:-1], wall, "--force").stderr


def test_water_lifts_a_wall(wall, tmp_path):
    """U = gamma z b through the middle of the base: both moments shrink alike."""
    asked = ("uplift", wall, "--level", 2, "--share", 0.5, "-o", tmp_path / "wet.json")
    done = run(*asked, "--interface", "block 1|base")
    assert (done.exit_code, done.stderr) == (0, "")
    assert "with water in 1 joint" in done.stdout
    wet = lb.read(tmp_path / "wet.json")
    assert lb.bounds(wet).upper == pytest.approx(B / H * (1 - 0.5 * 9810 * 2 * B / W), rel=1e-6)
    twice = run("uplift", tmp_path / "wet.json", "--level", 2, "-o", tmp_path / "twice.json")
    assert "has water in joints already" in twice.stderr
    factored = design_model(lb.read(wall), PartialFactors(1.35, 1.5, 1.2)).save(tmp_path / "design.json")
    wetted = run("uplift", factored, "--level", 2, "-o", tmp_path / "dw.json")
    assert "the model has design values; this water has no gamma_G" in wetted.stderr
    assert "kN/m3" in run(*asked, "--force", "--unit-weight", 9.81).stderr
    for wrong, said in (
        (("--share", 2), "share"),
        (("--level", -1), "no joint"),
        (("--interface", "x"), "'x'"),
    ):
        refused = run(*asked, "--force", *wrong)
        assert (refused.exit_code, said in refused.stderr) == (2, True)


def test_a_point_on_two_joints_asks_which(tmp_path):
    stones = [
        lb.Block.box("ground", (4, 1, 0.2), (0, 0, -0.1)),
        lb.Block.box("left", (1, 1, 1), (-0.5, 0, 0.5), 20e3),
        lb.Block.box("right", (1, 1, 1), (0.5, 0, 0.5), 20e3),
    ]
    found = lb.find_interfaces(stones, lb.PointContact(MU))
    model = lb.Model(stones, ["ground"], found, lb.self_weight(), lb.mass_proportional((1, 0, 0)))
    asked = (
        "strip",
        model.save(tmp_path / "two.json"),
        "--point",
        0,
        0,
        0,
        *STRIP,
        "-o",
        tmp_path / "held.json",
    )
    assert "on the joints ground|left and ground|right and left|right: say which" in run(*asked).stderr
    assert run(*asked, "--interface", "left|right").exit_code == 0
    assert lb.read(tmp_path / "held.json").interfaces[-1].name == "strip left|right"


def test_where_joints_have_both_orders_of_two_blocks_each_is_named_by_its_own():
    """Two feet of one table: given by hand, each its own way round."""
    ground = lb.Block.box("ground", (4, 1, 0.2), (0, 0, -0.1))
    table = lb.Block.box("table", (2, 1, 1), (0, 0, 0.5), 20e3)
    (whole,) = lb.find_interfaces([ground, table], lb.PointContact(MU))
    foot = whole.polygon * (0.25, 1.0)
    left, right = (replace(whole, centroid=(x, 0, 0), polygon=foot) for x in (-0.75, 0.75))
    turned = replace(
        right,
        block_i="table",
        block_j="ground",
        axes=right.axes * [[1], [-1], [-1]],
        polygon=(foot * (1, -1))[::-1],
    )
    model = lb.Model(
        [ground, table], ["ground"], [left, turned], lb.self_weight(), lb.mass_proportional((1, 0, 0))
    )
    assert [joints_named(model, [one.name]) for one in (left, turned)] == [[left], [turned]]

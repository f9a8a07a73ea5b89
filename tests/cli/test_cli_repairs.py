"""The least ties and masses from the shell: by hand, the model with them, and what is refused."""

import json

import pytest
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks import cli

B, H, W = 0.5, 5.0, 50e3
REQUIRED = 0.3
LOW = ("--anchor", "block 1", 0, 0, 2, "--anchor", "base,-6,0,2")
HIGH = ("--anchor", "block 1", 0, 0, 4.5, "--anchor", "base,-9,0,4.5")
ROD = ("--area", 1e-3, "--strength", 100e6)
DEEP, TALL = ("--place", "block 1", 0, 0, 0.5), ("--place", "block 1", 0.25, 0, 4)


def run(*arguments):
    return CliRunner().invoke(cli.app, [str(one) for one in arguments])


@pytest.fixture
def wall(tmp_path):
    """Its heel is at x = 0, its toe at x = B."""
    return lb.structures.block(lb.PointContact(0.6), width=B, height=H).save(tmp_path / "wall.json")


@pytest.mark.parametrize(
    ("asked", "load_factor", "expected"),
    [
        (("least-ties", *LOW, *HIGH, *ROD), REQUIRED, [0.0, W * (REQUIRED * H - B) / 2 / 4.5]),
        (("least-masses", *DEEP, *TALL), 0.12, [W * (0.12 * H - B) / 2 / (B - 0.12 * 0.5), 0.0]),
    ],
)
def test_least_repair_by_moments_about_the_toe(wall, tmp_path, asked, load_factor, expected):
    verb, *options = asked
    held, kept = tmp_path / "held.json", tmp_path / "kept.json"
    done = run(verb, wall, *options, "--load-factor", load_factor, "--model", held, "-o", kept, "--json")
    assert done.exit_code == 0, done.stderr
    assert json.loads(done.stdout)["amounts"] == pytest.approx(expected, rel=1e-5)
    assert lb.bounds(lb.read(held)).lower == pytest.approx(load_factor, rel=1e-4)
    assert "least reinforcement" in str(lb.read_result(kept, lb.read(wall)))
    again = run(verb, wall, *options, "--load-factor", load_factor, "--model", held)
    assert again.exit_code == 2
    assert "--model" in again.stderr


def test_half_a_tie_is_refused(wall):
    done = run("least-ties", wall, *LOW, *HIGH[:5], *ROD, "--load-factor", REQUIRED)
    assert done.exit_code == 2
    assert "3 given, expected 2 a tie" in done.stderr


def test_what_ties_cannot_reach_is_said_with_what_they_can(wall):
    done = run("least-ties", wall, *HIGH, *ROD, "--pull-out", 1e3, "--load-factor", REQUIRED)
    assert done.exit_code == 2
    most = (W * B / 2 + 1e3 * 4.5) / (W * H / 2)
    assert f"with their whole strengths it has {most:.6g}" in done.stderr

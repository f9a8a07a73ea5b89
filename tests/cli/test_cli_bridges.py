"""Vehicles and fill from the shell: the model with the vehicle, and levels off the fill of the model."""

import json

import pytest
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks import cli
from limitblocks.structures import Fill, arch_bridge


@pytest.fixture(scope="module")
def bridge(tmp_path_factory):
    """A ring of 5 voussoirs, its crown at 1.05 m, fill up to 1.35 m."""
    model = arch_bridge(
        lb.PointContact(0.6), span=3.0, rise=0.75, thickness=0.3, voussoirs=5, fill=Fill(0.3, 18e3), depth=2.9
    )
    level = max(block.vertices[:, 2].max() for block in model.free_blocks) + 0.3
    return model.save(tmp_path_factory.mktemp("bridge") / "bridge.json"), level


def run(*arguments):
    return CliRunner().invoke(cli.app, [str(one) for one in arguments])


def test_a_vehicle_leaves_the_model_with_itself_at_its_worst(bridge, tmp_path):
    file, level = bridge
    loaded = tmp_path / "loaded.json"
    asked = "vehicle", file, "--axles", "1e5", "--level", level, "--count", 3, "--model", loaded, "--json"
    said = run(*asked)
    assert said.exit_code == 0, said.output
    assert "meant?" not in said.stderr
    found = json.loads(said.stdout)
    assert lb.bounds(lb.read(loaded)).lower == pytest.approx(found["bounds"]["lower"], rel=1e-6)
    again = run(*asked)
    assert again.exit_code == 2
    assert "--model" in again.stderr
    assert "exists" in again.stderr


def test_levels_off_the_fill_of_the_model_are_asked_about(bridge, tmp_path):
    file, level = bridge
    rounded = run("vehicle", file, "--axles", "1e5", "--level", round(level + 4e-4, 3), "--count", 3)
    assert "meant?" not in rounded.stderr
    road = run("vehicle", file, "--axles", "1e5", "--level", level + 0.1, "--count", 3)
    assert f"the fill of the model ends at {level:.3f}"[:-1] in road.stderr
    fill = "backfill", file, "--unit-weight", "18e3", "--passive", 3, "--weight", "-o"
    same, other = (run(*fill, tmp_path / f"{at}.json", "--level", level + at) for at in (0.0, 0.1))
    assert "meant?" not in same.stderr
    assert "the fill that resists is at" in other.stderr
    assert "has the weight of fill already" in same.stderr

"""What governs the load factor, from the shell."""

import csv
import json

import pytest
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks import cli

MU = 0.3


def test_sensitivities_are_printed_and_written(tmp_path):
    """A block that slides has a = mu: da/dmu mu = mu, and its weight does not matter."""
    block = lb.structures.block(lb.PointContact(MU), width=1.0, height=2.0).save(tmp_path / "block.json")
    names = ("rows.csv", "found.json", "filed.md")
    rows, result, filed = files = [tmp_path / name for name in names]
    asked = ["sensitivities", block, "--csv", rows, "--output", result, "--report", filed]
    run = CliRunner().invoke
    done = run(cli.app, [*map(str, asked)])
    assert (done.exit_code, done.stderr) == (0, "")
    assert "friction of base|block 1" in " ".join(done.stdout.split())
    with rows.open(newline="") as stream:
        found = {(row["kind"], row["name"]): float(row["elasticity"]) for row in csv.DictReader(stream)}
    assert found["friction", "base|block 1"] == pytest.approx(MU, rel=1e-6)
    assert found["unit weight", "block 1"] == pytest.approx(0.0, abs=1e-6)
    assert json.loads(result.read_text())["friction"] == pytest.approx([1.0], rel=1e-6)
    assert "Sensitivity" in filed.read_text(encoding="utf-8")
    assert "kinematic" in filed.read_text(encoding="utf-8")
    for file in files:
        refused = run(cli.app, [*map(str, asked)])
        assert (refused.exit_code, f"{file} exists" in refused.stderr) == (2, True)
        file.unlink()

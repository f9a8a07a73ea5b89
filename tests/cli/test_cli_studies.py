import csv
import json

import pytest
from stones import model_of
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks import cli


def run(*arguments):
    return CliRunner().invoke(cli.app, ["study", *(str(argument) for argument in arguments)])


@pytest.fixture
def file(tmp_path):
    blocks = [
        lb.Block.box("ground", (4, 4, 0.2), (0, 0, -0.1)),
        lb.Block.box("block", (1.0, 1.6, 2.0), (0, 0, 1), 20e3),
    ]
    return model_of(blocks, ["ground"], lb.PointContact(2.0)).save(tmp_path / "block.json")


def test_directions_are_printed_and_written(file, tmp_path):
    rows, result = tmp_path / "rows.csv", tmp_path / "rows.json"
    options = ("--count", 4, "--workers", 1, "--csv", rows, "--output", result)
    done = run("directions", file, *options)
    assert (done.exit_code, done.stderr) == (0, "")
    assert "4 analyses, associated: least load factor 0.5 at" in done.stdout
    assert "warning" not in done.stdout
    with rows.open(newline="") as stream:
        factors = [float(row["load_factor"]) for row in csv.DictReader(stream)]
    assert factors == pytest.approx([0.5, 0.8, 0.5, 0.8], rel=1e-6)
    written = json.loads(result.read_text())
    assert [row["load_factor"] for row in written["rows"]] == factors
    assert run("directions", file, *options).exit_code == 2
    assert run("directions", file, *options, "--force").exit_code == 0


def test_json_is_json_and_nothing_else(file):
    done = run("directions", file, "--count", 2, "--workers", 1, "--nonassociated", "--json")
    assert json.loads(done.stdout)["rows"][0]["load_factor"] == pytest.approx(0.5, rel=1e-5)


def test_unlimited_load_is_a_row_and_a_warning(file):
    done = run("directions", file, "--count", 1, "--vertical", "--workers", 1)
    assert done.exit_code == 0
    assert "unlimited" in done.stdout.splitlines()[3]
    assert "nan" not in done.stdout
    assert "warning: row 3: UnlimitedLoad" in done.stdout


def test_moving_load_is_printed(file):
    line = ("--from", -0.5, 0, "--to", 0.5, 0, "--count", 3, "--workers", 1)
    done = run("moving", file, "--load", 3e4, 0, -1e4, *line)
    assert done.exit_code == 0, done.output
    # about the edge at x = 0.5: W b / 2 over H h - V (0.5 - x), the last on the edge itself
    factors = [32e3 * 2 * 0.5 / (3e4 * 2 - 1e4 * (0.5 - x)) for x in (-0.5, 0.0, 0.5)]
    for factor in factors:
        assert f"{factor:.4g}" in done.stdout
    assert done.stderr == ""
    upwards = run("moving", file, "--load", 0, 0, 1e4, *line)
    assert "warning: the load acts upwards, 10000 N along Z: -10000 N?" in upwards.stderr


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (("moving", "--load", 0, 0, -1, "--from", 8, 0, "--to", 9, 0, "--workers", 1), 3),
        (("directions", "--dilatancy", 0.1), 2),
        (("directions", "--count", 0), 2),
        (("moving",), 2),
    ],
)
def test_failures_have_their_codes(file, arguments, code):
    verb, *options = arguments
    done = run(verb, file, *options)
    assert done.exit_code == code
    assert "Traceback" not in done.output
    assert done.stderr


def test_a_live_load_that_does_not_turn_is_code_2(file, tmp_path):
    document = json.loads(file.read_text())
    document["live"] = [{"type": "Moment", "block": "block", "moment": [0, 1, 0]}]
    other = tmp_path / "other.json"
    other.write_text(json.dumps(document))
    done = run("directions", other, "--workers", 1)
    assert (done.exit_code, done.stdout) == (2, "")
    assert "Moment" in done.stderr


def test_no_number_of_a_table_is_broken_in_two(file):
    """Half of 2.5e-09 on a line of its own reads as 2.5."""
    line = ["directions", str(file), "--count", "8", "--workers", "1"]
    done = CliRunner().invoke(cli.app, ["study", *line], env={"COLUMNS": "70"})
    rows = [row.split() for row in done.stdout.splitlines() if row.strip()[:1].isdigit()][:8]
    assert [len(row) for row in rows] == [8] * 8
    assert all(float(row[-1]) <= 1e-6 for row in rows)


def test_what_an_analysis_remarks_stands_by_its_rows(tmp_path):
    """Pushed along a diagonal Eq. (39) has more than the stress block, along a side it has not."""
    blocks = [
        lb.Block.box("ground", (6, 6, 1), (0, 0, -0.5)),
        lb.Block.box("pier", (1, 1, 4), (0, 0, 2), 20e3),
    ]
    model = model_of(blocks, ["ground"], lb.OrdunaLourenco(0.9, compressive_strength=400e3))
    file, rows = model.save(tmp_path / "pier.json"), tmp_path / "rows.csv"
    done = run("directions", file, "--count", 8, "--workers", 1, "--csv", rows)
    assert "warning: rows 2, 4, 6, 8: " in done.stdout
    with rows.open(newline="") as stream:
        said = ["times the moment" in row["remarks"] for row in csv.DictReader(stream)]
    assert said == 4 * [False, True]


def test_no_word_of_the_head_of_a_table_is_broken_in_two(file):
    line = ["directions", str(file), "--count", "3", "--workers", "1", "--nonassociated"]
    done = CliRunner().invoke(cli.app, ["study", *line], env={"COLUMNS": "80"})
    assert {"Frictionless", "Associated", "residual"} <= set(done.stdout.split())


def test_a_column_that_no_row_claims_is_left_out(tmp_path):
    """Without friction an arch does not stand, so that no frictionless load factor is claimed."""
    model = lb.structures.arch(lb.PointContact(0.6), radius=2.0, thickness=0.5, voussoirs=7)
    done = run(
        "directions", model.save(tmp_path / "arch.json"), "--count", 1, "--workers", 1, "--nonassociated"
    )
    assert "Associated" in done.stdout
    assert "Frictionless" not in done.stdout

import json
import subprocess
import sys
from pathlib import Path

import jsonschema
import pytest
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks import cli
from limitblocks.cli.errors import exit_code

ROOT = Path(__file__).parents[2]
BLOCKS = [
    {"name": "ground", "box": {"size": [4.0, 1.0, 0.2], "at": [0.0, 0.0, -0.1]}},
    {"name": "[b]block[/b]", "box": {"size": [1.0, 1.0, 2.0], "at": [0.0, 0.0, 1.0]}, "unit_weight": 20e3},
]
BLOCK = {
    "schema_version": 1,
    "name": "One [red]block[/red]",
    "blocks": BLOCKS,
    "supports": ["ground"],
    "joints": {"dry": {"type": "PointContact", "friction": 0.7}},
    "interfaces": {"find": {"joint": "dry"}},
    "live": [{"type": "MassProportional", "direction": [1, 0, 0]}],
}
HANGING = [BLOCKS[0], {**BLOCKS[1], "box": {"size": [1.0, 1.0, 2.0], "at": [2.4, 0.0, 1.0]}}]


def run(*arguments):
    return CliRunner().invoke(cli.app, [str(argument) for argument in arguments])


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "block.json"
    path.write_text(json.dumps(BLOCK))
    return path


def test_bounds_prints_load_factor_residuals_and_meaning(file):
    result = run("bounds", file)
    assert (result.exit_code, result.stderr) == (0, "")
    said = " ".join(result.stdout.split())
    for part in ("0.5000", "Gap", "equilibrium", "Eq. (56)", "pass", "Real joints dilate less"):
        assert part in said


def test_a_file_of_blocks_is_sent_to_import(file, tmp_path):
    lb.files.write_blocks(lb.read(file), tmp_path / "block.obj")
    result = run("bounds", tmp_path / "block.obj")
    assert result.exit_code == 2
    assert "holds blocks only; `limitblocks import` makes a model file of them" in result.stderr


def test_a_control_point_needs_its_block(file):
    result = run("capacity", file, "--point", "0.5,0,2")
    assert result.exit_code == 2
    assert "Invalid value for --block, --point: give both or neither" in result.stderr


def test_bounds_as_json_is_json_and_nothing_else(file, tmp_path):
    output = tmp_path / "result.json"
    result = run("bounds", file, "--json", "--output", output)
    printed = json.loads(result.stdout)
    assert printed == json.loads(output.read_text())
    assert printed["lower"] == pytest.approx(0.5, abs=1e-6)
    assert printed["model_digest"] == lb.read(file).digest
    again = run("bounds", file, "--output", output)
    assert again.exit_code == 2
    assert "exists" in again.stderr
    assert run("bounds", file, "--output", output, "--force").exit_code == 0


def test_info_prints_what_the_file_contains(file):
    result = run("info", file)
    assert result.exit_code == 0
    for part in (
        "One [red]block[/red]",
        "ground",
        "40 kN",
        "1 m²",
        "friction coefficient 0.7 (35.0 degrees)",
        "4 × 1 × 2.2 m",
    ):
        assert part in " ".join(result.stdout.split())
    known = json.loads(run("info", file, "--json").stdout)
    assert (known["blocks"], known["interfaces"], known["weight"]) == (2, 1, pytest.approx(40e3))


def test_info_says_a_near_miss_once(tmp_path):
    """Two stones 2 mm apart on one base, whose interfaces the file leaves to be found."""
    boxes = {"A": [-0.501, 0, 0.5], "B": [0.501, 0, 0.5]}
    stones = [
        {"name": name, "box": {"size": [1, 1, 1], "at": at}, "unit_weight": 2e4} for name, at in boxes.items()
    ]
    ground = {"name": "base", "box": {"size": [6, 2, 1], "at": [0, 0, -0.5]}}
    document = {
        "schema_version": 1,
        "blocks": [ground, *stones],
        "supports": ["base"],
        "joints": {"m": {"type": "PointContact", "friction": 0.6}},
        "interfaces": {"find": {"joint": "m"}},
        "dead": [{"type": "SelfWeight"}],
        "live": [{"type": "MassProportional", "direction": [1, 0, 0]}],
    }
    file = tmp_path / "near.json"
    file.write_text(json.dumps(document), encoding="utf-8")
    words = [sys.executable, "-m", "limitblocks", "info", str(file)]
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    assert (done.stdout + done.stderr).count("nearly touch") == 1


def test_report_is_written_beside_the_model_and_overwrites_nothing(file):
    result = run("report", file)
    page = file.with_suffix(".html")
    assert (result.exit_code, result.stdout.strip()) == (0, str(page))
    assert "0.5000" in page.read_text(encoding="utf-8")
    assert run("report", file).exit_code == 2
    page.write_text("mine")
    assert run("report", file).exit_code == 2
    assert page.read_text() == "mine"
    assert run("report", file, "--force").exit_code == 0
    assert run("report", file, "-o", file, "--force").exit_code == 2
    assert lb.read(file)


def test_schema_is_a_json_schema():
    result = run("schema")
    jsonschema.Draft202012Validator(json.loads(result.stdout)).validate(BLOCK)


def test_version():
    assert run("--version").stdout == f"limitblocks {lb.__version__}\n"


def test_wrong_model_is_code_2_and_a_line_a_fault(file):
    file.write_text(json.dumps(BLOCK | {"supports": 3, "live": 4}))
    result = run("bounds", file)
    assert result.exit_code == 2
    assert result.stdout == ""
    assert [line.split(": ")[2] for line in result.stderr.splitlines()] == ["supports", "live"]


def test_many_faults_are_cut_short(file):
    file.write_text(json.dumps(BLOCK | {"supports": list(range(1000))}))
    lines = run("info", file).stderr.splitlines()
    assert len(lines) == 21
    assert lines[-1] == "error: and 980 more faults"


@pytest.mark.parametrize(
    "change",
    [
        {"blocks": HANGING},  # falls under its own weight
        {"live": [{"type": "MassProportional", "direction": [0, 0, -1]}]},  # may press without limit
    ],
)
def test_no_solution_is_code_3_and_one_line(file, change):
    file.write_text(json.dumps(BLOCK | change))
    result = run("bounds", file)
    assert (result.exit_code, result.stdout) == (3, "")
    assert len(result.stderr.splitlines()) == 1


def test_failed_check_is_code_1():
    assert exit_code(lb.errors.CheckFailed("no")) == 1
    assert exit_code(lb.NotConverged("no", None)) == 3
    assert exit_code(lb.errors.MissingDependency("no")) == 2


@pytest.mark.parametrize(
    "arguments", [["bounds"], ["bonds"], ["bounds", "a.json", "--tolerance", "much"], ["info", "none.json"]]
)
def test_wrong_usage_is_code_2_without_traceback(arguments):
    result = subprocess.run(
        [sys.executable, "-m", "limitblocks", *arguments],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert (result.returncode, result.stdout) == (2, "")
    assert result.stderr
    assert "Traceback" not in result.stderr


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full")
@pytest.mark.parametrize("arguments", [["schema"], ["examples", "list"], ["--help"]])
def test_a_full_disk_behind_stdout_is_one_line(arguments):
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "limitblocks", *arguments],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert done.returncode == 2
    assert done.stderr == "error: cannot write what there is to print: No space left on device\n"


def test_help_names_every_verb():
    result = run("--help")
    assert result.exit_code == 0
    assert all(
        verb in result.stdout
        for verb in ("bounds", "nonassociated", "path", "check", "info", "report", "schema", "--version")
    )


def test_a_number_out_of_the_range_of_an_option_is_named(file):
    result = run("range", file, "--paths", 0)
    assert result.exit_code == 2
    assert "Invalid value for '--paths': '0': expected a number greater than or equal to 1" in result.stderr

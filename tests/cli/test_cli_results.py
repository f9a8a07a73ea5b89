import json

import numpy as np
import pytest
from portal_by_hand import PORTAL, changed, run

import limitblocks as lb
from limitblocks.problem import Turning


@pytest.mark.usefixtures("solver")
def test_nonassociated_prints_its_bracket_and_residuals(file, tmp_path):
    output = tmp_path / "out.json"
    done = run("nonassociated", file, "--dilatancy", 0.2, "--output", output)
    assert (done.exit_code, done.stderr) == (0, "")
    for part in (
        "0.2000",
        "Frictionless",
        "not claimed",
        "nobody asked",
        "Associated",
        "others may solve too",
        "equilibrium",
    ):
        assert part in done.stdout
    assert run("check", file, output).exit_code == 0
    printed = run("nonassociated", file, "--dilatancy", 0.2, "--json")
    assert json.loads(printed.stdout) == json.loads(output.read_text())
    assert run("nonassociated", file, "--output", output).exit_code == 2
    assert run("nonassociated", file, "--output", file, "--force").exit_code == 2


@pytest.mark.usefixtures("solver")
def test_path_prints_its_steps(file, tmp_path):
    output = tmp_path / "out.json"
    done = run("path", file, "--dilatancy", 0.2, "-o", output)
    assert (done.exit_code, done.stderr) == (0, "")
    for part in ("Steps of the load path", "Begins to flow", "[b]|left sliding", "Peak"):
        assert part in done.stdout
    assert run("check", file, output).exit_code == 0
    assert len(json.loads(run("path", file, "--json").stdout)["steps"]) == 2
    # the option arrives, though this stand-in does not know it
    assert "unexpected keyword argument 'snaps'" in str(run("path", file, "--along").exception)


@pytest.mark.usefixtures("solver")
@pytest.mark.parametrize("verb", ["nonassociated", "path"])
def test_turning_is_an_option_and_is_kept_in_the_file(verb, file, tmp_path):
    output = tmp_path / "out.json"
    done = run(verb, file, "--dilatancy", 0.2, "--turning", "centre of pressure", "-o", output)
    assert (done.exit_code, done.stderr) == (0, "")
    assert lb.read_result(output).collapse.turning is Turning.PRESSURE
    assert run("check", file, output).exit_code == 0
    refused = run(verb, file, "--turning", "table 5")
    assert refused.exit_code == 2
    assert "centre of pressure" in refused.stderr


@pytest.mark.usefixtures("solver")
def test_method_is_an_option(file):
    done = run("nonassociated", file, "--method", "fixed point", "--json")
    assert json.loads(done.stdout)["how"] == "by hand, fixed point"
    refused = run("nonassociated", file, "--method", "luck")
    assert refused.exit_code == 2
    assert "fixed point" in refused.stderr


def test_bounds_are_checked_with_associated_flow(file, tmp_path):
    output = tmp_path / "bounds.json"
    assert run("bounds", file, "-o", output).exit_code == 0
    done = run("check", file, output)
    assert (done.exit_code, done.stderr) == (0, "")
    changed(output, lower=lambda lower: 1.001 * lower)
    assert run("check", file, output).exit_code == 2  # its proof says otherwise
    changed(output, proof=lambda proof: proof | {"lower": 1.001 * proof["lower"]})
    assert run("check", file, output).exit_code == 1


def between_walls(stone, joint):
    """A cube of 1 m between two walls; above a floor, or above nothing."""
    return {
        "schema_version": 1,
        "blocks": [
            {"name": "left", "box": {"size": [1.0, 1.0, 2.0], "at": [-1.0, 0.0, 1.0]}},
            {"name": "right", "box": {"size": [1.0, 1.0, 2.0], "at": [1.0, 0.0, 1.0]}},
            {"name": "floor", "box": {"size": [3.0, 1.0, 1.0], "at": [0.0, 0.0, -0.5]}},
            {"name": "stone", "box": {"size": [1.0, 1.0, 1.0], "at": [0.0, 0.0, stone]}, "unit_weight": 20e3},
        ],
        "supports": ["left", "right", "floor"],
        "joints": {"dry": {"type": "OrdunaLourenco", "friction": joint}},
        "interfaces": {"find": {"joint": "dry"}},
        "live": [{"type": "MassProportional", "direction": [0, 1, 0]}],
    }


@pytest.mark.parametrize(
    ("document", "code", "kind"),
    [
        (between_walls(0.5, 0.6), 0, "stands"),
        (between_walls(1.0, 0.6), 1, "self-stress"),
        (between_walls(1.0, 0.0), 1, "falls"),
    ],
)
def test_stability_is_code_0_only_for_what_stands_by_itself(document, code, kind, tmp_path):
    file, output = tmp_path / "model.json", tmp_path / "stability.json"
    file.write_text(json.dumps(document))
    done = run("stability", file, "-o", output)
    assert done.exit_code == code
    assert ("against their dead load: stone;" in done.stderr) is bool(done.stderr) is bool(code)
    assert kind in done.stdout
    assert ("stone" in done.stdout) is bool(code)
    answer = json.loads(run("stability", file, "--json").stdout)
    assert (answer["kind"], answer["stands"]) == (kind, code == 0)
    assert answer == json.loads(output.read_text())
    refused = run("check", file, output)
    assert refused.exit_code == 2
    assert "Stability has no load_factor; expected" in refused.stderr


def test_check_of_an_honest_result_passes(file, result):
    done = run("check", file, result)
    assert (done.exit_code, done.stderr) == (0, "")
    assert all(part in done.stdout for part in ("passed", "complementarity", "Eq. (59)", "as claimed"))
    said = json.loads(run("check", file, result, "--json").stdout)
    assert (said["analysis"], said["passed"], said["mechanism_found"]) == ("check", True, False)
    assert run("check", file, result, "--tolerance", 1e-16).exit_code == 1


def times(factor):
    return lambda numbers: (factor * np.array(numbers)).tolist()


def test_check_takes_what_is_exact_for_a_near_model_where_asked_to(file, result):
    """One thousandth more load factor: an imbalance of less than that of what acts on a block."""
    changed(result, load_factor=times(1.001))
    assert run("check", file, result).exit_code == 1
    done = run("check", file, result, "--backward-error", 1e-3)
    assert done.exit_code == 0
    assert "near" in done.stdout
    assert "loads" in done.stdout
    found = json.loads(run("check", file, result, "--backward-error", 1e-3, "--json").stdout)
    assert (found["passed"], found["accepted"], found["backward_error_limit"]) == (False, True, 1e-3)
    assert found["backward_error"]["value"] == found["backward_error"]["loads"] < 1e-3
    assert run("check", file, result, "--backward-error", 1e-6).exit_code == 1
    assert run("check", file, result, "--backward-error", 0).exit_code == 2


MUTILATIONS = {
    "load factor": ({"load_factor": times(1.01)}, "equilibrium"),
    "forces": ({"stress_resultants": times(1.01), "generalised_stresses": times(1.01)}, "equilibrium"),
    "mechanism flipped": ({"displacement_rates": times(-1.0)}, "normalisation"),
    "multiplier signs": ({"flow_multipliers": times(-1.0)}, "multipliers"),
    "multipliers": ({"flow_multipliers": times(1.01)}, "flow"),
    "dilatancy": ({"dilatancy": lambda _: 0.0}, "flow"),
}


@pytest.mark.parametrize(("changes", "residual"), MUTILATIONS.values(), ids=MUTILATIONS)
def test_check_names_the_residual_of_every_mutilation(changes, residual, file, result):
    changed(result, **changes)
    done = run("check", file, result)
    assert done.exit_code == 1
    (line,) = done.stderr.splitlines()
    assert line.startswith("error: above 1e-08:")
    assert f"{residual} " in line
    answer = run("check", file, result, "--json")
    assert answer.exit_code == 1
    assert json.loads(answer.stdout)["passed"] is False


def test_yield_violation_is_named(file, result):
    """A friction one percent lower makes the same state violate yield, and is another model."""
    weaker = file.with_name("weaker.json")
    weaker.write_text(json.dumps(PORTAL | {"joints": {"dry": {"type": "PointContact", "friction": 0.198}}}))
    done = run("check", weaker, result)
    assert (done.exit_code, done.stdout) == (2, "")
    for path in (file, weaker):
        assert lb.read(path).digest[:12] in done.stderr
    changed(result, model_digest=lambda _: "", dilatancy=lambda _: 0.198)
    done = run("check", weaker, result)
    assert done.exit_code == 1
    assert "does not say which model it belongs to" in done.stderr
    assert "yield " in done.stderr


@pytest.mark.parametrize("document", ["{", {"load_factor": 1}, {"analysis": "bounds"}, PORTAL])
def test_wrong_result_file_is_code_2_and_a_line_a_fault(document, file, tmp_path):
    path = tmp_path / "wrong.json"
    path.write_text(document if isinstance(document, str) else json.dumps(document))
    done = run("check", file, path)
    assert (done.exit_code, done.stdout) == (2, "")
    assert all(line.startswith(f"error: {path}: ") for line in done.stderr.splitlines())
    assert run("check", file, tmp_path / "none.json").exit_code == 2


@pytest.mark.parametrize("arguments", [["nonassociated", "--dilatancy", "0"], ["path", "--dilatancy", "0.2"]])
def test_the_real_analyses_pass_the_check(arguments, file, tmp_path):
    output = tmp_path / "out.json"
    done = run(*arguments, file, "--output", output)
    assert done.exit_code == 0, done.stderr
    assert run("check", file, output).exit_code == 0


@pytest.mark.parametrize("verb", ["nonassociated", "path"])
def test_dilatancy_above_friction_is_code_2(verb, file):
    done = run(verb, file, "--dilatancy", 0.9)
    assert done.exit_code == 2
    assert "dilatancy is 0.9" in done.stderr


def test_a_model_and_its_result_the_other_way_round_are_told(tmp_path):
    model = lb.structures.block(lb.PointContact(0.5), width=1.0, height=2.0)
    file, result = model.save(tmp_path / "block.json"), lb.nonassociated(model).save(tmp_path / "result.json")
    for arguments, said in (
        (("check", result, file), "result.json: is a result, not a model"),
        (("bounds", result), "result.json: is a result, not a model"),
        (("check", file, file), "block.json: is a model, not a result"),
        (("report", file, file, "-o", tmp_path / "report.md"), "block.json: is a model, not a result"),
    ):
        told = run(*arguments)
        assert told.exit_code == 2
        assert told.stderr.endswith(f"{said}; the model comes first, then the result\n")
        assert told.stderr.count("error") == 1

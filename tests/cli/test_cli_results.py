import json
import signal
import subprocess
import sys
import time
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks.choices import Method
from limitblocks.cli import app, progress
from limitblocks.evidence.ending import Status
from limitblocks.evidence.load_path_result import LoadPath, PathStep
from limitblocks.evidence.results import Iteration, Nonassociated
from limitblocks.problem import Turning

JAMMED = {"live": [{"type": "MassProportional", "direction": [0, 0, -1]}]}
PORTAL = {
    "schema_version": 1,
    "name": "Portal",
    "blocks": [
        {"name": "ground", "box": {"size": [4.0, 1.0, 0.2], "at": [0.0, 0.0, -0.1]}},
        {"name": "left", "box": {"size": [0.5, 1.0, 2.0], "at": [-1.0, 0.0, 1.0]}, "unit_weight": 20e3},
        {"name": "right", "box": {"size": [0.5, 1.0, 2.0], "at": [1.0, 0.0, 1.0]}, "unit_weight": 20e3},
        {"name": "lintel", "box": {"size": [2.5, 1.0, 0.4], "at": [0.0, 0.0, 2.2]}, "unit_weight": 24e3},
    ],
    "supports": ["ground"],
    "joints": {"dry": {"type": "PointContact", "friction": 0.2}},
    "interfaces": {"find": {"joint": "dry"}},
    "live": [{"type": "MassProportional", "direction": [1, 0, 0]}],
}


def run(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def solved(
    model,
    *,
    dilatancy=0.2,
    turning="centroid",
    method="path",
    tolerance=1e-8,
    backward_error=None,
    progress=None,
    status=Status.CONVERGED,
):
    """The associated solution: it satisfies Eqs (54)-(59) where the dilatancy is the friction."""
    bounds = lb.bounds(model)
    iteration = Iteration(bounds.lower, "step", 0.0, {"flow": 1e-9}, 1, 0)
    if progress:
        progress(iteration)
    names = ("stress_resultants", "generalised_stresses", "displacement_rates", "flow_multipliers")
    names += ("dead_load_stresses",)
    return Nonassociated(
        load_factor=bounds.upper,
        frictionless=np.nan,
        associated=bounds.upper,
        residuals=bounds.residuals,
        backward_error=lb.check_mcp(model, bounds).backward_error,
        status=status,
        how=f"by hand, {Method(method).value}",
        history=(iteration,),
        dilatancy=dilatancy,
        turning=Turning(turning),
        remarks=(),
        tolerance=tolerance,
        digest=model.digest,
        unclaimed="nobody asked",
        **{name: getattr(bounds, name) for name in names},
    )


def walked(model, **settings):
    end = solved(model, **settings)
    first = PathStep(0.0, end.stress_resultants, 0.0 * end.displacement_rates, (), {"yield": 0.0}, "step")
    moved = 1e3 * end.displacement_rates
    return LoadPath(
        (first, replace(first, load_factor=0.2, displacements=moved, active=(("[b]|left", "sliding"),))), end
    )


def stopped(model, **settings):
    best = solved(model, status=Status.OUT_OF_STEPS, **settings)
    raise lb.NotConverged("not converged: flow residual 1e-3", replace(best, load_factor=0.21))


@pytest.fixture
def solver(monkeypatch):
    """Puts analyses of known outcome in place of the real ones."""

    def put(nonassociated=solved, load_path=walked):
        fakes = {"loop": {"nonassociated": nonassociated}, "load_path": {"load_path": load_path}}
        for name, fake in fakes.items():
            module = f"limitblocks.analysis.nonassociated.{name}"
            monkeypatch.setitem(sys.modules, module, SimpleNamespace(**fake))

    put()
    return put


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "portal.json"
    path.write_text(json.dumps(PORTAL))
    return path


@pytest.fixture
def result(file, tmp_path):
    return lb.files.write_result(solved(lb.read(file)), tmp_path / "result.json")


def changed(file, **changes):
    document = json.loads(file.read_text())
    for key, change in changes.items():
        document[key] = change(document[key])
    file.write_text(json.dumps(document))


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
    assert (done.exit_code, done.stderr) == (code, "")
    assert kind in done.stdout
    assert ("stone" in done.stdout) is bool(code)
    answer = json.loads(run("stability", file, "--json").stdout)
    assert (answer["kind"], answer["stands"]) == (kind, code == 0)
    assert answer == json.loads(output.read_text())
    refused = run("check", file, output)
    assert refused.exit_code == 2
    assert "Stability has no load_factor; expected" in refused.stderr


def test_stopping_early_is_code_3_and_the_best_state_is_kept(solver, file, tmp_path):
    solver(stopped, stopped)
    output = tmp_path / "best.json"
    for verb in ("nonassociated", "path"):
        done = run(verb, file, "--dilatancy", 0.2, "--output", output, "--force")
        assert (done.exit_code, done.stdout) == (3, "")
        assert f"the best state found, not a solution, is in {output}" in done.stderr
        assert "error: not converged: flow residual 1e-3" in done.stderr
        assert run("check", file, output).exit_code == 1
    assert run("nonassociated", file).exit_code == 3
    assert run("report", file, "--nonassociated").exit_code == 3
    assert not file.with_suffix(".html").exists()


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


@pytest.mark.usefixtures("solver")
def test_report_takes_the_analyses_asked_for(file):
    page = file.with_suffix(".html")
    assert run("report", file).exit_code == 0
    assert "Load path" not in page.read_text(encoding="utf-8")
    done = run("report", file, "--nonassociated", "--path", "--dilatancy", 0.2, "--force")
    assert (done.exit_code, done.stderr) == (0, "")
    html = page.read_text(encoding="utf-8")
    assert all(part in html for part in ("Side by side", "Non-associated solution", "Steps of the load path"))


def test_report_does_without_bounds_where_dilating_joints_jam(solver, file):
    free = lb.read(file)
    file.write_text(json.dumps(PORTAL | JAMMED))
    jammed = lb.read(file)
    solver(
        lambda model, **settings: replace(solved(free, **settings), associated=np.inf, digest=model.digest)
    )
    assert jammed.digest != free.digest
    assert run("report", file).exit_code == 3
    done = run("report", file, "--nonassociated", "--dilatancy", 0.2)
    assert done.exit_code == 0
    assert "warning: no bounds: the live load can grow without limit" in done.stderr
    assert "unlimited" in file.with_suffix(".html").read_text(encoding="utf-8")


@pytest.mark.usefixtures("solver")
def test_progress_is_lines_without_a_terminal_and_a_bar_on_one(file, monkeypatch, capsys):
    assert run("nonassociated", file, "--json").stderr == ""  # less than ten seconds
    monkeypatch.setattr(progress, "EVERY", 0.01)
    at = Iteration(0.25, "step", 1.0, {"flow": 1e-3, "yield": 1e-9}, 3, 0)
    with progress.of_iterations("path") as show:
        show(at)
        time.sleep(0.2)
    captured = capsys.readouterr()
    assert captured.err.splitlines()[-1] == "path: 0 s, step: load factor 0.25"
    assert captured.out == ""
    monkeypatch.setenv("FORCE_COLOR", "1")
    with progress.of_iterations("path") as show:
        show(at)
    captured = capsys.readouterr()
    assert "step: load factor 0.25" in captured.err
    assert captured.out == ""


@pytest.mark.parametrize("arguments", [["nonassociated", "--dilatancy", "0"], ["path", "--dilatancy", "0.2"]])
def test_the_real_analyses_pass_the_check(arguments, file, tmp_path):
    module = {"nonassociated": "nonassociated", "path": "load_path"}[arguments[0]]
    pytest.importorskip(f"limitblocks.analysis.{module}")
    output = tmp_path / "out.json"
    done = run(*arguments, file, "--output", output)
    assert done.exit_code == 0, done.stderr
    assert run("check", file, output).exit_code == 0


@pytest.mark.parametrize(
    "arguments", [["nonassociated", "--dilatancy", "0.9"], ["path", "--dilatancy", "0.9"]]
)
def test_dilatancy_above_friction_is_code_2(arguments, file):
    module = {"nonassociated": "nonassociated", "path": "load_path"}[arguments[0]]
    pytest.importorskip(f"limitblocks.analysis.{module}")
    done = run(*arguments, file)
    assert done.exit_code == 2
    assert "dilatancy is 0.9" in done.stderr


def test_an_interrupted_analysis_writes_its_best_state_or_says_there_is_none(solver, file, tmp_path):
    def interrupted(_model, **_settings):
        raise KeyboardInterrupt

    solver(interrupted, stopped)
    output = tmp_path / "best.json"
    done = run("nonassociated", file, "-o", output)
    assert (done.exit_code, done.stdout) == (130, "")
    assert done.stderr == "interrupted, with nothing to write yet\n"
    assert not output.exists()
    assert run("path", file, "--dilatancy", 0.2, "-o", output).exit_code == 3
    assert output.exists()


def _interrupted(arguments, met):
    """Exit code and errors of the command in a process of its own, which gets SIGINT once it tells `met`."""
    often = "import limitblocks.cli.progress as p; p.EVERY = 0.02; from limitblocks.cli import main; main()"
    words = [sys.executable, "-c", often, *map(str, arguments)]
    with subprocess.Popen(words, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True) as process:
        said = []
        for line in process.stderr:
            said.append(line)
            if met in line:
                process.send_signal(signal.SIGINT)
                break
        _, rest = process.communicate(timeout=60)
    return process.returncode, "".join(said) + rest


@pytest.mark.skipif(sys.platform == "win32", reason="Windows sends no SIGINT to one process")
def test_a_range_stopped_by_the_user_is_written_as_far_as_it_got(tmp_path):
    model = lb.structures.block(lb.PointContact(0.3), width=1.0, height=1.0).save(tmp_path / "model.json")
    output = tmp_path / "range.json"
    asked = ("range", model, "--paths", 10**6, "--mechanisms", 10**6, "--time-limit", 600, "-o", output)
    code, said = _interrupted(asked, "load factor 0.3")
    assert code == 130, said
    found = lb.read_result(output)
    assert not found.complete
    assert found.load_path.load_factor == pytest.approx(0.3, rel=1e-6)  # friction
    assert lb.report(lb.read(model), found).sections[0].designs


@pytest.mark.skipif(sys.platform == "win32", reason="Windows sends no SIGINT to one process")
def test_a_path_stopped_by_the_user_leaves_its_best_state(tmp_path):
    joint = lb.OrdunaLourenco(0.6)
    model = lb.structures.wall(joint, length=4.0, courses=10).save(tmp_path / "model.json")
    output = tmp_path / "path.json"
    code, said = _interrupted(("path", model, "-o", output), "load factor")
    assert code == 130, said
    assert "interrupted" in said
    assert not lb.read_result(output).collapse.converged


def test_a_study_interrupted_keeps_its_rows(file, tmp_path, monkeypatch):
    from limitblocks.studies import pool

    done = iter([pool.Outcome(0.25, lb.bounds(lb.read(file)), "")])

    def in_order(*_):
        yield from done
        raise KeyboardInterrupt

    monkeypatch.setattr(pool, "in_order", in_order)
    rows = tmp_path / "rows.csv"
    arguments = ("study", "directions", file, "--count", 3, "--csv", rows)
    kept = run(*arguments)
    assert kept.exit_code == 130
    assert kept.stdout.count("interrupted before this one was done") == 2
    assert len(rows.read_text().splitlines()) == 4
    assert run(*arguments, "--force").exit_code == 130  # not even one row: nothing is replaced
    assert "0.25" in rows.read_text()


def test_report_refuses_to_replace_what_it_reads(file, result):
    done = run("report", file, result, "-o", result, "--force")
    assert done.exit_code == 2
    assert "is what the command reads; name another file with --output" in done.stderr


def test_report_is_labelled(file, tmp_path):
    output = tmp_path / "report.json"
    labels = {"title": "North wall", "author": "A. Mason", "project": "17", "notes": "dry", "demand": "0.15"}
    options = [word for name, text in labels.items() for word in (f"--{name}", text)]
    assert run("report", file, *options, "-o", output).exit_code == 0
    text = output.read_text()
    assert json.loads(text)["title"] == labels["title"]
    done = run("report", file, "--demand", "-1")
    assert done.exit_code == 2
    assert "demand" in done.stderr


def test_report_of_saved_results_analyses_nothing(file, result, tmp_path, monkeypatch):
    """Neither without options nor beside the one that is asked for."""
    saved, page = tmp_path / "bounds.json", tmp_path / "page.md"
    assert run("bounds", file, "-o", saved).exit_code == 0
    asked = []
    for name in ("bounds", "nonassociated", "path"):
        monkeypatch.setattr(
            f"limitblocks.cli.analyses.{name}", lambda *_, name=name, **__: asked.append(name)
        )
    done = run("report", file, saved, result, "-o", page)
    assert (done.exit_code, asked) == (0, []), done.stderr
    assert page.read_text(encoding="utf-8").count("checked") >= 2
    other = tmp_path / "other.json"
    other.write_text(json.dumps(PORTAL | {"joints": {"dry": {"type": "PointContact", "friction": 0.3}}}))
    refused = run("report", other, saved, "-o", page, "--force")
    assert (refused.exit_code, asked) == (2, [])
    assert "belongs to model" in refused.stderr

"""Commands that are stopped: what they say on the way, and what they leave."""

import errno
import importlib
import os
import signal
import subprocess
import sys
import time
from contextlib import nullcontext

import numpy as np
import osqp
import pytest
from portal_by_hand import run, stopped

import limitblocks as lb
from limitblocks import cli
from limitblocks.cli import progress
from limitblocks.evidence.results import Iteration


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
    assert "No non-associated load factor" in file.with_suffix(".html").read_text(encoding="utf-8")


def test_a_state_of_a_model_with_design_values_is_said_to_be_of_another_model(file, tmp_path, monkeypatch):
    module = importlib.import_module("limitblocks.practice.adequacy")
    monkeypatch.setattr(module, "nonassociated", stopped)
    output = tmp_path / "best.json"
    factors = ("--gamma-g", 1.0, "--gamma-q", 1.5, "--gamma-m", 1.2)
    done = run("adequacy", file, *factors, "--output", output)
    assert done.exit_code == 3
    assert f"it is not of {file} but of a model made from it on the way" in done.stderr
    assert run("check", file, output).exit_code == 2


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


@pytest.mark.parametrize(
    ("factor", "said"), [(0.25, "load factor 0.25"), (np.nan, "no load factor"), (np.inf, "unlimited")]
)
def test_progress_says_no_nan_and_no_inf(factor, said, monkeypatch, capsys):
    monkeypatch.setattr(progress, "EVERY", 0.01)
    with progress.of_places("vehicle") as show:
        show(1.5, factor)
        time.sleep(0.2)
    assert capsys.readouterr().err.splitlines()[-1] == f"vehicle: 0 s, X = 1.5 m: {said}"


def test_progress_goes_on_between_the_points_of_a_curve(file, monkeypatch):
    """It stood at the last point, for minutes where the next one was hard to find."""
    told = []
    monkeypatch.setattr(progress, "_lines", lambda _verb: nullcontext(lambda text, _share: told.append(text)))
    assert run("capacity", file, "--steps", 2, "--largest", 0.01).exit_code == 0
    assert told[0].startswith("path: load factor ")  # of the structure as it is
    between = [one for one in told if one.startswith("0 m: load factor ")]
    assert any("; next path: load factor " in one for one in between)
    told.clear()
    lb.nonassociated(lb.read(file))
    assert told == []


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
    assert "rows 2 to 3: interrupted before this one was done" in kept.stdout
    assert len(rows.read_text().splitlines()) == 4
    assert run(*arguments, "--force").exit_code == 130  # not even one row: nothing is replaced
    assert "0.25" in rows.read_text()


@pytest.mark.skipif(sys.platform == "win32", reason="Windows sends no SIGINT to one process")
def test_a_report_whose_path_the_user_stops_has_what_there_was_and_the_code_of_an_interruption(tmp_path):
    model = lb.structures.wall(lb.OrdunaLourenco(0.6), length=4.0, courses=10).save(tmp_path / "model.json")
    output = tmp_path / "report.md"
    code, said = _interrupted(("report", model, "--bounds", "--path", "-o", output), "step: load factor")
    assert code == 130, said
    assert "Associated bounds" in output.read_text(encoding="utf-8")


def test_a_report_that_osqp_is_stopped_in_has_the_code_of_an_interruption(monkeypatch, tmp_path):
    """It keeps the signal to itself and returns OSQP_SIGINT, 10 in its constants.h."""
    solve = osqp.OSQP.solve

    def pressed(solver, **options):
        found = solve(solver, **options)
        found.info.status_val = 10
        return found

    monkeypatch.setattr(osqp.OSQP, "solve", pressed)
    lintel = lb.structures.eccentric_lintel(lb.OrdunaLourenco(0.6, slip="paper"))  # yields under its weight
    model, output = lintel.save(tmp_path / "model.json"), tmp_path / "report.md"
    assert run("report", model, "--bounds", "--path", "-o", output).exit_code == 130
    assert "Associated bounds" in output.read_text(encoding="utf-8")


def test_a_pipe_that_nobody_reads_any_more_is_no_check_that_failed(file):
    read, write = os.pipe()
    os.close(read)
    words = [sys.executable, "-m", "limitblocks", "info", str(file)]
    done = subprocess.run(words, stdout=write, stderr=subprocess.PIPE, text=True, check=False)
    os.close(write)
    assert (done.returncode, done.stderr) == (141, "")


def test_windows_says_otherwise_that_nobody_reads_any_more(monkeypatch, capfd):
    def closed(**_):
        raise OSError(errno.EINVAL, "Invalid argument")

    monkeypatch.setattr(cli, "app", closed)
    monkeypatch.setattr(cli, "_say_no_more", lambda: None)
    with pytest.raises(SystemExit, match="141"):
        cli.main()
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize(("usual", "code"), [("default_int_handler", 130), ("SIG_IGN", 0)])
def test_an_interruption_of_the_imports_ends_without_a_word(usual, code):
    """At the first import of the command line; where it is ignored, as by nohup, it stays so."""
    script = f"""
import signal, sys
from importlib.abc import MetaPathFinder

class Interrupting(MetaPathFinder):
    def find_spec(self, name, *_):
        if name == "typer":
            signal.raise_signal(signal.SIGINT)

sys.meta_path.insert(0, Interrupting())
signal.signal(signal.SIGINT, signal.{usual})
sys.argv = ["limitblocks", "--version"]
from limitblocks.__main__ import main
main()
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (code, "")


def test_an_interruption_before_a_command_begins_is_130_too():
    """Python ends an uncaught KeyboardInterrupt by a signal to itself: -2, which shells do not call 130."""
    script = """
import sys, limitblocks.cli
def interrupted():
    raise KeyboardInterrupt
limitblocks.cli.main = interrupted
from limitblocks.__main__ import main
main()
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (130, "")

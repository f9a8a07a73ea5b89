"""The command `report`: what is analysed, labelled, refused."""

import json
from dataclasses import replace

import numpy as np
import pytest
from portal_by_hand import JAMMED, PORTAL, run, solved, stopped

import limitblocks as lb


@pytest.mark.usefixtures("solver")
def test_report_takes_the_analyses_asked_for(file):
    page = file.with_suffix(".html")
    assert run("report", file).exit_code == 0
    html = page.read_text(encoding="utf-8")
    assert "Load path" not in html
    assert "no stability was given to it" in html
    done = run("report", file, "--stability", "--nonassociated", "--path", "--dilatancy", 0.2, "--force")
    assert (done.exit_code, done.stderr) == (0, "")
    html = page.read_text(encoding="utf-8")
    assert "no stability was given to it" not in html
    assert "Stability under the dead loads" in html
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


@pytest.mark.parametrize("option", ["--nonassociated", "--path"])
def test_report_keeps_the_other_chapters_where_an_analysis_has_no_answer(solver, file, option):
    """The bounds, the state reached and what to do are in it; the exit code says that it is not all."""
    solver(stopped, stopped)
    done = run("report", file, option)
    page = file.with_suffix(".html")
    assert (done.exit_code, done.stdout.strip()) == (3, str(page))
    assert "error: not converged: flow residual 1e-3" in done.stderr
    text = page.read_text(encoding="utf-8")
    word = {"--nonassociated": "non-associated load factor", "--path": "load path"}[option]
    assert f"No {word}: not converged: flow residual 1e-3" in text
    assert "Associated bounds" in text
    assert "Non-associated state, not converged" in text
    assert "design with, upper estimate" in text


def test_report_refuses_to_replace_what_it_reads(file, result):
    done = run("report", file, result, "-o", result, "--force")
    assert done.exit_code == 2
    assert "is what the command reads or writes, too; name another with --output" in done.stderr


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


@pytest.mark.usefixtures("solver")
@pytest.mark.parametrize("verb", ["stability", "bounds", "nonassociated", "path"])
def test_verbs_report_their_own_answer(verb, file, tmp_path):
    page = tmp_path / "answer.md"
    done = run(verb, file, "--json", "--report", page)
    assert done.exit_code == 0, done.stderr
    assert lb.read(file).digest in page.read_text(encoding="utf-8")
    assert run(verb, file, "--report", page).exit_code == 2  # it is there already

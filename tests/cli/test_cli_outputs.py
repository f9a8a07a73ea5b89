"""Where results go: what cannot be written is refused before the analysis, and costs no answer after it."""

import errno
import os

import pytest
from portal_by_hand import run

from limitblocks.cli import errors


def _asked_in_vain(*_arguments, **_settings):
    raise AssertionError("analysed before the output was refused")


@pytest.mark.parametrize("option", ["--output", "--report"])
def test_a_file_that_cannot_be_written_is_refused_before_the_analysis(
    solver, file, tmp_path, monkeypatch, option
):
    solver(_asked_in_vain)
    nowhere, folder = tmp_path / "none" / "r.html", tmp_path / "made.html"
    folder.mkdir()
    for path, said in ((nowhere, "there is no folder"), (folder, "is a folder; name a file")):
        done = run("nonassociated", file, option, path, "--force")
        assert done.exit_code == 2
        assert f"{option} {path}" in done.stderr
        assert said in done.stderr

    def denied(**_where):  # where access() says yes, too: on a share, or to root in /proc
        raise PermissionError(errno.EACCES, "no")

    monkeypatch.setattr(errors, "TemporaryFile", denied)
    done = run("nonassociated", file, option, tmp_path / "r.html")
    assert (done.exit_code, f"folder {tmp_path} may not be written to: no" in done.stderr) == (2, True)


def test_a_file_named_minus_is_not_the_standard_output(solver, file, tmp_path, monkeypatch):
    """A file of that name was written, which `rm` takes for an option; a pipe behind it got the table."""
    solver(_asked_in_vain)
    monkeypatch.chdir(tmp_path)
    there = sorted(tmp_path.iterdir())
    for option, *words in (
        ("--output", "nonassociated", file),
        ("--output", "new", "block", "--width", 1, "--height", 2, "--friction", 0.6),
        ("--csv", "study", "directions", file),
    ):
        done = run(*words, option, "-", "--force")
        assert done.exit_code == 2
        assert f"error: {option} -: expected a file, not the standard output" in done.stderr
    assert sorted(tmp_path.iterdir()) == there


def test_one_file_for_the_result_and_its_report_is_refused(solver, file, tmp_path):
    """The report took the place of the result without a word."""
    solver(_asked_in_vain)
    done = run("bounds", file, "--output", tmp_path / "r.json", "--report", tmp_path / "r.json", "--force")
    assert (done.exit_code, "reads or writes, too" in done.stderr) == (2, True)


@pytest.mark.usefixtures("solver")
def test_a_full_disk_does_not_cost_the_answer(file, tmp_path, monkeypatch):
    def full(_descriptor):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", full)
    done = run("nonassociated", file, "--dilatancy", 0.2, "--output", tmp_path / "r.json")
    assert done.exit_code == 2
    assert "cannot write" in done.stderr
    assert "0.2000" in done.stdout
    assert not list(tmp_path.glob(".*"))
    study = ("study", "directions", file, "--count", 1, "--workers", 1, "--csv")
    for words, said in (
        (study, "least load factor 0.2 "),
        (("report", file, "-o"), "Load factor to design with"),
    ):
        done = run(*words, tmp_path / "r.md")
        assert (done.exit_code, "cannot write" in done.stderr) == (2, True)
        assert said in done.stdout

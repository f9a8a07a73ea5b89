"""`limitblocks examples`, completion, near misses, and silence where nobody watches."""

import ast
from importlib import import_module
from pathlib import Path

import pytest
from typer.testing import CliRunner

from limitblocks import cli

ROOT = Path(__file__).parents[2]
HERE = sorted(file.stem for file in (ROOT / "examples").glob("*.py") if not file.stem.startswith("_"))


def run(*arguments):
    return CliRunner().invoke(cli.app, [str(argument) for argument in arguments])


def test_list_names_every_example_and_its_question():
    done = run("examples", "list")
    assert done.exit_code == 0
    assert [line.split()[0] for line in done.stdout.splitlines()] == HERE
    for line in done.stdout.splitlines():
        doc = ast.get_docstring(ast.parse((ROOT / "examples" / f"{line.split()[0]}.py").read_text("utf-8")))
        assert line.endswith(doc.split("\n", 1)[0])


def test_run_writes_the_pictures_here(tmp_path, monkeypatch):
    pytest.importorskip("matplotlib")
    monkeypatch.chdir(tmp_path)
    done = run("examples", "run", "01")
    assert done.exit_code == 0, done.output
    (picture,) = (tmp_path / "output").iterdir()
    assert done.stdout.splitlines()[-1] == str(Path("output") / picture.name)


def test_run_replaces_a_file_only_with_force(tmp_path, monkeypatch):
    """Pictures, models and reports of an example have its name; others stay."""
    lines = "from pathlib import Path", "Path('output/drawing.png').write_text('new')"
    (tmp_path / "drawing.py").write_text("\n".join(lines))
    monkeypatch.setattr(import_module("limitblocks.cli.examples"), "folder", lambda: tmp_path)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "output").mkdir()
    mine, other = tmp_path / "output" / "drawing.png", tmp_path / "output" / "drawing_of_mine.png"
    mine.write_text("mine")
    other.write_text("mine")
    refused = run("examples", "run", "drawing")
    assert (refused.exit_code, mine.read_text()) == (2, "mine")
    assert f"{Path('output') / 'drawing.png'} exists; move it, or replace it with --force" in refused.stderr
    assert run("examples", "run", "drawing", "--force").exit_code == 0
    assert (mine.read_text(), other.read_text()) == ("new", "mine")


def test_show_is_the_file():
    shown = run("examples", "show", "facade").stdout
    assert shown == (ROOT / "examples" / "facade.py").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("name", "said"),
    [("facad", "did you mean 'facade'"), ("99", "examples list"), ("../facade", "no example")],
)
def test_an_unknown_example_is_code_2(name, said):
    done = run("examples", "run", name)
    assert (done.exit_code, done.stdout) == (2, "")
    assert said in done.stderr


def test_an_example_that_takes_words_gets_none_of_ours(tmp_path, monkeypatch):
    """`examples run 20` ended in a traceback: it took `examples run 20` for its folder and suffix."""
    (tmp_path / "drawing.py").write_text("import sys\nif __name__ == '__main__':\n    print(sys.argv)\n")
    monkeypatch.setattr(import_module("limitblocks.cli.examples"), "folder", lambda: tmp_path)
    monkeypatch.setattr("sys.argv", ["limitblocks", "examples", "run", "drawing"])
    done = run("examples", "run", "drawing")
    assert (done.exit_code, done.stdout) == (0, f"{[str(tmp_path / 'drawing.py')]}\n")


def test_a_missing_package_is_named(tmp_path, monkeypatch):
    (tmp_path / "drawing.py").write_text("import a_package_that_is_missing\n")
    monkeypatch.setattr(import_module("limitblocks.cli.examples"), "folder", lambda: tmp_path)
    done = run("examples", "run", "drawing")
    assert done.exit_code == 2
    assert "a_package_that_is_missing" in done.stderr
    assert "pip install" in done.stderr


def test_a_mistyped_verb_is_recognised():
    done = run("bound", "model.json")
    assert done.exit_code == 2
    assert "Did you mean 'bounds'" in done.stderr


def test_the_shell_can_learn_the_commands():
    assert "--install-completion" in run("--help").stdout
    done = CliRunner().invoke(
        cli.app,
        [],
        prog_name="limitblocks",
        env={"_LIMITBLOCKS_COMPLETE": "complete_bash", "COMP_WORDS": "limitblocks bou", "COMP_CWORD": "1"},
    )
    assert done.stdout.split() == ["bounds"]


def test_a_report_is_silent_where_nobody_watches(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert run("new", "block", "--width", 0.5, "--height", 1, "--friction", 0.7).exit_code == 0
    done = run("report", "block.json", "--nonassociated", "--path")
    assert (done.exit_code, done.stderr) == (0, "")
    assert done.stdout == "block.html\n"

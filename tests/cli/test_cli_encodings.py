"""The command line under the encodings of Windows, and on paths with blanks and letters beyond ASCII."""

import os
import subprocess
import sys

import pytest

import limitblocks as lb

STONES = [
    lb.Block.box("Gründung 基礎", (3.0, 1.0, 0.2), (0.0, 0.0, -0.1)),
    lb.Block.box("σ stone", (1.0, 1.0, 1.0), (0.0, 0.0, 0.5)),
    lb.Block.box("half \udc80", (1.0, 1.0, 1.0), (0.0, 0.0, 1.5)),
]


def run(encoding, *words):
    """Run the command line in a process whose console has the given encoding."""
    env = {**os.environ, "PYTHONIOENCODING": encoding, "PYTHONUTF8": "0"}
    command = [sys.executable, "-m", "limitblocks", *map(str, words)]
    return subprocess.run(command, capture_output=True, env=env, check=False)


@pytest.mark.parametrize("encoding", ["cp1252", "cp932"])
def test_nothing_crashes_on_letters_that_the_console_lacks(tmp_path, encoding):
    folder = tmp_path / "mes résultats 結果"
    folder.mkdir()
    file = lb.files.write_blocks(STONES, folder / "mur été.obj")
    model = folder / "mur été.json"
    words = ["--friction", "0.6", "--live", "1,0,0", "--unit-weight", "20e3", "--supports", "Gründung 基礎"]
    done = run(encoding, "import", file, *words)
    assert done.returncode == 0, done.stderr
    assert model.exists()
    shown = run(encoding, "info", model)
    assert (shown.returncode, b"Traceback" in shown.stderr) == (0, False)
    answer = run(encoding, "bounds", model)
    assert answer.returncode == 0, answer.stderr
    assert b"0.5000" in answer.stdout  # rocks: half of 1 m over half of 2 m
    wrong = run(encoding, "import", folder / "日本\udc80.obj", *words)
    assert (wrong.returncode, b"Traceback" in wrong.stderr) == (2, False)
    assert wrong.stderr.startswith(b"error: ")


def test_what_the_console_lacks_is_replaced(tmp_path):
    file = tmp_path / "a.json"
    file.write_text('{"σ基": 1}', encoding="utf-8")
    said = run("cp1252", "info", file).stderr
    assert b"unknown key" in said
    assert b"?" in said

"""A stranger's project with the wheel installed: type checkers see types, and names that are not there."""

import importlib.util
import os
import shutil
import subprocess
import sys
import sysconfig
import venv
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
ALONE = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "MYPYPATH")}
PROJECT = """\
import limitblocks as lb

wall: lb.Model = lb.structures.wall(lb.PointContact(0.6), length=1.2, courses=3)
factor: float = lb.bounds(wall).lower
reveal_type(lb.load_path(wall).collapse)
reveal_type(lb.loads.force)
lb.bound(wall)
wrong: str = lb.nonassociated(wall).load_factor
"""


@pytest.fixture(scope="module")
def stranger(tmp_path_factory):
    """A project with an environment of its own, in which the wheel and nothing else is installed."""
    if importlib.util.find_spec("hatchling") is None:
        pytest.skip("hatchling, which builds the wheel, is not installed")
    folder = tmp_path_factory.mktemp("stranger")
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    subprocess.run(build, cwd=ROOT, check=True, capture_output=True)
    venv.create(folder / "env", with_pip=False)
    paths = {"base": str(folder / "env"), "platbase": str(folder / "env")}
    site = sysconfig.get_path("purelib", scheme="venv", vars=paths)
    with zipfile.ZipFile(next(folder.glob("*.whl"))) as wheel:
        wheel.extractall(site)
    (folder / "project.py").write_text(PROJECT, encoding="utf-8")
    python = Path(sysconfig.get_path("scripts", scheme="venv", vars=paths)) / Path(sys.executable).name
    return folder, Path(site), next(iter(sorted(python.parent.glob("python*"))))


def mypy(folder, python):
    command = [
        sys.executable,
        "-m",
        "mypy",
        "--strict",
        "--no-incremental",
        "--python-executable",
        str(python),
        "project.py",
    ]
    return subprocess.run(command, cwd=folder, env=ALONE, capture_output=True, text=True, check=False).stdout


def test_mypy_sees_types_and_faults(stranger):
    pytest.importorskip("mypy", reason="mypy is not installed")
    folder, site, python = stranger
    said = mypy(folder, python)
    assert 'project.py:5: note: Revealed type is "limitblocks.evidence.results.Nonassociated"' in said
    assert 'project.py:6: note: Revealed type is "def (block: ' in said
    assert 'project.py:7: error: Module has no attribute "bound"' in said
    assert "project.py:8: error: Incompatible types in assignment" in said
    assert "Found 2 errors in 1 file" in said
    (site / "limitblocks" / "py.typed").unlink()  # the marker is what makes the difference
    assert "missing library stubs or py.typed marker" in mypy(folder, python)
    (site / "limitblocks" / "py.typed").touch()


def test_pyright_sees_types_and_faults(stranger):
    if shutil.which("pyright") is None:
        pytest.skip("pyright is not installed")
    folder, _, python = stranger
    command = ["pyright", "--pythonpath", str(python), "project.py"]
    said = subprocess.run(command, cwd=folder, env=ALONE, capture_output=True, text=True, check=False).stdout
    assert '"bound" is not a known attribute' in said
    assert "2 errors" in said

import ast
import re
import subprocess
import tomllib
from itertools import chain
from pathlib import Path

import pytest

import limitblocks

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
REQUIREMENTS = list(chain(PROJECT["dependencies"], *PROJECT["optional-dependencies"].values()))
NEWER_SYNTAX = (ast.JoinedStr, ast.AnnAssign, ast.NamedExpr, ast.AsyncFunctionDef, ast.Nonlocal, ast.Match)


def test_version_is_the_same_everywhere():
    version = PROJECT["version"]
    assert limitblocks.__version__ == version
    assert f"\nversion: {version}\n" in (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert version in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", ["environment.py", "test", "demo", "docs"])
def test_script_can_tell_an_old_python_that_it_is_too_old(name):
    tree = ast.parse((ROOT / "scripts" / name).read_text(encoding="ascii"), feature_version=(3, 7))
    for node in ast.walk(tree):
        assert not isinstance(node, NEWER_SYNTAX)
        if isinstance(node, ast.arguments):
            assert not node.kwonlyargs
            assert not node.posonlyargs
            assert all(argument.annotation is None for argument in node.args)


@pytest.mark.parametrize("requirement", REQUIREMENTS)
def test_dependency_has_a_lower_bound(requirement):
    assert ">=" in requirement or requirement.startswith("limitblocks[")


def test_no_file_names_a_folder_of_one_machine():
    listing = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    try:
        listed = subprocess.run(listing, cwd=ROOT, capture_output=True, check=True).stdout.decode()
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("not a git checkout")
    machine_path = re.compile(rb"(?<![\w.:/-])/(home|root|Users|work|opt|mnt)/\w|[A-Z]:\\Users\\")
    files = [ROOT / name for name in listed.split("\0") if name and (ROOT / name).is_file()]
    assert [file.name for file in files if machine_path.search(file.read_bytes())] == []

import ast
import re
import runpy
import subprocess
import sys
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


def test_every_extra_is_described():
    page = (ROOT / "docs" / "installation.md").read_text(encoding="utf-8")
    described = re.findall(r"^\| `(\w+)` \|", page, re.MULTILINE)
    assert set(described) == set(PROJECT["optional-dependencies"])


def test_no_file_names_a_folder_of_one_machine():
    listing = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    try:
        listed = subprocess.run(listing, cwd=ROOT, capture_output=True, check=True).stdout.decode()
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("not a git checkout")
    machine_path = re.compile(rb"(?<![\w.:/-])/(home|root|Users|work|opt|mnt)/\w|[A-Z]:\\Users\\")
    files = [ROOT / name for name in listed.split("\0") if name and (ROOT / name).is_file()]
    assert [file.name for file in files if machine_path.search(file.read_bytes())] == []


def test_workflow_files_are_valid():
    pytest.importorskip("check_jsonschema", reason="the package check-jsonschema is not installed")
    files = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
    command = [sys.executable, "-m", "check_jsonschema", "--builtin-schema", "vendor.github-workflows"]
    checked = subprocess.run([*command, *files], capture_output=True, text=True, check=False)
    assert (checked.returncode, len(files)) == (0, 1), checked.stdout


def test_picture_of_the_house_has_every_package():
    house = runpy.run_path(str(ROOT / "scripts" / "house"))
    drawn = re.findall(
        r'font-weight="bold">(\w+)<', (ROOT / "docs" / "house.svg").read_text(encoding="utf-8")
    )
    assert drawn == [name for floor in house["floors"]() for name in floor], "run scripts/house"


def test_what_contributors_are_sent_to_is_there():
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    places = re.findall(r"`((?:limitblocks|tests|examples|scripts|docs)/[\w./-]*)`", text)
    assert len(places) > 12
    missing = [place for place in places if "NN_" not in place and not (ROOT / place).exists()]
    assert missing == []


def test_pages_that_texts_and_messages_name_are_there():
    rooms = [ROOT / room for room in ("limitblocks", "docs", "examples", "scripts", "tests")]
    pages = chain(ROOT.glob("*.md"), *(room.rglob(kind) for room in rooms for kind in ("*.md", "*.py")))
    named = {}
    for file in pages:
        text = file.read_text(encoding="utf-8")
        named |= dict.fromkeys(re.findall(r"\bdocs/[\w/-]+\.md\b", text), file.name)
        if file.suffix == ".md" and file.parent in (ROOT, ROOT / "examples"):  # the others are built
            links = re.findall(r"\]\((?!\w+:)([^)#\s]+)", text)
            named |= {(file.parent / link).relative_to(ROOT).as_posix(): file.name for link in links}
    assert len(named) > 50
    assert {page: by for page, by in named.items() if not (ROOT / page).exists()} == {}


def test_every_command_of_the_folder_scripts_knows_help():
    """`scripts/test --help` made a virtual environment and ran every check."""
    commands = [file for file in (ROOT / "scripts").iterdir() if file.is_file() and not file.suffix]
    texts = {file.name: file.read_text(encoding="utf-8") for file in commands}
    assert len(texts) > 10
    assert [name for name, text in texts.items() if "ArgumentParser(" not in text] == []


def test_commands_of_the_folder_scripts_go_on_in_the_environment(tmp_path):
    """`scripts/random_suite`, run by a Python without limitblocks, said that there is no module joblib."""
    scripts = ROOT / "scripts"
    bare = {file for file in scripts.iterdir() if file.is_file() and not file.suffix} - {
        scripts / name for name in ("demo", "docs", "lowest", "package", "test")
    }
    for file in bare:
        tree = ast.parse(file.read_text(encoding="utf-8"))
        first = next(node for node in tree.body if isinstance(node, (ast.Import, ast.ImportFrom)))
        assert ast.unparse(first) == "import in_environment", file.name
    command = tmp_path / "command.py"
    command.write_text("import sys; print('run', sys.argv[1]); sys.exit(3)")
    code = (
        f"import sys; sys.path.insert(0, {str(scripts)!r}); import environment; "
        "environment.prepare = lambda extra: print('prepared', extra, flush=True); "
        f"environment.PYTHON = sys.executable; sys.argv = [{str(command)!r}, 'it']; environment.enter()"
    )
    done = subprocess.run(
        [sys.executable, "-I", "-S", "-c", code], check=False, capture_output=True, text=True
    )
    assert (done.stdout.split(), done.returncode) == (["prepared", "dev", "run", "it"], 3)


def test_lowest_versions_are_the_lower_bounds():
    lowest = runpy.run_path(str(ROOT / "scripts" / "lowest"))["lowest"]()
    assert "numpy==" in " ".join(lowest)
    assert all(re.fullmatch(r"[\w-]+==[\d.]+", one) for one in lowest)

"""The names that users see: few, all there, and loaded when they are used."""

import ast
import dataclasses
import inspect
import re
import subprocess
import sys
from dataclasses import fields
from pathlib import Path

import pytest

import limitblocks as lb

HEAVY = {"cvxpy", "clarabel", "jinja2", "matplotlib", "numpy", "osqp", "pydantic", "rich", "scipy", "shapely"}
PARTS = [name for name in lb.__all__ if inspect.ismodule(getattr(lb, name))]


def loaded(code):
    """Packages among HEAVY that running `code` imports."""
    script = f"import sys\n{code}\nprint(*({HEAVY!r} & sys.modules.keys()))"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    return set(done.stdout.splitlines()[-1].split())


def test_there_are_at_most_forty_names_in_order():
    assert len(lb.__all__) <= 40
    assert lb.__all__ == sorted(lb.__all__)


def test_every_name_is_there_once_and_no_other():
    assert [name for name in lb.__all__ if getattr(lb, name, None) is None] == []
    assert dir(lb) == lb.__all__
    with pytest.raises(AttributeError, match="'limitblocks' has no attribute 'bound'"):
        lb.bound  # noqa: B018


@pytest.mark.parametrize(
    ("name", "home"),
    [("ExactTorsion", "joints"), ("pressure", "loads"), ("Bounds", "results"), ("kN", "units")],
)
def test_a_name_of_a_part_is_told_where_it_is(name, home):
    with pytest.raises(AttributeError, match=f"no attribute '{name}'; it is limitblocks.{home}.{name}$"):
        getattr(lb, name)


def test_what_tools_ask_a_module_for_loads_nothing():
    assert (
        loaded("import limitblocks; hasattr(limitblocks, '__wrapped__'), hasattr(limitblocks, '_x')") == set()
    )


def test_type_checkers_know_what_an_analysis_that_did_not_converge_carries():
    assert inspect.signature(lb.NotConverged.__init__).parameters["result"].annotation == "Nonassociated"


def test_type_checkers_see_the_names_that_python_finds():
    tree = ast.parse(Path(lb.__file__).read_text(encoding="utf-8"))
    block = next(node for node in tree.body if isinstance(node, ast.If))
    seen = {
        alias.name: node.module
        for node in block.body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    assert sorted(seen) == lb.__all__
    homes = {name: f"limitblocks.{home}" for name, home in lb._HOMES.items()}
    assert seen == homes | dict.fromkeys(PARTS, "limitblocks")


@pytest.mark.parametrize("part", PARTS)
def test_a_part_shows_its_public_names_alone(part):
    module = getattr(lb, part)
    if part != "units":
        assert dir(module) == module.__all__ == sorted(module.__all__)
    assert all(hasattr(module, name) for name in dir(module))


def test_what_a_public_class_holds_is_public_too():
    sources = (file.read_text(encoding="utf-8") for file in Path(lb.__file__).parent.rglob("*.py"))
    ours = set(re.findall(r"^class (\w+)", "\n".join(sources), re.MULTILINE))
    things = [getattr(module, name) for module in (lb, *map(lb.__getattr__, PARTS)) for name in dir(module)]
    classes = [thing for thing in things if dataclasses.is_dataclass(thing)]
    held = {word for one in classes for part in fields(one) for word in re.findall(r"\w+", str(part.type))}
    inner = {"Labels", "Result", "State", "Term"}  # of a report, of any analysis, of the problem, of a load
    assert held & ours - {one.__name__ for one in things if inspect.isclass(one)} == inner


def test_what_is_public_in_two_places_is_one_thing():
    for part in set(PARTS) - {"plots"}:  # there a name is the picture of what it names
        module = getattr(lb, part)
        for name in set(dir(module)) & set(lb.__all__):
            assert getattr(module, name) is getattr(lb, name), f"{part}.{name}"


def test_import_loads_nothing_but_itself():
    assert loaded("import limitblocks") == set()


def test_a_name_loads_what_it_needs():
    assert "shapely" in loaded("import limitblocks; limitblocks.Block")
    assert "matplotlib" not in loaded("import limitblocks; limitblocks.bounds, limitblocks.report")
    assert "cvxpy" not in loaded("import limitblocks; limitblocks.structures, limitblocks.read")


def test_help_loads_nothing_but_the_commands():
    code = """
from limitblocks.cli import main
sys.argv = ["limitblocks", "--help"]
try:
    main()
except SystemExit as end:
    assert end.code == 0
"""
    assert loaded(code) == set()


def test_signatures_fit_into_a_notebook():
    for name in ("bounds", "nonassociated", "load_path", "load_factor_range", "stability", "check_mcp"):
        assert len(str(inspect.signature(getattr(lb, name)))) < 500, name

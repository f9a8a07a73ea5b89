"""One vocabulary in every command: joints, vectors, options."""

import re

import pytest
import typer.main
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks.cli import app
from limitblocks.cli.joints import NAMES, joint_name, joints
from limitblocks.cli.vectors import Command

BLOCK = ("new", "block", "--width", 1, "--height", 0.5, "--friction", 0.6, "--force")


def run(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def commands(group, path=()):
    for name, command in group.commands.items():
        if hasattr(command, "commands"):
            yield from commands(command, (*path, name))
        else:
            yield (*path, name), command


COMMANDS = dict(commands(typer.main.get_command(app)))


def pushed():
    """Direction of the live load of the model written last."""
    ((_, load),) = lb.read("block.json").live.terms
    return tuple(load.direction)


@pytest.fixture(autouse=True)
def _empty_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize(
    "given", [("0,1,0",), ("0", "1", "0"), ("0 1 0",), ("0, 1, 0",), ("0.", "1e0", "-0")], ids="|".join
)
@pytest.mark.parametrize("option", ["--live", "--direction"])
def test_a_vector_with_commas_or_blanks(option, given):
    done = run(*BLOCK, option, *given)
    assert done.exit_code == 0, done.stderr
    assert pushed() == (0.0, 1.0, 0.0)


def test_the_first_number_of_a_vector_may_be_negative():
    assert run(*BLOCK, "--live", -1, 0, 0).exit_code == 0
    assert pushed() == (-1.0, 0.0, 0.0)


@pytest.mark.parametrize("given", [("1,0",), ("1", "0"), ("north",), ("1,0,0,0",), ("nan,0,0",)])
def test_a_wrong_vector_is_named_with_its_option(given):
    done = run(*BLOCK, "--live", *given)
    assert done.exit_code == 2
    assert "--live" in done.stderr or "unexpected extra argument" in done.stderr


def test_places_of_a_study_take_both_ways_too():
    run(*BLOCK)
    ends = ("--load", 0, 0, -1e3, "--from", -0.4, 0, "--to", "0.4,0", "--count", 2, "--workers", 1)
    done = run("study", "moving", "block.json", *ends)
    assert "unlimited" in done.stdout or done.exit_code in (0, 3)
    assert "expected" not in done.stderr


def test_help_names_every_joint_of_the_model_file():
    assert list(NAMES) == sorted(joints())


@pytest.mark.parametrize("name", NAMES)
def test_every_joint_has_one_name_in_all_commands(name):
    assert run(*BLOCK, "--joint", name).exit_code == 0
    made = lb.read("block.json")
    kind = type(made.interfaces[0].joint).__name__
    assert joint_name(kind) == joint_name(kind.lower()) == name  # the class of the model file means the same
    lb.files.write_blocks(made, "block.obj")
    more = ("--live", 1, 0, 0, "--unit-weight", 20e3, "--supports", made.supports[0], "--force")
    assert run("import", "block.obj", "--friction", 0.6, "--joint", name, *more).exit_code == 0
    assert type(lb.read("block.json").interfaces[0].joint).__name__ == kind


def test_options_of_one_name_are_the_same_in_every_command():
    """But for the file that --output writes, and --unit-weight, which `import` takes by layer, too."""
    seen, own = {}, ("--output", "--unit-weight")
    for path, command in COMMANDS.items():
        for option in command.params:
            for name in (n for n in option.opts if n.startswith("--") and n not in own):
                seen.setdefault(name, {}).setdefault(option.metavar, []).append(path)
    shared = {name: kinds for name, kinds in seen.items() if path_of(kinds) - {"new"}}
    assert {"--joint", "--friction", "--slip", "--live", "--force", "--tolerance"} <= shared.keys()
    assert {name: kinds for name, kinds in shared.items() if len(kinds) > 1} == {}


def path_of(kinds):
    return {path[0] for paths in kinds.values() for path in paths}


def test_every_command_with_a_vector_takes_it_apart():
    for path, command in COMMANDS.items():
        if any(option.metavar and re.fullmatch("[XYZ,F]{3,}", option.metavar) for option in command.params):
            assert isinstance(command, Command), path


def test_every_option_has_a_help():
    said = [
        (*path, option.name, getattr(option, "help", "argument"))
        for path, command in COMMANDS.items()
        for option in command.params
        if path[0] != "new"  # tested there
    ]
    assert [one for one in said if not one[-1]] == []

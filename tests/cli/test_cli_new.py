"""`limitblocks new`: every generator, its parameters as options, what it writes and what it refuses."""

import functools
import inspect
import re

import pytest
import typer
import typer.main
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks import cli
from limitblocks.cli.new import command, generators, left_out, parameter_texts

WALL = ("wall", "--length", 1.2, "--courses", 4, "--friction", 0.6)


@pytest.fixture(autouse=True)
def _empty_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def run(*arguments):
    return CliRunner().invoke(cli.app, ["new", *(str(argument) for argument in arguments)])


def command_of(name):
    return typer.main.get_command(cli.app).commands["new"].commands[name.replace("_", "-")]


@pytest.mark.parametrize("name", sorted(generators()))
def test_every_generator_is_a_command_with_all_its_parameters(name):
    parameters = inspect.signature(getattr(lb.structures, name)).parameters
    options = {option.name: option for option in command_of(name).params}
    assert set(parameters) - set(left_out(getattr(lb.structures, name))) <= set(options)
    for key, parameter in parameters.items():
        if key in options and key != "joint":
            assert options[key].required == (parameter.default is parameter.empty)
            assert options[key].help or key in command_of(name).help, key
    assert {"joint", "friction", "slip", "compressive_strength", "output", "force"} <= set(options)


def test_what_takes_long_says_that_it_is_at_work(monkeypatch):
    monkeypatch.setattr("limitblocks.cli.progress.EVERY", 0.002)
    done = run(*WALL)
    assert done.exit_code == 0
    assert "making wall: 0 s" in done.stderr


def test_no_public_generator_is_missing():
    made = {n for n in lb.structures.__all__ if inspect.isfunction(getattr(lb.structures, n))}
    assert made == set(generators())
    assert len(made) >= 13


def test_the_file_is_the_model_that_python_makes():
    opening = (0.4, 0.2, 0.4, 0.4)
    done = run(*WALL, "--openings", "0.4,0.2,0.4,0.4", "--direction", 0, -1, 0, "--unit-weight", 24e3)
    assert done.exit_code == 0, done.output
    made = lb.structures.wall(
        lb.OrdunaLourenco(0.6),
        length=1.2,
        courses=4,
        openings=[opening],
        direction=(0, -1, 0),
        unit_weight=24e3,
    )
    assert lb.read("wall.json").digest == made.digest


@pytest.mark.parametrize(
    ("options", "joint"),
    [
        ((), lb.OrdunaLourenco(0.6)),
        (("--slip", "paper"), lb.OrdunaLourenco(0.6, slip="paper")),
        (("--compressive-strength", 3e6), lb.OrdunaLourenco(0.6, compressive_strength=3e6)),
        (("--joint", "point-contact"), lb.PointContact(0.6)),
        (("--joint", "exact-torsion"), lb.joints.ExactTorsion(0.6)),
    ],
)
def test_joints(options, joint):
    assert run(*WALL, *options, "-o", "other.json").exit_code == 0
    assert {interface.joint for interface in lb.read("other.json").interfaces} == {joint}


def test_a_friction_in_degrees_is_asked_about():
    done = run("wall", "--length", 2, "--courses", 2, "--friction", 35)
    assert done.exit_code == 0
    assert done.stderr == "warning: friction is 35: degrees? tan 35 deg = 0.7\n"


def test_dimensions_in_mm_are_asked_about_before_the_structure_is_made():
    """3200 mm given as 3200 m were a minute of work before any question."""
    made = []

    @functools.wraps(lb.structures.tower)
    def make(**given):
        made.append(given)
        raise lb.ModelError("made")

    app = typer.Typer()
    app.command()(command(make))
    for length, asked in (("3200", "--length is 3200 m: millimetres? then 3.2 m; see units"), ("3.2", "")):
        size = ["--length", length, "--width", "3.2", "--courses", "9", "--unit-weight", "20000"]
        done = CliRunner().invoke(app, [*size, "--friction", "0.6"])
        assert done.stderr == f"warning: {asked}\n" * bool(asked) + "error: made\n"
    assert [given["length"] for given in made] == [3200.0, 3.2]


def test_nothing_is_overwritten_unless_asked():
    assert run(*WALL).exit_code == 0
    again = run(*WALL)
    assert again.exit_code == 2
    assert "--force" in again.stderr
    assert run(*WALL, "--force").exit_code == 0


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((*WALL, "--joint", "point-contact", "--compressive-strength", 1e6), "no compressive strength"),
        ((*WALL, "--joint", "point-contact", "--slip", "paper"), "no slip; leave it out"),
        ((*WALL, "--slip", "round"), "'exact', 'paper', 'inner', 'outer'"),
        ((*WALL, "--friction", -1), "friction"),
        ((*WALL, "--courses", 0), "courses"),
        ((*WALL, "--courses", "two"), "--courses"),
        ((*WALL, "--openings", "0.4,0.2"), "LEFT,SILL,WIDTH,HEIGHT"),
        ((*WALL, "--openings", "a,b,c,d"), "expected numbers"),
        ((*WALL, "--lenght", 2), "--length"),
        (("wal", "--length", 2), "wall"),
        (("wall", "--courses", 4, "--friction", 0.6), "--length"),
        ((*WALL, "-o", "missing/folder/wall.json"), "missing"),
    ],
)
def test_what_is_wrong_is_said_and_nothing_is_written(arguments, said, tmp_path):
    done = run(*arguments)
    assert done.exit_code == 2
    assert said in done.stderr
    assert "Traceback" not in done.output
    assert list(tmp_path.iterdir()) == []


def test_named_tuples_are_numbers_with_commas():
    if "piers" not in inspect.signature(lb.structures.arch).parameters:
        pytest.skip("no such parameter")
    arch = ("arch", "--radius", 2, "--thickness", 0.4, "--voussoirs", 9, "--friction", 0.7)
    assert run(*arch, "--piers", "0.6,3").exit_code == 0
    made = lb.structures.arch(
        lb.OrdunaLourenco(0.7), radius=2.0, thickness=0.4, voussoirs=9, piers=lb.structures.Piers(0.6, 3)
    )
    assert lb.read("arch.json").digest == made.digest


def test_help_is_the_docstring():
    text = " ".join(run("facade", "--help").stdout.split())
    assert "A facade with a door, a window and two return walls" in text
    assert "Number of courses." in text
    assert not re.search(r":func:|Parameters|----", text)


def test_parameter_texts():
    doc = "Return.\n\nParameters\n----------\na, b : float\n    Both, in\n    m.\nc : int\n    Count.\n"
    doc += "\nRaises\n------\nError\n    Never.\n"
    assert parameter_texts(doc) == {"a": "a, b: Both, in m.", "b": "a, b: Both, in m.", "c": "Count."}
    assert parameter_texts("Nothing.") == {}


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (
            ("--length", "1,2"),
            "'--length': '1,2': expected a number; decimals stand after a point, as in 1.2",
        ),
        (("--friction", "dry"), "'--friction': 'dry': expected a number\n"),
        (("--courses", "4,5"), "'--courses': '4,5': expected a whole number\n"),
        (("--courses", "4.5"), "'--courses': '4.5': expected a whole number\n"),
        (("--slip", "round"), "'--slip': 'round' is not one of 'exact', 'paper', 'inner', 'outer'"),
    ],
)
def test_the_value_of_an_option_is_named_with_what_is_wrong(given, said):
    result = run(*WALL, *given)
    assert result.exit_code == 2
    assert f"Invalid value for {said}" in result.stderr

"""The commands settle, capacity and vehicle, and those that add to a model."""

import json
from dataclasses import replace

import facades
import numpy as np
import pytest
from settling_blocks import beam_on
from stones import model_of
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks.cli import app
from limitblocks.practice import reinforced, tie


@pytest.fixture
def block(tmp_path):
    return lb.structures.block(lb.PointContact(0.6), width=0.2, height=1.0).save(tmp_path / "block.json")


@pytest.fixture
def beam(tmp_path):
    return facades.beam().save(tmp_path / "beam.json")


def run(*words):
    return CliRunner().invoke(app, [str(word) for word in words])


def test_settle(beam, tmp_path):
    """The beam turns about the inner edge of the left support and rests on the far edge of the right one."""
    least = 40e3 * (2.0 - 0.5) / (3.0 - 0.5)
    done = run(
        "settle", beam, "--support", "right", "--direction", 0, 0, -1, "--json", "-o", tmp_path / "s.json"
    )
    assert done.exit_code == 0, done.output
    found = json.loads((tmp_path / "s.json").read_text())
    assert found["nonassociated"] == pytest.approx(least, rel=1e-8)
    assert "24 kN" in run("settle", beam, "--support", "right").stdout
    wrong = run("settle", beam, "--support", "beam")
    assert wrong.exit_code == 2
    assert "'beam' is a free block" in wrong.output


@pytest.mark.parametrize("name", ["pier [west]", "[/b]", "pier :cat:"])
def test_names_that_look_like_markup_are_printed_as_they_are(name, tmp_path):
    """The beam turns about the inner edge of the one support and rests on the far edge of the other."""
    stones = [
        lb.Block.box("east", (0.5, 1.0, 0.2), (-1.5, 0.0, -0.1)),
        lb.Block.box(name, (0.5, 1.0, 0.2), (1.5, 0.0, -0.1)),
        lb.Block.box("beam", (4.0, 1.0, 0.5), (0.0, 0.0, 0.25), 20e3),
    ]
    path = model_of(stones, ["east", name], lb.PointContact(0.6)).save(tmp_path / "m.json")
    least = 20.0 * 4.0 * 1.0 * 0.5 * 1.25 / (1.75 + 1.25)
    done = run("settle", path, "--support", name)
    assert (done.exit_code, done.exception) == (0, None)
    head = f"  {least:.6g} kN  least reaction without dilatancy, Settlement of {name}"
    assert done.stdout.splitlines()[1] == head


def test_settle_until_collapse(tmp_path):
    """Two stones that lean on one another slide apart; each of the misuses is one line."""
    ring = lb.structures.arch(lb.PointContact(0.5), radius=1.0, thickness=0.3, voussoirs=2)
    path = ring.save(tmp_path / "ring.json")
    way = ("settle", path, "--support", "right support", "--direction", 1, 0, 0, "--until-collapse")
    done = run(*way, "--largest", 0.01, "--json")
    assert done.exit_code == 0, done.output
    found = json.loads(done.stdout)
    assert found["points"][-1]["displacement"] == pytest.approx(0.01)
    assert found["ended"] == "the settlement 0.01 m is reached"
    assert "the settlement 0.01 m is reached" in run(*way, "--largest", 0.01).stdout


def test_settle_takes_step_accuracy_and_flow(tmp_path):
    """A beam whose bearing of .2 m slides away, in steps of .04 m, falls within the accuracy."""
    beam = beam_on({"left": (-2.0, -1.6), "right": (1.6, 3.0)}, (-2.0, 1.8), lb.PointContact(0.1))
    way = ("settle", beam.save(tmp_path / "m.json"), "--support", "right", "--direction", 1, 0, 0)
    done = run(*way, "--until-collapse", "--step", 0.04, "--accuracy", 0.005, "--json")
    assert done.exit_code == 0, done.output
    found = json.loads(done.stdout)
    at = [point["displacement"] for point in found["points"]]
    assert at[-1] == pytest.approx(0.2, abs=0.005 + 1e-9)
    assert 0.0 < found["falls"] - at[-1] <= 0.005
    assert max(np.diff(at)) == pytest.approx(0.04)
    bounded = json.loads(run(*way, "--associated", "--json").stdout)
    lifted = json.loads(run(*way, "--associated", "--until-collapse", "--largest", 0.01, "--json").stdout)
    for one in (bounded, *(point["found"] for point in lifted["points"])):
        assert (one["nonassociated"], one["result"]) == (None, None)
    wrong = run(*way, "--largest", 0.1, "--step", 0.04)
    assert (wrong.exit_code, wrong.stdout) == (2, "")
    assert "Invalid value for --largest, --step: give --until-collapse, too" in wrong.output


def test_capacity(block, tmp_path):
    filed = tmp_path / "curve.md"
    at = ("--block", "block 1", "--point", 0.2, 0.5, 1.0)
    done = run("capacity", block, "--steps", 3, *at, "--json", "--report", filed)
    assert done.exit_code == 0, done.output
    assert "load factor zero at 0.196116 m" in filed.read_text()
    found = json.loads(done.stdout)
    assert found["zero"] == pytest.approx(0.196116, abs=5e-7)


def head_of(path):
    """Document of a GLB file."""
    data = path.read_bytes()
    return json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])


def test_animations(block, tmp_path):
    """A node a block and a key a point of the curve, at true size; misuse is refused."""
    pytest.importorskip("trimesh", reason="the package trimesh is not installed")
    moves, curve = tmp_path / "moves.glb", tmp_path / "curve.json"
    done = run("capacity", block, "--steps", 3, "--animation", moves, "-o", curve)
    assert done.exit_code == 0, done.output
    document = head_of(moves)
    times = document["animations"][0]["samplers"][0]["input"]
    assert document["accessors"][times]["count"] == 1 + len(json.loads(curve.read_text())["points"])
    ring = lb.structures.arch(lb.PointContact(0.5), radius=1.0, thickness=0.3, voussoirs=2)
    way = ("settle", ring.save(tmp_path / "ring.json"), "--support", "right support", "--direction", 1, 0, 0)
    spreads = tmp_path / "spreads.glb"
    assert run(*way, "--until-collapse", "--largest", 0.01, "--animation", spreads).exit_code == 0
    assert head_of(spreads)["animations"]
    for words, said in (
        ((*way, "--animation", tmp_path / "new.glb"), "--until-collapse"),
        (("capacity", block, "--animation", tmp_path / "moves.gltf"), "expected .glb"),
        (("capacity", block, "--animation", moves), "exists"),
    ):
        wrong = run(*words)
        assert wrong.exit_code == 2
        assert said in wrong.output
        assert not wrong.stdout  # refused before the analysis


def test_no_file_of_a_command_takes_the_place_of_another(block, beam, tmp_path):
    """An animation took the place of the result, a report that of the model, a result that of the curve."""
    both, curve = tmp_path / "both.glb", tmp_path / "curve.json"
    assert run("capacity", block, "--steps", 3, "-o", curve).exit_code == 0
    kept = curve.read_bytes()
    site = ("--a-g", 0.25, "--soil", 1.2, "--f0", 2.5, "--t-c", 0.5, "--q", 2)
    axle = ("--axles", 10e3, "--level", 0.5, "--first", 3.2, "--last", 3.8)
    made = tmp_path / "made.json"
    for words in (
        ("capacity", block, "--animation", both, "-o", both),
        ("vehicle", beam, *axle, "--model", made, "--report", made),
        ("verify", block, *site, "--curve", curve, "-o", curve),
        ("verify", block, *site, "--curve", curve, "--report", curve),
    ):
        done = run(*words, "--force")
        assert (done.exit_code, "reads or writes, too" in done.stderr) == (2, True), words
        assert not done.stdout  # refused before the analysis
    assert curve.read_bytes() == kept
    assert not both.exists()
    assert not made.exists()


@pytest.fixture
def tied(tmp_path):
    """A wall and a tie, as the text of a model file."""
    wall = model_of(facades.wall_stones(), ["ground"], lb.PointContact(0.6))
    rod = tie("wall", (-0.25, 0, 4.5), "ground", (-6, 0, 4.5), area=1e-4, strength=2e8)
    return reinforced(wall, rod).save(tmp_path / "tied.json").read_text()


@pytest.mark.parametrize(
    ("was", "becomes", "words"),
    [
        ('"type": "Tie", "strength": 200000000.0', '"type": "Tie", "strength": -5.0', "strength"),
        ('"friction": 0.6', '"friction": -0.6', "friction"),
        ('"block_i": "wall", "block_j": "ground", "centroid": [-3.125',
         '"block_i": "wall", "block_j": "wall", "centroid": [-3.125', "joins a block to itself"),
    ],
)  # fmt: skip
def test_misuse_in_a_file_is_one_line(tied, tmp_path, was, becomes, words):
    """A negative strength, and a tie with both ends in one block."""
    compact = json.dumps(json.loads(tied))
    assert was in compact
    path = tmp_path / "wrong.json"
    path.write_text(compact.replace(was, becomes))
    done = run("bounds", path)
    assert done.exit_code == 2
    assert words in done.output
    assert len(done.output.strip().splitlines()) == 1, done.output


def test_misuse_on_the_command_line(beam, block):
    """Settlement of a free block, of what is no block, and a spectrum without q."""
    for name, words in (("beam", "'beam' is a free block"), ("post", "'post' is not a block of the model")):
        done = run("settle", beam, "--support", name, "--until-collapse")
        assert done.exit_code == 2
        assert words in done.output
        assert len(done.output.strip().splitlines()) == 1
    done = run("verify", block, "--a-g", 0.25, "--soil", 1.2, "--f0", 2.5, "--t-c", 0.5)
    assert done.exit_code == 2
    assert "--q" in done.output
    site = ("--a-g", 0.25, "--soil", 1.2, "--f0", 2.5, "--t-c", 0.5, "--q", 2, "--linear")
    done = run("verify", block, *site, "--slc", "0.3,1.2")
    assert done.exit_code == 2
    assert "expected A_G/g,S,F0,T_C" in done.output


def test_vehicle(beam):
    """The overhang tips about x = 3: 20e3 x 4 x .5 x (3 - 2) over the moment of the axle."""
    done = run(
        "vehicle",
        beam,
        "--axles",
        10e3,
        "--level",
        0.5,
        "--first",
        3.2,
        "--last",
        3.8,
        "--count",
        3,
        "--json",
    )
    assert done.exit_code == 0, done.output
    found = json.loads(done.stdout)
    assert found["position"] == pytest.approx(3.8, abs=1e-3)
    assert found["bounds"]["lower"] == pytest.approx(40e3 / 10e3 / (found["position"] - 3.0), rel=1e-3)
    light = run("vehicle", beam, "--axles", "20", "--level", 0.5, "--first", 3, "--last", 4, "--count", 3)
    assert "warning: the heaviest axle is 20 N: kN? 20 kN = 20000 N" in light.output
    place = ("--level", 0.5, "--first", 3, "--last", 4, "--count", 3)
    long = run("vehicle", beam, "--axles", "10e3,10e3", "--distances", "0,1200", *place)
    assert "warning: the axles are 1200 m or more apart: millimetres? 1200 mm = 1.2 m" in long.stderr
    wagon = run("vehicle", beam, "--axles", "10e3,10e3", "--distances", "0,25", *place)
    assert "apart" not in wagon.stderr
    assert "--axles" in run("vehicle", beam, "--axles", "x", "--level", 0.5, "--first", 3, "--last", 4).output


def test_a_bridge_from_the_shell(tmp_path):
    """A bridge of two spans, fill that resists, a vehicle over all of it, a PDF."""
    pypdf = pytest.importorskip("pypdf", reason="the package pypdf is not installed")
    bare, held, filed = tmp_path / "bridge.json", tmp_path / "held.json", tmp_path / "bridge.pdf"
    shape = ("--span", 3, "--rise", 0.75, "--thickness", 0.3, "--voussoirs", 7, "--pier-width", 0.8)
    made = run(
        "new", "arch-bridge", *shape, "--spans", 2, "--fill", "0.3,20e3", "--friction", 0.6, "-o", bare
    )
    assert made.exit_code == 0, made.output
    model = lb.read(bare)
    level = max(block.vertices[:, 2].max() for block in model.free_blocks) + 0.3
    done = run("backfill", bare, "--level", level, "--unit-weight", 20e3, "--passive", 3, "-o", held)
    assert done.exit_code == 0, done.output
    assert "fill holds 12 blocks on 12 faces" in done.output  # all voussoirs but the two at the crowns
    assert "active pressure" not in done.output
    active = run(
        "backfill", bare, "--level", level, "--unit-weight", 20e3, "--passive", 0.3, "-o", tmp_path / "a.json"
    )
    assert "coefficient of passive pressure is 0.3, below 1: that of active pressure?" in active.stderr
    assert "fill that resists already" not in active.stderr
    again = run(
        "backfill", held, "--level", level, "--unit-weight", 20e3, "--passive", 3, "-o", tmp_path / "b.json"
    )
    assert "the model has fill that resists already; this adds to it" in again.stderr
    assert "fill resists 'span 1 voussoir 1'" in run("info", tmp_path / "b.json").output
    words = ("--axles", "50e3,50e3", "--distances", "0,1.2", "--level", level, "--count", 5)
    found = json.loads(run("vehicle", bare, *words, "--json").stdout)
    x = [block.vertices[:, 0] for block in model.free_blocks]
    assert min(found["positions"]) == pytest.approx(min(part.min() for part in x) - 1.2)
    assert max(found["positions"]) == pytest.approx(max(part.max() for part in x))
    resisting = run("vehicle", held, *words, "--report", filed, "-o", tmp_path / "v.json")
    assert resisting.exit_code == 0, resisting.output
    better = lb.read_result(tmp_path / "v.json", lb.read(held))
    assert better.bounds.lower > 1.02 * found["bounds"]["lower"]
    said = " ".join(page.extract_text() for page in pypdf.PdfReader(filed).pages)
    for word in (
        "Vehicle on the deck",
        "worst",
        "passive resistance of fill",
        "50, 50 kN",
        "0, 1.2 m along X",
    ):
        assert word in said, word
    assert said.count("Fill resists blocks") == 1  # 12 pressures, and one assumption
    assert (better.vehicle.axles, better.deck.level) == ((50e3, 50e3), level)
    assert run("vehicle", bare, *words, "--first", 1).exit_code == 2


def test_fill_on_one_side_of_a_wall_from_the_shell(tmp_path):
    """W = 20e3 x 3, E = gamma .5 h / 2: off the fill alpha W = mu (W + E)."""
    outline = [(-1, 0), (1, 0), (0.5, 2), (-0.5, 2)]
    stones = [
        lb.Block.box("ground", (8, 1, 0.4), (0, 0, -0.2)),
        lb.Block.prism("wall", outline, (0, 1), 20e3),
    ]
    wall = model_of(stones, ["ground"], lb.PointContact(0.3), (-1, 0, 0))
    file, held, whole = wall.save(tmp_path / "wall.json"), tmp_path / "held.json", tmp_path / "whole.json"
    fill = ("--level", 2, "--unit-weight", 18e3, "--passive", 3)
    done = run("backfill", file, *fill, "--weight", "--beyond", 0, 0, "--towards", 1, 0, "-o", held)
    assert (done.exit_code, done.stderr) == (0, "")
    W, E = 60e3, 18e3 * 0.5 * 2 / 2
    assert lb.bounds(lb.read(held)).lower == pytest.approx(0.3 * (W + E) / W, rel=1e-6)
    half = replace(wall, dead=lb.read(held).dead).save(tmp_path / "half.json")
    assert "from the other side" in run("backfill", half, *fill, "-o", whole).stderr

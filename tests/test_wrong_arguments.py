"""What a newcomer gives by mistake is named, with what would be right."""

import copy
import pickle
import re
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.practice import capacity_curve, settlement, uplift
from limitblocks.practice.advance import farthest
from limitblocks.reports.words import together

JOINT = lb.PointContact(0.6)
BARRIER, MEANS = lb.settings.Barrier, lb.settings.Means


@pytest.fixture(scope="module")
def wall():
    return lb.structures.wall(lb.PointContact(0.6), length=1.6, courses=2)


@pytest.mark.parametrize(
    "ask",
    [
        lb.bounds,
        lb.nonassociated,
        lb.load_path,
        lb.stability,
        lb.load_factor_range,
        lb.diagnose,
        lb.report,
        lambda model: lb.check_mcp(model, None),
        lambda model: lb.interface_states(model, None),
        lambda model: lb.sensitivities(model, None),
        lambda model: lb.files.write_forces(model, "wall.glb", None),
        lambda model: lb.files.write_vtu(model, "wall.vtu"),
        lambda model: lb.files.write_animation(model, "wall.glb", None),
    ],
)
def test_the_name_of_a_file_is_no_model(ask):
    with pytest.raises(
        lb.ModelError, match=r"model is a str, expected a Model; limitblocks.read\('wall.json'\)"
    ):
        ask("wall.json")


def test_what_is_no_block_is_not_written_or_chosen(wall):
    with pytest.raises(lb.ModelError, match=r"blocks is 'wall.obj', expected a sequence of Block"):
        lb.files.write_blocks("wall.obj", wall)
    with pytest.raises(lb.ModelError, match="supports is 3, expected a sequence of str"):
        lb.files.select(wall.blocks, 3, "supports")


@pytest.mark.parametrize(
    ("word", "value", "said"),
    [
        ("supports", "base", "supports is 'base', expected a sequence of str"),
        ("blocks", ["base"], "blocks holds 'base', expected a sequence of Block"),
        ("interfaces", None, "interfaces is None, expected a sequence of Interface"),
        ("live", (1.0, 0.0, 0.0), "live is .*expected a load such as mass_proportional"),
        ("dead", None, "dead is None, expected a load"),
    ],
)
def test_parts_of_a_model_are_what_they_should_be(wall, word, value, said):
    with pytest.raises(lb.ModelError, match=said):
        replace(wall, **{word: value})


def test_all_contacts_are_no_interfaces(wall):
    found = lb.find_contacts(wall.blocks, lb.PointContact(0.6))
    with pytest.raises(lb.ModelError, match="expected a sequence of Interface"):
        replace(wall, interfaces=found)


@pytest.mark.parametrize("joint", [lb.OrdunaLourenco, lb.PointContact])
def test_friction_is_a_number(joint):
    with pytest.raises(lb.ModelError, match="friction is 'high'"):
        joint(friction="high")


def test_notes_on_many_blocks_are_one():
    notes = ["block 'a': is mended", "unit of length is mm", *(f"block 'b{k}': is turned" for k in range(9))]
    said = together(notes)
    assert said[:2] == ["block 'a': is mended", "unit of length is mm"]
    shown = ", ".join(f"'b{k}'" for k in range(8))
    assert said[2:] == [f"9 blocks {shown} and 1 more: is turned"]


def test_notes_that_differ_in_numbers_alone_are_one_with_the_least_and_the_most():
    """Numbers are compared as such, not as text; what is not of a block stays as it is."""
    notes = [
        f"block 'b{k}': {n} of 6 bent, up to {off} m"
        for k, (n, off) in enumerate([(2, "9e-5"), (10, "0.02")])
    ]
    said = together([*notes, "block 'c': 3 of 7 left out", "layer 1", "layer 2"])
    assert said == [
        "2 blocks 'b0', 'b1': 2 to 10 of 6 bent, up to 9e-5 to 0.02 m",
        "block 'c': 3 of 7 left out",
        "layer 1",
        "layer 2",
    ]


@pytest.mark.parametrize(
    ("ask", "said"),
    [
        (lambda model: lb.nonassociated(model, dilatancy="0.1"), "dilatancy is '0.1', expected 0 to"),
        (lambda model: lb.bounds(model, tolerance=0), "tolerance is 0, expected a finite number > 0"),
        (lambda model: lb.nonassociated(model, tolerance="tight"), "tolerance is 'tight', expected"),
        (lambda model: lb.nonassociated(model, tolerance="1e-8"), "tolerance is '1e-8', expected"),
        (lambda model: lb.bounds(replace(model, dead=float("nan") * model.dead)), "factor of a load is nan"),
        (
            lambda model: lb.nonassociated(model, method="fixed point", means=[]),
            "means are paths to follow; method='fixed point' follows none",
        ),
        (lambda model: lb.load_path(model, tolerance=-1), "tolerance is -1, expected"),
        (lambda model: lb.load_path(model, settings={"first": 0.1}), "settings is a dict, expected Settings"),
        (lambda model: lb.load_factor_range(model, paths=2.5), "paths is 2.5, expected a whole number"),
        (
            lambda model: lb.load_factor_range(model, seed=-1),
            "seed is -1, expected a whole number of at least",
        ),
        (lambda model: lb.load_factor_range(model, seed="a"), "seed is 'a', expected a whole number of at"),
        (lambda model: lb.load_factor_range(model, progress=3), "progress is a int, expected a function"),
        (lambda model: lb.bounds(model, progress=3), "progress is a int, expected a function"),
        (lambda model: lb.nonassociated(model, progress="x"), "progress is a str, expected a function"),
        (lambda model: lb.load_path(model, progress=3), "progress is a int, expected a function"),
        (lambda model: lb.load_factor_range(model, time_limit=0), "time_limit is 0, expected more than 0 s"),
        (lambda model: lb.sensitivities(model, model), "bounds is a Model, expected Bounds"),
        (lambda model: lb.studies.sweep(model, [0.5]), "maker is a Model, expected a function"),
        (lambda model: lb.studies.sweep(lambda mu: model, 5), "values is 5, expected a sequence"),
        (lambda model: lb.loads.compass("8"), "count of directions is '8', expected a whole number of at"),
        (lambda model: lb.loads.compass(2.5), "count of directions is 2.5, expected a whole number of at"),
        (lambda model: lb.studies.minimum(model, 0.1, 0.9), "maker is a Model, expected a function"),
        (lambda model: lb.find_interfaces(model.blocks[0], JOINT), "blocks is <block .*expected a sequence"),
        (lambda model: lb.heal("wall.obj"), "blocks is 'wall.obj', expected a sequence of Block"),
        (
            lambda model: lb.find_contacts(model.blocks, lb.PointContact),
            "joint is the class PointContact, exp",
        ),
        (lambda model: lb.studies.directions(model.live, 4), "model is a Load, expected a Model"),
        (lambda model: lb.studies.moving_load("m.json", (0, 0, -1.0), [(0, 0)]), "model is a str, expected"),
    ],
)
def test_arguments_of_an_analysis_are_refused_by_name(wall, ask, said):
    with pytest.raises(lb.ModelError, match=said):
        ask(wall)


def test_a_figure_of_a_result_without_its_model(wall):
    pytest.importorskip("matplotlib")
    result = lb.nonassociated(wall)
    for draw in (lambda: lb.plots.structure(result), lambda: lb.plots.thrust_line(result, wall)):
        with pytest.raises(lb.ModelError, match="model is a Nonassociated, expected a Model"):
            draw()
    with pytest.raises(lb.ModelError, match="sensitivities is a Nonassociated, expected Sensitivities"):
        lb.plots.sensitivity(wall, result)


def test_a_mass_is_no_load():
    mass = lb.loads.added_mass("wall 1.1", (0, 0, 0), weight=1e3)
    with pytest.raises(lb.ModelError, match=r"cannot be added to a load; masses go into self_weight\(\[mass"):
        lb.self_weight() + mass
    with pytest.raises(lb.ModelError, match=r"added is AddedMass.*expected a sequence of AddedMass"):
        lb.self_weight(mass)


BOX = lb.Block.box("box", (1, 1, 1), (0, 0, 0.5), 2e4)
SQUARE = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]
FACE = lb.joints.interface(SQUARE, lb.OrdunaLourenco(0.6))
TEXTS = [
    ("unit weight is '20'", lambda _: lb.Block.box("box", (1, 1, 1), (0, 0, 0), "20")),
    ("size", lambda _: lb.Block.box("box", ("1", 1, 1), (0, 0, 0))),
    ("between", lambda _: lb.Block.prism("prism", SQUARE, ("0", 1))),
    ("vertices", lambda _: lb.Block("box", BOX.vertices.astype(str).tolist(), BOX.faces)),
    ("translation", lambda _: BOX.moved(np.eye(3), (0, 0, "1"))),
    ("polygon is [['1', 2]], expected numbers", lambda wall: replace(wall.interfaces[0], polygon=[["1", 2]])),
    (
        "centroid is ['1', 0, 0]",
        lambda wall: replace(wall.interfaces[0], centroid=["1", 0, 0]),
    ),
    ("axes is array(", lambda wall: replace(wall.interfaces[0], axes=np.eye(3).astype(str))),
    ("block_i of an interface is 1", lambda wall: replace(wall.interfaces[0], block_i=1)),
    ("unit weight is '20'", lambda _: lb.joints.Material("20")),
    ("unit weight is nan", lambda _: lb.joints.Material(float("nan"))),
    ("joint is 0.6, expected one such as", lambda _: lb.joints.Material(joint=0.6)),
    ("blocks are 'wall', expected a list", lambda _: lb.joints.Material(blocks="wall")),
    ("values is '0.4', expected a sequence", lambda wall: lb.studies.sweep(lambda _: wall, "0.4")),
    ("axle load is '1'", lambda _: lb.practice.Vehicle(["1"])),
    ("axle load is [1.0]", lambda _: lb.practice.Vehicle([[1.0], 2.0], [0.0, 1.0])),
    ("gap is '1e-3'", lambda wall: lb.find_contacts(wall.blocks, JOINT, gap="1e-3")),
    ("angle is '0.01'", lambda wall: lb.find_contacts(wall.blocks, JOINT, angle="0.01")),
    ("accuracy is '0.001'", lambda wall: lb.heal(wall.blocks, accuracy="0.001")),
    ("gap of the tolerances is '1'", lambda _: lb.settings.Tolerances(gap="1")),
    ("direction", lambda _: lb.structures.wall(JOINT, length=1.2, courses=2, direction=("1", 0, 0))),
    (
        "fill height is '1', expected a number >= 0; fill inertia is '1'",
        lambda _: lb.structures.arch(
            JOINT, radius=2, thickness=0.4, voussoirs=9, fill=lb.structures.Fill("1", inertia="1")
        ),
    ),
    ("length of a tie is '1'", lambda _: lb.joints.Tie(2e8, "1")),
    ("prestress of a tie is '1'", lambda _: lb.joints.Tie(2e8, prestress="1")),
    ("finite array", lambda _: lb.joints.interface([("0", 0), (1, 0), (0, 1)], JOINT)),
    ("given is", lambda _: FACE.joint.strength(FACE, (0, 0, 0, 0, 0, 1), given=("0", 0, -1, 0, 0, 0))),
    ("direction is", lambda _: lb.mass_proportional(("1", 0, 0))),
    ("force", lambda _: lb.loads.force("wall 1.1", ("1", 0, 0), (0, 0, 0))),
    ("place is", lambda _: lb.loads.top_force((0, 0, -1), ("0.3", 0))),
    ("angle is '0.1'", lambda _: lb.loads.tilting((1, 0, 0)).at("0.1")),
    ("time_limit is '1'", lambda wall: lb.load_factor_range(wall, time_limit="1")),
    ("stiffness", lambda wall: lb.load_path(wall, stiffness=("1e9", 1e9))),
    ("low is '0.1'", lambda wall: lb.studies.minimum(lambda _: wall, "0.1", 0.9)),
    ("tolerance is '0.1'", lambda wall: lb.studies.minimum(lambda _: wall, 0.1, 0.9, tolerance="0.1")),
    ("load factor is '0'", lambda wall: lb.studies.minimum(lambda _: wall, 0.1, 0.9, load_factor="0")),
    ("finite numbers", lambda wall: lb.studies.directions(wall, [("1", 0, 0)])),
    ("expected (low, high)", lambda wall: lb.study(lambda friction: wall, {"friction": ("0.1", "0.9")}, 2)),
    ("control point is", lambda wall: capacity_curve(wall, control=("wall 1.1", ("0", 0, 0)))),
    ("share of the water pressure is '1'", lambda wall: uplift(wall, 1.0, share="1")),
    (
        "step is '1e-5'",
        lambda wall: lb.studies.shape_sensitivity(wall, lb.bounds(wall), lambda points: points, step="1e-5"),
    ),
]


@pytest.mark.parametrize(("said", "ask"), TEXTS, ids=[said for said, _ in TEXTS])
def test_a_number_written_as_text_is_none(wall, said, ask):
    """Numpy and float read it: texts of a table would pass in one place and fail in the next."""
    with pytest.raises(lb.ModelError, match=re.escape(said)):
        ask(wall)


NUMBERS = [int, float, np.float32, np.float64, np.int32, np.int64]


@pytest.mark.parametrize("kind", NUMBERS)
def test_a_number_is_one_whatever_its_kind(kind, tmp_path):
    """As numpy and tables give them: 3000000 Pa is 3e6 Pa, in the digest of a model and in its file."""
    model, other = (
        lb.structures.block(lb.OrdunaLourenco(0.5, compressive_strength=strength), width=1, height=kind(2))
        for strength in (kind(3_000_000), 3e6)
    )
    assert model.digest == other.digest == lb.read(model.save(tmp_path / "block.json")).digest
    bounds = lb.bounds(model, tolerance=np.float32(1e-6))
    kept = lb.read_result(bounds.save(tmp_path / "bounds.json"), other)
    assert kept.lower == bounds.lower
    lb.report(model, bounds, demand=kind(1)).save(tmp_path / "report.json")
    assert len(lb.studies.directions(model, np.int64(2)).load_factors) == 2
    assert farthest(kind(1), "displacement") == 1.0


def test_the_seed_of_a_study_may_be_of_numpy(tmp_path):
    def made(friction):
        return lb.structures.block(lb.PointContact(friction), width=1.0, height=2.0)

    between = {"friction": (np.float32(0.4), np.float32(0.6))}
    kept = [
        lb.study(made, between, np.int64(2), seed=s, file=tmp_path / "s.jsonl").table()
        for s in (np.int64(1), 1)
    ]
    assert kept[0] == kept[1]


@pytest.mark.parametrize(
    ("ask", "said"),
    [
        (lambda wall: lb.report(wall, title=5), "title is a int, expected str"),
        (lambda wall: lb.report(wall, notes=["a", "b"]), "notes is a list, expected str"),
        (lambda wall: lb.report(wall, demand="0.15"), "demand is '0.15', expected a load factor > 0"),
        (lambda wall: lb.report(wall, failed="bounds"), "failed is 'bounds', expected a sequence of str"),
        (lambda wall: lb.nonassociated(wall, means=3), "means is 3, expected a sequence of Means"),
        (lambda wall: lb.nonassociated(wall, means=[MEANS(3, 1, 9)]), "barrier of means is a int, expected"),
        (lambda wall: lb.nonassociated(wall, means=[MEANS(BARRIER(), -1, 9)]), "seed of means is -1"),
        (lambda wall: lb.nonassociated(wall, means=[MEANS(BARRIER(), 1, -1)]), "budget of means is -1"),
        (lambda wall: lb.nonassociated(wall, means=[MEANS(BARRIER(), 1, 9, 0)]), "patience of means is 0"),
        (lambda wall: BARRIER(size=0.0), "size of the barrier is 0.0, expected a finite number > 0"),
        (lambda wall: BARRIER(power=-1.0), "power of the barrier is -1.0"),
        (lambda wall: BARRIER(floor=-1.0), "floor of the barrier is -1.0"),
        (lambda wall: BARRIER(opening=0.0), "opening of the barrier is 0.0"),
        (lambda wall: lb.settings.Settings(first=float("nan")), "first of the settings is nan"),
        (lambda wall: lb.settings.Settings(growth=1.0), "growth of the settings is 1.0"),
        (lambda wall: lb.settings.Settings(barrier=0.0), "barrier of the settings is 0.0"),
        (lambda wall: lb.settings.Settings(left=-1e-9), "left of the settings is -1e-09"),
        (lambda wall: lb.settings.Settings(budget=1.5), "budget of the settings is 1.5"),
        (lambda wall: settlement(wall, [], (0, 0, -1)), "settlement of no support: expected supports"),
        (lambda wall: lb.loads.fill(2e4, 1.0, blocks=3), "blocks is 3, expected a sequence of str"),
        (lambda wall: lb.loads.pressure([wall], 1.0, facing=(1, 0, 0)), "blocks holds <model"),
    ],
)
def test_labels_means_and_names_are_refused_by_name(wall, ask, said):
    with pytest.raises(lb.LimitBlocksError, match=re.escape(said)):
        ask(wall)


@pytest.mark.parametrize("again", [copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))])
def test_copies_are_as_read_only_as_what_they_are_of(wall, again):
    """A block whose vertices are written to keeps its centroid, its volume and the digest of the model."""
    model, result = again((wall, lb.nonassociated(wall)))
    for array in (model.blocks[0].vertices, model.interfaces[0].centroid, result.stress_resultants):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 1.0
    assert model.digest == wall.digest


@pytest.mark.parametrize("again", [copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))])
@pytest.mark.parametrize(
    "error",
    [
        lb.ModelError("left: no unit weight", "right: no unit weight"),
        lb.errors.NoEquilibrium(("left", "lintel"), ("pier",)),
        lb.NotConverged("not converged", "the best state"),
        lb.errors.UnlimitedLoad("jams"),
    ],
    ids=lambda error: type(error).__name__,
)
def test_an_error_of_another_process_says_the_same(error, again):
    """One that cannot be read back breaks the pool of processes, and the work of all its tasks is lost."""
    copied = again(error)
    assert (type(copied), str(copied), vars(copied)) == (type(error), str(error), vars(error))


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: lb.PointContact(True), "friction is True, expected a finite coefficient"),
        (lambda: lb.OrdunaLourenco(0.6, cohesion=True), "cohesion is True Pa, expected a finite stress"),
        (lambda: lb.Block.box("a", (1, 1, 1), (0, 0, 0), True), "True"),
        (lambda: 2.0 * lb.self_weight() / True, "divisor of a load is True, expected a finite number"),
    ],
)
def test_true_is_no_number(make, said):
    with pytest.raises(lb.ModelError, match=said):
        make()


@pytest.mark.parametrize("value", [Decimal("20000"), Fraction(20000), np.float32(2e4), np.int64(20000)])
def test_numbers_of_any_kind_are_taken(value):
    assert lb.Block.box("a", (1, 1, 1), (0, 0, 0), value).weight == 20e3


@pytest.mark.parametrize("ask", [lb.diagnose, lb.bounds, lb.stability])
def test_a_friction_in_place_of_a_joint_is_named(ask, wall):
    with pytest.raises(lb.ModelError, match=r"joint is 0\.6, expected a joint such as OrdunaLourenco"):
        ask(replace(wall, interfaces=lb.find_interfaces(wall.blocks, 0.6)))


FILES = {
    "read": lb.read,
    "read_blocks": lb.files.read_blocks,
    "read_drawing": lambda file: lb.files.read_drawing(file, thickness=1.0),
    "read_materials": lb.files.read_materials,
    "read_result": lb.files.read_result,
    "look": lb.files.look,
}


@pytest.mark.parametrize("file", [3, None, b"wall.json", ["wall.json"]])
@pytest.mark.parametrize("ask", FILES)
def test_what_names_no_file_is_named(ask, file):
    with pytest.raises(lb.ModelError, match=re.escape(f"file is {file!r}, expected its name: a str or Path")):
        FILES[ask](file)


@pytest.mark.parametrize(
    "ask",
    [
        lambda wall: wall.save(None),
        lambda wall: lb.files.write_blocks(wall, None),
        lambda wall: lb.files.write_vtu(wall, None),
        lambda wall: lb.files.write_animation(wall, None, None),
        lambda wall: lb.files.write_forces(wall, None, None),
        lambda wall: lb.report(wall).save(None),
    ],
)
def test_nothing_is_written_to_what_names_no_file(ask, wall):
    with pytest.raises(lb.ModelError, match="file is None, expected its name"):
        ask(wall)


@pytest.mark.parametrize(
    ("ask", "said"),
    [
        (lambda file: lb.files.read_blocks(file, units=[]), r"units are \[\]; expected one of"),
        (lambda file: lb.files.read_blocks(file, unit_weight={3: 1.0}), "unit weight of layer 3: there are"),
        (lambda file: lb.files.read_drawing(file, thickness=None), "thickness is None; expected a number"),
        (lambda file: lb.files.read_drawing(file, thickness=1.0, layers=3), "layers is 3, expected a seq"),
        (lambda file: lb.files.read_drawing(file, thickness=1.0, layers=[3]), "layers holds 3, expected a"),
    ],
)
def test_what_says_how_to_read_a_file_is_checked(ask, said, wall, tmp_path):
    file = lb.files.write_blocks(wall, tmp_path / "wall.dxf")
    with pytest.raises(lb.ModelError, match=said):
        ask(file)


def test_nothing_to_heal_and_blocks_that_are_a_model_are_named(wall):
    with pytest.raises(lb.ModelError, match="no blocks given; expected at least one"):
        lb.heal([], 1e-3)
    with pytest.raises(lb.ModelError, match="expected a sequence of Block"):
        lb.files.select(wall, "base")

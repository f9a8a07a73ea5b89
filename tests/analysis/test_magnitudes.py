"""Numbers of the wrong magnitude are asked about, and plausible ones are not."""

import logging
from dataclasses import replace

import numpy as np
import pytest
from stones import model_of
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks import structures
from limitblocks.analysis.magnitudes import questions
from limitblocks.cli import app
from limitblocks.joints import Tie
from limitblocks.practice import PartialFactors, design_model, dowel, passive_fill, reinforced, strip, tie


def block(joint=None, **change):
    settings = {"width": 0.5, "height": 1.0, "unit_weight": 20e3} | change
    return structures.block(joint or lb.OrdunaLourenco(0.6), **settings)


def arched(**change):
    return structures.arch(lb.PointContact(0.7), radius=2.0, thickness=0.4, voussoirs=8, **change)


@pytest.mark.parametrize(
    ("model", "question"),
    [
        (block(lb.PointContact(30.0)), "friction is 30: degrees? tan 30 deg = 0.577"),
        (block(lb.PointContact(300.0)), "friction is 300: a coefficient is below 2"),
        (
            block(lb.OrdunaLourenco(0.6, compressive_strength=2.0)),
            "compressive strength is 2 Pa: MPa? 2 MPa = 2e+06 Pa",
        ),
        (
            block(lb.OrdunaLourenco(0.6, cohesion=3e3, tensile_strength=5.1e3)),
            "tensile strength is 5100 Pa: of it 5e+03 Pa counts, cohesion / friction; more cohesion?",
        ),
        (block(lb.OrdunaLourenco(0.6, cohesion=0.1)), "cohesion is 0.1 Pa: MPa? 0.1 MPa = 100000 Pa"),
        (block(unit_weight=20.0), "unit weight is 20 N/m3: kN/m3? 20 kN/m3 = 20000 N/m3"),
        (block(unit_weight=2000.0), "unit weight is 2000 N/m3: kg/m3? 2000 kg/m3 weigh 1.962e+04 N/m3"),
        (block(unit_weight=20e6), "unit weight is 2e+07 N/m3, more than any material weighs"),
        (
            block(lb.OrdunaLourenco(0.6, compressive_strength=2e15)),
            "compressive strength is 2e+15 Pa, more than any stone bears",
        ),
        (
            block(lb.OrdunaLourenco(0.6, compressive_strength=1.5e9)),
            "compressive strength is 1.5e+09 Pa, more",
        ),
        (arched(fill=(0.3, 18.0)), "fill or pressure: unit weight is 18 N/m3: kN/m3?"),
        (block(width=8000.0), "the structure is "),
        (block(width=0.01, height=0.01, depth=0.01), "the structure is "),
    ],
)
def test_what_a_colleague_would_ask(model, question):
    (asked,) = questions(model)
    assert asked.startswith(question)


@pytest.mark.parametrize(
    ("weight", "fill", "pressure"),
    [
        (18.0, "unit weight is 18 N/m3: kN/m3?", "unit weight is 18 N/m3: kN/m3?"),
        (1800.0, "unit weight is 1800 N/m3: kg/m3?", None),  # of soil; its pressure may grow as slowly
        (1000.0, "unit weight is 1000 N/m3: kg/m3?", "unit weight is 1000 N/m3: kg/m3?"),  # of water
        (
            18e6,
            "unit weight is 1.8e+07 N/m3, more than of concrete",
            "unit weight is 1.8e+07 N/m3, more than",
        ),
        (2.5e3, None, None),  # expanded clay
        (9.81e3, None, None),
        (25e3, None, None),
        (1.0, None, None),  # the load factor is the unit weight
    ],
)
def test_unit_weights_of_fill_and_of_what_presses_a_face_are_asked_about(weight, fill, pressure):
    model = block()
    dead = replace(model, dead=model.dead + lb.loads.fill(weight, 2.0))
    live = replace(model, live=lb.loads.pressure("block 1", facing=(-1, 0, 0), unit_weight=weight, level=1.0))
    for asked, said in ((questions(dead), fill), (questions(live), pressure)):
        assert len(asked) == bool(said)
        assert not said or asked[0].startswith(f"fill or pressure: {said}")


@pytest.mark.parametrize("name", structures.EXAMPLES)
def test_plausible_models_raise_no_question(name):
    assert questions(structures.EXAMPLES[name](lb.OrdunaLourenco(0.8, compressive_strength=3e5))) == []


def test_tensile_strength_up_to_cohesion_over_friction_is_not_asked_about():
    """Whatever rounding makes of the product: .9 x 5001 is above 4500.9 in binary numbers."""
    for tension in range(5001, 5100):
        joint = lb.OrdunaLourenco(0.9, cohesion=9 * tension / 10, tensile_strength=tension)
        assert questions(block(joint)) == []
        assert joint.counted_tension == tension


def test_questions_reach_whoever_imports_and_reports(tmp_path, caplog):
    file = lb.files.write_blocks(block().blocks, tmp_path / "house.obj")
    said = "friction is 30: degrees? tan 30 deg = 0.577"
    options = ["--friction", "30", "--live", "1,0,0", "--unit-weight", "20e3", "--supports", "base"]
    result = CliRunner().invoke(app, ["import", str(file), *options])
    assert f"warning: {said}" in result.stderr
    assert said in CliRunner().invoke(app, ["info", str(tmp_path / "house.json")]).output.replace("\n", " ")
    with caplog.at_level(logging.WARNING, logger="limitblocks"):
        lb.read(file, joint=lb.PointContact(30.0), supports="base", live=lb.mass_proportional((1, 0, 0)),
                unit_weight=20e3)  # fmt: skip
    assert any(said in line for line in caplog.messages)


def test_questions_are_asked_before_an_analysis(tmp_path):
    """A unit weight in kN/m3 where the file states kN and mm: platinum weighs 210 kN/m3, this 2e10 kN/m3."""
    file = tmp_path / "heavy.json"
    text = """{"schema_version": 1, "units": {"length": "mm", "force": "kN"}, "supports": ["g"],
     "blocks": [{"name": "g", "box": {"size": [4000, 1000, 200], "at": [0, 0, -100]}},
                {"name": "s", "box": {"size": [500, 500, 1000], "at": [0, 0, 500]}, "unit_weight": 20}],
     "joints": {"dry": {"type": "PointContact", "friction": 0.6}}, "interfaces": {"find": {"joint": "dry"}},
     "live": [{"type": "MassProportional", "direction": [1, 0, 0]}]}"""
    file.write_text(text)
    result = CliRunner().invoke(app, ["bounds", str(file), "--json"])
    assert result.exit_code == 0
    assert "warning: unit weight is 2e+13 N/m3, more than any material weighs" in result.stderr
    assert "warning" not in result.stdout


def with_roof(dead, live):
    """A block with a roof on top that is given to the dead load, to the live load, or to both."""
    model, roof = block(), lb.loads.added_mass("block 1", at=(0.0, 0.0, 1.0), weight=5e3)
    loads = lb.self_weight([roof] * dead), lb.mass_proportional((1, 0, 0), [roof] * live)
    return replace(model, dead=loads[0], live=loads[1])


@pytest.mark.parametrize(("dead", "live", "alone"), [(True, False, "dead"), (False, True, "live")])
def test_a_mass_forgotten_in_one_of_the_loads_is_asked_about(dead, live, alone):
    (asked,) = questions(with_roof(dead, live))
    assert asked.startswith(f"the mass fixed to 'block 1' at (0, 0, 1) m acts in the {alone} load alone")
    assert questions(with_roof(True, True)) == questions(with_roof(False, False)) == []


def test_a_study_asks_as_an_analysis_does(tmp_path):
    file = with_roof(True, False).save(tmp_path / "roof.json")
    result = CliRunner().invoke(app, ["study", "directions", str(file), "--count", "1", "--workers", "1"])
    assert "warning: the mass fixed to 'block 1'" in result.stderr


def test_blocks_without_weight_are_asked_about():
    model = block()
    light = [replace(one, unit_weight=0.0) for one in model.blocks]
    roof = lb.loads.added_mass("block 1", at=(0.0, 0.0, 1.0), weight=5e3)
    loads = lb.self_weight([roof]), lb.mass_proportional((1, 0, 0), [roof])
    assert questions(replace(model, blocks=light, dead=loads[0], live=loads[1])) == [
        "without weight: block 'block 1'"
    ]


@pytest.mark.parametrize(
    ("dead", "asked"),
    [
        (
            lb.loads.force("block 1", (0.0, 0.0, -20.0), (0.0, 0.0, 1.0)),
            "20 N on a block of 1e+04 N; kN? see units",
        ),
        (lb.loads.force("block 1", (0.0, 0.0, -20e3), (0.0, 0.0, 1.0)), ""),
        (20e3 * lb.loads.force("block 1", (0.0, 0.0, -1.0), (0.0, 0.0, 1.0)), ""),
        (lb.loads.force("block 1", (5e3, 0.0, 0.0), (0.0, 0.0, 1000.0)), "that is 999.5 m off the centroid"),
        (lb.loads.force("block 1", (0.0, 0.0, -5e3), (0.0, 0.0, 1000.0)), ""),  # on its line all are one
    ],
)
def test_forces_in_other_units_are_asked_about(dead, asked):
    """A block of .5 m x 1 m x 1 m and 10 kN: kN for N, and mm for m, were silent."""
    said = questions(replace(model := block(), dead=model.dead + dead))
    assert len(said) == bool(asked)
    assert not asked or asked in said[0]


@pytest.mark.parametrize(
    ("at", "asked"),
    [
        ((0.0, 0.5, 2.0), ""),  # on the edge of both
        ((0.0, 0.5, 2.4), "that is in block 'block 3'"),
        ((0.0, 0.0, 0.9), "that is in block 'block 1'"),
        ((0.0, 2.0, 3.5), ""),  # on a bracket: 2.8 m off
        ((0.0, 2.5, 4.5), "that is 3.905 m off the centroid of the block, 1 m large"),
    ],
)
def test_a_force_that_is_off_its_block_is_asked_about(at, asked):
    """Columns of blocks of 1 m x 1 m x 1 m, six high: a force on the second one."""
    model = lb.structures.column(lb.PointContact(0.6), count=6, width=1.0, height=1.0)
    said = questions(replace(model, live=lb.loads.force("block 2", (5e3, 0.0, 0.0), at)))
    assert len(said) == bool(asked)
    assert not asked or asked in said[0]


def test_no_structure_of_the_library_is_asked_about_where_its_forces_act():
    made = [make(lb.PointContact(0.6)) for make in structures.EXAMPLES.values()]
    assert not [one for model in made for one in questions(model) if "that is" in one]


def test_a_live_force_of_one_newton_is_none_to_ask_about():
    assert questions(replace(block(), live=lb.loads.force("block 1", (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)))) == []


def test_a_mass_in_millimetres_is_asked_about():
    model, roof = block(), lb.loads.added_mass("block 1", at=(0.0, 0.0, 1000.0), weight=5e3)
    loads = lb.self_weight([roof]), lb.mass_proportional((1, 0, 0), [roof])
    said = questions(replace(model, dead=loads[0], live=loads[1]))
    assert len(said) == 2
    assert all("that is 999.5 m off the centroid" in one for one in said)


@pytest.mark.parametrize(
    ("settings", "asked"),
    [
        ({"area": 314.0, "strength": 235e6}, "its section is 314 m2: mm2? 314 mm2 = 0.000314 m2"),
        ({"area": 314e-6, "strength": 235.0}, "it carries 0.07379 N, 235 Pa on its section: MPa, or kN?"),
        ({"area": 314e-6, "strength": 235e6, "pull_out": 8.0}, "it carries 8 N"),
        ({"area": 314e-6, "strength": 235e6, "pull_out": 8e3}, ""),
    ],
)
def test_ties_in_other_units_are_asked_about(settings, asked):
    rod = tie("block 1", (0.0, 0.0, 0.9), "base", (-3.0, 0.0, 0.9), **settings)
    said = questions(reinforced(block(), rod))
    assert len(said) == bool(asked)
    assert not asked or asked in said[0]


@pytest.mark.parametrize(
    ("off", "number", "turned"), [(0.0, 1, False), (0.0005, 1, True), (0.01, 0, False), (0.0, 0, None)]
)
def test_a_tie_given_twice_is_asked_about(off, number, turned):
    """Anchors within the gap, a thousandth of a block's length, are the same ones, whichever comes first."""
    bar = {"area": 314e-6, "strength": 235e6}
    ends = [("block 1", (0.0, 0.0, 0.9 + off)), ("base", (-3.0, 0.0, 0.9))]
    if turned:
        ends.reverse()
    first = tie("block 1", (0.0, 0.0, 0.9), "base", (-3.0, 0.0, 0.9), **bar)
    second = [] if turned is None else [tie(*ends[0], *ends[1], **bar)]
    said = questions(reinforced(block(), first, *second))
    assert len(said) == number
    assert all("given twice? they add up" in one for one in said)


@pytest.mark.parametrize(("width", "asked"), [(0.1, 0), (8.0, 1), (100.0, 1)])
def test_strips_and_dowels_in_millimetres_are_asked_about(width, asked):
    model = block()
    (joint,) = model.interfaces
    at = joint.centroid.tolist()
    for made in (
        strip(joint, at, width=width, capacity=5e3),
        dowel(joint, at, diameter=width, capacity=5e3),
    ):
        said = questions(reinforced(model, made))
        assert [
            f"it is {width:.4g} m wide: mm? {width:.4g} mm = {width / 1e3:.4g} m" in one for one in said
        ] == [True] * asked


def prestressed():
    bar = {"area": 314e-6, "strength": 235e6}
    ends = ("block 1", (0.0, 0.0, 0.9), "base", (-3.0, 0.0, 0.9))
    return reinforced(block(), tie(*ends, prestress=2e3, **bar), tie(*ends[:3], (-4.0, 0.0, 0.9), **bar))


def test_an_anchor_off_its_block_in_a_file_is_asked_about():
    """A tie that a file has 1 m above a block of that height; `reinforced` refuses it."""
    first, moved, last = prestressed().interfaces
    moved = replace(moved, centroid=moved.centroid + np.array([0.0, 0.0, 1.1]), joint=Tie(235e6, 3.0))
    (said,) = questions(replace(block(), interfaces=(first, moved, last)))
    assert "tie block 1|base: its anchor at (0, 0, 2) is 1 m off block 'block 1'" in said


def test_a_prestress_that_passes_through_other_blocks_is_not_asked_about():
    """A rod of 20 kN from the fourth block into the first one: half way between its anchors is the second."""
    model = lb.structures.column(lb.PointContact(0.6), count=4, width=1.0, height=1.0)
    rod = tie("block 4", (0, 0.5, 3.5), "block 1", (0, 0.5, 0.3), area=1e-4, strength=235e6, prestress=20e3)
    assert questions(reinforced(model, rod)) == []


@pytest.mark.parametrize("factor", [0.9, 1.35])
def test_a_prestress_that_is_not_that_of_the_dead_loads_is_asked_about(factor):
    """The tie keeps the rest of its strength, whatever pulls; a partial factor changes both."""
    model = prestressed()
    assert questions(model) == []
    assert questions(design_model(model, PartialFactors(factor, 1.5, 1.0, 1.0, 1.0))) == []
    for dead, pull in ((lb.self_weight(), 0.0), (factor * model.dead, factor * 2e3)):
        (said,) = questions(replace(model, dead=dead))
        assert f"a prestress of 2000 N, and the dead loads pull 'block 1' with {pull:g} N there" in said


def test_a_dowel_in_a_strip_is_no_strip_given_twice():
    model = block()
    (joint,) = model.interfaces
    held = strip(joint, joint.centroid, width=0.1, capacity=2e3)
    pin = dowel(joint, joint.centroid, diameter=0.02, capacity=2e3)
    assert questions(reinforced(model, held, pin)) == []
    assert len(questions(reinforced(model, held, pin, held))) == 1


def test_fill_on_both_faces_of_a_roof_is_not_given_twice():
    """Both faces of a symmetric gable have the resultant at one height: fill at one point, both ways."""
    outline = [(0.0, 0.0), (2.0, 0.0), (1.0, 1.0)]
    gable = lb.Block.prism("block", outline, (0.0, 1.0), unit_weight=20e3)
    ground = lb.Block.box("ground", size=(2.0, 1.0, 0.2), at=(1.0, 0.5, -0.1))
    model = model_of([gable, ground], ["ground"], lb.PointContact(0.6))
    fill = passive_fill(model, 2.0, unit_weight=18e3, coefficient=3.0)
    assert len(fill) == 2
    assert questions(reinforced(model, *fill)) == []
    (said,) = questions(reinforced(model, *fill, *fill))
    assert "fill resists 'block' twice at one place" in said


def test_fill_is_as_wide_as_the_face_that_presses_it():
    """5 m high and 8 m wide, more than the 16 m2 of a strip that may be in millimetres."""
    wedge = lb.Block.prism("block", [(0.0, 0.0), (5.0, 0.0), (0.0, 5.0)], (0.0, 8.0), unit_weight=20e3)
    ground = lb.Block.box("ground", size=(6.0, 9.0, 0.2), at=(2.5, 4.0, -0.1))
    model = model_of([wedge, ground], ["ground"], lb.PointContact(0.6))
    (fill,) = passive_fill(model, 6.0, unit_weight=18e3, coefficient=3.0)
    assert questions(reinforced(model, fill)) == []


@pytest.mark.parametrize(
    ("off", "rounded"), [(5e6, ""), (1e9, ""), (2e9, "2e-07"), (5e12, "0.001")]
)  # m: a northing of a map; 2 m large, from 1e-7 of that on
def test_coordinates_that_rounding_changes_are_asked_about(off, rounded):
    stones = [
        lb.Block.box("ground", (1.0, 1.0, 1.0), (off, 0.0, -0.5)),
        lb.Block.box("block", (0.5, 1.0, 1.0), (off, 0.0, 0.5), 20e3),
    ]
    said = questions(model_of(stones, ["ground"], lb.PointContact(0.6)))
    assert len(said) == bool(rounded)
    words = f"{off:.4g} m off the origin, where coordinates are rounded to {rounded} m"
    assert all(words in one for one in said)


def test_a_force_on_a_block_without_a_unit_weight():
    blocks = [lb.Block.box("ground", (3, 3, 1), (0, 0, -0.5)), lb.Block.box("stone", (1, 1, 1), (0, 0, 0.5))]
    down = lb.loads.force("stone", (0, 0, -1e5), (0, 0, 1))
    push = lb.loads.force("stone", (1, 0, 0), (0, 0, 1))
    model = lb.Model(blocks, ["ground"], lb.find_interfaces(blocks, lb.PointContact(0.9)), down, push)
    assert lb.report(model, lb.bounds(model)).text


def test_diagnose_asks_what_reports_and_the_command_line_ask_once():
    model = block(lb.PointContact(30.0))
    found = lb.diagnose(model)
    assert found.warnings == list(found.questions) == ["friction is 30: degrees? tan 30 deg = 0.577"]
    assert str(found).startswith("1 question; ")
    assert found.nothing  # of its contacts
    assert lb.report(model, lb.bounds(model)).text.count("- friction is 30:") == 1

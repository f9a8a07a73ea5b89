"""Every load term in the model file."""

import json
from typing import get_args

import jsonschema
import pytest
from hypothesis import given
from hypothesis import strategies as st
from reading import read_or_refused
from stones import portal_stones

import limitblocks as lb
from limitblocks.mechanics.loads import JointPressure, LoadTerm

THIRD = 1 / 3
MASS = lb.loads.added_mass("right", (1.0, THIRD, 2.0), mass=700)
TERMS = {
    "MassProportional": lb.self_weight(),
    "AddedMass": lb.mass_proportional((1, 2, 3), [MASS]),
    "PointForce": lb.loads.force("left", (1, 2, 3), (0, 0, 1)),
    "JointPressure": lb.loads.Load(
        ((2.0, JointPressure("left", "lintel", (1.0, 2.0, 3.0), (-1.0, 0.0, 2.0))),)
    ),
    "Moment": lb.loads.moment("left", (1, 2, THIRD)),
    "Pressure": lb.loads.pressure("left", 7, facing=(-1, 0, 0))
    + lb.loads.pressure("left", -THIRD, at=(-1.25, 0, 1)),
    "Hydrostatic": lb.loads.pressure(["left", "right"], facing=(-1, 0.1, 0), unit_weight=9810, level=1),
    "Fill": lb.loads.fill(18e3, 3, earth_pressure=THIRD)
    + lb.loads.fill(18e3, 3 * THIRD + 2, blocks=["lintel"])
    + lb.loads.fill(18e3, 3, beyond=(THIRD, 0), towards=(1, THIRD, 0)),
    "TopForce": lb.loads.top_force((0, 0, -1), (0, THIRD)),
    "LineLoad": lb.loads.line_load((0, 0, -1), (-1, -THIRD), (1, THIRD)),
}


def portal(load):
    blocks = portal_stones()
    interfaces = lb.find_interfaces(blocks, lb.PointContact(0.6))
    return lb.Model(blocks, ["ground"], interfaces, lb.self_weight() + load, 0.5 * load)


def document(load):
    return json.loads(json.dumps(portal(load).to_dict()))


def test_every_term_is_here():
    used = {type(term) for load in TERMS.values() for _, term in load.terms}
    assert used == set(get_args(LoadTerm))


@pytest.mark.parametrize("load", TERMS.values(), ids=TERMS)
def test_what_is_written_is_read_bit_for_bit(load, tmp_path):
    model = portal(load)
    again = lb.read(model.save(tmp_path / "model.json"))
    assert again.digest == model.digest
    assert again.live.terms == model.live.terms
    assert again.live.on(again.free_blocks).tobytes() == model.live.on(model.free_blocks).tobytes()
    jsonschema.Draft202012Validator(lb.files.model_schema()).validate(document(load))


@pytest.mark.parametrize("load", TERMS.values(), ids=TERMS)
def test_report_says_every_term(load):
    assert lb.report(portal(load)).to_dict()


def test_defaults_may_be_left_out_and_directions_have_any_length(tmp_path):
    live = [
        {"type": "AddedMass", "block": "left", "weight": 5, "at": [0, 0, 1]},
        {"type": "AddedMass", "block": "left", "weight": 5, "at": [0, 0, 1], "direction": [3, 0, 4]},
        {"type": "Pressure", "blocks": ["left"], "pressure": 3, "facing": [-2, 0, 0]},
        {"type": "Fill", "unit_weight": 18e3, "level": 3},
    ]
    file = tmp_path / "model.json"
    file.write_text(json.dumps(document(TERMS["Moment"]) | {"live": live}))
    mass = lb.loads.added_mass("left", (0, 0, 1), weight=5)
    expected = (
        lb.self_weight([mass]).terms[1:]
        + lb.mass_proportional((3, 0, 4), [mass]).terms[1:]
        + lb.loads.pressure("left", 3, facing=(-1, 0, 0)).terms
        + lb.loads.fill(18e3, 3).terms
    )
    model = lb.read(file)
    assert model.live.on(model.free_blocks) == pytest.approx(lb.loads.Load(expected).on(model.free_blocks))
    assert model.live.terms[1] == expected[1]


@pytest.mark.parametrize(
    ("term", "said"),
    [
        (
            {"type": "Fill", "unit_weight": 1, "level": 3, "blocks": ["lintl"]},
            ["live[0].blocks[0]: 'lintl'", "did you mean 'lintel'"],
        ),
        ({"type": "AddedMass", "block": "lef", "weight": 1, "at": [0, 0, 1]}, ["live[0].block", "'lef'"]),
        ({"type": "AddedMass", "block": "left", "weight": -1, "at": [0, 0, 1]}, ["live[0]", "weight is -1"]),
        ({"type": "Fill", "unit_weight": -1, "level": 3}, ["live[0]", "unit weight is -1"]),
        ({"type": "Fill", "unit_weight": 1, "level": 0}, ["live load", "level 0 m"]),
        ({"type": "Fill", "unit_weight": 1, "level": 3, "beyond": [0, 1]}, ["live[0]", "given together"]),
        ({"type": "Pressure", "blocks": [], "pressure": 1, "facing": [1, 0, 0]}, ["live[0]", "no block"]),
        ({"type": "Pressure", "blocks": ["left"], "pressure": 1}, ["live[0]", "direction"]),
        (
            {"type": "Pressure", "blocks": ["left"], "pressure": 1, "facing": [1, 1, 0]},
            ["live load", "equally close"],
        ),
        ({"type": "Pressure", "blocks": "left", "pressure": 1}, ["live[0].blocks: expected a list"]),
        ({"type": "TopForce", "force": [0, 0, -1], "at": [9, 0]}, ["live load", "x = 9 m"]),
        ({"type": "TopForce", "force": [0, 0, -1], "at": [9, 0, 0]}, ["live[0].at"]),
        ({"type": "LineLoad", "force_per_length": [0, 0, -1], "start": [0, 0], "end": [0, 0]}, ["live[0]"]),
    ],
)
def test_fault_is_one_line_with_its_place(term, said, tmp_path):
    file = tmp_path / "model.json"
    file.write_text(json.dumps(document(TERMS["Moment"]) | {"live": [term]}))
    with pytest.raises(lb.ModelError) as caught:
        lb.read(file)
    (line,) = caught.value.problems
    assert all(part in line for part in said), line


EVERY = document(sum(TERMS.values(), lb.loads.Load())) | {"units": {"length": "ft", "force": "kip"}}
PLACES = [(k, key) for k, term in enumerate(EVERY["live"]) for key in term]
VALUES = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(allow_nan=False, allow_infinity=False),
    st.sampled_from([0.0, -1.0, 1e-300, 1e29, -1e29, [], [[]], "", "left", "ground", "Fill"]),
    st.lists(st.floats(-3, 3), min_size=2, max_size=3),
    st.lists(st.sampled_from(["left", "right", "lintel", "ground"]), max_size=3),
)


@given(st.sampled_from(PLACES), VALUES)
def test_only_our_errors_come_out_of_wrong_terms(tmp_path_factory, place, value):
    k, key = place
    changed = EVERY | {"live": [*EVERY["live"][:k], EVERY["live"][k] | {key: value}, *EVERY["live"][k + 1 :]]}
    file = tmp_path_factory.mktemp("fuzz") / "model.json"
    file.write_text(json.dumps(changed))
    read_or_refused(file)


def test_the_document_changed_above_is_sound(tmp_path):
    file = tmp_path / "model.json"
    file.write_text(json.dumps(EVERY))
    assert lb.bounds(lb.read(file)).lower > 0.0

import json
import re
from copy import copy
from dataclasses import replace
from pathlib import Path

import jsonschema
import numpy as np
import pytest
from stones import portal_stones

import limitblocks as lb

PAGE = Path(__file__).parents[2] / "docs" / "model-file.md"


def rotation(axis, angle):
    x, y, z = np.array(axis) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def portal(joint, live, dead=None, turn=None):
    blocks = portal_stones()
    if turn is not None:
        blocks = [block.moved(turn, (0.1, 1 / 3, -7.7)) for block in blocks]
    return lb.Model(
        blocks, ["ground"], lb.find_interfaces(blocks, joint), dead or lb.self_weight(), live, "Portal"
    )


def two_joints():
    model = portal(lb.OrdunaLourenco(0.6), lb.mass_proportional((1, 1, 0)))
    low, high = model.interfaces[:2], model.interfaces[2:]
    swapped = [
        lb.Interface(i.block_i, i.block_j, i.centroid, i.axes, i.polygon, lb.PointContact(0.7)) for i in high
    ]
    return lb.Model(model.blocks, ["ground"], [*low, *swapped], model.dead, model.live)


LOADS = 0.1 * lb.loads.force("lintel", (1e3, -1 / 3, 0), (0, 0, 2.4)) + 3 * lb.loads.moment(
    "left", (0, 5, np.pi)
)
MODELS = {
    "boxes": portal(lb.OrdunaLourenco(0.6), lb.mass_proportional((1, 2, 3))),
    "points": portal(lb.PointContact(1 / 3), lb.mass_proportional((1, 0, 0))),
    "two joints": two_joints(),
    "loads": portal(lb.OrdunaLourenco(0.6), LOADS, dead=1.1 * lb.self_weight() + LOADS),
    "rotated": portal(lb.OrdunaLourenco(0.6), lb.mass_proportional((1, 0, 0)), turn=rotation((1, 2, 3), 0.7)),
    "arch": lb.structures.arch(lb.PointContact(0.6), radius=5.0, thickness=0.9, voussoirs=13),
    "whole numbers": portal(lb.OrdunaLourenco(1), lb.mass_proportional((1, 0, 0))),
    "numpy numbers": portal(
        lb.PointContact(np.float64(0.3)), np.float64(2) * lb.mass_proportional((1, 0, 0))
    ),
}


@pytest.mark.parametrize("model", MODELS.values(), ids=MODELS)
def test_what_is_written_is_read_bit_for_bit(model, tmp_path):
    again = lb.read(model.save(tmp_path / "model.json"))
    assert again.digest == model.digest
    assert again.supports == model.supports
    assert again.dead.terms == model.dead.terms
    assert again.live.terms == model.live.terms
    for old, new in zip(model.blocks, again.blocks, strict=True):
        assert (old.name, old.faces, old.unit_weight) == (new.name, new.faces, new.unit_weight)
        assert old.vertices.tobytes() == new.vertices.tobytes()
    for old, new in zip(model.interfaces, again.interfaces, strict=True):
        assert (old.name, old.joint) == (new.name, new.joint)
        for array in ("centroid", "axes", "polygon"):
            assert getattr(old, array).tobytes() == getattr(new, array).tobytes()
            assert not getattr(new, array).flags.writeable


@pytest.mark.parametrize("model", MODELS.values(), ids=MODELS)
def test_schema_accepts_what_is_written(model):
    jsonschema.Draft202012Validator(lb.files.model_schema()).validate(json.loads(json.dumps(model.to_dict())))


def test_schema_is_sound_and_rejects_what_read_rejects():
    jsonschema.Draft202012Validator.check_schema(lb.files.model_schema())
    validator = jsonschema.Draft202012Validator(lb.files.model_schema())
    good = json.loads(json.dumps(MODELS["boxes"].to_dict()))
    for change in (
        {"schema_version": 2},
        {"blocks": [{"name": "x"}]},
        {"wrong": 1},
        {"joints": {"dry": {"type": "Glue"}}},
        {"live": [{"type": "Moment", "block": "left", "moment": [1, 2]}]},
        {"interfaces": {"find": {}}},
    ):
        assert not validator.is_valid(good | change)


def test_file_written_by_hand_is_the_same_model(tmp_path):
    text, *_ = re.findall(r"```json\n(.*?)```", PAGE.read_text(encoding="utf-8"), flags=re.DOTALL)
    file = tmp_path / "portal.json"
    file.write_text(text, encoding="utf-8")
    model = lb.read(file)
    assert model.digest == portal(lb.OrdunaLourenco(0.6), lb.mass_proportional((1, 0, 0))).digest
    file.write_text(text, encoding="utf-8-sig")  # as editors on Windows do
    assert lb.read(str(file)).digest == model.digest
    jsonschema.Draft202012Validator(lb.files.model_schema()).validate(json.loads(text))


def test_direction_is_brought_to_unit_length_and_self_weight_is_a_term(tmp_path):
    document = MODELS["boxes"].to_dict()
    document["live"] = [{"type": "MassProportional", "direction": [3, 0, 4], "factor": 2}]
    document["dead"] = [{"type": "SelfWeight", "factor": 1.5}]
    file = tmp_path / "model.json"
    file.write_text(json.dumps(document))
    model = lb.read(file)
    assert model.live.terms == (2 * lb.mass_proportional((3, 0, 4))).terms
    assert model.dead.terms == (1.5 * lb.self_weight()).terms


def test_save_refuses_an_existing_file(tmp_path):
    file = tmp_path / "model.json"
    file.write_text("mine")
    with pytest.raises(lb.LimitBlocksError, match="exists"):
        MODELS["boxes"].save(file)
    assert file.read_text() == "mine"


BLOCK, INTERFACE = MODELS["two joints"].blocks[1], MODELS["two joints"].interfaces[2]
PARTS = {
    "blocks": [
        *(
            {"layer": "a"},
            {"material": "a"},
            {"groups": ["a"]},
            {"colour": "#102030"},
            {"unit_weight": 2e4 + 1},
        ),
        *({"name": "a"}, {"vertices": BLOCK.vertices + 1e-9}, {"faces": BLOCK.faces[1:] + BLOCK.faces[:1]}),
    ],
    "interfaces": [
        *({"joint": lb.PointContact(0.6)}, {"block_i": "lintel"}, {"block_j": "ground"}),
        *({part: getattr(INTERFACE, part) * (1.0 + 1e-15)} for part in ("centroid", "axes", "polygon")),
    ],
}
WHOLE = {"supports": ["ground", "right"], "dead": 2 * lb.self_weight(), "live": LOADS, "name": "Other"}


def test_no_part_of_a_model_is_left_out_of_its_digest():
    model = MODELS["two joints"]
    others = [replace(model, **{word: value}) for word, value in WHOLE.items()]
    for word, changes in PARTS.items():
        k = 1 if word == "blocks" else 2
        for change in changes:
            parts = list(getattr(model, word))
            parts[k] = replace(parts[k], **change)
            others.append(copy(model))  # a name that is changed in one place makes no model
            others[-1].__dict__.pop("digest", None)
            object.__setattr__(others[-1], word, parts)
    digests = [each.digest for each in (model, *others)]
    assert len(set(digests)) == len(digests) == 19

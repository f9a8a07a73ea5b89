"""Units stated in a model file."""

import copy
import json
from dataclasses import fields

import jsonschema
import pytest

import limitblocks as lb
from limitblocks import units
from limitblocks.io.registry import JOINTS, TERMS
from limitblocks.io.units import DIMENSIONS, METRES, NEWTONS

GROUND = [[-2.0, -0.2], [2.0, -0.2], [2.0, 0.0], [-2.0, 0.0]]
SI = {
    "schema_version": 1,
    "blocks": [
        {"name": "ground", "prism": {"outline": GROUND, "between": [-0.5, 0.5]}},
        {"name": "left", "box": {"size": [0.5, 1.0, 2.2], "at": [-1.0, 0.0, 1.1]}, "unit_weight": 20e3},
        {"name": "right", "box": {"size": [0.5, 1.0, 2.2], "at": [1.0, 0.0, 1.1]}, "unit_weight": 20e3},
        {"name": "lintel", "box": {"size": [2.5, 1.0, 0.4], "at": [0.0, 0.0, 2.4]}, "unit_weight": 24e3},
    ],
    "supports": ["ground"],
    "joints": {
        "mortar": {
            "type": "OrdunaLourenco",
            "friction": 0.6,
            "compressive_strength": 3e6,
            "cohesion": 5e3,
            "tensile_strength": 1e3,
        }
    },
    "interfaces": {"find": {"joint": "mortar", "gap": 1e-3}},
    "dead": [
        {"type": "SelfWeight", "factor": 1.5},
        {"type": "PointForce", "block": "lintel", "force": [0, 0, -7e3], "at": [0.1, 0, 2.6]},
        {"type": "Moment", "block": "left", "moment": [0, 500.0, 0]},
        {"type": "AddedMass", "block": "lintel", "weight": 3e3, "at": [0, 0, 2.6]},
        {"type": "Pressure", "blocks": ["left"], "pressure": 200.0, "facing": [-1, 0, 0]},
        {
            "type": "Fill",
            "unit_weight": 18e3,
            "level": 3.0,
            "blocks": ["lintel"],
            "coefficient": 0.3,
            "beyond": [0.3, 0.1],
            "towards": [1, 0, 0],
        },
        {"type": "TopForce", "force": [0, 0, -50.0], "at": [0.3, 0.1]},
        {"type": "LineLoad", "force_per_length": [0, 0, -150.0], "start": [-1.0, 0.1], "end": [1.0, 0.1]},
    ],
    "live": [{"type": "MassProportional", "direction": [1, 0, 0]}],
}


def scaled(document, metre, newton):
    """The document with its numbers in other units of length (m) and force (N), written out by hand."""
    new = copy.deepcopy(document)

    def over(values, unit):
        return [value / unit for value in values]

    for block in new["blocks"]:
        if "box" in block:
            block["box"] = {key: over(value, metre) for key, value in block["box"].items()}
        else:
            outline, between = block["prism"].values()
            block["prism"] = {
                "outline": [over(place, metre) for place in outline],
                "between": over(between, metre),
            }
        if "unit_weight" in block:
            block["unit_weight"] *= metre**3 / newton
    joint = new["joints"]["mortar"]
    for key in ("compressive_strength", "cohesion", "tensile_strength"):
        joint[key] *= metre**2 / newton
    _, force, moment, mass, pressure, fill, top, line = new["dead"]
    force.update(force=over(force["force"], newton), at=over(force["at"], metre))
    moment["moment"] = over(moment["moment"], newton * metre)
    mass.update(weight=mass["weight"] / newton, at=over(mass["at"], metre))
    pressure["pressure"] *= metre**2 / newton
    fill.update(unit_weight=fill["unit_weight"] * metre**3 / newton, level=fill["level"] / metre)
    fill["beyond"] = over(fill["beyond"], metre)
    top.update(force=over(top["force"], newton), at=over(top["at"], metre))
    line.update(
        force_per_length=over(line["force_per_length"], newton / metre),
        start=over(line["start"], metre),
        end=over(line["end"], metre),
    )
    return new


def read(document, tmp_path):
    file = tmp_path / "model.json"
    file.write_text(json.dumps(document))
    return lb.read(file)


@pytest.mark.parametrize(
    ("length", "force", "metre", "newton"),
    [("mm", "kN", 1e-3, 1e3), ("ft", "kip", units.ft, units.kip), ("in", "lbf", units.inch, units.lbf)],
)
def test_other_units_give_the_same_model(length, force, metre, newton, tmp_path):
    document = scaled(SI, metre, newton) | {"units": {"length": length, "force": force}}
    jsonschema.Draft202012Validator(lb.files.model_schema()).validate(document)
    model, si = read(document, tmp_path), read(SI, tmp_path)
    assert [i.name for i in model.interfaces] == [i.name for i in si.interfaces]
    for array in ("centroid", "axes", "polygon"):
        for one, other in zip(model.interfaces, si.interfaces, strict=True):
            assert getattr(one, array) == pytest.approx(getattr(other, array), abs=1e-12)
    joint, expected = model.interfaces[0].joint, si.interfaces[0].joint
    for field in fields(joint):
        if field.name != "slip":
            assert getattr(joint, field.name) == pytest.approx(getattr(expected, field.name))
    for load in ("dead", "live"):
        one, other = (getattr(m, load).on(m.free_blocks) for m in (model, si))
        assert one == pytest.approx(other, rel=1e-9, abs=1e-9)
    assert lb.bounds(model).lower == pytest.approx(lb.bounds(si).lower, rel=1e-6)


def test_millimetres_are_the_same_bits(tmp_path):
    """Whole numbers of mm and N: the digest is that of the SI model."""
    document = copy.deepcopy(SI)
    document["joints"] = {"mortar": {"type": "PointContact", "friction": 0.6}}
    document["dead"] = [{"type": "SelfWeight"}]
    digest = read(document, tmp_path).digest
    ground, *stones = document["blocks"]
    outline = [[round(1000 * x) for x in place] for place in ground["prism"]["outline"]]
    ground["prism"] = {"outline": outline, "between": [-500, 500]}
    for block in stones:
        block["box"] = {key: [round(1000 * x) for x in value] for key, value in block["box"].items()}
        block.pop("unit_weight")
    for block, weight in zip(document["blocks"][1:], (2e-5, 2e-5, 2.4e-5), strict=True):
        block["unit_weight"] = weight
    model = read(document | {"units": {"length": "mm"}}, tmp_path)
    assert [b.unit_weight for b in model.free_blocks] == pytest.approx([20e3, 20e3, 24e3], rel=1e-15)
    saved = lb.read(model.save(tmp_path / "saved.json"))
    assert saved.digest == model.digest  # what is written is SI
    assert all(
        (b.vertices == s.vertices).all() for b, s in zip(model.blocks, read_si(tmp_path).blocks, strict=True)
    )
    assert digest == read_si(tmp_path).digest


def read_si(tmp_path):
    document = SI | {
        "joints": {"mortar": {"type": "PointContact", "friction": 0.6}},
        "dead": [{"type": "SelfWeight"}],
    }
    return read(document, tmp_path)


def test_explicit_interfaces_and_vertices_are_converted(tmp_path):
    model = read(SI, tmp_path)
    document = json.loads(json.dumps(model.to_dict())) | {"units": {"length": "mm", "force": "N"}}
    small = read(
        document | {"dead": [{"type": "SelfWeight"}], "live": [{"type": "SelfWeight", "factor": 0.1}]},
        tmp_path,
    )
    for block, other in zip(small.blocks, model.blocks, strict=True):
        assert block.vertices == pytest.approx(1e-3 * other.vertices)
    for one, other in zip(small.interfaces, model.interfaces, strict=True):
        assert (one.axes == other.axes).all()
        assert one.centroid == pytest.approx(1e-3 * other.centroid)
        assert one.polygon == pytest.approx(1e-3 * other.polygon)


def test_every_number_of_every_joint_and_load_has_a_unit():
    """A field that is not a name, a word or a truth must be in the table, or files in mm go wrong."""
    words = {"block", "block_i", "block_j", "blocks", "slip", "side", "cone", "slides"}
    for cls in (*JOINTS.values(), *TERMS.values()):
        assert {field.name for field in fields(cls) if field.init} - words <= set(DIMENSIONS), cls


@pytest.mark.parametrize(("place", "low"), [("z<2250", 2), ("z < 2.25e3", 2), ("z>2200", 1), ("low", 1)])
def test_places_in_patterns_of_materials_are_in_the_unit_of_the_file(place, low, tmp_path):
    """Columns of 2.2 m and a lintel above them, in mm."""
    document = scaled(SI, 1e-3, 1.0) | {"units": {"length": "mm"}}
    for block in document["blocks"]:
        block.pop("unit_weight", None)
    document["blocks"][1]["layer"] = "low"
    picked = {"blocks": [place], "unit_weight": 1e-5}
    document["materials"] = {"a": picked, "b": {"blocks": ["*"], "unit_weight": 2e-5}}
    weights = [block.unit_weight for block in read(document, tmp_path).free_blocks]
    assert weights.count(pytest.approx(1e4)) == low


def test_units_are_those_of_the_module():
    for name, metre in METRES.items():
        assert float(metre) == getattr(units, {"in": "inch"}.get(name, name))
    for name, newton in NEWTONS.items():
        assert float(newton) == pytest.approx(getattr(units, name), rel=1e-15)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"length": "km"}, "units.length"),
        ({"mass": "kg"}, "units.mass: unknown key"),
        ("mm", "units: expected"),
    ],
)
def test_unknown_units_are_refused(given, said, tmp_path):
    with pytest.raises(lb.ModelError, match=said):
        read(SI | {"units": given}, tmp_path)


def test_numbers_out_of_range_after_conversion_are_refused(tmp_path):
    document = copy.deepcopy(SI) | {"units": {"length": "ft", "force": "kip"}}
    document["dead"][1]["force"] = [9e29, 0, 0]
    with pytest.raises(lb.ModelError, match="units: force is 9e\\+29"):
        read(document, tmp_path)

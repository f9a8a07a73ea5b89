import copy
import json
import os

import pytest
from portal import LISTED, PORTAL, changed
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks.cli import app
from limitblocks.io import strict_json

CUBE = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]]
CORNERS = [[x, y, z + 3.0] for z in (0, 1) for y in (0, 1) for x in (0, 1)]


def find(*path, to):
    return changed(PORTAL, *path, to=to)


def listed(*path, to):
    return changed(LISTED, *path, to=to)


def block(vertices, faces):
    return find("blocks", 4, to={"name": "stone", "vertices": vertices, "faces": faces, "unit_weight": 1.0})


AXES = LISTED["interfaces"][0]["axes"]
WARPED = [*CORNERS[:7], [1.0, 1.0, 4.3]]
FLAT = [[x, y, 3.0] for x, y, _ in CORNERS]

FAULTS = {
    "unknown block in an interface": (
        listed("interfaces", 0, "block_j", to="lef"),
        ["interfaces[0].block_j", "'lef'", "'left'"],
    ),
    "report": (
        {"format": "limitblocks report", "schema_version": 2},
        ["is a report", "a model file is needed"],
    ),
    "unknown support": (find("supports", to=["grond"]), ["supports[0]", "'grond'", "did you mean 'ground'"]),
    "no support": (find("supports", to=[]), ["no support"]),
    "only supports": (find("supports", to=["ground", "left", "right", "lintel"]), ["no free block"]),
    "zero volume": (block(FLAT, CUBE), ["blocks[4]", "'stone'", "coincide"]),
    "no thickness": (find("blocks", 1, "box", "size", to=[1, 1, 0]), ["blocks[1]", "'left'", "positive"]),
    "face not planar": (block(WARPED, CUBE), ["blocks[4]", "'stone'", "not planar"]),
    "open mesh": (block(CORNERS, CUBE[:5]), ["blocks[4]", "'stone'", "closed"]),
    "vertex out of range": (block(CORNERS, [*CUBE[:5], [4, 5, 7, 9]]), ["'stone'", "out of range"]),
    "duplicate names": (find("blocks", 2, "name", to="left"), ["'left'"]),
    "overlap": (find("blocks", 3, "box", "at", to=[0, 0, 2.1]), ["overlap by", "m3", "'lintel'", "'left'"]),
    "floating": (find("blocks", 3, "box", "at", to=[0, 0, 2.5]), ["floating", "'lintel'"]),
    "no live load": (find("live", to=[]), ["no live load"]),
    "live load missing": (find("live", to=...), ["live: is missing"]),
    "no direction": (find("live", 0, "direction", to=[0, 0, 0]), ["live[0]", "non-zero"]),
    "load on unknown block": (
        find("live", 0, to={"type": "Moment", "block": "lintl", "moment": [0, 1, 0]}),
        ["live[0].block", "'lintl'", "'lintel'"],
    ),
    "load type": (find("dead", 0, "type", to="Snow"), ["dead[0]", "'Snow'", "'SelfWeight'"]),
    "joint type": (find("joints", "dry", "type", to="Glue"), ["joints.dry", "'Glue'", "'OrdunaLourenco'"]),
    "joint without type": (find("joints", "dry", "type", to=...), ["joints.dry", "type is missing"]),
    "joint of your own": (find("joints", "dry", "type", to="Mortar"), ["'Mortar'", "joint of your own"]),
    "friction": (find("joints", "dry", "friction", to=-0.1), ["joints.dry", "friction is -0.1"]),
    "unknown joint": (
        find("interfaces", "find", "joint", to="dri"),
        ["interfaces.find.joint", "'dri'", "'dry'"],
    ),
    "gap": (find("interfaces", "find", "gap", to=-1.0), ["interfaces.find", "gap is -1.0"]),
    "wrong type": (
        find("blocks", 1, "unit_weight", to="20e3"),
        ["blocks[1].unit_weight: expected a number, not '20e3'"],
    ),
    "truth for a number": (find("blocks", 1, "box", "at", 1, to=True), ["blocks[1].box.at[1]", "not True"]),
    "negative weight": (find("blocks", 1, "unit_weight", to=-1), ["blocks[1].unit_weight"]),
    "no weight": (find("blocks", 1, "unit_weight", to=...), ["'left'", "no unit weight"]),
    "vertex of two": (block([*CORNERS[:2], [0, 0]], CUBE), ["blocks[4].vertices[2][2]: is missing"]),
    "no shape": (find("blocks", 1, "box", to=...), ["blocks[1]: has no shape"]),
    "two shapes": (find("blocks", 1, "faces", to=CUBE), ["blocks[1]: has faces and box"]),
    "empty name": (find("blocks", 1, "name", to=" "), ["blocks[1]"]),
    "unknown key": (
        find("blocks", 1, "unitweight", to=1),
        ["blocks[1].unitweight: unknown key; did you mean 'unit_weight'"],
    ),
    "key of a box beside it": (
        listed("blocks", 1, "size", to=[1.0, 1.0, 1.0]),
        ["blocks[1].size: unknown key here; it belongs in 'box'"],
    ),
    "joint in place of its name": (
        listed("interfaces", 0, "joint", to={"type": "PointContact", "friction": 0.5}),
        ["interfaces[0].joint: expected the name of one of the joints, not {"],
    ),
    "unknown key at the top": (find("suports", to=[]), ["suports: unknown key; did you mean 'supports'"]),
    "version that is no number": (find("schema_version", to=True), ["schema_version: expected 1, not True"]),
    "later version": (find("schema_version", to=2), ["schema_version: expected 1, not 2", "newer version"]),
    "decimal comma": (
        find("blocks", 1, "box", "size", to=[0, 5, 1, 2]),
        ["blocks[1].box.size: expected at most 3 entries, not [0, 5, 1, 2]"],
    ),
    "huge number": (find("blocks", 1, "box", "at", 0, to=1e300), ["blocks[1].box.at[0]"]),
    "huge friction": (find("joints", "dry", "friction", to=1e300), ["joints.dry.friction"]),
    "huge direction": (find("live", 0, "direction", 2, to=1e300), ["live[0].direction[2]"]),
    "list for an object": ([], ["expected an object"]),
    "text for an object": ("model", ["expected an object"]),
    "interfaces a number": (find("interfaces", to=3), ["interfaces: expected a list"]),
    "axes off": (
        listed("interfaces", 0, "axes", 0, 0, to=1.001),
        ["interfaces[0]: interface ground|left: axes", "orthonormal"],
    ),
    "axes left-handed": (
        listed("interfaces", 0, "axes", to=[AXES[1], AXES[0], AXES[2]]),
        ["ground|left", "left-handed"],
    ),
    "polygon clockwise": (
        listed("interfaces", 0, "polygon", to=[[1, 1], [1, -1], [-1, -1], [-1, 1]]),
        ["ground|left", "counter-clockwise"],
    ),
    "polygon not convex": (
        listed("interfaces", 0, "polygon", to=[[2, 0], [0.5, 0.5], [0, 2], [-2, 0], [0, -2]]),
        ["ground|left", "not convex"],
    ),
    "polygon beside": (
        listed("interfaces", 0, "polygon", to=[[1, 1], [2, 1], [2, 2], [1, 2]]),
        ["ground|left", "strictly inside"],
    ),
    "polygon off centre": (
        listed("interfaces", 0, "polygon", to=[[1, -1], [1.1, 1], [-1, 1], [-1, -1]]),
        ["ground|left", "centroid"],
    ),
    "pentagram": (
        listed(
            "interfaces",
            0,
            "polygon",
            to=[[1, 0], [-0.81, 0.59], [0.31, -0.95], [0.31, 0.95], [-0.81, -0.59]],
        ),
        ["ground|left", "crosses itself"],
    ),
    "polygon of two": (
        listed("interfaces", 0, "polygon", to=[[1, 0], [0, 1]]),
        ["interfaces[0].polygon", "at least 3"],
    ),
    "interface to itself": (listed("interfaces", 0, "block_j", to="ground"), ["joins a block to itself"]),
}
TEXTS = {
    "empty": (b"", ["is empty"]),
    "white space": (b" \n ", ["is empty"]),
    "truncated": (json.dumps(PORTAL).encode()[:300], ["line 1, column", "not JSON"]),
    "not JSON": (b"<xml/>", ["not JSON"]),
    "NaN": (json.dumps(PORTAL).replace("24000.0", "NaN").encode(), ["unit_weight: NaN is not"]),
    "NaN, where": (
        b'{"schema_version": 1,\n "name": "NaN and \\" Infinity",\n "blocks": [NaN]}',
        ["line 3, column 13: not JSON: blocks: NaN is not a number"],
    ),
    "singular": (  # `joint` is a key of interfaces
        json.dumps({"joint" if key == "joints" else key: value for key, value in PORTAL.items()}).encode(),
        ["joint: unknown key; did you mean 'joints'?"],
    ),
    "Infinity": (json.dumps(PORTAL).replace("24000.0", "-Infinity").encode(), ["-Infinity"]),
    "infinity by size": (json.dumps(PORTAL).replace("24000.0", "1e999").encode(), ["blocks[3].unit_weight"]),
    "digits": (json.dumps(PORTAL).replace("24000.0", "9" * 5000).encode(), ["not JSON"]),
    "duplicate key": (b'{"schema_version": 1, "name": "a", "name": "b"}', ["'name' appears twice"]),
    "encoding": (json.dumps(PORTAL).replace("Portal", "Säule").encode("latin-1"), ["UTF-8"]),
    "UTF-16": (json.dumps(PORTAL).encode("utf-16"), ["is UTF-16 text; save it as UTF-8"]),
    "lone surrogate": (json.dumps(PORTAL).replace("Portal", "\\ud800").encode(), ["not JSON"]),
    "nested lists": (b"[" * 100_000, ["nests too deeply"]),
    "nested a little": (b'{"blocks":' + b"[" * 500 + b"]" * 500 + b"}", []),
}
CASES = {k: (json.dumps(document).encode(), said) for k, (document, said) in FAULTS.items()} | TEXTS


def assert_clean(lines, file, said):
    assert lines
    for line in lines:
        assert str(file) in line
        assert "\n" not in line
        assert "pydantic" not in line.lower()
    text = "\n".join(lines)
    assert all(part in text for part in said), text


@pytest.fixture
def file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return "model.json"


@pytest.mark.parametrize(("data", "said"), CASES.values(), ids=CASES)
def test_fault_is_one_line_that_names_file_and_place(data, said, file):
    with open(file, "wb") as stream:
        stream.write(data)
    with pytest.raises(lb.ModelError) as caught:
        lb.read(file)
    assert_clean(caught.value.problems, file, said)
    result = CliRunner().invoke(app, ["info", file])
    assert (result.exit_code, result.stdout) == (2, "")
    assert_clean(result.stderr.splitlines(), file, said)


def test_good_documents_are_read(file):
    for document in (PORTAL, LISTED):
        with open(file, "w") as stream:
            json.dump(document, stream)
        assert len(lb.read(file).interfaces) == 4


def test_all_faults_come_at_once(file):
    document = find("blocks", 1, "unit_weight", to="heavy")
    document["live"][0]["direction"] = [1, 2]
    document["supports"] = [7]
    del document["joints"]
    with open(file, "w") as stream:
        json.dump(document, stream)
    with pytest.raises(lb.ModelError) as caught:
        lb.read(file)
    places = ("blocks[1].unit_weight", "supports[0]", "joints", "live[0].direction[2]")
    assert sorted(problem.split(": ")[1] for problem in caught.value.problems) == sorted(places)
    document = find("blocks", 1, "box", "size", to=[1, 1, 0])
    document["supports"], document["joints"]["dry"]["friction"] = ["sky"], -1
    document["live"][0]["direction"] = [0, 0, 0]
    with open(file, "w") as stream:
        json.dump(document, stream)
    with pytest.raises(lb.ModelError) as caught:
        lb.read(file)
    assert len(caught.value.problems) == 4


def test_an_unknown_key_at_the_top_is_compared_with_those_there(tmp_path):
    """It was asked about `friction`, which is a key of joints alone."""
    file = tmp_path / "portal.json"
    file.write_text(json.dumps(find("fricton", to=0.6)))
    with pytest.raises(lb.ModelError) as caught:
        lb.read(file)
    (line,) = caught.value.problems
    assert line.endswith(": fricton: unknown key")


def test_missing_file_directory_and_pipe(tmp_path):
    for name, said in (("none.json", "No such file"), (".", "is a folder"), ("a\0b", "cannot be read")):
        with pytest.raises(lb.ModelError, match=said):
            lb.read(tmp_path / name)
    if hasattr(os, "mkfifo"):
        os.mkfifo(tmp_path / "pipe")
        with pytest.raises(lb.ModelError, match="not a file"):
            lb.read(tmp_path / "pipe")


def test_too_large_a_file_is_refused(tmp_path):
    file = tmp_path / "large.json"
    with file.open("wb") as stream:
        stream.truncate(2 * strict_json.LARGEST_FILE)  # sparse: takes no space
    with pytest.raises(lb.ModelError, match="larger than 100 MB"):
        lb.read(file)


def raised(height):
    """The portal with its lintel `height` m above the legs."""
    document = copy.deepcopy(PORTAL)
    document["blocks"][3]["box"]["at"][2] += height
    return json.dumps(document).encode()


def test_a_block_that_floats_by_a_drawn_gap_is_told_the_gap(tmp_path):
    file = tmp_path / "portal.json"
    file.write_bytes(raised(0.02))
    with pytest.raises(lb.ModelError) as caught:
        lb.read(file)
    assert any("typically 20 mm wide" in line for line in caught.value.problems)


def test_joints_lost_to_a_gap_are_told_on_reading(tmp_path, caplog):
    """The right leg stops 5 mm below the lintel, which then rests on the left one alone."""
    document = copy.deepcopy(PORTAL)
    document["blocks"][2]["box"] |= {"size": [0.5, 1.0, 1.995], "at": [1.0, 0.0, 0.9975]}
    file = tmp_path / "portal.json"
    file.write_text(json.dumps(document))
    assert len(lb.read(file).interfaces) == 3
    assert any("nearly touch: right|lintel" in line for line in caplog.messages)

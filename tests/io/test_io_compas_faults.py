"""COMPAS files that are wrong or damaged: one clean error."""

import copy
import json
import random

import compas
import numpy as np
import pytest
from compas_documents import (
    CUBES,
    assembly_document,
    compas_1_document,
    model_document,
    network_document,
    written,
)
from portal import changed
from reading import fault, outcome

NODE = ("data", "graph", "data", "node", "0", "block", "data")
ELEMENT = ("data", "elements", "e1", "data")
BAD = {
    "no number": (changed(assembly_document(), *NODE, "vertex", "0", "x", to="1"), "expected 3 numbers"),
    "truth": (changed(assembly_document(), *NODE, "vertex", "0", "x", to=True), "expected 3 numbers"),
    "vertex": (changed(assembly_document(), *NODE, "vertex", "0", to=3), "vertex 0 of a mesh is 3"),
    "face": (changed(assembly_document(), *NODE, "face", "0", to=[0, 1, 99]), "face 0 of a mesh"),
    "face missing": (changed(assembly_document(), *NODE, "face", "0", to=...), "open"),
    "huge": (changed(assembly_document(), *NODE, "vertex", "0", "x", to=1e300), "up to 1e30"),
    "no nodes": (changed(assembly_document(), "data", "graph", "data", "node", to={}), "holds no COMPAS"),
    "nodes a list": (changed(assembly_document(), "data", "graph", "data", "node", to=[]), "not sound"),
    "matrix": (changed(model_document(), *ELEMENT, "transformation", to={"matrix": [[1]]}), "4 rows"),
    "perspective": (
        changed(model_document(), *ELEMENT, "transformation", to={"matrix": np.ones((4, 4)).tolist()}),
        "expected 0, 0, 0, 1",
    ),
    "frame": (changed(model_document(), *ELEMENT, "frame", to={}), "has a frame"),
    "circle": (
        changed(
            model_document(), "data", "tree", "root", "children",
            to=[{"element": "g", "children": [{"element": "e1", "children": [{"element": "g"}]}]}],
        ),
        "runs in a circle",
    ),
    "flat box": (json.loads(compas.json_dumps(CUBES[0])) | {}, ""),
    "something else": ({"dtype": "compas.geometry/Point", "data": [0.0, 0.0, 0.0]}, "holds no COMPAS"),
    "plain": ([1, 2, 3], "holds no COMPAS"),
    "text": ("blocks", "holds no COMPAS"),
}  # fmt: skip
BAD["flat box"] = (changed(BAD["flat box"][0], "data", "zsize", to=0.0), "positive")


@pytest.mark.parametrize("case", BAD)
def test_bad_documents_are_one_clean_error(tmp_path, case):
    document, expected = BAD[case]
    assert expected in fault(written(tmp_path / "a.json", document))


@pytest.mark.parametrize("text", ["", "{", '{"dtype": NaN}', "[" * 100_000, '{"a": 1, "a": 2}', "\0\1\2"])
def test_files_that_are_no_json(tmp_path, text):
    path = tmp_path / "a.json"
    path.write_text(text, encoding="utf-8")
    fault(path)


VALUES = (None, True, -1, 1e308, 10**400, "x", [], {}, [[]], {"dtype": "a/b", "data": {}})


def damage(part, chance):
    """Change one value somewhere in a document."""
    while isinstance(part, dict | list) and part:
        key = chance.choice(list(part)) if isinstance(part, dict) else chance.randrange(len(part))
        if not isinstance(part[key], dict | list) or not part[key] or chance.random() < 0.15:
            if chance.random() < 0.3:
                del part[key]
            else:
                part[key] = copy.deepcopy(chance.choice(VALUES))
            return
        part = part[key]


def test_damaged_documents_read_or_fail_cleanly(tmp_path):
    chance = random.Random(1)
    good = [make() for make in (assembly_document, model_document, compas_1_document, network_document)]
    ends = []
    for k in range(160):
        document = copy.deepcopy(good[k % len(good)])
        for _ in range(chance.choice((1, 1, 3))):
            damage(document, chance)
        path = written(tmp_path / "a.json", document)
        ends.append(outcome(path))
    assert sum(isinstance(end, str) for end in ends) > 30

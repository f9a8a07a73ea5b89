"""Result files whose numbers contradict each other: what is told twice is told once otherwise."""

import json
from dataclasses import replace

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.evidence.proof import Proof


@pytest.fixture(scope="module")
def model():
    return lb.structures.EXAMPLES["eccentric_lintel"](lb.PointContact(0.6))


def falsified(result, path, **said):
    """The file of a result with other numbers under keys, of the proof where they are its."""
    file = lb.files.write_result(result, path)
    data = json.loads(file.read_text())
    for key, value in said.items():
        *place, last = key.split("__")
        (data[place[0]] if place else data)[last] = value
    file.write_text(json.dumps(data))
    return file


@pytest.mark.parametrize(
    ("side", "share"), [("lower", 1.01), ("lower", 0.99), ("upper", 0.99), ("upper", 1.01)]
)
def test_a_proof_of_other_bounds_is_refused(model, tmp_path, side, share):
    bounds = lb.bounds(model)
    assert bounds.proven
    file = falsified(bounds, tmp_path / "bounds.json", **{f"proof__{side}": share * getattr(bounds, side)})
    with pytest.raises(lb.errors.ModelError, match=rf"proof\.{side} is"):
        lb.read_result(file, model)


@pytest.mark.parametrize("sides", [(1.01, 1.0), (1.0, 0.99), (0.9, 0.1)])
def test_a_proof_narrower_than_what_is_proven_does_not_pass(model, sides):
    bounds = lb.bounds(model)
    low, high = np.multiply(sides, (bounds.lower, bounds.upper)).tolist()
    assert lb.check_mcp(model, bounds, tolerance=1e-6).passed
    check = lb.check_mcp(model, replace(bounds, proof=Proof(low, high)), tolerance=1e-6)
    assert check.residuals["proof told"] == np.inf
    assert not check.passed


@pytest.mark.parametrize(
    ("key", "value"),
    [("dilatancy", 0.3), ("associated", 0.2), ("frictionless", 0.38), ("turning", "centre of pressure")],
)
def test_a_range_that_contradicts_its_answers_is_refused(model, tmp_path, key, value):
    found = lb.load_factor_range(model, time_limit=2.0)
    assert found.answers
    file = falsified(found, tmp_path / "range.json", **{key: value})
    with pytest.raises(lb.errors.ModelError, match=f"{key} is .* of an answer"):
        lb.read_result(file, model)

"""The file of a load path: what the check finds changed in it, and what it says that it does not judge."""

import json
from dataclasses import replace

import numpy as np
import pytest

import limitblocks as lb


def falsified(path, change, file):
    """The file of a path in which a dictionary was changed, as it is read."""
    document = json.loads(json.dumps(path.to_dict()))
    change(document)
    file.write_text(json.dumps(document))
    return lb.read_result(file)


@pytest.mark.parametrize(
    ("steps", "said"),
    [
        (lambda step: (), "the load path has no steps"),
        (lambda step: 5, "steps is 5, expected a sequence of PathStep"),
        (lambda step: (5,), "steps holds 5, expected a sequence of PathStep"),
        (lambda step: (step, replace(step, load_factor=np.nan)), "step 1: load_factor is nan, expected"),
        (
            lambda step: (step, replace(step, stress_resultants=step.stress_resultants[1:])),
            r"step 1: stress_resultants has shape \(0, 6\), expected \(1, 6\)",
        ),
    ],
)
def test_steps_of_a_path_that_are_none_are_refused(steps, said):
    model = lb.structures.block(lb.PointContact(0.5), width=1.0, height=2.0)
    path = lb.load_path(model)
    with pytest.raises(lb.ModelError, match=said):
        lb.check_mcp(model, replace(path, steps=steps(path.steps[0])))


@pytest.mark.parametrize("joint", [lb.PointContact(0.5), lb.OrdunaLourenco(0.5)])
def test_a_path_that_was_changed_is_found_out(tmp_path, joint):
    model = lb.structures.portal(joint, span=2.0, pier_width=0.5, pier_blocks=2)
    path, file = lb.load_path(model), tmp_path / "path.json"
    same = falsified(path, lambda _: None, file)
    assert lb.check_mcp(model, same).passed
    assert "not yield or displacements, nor the trace" in str(lb.check_mcp(model, same))
    assert "trace" not in str(lb.check_mcp(model, path.collapse))
    assert lb.report(model, same).sections[0].designs
    for change in (
        lambda document: document["steps"][3].update(load_factor=2.0 * path.steps[3].load_factor),
        lambda document: document["steps"][3]["stress_resultants"][0].__setitem__(2, -1.0),
    ):
        false = falsified(path, change, file)
        check = lb.check_mcp(model, false)
        assert [one.name for one in check.residuals.above(check.tolerance)] == ["steps"]
        assert check.worst.where.startswith("step 3, ")
        assert not lb.report(model, false).sections[0].designs
    half = falsified(path, lambda document: document.update(tracked=0.5 * path.tracked), file)
    assert "50 % off" in lb.report(model, half).text

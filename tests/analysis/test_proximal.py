"""Proximal steps take the end of a path in a plane to an exact solution, where pivots and polish do not."""

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.analysis.nonassociated import proximal, ways
from limitblocks.analysis.polish import defect
from limitblocks.problem import Flow, State

LIMIT = 1e-6  # of the backward error


@pytest.mark.parametrize("steps", [True, False])
def test_the_answer_of_a_large_wall_is_exact_for_a_model_next_to_it(steps, monkeypatch):
    """Residuals are within 1e-8 either way; without the steps no mechanism fits the stresses exactly."""
    if not steps:
        monkeypatch.setattr(proximal, "standing_still", lambda _, state: state)
    model = lb.structures.wall(lb.PointContact(0.6), length=9.6, courses=24)
    assert len(model.free_blocks) > ways.LARGE_IN_PLANE
    found = lb.nonassociated(model, confirm=False)
    assert found.residuals.worst.value <= 1e-8
    assert (found.backward_error.value <= LIMIT) is steps


def test_steps_that_end_farther_off_are_dropped():
    """A state without stresses and rates is no end of a path; what comes back is never worse."""
    model = lb.structures.block(lb.PointContact(0.5), width=1.0, height=1.0)
    problem = model.problem
    nothing = State(0.0, np.zeros(problem.C.shape[0]), np.zeros(problem.C.shape[1]), np.zeros(len(problem.g)))
    flow = Flow(problem)
    end = proximal.standing_still(flow, nothing)
    assert defect(flow, end) <= defect(flow, nothing)
    assert proximal.Still(flow, tried=True)(nothing) is nothing

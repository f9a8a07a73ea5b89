"""States that are exact for a model near by: accepted where that is asked for, and nowhere else."""

import numpy as np
import pytest
from attacks import ATTACKS
from true_claims import shaken, true

import limitblocks as lb


def test_what_is_near_is_accepted_only_where_asked_for(monkeypatch):
    from limitblocks.analysis.nonassociated import loop

    model, _ = true("points")
    whole = loop.first_to_solve

    def stopped(given, *rest):
        state, how = whole(given, *rest)
        return shaken(given.flow.problem, state, 1e-5), how

    monkeypatch.setattr(loop, "first_to_solve", stopped)
    with pytest.raises(lb.NotConverged, match="backward error"):
        lb.nonassociated(model)
    found = lb.nonassociated(model, backward_error=1e-2)
    assert found.status is lb.results.Status.NEARBY
    assert found.accepted
    assert not found.converged
    assert found.residuals["flow"] <= 1e-10  # the mechanism was put right
    assert found.residuals.worst.value > 1e-8
    check = lb.check_mcp(model, found, backward_error=1e-2)
    assert check.accepted
    assert not check.passed
    assert check.backward_error.value == pytest.approx(found.backward_error.value, rel=1e-6)
    assert "exact for a model within 0.01" in str(check)
    with pytest.raises(lb.errors.CheckFailed, match=r"above 1e-09"):
        lb.check_mcp(model, found, backward_error=1e-9).require()


@pytest.mark.parametrize("limit", [0.0, -1e-4, np.nan, "1e-4"])
def test_wrong_limits_are_refused(limit):
    model, claim = true("sliding, circle")
    with pytest.raises(lb.ModelError, match="backward_error"):
        lb.check_mcp(model, claim, backward_error=limit)


def test_a_check_that_passed_says_so_with_its_backward_error():
    check = lb.check_mcp(*true("sliding, circle"))
    assert check.accepted
    assert str(check).startswith("check passed: worst residual")
    assert "backward error 0.0e+00" in str(check)


def test_a_model_that_falls_or_gives_work_is_not_accepted():
    """A change of the model heals neither: both are judged by their residuals."""
    names = ("a stack that leans too far, octagon", "table 5 at an interface that gives work, square")
    for name in names:
        check = lb.check_mcp(*ATTACKS[name].make(), backward_error=1e-4)
        assert check.backward_error.value <= 1e-10
        assert not check.accepted

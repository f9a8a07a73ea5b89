"""Interfaces that give power: named by results, checks and reports, and refused."""

import pytest
from true_claims import state_of, twisted

import limitblocks as lb
from limitblocks.analysis.nonassociated.finished import finished
from limitblocks.analysis.nonassociated.start import bracket
from limitblocks.evidence.given_power import given_power
from limitblocks.evidence.residuals import TOLERANCE
from limitblocks.problem import Flow, State, Turning


def test_a_solution_that_gives_power_is_named_and_refused():
    """All equations hold, at load factor -1; the upper end of yield has no flow that the load works on."""
    model, claim = twisted(Turning.PRESSURE, against=True)
    state, flow = state_of(model, claim), Flow(model.problem, 0.0, Turning.PRESSURE)
    (remark,) = given_power(flow, state, TOLERANCE)
    assert remark.startswith("interfaces give power instead of taking it up")
    assert f"{model.interfaces[0].name} (1.0e+00)" in remark
    twice = State(2.0 * state.load_factor, state.x, state.u, state.y)  # the live load works twice as much
    assert given_power(flow, twice, TOLERANCE) == (remark.replace("(1.0e+00)", "(5.0e-01)"),)
    assert remark in lb.check_mcp(model, claim).remarks
    with pytest.raises(lb.NotConverged, match="dissipation residual"):
        finished(model, state, bracket(model), (), flow, "by hand", TOLERANCE, throw=True)
    result = finished(model, state, bracket(model), (), flow, "by hand", TOLERANCE, throw=False)
    assert result.status is lb.results.Status.GIVES_POWER
    assert remark in result.remarks
    text = lb.report(model, result).markdown
    assert "interfaces give power" in text
    assert lb.results.Status.GIVES_POWER.value.split(",")[0] in text


def test_a_solution_that_takes_up_power_has_no_remark():
    model, claim = twisted(Turning.PRESSURE)
    assert given_power(Flow(model.problem, 0.0, Turning.PRESSURE), state_of(model, claim), TOLERANCE) == ()
    assert lb.check_mcp(model, claim).remarks == ()

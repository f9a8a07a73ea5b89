"""The nearest exact mechanism: how long it is looked for where the rows allow none, and where they do."""

import numpy as np
import pytest
from true_claims import state_of, true

from limitblocks.evidence import nearest_mechanism as module
from limitblocks.evidence.multipliers import near_yield


@pytest.fixture
def solves(monkeypatch):
    """One entry for each system that is solved."""
    made, solve = [], module.least_solution
    monkeypatch.setattr(module, "least_solution", lambda *given: (made.append(1), solve(*given))[1])
    return made


def sought(*, ease, allowed):
    """Of a block that slides, from rates without the multipliers, which are this easy to change."""
    model, claim = true("sliding, circle")
    p, state = model.problem, state_of(model, claim)
    near = np.full(p.cones.degree, allowed)
    may = near_yield(p.cones, p.F @ state.x + p.g, near, np.zeros(p.cones.degree), 1.0)
    may = may._replace(ease=np.full(len(may.ease), ease))
    found = module.nearest_mechanism(p, p.G, state.u, np.zeros(len(state.y)), may)
    return p, found


def test_rows_that_allow_no_mechanism_are_given_up_after_a_round(solves):
    """Without rows C u = 0 contradicts live . u = 1: a round leaves all that was left."""
    _, found = sought(ease=1.0, allowed=False)
    assert found is None
    assert len(solves) == 1


def test_a_mechanism_that_takes_many_rounds_is_found(solves):
    """Multipliers that hardly change: each round leaves a part of what the one before has left."""
    p, (u, y) = sought(ease=1e-2, allowed=True)
    assert len(solves) > 2
    assert np.abs(p.C @ u + p.G.T @ y).max() <= 1e-9 * np.abs(u).max()
    assert p.live @ u == pytest.approx(1.0, rel=1e-9)


def test_a_multiplier_that_is_negative_by_rounding_leaves_no_flow():
    """By 5e-11 of the largest, with the rates that belong to it: set to zero alone it left them."""
    model, claim = true("sliding, circle")
    p, state = model.problem, state_of(model, claim)
    near = np.ones(p.cones.degree, dtype=bool)
    may = near_yield(p.cones, p.F @ state.x + p.g, near, np.zeros(p.cones.degree), 1.0)
    w = may.parts(p.cones, state.y)
    idle = np.flatnonzero(may.along & (w == 0.0))[0]
    y = state.y - 5e-11 * w.max() * may.columns[:, [idle]].toarray().ravel()
    u = np.linalg.solve(p.C.toarray(), -(p.G.T @ y))
    found = module.nearest_mechanism(p, p.G, u / (p.live @ u), y / (p.live @ u), may)
    rates, multipliers = found
    assert np.abs(p.C @ rates + p.G.T @ multipliers).max() <= 1e-14 * np.abs(rates).max()
    assert (multipliers[p.cones.heads] >= 0.0).all()

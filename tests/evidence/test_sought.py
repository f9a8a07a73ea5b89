"""Backward errors of symmetric states: the mechanism is sought in the plane or a half, judged in space."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from true_claims import state_of

import limitblocks as lb
from limitblocks.analysis.nonassociated.means import MEANS, REDUCED_MEANS
from limitblocks.evidence.backward_error import is_exact, least
from limitblocks.evidence.given_state import Given
from limitblocks.evidence.sought import Sought
from limitblocks.problem import Flow, Turning
from limitblocks.structures import EXAMPLES

ALONG = (1.0, 0.0, 0.0)
ROUND, POINTS = lb.OrdunaLourenco(0.6), lb.PointContact(0.6)
CASES = {
    "round friction": ("wall", ROUND, ALONG, "centroid"),
    "points": ("wall", POINTS, ALONG, "centroid"),
    "crushing": ("wall", lb.OrdunaLourenco(0.6, compressive_strength=5e6), ALONG, "centroid"),
    "octagon": ("arch", lb.OrdunaLourenco(0.6, slip="paper"), ALONG, "centroid"),
    "Table 5": ("wall", ROUND, ALONG, "centre of pressure"),
    "half": ("pavilion_vault", ROUND, ALONG, "centroid"),
}
HALF = (MEANS[0]._replace(budget=1), REDUCED_MEANS[1])  # the first path is stopped at once


@cache
def solved(name):
    build, joint, push, turning = CASES[name]
    model = replace(EXAMPLES[build](joint), live=lb.mass_proportional(push))
    means = HALF if name == "half" else None
    found = lb.nonassociated(model, turning=turning, confirm=False, means=means)
    return Flow(model.problem, 0.0, Turning(turning)), state_of(model, found)


def shaken(name, size):
    """Forces off by that much of what acts, rates by as much of the largest."""
    flow, state = solved(name)
    random = np.random.default_rng(0)
    x = state.x + size * Given(flow, state).acting * random.uniform(-1.0, 1.0, len(state.x))
    u = state.u + size * np.abs(state.u).max() * random.uniform(-1.0, 1.0, len(state.u))
    return Given(flow, replace(state, x=x, u=u))


def symmetric(name, size):
    """The mean of such a state and its mirror image."""
    plane, given = Given(*solved(name)).sought.plane, shaken(name, size)
    return Given(given.flow, plane.lifted(plane.averaged(given.state)))


def in_space(given):
    """The same, its mechanism sought in the whole problem."""
    whole = Given(given.flow, given.state)
    whole.__dict__["sought"] = Sought(given.flow.problem, None, given.flow, given.state)
    return whole


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("size", [1e-8, 1e-5])
def test_the_nearest_model_is_that_found_in_space(name, size):
    given = symmetric(name, size)
    assert given.sought.problem.C.shape[0] <= 0.7 * given.flow.problem.C.shape[0]
    found, whole = least(given), least(in_space(given))
    assert found.change == pytest.approx(whole.change, rel=1e-3)
    assert is_exact(found)


@pytest.mark.parametrize("name", ["points", "half"])
def test_of_a_state_that_is_not_symmetric_it_is_sought_in_space(name):
    given = shaken(name, 1e-6)
    assert given.sought.plane is None
    assert given.sought.problem is given.flow.problem
    assert is_exact(least(given))


@pytest.mark.parametrize("part", ["rates", "multipliers"])
def test_what_a_wrong_lift_gives_is_no_number(part, monkeypatch):
    """Lifted by what mirrors wrongly, the mechanism does not hold in space."""
    given = symmetric("points", 1e-6)
    assert is_exact(least(given))
    sought = given.sought
    wrong = getattr(sought.plane, part).copy()
    wrong.data[::2] *= -1.0
    given.__dict__["sought"] = replace(sought, plane=replace(sought.plane, **{part: wrong}))
    assert least(given) is None

"""Residuals one term at a time: what is undefined, what violations are worth, and units of rows."""

from dataclasses import replace

import numpy as np
import pytest
from stones import model_of

import limitblocks as lb
from limitblocks import structures
from limitblocks.evidence.measure import Measure
from limitblocks.evidence.residuals import bounds_residuals, mcp_residuals, residual, worth_of_violations
from limitblocks.problem import Flow, State


@pytest.mark.parametrize(
    ("value", "scale", "expected"),
    [
        (0.0, 0.0, 0.0),
        (1.0, 0.0, np.inf),
        (-1.0, 0.0, np.inf),
        (1.0, 2.0, 0.5),
        (-1.0, 2.0, 0.5),
        (np.nan, 1.0, np.inf),
        (np.inf, 1.0, np.inf),
        (1.0, np.nan, np.inf),
        (1.0, np.inf, np.inf),
    ],
)
def test_something_over_nothing_and_what_is_no_number_are_infinite(value, scale, expected):
    assert residual("one", np.array([0.0, value]), "", np.array([1.0, scale])).value == expected


@pytest.fixture(scope="module", params=[lb.PointContact(0.6), lb.OrdunaLourenco(0.6, cohesion=1e3)], ids=repr)
def problem(request):
    return structures.wall(request.param, length=0.8, courses=3).problem


def test_a_lower_bound_above_the_upper_is_worth_the_difference(problem):
    """lower - upper = x.f + r.u - s.y - lower (live.u - 1) with s.y >= 0 in K: no term of it may be missing.

    Nothing moves: the live load does no work, worth the whole load factor. No stresses and no multipliers:
    all loads are unbalanced, worth their power.
    """
    p, a = problem, 0.3
    nothing = State(a, np.zeros(p.C.shape[0]), np.zeros(p.C.shape[1]), np.zeros(len(p.g)))
    assert worth_of_violations(Measure(p, nothing)) == pytest.approx(a)
    assert (p.cones.margin(p.g) >= 0.0).all()
    inward = replace(nothing, y=-0.5 * p.cones.identity)  # multipliers outside K, by as much of the slack g
    assert worth_of_violations(Measure(p, inward)) == pytest.approx(a + 0.5 * p.g[p.cones.heads].sum())
    u = p.live / (p.live @ p.live) + 0.01 * p.dead
    u = u / (p.live @ u)
    moving = replace(nothing, u=u)
    assert worth_of_violations(Measure(p, moving)) >= (a + p.dead @ u) * (1.0 - 1e-12) > 0.0
    random = np.random.default_rng(3)
    for _ in range(20):
        x, v, y = (random.normal(size=n) for n in (*p.C.shape, len(p.g)))
        state = State(a, x, v, y)
        upper = p.g @ y - p.dead @ v
        assert a - upper <= worth_of_violations(Measure(p, state)) * (1.0 + 1e-12)


def test_a_negative_multiplier_counts_the_same_in_any_unit_of_its_row(problem):
    """Rows times c with multipliers over c are the same flow."""
    p, random = problem, np.random.default_rng(4)
    x, u, y = (random.normal(size=n) for n in (*p.C.shape, len(p.g)))
    by = 2.0 ** random.integers(-3, 4, p.cones.degree)[p.cones.member]
    other = replace(
        p,
        F=(p.F.T.multiply(by)).T.tocsr(),
        G=(p.G.T.multiply(by)).T.tocsr(),
        g=by * p.g,
        pivot=by * p.pivot,
        units=replace(p.units, row=p.units.row / by),
    )
    one, two = (mcp_residuals(Flow(q), State(0.3, x, u, v)) for q, v in ((p, y), (other, y / by)))
    for name in ("flow", "multipliers", "yield"):
        assert one[name] == pytest.approx(two[name], rel=1e-12)
    assert one["multipliers"] > 0.0


def test_a_state_that_ran_away_has_residuals_without_limit():
    """Its squares overflow; no warning of that gets out (warnings are errors in these tests)."""
    problem = lb.structures.block(lb.PointContact(0.5), width=1.0, height=1.0).problem
    far = [np.full(n, 1e200) for n in (problem.C.shape[0], problem.C.shape[1], len(problem.g))]
    assert mcp_residuals(Flow(problem), State(1.0, *far)).worst.value > 1.0
    assert bounds_residuals(Flow(problem), State(1.0, *far), 1.0).worst.value > 1.0


def test_units_of_a_state_that_ran_away_do_not_warn():
    """Compliances have the square of a force (warnings are errors in these tests)."""
    problem = lb.structures.block(lb.PointContact(0.5), width=1.0, height=1.0).problem
    far = problem.measured(np.full(len(problem.blocks), 2.0**700))
    assert np.isinf(far.compliance).all()
    assert np.isfinite(far.C.data).all()


@pytest.mark.parametrize("weights", [(1e3, 64e3), (64e3, 1e3)])
def test_an_interface_is_pressed_by_what_is_tied_to_it_and_not_by_a_stone_beside(weights):
    stones = [lb.Block.box(f"{x}", (1, 1, 1), (x, 0, 0.5), w) for x, w in zip((-2, 2), weights, strict=True)]
    blocks = [lb.Block.box("ground", (6, 1, 1), (0, 0, -0.5)), *stones]
    problem = model_of(blocks, ["ground"], lb.OrdunaLourenco(0.6)).problem
    at_rest = State(0.0, *(np.zeros(size) for size in (problem.C.shape[0], 12, len(problem.g))))
    pressed = Measure(problem, at_rest).pressed * problem.units.interface_force
    assert pressed == pytest.approx(weights)


def test_a_drift_counts_as_a_thousand_times_the_rate_of_the_live_load_at_most():
    """One block without stresses: its weight is all that acts on it, through its largest rate."""
    p = lb.structures.block(lb.PointContact(0.5), width=1.0, height=1.0).problem
    none, weight = np.zeros(p.C.shape[0]), np.abs(p.dead).max()
    for rate, counted in ((2.0, 2.0), (1e3, 1e3), (1e9, 1e3)):
        state = State(0.0, none, np.full(p.C.shape[1], rate), np.zeros(len(p.g)))
        assert Measure(p, state).everything == pytest.approx(counted * weight)

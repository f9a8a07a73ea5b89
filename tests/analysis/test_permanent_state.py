"""The state of the permanent loads: of least norm, believed where its conditions hold."""

import signal
from dataclasses import replace

import cvxpy as cp
import numpy as np
import pytest

import limitblocks as lb
from limitblocks.analysis.nonassociated import least_norm
from limitblocks.analysis.nonassociated.least_norm import by_cones, by_planes, permanent_state
from limitblocks.analysis.nonassociated.start import bracket, own_units
from limitblocks.analysis.programs import in_cone

MU = 0.6


CRUSHING = lb.OrdunaLourenco(MU, compressive_strength=3e5)


@pytest.mark.parametrize(
    "joint",
    [lb.OrdunaLourenco(MU, slip="paper"), lb.PointContact(0.0), lb.PointContact(MU), CRUSHING],
    ids=repr,
)
def test_permanent_state_is_the_least_norm(joint):
    """As cvxpy finds it by a solver of its own; no live load is left to help."""
    problem = lb.structures.wall(joint, length=1.2, courses=4, direction=(1.0, 0.0, 0.0)).problem
    x, W = permanent_state(problem, problem.compliance), problem.compliance
    assert problem.C.T @ x == pytest.approx(problem.dead, abs=1e-8)
    assert problem.cones.margin(problem.F @ x + problem.g).min() > -1e-8
    y = cp.Variable(len(x))
    inside = in_cone(problem.F @ y + problem.g, problem.cones)
    norm = cp.sum_squares(cp.multiply(np.sqrt(W), y))
    cp.Problem(cp.Minimize(norm), [problem.C.T @ y == problem.dead, *inside]).solve(cp.SCS, eps=1e-9)
    assert x @ (W * x) == pytest.approx(norm.value, rel=1e-7)


@pytest.mark.parametrize(
    "joint", [lb.OrdunaLourenco(MU, slip="paper"), lb.PointContact(MU, cone="inner"), lb.PointContact(0.0)]
)
def test_permanent_state_by_planes_is_that_by_cones(joint):
    problem = lb.structures.wall(joint, length=1.2, courses=4, direction=(1.0, 0.0, 0.0)).problem
    W = problem.compliance
    x, expected = by_planes(problem, W), by_cones(problem, W)
    assert problem.C.T @ x == pytest.approx(problem.dead, abs=1e-12)
    assert (problem.F @ x + problem.g).min() > -1e-12
    assert x @ (W * x) == pytest.approx(expected @ (W * expected), rel=1e-7)


def test_permanent_state_that_does_not_hold_is_refused(monkeypatch):
    problem = lb.structures.wall(lb.PointContact(MU, cone="inner"), length=1.2, courses=4).problem
    rough = least_norm.OSQP | {"eps_abs": 1e-2, "eps_rel": 1e-2, "polishing": False}
    monkeypatch.setattr(least_norm, "OSQP", rough)
    assert by_planes(problem, problem.compliance) is None
    assert permanent_state(problem, problem.compliance) is not None
    few = least_norm.CLARABEL | {"max_iter": 5}
    monkeypatch.setattr(least_norm, "CLARABEL", few)
    assert permanent_state(problem, problem.compliance) is None


def test_permanent_state_of_a_corner_that_takes_refinement():
    """Without refinement Clarabel ends in insufficient progress."""
    size = {"length": 2.4, "return_length": 2.4, "courses": 4, "direction": (0.0, 1.0, 0.0)}
    model = lb.structures.corner(lb.OrdunaLourenco(0.8), **size)
    problem = own_units(model, bracket(model))
    assert permanent_state(problem, problem.compliance) is not None


@pytest.mark.parametrize("cone", ["exact", "inner"])
def test_no_permanent_state_of_blocks_that_fall_up(cone):
    problem = lb.structures.wall(lb.PointContact(MU, cone=cone), length=1.2, courses=4).problem
    assert permanent_state(problem, problem.compliance) is not None
    assert permanent_state(replace(problem, dead=-problem.dead), problem.compliance) is None


def test_ctrl_c_that_osqp_keeps_to_itself_ends_the_analysis(monkeypatch):
    """It prints that it was interrupted, and returns."""
    solve = least_norm.osqp.OSQP.solve

    def pressed(solver, **options):
        found = solve(solver, **options)
        found.info.status_val = 10  # OSQP_SIGINT of its constants.h
        return found

    monkeypatch.setattr(least_norm.osqp.OSQP, "solve", pressed)
    problem = lb.structures.wall(lb.OrdunaLourenco(0.6, slip="paper"), length=1.2, courses=3).problem
    usual = signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored in the background of a shell
    try:
        with pytest.raises(KeyboardInterrupt):
            permanent_state(problem, problem.compliance)
    finally:
        signal.signal(signal.SIGINT, usual)

"""One implicit step: its equations recomputed, and the associated step against cvxpy."""

import cvxpy as cp
import numpy as np
import pytest
from scipy import sparse

import limitblocks as lb
from limitblocks.analysis.interface_blocks import InterfaceBlocks
from limitblocks.analysis.nonassociated.implicit_step import Loading, implicit_step
from limitblocks.analysis.nonassociated.least_norm import permanent_state
from limitblocks.problem import Flow

MU = 0.6
JOINTS = [lb.OrdunaLourenco(MU), lb.OrdunaLourenco(MU, compressive_strength=1e6), lb.PointContact(MU)]
RHO = 0.5


@pytest.fixture(scope="module", params=JOINTS, ids=repr)
def problem(request):
    return lb.structures.wall(request.param, length=0.8, courses=3, direction=(0.8, 0.6, 0)).problem


@pytest.fixture(scope="module")
def x0(problem):
    return permanent_state(problem, problem.compliance)


def loading_of(problem, x0, dilatancy=0.0):
    return Loading(Flow(problem, dilatancy), InterfaceBlocks(problem), problem.compliance, x0, RHO)


def test_the_permanent_state_carries_the_dead_load_with_the_least_norm(problem, x0):
    assert np.abs(problem.dead - problem.C.T @ x0).max() <= 1e-7
    assert problem.cones.margin(problem.F @ x0 + problem.g).min() >= -1e-7
    # no self-equilibrated change that stays within yield lowers the norm: try those towards other states
    random = np.random.default_rng(0)
    x = cp.Variable(len(x0))
    for _ in range(3):
        inside = [sum_of_cones >= 0 for sum_of_cones in linear_rows(problem, x)]
        other = cp.Problem(
            cp.Minimize(random.normal(size=len(x0)) @ x),
            [problem.C.T @ x == problem.dead, cp.abs(x) <= 5, *inside],
        )
        other.solve(solver=cp.CLARABEL)
        assert (problem.compliance * x0) @ (x.value - x0) >= -1e-5


def linear_rows(problem, x):
    """Yield rows as expressions that must not be negative."""
    rows, found = problem.F @ x + problem.g, [(problem.F @ x + problem.g)[: problem.cones.linear]]
    for group in problem.cones.groups:
        for places in group:
            cone = rows[places]
            found.append(cone[0] - cp.norm(cone[1:]))
    return found


@pytest.mark.parametrize("dilatancy", [0.0, MU / 2, MU])
def test_a_step_satisfies_its_equations(problem, x0, dilatancy):
    result = implicit_step(loading_of(problem, x0, dilatancy), 100)
    assert result.accepted
    z = result.point
    G = Flow(problem, dilatancy).matrix(z.x)
    elastic = RHO * problem.compliance * (z.x - x0)
    assert np.abs(elastic - problem.C @ z.u - G.T @ z.y).max() <= 1e-7
    assert np.abs(problem.dead + z.load_factor * problem.live - problem.C.T @ z.x).max() <= 1e-7
    assert problem.live @ z.u == pytest.approx(1.0, abs=1e-7)
    s = problem.F @ z.x + problem.g
    assert np.abs(s - z.s).max() <= 1e-7
    assert problem.cones.margin(z.s).min() >= 0.0
    assert problem.cones.margin(z.y).min() >= 0.0
    assert 0.0 <= z.s @ z.y <= 1e-5
    assert z.load_factor > 0.0


def test_an_associated_step_is_a_quadratic_program(problem, x0):
    """Minimise (rho / 2) |x - x0|_W^2 - a over states in equilibrium within yield; the cvxpy solution."""
    z = implicit_step(loading_of(problem, x0, dilatancy=MU), 100).point
    x, load_factor = cp.Variable(len(x0)), cp.Variable()
    energy = 0.5 * RHO * cp.sum_squares(cp.multiply(np.sqrt(problem.compliance), x - x0))
    balance = problem.C.T @ x == problem.dead + load_factor * problem.live
    inside = [row >= 0 for row in linear_rows(problem, x)]
    cp.Problem(cp.Minimize(energy - load_factor), [balance, *inside]).solve(solver=cp.CLARABEL)
    assert z.load_factor == pytest.approx(float(load_factor.value), rel=1e-6)
    np.testing.assert_allclose(z.x, x.value, atol=1e-4)


def test_a_step_that_is_cut_short_is_not_accepted(problem, x0):
    result = implicit_step(loading_of(problem, x0), 2)
    assert not result.accepted
    assert result.iterations == 2


def test_interface_blocks_are_inverted_one_by_one(problem):
    random = np.random.default_rng(1)
    blocks = InterfaceBlocks(problem)
    part = abs(problem.resultants).T @ sparse.kron(sparse.eye(len(problem.interfaces)), np.ones((6, 6)))
    pattern = (part @ abs(problem.resultants)).toarray() > 0
    n = len(pattern)
    matrix = np.where(pattern, random.normal(size=(n, n)), 0.0) + 10 * np.eye(n)
    found = blocks.inverse(sparse.csr_array(matrix))
    np.testing.assert_allclose(found.toarray(), np.linalg.inv(matrix), atol=1e-12)

"""Stresses of least norm under the dead loads, and the blocks of interfaces."""

import cvxpy as cp
import numpy as np
import pytest
from scipy import sparse

import limitblocks as lb
from limitblocks.analysis.nonassociated.least_norm import least_state
from limitblocks.analysis.splitting import inverse_by_interfaces

MU = 0.6
JOINTS = [lb.OrdunaLourenco(MU), lb.OrdunaLourenco(MU, compressive_strength=1e6), lb.PointContact(MU)]


@pytest.fixture(scope="module", params=JOINTS, ids=repr)
def problem(request):
    return lb.structures.wall(request.param, length=0.8, courses=3, direction=(0.8, 0.6, 0)).problem


@pytest.fixture(scope="module")
def x0(problem):
    return least_state(problem, problem.compliance).x


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


def test_interface_blocks_are_inverted_one_by_one(problem):
    random = np.random.default_rng(1)
    part = abs(problem.resultants).T @ sparse.kron(sparse.eye(len(problem.interfaces)), np.ones((6, 6)))
    pattern = (part @ abs(problem.resultants)).toarray() > 0
    n = len(pattern)
    matrix = np.where(pattern, random.normal(size=(n, n)), 0.0) + 10 * np.eye(n)
    found = inverse_by_interfaces(problem, sparse.csr_array(matrix))
    np.testing.assert_allclose(found.toarray(), np.linalg.inv(matrix), atol=1e-12)

"""Complementary pivots: the solution where there is one, by enumeration, and none where there is none."""

from itertools import product

import numpy as np
import pytest

from limitblocks.analysis.complementarity import _from_pair, _from_zero, complementary


def solutions(q, M):
    """Slacks and multipliers of all solutions, one set of zeros after the other."""
    found = []
    for chosen in product([False, True], repeat=len(q)):
        on = np.flatnonzero(chosen)
        y = np.zeros(len(q))
        y[on] = np.linalg.solve(M[np.ix_(on, on)], -q[on])
        s = q + M @ y
        s[on] = 0.0
        if min(s.min(), y.min()) >= 0.0:
            found.append((s, y))
    return found


def problem(seed, size=6, positive=True):
    """A random problem, with one solution where M is positive definite, and a pair to start from."""
    random = np.random.default_rng(seed)
    A, q, v = random.normal(size=(size, size)), random.normal(size=size), random.normal(size=size)
    M = A @ A.T + 0.1 * np.eye(size) + (A - A.T) if positive else A
    return q, M, np.maximum(v, 0.0), np.maximum(-v, 0.0)


@pytest.mark.parametrize("method", [complementary, _from_pair, _from_zero])
@pytest.mark.parametrize("seed", range(10))
def test_the_only_solution_is_found(method, seed):
    q, M, s, y = problem(seed)
    ((slack, multiplier),) = solutions(q, M)
    found = method(q, M, s, y)
    np.testing.assert_allclose(found[0], slack, atol=1e-9)
    np.testing.assert_allclose(found[1], multiplier, atol=1e-9)


def test_of_several_solutions_any_is_one_and_none_is_invented():
    first = second = 0
    for seed in range(60):
        q, M, s, y = problem(seed, positive=False)
        known, found = solutions(q, M), complementary(q, M, s, y)
        if found is None:
            continue
        assert any(np.allclose(found[1], multiplier, atol=1e-7) for _, multiplier in known)
        near = _from_pair(q, M, s, y)
        first, second = first + (near is not None), second + (near is None)
    assert first > 5  # of 60
    assert second > 0  # where the line from the pair leads nowhere, that from zero does


def test_a_pair_that_solves_stays():
    q, M, _, _ = problem(3)
    ((slack, multiplier),) = solutions(q, M)
    found = _from_pair(q, M, slack, multiplier)
    np.testing.assert_allclose(found[1], multiplier, atol=1e-9)


def test_no_solution():
    assert complementary(np.array([-1.0]), np.array([[-1.0]]), np.zeros(1), np.zeros(1)) is None


def test_a_multiplier_that_nothing_limits_leads_to_none():
    assert _from_pair(np.array([1.0]), np.zeros((1, 1)), np.zeros(1), np.ones(1)) is None


def test_no_pairs():
    slack, multiplier = complementary(np.zeros(0), np.zeros((0, 0)), np.zeros(0), np.zeros(0))
    assert len(slack) == len(multiplier) == 0

"""Pairs of slack and multiplier: those of a solution, and all of a multiplier."""

import numpy as np

from limitblocks.analysis.eigenpairs import pairs
from limitblocks.problem import Cones

CONES = Cones(2, ((3, 3), (1, 4)))


def test_pairs_of_a_solution():
    d = np.array([0.6, 0.8])
    s = np.concatenate([[2.0, 0.0], 5.0 * np.array([1.0, *d]), np.zeros(3), [3.0, 1.0, 0.0], np.zeros(4)])
    y = np.concatenate([[0.0, 7.0], 4.0 * np.array([1.0, *-d]), [2.0, 1.0, 1.0], np.zeros(3), [1.0, 0, 0, 0]])
    found = pairs(CONES, s, y)
    assert np.abs(found.slack * found.multiplier).max() < 1e-14
    assert min(found.slack.min(), found.multiplier.min()) > -1e-14
    assert np.abs(found.across @ s + found.kappa * (found.across @ y)).max() < 1e-14
    # the cone on its boundary slips: least slack 0 and multiplier y0 + |y|, largest s0 and 0; kappa 5 / 4
    assert np.allclose(found.slack[[2, 5]], [0.0, 5.0])
    assert np.allclose(found.multiplier[[2, 5]], [8.0, 0.0])
    assert np.isclose(found.kappa[0], 5.0 / 4.0)


def test_multipliers_are_those_of_the_pairs_and_across():
    random = np.random.default_rng(0)
    s, y = random.normal(size=(2, CONES.height))
    y[2:5] = s[2:5] - np.array([3.0, 0.0, 0.0])  # no direction at all: any frame does
    found = pairs(CONES, s, y)
    whole = found.rows.T @ found.multiplier
    held = found.across.T @ (found.across @ y)
    shut = np.ones(CONES.height, dtype=bool)
    shut[2:5] = False  # inside the cone: nothing across
    np.testing.assert_allclose((whole + held)[shut], y[shut], atol=1e-14)
    np.testing.assert_allclose(found.rows @ s, found.slack)


def test_a_small_multiplier_beside_a_large_slack_is_not_lost():
    """Of a cone that slips: s = 5 (1, d) and y = 5e-4 (1, -d') with d' at an angle to d; kappa is 1e4."""
    s, y = np.array([5.0, 3.0, 4.0]), 5e-4 * np.array([1.0, -0.8, -0.6])
    found = pairs(Cones(0, ((1, 3),)), s, y)
    np.testing.assert_allclose(
        found.rows.T @ found.multiplier + found.across.T @ (found.across @ y), y, rtol=1e-12
    )


def test_planes_are_pairs_themselves():
    s, y = np.array([1.0, 0.0]), np.array([0.0, 2.0])
    found = pairs(Cones(2), s, y)
    assert found.across.shape == (0, 2)
    assert (found.signed == s - y).all()

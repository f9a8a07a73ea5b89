"""Compatibility and compliance of interfaces from their closed forms."""

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.mechanics.compatibility import compatibility_matrix


def test_strain_rates_are_those_of_block_j_less_those_of_block_i():
    """Rates at a point are du + w x r and w, in the axes of the interface: Eqs (44)-(47)."""
    rng = np.random.default_rng(1)
    axes = np.linalg.qr(rng.normal(size=(2, 3, 3)))[0]
    at_i, at_j, u = rng.normal(size=(2, 3)), rng.normal(size=(2, 3)), rng.normal(size=(2, 6))
    ends = np.array([[0, 1], [1, -1]])
    C = compatibility_matrix(axes, at_i, at_j, *ends.T, 2)
    moved = np.zeros((2, 6))
    for k, (i, j) in enumerate(ends):
        for block, at, sign in ((i, at_i[k], -1.0), (j, at_j[k], 1.0)):
            if block >= 0:
                du, w = u[block, :3], u[block, 3:]
                moved[k] += sign * np.concatenate([axes[k] @ (du + np.cross(w, at)), axes[k] @ w])
    assert (C @ u.ravel()).reshape(2, 6) == pytest.approx(moved)


def test_compliance_is_one_over_area_and_second_moments():
    """A of V1, V2, N; of M1, M2, T the integrals of x2^2 and x1^2 and their sum; in units of both."""
    stones = [
        lb.Block.box("ground", (20, 4, 1), (0, 0, -0.5)),
        lb.Block.box("light", (1, 2, 1), (-5, 0, 0.5), 1e3),
        lb.Block.box("heavy", (4, 3, 2), (5, 0, 1), 40e3),
    ]
    found = lb.find_interfaces(stones, lb.OrdunaLourenco(0.6))
    problem = lb.Model(stones, ["ground"], found, lb.self_weight(), lb.mass_proportional((1, 0, 0))).problem
    units, expected = problem.units, []
    for own in found:
        a, b = np.ptp(own.polygon, axis=0)
        second = [a * b**3 / 12, b * a**3 / 12]
        expected.append([a * b] * 3 + [*second, sum(second)])
    mean = np.mean(units.interface_force) / np.mean(units.interface_length)
    wanted = units.resultants**2 / np.ravel(expected) / mean**2
    assert problem.resultants @ problem.compliance == pytest.approx(wanted)

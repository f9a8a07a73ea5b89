"""The equations of a tracked path: their derivative, its solution, and moves along the path."""

from dataclasses import replace

import numpy as np
import pytest
from paths import direction, start

import limitblocks as lb
from limitblocks import structures
from limitblocks.analysis.nonassociated.path_equations import (
    Barrier,
    Point,
    moved,
    moved_on,
    residuals,
    theta_slope,
)
from limitblocks.analysis.nonassociated.path_newton import Newton, inverses
from limitblocks.analysis.nonassociated.path_start import centred, path_from
from limitblocks.analysis.nonassociated.tracking import track
from limitblocks.problem import Turning
from limitblocks.problem.barrier import central


@pytest.mark.parametrize("joint", [lb.OrdunaLourenco(0.6, compressive_strength=1e6), lb.PointContact(0.6)])
def test_rows_that_flow_along_their_normal_have_their_own_share_of_the_barrier(joint):
    flow, x0, weights = start(structures.ferris_tin_loi_wall(1, joint))
    whole, shared = (path_from(flow, x0, weights, Barrier(opening=share), 1).weights for share in (1.0, 0.3))
    opens = np.array([mode.opens for mode in flow.problem.row_mode])
    assert 0 < opens.sum() < len(opens)
    np.testing.assert_allclose(shared, np.where(opens, 0.3, 1.0) * whole, rtol=1e-12)


@pytest.mark.parametrize("rule", [{}, {"turning": Turning.PRESSURE, "softening": 1e-2}], ids=str)
@pytest.mark.parametrize(("joint", "size"), [(lb.OrdunaLourenco(0.6), 6), (lb.PointContact(0.6), 3)])
def test_the_derivative_is_that_of_the_equations(joint, size, rule):
    """Rows couple the stresses of an interface, or the three of a point, which are eliminated in blocks."""
    flow, x0, weights = start(structures.wall(joint, length=0.8, courses=3, direction=(0.8, 0.6, 0)), **rule)
    path = path_from(flow, x0, weights, Barrier(), 0)
    assert path.layout.coupled == size
    z, _ = centred(path)
    random = np.random.default_rng(0)
    q = residuals(path, z.moved(1.0, direction(random, z, 1e-3)))
    q = replace(q, multiplier=1e-3 * random.normal(size=z.y.shape))
    (d,) = Newton(path, z).solve(q)
    h = 1e-5
    points = [z.moved(t, d) for t in (-h, h)]
    ends = [residuals(path, point) for point in points]
    for name in ("flow", "balance", "work", "slack"):
        slope = (getattr(ends[0], name) - getattr(ends[1], name)) / (2.0 * h)
        np.testing.assert_allclose(slope, getattr(q, name), atol=1e-6)
    products = [path.cones.product(point.s, point.y) for point in points]
    asked = path.cones.product(z.s, q.multiplier)
    np.testing.assert_allclose((products[0] - products[1]) / (2.0 * h), asked, atol=1e-6)


def test_directions_satisfy_the_flow_where_little_barrier_is_left():
    """Elimination loses it where rows flow by far more than their slacks; one refinement does not mend it."""
    flow, x0, weights = start(
        structures.wall(lb.OrdunaLourenco(0.6), length=0.8, courses=3, direction=(0.8, 0.6, 0))
    )
    solution, _ = track(flow, x0, weights)
    path, p, theta = path_from(flow, x0, weights, Barrier(floor=1e-12), 1), flow.problem, 1e-7
    s, y = central(p.cones, p.F @ solution.x + p.g - solution.y, path.target(theta))
    z = Point(solution.x, solution.u, solution.load_factor, s, y, theta)
    q = theta_slope(path, z)
    (d,) = Newton(path, z).solve(q)
    left = q.flow + path.rho(theta) * path.elastic * d.x - p.C @ d.u - flow.matrix(z.x).T @ d.y
    assert np.abs(left).max() <= 2e-4 * np.abs(d.y).max()


@pytest.mark.parametrize("order", [(0, 1, 2, 3, 4, 5), (3, 0, 4, 1, 5, 2)])
def test_parts_are_inverted_without_row_exchanges_where_one_half_does_not_depend_on_the_other(order):
    """Definite halves [[A, B], [0, D]] of sizes 1e-9 to 1, in any order; a determinant may be negative."""
    random = np.random.default_rng(0)
    halves = np.zeros((2, 50, 6, 6))
    for part in (slice(0, 3), slice(3, 6)):
        root = random.normal(size=(2, 50, 3, 3)) * np.logspace(-4.5, 0.0, 50)[:, None, None]
        halves[..., part, part] = root @ np.swapaxes(root, -1, -2)
    halves[..., :3, 3:] = random.normal(size=(2, 50, 3, 3)) * np.logspace(-9.0, 0.0, 50)[:, None, None]
    halves[1, :, :3] *= -1.0
    matrices = halves[..., order, :][..., order]
    inverse, determinants = inverses(matrices)
    assert (determinants[0] == 1.0).all()
    assert (determinants[1] == -1.0).all()
    error = np.linalg.norm(inverse @ matrices - np.eye(6), axis=(2, 3))
    assert (error <= 1e-14 * np.linalg.cond(matrices)).all()


def test_a_pivot_that_rounding_took_leaves_an_inverse():
    """Of a rotation that flows by 1e9 beside a compliance of 1e-8 nothing is left of the latter."""
    f = np.array([1.0, -2.5])
    matrix = 268471804.0 * np.outer(f, f) + 1e-8 * np.eye(2)
    assert np.linalg.det(matrix) == 0.0  # in floating point; it is 19
    inverse, determinants = inverses(matrix[None])
    assert determinants[0] == 1.0
    assert np.isfinite(inverse).all()
    assert f @ inverse[0] @ f <= 1e-7  # soft along the flow, to rounding


def test_a_point_that_ran_away_is_refused_without_a_word_on_the_terminal(capfd):
    """SuperLU takes what is not finite, and BLAS prints that it is illegal."""
    flow, x0, weights = start(structures.wall(lb.PointContact(0.6), length=0.8, courses=3))
    path = path_from(flow, x0, weights, Barrier(), 0)
    z, _ = centred(path)
    with np.errstate(all="ignore"), pytest.raises(np.linalg.LinAlgError, match="ran away"):
        Newton(path, replace(z, y=np.inf * z.y))
    assert capfd.readouterr() == ("", "")


def test_the_products_of_moved_points_are_those_of_their_theta():
    flow, x0, weights = start(structures.wall(lb.OrdunaLourenco(0.6), length=0.8, courses=3))
    path = path_from(flow, x0, weights, Barrier(), 1)
    z, _ = centred(path)
    (tangent,) = Newton(path, z).solve(theta_slope(path, z))
    ahead = moved(path, z, 0.1, replace(tangent, theta=1.0))
    for point in (z, ahead):
        products = path.cones.product(point.s, point.y)
        np.testing.assert_allclose(products, path.target(point.theta), rtol=1e-9, atol=1e-12)
    assert ahead.theta == pytest.approx(1.1)


def test_the_stresses_move_on_without_a_jump_of_the_path():
    flow, x0, weights = start(structures.wall(lb.OrdunaLourenco(0.6), length=0.8, courses=3))
    path = path_from(flow, x0, weights, Barrier(floor=2.0), 0)
    z, _ = centred(path)
    (d,) = Newton(path, z).solve(theta_slope(path, z))
    z = z.moved(0.5, d)
    onward = moved_on(path, z)
    assert np.abs(onward.x0 - path.x0).max() > 1e-3
    np.testing.assert_allclose(residuals(onward, z).flow, residuals(path, z).flow, atol=1e-12)

"""Faces whose corners lie in no plane."""

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.geometry.mend import TwistedFaces, mended
from limitblocks.geometry.twisted import fitted, rounding, triangulated, warps

BOX = lb.Block.box("box", (1.0, 1.0, 1.0), (0.5, 0.5, 0.5))
LIFTED = BOX.vertices + [(0.0, 0.0, 0.1 * (k == 7)) for k in range(8)]


def test_warp_of_a_quad_is_a_quarter_of_what_one_corner_is_lifted():
    # the plane square to the area vector through the mean corner: heights +-h/4 over the diagonal
    height = warps(np.array([(0, 0, 0), (1, 0, 0), (1, 1, 1e-3), (0, 1, 0.0)]), ((0, 1, 2, 3),))
    assert height == pytest.approx(1e-3 / 4, rel=1e-5)


def test_triangles_keep_the_vertices():
    block, notes = mended("box", LIFTED, BOX.faces, twisted="triangulate")
    assert set(map(tuple, block.vertices)) == set(map(tuple, LIFTED))
    assert len(block.faces) == 7  # the sides stay plane
    assert "divided into triangles" in notes[-1]
    # the shorter diagonal leaves the lifted corner to one triangle: half the area, a third of the height
    assert block.volume == pytest.approx(1.0 + 0.5 * 0.1 / 3)


def test_a_face_in_common_is_divided_alike_from_both_sides():
    """Two stones that share a twisted face touch through it, and nothing overlaps."""
    rng = np.random.default_rng(3)
    for _ in range(20):
        shared = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0.0)]) + 0.1 * rng.normal(size=(4, 3))
        first = triangulated(shared, ((0, 1, 2, 3),), np.array([0]))
        order = rng.permutation(4)  # the other block numbers and turns it otherwise
        place = np.argsort(order)
        second = triangulated(shared[order], (tuple(place[[3, 2, 1, 0]].tolist()),), np.array([0]))
        theirs = {frozenset(int(order[v]) for v in trio) for trio in second}
        assert {frozenset(trio) for trio in first} == theirs


def star(corners, seed):
    angle = 2 * np.pi * np.arange(corners) / corners
    radius = np.random.default_rng(seed).uniform(0.2, 1.0, corners)
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.zeros(corners)])


SLIT = np.array(
    [(10, 0, 0), (0, 1, 0), (-3, 0.5, 0), (5, 0, 0), (-3, -0.5, 0), (0, -1, 0.0)]
)  # shuts one ear


@pytest.mark.parametrize("outline", [SLIT, *(star(n, seed) for n in (5, 8, 12) for seed in range(10))])
def test_triangles_cover_a_face_with_notches_once(outline):
    """Each turns the way of the face, and their areas add up: none lies on another one or outside."""
    n = len(outline)
    triangles = np.array(triangulated(outline, (tuple(range(n)),), np.array([0])))
    a, b, c = outline[triangles].swapaxes(0, 1)
    areas = np.cross(b - a, c - a)[:, 2] / 2
    assert len(triangles) == n - 2
    assert (areas > 0.0).all()
    assert areas.sum() == pytest.approx(np.cross(outline, np.roll(outline, -1, axis=0))[:, 2].sum() / 2)


def test_fitting_makes_faces_plane_and_says_how_far_it_moved():
    moved = BOX.vertices + 2e-3 * np.random.default_rng(1).normal(size=(8, 3))
    block, notes = mended("box", moved, BOX.faces, twisted="fit")
    assert len(block.faces) == 6
    assert warps(block.vertices, block.faces).max() < 1e-4 + 1e-12
    shift = np.linalg.norm(block.vertices - moved[np.lexsort(moved.T[::-1])], axis=1).max()
    assert f"up to {shift:.3g} m" in notes[-1]


def test_fitting_gives_up_where_no_planes_are_near():
    # an octahedron of four-cornered faces has no planes of its own: twist one cube by a quarter of a turn
    turned = BOX.vertices.copy()
    top = turned[:, 2] > 0.5
    turned[top, :2] = (turned[top, :2] - 0.5) @ np.array([(0.5, 0.9), (-0.9, 0.5)]) + 0.5
    assert fitted(turned, BOX.faces, 1e-3) is None
    with pytest.raises(TwistedFaces, match=r"no planes fit, ask for --twisted triangulate"):
        mended("box", turned, BOX.faces, twisted="fit")


@pytest.mark.parametrize("n", [10, 14])
def test_what_is_fitted_is_plane_and_near(n):
    """Fields of four-cornered faces, less and less rough: plane to a tenth of what is tolerated, or none."""
    said = []
    loops = tuple((k, k + 1, k + n + 1, k + n) for k in range(n * (n - 1)) if k % n < n - 1)
    level = np.stack(np.mgrid[:n, :n, :1], axis=-1).reshape(-1, 3) / (n - 1)
    for rough in np.geomspace(3e-2, 3e-4, 9):
        points = level + rough * np.random.default_rng(0).normal(size=level.shape)
        placed = fitted(points, loops, 1e-3)
        said.append(placed is None)
        if placed is not None:
            assert warps(placed, loops).max() <= 1e-4 + 1e-12
            assert np.linalg.norm(placed - points, axis=1).max() <= 0.02
    assert said == sorted(said, reverse=True)
    assert 0 < sum(said) < len(said)


def test_plane_faces_are_left_alone():
    for how in ("refuse", "triangulate", "fit"):
        block, notes = mended("box", BOX.vertices, BOX.faces, twisted=how)
        assert (len(block.faces), notes) == (6, ())


@pytest.mark.parametrize(
    ("points", "step"),
    [
        (np.round(np.random.default_rng(0).uniform(0, 1, (8, 3)), 3), 1e-3),
        (np.round(np.random.default_rng(0).uniform(0, 1, (8, 3)) * 2**14) / 2**14, 2.0**-14),
        (np.random.default_rng(0).uniform(0, 1, (8, 3)), 0.0),
        (BOX.vertices, 0.0),  # whole metres are how it was drawn
        (np.round(LIFTED, 1), 0.0),
    ],
)
def test_rounding(points, step):
    assert rounding(points) == pytest.approx(step)


def test_rounding_to_half_precision():
    points = np.random.default_rng(0).uniform(0.25, 0.5, (8, 3)).astype(np.float16).astype(float)
    points[0] = 2.0**-13 * 1.0009765625  # a step of its own, far finer
    assert rounding(points) == pytest.approx(np.abs(points).max() * 2.0**-10)

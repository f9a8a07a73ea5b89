import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from limitblocks.geometry import polygon

UNIT = np.array([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)])


def turned(points, angle):
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([(c, s), (-s, c)])


@settings(max_examples=40, deadline=None)
@given(
    b=st.floats(0.01, 10),
    h=st.floats(0.01, 10),
    x=st.floats(-1e4, 1e4),
    y=st.floats(-1e4, 1e4),
    t=st.floats(0, 6.3),
)
def test_rectangle(b, h, x, y, t):
    stack = turned(UNIT * (b, h), t)[None] + np.array((x, y))
    assert polygon.areas(stack) == pytest.approx(b * h, rel=1e-6)
    assert polygon.centroids(stack)[0] == pytest.approx([x, y], abs=1e-6)
    i1, i2 = h * b**3 / 12, b * h**3 / 12
    c, s = np.cos(t), np.sin(t)
    expected = [i1 * c * c + i2 * s * s, i1 * s * s + i2 * c * c, (i1 - i2) * s * c]
    assert polygon.second_moments(stack)[0] == pytest.approx(expected, rel=1e-5, abs=1e-5 * (i1 + i2))


def test_triangles_in_a_stack():
    b, h = np.array([3.0, 1.0]), np.array([2.0, 5.0])
    zero = np.zeros(2)
    stack = np.stack([np.column_stack(p) for p in ((zero, zero), (b, zero), (zero, h))], axis=1)
    assert polygon.areas(stack) == pytest.approx(b * h / 2)
    assert polygon.areas(stack[:, ::-1]) == pytest.approx(-b * h / 2)
    assert polygon.centroids(stack) == pytest.approx(np.column_stack([b, h]) / 3)
    expected = np.column_stack([h * b**3 / 36, b * h**3 / 36, -(b**2) * h**2 / 72])
    assert polygon.second_moments(stack) == pytest.approx(expected)


def test_regular_polygon():
    n, r = 7, 2.0
    t = 2 * np.pi * np.arange(n) / n
    stack = r * np.column_stack([np.cos(t), np.sin(t)])[None]
    wedge = 2 * np.pi / n
    assert polygon.areas(stack) == pytest.approx(n * r**2 * np.sin(wedge) / 2)
    polar = n * r**4 * np.sin(wedge) * (2 + np.cos(wedge)) / 12
    assert polygon.second_moments(stack)[0] == pytest.approx([polar / 2, polar / 2, 0], abs=1e-12)


def test_clean_removes_duplicates_and_collinear_vertices_only():
    square = np.array([(0, 0), (0.3, 0), (1, 0), (1, 1e-9), (1, 1), (0, 1), (0, 1)])
    triangle = np.array([(0, 0), (1, 0), (0.5, 1e-3), (0, 1)]) + 5.0
    points, owner = np.concatenate([square, triangle]), np.repeat([0, 1], [7, 4])
    points, owner = polygon.clean(points, owner, np.array([1e-6, 1e-6]))
    assert points[owner == 0] == pytest.approx(np.array([(0, 0), (1, 0), (1, 1), (0, 1)]), abs=1e-8)
    assert points[owner == 1] == pytest.approx(triangle)


@pytest.mark.parametrize(
    ("outline", "side"),
    [
        (UNIT * (2, 1), 0),  # along X of the two that tie
        (UNIT * (1, 2), 1),  # along Y of the two that tie
        (UNIT, 0),  # all four tie: the one along +X
        (turned(UNIT, np.pi / 4), 0),  # (+X, +Y) and (+X, -Y) tie along X: the one along +Y
        (turned(UNIT, np.pi / 4)[[3, 0, 1, 2]], 1),  # whatever the first vertex is
        (UNIT * (1, 1 + 1e-9), 0),  # equal within the tolerance
        (UNIT * (1, 1 + 1e-4), 1),
    ],
)
def test_longest_side(outline, side):
    planes = np.eye(3)[None, :2]
    assert polygon.longest_side(outline[None], planes).tolist() == [side]


def test_longest_side_in_a_vertical_plane_looks_along_z_last():
    planes = np.array([[(0, 1, 0), (0, 0, 1)]], dtype=float)  # a plane of constant x
    assert polygon.longest_side(UNIT[None], planes).tolist() == [0]  # along +Y
    assert polygon.longest_side(UNIT[None] * (1, 2), planes).tolist() == [1]  # along +Z

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
    first, turn = polygon.along_longest_side(outline[None], np.eye(3)[None, :2])
    assert first.tolist() == [(side + 1) % 4]
    along = outline[first[0]] - outline[first[0] - 1]
    assert turn[0] @ along == pytest.approx([np.hypot(*along), 0.0])


def test_axes_of_a_rectangle_are_along_its_side_to_the_last_bit():
    """The mean of its two long sides is off by rounding."""
    for angle in np.linspace(0.0, 3.0, 50):
        outline = turned(UNIT * (2, 1) - (0.3, 0.2), angle)
        first, turn = polygon.along_longest_side(outline[None], np.eye(3)[None, :2])
        along = outline[first[0]] - outline[first[0] - 1]
        assert (turn[0, 0] == along / np.hypot(*along)).all()


def test_longest_side_in_a_vertical_plane_looks_along_z_last():
    planes = np.array([[(0, 1, 0), (0, 0, 1)]], dtype=float)  # a plane of constant x
    assert polygon.along_longest_side(UNIT[None], planes)[0].tolist() == [1]  # along +Y
    assert polygon.along_longest_side(UNIT[None] * (1, 2), planes)[0].tolist() == [2]  # along +Z


LEGS = np.array([(-0.2, -0.5), (0.2, -0.5), (0.1, 0.5), (-0.1, 0.5)])  # longest sides at 0.1 from its axis


@pytest.mark.parametrize(
    ("outline", "line"),
    [
        (LEGS, np.pi / 2),  # the axis of symmetry
        (np.array([(-1.0, 0.0), (1.0, 0.0), (0.0, 4.0)]), np.pi / 2),
        (np.array([(-2.0, 0.0), (2.0, 0.0), (0.0, 1.0)]), 0.0),  # one side is the longest
        (np.array([(-2.0, 0.0), (0.0, -1.0), (2.0, 0.0), (0.0, 1.0)]), 0.0),  # a rhombus of 53 degrees
        (np.array([(0.0, 0.0), (1.0, 0.0), (1.0 + 1e-5, 1.0), (1e-5, 1.0)]), 0.0),  # not its diagonal
        (np.exp(1j * np.pi / 3 * np.arange(6)).view(float).reshape(6, 2), 0.0),
    ],
)
@pytest.mark.parametrize("angle", [0.0, 0.3, 2.0])
def test_axes_of_sides_that_tie(outline, line, angle):
    """Mirror images of what is symmetric have axes that are each other's images, as lines or right angles."""
    for mirrored in (outline, (outline * (-1, 1))[::-1]):
        _, turn = polygon.along_longest_side(turned(mirrored, angle)[None], np.eye(3)[None, :2])
        off = np.arctan2(turn[0, 0, 1], turn[0, 0, 0]) - angle - line
        if len(outline) == 6:  # any of its sides
            assert np.sin(3.0 * off) == pytest.approx(0.0, abs=1e-9)
        else:
            assert np.sin(2.0 * off) == pytest.approx(0.0, abs=1e-4)

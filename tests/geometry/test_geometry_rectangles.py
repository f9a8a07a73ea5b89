"""Areas whose sides lie along two perpendicular directions are divided into few rectangles."""

import numpy as np
import pytest
import shapely
import shapely.affinity
from bodies import PLUS, SQUARE, L, U
from hypothesis import given, settings
from hypothesis import strategies as st

from limitblocks.geometry.pieces import convex_pieces

TOLERANCE = 1e-3
LEGS = [(0, 0), (3, 0), (3, 1), (1, 1), (1, 2), (0, 2)]  # 3 x 1 and 1 x 1, or 2 x 1 and 1 x 2: more even


def divided(shape, axis=(1.0, 0.0), mirrored=False, tolerance=TOLERANCE):
    return convex_pieces(np.array([shape]), np.array([axis]), np.array([mirrored]), tolerance)[0]


def are_rectangles(pieces):
    boxes = shapely.area(shapely.oriented_envelope(pieces))
    return shapely.get_num_coordinates(pieces).max() == 5 and np.allclose(boxes, shapely.area(pieces))


def fill(pieces, whole):
    return shapely.symmetric_difference(shapely.union_all(pieces), whole).area < 1e-9 and (
        shapely.area(pieces).sum() == pytest.approx(whole.area)
    )


@st.composite
def areas_of_cells(draw):
    """One area of unit cells, with its holes."""
    size = draw(st.integers(2, 5)), draw(st.integers(2, 5))
    full = np.array(draw(st.lists(st.booleans(), min_size=size[0] * size[1], max_size=size[0] * size[1])))
    boxes = [shapely.box(i, j, i + 1, j + 1) for i, j in np.argwhere(full.reshape(size)).tolist()]
    parts = shapely.get_parts(shapely.union_all([shapely.box(0, 0, 1, 1), *boxes]))
    return shapely.simplify(max(parts, key=shapely.area), 0.0)


def reflex(shape):
    total = 0
    for ring in shapely.get_rings(shapely.geometry.polygon.orient(shape)):
        sides = np.diff(shapely.get_coordinates(ring), axis=0)
        after = np.roll(sides, -1, axis=0)
        total += int((sides[:, 0] * after[:, 1] - sides[:, 1] * after[:, 0] < 0).sum())
    return total


@settings(max_examples=60, deadline=None)
@given(shape=areas_of_cells(), angle=st.floats(0.0, 6.3), turn=st.floats(0.0, 6.3), mirrored=st.booleans())
def test_rectangles_fill_an_area_and_turn_with_it(shape, angle, turn, mirrored):
    """One cut a reflex corner in one direction: at most reflex corners - holes + 1 of them."""
    axis = np.array([np.cos(angle), np.sin(angle)])
    pieces = divided(shape, axis, mirrored)
    assert are_rectangles(pieces)
    assert fill(pieces, shape)
    assert len(pieces) <= reflex(shape) - shapely.get_num_interior_rings(shape) + 1
    turned = shapely.affinity.rotate(shape, turn, origin=(7, 3), use_radians=True)
    moved = divided(turned, (np.cos(angle + turn), np.sin(angle + turn)), mirrored)
    back = [shapely.affinity.rotate(one, -turn, origin=(7, 3), use_radians=True) for one in moved]
    assert shapely.area(shapely.symmetric_difference(pieces, back)) == pytest.approx(0.0, abs=1e-9)
    seen = divided(shapely.affinity.scale(shape, xfact=-1.0, origin=(0, 0)), axis * (-1, 1), not mirrored)
    back = [shapely.affinity.scale(one, xfact=-1.0, origin=(0, 0)) for one in seen]
    assert shapely.area(shapely.symmetric_difference(pieces, back)) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("outline", "holes", "count"),
    [(L, [], 2), (U, [], 3), (PLUS, [], 3), (LEGS, [], 2), (2 * SQUARE, [SQUARE], 4)],
)
@pytest.mark.parametrize("first", range(4))
def test_rectangles_are_few_whatever_the_first_corner(outline, holes, count, first):
    pieces = divided(shapely.Polygon(np.roll(outline, -first, axis=0), holes))
    assert len(pieces) == count
    assert fill(pieces, shapely.Polygon(outline, holes))


@pytest.mark.parametrize("axis", [(1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (-1.0, 0.3)])
def test_of_as_many_rectangles_the_more_even_ones(axis):
    assert sorted(shapely.area(divided(shapely.Polygon(LEGS), axis))) == pytest.approx([2, 2])


def test_corners_near_a_line_are_on_it():
    """Shoulders of a T half the tolerance apart, and corners off by a third of it, make no splinters."""
    shoulders = np.array([(0, 0), (3, 0), (3, 1), (2, 1), (2, 3), (1, 3), (1, 1), (0, 1)], dtype=float)
    whole = shapely.Polygon(shoulders)
    noise = np.random.default_rng(1).uniform(-TOLERANCE / 3, TOLERANCE / 3, shoulders.shape)
    shoulders[6:, 1] += TOLERANCE / 2
    for outline in (shoulders, shoulders + noise):
        pieces = divided(shapely.Polygon(outline))
        assert len(pieces) == 2
        assert are_rectangles(pieces)
        assert shapely.symmetric_difference(shapely.union_all(pieces), whole).area < TOLERANCE * whole.length
    assert len(divided(shapely.Polygon(shoulders), tolerance=1e-6)) == 3


def test_a_comb_keeps_the_heights_of_its_teeth():
    """Each is on the line of the next within the tolerance, but the last is not on that of the first."""
    tops = [(k, 1 + 0.8 * TOLERANCE * (k // 2)) for k in range(19)]
    teeth = [p for k, h in tops[::2] for p in ((k, 0.5), (k, h), (k + 1, h), (k + 1, 0.5))]
    whole = shapely.Polygon([(19, 0), (0, 0), *teeth])
    made = shapely.union_all(divided(whole), grid_size=1e-9)
    assert shapely.hausdorff_distance(made.exterior, whole.exterior) < 2 * TOLERANCE


@pytest.mark.parametrize("angle", np.pi / 4 * np.arange(8))
def test_rounding_settles_no_tie(angle):
    """A square about a square, cut in either direction: axes along a side, or along a diagonal."""
    shape = shapely.Polygon(2 * SQUARE, [SQUARE])
    one, other = (divided(shape, (np.cos(a), np.sin(a))) for a in (angle - 1e-12, angle + 1e-12))
    assert shapely.area(shapely.symmetric_difference(one, other)) == pytest.approx(0.0, abs=1e-9)

"""Blocks that are not convex, with holes and cavities: mass properties and refusals."""

import numpy as np
import pytest
import shapely
from bodies import SQUARE, L, U, extruded, hollow, moved, regular, ring, triangulated
from hypothesis import given, settings
from hypothesis import strategies as st

from limitblocks.errors import GeometryError
from limitblocks.geometry import Block
from limitblocks.geometry.pieces import convex_pieces

FAR = 1e6


@pytest.mark.parametrize("shift", [0.0, FAR])
def test_l_block(shift):
    # two squares of side 2 and 1, the second one taken away
    block = extruded("L", L).moved(np.eye(3), (shift, -shift, shift))
    assert not block.convex
    assert block.volume == pytest.approx(2 * 2 - 1, rel=1e-8)
    middle = (4 * 1 - 1 * 1.5) / 3
    assert block.centroid - (shift, -shift, shift) == pytest.approx([middle, middle, 0.5], abs=1e-8)
    assert sorted(block.areas) == pytest.approx([1, 1, 1, 1, 2, 2, 3, 3])


@pytest.mark.parametrize("shift", [0.0, FAR])
def test_square_hole_through_a_box(shift):
    outer, inner, height, off = 2.0, 1.0, 3.0, 0.2
    block = ring("tube", outer * SQUARE, inner * SQUARE + (off, 0), 0, height)
    block = block.moved(np.eye(3), np.zeros(3) + shift)
    assert not block.convex
    assert block.volume == pytest.approx((outer**2 - inner**2) * height, rel=1e-8)
    middle = [-off * inner**2 / (outer**2 - inner**2), 0, height / 2]
    assert block.centroid - shift == pytest.approx(middle, abs=1e-8)


@pytest.mark.parametrize("n", [3, 12, 100])
def test_tube_with_facets(n):
    outer, inner, height = 2.0, 1.5, 0.7
    block = ring("tube", regular(n, outer), regular(n, inner), 0, height)
    assert block.volume == pytest.approx(n / 2 * np.sin(2 * np.pi / n) * (outer**2 - inner**2) * height)


def test_cavity():
    outer, inner, off = 3.0, 1.0, 0.5
    block = hollow("hollow", outer, inner, (off, 0, 0))
    assert not block.convex
    assert block.volume == pytest.approx(outer**3 - inner**3)
    assert block.centroid == pytest.approx([-off * inner**3 / (outer**3 - inner**3), 0, 0])


@pytest.mark.parametrize("block", [extruded("U", U), ring("tube", 2 * SQUARE, SQUARE), hollow("h", 2.0, 1.0)])
def test_triangles_divide_the_faces(block):
    split = triangulated(block)
    assert split.volume == pytest.approx(block.volume)
    assert split.centroid == pytest.approx(block.centroid)
    assert split.areas.sum() == pytest.approx(block.areas.sum())
    assert len(split.faces) == sum(len(face) - 2 for face in block.faces)


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 2**31))
def test_rigid_motion_carries_a_body_with_a_hole_along(seed):
    before = ring("tube", 2 * SQUARE, SQUARE + 0.1)
    (after,), rotation, translation = moved([before], seed)
    assert after.volume == pytest.approx(3.0)
    assert after.centroid == pytest.approx(rotation @ before.centroid + translation, abs=1e-9)


def test_noise_of_a_tenth_of_a_millimetre_on_a_brick_is_accepted():
    brick = Block.box("brick", (0.2, 0.1, 0.05), (0, 0, 0))
    for seed in range(20):
        noise = np.random.default_rng(seed).uniform(-1e-4, 1e-4, (8, 3))
        for form in (brick, triangulated(brick)):
            assert Block("brick", form.vertices + noise, form.faces).volume == pytest.approx(1e-3, rel=2e-2)


def test_loop_that_crosses_itself_is_refused():
    block = extruded("L", L)
    swapped = block.vertices.copy()
    swapped[[3, 9]] = swapped[[3, 9]] + (2, -3, 0)  # the inner corner beyond the opposite side
    with pytest.raises(GeometryError, match=r"block 'L': face 0 crosses itself near vertex \d"):
        Block("L", swapped, block.faces)
    star = regular(5, 1.0)[[0, 2, 4, 1, 3]]  # turns left at every corner
    with pytest.raises(GeometryError, match="block 'star': face 0 crosses itself"):
        extruded("star", star)


def test_surface_that_crosses_itself_is_refused():
    # a tube whose inner wall leans out through its outer wall
    tube = ring("tube", 2 * SQUARE, SQUARE, 0, 4)
    points = tube.vertices.copy()
    points[12:] += (1.3, 0, 0)
    with pytest.raises(GeometryError, match=r"block 'tube': (the surface|face \d+) crosses itself"):
        Block("tube", points, triangulated(tube).faces)


def both(first, second, inward=False):
    faces = [*first.faces, *(tuple(len(first.vertices) + v for v in f) for f in second.faces)]
    return np.concatenate([first.vertices, second.vertices]), faces


def test_two_pieces_are_refused():
    pieces = both(Block.box("a", (1, 1, 1), (0, 0, 0)), Block.box("b", (1, 1, 1), (3, 0, 0)))
    with pytest.raises(GeometryError, match="block 'pair': face 6 belongs to a second piece"):
        Block("pair", *pieces)


def test_same_box_twice_is_refused():
    pieces = both(Block.box("a", (1, 1, 1), (0, 0, 0)), Block.box("b", (1, 1, 1), (0, 0, 0)))
    with pytest.raises(GeometryError, match="block 'twice': face 6 belongs to a second piece"):
        Block("twice", *pieces)


def test_cavity_whose_faces_point_out_of_it_is_refused():
    inside_out = both(Block.box("a", (3, 3, 3), (0, 0, 0)), Block.box("b", (1, 1, 1), (0, 0, 0)))
    with pytest.raises(GeometryError, match=r"face 6 belongs to .* a cavity whose faces point out of it"):
        Block("hollow", *inside_out)


def test_cavity_outside_the_block_is_refused():
    with pytest.raises(GeometryError, match="face 6 belongs to a cavity that is not inside the block"):
        hollow("hollow", 2.0, 1.0, (5, 0, 0))


def test_cavity_that_breaks_through_is_refused():
    with pytest.raises(GeometryError, match=r"the surface crosses itself: edge \d+-\d+ passes through face"):
        hollow("hollow", 2.0, 1.0, (0.9, 0.01, 0.02))


def test_inward_faces_of_a_body_with_a_hole_are_refused():
    tube = ring("tube", 2 * SQUARE, SQUARE)
    with pytest.raises(GeometryError, match=r"volume is negative \(-3 m3\): the faces point inward"):
        Block("tube", tube.vertices, [face[::-1] for face in tube.faces])


#: Areas that hardly hold together: a neck of 1e-12 m, a hole that meets the rim, or is in a bump of it.
FRAIL = {
    "neck": [[(0, 0), (1, 0), (1, 0.5), (2, 0.5), (2, 0), (3, 0.3), (3, 1), (2, 1), (2, 0.5 + 1e-12),
              (1, 0.5 + 1e-12), (1, 1), (0, 1.1)]],
    "rim": [[(0, 0), (1, 0), (1, 1), (0, 1)], [(0.3, 0), (0.7, 0.4), (0.3, 0.8)]],
    "bump": [[(0, 0), (0.5, -0.008), (1, 0), (1, 0.6), (0.5, 1), (0, 1)],
             [(0.5, -0.004), (0.7, 0.4), (0.3, 0.5)]],
}  # fmt: skip


@pytest.mark.parametrize("angle", [4.0, 20.0, 40.0])
@pytest.mark.parametrize("name", FRAIL)
def test_an_area_that_hardly_holds_together_is_divided_into_sound_pieces(name, angle):
    rim, *holes = FRAIL[name]
    area = shapely.affinity.rotate(shapely.Polygon(rim, holes), angle)
    pieces, _ = convex_pieces(np.array([area]), np.array([[1.0, 0.0]]), np.array([False]), 1e-2)
    assert shapely.area(pieces).sum() == pytest.approx(area.area, rel=1e-6)
    assert shapely.area(pieces).min() > 1e-3


def test_an_area_narrower_than_the_tolerance_is_not_lost():
    """An arrow 2 m long and 2 mm wide, notched by 0.4 mm: all of its corners are within 1 cm of a line."""
    arrow = shapely.Polygon([(0, 0), (1, 4e-4), (2, 0), (1, 2e-3)])
    pieces, owner = convex_pieces(np.array([arrow]), np.array([[1.0, 0.0]]), np.array([False]), 1e-2)
    assert owner.tolist() == [0]
    assert shapely.area(pieces) == pytest.approx([2 * 2e-3 / 2])  # the notch counts as straight

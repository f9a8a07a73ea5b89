"""Overlaps of bodies, convex or not, at their depth and volume."""

import numpy as np
import pytest
from bodies import SQUARE, L, U, extruded, hollow, moved, ring

from limitblocks.errors import GeometryError
from limitblocks.geometry import Block, find_contacts, find_interfaces


def overlap_of(*blocks):
    (contacts,) = find_contacts(blocks, None).overlaps
    return contacts


def slab(a, b, thickness):
    """Mean thickness of a box."""
    return 2 * a * b * thickness / (2 * (a * b + (a + b) * thickness))


@pytest.mark.parametrize("seed", [None, 1, 2])
@pytest.mark.parametrize("depth", [0.2, 0.01])
def test_overlap_of_an_l_block(depth, seed):
    blocks = [extruded("L", L), Block.box("b", (1, 1, 1), (1.5 - depth, 1.5, 0.5))]
    if seed is not None:
        blocks, _, _ = moved(blocks, seed)
    result = overlap_of(*blocks)
    assert (result.block_i, result.block_j) == ("L", "b")
    assert result.volume == pytest.approx(depth)
    assert result.depth == pytest.approx(slab(1, 1, depth), rel=1e-3)
    with pytest.raises(GeometryError, match=f"blocks 'L' and 'b' overlap by {depth:.3g} m3"):
        find_interfaces(blocks, None)


@pytest.mark.parametrize("seed", [None, 1, 2])
def test_blocks_that_fill_each_others_notches_do_not_overlap(seed):
    blocks = [
        extruded("U", U),
        Block.box("post", (1, 1, 4), (1.5, 1.5, 0)),
        ring("r", 8 * SQUARE, 7 * SQUARE, 0, 1),
    ]
    blocks += [hollow("h", 2.0, 1.0).moved(np.eye(3), (20, 0, 0)), Block.box("stone", (1, 1, 1), (20, 0, 0))]
    if seed is not None:
        blocks, _, _ = moved(blocks, seed)
    assert find_contacts(blocks, None).overlaps == ()


def test_overlap_of_two_legs_counts_each_by_itself():
    depth = 0.05
    result = overlap_of(extruded("U", U), Block.box("b", (1 + 2 * depth, 1, 1), (1.5, 1.5, 0.5)))
    assert result.volume == pytest.approx(2 * depth)
    assert result.depth == pytest.approx(slab(1, 1, depth), rel=1e-3)


def test_tolerance_of_overlap_of_bodies_that_are_not_convex():
    low = extruded("low", U)
    for depth, count in ((0.9e-3, 0), (1.6e-3, 1)):  # block length: between 1 and cbrt(5)
        high = Block.box("high", (1, 1, 1), (1.5, 1.5, 0.5)).moved(np.eye(3), (0, -depth, 0))
        assert len(find_contacts([low, high], None).overlaps) == count


def test_stone_within_a_body_with_a_cavity():
    result = overlap_of(hollow("h", 4.0, 1.0), Block.box("stone", (0.5, 0.5, 0.5), (1.2, 1.2, 1.2)))
    assert result.volume == pytest.approx(0.5**3)
    assert result.depth == pytest.approx(0.5 / 3, rel=1e-3)


@pytest.mark.parametrize("at", [0.0, 0.2])
def test_thin_blocks_do_not_hide_an_overlap(at):
    # thinner than the tolerance of 1e-3 block lengths
    plate = Block.box("plate", (0.5, 0.25, 1e-4), (0, 0, at))
    for stone in (Block.box("stone", (1, 1, 1), (0, 0, 0)), hollow("stone", 1.0, 0.05, (0.3, 0.3, 0.3))):
        result = overlap_of(stone, plate, Block.box("other", (1, 1, 1), (5, 0, 0)))
        assert result.volume == pytest.approx(0.5 * 0.25 * 1e-4)
        assert result.tolerance < 0.5e-4
    half_in = plate.moved(np.eye(3), (0, 0, 0.5 - at - 1e-5))
    assert overlap_of(Block.box("stone", (1, 1, 1), (0, 0, 0)), half_in).depth == pytest.approx(6e-5)
    resting = plate.moved(np.eye(3), (0, 0, 0.5 - at + 0.5e-4))
    assert len(find_interfaces([Block.box("stone", (1, 1, 1), (0, 0, 0)), resting], None)) == 1

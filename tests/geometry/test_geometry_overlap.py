import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from limitblocks.errors import GeometryError
from limitblocks.geometry import Block, find_contacts, find_interfaces

box = Block.box
UNIT = (1.0, 1.0, 1.0)


def message(a, b, volume, depth):
    return f"blocks '{a}' and '{b}' overlap by {volume:.3g} m3, {depth:.3g} m deep"


@settings(max_examples=30, deadline=None)
@given(shift=st.tuples(*[st.floats(-0.9, 0.9)] * 3), seed=st.integers(0, 2**31))
def test_overlap_of_two_boxes(shift, seed):
    turn = Rotation.from_quat(np.random.default_rng(seed).normal(size=4)).as_matrix()
    blocks = [box("a", UNIT, (0, 0, 0)), box("b", UNIT, shift)]
    with pytest.raises(GeometryError) as error:
        find_interfaces([block.moved(turn, (5, 6, 7)) for block in blocks], None)
    (problem,) = error.value.problems
    numbers = [float(word) for word in problem.replace(";", "").split() if word[0].isdigit()]
    sides = 1 - np.abs(shift)
    assert numbers == pytest.approx([sides.prod(), sides.min(), 1e-3], rel=6e-3)


def test_every_overlap_is_listed():
    blocks = [box("a", UNIT, (0, 0, 0)), box("b", UNIT, (0.5, 0, 0)), box("c", UNIT, (1.25, 0, 0))]
    with pytest.raises(GeometryError) as error:
        find_interfaces(blocks, None)
    first, second = error.value.problems
    assert first.startswith(message("a", "b", 0.5, 0.5))
    assert second.startswith(message("b", "c", 0.25, 0.25))


def test_identical_blocks_and_blocks_inside_others():
    with pytest.raises(GeometryError, match=message("a", "b", 1.0, 1.0)):
        find_interfaces([box("a", UNIT, (0, 0, 0)), box("b", UNIT, (0, 0, 0))], None)
    inner = box("b", (0.5, 0.25, 1e-4), (0, 0, 0.2))  # thinner than the tolerance
    with pytest.raises(GeometryError, match=message("a", "b", 0.5 * 0.25 * 1e-4, 0.3)):
        find_interfaces([box("a", UNIT, (0, 0, 0)), inner], None)


@pytest.mark.parametrize("turn", [np.eye(3), Rotation.from_rotvec([0.3, -1.1, 2.0]).as_matrix()])
def test_tolerance(turn):
    low, high = box("low", UNIT, (0, 0, 0)), box("high", UNIT, (0, 0, 1 - 0.999e-3))
    assert len(find_interfaces([b.moved(turn, (0, 0, 0)) for b in (low, high)], None)) == 1
    high = box("high", UNIT, (0, 0, 1 - 1.01e-3))
    with pytest.raises(GeometryError, match=message("low", "high", 1.01e-3, 1.01e-3)):
        find_interfaces([b.moved(turn, (0, 0, 0)) for b in (low, high)], None)
    assert len(find_interfaces([low, high], None, gap=2e-3)) == 1


def crossed_edges(distance):
    """Two unit cubes on edge; the nearest edges, along x and along y, are `distance` apart."""
    eighth = np.pi / 4
    low = box("low", UNIT, (0, 0, 0)).moved(Rotation.from_rotvec([eighth, 0, 0]).as_matrix(), (0, 0, 0))
    turn = Rotation.from_rotvec([0, eighth, 0]).as_matrix()
    return [low, box("high", UNIT, (0, 0, 0)).moved(turn, (0, 0, np.sqrt(2) + distance))]


@pytest.mark.parametrize("distance", [0.01, 0.0, -0.9e-3])
def test_crossed_edges_that_do_not_overlap(distance):
    # no face plane separates them
    assert find_interfaces(crossed_edges(distance), None) == ()


def test_crossed_edges_that_overlap():
    depth = 0.01  # a square pyramid of base |x| + |y| <= depth
    with pytest.raises(GeometryError, match=message("low", "high", 2 * depth**3 / 3, depth)):
        find_interfaces(crossed_edges(-depth), None)


def test_tetrahedra_point_to_face():
    faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
    points = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], dtype=float)
    ground = box("ground", (4, 4, 1), (0, 0, -0.5))
    depth = 0.2  # the tip that is below ground is a tetrahedron similar to the whole
    tip = Block("tip", points * (1, 1, -1) + (0, 0, 1 - depth), [face[::-1] for face in faces])
    with pytest.raises(GeometryError, match=message("ground", "tip", depth**3 / 6, depth)):
        find_interfaces([ground, tip], None)
    assert find_interfaces([ground, tip.moved(np.eye(3), (0, 0, depth))], None) == ()


@pytest.mark.parametrize(("at", "said"), [(0.0, True), (0.05, True), (0.2, False)])
def test_a_block_drawn_twice_is_said(at, said):
    blocks = [Block.box("a", (1, 1, 1), (0, 0, 0)), Block.box("a 2", (1, 1, 1), (at, 0, 0))]
    (overlap,) = find_contacts(blocks, None).overlaps
    assert overlap.share == pytest.approx(1.0 - at)
    assert ("drawn twice; delete one" in find_contacts(blocks, None).faults[0]) is said


def test_a_frame_is_one_line_not_one_for_each_stone():
    stones = [Block.box(f"s{k}", (1, 1, 1), (2 * k, 0, 0)) for k in range(20)]
    frame = Block.box("frame", (50, 1, 5), (20, 0, 0))
    found = find_contacts([*stones, frame], None)
    assert len(found.overlaps) == 20
    for said in (found.faults, found.warnings):
        (line,) = (
            line for line in said if "frame" in line and "isolated" not in line and "interface" not in line
        )
        assert line.startswith("block 'frame' holds 20 others")
    with pytest.raises(GeometryError, match="block 'frame' holds 20 others"):
        found.require()

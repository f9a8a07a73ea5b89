"""Parametric structures: counts, dimensions and refusals."""

from dataclasses import replace

import numpy as np
import pytest
from stones import volume

import limitblocks as lb
from limitblocks import structures

JOINT = lb.PointContact(0.6)


def supported_interfaces(model):
    supports = set(model.supports)
    return sum(bool({i.block_i, i.block_j} & supports) for i in model.interfaces)


@pytest.mark.parametrize(
    ("number", "blocks", "interfaces", "on_base"),
    [(1, 33, 83, 6), (2, 55, 141, 6), (3, 46, 102, 4), (4, 55, 116, 6)],
)
def test_ferris_tin_loi_counts(number, blocks, interfaces, on_base):
    """Blocks and interfaces of the source, which counts the interfaces with the base, not the base."""
    model = structures.ferris_tin_loi_wall(number, JOINT)
    assert len(model.free_blocks) == blocks
    assert len(model.interfaces) == interfaces
    assert supported_interfaces(model) == on_base


def test_ferris_tin_loi_knows_four_walls():
    with pytest.raises(lb.ModelError, match="wall 5 is unknown"):
        structures.ferris_tin_loi_wall(5, JOINT)


def test_wall_is_a_running_bond():
    length, courses, block, height, thickness = 1.6, 4, 0.4, 0.2, 0.3
    model = structures.wall(
        JOINT, length=length, courses=courses, block_length=block, block_height=height, thickness=thickness
    )
    assert len(model.free_blocks) == 2 * 4 + 2 * 5
    assert volume(model) == pytest.approx(length * courses * height * thickness)
    # head joints 4 + 3 by turns; bed joints: each of 8 half lengths between two courses; 5 blocks on the base
    assert len(model.interfaces) == (4 + 3) * 2 + 3 * 8 + 5


def test_wall_with_openings_bridged_by_lintels():
    door, window = structures.Opening(0.8, 0.0, 0.8, 0.8), (2.4, 0.4, 0.6, 0.6)
    model = structures.wall(JOINT, length=4.0, courses=8, thickness=0.3, openings=[door, window])
    assert volume(model) == pytest.approx(0.3 * (4.0 * 1.6 - 0.8 * 0.8 - 0.6 * 0.6))
    lintels = {block.name: block for block in model.free_blocks if "lintel" in block.name}
    spans = {name: np.ptp(block.vertices[:, 0]) for name, block in lintels.items()}
    assert spans == pytest.approx({"wall lintel 1": 0.8 + 0.4, "wall lintel 2": 0.6 + 0.4})
    assert lintels["wall lintel 1"].vertices[:, 2].min() == pytest.approx(0.8)
    assert lb.bounds(model).lower > 0.0


def test_opening_to_the_top_of_the_wall_has_no_lintel():
    model = structures.wall(JOINT, length=2.0, courses=4, openings=[(0.8, 0.4, 0.4, 0.4)])
    assert not any("lintel" in block.name for block in model.blocks)


def test_openings_side_by_side_up_to_the_ends_of_the_wall_whatever_rounding_says():
    """0.4 + 0.8 is above 1.2, 1.6 + 0.8 above 2.4, and 0.15 + 0.75 above 6 x 0.15."""
    openings = [(0.4, 0.15, 0.8, 0.75), (1.2, 0.15, 0.4, 0.75), (1.6, 0.15, 0.8, 0.75)]
    model = structures.wall(JOINT, length=2.4, courses=6, block_height=0.15, openings=openings)
    assert volume(model) == pytest.approx((2.4 * 0.9 - 2.0 * 0.75) * 0.2, rel=1e-12)


@pytest.mark.parametrize(
    ("opening", "message"),
    [
        ((0.7, 0.0, 0.8, 0.8), "left is 0.7"),
        ((0.8, 0.1, 0.8, 0.8), "sill is 0.1"),
        ((0.8, 0.0, 0.8, 2.0), "above the wall"),
        ((0.8, 0.0, -0.8, 0.8), "positive width"),
        ((0.0, 0.0, 0.8, 0.8), "leaves the wall"),
    ],
)
def test_wall_refuses_openings_off_the_grid(opening, message):
    with pytest.raises(lb.ModelError, match=message):
        structures.wall(JOINT, length=4.0, courses=8, openings=[opening])


def test_wall_refuses_openings_that_overlap():
    with pytest.raises(lb.ModelError, match="overlaps another"):
        structures.wall(JOINT, length=4.0, courses=8, openings=[(0.8, 0, 0.8, 0.8), (1.2, 0, 0.8, 0.8)])


@pytest.mark.parametrize("length", [2.4, 2.8, 3.2, 3.6])
def test_as_many_quoins_bind_either_return_wall(length):
    """Half blocks in odd number: a joint ran through all courses at one end."""
    model = structures.facade(JOINT, length=length, courses=6, return_length=1.6, openings=())
    for at in (0.4, length - 0.4):
        x = np.array(
            [(block.vertices[:, 0].min(), block.vertices[:, 0].max()) for block in model.free_blocks]
        )
        assert ((x[:, 0] < at - 1e-9) & (x[:, 1] > at + 1e-9)).sum() == 3


def test_facade_is_interlocked_with_its_returns():
    model = structures.facade(JOINT)
    assert len(model.free_blocks) >= 150
    stone, returns = 0.8, 0.4 * (3.2 - 0.4) * 4.4
    openings = 1.2 * 2.4 + 1.2 * 1.2
    assert volume(model) == pytest.approx(0.4 * (6.4 * 4.4 - openings) + 2 * returns)
    assert all(
        np.ptp(block.vertices[:, :2], axis=0).min() == pytest.approx(0.4) for block in model.free_blocks
    )
    for side in ("left", "right"):
        bearing = [
            i for i in model.interfaces
            if abs(i.axes[2, 2]) > 0.9 and {i.block_i.split()[0], i.block_j.split()[0]} == {"facade", side}
        ]  # fmt: skip
        # between every two courses the quoin of one wall bears on half a stone of the other
        assert len(bearing) == 11 - 1
        assert [lb.joints.areas(i.polygon) for i in bearing] == pytest.approx([0.4 * stone / 2] * 10)
        quoins = [b for b in model.free_blocks if b.name.startswith(side) and b.vertices[:, 1].min() < 0.01]
        assert len(quoins) == 11 // 2


def test_facade_resists_out_of_plane_more_than_a_free_wall():
    joint, length, courses = lb.PointContact(0.6), 3.2, 4
    tied = structures.facade(joint, length=length, courses=courses, return_length=1.6, openings=[])
    assert lb.bounds(tied).lower > 1.05 * 0.4 / (courses * 0.4)


def test_arch_geometry():
    radius, thickness, n, depth = 5.0, 0.8, 9, 1.5
    model = structures.arch(JOINT, radius=radius, thickness=thickness, voussoirs=n, depth=depth)
    assert len(model.free_blocks) == n
    assert len(model.interfaces) == n + 1
    outer, inner = radius + thickness / 2, radius - thickness / 2
    sector = np.sin(np.pi / n) / 2  # area of a triangle between two radii of length one
    assert volume(model) == pytest.approx(n * sector * (outer**2 - inner**2) * depth)
    for interface in model.interfaces:
        assert np.linalg.norm(interface.centroid) == pytest.approx(radius)
        assert interface.axes[2] @ interface.centroid == pytest.approx(0.0, abs=1e-9)  # radial joints


@pytest.mark.parametrize("embrace", [2 * np.pi / 3, np.radians(157.5), np.pi])
def test_arch_is_symmetrical(embrace):
    model = structures.arch(JOINT, radius=5.0, thickness=0.9, voussoirs=8, embrace=embrace)
    left = lb.bounds(model).lower
    right = lb.bounds(replace(model, live=lb.mass_proportional((-1, 0, 0)))).lower
    assert left == pytest.approx(right, rel=1e-6)

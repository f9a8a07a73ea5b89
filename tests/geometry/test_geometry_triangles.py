"""Faces with corners on straight sides, as merged ones have: divided without triangles that have no area."""

from collections import deque

import numpy as np
import pytest
from manifold3d import Manifold, Mesh64

import limitblocks as lb
from limitblocks.geometry import surface
from limitblocks.geometry.polygon import areas

# a leg and an arm of a stone drawn as eleven faces, some with corners of their neighbours on their sides
LOOPS = [
    [(0, 0.3, 0.25), (0, 0.3, 0.75), (0, 1.25, 0.75), (0, 1.25, 0.25)],
    [(0.25, 0.6, 0.25), (0.25, 1.25, 0.25), (0.25, 1.25, 0.75), (0.25, 0.6, 0.75)],
    [(0.25, 0, 0), (0.65, 0, 0), (0.65, 0, 0.75), (0.25, 0, 0.75)],
    [(0.25, 0.6, 0), (0.25, 0.6, 0.25), (0.25, 0.6, 0.75), (0.65, 0.6, 0.75), (0.65, 0.6, 0)],
    [(0.25, 0, 0), (0.25, 0, 0.75), (0.25, 0.3, 0.75), (0.25, 0.3, 0.25), (0.25, 0.6, 0.25), (0.25, 0.6, 0)],
    [(0.65, 0, 0), (0.65, 0.6, 0), (0.65, 0.6, 0.75), (0.65, 0, 0.75)],
    [(0, 0.3, 0.25), (0.25, 0.3, 0.25), (0.25, 0.3, 0.75), (0, 0.3, 0.75)],
    [(0, 1.25, 0.25), (0, 1.25, 0.75), (0.25, 1.25, 0.75), (0.25, 1.25, 0.25)],
    [(0.25, 0, 0), (0.25, 0.6, 0), (0.65, 0.6, 0), (0.65, 0, 0)],
    [(0, 0.3, 0.75), (0.25, 0.3, 0.75), (0.25, 0, 0.75), (0.65, 0, 0.75), (0.65, 0.6, 0.75),
     (0.25, 0.6, 0.75), (0.25, 1.25, 0.75), (0, 1.25, 0.75)],
    [(0, 0.3, 0.25), (0, 1.25, 0.25), (0.25, 1.25, 0.25), (0.25, 0.6, 0.25), (0.25, 0.3, 0.25)],
]  # fmt: skip


def stone(turn):
    """The same body whatever corner its faces start with."""
    points = sorted({corner for loop in LOOPS for corner in loop})
    faces = []
    for loop in LOOPS:
        corners = deque(points.index(corner) for corner in loop)
        corners.rotate(-turn)
        faces.append(list(corners))
    return lb.Block("stone", points, faces, 20e3)


@pytest.mark.parametrize("turn", range(6))
def test_an_overlap_is_found_whatever_corner_a_face_starts_with(turn):
    """A box that reaches .05 m into the leg; the solid of the stone had .274 of .299 m3."""
    box = lb.Block.box("box", (0.3, 0.25, 0.1), (0.15, 0.35, 0.05), 20e3)
    ground = lb.Block.box("ground", (3, 3, 0.2), (0.3, 0.5, -0.1))
    with pytest.raises(lb.ModelError, match=r"blocks 'stone' and 'box' overlap by 0\.00125 m3"):
        lb.find_interfaces([ground, stone(turn), box], lb.PointContact(0.6))


@pytest.mark.parametrize("turn", range(6))
def test_a_solid_has_the_volume_of_its_block(turn):
    block = stone(turn)
    corners = block.vertices[block.triangles]
    assert surface._breadth(corners).min() > 1e-3
    assert Manifold(
        Mesh64(block.vertices.copy(), block.triangles.astype(np.uint64))
    ).volume() == pytest.approx(0.25 * 0.95 * 0.5 + 0.4 * 0.6 * 0.75, rel=1e-12)


@pytest.mark.parametrize("count", [1, 2, 7])
def test_every_side_may_have_corners(count):
    """A square with corners on all four sides has no corner that a fan could start from."""
    along = np.arange(count + 1) / (count + 1)
    still = np.zeros_like(along)
    sides = [(along, still), (1 + still, along), (1 - along, 1 + still), (still, 1 - along)]
    outline = np.concatenate([np.column_stack(side) for side in sides])
    block = lb.Block.prism("square", outline.tolist(), (0, 1), 20e3, along="x")
    corners = block.vertices[block.triangles]
    assert len(corners) == 2 * (len(outline) - 2) + 2 * len(outline)
    assert surface._breadth(corners).min() > 1e-3
    assert areas(np.array([outline]))[0] == pytest.approx(1.0)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
    assert np.linalg.norm(normals, axis=1).sum() == pytest.approx(6.0)
    assert np.einsum("ij,ij->i", normals, corners[:, 0]).sum() / 3 == pytest.approx(1.0)  # outwards


@pytest.mark.parametrize("angle", [0.05, 0.08, 0.3])
def test_a_corner_on_a_side_but_for_roundoff_is_in_no_triangle_without_area(angle):
    """Ear clipping cuts off the corner itself where roundoff puts it outside the side."""
    turn = np.exp(1j * angle) * (np.array([(0.0, 0.0), (1.0, 0.0), (0.75, 0.5), (0.5, 1.0)]) @ (1, 1j))
    outline = np.column_stack([turn.real, turn.imag])
    block = lb.Block.prism("wedge", outline.tolist(), (0, 1), 20e3, along="x")
    assert surface._breadth(block.vertices[block.triangles]).min() > 0.1

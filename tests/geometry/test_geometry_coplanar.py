"""Faces in one plane made one: what is one plane, outlines that touch themselves, needless vertices."""

import numpy as np
import pytest
from bodies import extruded, regular, ring

from limitblocks.geometry.coplanar import area_vectors, merged

MANY = 100


def prism(outline):
    """Vertices and faces of a prism of height 1 over an outline (n, 2)."""
    block = extruded("prism", outline)
    return block.vertices, block.faces


def gridded(n):
    """A cube of n x n squares on each side, each square as two triangles."""
    places, faces = {}, []

    def at(point):
        return places.setdefault(tuple(point.tolist()), len(places))

    for axis in range(3):
        along, across, out = np.roll(np.eye(3, dtype=int), -axis - 1, axis=0)
        for side in (0, n):
            for i, j in np.ndindex(n, n):
                first = side * out + i * along + j * across
                a, b, c, d = (at(first + step) for step in (0 * along, along, along + across, across))
                faces += [trio if side else trio[::-1] for trio in ((a, b, c), (a, c, d))]
    return np.array(list(places)) / n, tuple(faces)


def test_a_cube_of_many_triangles_has_six_faces():
    points, faces = gridded(4)
    found, warp = merged(points, faces, 1.0, MANY)
    assert sorted(map(len, found)) == [4] * 6
    assert np.linalg.norm(area_vectors(points, found), axis=1) == pytest.approx(1.0)
    assert warp == 0.0


@pytest.mark.parametrize(
    ("angle", "width", "faces"),
    [
        (0.005, 0.004, 6),  # both small
        (0.02, 0.004, 7),  # 2e-2 rad of 1e-2
        (0.005, 0.019, 6),  # falls by .95e-4 of 1e-4 of the size
        (0.005, 0.03, 7),  # by 1.5e-4
        (1.0, 5e-5, 6),  # too slim for its normal to count
        (1.0, 3e-4, 7),
    ],
)
def test_a_bevel_is_part_of_the_face_beside_it_while_it_is_nearly_in_its_plane(angle, width, faces):
    """A unit square with a corner cut off: the strip is `width` wide and turned by `angle`."""
    fall = width * np.sin(angle)
    outline = [(0, 0), (1, 0), (1, 1 - fall), (1 - width * np.cos(angle), 1), (0, 1)]
    points, loops = prism(outline)
    found, warp = merged(points, loops, 1.0, MANY)
    assert len(found) == faces
    assert (0.0 < warp <= 1e-4) == (faces == 6)


def pitted():
    """A cube with a pit of three sides in its top, whose rim meets that of the top in one corner."""
    points = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
    points += [(1, 0, 2), (1.5, 1, 2), (0.5, 1, 2), (1, 0.6, 1.5)]
    sides = [(3, 2, 1, 0), (0, 1, 5, 8, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
    top = [(8, 5, 9), (5, 6, 9), (6, 7, 10), (6, 10, 9), (7, 4, 10), (4, 8, 10)]
    pit = [(8, 9, 11), (9, 10, 11), (10, 8, 11)]
    return np.array(points), (*sides, *top, *pit)


@pytest.mark.parametrize("shift", range(12))
def test_faces_round_a_pit_that_touches_the_rim_stay_in_pieces(shift):
    points, faces = pitted()
    faces = tuple(tuple((v + shift) % 12 for v in face) for face in faces)
    found, _ = merged(np.roll(points, shift, axis=0), faces, 2.0, MANY)
    assert sorted(found) == sorted(faces)


def test_faces_round_a_hole_stay_in_pieces():
    tube = ring("tube", regular(4, 2.0), regular(4, 1.0))
    found, _ = merged(tube.vertices, tube.faces, 4.0, MANY)
    assert sorted(found) == sorted(tube.faces)


def test_a_needle_has_no_outline_to_be_one_face_of():
    points, faces = prism([(0, 0), (1, 0), (1, 1), (0, 1)])
    found, _ = merged(points * (1e-5, 1e-5, 1.0), faces, 1.0, MANY)
    assert sorted(found) == sorted(faces)


def test_faces_beyond_the_most_are_not_looked_for():
    points, faces = prism(regular(50, 1.0))
    assert len(merged(points, faces, 2.0, 52)[0]) == 52
    assert len(merged(points, faces, 2.0, 20)[0]) == 21


def test_vertices_of_a_flat_arc_go_one_by_one():
    """Each is 7.6e-7 off the line of its neighbours: the half circle stays one, of fewer sides."""
    angle = np.linspace(0.0, np.pi, 1801)
    arc = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(1801)]) / 2
    points = np.vstack([arc, [(-0.5, -0.5, 0), (0.5, -0.5, 0)]])
    loop = tuple(range(len(points)))
    (back, face), _ = merged(points, (loop[::-1], loop), 1.0, MANY)
    assert 4 < len(face) < 1000
    assert sorted(face) == sorted(back)
    assert abs(area_vectors(points, (face,))[0, 2]) == pytest.approx(0.5 + np.pi / 8, abs=1e-5)


@pytest.mark.parametrize(
    ("second", "left"), [((0.5, -5e-7, 0), 4), ((0.5, -2e-6, 0), 5), ((1.5, 0, 0), 5), ((-0.5, 0, 0), 5)]
)
def test_a_vertex_between_two_sides_in_line_is_needless(second, left):
    """Not one beyond their ends, which is the tip of a spike."""
    points = np.array([(0, 0, 0), second, (1, 0, 0), (1, 1, 0), (0, 1, 0.0)])
    (face, _), _ = merged(points, ((0, 1, 2, 3, 4), (4, 3, 2, 1, 0)), 1.0, MANY)
    assert len(face) == left


def test_a_vertex_of_a_third_face_is_not():
    """Half of the top of a box slopes down: the step beside it ends in the line of the front edge."""
    points = [(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (2, 0, 1)]
    points += [(2, 0.5, 0.5), (1, 0.5, 0.5), (2, 1, 0.5), (1, 1, 0.5), (1, 1, 1), (0, 1, 1)]
    front, step = (0, 1, 6, 5, 4), (5, 8, 10, 11)
    top = (4, 5, 11, 12), (5, 6, 7, 8), (8, 7, 9, 10)
    others = (3, 2, 1, 0), (1, 2, 9, 7, 6), (2, 3, 12, 11, 10, 9), (3, 0, 4, 12)
    found, _ = merged(np.array(points) * (1, 20, 1), (*others, *top, step, front), 20.0, MANY)
    assert sorted(found) == sorted((*others, *top, step, front))


def test_a_slim_face_is_no_spike_of_the_face_at_its_end():
    """The top of a fin goes with the side of the fin, not with the top of the box."""
    outline = np.array([(0, 0), (1, 0), (2, 0), (2, 1e-4), (1, 1e-4), (1, 5), (0, 5)])
    points = np.vstack([np.column_stack([outline, np.full(7, z)]) for z in (0.0, 1.0)])
    sides = [(k, (k + 1) % 7, (k + 1) % 7 + 7, k + 7) for k in range(7)]
    ends = [(7, 8, 11, 12, 13), (8, 9, 10, 11)]
    below = [tuple(v - 7 for v in face[::-1]) for face in ends]
    found, _ = merged(points, (*sides, *ends, *below), 5.0, MANY)
    assert set(ends[0]) in map(set, found)


def test_a_face_that_is_a_line_keeps_its_vertices():
    points = np.array([(0, 0, 0), (0.5, 0, 0), (1, 0, 0.0)])
    found, _ = merged(points, ((0, 1, 2), (2, 1, 0)), 1.0, MANY)
    assert list(map(len, found)) == [3, 3]

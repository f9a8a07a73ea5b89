"""Polygon soups become blocks: what is mended keeps the solid, what cannot be mended is named."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import limitblocks as lb
from limitblocks.geometry.mend import mended

BOX = lb.Block.box("box", (1.0, 2.0, 3.0), (0.5, 1.0, 1.5))
VOUSSOIR = lb.structures.arch(lb.PointContact(0.6), radius=5.0, thickness=0.8, voussoirs=9).free_blocks[2]
CORNERS = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)


def soup(block, rng, turned=0.5):
    """Triangles of a block in random order, each with its own vertices, some of them turned."""
    triangles = []
    for face in block.faces:
        k = rng.integers(len(face))
        ring = block.vertices[[*face[k:], *face[:k]]]
        fan = [ring[[0, j, j + 1]] for j in range(1, len(ring) - 1)]
        triangles += [corners[::-1] if rng.random() < turned else corners for corners in fan]
    triangles = rng.permutation(np.array(triangles))
    return triangles.reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3)


def same_solid(result, block, tolerance=1e-12):
    scale = block.size
    assert result.volume == pytest.approx(block.volume, rel=tolerance)
    assert np.abs(result.centroid - block.centroid).max() <= tolerance * scale
    assert len(result.faces) == len(block.faces)
    assert sorted(result.areas) == pytest.approx(sorted(block.areas), rel=tolerance)


@given(st.integers(0, 2**31), st.sampled_from([BOX, VOUSSOIR]), st.floats(-1e3, 1e3))
def test_triangle_soup_gives_the_solid_back(seed, block, far):
    rng = np.random.default_rng(seed)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    block = block.moved(turn, (far, -far, far / 2))
    result, notes = mended("stone", *soup(block, rng))
    same_solid(result, block, 1e-9)
    assert len(result.vertices) == len(block.vertices)
    assert all(note.startswith("block 'stone': ") for note in notes)


def test_sound_solid_stays_as_it_is_without_a_note():
    result, notes = mended("box", BOX.vertices, BOX.faces)
    same_solid(result, BOX)
    assert notes == ()


def test_inside_out_is_turned_with_a_note():
    values, notes = mended("box", BOX.vertices, [face[::-1] for face in BOX.faces])
    same_solid(values, BOX)
    assert notes == ("block 'box': all faces pointed inward and are turned",)


def test_repeated_and_flat_faces_go_with_a_note():
    flat = [(0, 0, 1), (2, 2, 2)]
    values, notes = mended("box", BOX.vertices, [*BOX.faces, *flat, BOX.faces[0], BOX.faces[1][::-1]])
    same_solid(values, BOX)
    assert notes == (
        "block 'box': 2 of 10 faces without area left out",
        "block 'box': 2 of 8 faces repeat another one and are left out",
    )


@pytest.mark.parametrize("width", [1e-7, 1e-5, 3e-4])
def test_crack_up_to_the_tolerance_is_closed_with_its_width(width):
    rng = np.random.default_rng(1)
    vertices, faces = soup(BOX, rng, turned=0.0)
    shift = rng.normal(size=vertices.shape)
    shift *= width * BOX.size / 2.0 / np.linalg.norm(shift, axis=1)[:, None]  # ends at most `width` apart
    result, notes = mended("box", vertices + shift, faces)
    assert result.volume == pytest.approx(BOX.volume, rel=10 * width)
    assert "merged" in notes[0] or "crack" in notes[0]


def test_wider_crack_is_an_open_surface_with_its_place():
    vertices, faces = soup(BOX, np.random.default_rng(1), turned=0.0)
    vertices[0] += 2e-3 * BOX.size
    with pytest.raises(lb.errors.GeometryError, match=r"block 'box'.*open.*from \(.*\) to \(") as caught:
        mended("box", vertices, faces)
    assert "\n" not in str(caught.value)


def test_vertex_on_the_edge_of_another_face_closes_it():
    middle = (BOX.vertices[0] + BOX.vertices[4]) / 2.0
    faces = [*BOX.faces[1:], (0, 8, 6, 2), (8, 4, 6)]  # BOX.faces[0] is (0, 4, 6, 2)
    values, notes = mended("box", [*BOX.vertices, middle], faces)
    same_solid(values, BOX)
    assert len(values.vertices) == 8  # a vertex in the middle of an edge says nothing
    assert notes == (
        "block 'box': vertices inserted where they lie on the edge of another face, within 0 m: 1",
    )


def test_needle_triangles_join_the_plane_of_their_longest_side():
    middle = (BOX.vertices[0] + BOX.vertices[4]) / 2.0
    below = next(face for face in BOX.faces[1:] if {0, 4} <= set(face))
    k = below.index(4)
    ring = (*below[k:], *below[:k])  # from 4 round to 0
    assert ring[1] == 0 or ring[-1] == 0
    faces = [*BOX.faces[1:], (0, 8, 6, 2), (8, 4, 6), (0, 4, 8)]
    values, _ = mended("box", [*BOX.vertices, middle], faces)
    same_solid(values, BOX)


def test_faces_of_a_round_body_are_not_merged():
    n = 40
    angle = 2.0 * np.pi * np.arange(n) / n
    ring = np.column_stack([np.cos(angle), np.sin(angle)])
    vertices = np.vstack([np.column_stack([ring, np.full(n, z)]) for z in (0.0, 1.0)])
    k = np.arange(n)
    after = (k + 1) % n
    sides = np.vstack([np.column_stack([k, after, after + n]), np.column_stack([k, after + n, k + n])])
    ends = np.vstack([np.column_stack([k * 0, after, k])[1:-1], np.column_stack([k * 0, k, after])[1:-1] + n])
    values, notes = mended("drum", vertices, [*sides.tolist(), *ends.tolist()])
    assert len(values.faces) == n + 2
    assert values.volume == pytest.approx(n / 2.0 * np.sin(2.0 * np.pi / n))  # regular n-gon
    assert notes == ()


def test_slightly_warped_quadrilateral_is_taken_as_flat_with_a_note():
    vertices = BOX.vertices.copy()
    vertices[7] += (0.0, 0.0, 5e-5)
    faces = [
        part for face in BOX.faces for part in ((face[0], face[1], face[2]), (face[0], face[2], face[3]))
    ]
    result, notes = mended("box", vertices, faces)
    assert len(result.faces) == 6
    assert "flat within" in notes[0]


def test_outline_bridged_to_a_hole_is_read():
    outer = [(x, y) for x, y in ((0, 0), (3, 0), (3, 3), (0, 3))]
    inner = [(x, y) for x, y in ((1, 1), (2, 1), (2, 2), (1, 2))]
    vertices = [(x, y, z) for z in (0.0, 1.0) for x, y in outer + inner]  # 0-3, 4-7 below; 8-11, 12-15 above
    top = (8, 9, 10, 11, 8, 12, 15, 14, 13, 12)
    bottom = tuple(v - 8 for v in reversed(top))
    sides = [(k, (k + 1) % 4, (k + 1) % 4 + 8, k + 8) for k in range(4)]
    sides += [((k + 1) % 4 + 4, k + 4, k + 12, (k + 1) % 4 + 12) for k in range(4)]
    values, notes = mended("frame", vertices, [top, bottom, *sides])
    assert values.volume == pytest.approx(8.0)
    assert notes == ()


def test_face_that_is_not_planar_is_named_by_its_corners():
    vertices = BOX.vertices.copy()
    vertices[7] += (0.0, 0.0, 0.1)
    with pytest.raises(
        lb.errors.GeometryError, match=r"'box'.*twisted face.*\(1, 2, 3.1\).*--twisted triangulate or fit"
    ):
        mended("box", vertices, BOX.faces)


MOEBIUS = [(k, (k + 1) % 5, (k + 2) % 5) for k in range(5)]
# the projective plane of 6 vertices: closed, without an inner side
PROJECTIVE = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5), (0, 5, 1)]
PROJECTIVE += [(1, 2, 4), (2, 3, 5), (3, 4, 1), (4, 5, 2), (5, 1, 3)]
WRONG = {
    "Moebius strip": (CORNERS[:5], MOEBIUS, "open"),
    "projective plane": (CORNERS[:6], PROJECTIVE, "no inner and outer side"),
    "two solids": (
        np.vstack([BOX.vertices, BOX.vertices + 5.0]),
        [*BOX.faces, *(tuple(v + 8 for v in face) for face in BOX.faces)],
        "2 separate closed surfaces",
    ),
    "membrane": (BOX.vertices, [*BOX.faces, (0, 1, 7, 6)], "belong to 3 faces"),
    "no faces": (BOX.vertices, [], "at least 4"),
    "flat": (BOX.vertices * (1, 1, 0), BOX.faces, "block"),
    "NaN": (np.where(BOX.vertices == BOX.vertices[3], np.nan, BOX.vertices), BOX.faces, "finite"),
    "index out of range": (BOX.vertices, [*BOX.faces, (0, 1, 8)], "0 to 7"),
    "negative index": (BOX.vertices, [*BOX.faces, (0, 1, -1)], "0 to 7"),
    "faces of text": (BOX.vertices, ["abc"], "faces"),
    "vertices of the plane": (BOX.vertices[:, :2], BOX.faces, r"\(n, 3\)"),
    "vertices of text": ("abc", BOX.faces, "vertices"),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_cannot_be_mended_is_named(name):
    vertices, faces, said = WRONG[name]
    with pytest.raises(lb.errors.GeometryError, match=said) as caught:
        mended("stone", vertices, faces)
    assert str(caught.value).startswith("block 'stone': ")
    assert "\n" not in str(caught.value)


def test_vertices_that_crowd_do_not_take_all_memory():
    rng = np.random.default_rng(1)
    crowd = rng.normal(size=(20000, 3)) * 1e-9
    vertices = np.vstack([BOX.vertices, crowd])
    faces = [*BOX.faces, *((a, a + 1, a + 2) for a in range(8, 20006, 3))]
    with pytest.raises(lb.errors.GeometryError, match="coarser"):
        mended("stone", vertices, faces)

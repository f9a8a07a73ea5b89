import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from limitblocks.errors import GeometryError, ModelError
from limitblocks.geometry import Block

FAR = 1e6
BOX = Block.box("stone", (1, 1, 1), (0, 0, 0))
PRISM_FACES = ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5))


def tetrahedron(a, b, c, shift=0.0):
    points = np.array([(0, 0, 0), (a, 0, 0), (0, b, 0), (0, 0, c)], dtype=float) + shift
    return Block("tetrahedron", points, [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)])


def frustum(bottom, top, height, shift=0.0):
    """Square frustum with its axis on z."""
    square = np.array([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)])
    points = [np.column_stack([square * s, np.full(4, z)]) for s, z in ((bottom, 0), (top, height))]
    faces = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
    return Block("frustum", np.concatenate(points) + shift, faces)


@pytest.mark.parametrize("shift", [0.0, FAR])
def test_box(shift):
    box = Block.box("stone", (2.0, 3.0, 0.5), (shift, -shift, shift), unit_weight=20e3)
    assert box.volume == pytest.approx(2.0 * 3.0 * 0.5, rel=1e-8)
    assert box.centroid == pytest.approx([shift, -shift, shift], rel=1e-12, abs=1e-12)
    assert box.weight == pytest.approx(20e3 * 3.0, rel=1e-8)
    assert box.size == pytest.approx(3.0, rel=1e-8)
    assert sorted(map(tuple, np.round(box.normals).tolist())) == sorted(
        map(tuple, np.vstack([np.eye(3), -np.eye(3)]).tolist())
    )
    middles = [box.vertices[list(face)].mean(axis=0) for face in box.faces]
    assert np.einsum("ij,ij->i", box.normals, middles) == pytest.approx(box.offsets, rel=1e-12)


@pytest.mark.parametrize("shift", [0.0, FAR])
def test_tetrahedron(shift):
    a, b, c = 1.0, 2.0, 3.0
    block = tetrahedron(a, b, c, shift)
    assert block.volume == pytest.approx(a * b * c / 6, rel=1e-8)
    assert block.centroid - shift == pytest.approx([a / 4, b / 4, c / 4], abs=1e-9)
    sides = np.array([a, b, c])
    second = (4.0 * np.diag(sides**2) - np.outer(sides, sides)) / 80.0  # of its volume, over the volume
    assert block.size == pytest.approx(np.sqrt(12.0 * np.linalg.eigvalsh(second)[-1]), rel=1e-8)


@pytest.mark.parametrize("shift", [0.0, FAR])
def test_frustum(shift):
    height, bottom, top = 1.5, 2.0, 1.0
    a, b = bottom**2, top**2
    block = frustum(bottom, top, height, shift)
    mixed = np.sqrt(a * b)
    assert block.volume == pytest.approx(height / 3 * (a + mixed + b), rel=1e-8)
    level = height / 4 * (a + 2 * mixed + 3 * b) / (a + mixed + b)
    assert block.centroid - shift == pytest.approx([0, 0, level], abs=1e-9)


def test_triangular_prism():
    base = np.array([(0, 0), (3, 0), (0, 2)])
    points = np.concatenate([np.column_stack([base, np.full(3, z)]) for z in (1, 5)])
    block = Block("prism", points, PRISM_FACES)
    assert block.volume == pytest.approx(3 * 2 / 2 * 4)
    assert block.centroid == pytest.approx([1, 2 / 3, 3])


@pytest.mark.parametrize("turn", [1, -1])
@pytest.mark.parametrize(("along", "centre"), [("x", (3, 2, 1)), ("y", (2, 3, 1)), ("z", (2, 1, 3))])
def test_prism_of_a_gable(along, centre, turn):
    """A triangle of base 4 and height 3, whichever way it turns, from 2 to 4 along the axis."""
    gable = Block.prism("gable", [(0, 0), (4, 0), (2, 3)][::turn], (2, 4), 19e3, along)
    assert gable.volume == pytest.approx(4 * 3 / 2 * 2)
    assert gable.centroid == pytest.approx(centre)
    assert gable.weight == pytest.approx(19e3 * 12)


@pytest.mark.parametrize(
    ("outline", "between", "along", "message"),
    [
        ([(0, 0), (1, 0), (1, 1)], (1, 0), "y", r"between is \(1, 0\); the lesser place comes first"),
        ([(0, 0), (1, 0), (1, 1)], (0, 1), "Y", "along is 'Y'; x, y or z is needed"),
        ([(0, 0), (1, 0)], (0, 1), "y", "a polyhedron has at least 4|faces|vertices"),
        ([(0, 0), (1, 1), (1, 0), (0, 1)], (0, 1), "y", ""),
        ([(0, 0), (1, 0), (2, 0)], (0, 1), "y", ""),
        ([(0, 0, 0)], (0, 1), "y", r"outline: shape \(1, 3\) given; shape \(n, 2\) is needed"),
    ],
)
def test_prism_refuses(outline, between, along, message):
    with pytest.raises(GeometryError, match=f"block 'stone': .*({message})"):
        Block.prism("stone", outline, between, along=along)


@settings(max_examples=40, deadline=None)
@given(
    size=st.tuples(*[st.floats(0.05, 20.0)] * 3),
    at=st.tuples(*[st.floats(-1e3, 1e3)] * 3),
    seed=st.integers(0, 2**31),
)
def test_rigid_motion_carries_the_body_along(size, at, seed):
    rng = np.random.default_rng(seed)
    rotation, translation = Rotation.from_quat(rng.normal(size=4)).as_matrix(), rng.uniform(-1e3, 1e3, 3)
    box = Block.box("stone", size, at, unit_weight=1.0)
    moved = box.moved(rotation, translation)
    assert moved.volume == pytest.approx(np.prod(size), rel=1e-9)
    assert moved.size == pytest.approx(max(size), rel=1e-9)
    assert moved.centroid == pytest.approx(rotation @ at + translation, abs=1e-9)
    assert np.abs(moved.normals - box.normals @ rotation.T).max() < 1e-9
    assert (moved.name, moved.faces, moved.unit_weight) == (box.name, box.faces, box.unit_weight)


def test_block_is_a_read_only_copy():
    points = BOX.vertices.copy()
    block = Block("stone", points, [list(face) for face in BOX.faces])
    points[:] = 0.0
    assert block.volume == pytest.approx(1.0)
    assert block.faces == BOX.faces
    for array in (block.vertices, block.centroid, block.normals, block.offsets):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0.0


def test_weight_needs_a_unit_weight():
    with pytest.raises(ModelError, match="'stone' has no unit weight"):
        _ = BOX.weight
    assert Block.box("stone", (1, 1, 1), (0, 0, 0), unit_weight=0.0).weight == 0.0


@pytest.mark.parametrize("name", ["", "  ", None, 3])
def test_name_must_be_a_text(name):
    with pytest.raises(ModelError, match=f"name is {name!r}"):
        Block.box(name, (1, 1, 1), (0, 0, 0))


@pytest.mark.parametrize("value", [-1.0, np.inf, np.nan, "20 kN"])
def test_unit_weight_must_be_a_number(value):
    with pytest.raises(ModelError, match=f"'stone': unit weight is {value!r}"):
        Block.box("stone", (1, 1, 1), (0, 0, 0), unit_weight=value)


@pytest.mark.parametrize(
    ("size", "at", "message"),
    [
        ((1, 0, 1), (0, 0, 0), r"size is \(1.0, 0.0, 1.0\); all three dimensions must be positive"),
        ((1, -2, 1), (0, 0, 0), r"size is \(1.0, -2.0, 1.0\)"),
        ((1, 1), (0, 0, 0), r"size: shape \(2,\) given; shape \(3,\) is needed"),
        ((1, 1, np.nan), (0, 0, 0), r"size\[2\] is nan"),
        ((1, 1, 1), (0, np.inf, 0), r"at\[1\] is inf"),
        ("big", (0, 0, 0), r"size: 'big' given; numbers of shape \(3,\)"),
    ],
)
def test_box_refuses(size, at, message):
    with pytest.raises(GeometryError, match=f"block 'stone': .*{message}"):
        Block.box("stone", size, at)


def _vertices(**changes):
    points = BOX.vertices.copy()
    for index, value in changes.items():
        points[int(index[1:])] = value
    return points


@pytest.mark.parametrize(
    ("vertices", "message"),
    [
        (_vertices(v3=(0.5, np.nan, 0)), r"vertices\[3, 1\] is nan"),
        (BOX.vertices[:, :2], r"vertices: shape \(8, 2\) given; shape \(n, 3\)"),
        (np.vstack([BOX.vertices, (0, 0, 0)]), "vertex 8 belongs to no face"),
        (_vertices(v7=(0.7, 0.7, 0.7)), r"face \d is not planar: vertex \d is 0\.\d+ m out of its plane"),
        (_vertices(v7=BOX.vertices[6]), "vertices 6 and 7 coincide"),
        (
            _vertices(v7=(1e9, 0, 0)),
            r" apart, which is nothing .*; vertex 7 at \(1e\+09, 0, 0\) m is far from all",
        ),
        (
            (BOX.vertices + 1e9).astype(np.float32),
            "coincide; keep one.*; at 1e\\+09 m from the origin .* too few",
        ),
        (BOX.vertices[:7], r"face 1 = \(1, 3, 7, 5\) has a vertex index out of range; .* 0 to 6"),
        (BOX.vertices[[1, 0, 3, 2, 5, 4, 7, 6]], r"volume is negative \(-1 m3\): the faces point inward"),
        (BOX.vertices @ np.array([(1, 0, 0), (0, 1, 0), (1, 1, 0)]), "volume is zero"),
    ],
)
def test_vertices_refused(vertices, message):
    with pytest.raises(GeometryError, match=f"block 'stone': .*{message}"):
        Block("stone", vertices, BOX.faces)


@pytest.mark.parametrize(
    ("faces", "message"),
    [
        (BOX.faces[:3], "3 faces given; a polyhedron has at least 4"),
        (BOX.faces[:5], r"not a closed surface: uses of edge \d-\d: 1 from \d to \d, 0 back"),
        (
            (BOX.faces[0][::-1], *BOX.faces[1:]),
            "not a closed surface: uses of edge 0-2: 2 from 0 to 2, 0 back",
        ),
        (((0, 1), *BOX.faces[1:]), "face 0 has 2 vertices; a face has at least 3"),
        (((0, 2, 2), *BOX.faces[1:]), r"face 0 = \(0, 2, 2\) repeats a vertex"),
        (((0, -1, 2), *BOX.faces[1:]), r"face 0 = \(0, -1, 2\) has a vertex index out of range"),
        (((0, 1.5, 2), *BOX.faces[1:]), "faces: .* given; sequences of vertex indices"),
        (None, "faces: None given"),
    ],
)
def test_faces_refused(faces, message):
    with pytest.raises(GeometryError, match=f"block 'stone': .*{message}"):
        Block("stone", BOX.vertices, faces)


def test_inward_faces_are_refused_and_not_mended():
    with pytest.raises(GeometryError, match="counter-clockwise seen from outside"):
        Block("stone", BOX.vertices, [face[::-1] for face in BOX.faces])


def test_non_convex_face_of_a_convex_block():
    # the top of a box divided into an L and a square
    points = np.array(
        [(x, y, 0) for x, y in ((0, 0), (2, 0), (2, 2), (0, 2))]
        + [(x, y, 1) for x, y in ((0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2), (2, 2))],
        dtype=float,
    )
    sides = [(0, 3, 2, 1), (0, 1, 5, 4), (1, 2, 10, 6, 5), (2, 3, 9, 8, 10), (3, 0, 4, 9)]
    whole = Block("box", points, [*sides, (4, 5, 6, 7, 8, 9), (6, 10, 8, 7)])
    split = Block("box", points, [*sides, (4, 5, 6, 7), (4, 7, 8, 9), (6, 10, 8, 7)])
    assert [whole.volume, split.volume] == pytest.approx([2 * 2 * 1] * 2)
    assert whole.areas[5:] == pytest.approx([3, 1])
    assert whole.convex
    assert split.convex


@pytest.mark.parametrize(("lift", "sound"), [(3.9e-3, True), (4.1e-3, False)])
def test_planarity_tolerance_is_relative_to_the_size(lift, sound):
    size = 10.0  # a vertex lifted by h leaves a square face warped by h / 4 about its mean plane
    points = BOX.vertices * size
    points[7, 2] += lift * size
    if sound:
        assert Block("stone", points, BOX.faces).volume == pytest.approx(size**3, rel=2e-3)
    else:
        with pytest.raises(GeometryError, match="face 5 is not planar"):
            Block("stone", points, BOX.faces)


@pytest.mark.parametrize("rotation", [np.diag([1, 1, -1]), 2 * np.eye(3), np.ones((3, 3))])
def test_moved_needs_a_proper_rotation(rotation):
    with pytest.raises(GeometryError, match=r"'stone': rotation \[\[.* is not proper"):
        BOX.moved(rotation, (0, 0, 0))

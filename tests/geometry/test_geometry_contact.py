import numpy as np
import pytest
from bodies import moved
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import ConvexHull, Voronoi
from scipy.spatial.transform import Rotation

from limitblocks.errors import ModelError
from limitblocks.geometry import Block, find_interfaces, polygon

JOINT = object()
FAR = np.array([1e6, -1e6, 1e6])


def box(name, size, at):
    return Block.box(name, size, at)


def area(interface):
    return float(polygon.areas(interface.polygon))


def total_area(interfaces):
    return sum(map(area, interfaces))


def pairs(interfaces):
    return [(interface.block_i, interface.block_j) for interface in interfaces]


def offset_pair(dx, dy, size=(1.0, 1.0, 1.0)):
    return [box("low", size, (0, 0, 0)), box("high", size, (dx, dy, size[2]))]


def running_bond(courses, length, x=0.4, y=0.2, z=0.2):
    """Wall of whole blocks, every second course shifted by half a block."""
    return [
        box(f"{k}/{m}", (x, y, z), ((m + 0.5 * (k % 2)) * x, 0, k * z))
        for k in range(courses)
        for m in range(length)
    ]


def hexahedron(name, bottom, top):
    faces = [(0, 1, 2, 3), (7, 6, 5, 4), (4, 5, 1, 0), (5, 6, 2, 1), (6, 7, 3, 2), (7, 4, 0, 3)]
    return Block(name, np.concatenate([bottom, top]), faces)


def arch(n, inner, outer, width):
    """Semicircular arch in the plane x, z, of n voussoirs with radial joints."""

    def radial(angle):
        spokes = [
            (r * np.cos(angle), y, r * np.sin(angle))
            for r, y in ((inner, -width / 2), (inner, width / 2), (outer, width / 2), (outer, -width / 2))
        ]
        return np.array(spokes)  # fmt: skip

    angles = np.linspace(0, np.pi, n + 1)
    return [hexahedron(f"v{k}", radial(angles[k]), radial(angles[k + 1])) for k in range(n)]


@settings(max_examples=40, deadline=None)
@given(dx=st.floats(-0.9, 0.9), dy=st.floats(-0.9, 0.9))
def test_stacked_with_an_offset(dx, dy):
    (interface,) = find_interfaces(offset_pair(dx, dy), JOINT)
    assert (interface.block_i, interface.block_j, interface.joint) == ("low", "high", JOINT)
    assert area(interface) == pytest.approx((1 - abs(dx)) * (1 - abs(dy)), rel=1e-9)
    assert interface.centroid == pytest.approx([dx / 2, dy / 2, 0.5])
    assert interface.axes[2] == pytest.approx([0, 0, 1])


@pytest.mark.parametrize("shift", [0.0, FAR])
def test_local_axes_and_vertex_order_of_a_rectangle(shift):
    l1, l2 = 0.3, 0.1
    blocks = [box("low", (2 * l1, 2 * l2, 1), (0, 0, 0)), box("high", (2 * l1, 2 * l2, 2), (0, 0, 1.5))]
    (interface,) = find_interfaces([b.moved(np.eye(3), np.zeros(3) + shift) for b in blocks], JOINT)
    assert interface.axes == pytest.approx(np.eye(3), abs=1e-8)
    corners = np.array([(l1, -l2), (l1, l2), (-l1, l2), (-l1, -l2)])
    assert interface.polygon == pytest.approx(corners, abs=1e-8)
    assert interface.centroid == pytest.approx(np.array([0, 0, 0.5]) + shift)
    for array in (interface.centroid, interface.axes, interface.polygon):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0.0


def test_block_i_is_the_earlier_and_order_is_by_blocks():
    wall = running_bond(3, 3)
    interfaces = find_interfaces(wall, JOINT)
    place = {block.name: k for k, block in enumerate(wall)}
    ranks = [(place[i], place[j]) for i, j in pairs(interfaces)]
    assert ranks == sorted(ranks)
    assert all(i < j for i, j in ranks)
    backward = find_interfaces(wall[::-1], JOINT)
    assert sorted(pairs(interfaces)) == sorted((j, i) for i, j in pairs(backward))
    for interface in interfaces:
        middle = wall[place[interface.block_j]].centroid - wall[place[interface.block_i]].centroid
        assert interface.axes[2] @ middle > 0


def test_running_bond_wall():
    courses, n, x, y, z = 5, 4, 0.4, 0.2, 0.2
    interfaces = find_interfaces(running_bond(courses, n, x, y, z), JOINT)
    assert len(interfaces) == courses * (n - 1) + (courses - 1) * (2 * n - 1)
    expected = courses * (n - 1) * y * z + (courses - 1) * (2 * n - 1) * (x / 2) * y
    assert total_area(interfaces) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("shift", [0.0, FAR])
def test_voussoirs(shift):
    n, inner, outer, width = 9, 2.0, 2.5, 0.8
    blocks = [b.moved(np.eye(3), np.zeros(3) + shift) for b in arch(n, inner, outer, width)]
    interfaces = find_interfaces(blocks, JOINT)
    assert pairs(interfaces) == [(f"v{k}", f"v{k + 1}") for k in range(n - 1)]
    for k, interface in enumerate(interfaces):
        angle = np.pi * (k + 1) / n
        radius = np.array([np.cos(angle), 0, np.sin(angle)])
        assert area(interface) == pytest.approx((outer - inner) * width, rel=1e-8)
        assert interface.centroid - shift == pytest.approx((inner + outer) / 2 * radius, abs=1e-8)
        assert interface.axes[2] == pytest.approx([-np.sin(angle), 0, np.cos(angle)], abs=1e-8)
        assert abs(interface.axes[0]) == pytest.approx([0, 1, 0], abs=1e-8)  # width > thickness


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 2**31))
def test_rigid_motion_moves_the_interfaces_along(seed):
    blocks = running_bond(3, 3) + [b.moved(np.eye(3), (20, 0, 0)) for b in arch(5, 1.0, 1.4, 0.7)]
    before = find_interfaces(blocks, JOINT)
    after_blocks, rotation, translation = moved(blocks, seed)
    after = find_interfaces(after_blocks, JOINT)
    assert pairs(after) == pairs(before)
    assert total_area(after) == pytest.approx(total_area(before), rel=1e-9)
    for old, new in zip(before, after, strict=True):
        assert new.centroid == pytest.approx(rotation @ old.centroid + translation, abs=1e-9)
        assert new.axes[2] == pytest.approx(rotation @ old.axes[2], abs=1e-9)
        assert new.axes @ new.axes.T == pytest.approx(np.eye(3), abs=1e-12)
        assert np.linalg.det(new.axes) == pytest.approx(1.0)
        if len(old.polygon) == 4 and np.ptp(np.linalg.norm(np.diff(old.polygon, axis=0), axis=1)) > 1e-3:
            assert abs(new.axes[0] @ rotation @ old.axes[0]) == pytest.approx(1.0, abs=1e-9)
            assert new.polygon == pytest.approx(old.polygon, abs=1e-9)


@settings(max_examples=10, deadline=None)
@given(seed=st.integers(0, 2**31))
def test_far_from_the_origin_the_interfaces_are_the_same(seed):
    blocks = running_bond(4, 4)
    far, rotation, translation = moved(blocks, seed, FAR)
    before, after = find_interfaces(blocks, JOINT), find_interfaces(far, JOINT)
    assert pairs(after) == pairs(before)
    assert total_area(after) == pytest.approx(total_area(before), rel=1e-8)
    for old, new in zip(before, after, strict=True):
        assert len(new.polygon) == len(old.polygon)
        assert new.centroid == pytest.approx(rotation @ old.centroid + translation, abs=1e-8)


def voronoi_blocks(n, seed):
    """Divide a unit cube into n Voronoi cells; return them and the areas between each two."""
    sites = np.random.default_rng(seed).uniform(size=(n, 3))
    mirrored = [sites]
    for axis in range(3):
        for wall in (0.0, 1.0):
            image = sites.copy()
            image[:, axis] = 2 * wall - image[:, axis]
            mirrored.append(image)
    voronoi = Voronoi(np.concatenate(mirrored))
    rings = [[] for _ in range(n)]
    areas = {}
    for ends, ridge in zip(voronoi.ridge_points, voronoi.ridge_vertices, strict=True):
        if ends.min() >= n:
            continue
        points = voronoi.vertices[ridge]
        for cell in ends[ends < n]:
            out = points.mean(axis=0) - sites[cell]
            swept = np.cross(points - points[0], np.roll(points, -1, axis=0) - points[0]).sum(axis=0)
            rings[cell].append(ridge if swept @ out > 0 else ridge[::-1])
        if ends.max() < n:
            areas[tuple(sorted(ends.tolist()))] = np.linalg.norm(swept) / 2
    blocks = []
    for cell, faces in enumerate(rings):
        used, local = np.unique(np.concatenate(faces), return_inverse=True)
        parts = np.split(local, np.cumsum([len(face) for face in faces])[:-1])
        blocks.append(Block(str(cell), voronoi.vertices[used], [part.tolist() for part in parts]))
    return blocks, areas


@pytest.mark.parametrize("seed", range(4))
def test_rubble_that_fills_a_cube(seed):
    blocks, areas = voronoi_blocks(30, seed)
    assert sum(block.volume for block in blocks) == pytest.approx(1.0, rel=1e-9)
    turned, _, _ = moved(blocks, seed)
    interfaces = {(int(f.block_i), int(f.block_j)): area(f) for f in find_interfaces(turned, JOINT)}
    assert set(interfaces) <= set(areas)
    for ends, expected in areas.items():
        assert interfaces.get(ends, 0.0) == pytest.approx(expected, rel=1e-6, abs=1e-3 * 30 ** (-2 / 3))
    assert all(interfaces[ends] == pytest.approx(areas[ends], rel=1e-6) for ends in interfaces)


@pytest.mark.parametrize(("gap", "count"), [(0.99e-3, 1), (1.01e-3, 0), (-0.99e-3, 1)])
def test_gap_tolerance(gap, count):
    blocks = [box("low", (1, 1, 1), (0, 0, 0)), box("high", (1, 1, 1), (0.2, 0, 1 + gap))]
    interfaces = find_interfaces(blocks, JOINT)
    assert len(interfaces) == count
    for interface in interfaces:
        assert interface.centroid == pytest.approx([0.1, 0, 0.5 + gap / 2])
    assert len(find_interfaces(blocks, JOINT, gap=2e-3)) == 1


def test_block_length_is_the_median_of_the_cube_roots_of_the_volumes():
    small = [box(f"small {k}", (0.1, 0.1, 0.1), (k, 0, 0.05 + 0.5e-3)) for k in range(3)]
    large = box("ground", (10, 10, 1), (0, 0, -0.5))
    assert find_interfaces([large, *small], JOINT) == ()  # 0.5 mm exceeds a thousandth of 0.1 m
    assert len(find_interfaces([large, small[0]], JOINT)) == 1


@pytest.mark.parametrize(("tilt", "count"), [(0.0199, 1), (0.0201, 0)])
def test_angle_tolerance(tilt, count):
    # the upper block is turned about one edge of the joint, which opens as a wedge
    turn = Rotation.from_rotvec([0, tilt, 0]).as_matrix()
    edge = np.array([0.5, 0, 0.5])
    high = box("high", (1, 1, 1), (0, 0, 1)).moved(turn, edge - turn @ edge)
    interfaces = find_interfaces([box("low", (1, 1, 1), (0, 0, 0)), high], JOINT, gap=0.05, angle=0.02)
    assert len(interfaces) == count
    for interface in interfaces:
        half = Rotation.from_rotvec([0, tilt / 2, 0]).as_matrix()
        assert interface.axes[2] == pytest.approx(half @ [0, 0, 1])
        assert area(interface) == pytest.approx(np.cos(tilt / 2), rel=1e-9)
        assert find_interfaces([high, box("low", (1, 1, 1), (0, 0, 0))], JOINT, gap=0.05, angle=0.02)


def test_only_polygons_are_contacts():
    low = box("low", (1, 1, 1), (0, 0, 0))
    assert find_interfaces([], JOINT) == ()
    assert find_interfaces([low], JOINT) == ()
    for at in [(1, 0, 1), (1, 1, 1), (3, 0, 0), (0, -1, 1)]:  # edge, vertex, away, edge
        assert find_interfaces([low, box("other", (1, 1, 1), at)], JOINT) == ()


@pytest.mark.parametrize(("overlap", "count"), [(0.9e-3, 0), (1.1e-3, 1)])
def test_slivers_are_dropped(overlap, count):
    assert len(find_interfaces(offset_pair(1 - overlap, 0), JOINT)) == count


def test_small_faces_on_large_ones_are_no_slivers():
    peg = box("peg", (0.01, 0.01, 0.01), (3, 0, 0.005))
    (interface,) = find_interfaces([box("ground", (10, 10, 10), (0, 0, -5)), peg], JOINT)
    assert area(interface) == pytest.approx(0.01**2)


def test_collinear_vertices_are_removed():
    # a box whose top has a vertex in the middle of one side
    points = np.vstack([box("low", (1, 1, 1), (0, 0, 0)).vertices, (0.1, -0.5, 0.5)])
    faces = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 8, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 8, 5, 7, 6)]
    low = Block("low", points, faces)
    (interface,) = find_interfaces([low, box("high", (1, 1, 1), (0, 0, 1))], JOINT)
    corners = np.array([(0.5, -0.5), (0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5)])
    assert interface.polygon == pytest.approx(corners)


def test_triangles_in_one_plane_are_one_face():
    low = Block.box("low", (1, 1, 1), (0, 0, 0))
    triangles = [t for a, b, c, d in low.faces for t in ((a, b, c), (a, c, d))]
    interfaces = find_interfaces(
        [Block("low", low.vertices, triangles), box("high", (1, 1, 1), (0, 0, 1))], JOINT
    )
    assert [area(f) for f in interfaces] == pytest.approx([1.0])
    assert all(len(f.polygon) == 4 for f in interfaces)


def test_octagonal_contact_of_two_squares():
    turn = Rotation.from_rotvec([0, 0, np.pi / 4]).as_matrix()
    high = box("high", (1, 1, 1), (0, 0, 1)).moved(turn, (0, 0, 0))
    (interface,) = find_interfaces([box("low", (1, 1, 1), (0, 0, 0)), high], JOINT)
    assert interface.polygon.shape == (8, 2)
    assert area(interface) == pytest.approx(2 * (np.sqrt(2) - 1))  # regular octagon, inradius 1/2
    assert interface.axes == pytest.approx(np.eye(3))


def test_polygon_starts_after_its_longest_side():
    for interface in find_interfaces(voronoi_blocks(20, 7)[0], JOINT):
        points = interface.polygon
        sides = np.roll(points, -1, axis=0) - points
        lengths = np.linalg.norm(sides, axis=1)
        assert lengths.argmax() == len(points) - 1
        assert sides[-1] == pytest.approx([lengths[-1], 0])
        assert area(interface) == pytest.approx(ConvexHull(points).volume)
        assert polygon.centroids(points) == pytest.approx([0, 0])


def test_names_must_be_unique():
    blocks = [box(name, (1, 1, 1), (2 * k, 0, 0)) for k, name in enumerate("abacb")]
    with pytest.raises(ModelError, match=r"named 'a'.*named 'b'") as error:
        find_interfaces(blocks, JOINT)
    assert len(error.value.problems) == 2


@pytest.mark.parametrize("tolerance", [{"gap": 0.0}, {"gap": np.nan}, {"angle": -1.0}, {"angle": 1.0}])
def test_tolerances_must_make_sense(tolerance):
    ((name, value),) = tolerance.items()
    with pytest.raises(ModelError, match=f"{name} is {value!r}"):
        find_interfaces([], JOINT, **tolerance)

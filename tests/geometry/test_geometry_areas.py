"""Contacts of blocks that are not convex: areas divided into convex pieces, regions, facets, overlaps."""

from itertools import pairwise

import numpy as np
import pytest
import shapely
import shapely.affinity
from bodies import PLUS, SQUARE, L, U, extruded, hollow, joined, moved, regular, ring, triangulated
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from test_geometry_contact import voronoi_blocks

from limitblocks.geometry import Block, find_contacts, find_interfaces, polygon
from limitblocks.geometry.given_interfaces import interface_faults
from limitblocks.geometry.patches import common_areas
from limitblocks.geometry.regions import in_turn


def area(interface):
    return float(polygon.areas(interface.polygon))


def check_pieces(result, whole):
    """The interfaces are convex, do not overlap, and fill the plane area `whole` in X and Y."""
    assert interface_faults(result) == []
    flat = [shapely.Polygon(one.corners[:, :2]) for one in result]
    assert sum(piece.area for piece in flat) == pytest.approx(whole.area, rel=1e-6)
    assert shapely.union_all(flat).symmetric_difference(whole).area < 1e-6 * whole.area


def decks(outline, low="low", high="high"):
    return [extruded(low, outline, 0, 1), extruded(high, outline, 1, 2)]


@pytest.mark.parametrize(
    ("outline", "count"), [(L, 2), (U, 3), (PLUS, 3), (regular(7, 1.0), 1), (np.multiply(L, 1e-2), 2)]
)
def test_contact_of_two_prisms(outline, count):
    blocks = decks(outline)
    interfaces = find_interfaces(blocks, None)
    assert len(interfaces) == count  # the least number of convex pieces
    check_pieces(interfaces, shapely.Polygon(outline))
    assert all(one.axes[2] == pytest.approx([0, 0, 1]) for one in interfaces)


def test_contact_of_crossed_u_blocks_is_the_common_area():
    # the upper one turned by a quarter about the middle of the square of side 3
    low = extruded("low", U, 0, 1)
    turn = Rotation.from_rotvec([0, 0, np.pi / 2]).as_matrix()
    high = extruded("high", U, 1, 2).moved(turn, (3, 0, 0))
    common = shapely.Polygon(U) & shapely.affinity.translate(
        shapely.affinity.rotate(shapely.Polygon(U), 90, origin=(0, 0)), 3, 0
    )
    interfaces = find_interfaces([low, high], None)
    check_pieces(interfaces, common)


def test_feet_of_a_u_block_stand_apart():
    # legs of 1 x 1 upside down on a plane: two interfaces, and a bridge between them
    legs = np.array([(0, 0), (1, 0), (1, 1), (2, 1), (2, 0), (3, 0), (3, 2), (0, 2)], dtype=float)
    arch = extruded("arch", legs).moved(Rotation.from_rotvec([np.pi / 2, 0, 0]).as_matrix(), (0, 1, 0))
    ground = Block.box("ground", (5, 5, 1), (1.5, 0.5, -0.5))
    interfaces = find_interfaces([ground, arch], None)
    assert [area(one) for one in interfaces] == pytest.approx([1, 1])
    assert sorted(one.centroid.tolist() for one in interfaces) == pytest.approx(
        [pytest.approx([0.5, 0.5, 0]), pytest.approx([2.5, 0.5, 0])]
    )


@pytest.mark.parametrize("side", [1.0, 0.3])
def test_contact_round_a_hole(side):
    outer, inner = 2 * SQUARE, side * SQUARE + 0.1
    interfaces = find_interfaces([ring("low", outer, inner, 0, 1), ring("high", outer, inner, 1, 2)], None)
    assert len(interfaces) == 4
    check_pieces(interfaces, shapely.Polygon(outer, [inner]))


@pytest.mark.parametrize("n", [3, 5, 12, 40])
def test_contact_of_two_tubes(n):
    outer, inner = regular(n, 2.0), regular(n, 1.5)
    interfaces = find_interfaces([ring("low", outer, inner, 0, 1), ring("high", outer, inner, 1, 2)], None)
    assert len(interfaces) == n
    check_pieces(interfaces, shapely.Polygon(outer, [inner]))


@pytest.mark.parametrize("off", [-1e-9, -1e-12, 0.0, 1e-12, 1e-9])
@pytest.mark.parametrize(("along", "count"), [((1.0, 0.0), 2), ((1.0, 1.0), 2), ((1.0, 0.25), 4)])
def test_hole_that_meets_the_rim_but_for_rounding_divides_the_area(along, count, off):
    """Tubes of 2 m with walls of .4 m, one off the other by the thickness of a wall."""
    outer, inner, shift = 2 * SQUARE, 1.2 * SQUARE, (0.4 + off) * np.array(along)
    low, high = ring("low", outer, inner, 0, 1), ring("high", outer + shift, inner + shift, 1, 2)
    whole = shapely.Polygon(outer, [inner]) & shapely.Polygon(outer + shift, [inner + shift])
    interfaces = find_interfaces([low, high], None)
    assert len(interfaces) == count
    check_pieces(interfaces, whole)


def test_shaft_through_two_plates_touches_all_round():
    plate = ring("plate", 4 * SQUARE, SQUARE)
    shaft = Block.box("shaft", (1, 1, 3), (0, 0, 0))
    interfaces = find_interfaces([plate, shaft], None)
    assert [area(one) for one in interfaces] == pytest.approx([1] * 4)
    assert {tuple(np.round(one.axes[2]).tolist()) for one in interfaces} == {
        (1, 0, 0),
        (-1, 0, 0),
        (0, 1, 0),
        (0, -1, 0),
    }


def test_stone_in_a_cavity_touches_its_walls():
    interfaces = find_interfaces([hollow("hollow", 2.0, 1.0), Block.box("stone", (1, 1, 1), (0, 0, 0))], None)
    assert [area(one) for one in interfaces] == pytest.approx([1] * 6)


@pytest.mark.parametrize("n", [6, 24, 96])
def test_coaxial_cylinders_touch_facet_by_facet(n):
    core, sleeve = extruded("core", regular(n, 1.0)), ring("sleeve", regular(n, 2.0), regular(n, 1.0))
    for blocks in ([core, sleeve], [triangulated(core), triangulated(sleeve)]):
        interfaces = find_interfaces(blocks, None)
        assert len(interfaces) == n
        assert [area(one) for one in interfaces] == pytest.approx([2 * np.sin(np.pi / n)] * n)
        radial = [one.centroid[:2] / np.linalg.norm(one.centroid[:2]) for one in interfaces]
        assert [one.axes[2, :2] for one in interfaces] == [
            pytest.approx(normal, abs=1e-6) for normal in radial
        ]


@pytest.mark.parametrize("turn", [0.1, 0.6, 1.5])
def test_rectangles_turned_about_their_normal(turn):
    # bars of width a and b cross in a rhomboid of area a b / sin(turn)
    a, b, long = 0.3, 0.2, 20.0
    low = Block.box("low", (long, a, 1), (0, 0, 0))
    rotation = Rotation.from_rotvec([0, 0, turn]).as_matrix()
    high = Block.box("high", (long, b, 1), (0, 0, 1)).moved(rotation, (0, 0, 0))
    (interfaces,) = find_interfaces([low, high], None)
    assert area(interfaces) == pytest.approx(a * b / np.sin(turn))
    assert interfaces.centroid == pytest.approx([0, 0, 0.5], abs=1e-9)


def shapes_of(result):
    """Each interface as its corners in global axes, sorted, whichever block comes first."""
    return sorted(np.round(one.corners, 6)[np.lexsort(np.round(one.corners, 6).T)].tolist() for one in result)


NEST = [ring("b", 2 * SQUARE, SQUARE, 0, 1), *decks(L, "c", "a"), extruded("d", PLUS, -1, 0)]


@pytest.mark.parametrize("blocks", [decks(L), decks(U), decks(PLUS), decks(np.array(U) * (1, 1.3)), NEST[:1]])
@pytest.mark.parametrize("form", [lambda block: block, triangulated])
@settings(max_examples=8, deadline=None)
@given(seed=st.integers(0, 2**31), far=st.sampled_from([0.0, 5e5]))
def test_division_moves_with_the_blocks(blocks, form, seed, far):
    plate = extruded("plate", 9.0 * SQUARE, -1, 0)
    blocks = [plate, *map(form, blocks)]
    before = find_interfaces(blocks, None)
    after_blocks, rotation, translation = moved(blocks, seed, far)
    after = find_interfaces(after_blocks, None)
    assert [(i.block_i, i.block_j) for i in after] == [(i.block_i, i.block_j) for i in before]
    back = [(one.corners - translation) @ rotation for one in after]
    for old, new in zip(before, back, strict=True):
        distance = np.linalg.norm(old.corners[:, None] - new[None], axis=2)
        assert distance.min(axis=0).max() < 1e-8
        assert distance.min(axis=1).max() < 1e-8


@pytest.mark.parametrize("blocks", [decks(L), decks(U), decks(PLUS)])
def test_division_does_not_depend_on_the_order_of_the_blocks(blocks):
    assert shapes_of(find_interfaces(blocks, None)) == shapes_of(find_interfaces(blocks[::-1], None))


@pytest.mark.parametrize("outline", [L, U, PLUS, SQUARE])
def test_triangulated_blocks_have_the_same_interfaces(outline):
    blocks = decks(outline)
    expected = shapes_of(find_interfaces(blocks, None))
    for some in ([triangulated(blocks[0]), blocks[1]], [*map(triangulated, blocks)]):
        assert shapes_of(find_interfaces(some, None)) == expected


def test_noise_on_an_edge_does_not_divide_a_convex_area():
    # a square with corners along its sides, moved in and out by up to 0.2 mm
    corners = [*SQUARE, SQUARE[0]]
    points = np.concatenate([np.linspace(a, b, 6)[:-1] for a, b in pairwise(corners)])
    noise = np.random.default_rng(1).uniform(-2e-4, 2e-4, points.shape)
    low, high = extruded("low", points + noise), extruded("high", 2 * SQUARE, 1, 2)
    (interfaces,) = find_interfaces([low, high], None)
    assert interface_faults([interfaces]) == []
    assert area(interfaces) == pytest.approx(1.0, rel=1e-3)


def test_notch_larger_than_the_tolerance_divides_an_area():
    for depth, count in ((0.5e-3, 1), (0.05, 2)):
        notch = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (0, 0.5 - depth), (-0.5, 0.5)]
        interfaces = find_interfaces(decks(notch), None)
        assert len(interfaces) == count
        assert sum(map(area, interfaces)) == pytest.approx(1 - depth / 2, rel=1e-3)
        exact = find_interfaces(decks(notch), None, gap=1e-9)
        assert len(exact) == 2
        assert sum(map(area, exact)) == pytest.approx(1 - depth / 2, rel=1e-12)


@pytest.mark.parametrize("seed", range(5))
def test_star_shaped_areas_at_random(seed):
    rng = np.random.default_rng(seed)
    angle = np.sort(rng.uniform(0, 2 * np.pi, 15))
    outline = np.column_stack([np.cos(angle), np.sin(angle)]) * rng.uniform(0.4, 1.0, 15)[:, None]
    interfaces = find_interfaces(decks(outline), None)
    check_pieces(interfaces, shapely.Polygon(outline))
    sides = np.roll(outline, -1, axis=0) - outline
    (x, y), (u, v) = np.roll(sides, 1, axis=0).T, sides.T
    turns = x * v - y * u
    assert len(interfaces) <= 2 * (turns < 0).sum() + 1  # Hertel & Mehlhorn: two diagonals a reflex corner


@pytest.mark.parametrize("form", [lambda block: block, triangulated])
@pytest.mark.parametrize("seed", range(4))
def test_rubble_of_pairs_of_cells_that_fills_a_cube(seed, form):
    """Cells of a Voronoi diagram joined two by two: not convex, and they touch exactly, nowhere deeper."""
    cells, areas = voronoi_blocks(30, seed)
    group, expected = np.arange(30), {}
    for (i, j), size in areas.items():
        if (
            group[i] == i
            and group[j] == j
            and not {i, j} & set(group[group != np.arange(30)])
            and size > 0.02
        ):
            group[j] = i
    for (i, j), size in areas.items():
        ends = tuple(sorted({int(group[i]), int(group[j])}))
        if len(ends) == 2:
            expected[ends] = expected.get(ends, 0.0) + size
    blocks = [
        form(joined(str(k), *(cells[m] for m in np.flatnonzero(group == k))))
        for k in np.unique(group).tolist()
    ]
    assert sum(not block.convex for block in blocks) >= 5
    assert sum(block.volume for block in blocks) == pytest.approx(1.0)
    blocks, _, _ = moved(blocks, seed)
    contacts = find_contacts(blocks, None)
    assert contacts.overlaps == ()
    values = {}
    for one in [*contacts.interfaces, *contacts.slivers]:
        ends = tuple(sorted((int(one.block_i), int(one.block_j))))
        values[ends] = values.get(ends, 0.0) + (area(one) if one in contacts.interfaces else one.area)
    assert values.keys() <= expected.keys()
    for ends, size in expected.items():
        assert values.get(ends, 0.0) == pytest.approx(size, rel=1e-4, abs=1e-6)


def test_polygons_that_share_a_side_have_no_common_area():
    # GEOS 3.14 gives the whole triangle
    triangle = """POLYGON ((-0.0335973787803959 -0.0606061820642776, 0.0671947575607918 0.0303034554064244,
    -0.0335973787803959 0.0303027266578531, -0.0335973787803959 -0.0606061820642776))"""
    other = """POLYGON ((-0.0335973787803959 -0.1515150907864083, -0.0335973787803959 -0.0606061820642776,
    0.0671947575607918 0.0303034554064244, 0.0668499922401276 -0.0606069083259443,
    -0.0335973787803959 -0.1515150907864083))"""
    pair = [np.array([shapely.from_wkt(" ".join(text.split()))]) for text in (triangle, other)]
    assert shapely.touches(*pair).all()
    assert shapely.area(common_areas(*pair, np.array([1e-9]), 1e-9)) == pytest.approx([0.0], abs=1e-9)


def test_neighbours_across_a_joint_of_a_dome_share_a_side_only():
    # GEOS 3.14 gives the whole of the second, whatever the order of the corners
    first = [(-0.3424974772438826, -0.007856525651676051), (-0.17806930397618018, -0.2919607224540524)]
    first += [(0.35299289255884225, -0.010277784782518175), (0.1675738886612196, 0.31009503288824664)]
    other = [(0.16757388866121956, 0.31009503288824664), (-0.3424974772438826, -0.007856525651676051)]
    other += [(-0.5263916124877991, 0.26411361822688467), (-0.03979609363511195, 0.6167847696023684)]
    pair = [np.array([shapely.Polygon(corners)]) for corners in (first, other)]
    assert shapely.area(common_areas(*pair, np.array([1e-9]), 1e-9)) == pytest.approx([0.0], abs=1e-9)


def test_polygons_that_rounding_errors_tell_apart_share_all():
    # GEOS 3.14 gives points alone, whatever the order of the corners
    first = [(0.2232847149593827, 0.9747532693279398), (-0.5056467476711092, -0.8627406137244437)]
    first += [(-0.1278292018801929, -0.991796196376389), (0.156509730351191, -0.9876764168012707)]
    first += [(0.4820043055643253, -0.876168847550204), (0.9990661420406534, -0.0432069881848416)]
    other = [first[5], (first[0][0], 0.9747532693279397), first[1], (-0.127829201880193, -0.9917961963763889)]
    other += [(0.1565097303511908, -0.9876764168012707), (0.4820043055643253, -0.8761688475502039)]
    pair = [np.array([shapely.Polygon(corners)]) for corners in (first, other)]
    for one, two in (pair, pair[::-1]):
        found = common_areas(one, two, np.array([1e-9]), 1e-9)
        np.testing.assert_allclose(shapely.area(found), polygon.areas(np.array([first])), rtol=1e-8)


def wavy(name, low, high, n=12):
    """Column of unit width between two surfaces Z = low(X, Y) and high(X, Y), in triangles."""
    x, y = (grid.ravel() for grid in np.meshgrid(*[np.linspace(0, 1, n)] * 2, indexing="ij"))
    points = np.concatenate([np.column_stack([x, y, z(x, y)]) for z in (low, high)])
    place = np.arange(n * n).reshape(n, n)
    a, b, c, d = (place[i : n - 1 + i, j : n - 1 + j].ravel() for i, j in ((0, 0), (1, 0), (1, 1), (0, 1)))
    rim = np.concatenate([place[:, 0], place[-1, 1:], place[-2::-1, -1], place[0, -2:0:-1]])
    on = np.roll(rim, -1)
    up = n * n
    sides = [(a, c, b), (a, d, c), (up + a, up + b, up + c), (up + a, up + c, up + d)]
    sides += [(rim, on, up + on), (rim, up + on, up + rim)]
    return Block(name, points, np.concatenate([np.column_stack(each) for each in sides]).tolist())


@pytest.mark.parametrize("seed", [None, 1, 2])
def test_curved_surfaces_in_small_triangles_touch_all_over(seed):
    """Some triangles count as one face on one side, and on the other not: no area is lost or counts twice."""

    def wave(x, y):
        return 0.5 + 0.1 * np.sin(5 * x) * np.cos(4 * y)

    blocks = [wavy("low", lambda x, y: 0 * x, wave), wavy("high", wave, lambda x, y: 0 * x + 1)]
    top = [k for k, face in enumerate(blocks[0].faces) if min(face) >= 144]
    if seed is not None:
        blocks, _, _ = moved(blocks, seed, 1e5)
    contacts = find_contacts(blocks, None)
    assert sum(map(area, contacts.interfaces)) == pytest.approx(blocks[0].areas[top].sum(), rel=1e-4)
    assert contacts.overlaps == ()


def test_chamfer_is_no_part_of_the_face_beside_it():
    # 1 mm at 45 degrees off a block of 1 m: within the planarity tolerance of the top
    leg = 1e-3
    outline = [(0, 0), (1, 0), (1, 1 - leg), (1 - leg, 1), (0, 1)]
    turn = Rotation.from_rotvec([np.pi / 2, 0, 0]).as_matrix()
    low = extruded("low", outline).moved(turn, (0, 1, 0))
    high = Block.box("high", (1, 1, 1), (0.5, 0.5, 1.5))
    (interfaces,) = find_interfaces([low, high], None)
    assert area(interfaces) == pytest.approx(1 - leg)


def test_half_edges_around_regions_are_put_in_turn():
    """A square is a ring; a frame with a hole, and triangles that meet at a vertex, are none."""
    square = [(3, 0), (1, 2), (0, 1), (2, 3)]
    frame = [(0, 1), (1, 2), (2, 0), (5, 4), (4, 3), (3, 5)]
    touching = [(0, 1), (1, 2), (2, 0), (2, 3), (3, 4), (4, 2)]
    start, end = np.array(square + frame + touching).T
    own = np.repeat([0, 1, 2], [4, 6, 6])
    sides = np.bincount(own)
    ring, turn = in_turn(own, np.cumsum(sides) - sides, sides, start, end)
    assert ring.tolist() == [True, False, False]
    assert [(start[k], end[k]) for k in turn[:4]] == [(3, 0), (0, 1), (1, 2), (2, 3)]
    assert turn[4:].tolist() == list(range(4, 16))

"""Pressure on faces: hydrostatics in closed form."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import limitblocks as lb

WATER = 9.81e3
WALL = lb.Block.box("wall", (1.0, 3.0, 2.0), (0.5, 0.0, 1.0), 20e3)
# a wedge with one face that slopes, and an odd tetrahedron
WEDGE = lb.Block.prism("wedge", [(0, 0), (2, 0), (0, 1)], (0, 3), 1.0)
TETRAHEDRON = lb.Block(
    "tetra",
    [(0, 0, 0), (1, 0.1, 0), (0.2, 1.3, 0), (0.3, 0.4, 0.9)],
    [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)],
)
BODIES = {block.name: block for block in (WALL, WEDGE, TETRAHEDRON)}


def inside(block, face):
    """A point inside a face."""
    return block.vertices[list(block.faces[face])].mean(axis=0)


def on_all_faces(block, **pressure):
    loads = (lb.loads.pressure(block.name, at=inside(block, k), **pressure) for k in range(len(block.faces)))
    return sum(loads, lb.loads.Load()).on([block])[0]


@pytest.mark.parametrize("block", BODIES.values(), ids=BODIES)
@given(st.integers(0, 1000))
def test_uniform_pressure_all_round_is_in_equilibrium(block, seed):
    turn = Rotation.random(random_state=seed).as_matrix()
    moved = block.moved(turn, np.random.default_rng(seed).normal(size=3) * 50)
    load = on_all_faces(moved, pressure=1e3)
    assert load == pytest.approx(np.zeros(6), abs=1e-8 * 1e3)


@pytest.mark.parametrize("block", BODIES.values(), ids=BODIES)
@given(st.integers(0, 1000))
def test_submerged_block_is_lifted_by_the_weight_of_water_at_its_centroid(block, seed):
    """Archimedes."""
    moved = block.moved(Rotation.random(random_state=seed).as_matrix(), (3.0, -2.0, 7.0))
    load = on_all_faces(moved, unit_weight=WATER, level=20.0)
    buoyancy = [0, 0, WATER * block.volume, 0, 0, 0]
    assert load == pytest.approx(np.array(buoyancy), abs=1e-8 * WATER * block.size**3)


def test_floating_block_is_lifted_by_the_weight_of_the_water_it_displaces():
    """Up to half its height: faces above the water get nothing, those through it a part."""
    sides = [
        lb.loads.pressure("wall", facing=d, unit_weight=WATER, level=0.5) for d in ((1, 0, 0), (-1, 0, 0))
    ]
    sides += [
        lb.loads.pressure("wall", facing=d, unit_weight=WATER, level=0.5) for d in ((0, 1, 0), (0, -1, 0))
    ]
    below = lb.loads.pressure("wall", facing=(0, 0, -1), unit_weight=WATER, level=0.5)
    load = sum(sides, below).on([WALL])[0]
    assert load == pytest.approx(np.array([0, 0, WATER * 3.0 * 0.5, 0, 0, 0]), abs=1e-9)


@pytest.mark.parametrize("depth", [0.3, 1.2, 2.0, 5.0])
def test_water_against_a_wall(depth):
    """Resultant gamma d^2 / 2 per m at d / 3 above the ground; a trapezium where it stands above the wall."""
    load = lb.loads.pressure("wall", facing=(-1, 0, 0), unit_weight=WATER, level=depth).on([WALL])[0]
    wet = min(depth, 2.0)
    deep, high = depth, depth - wet
    total = 3.0 * WATER * (deep + high) / 2 * wet
    height = wet / 3 * (deep + 2 * high) / (deep + high)
    assert load == pytest.approx(np.array([total, 0, 0, 0, total * (height - 1.0), 0]), rel=1e-12, abs=1e-9)


def test_water_on_a_slope_is_thrust_of_its_projection_and_weight_above():
    level = 1.5
    load = lb.loads.pressure("wedge", facing=(1, 0, 2), unit_weight=WATER, level=level).on([WEDGE])[0]
    thrust = 3.0 * WATER * (level**2 - 0.5**2) / 2
    weight = 3.0 * WATER * 2.0 * (level + 0.5) / 2
    assert load[:3] == pytest.approx([-thrust, 0, -weight])
    # virtual work of a rotation about Y through the toe (2, y, 0): the lever along the slope
    s = np.polynomial.legendre.leggauss(4)
    p = [WATER * (level - z) for z in (0.5 + 0.5 * s[0])]  # s from the toe up
    along = np.sqrt(5.0) / 2.0
    moment = -3.0 * along * float(s[1] @ (p * (along + along * s[0])))
    arm = WEDGE.centroid - (2.0, 1.5, 0.0)
    assert (load[3:] + np.cross(arm, load[:3]))[1] == pytest.approx(moment)


@pytest.mark.parametrize(
    ("friction", "formula"),
    [
        (5.0, 20e3 * 1.0 * 2.0 * 0.5 / (WATER * 2.0**3 / 6)),  # overturning: W b / 2 over gamma h^3 / 6
        (0.3, 0.3 * 20e3 * 1.0 * 2.0 / (WATER * 2.0**2 / 2)),  # sliding: mu W over gamma h^2 / 2
    ],
)
@pytest.mark.parametrize("joint_type", [lb.OrdunaLourenco, lb.PointContact])
def test_retaining_wall(joint_type, friction, formula):
    ground = lb.Block.box("ground", (4, 4, 0.2), (0, 0, -0.1))
    blocks = [ground, WALL]
    live = lb.loads.pressure("wall", facing=(-1, 0, 0), unit_weight=WATER, level=2.0)
    interfaces = lb.find_interfaces(blocks, joint_type(friction))
    model = lb.Model(blocks, ["ground"], interfaces, lb.self_weight(), live)
    assert lb.bounds(model).lower == pytest.approx(formula, rel=1e-6)


def test_pressure_on_courses_is_that_on_the_wall():
    courses = [lb.Block.box(f"course {k}", (1, 3, 0.5), (0.5, 0, 0.25 + k / 2), 20e3) for k in range(4)]
    names = [course.name for course in courses]
    level = 1.3  # the top course stays dry
    parts = lb.loads.pressure(names, 200.0, facing=(-1, 0, 0), unit_weight=WATER, level=level).on(courses)
    whole = lb.loads.pressure("wall", 200.0, facing=(-1, 0, 0), unit_weight=WATER, level=level).on([WALL])[0]
    arms = np.stack([course.centroid - WALL.centroid for course in courses])
    moment = (parts[:, 3:] + np.cross(arms, parts[:, :3])).sum(axis=0)
    assert np.concatenate([parts[:, :3].sum(axis=0), moment]) == pytest.approx(whole)


def test_point_on_a_face_of_a_block_that_is_not_convex():
    """An L of 2 m x 2 m in x and z, 1 m thick everywhere; a force of 1 N on each square metre."""
    corner = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
    block = lb.Block.prism("L", corner, (0.0, 3.0), 20e3)
    middles = {  # of faces of 1 m x 3 m
        (2.0, 1.5, 0.5): (-3.0, 0.0, 0.0),
        (1.0, 1.5, 1.5): (-3.0, 0.0, 0.0),
        (1.5, 1.5, 1.0): (0.0, 0.0, -3.0),
    }
    for middle, force in middles.items():
        load = lb.loads.pressure("L", 1.0, at=np.add(middle, (0.0, 0.3, 0.0))).on([block])[0]
        assert load[:3] == pytest.approx(np.array(force))
        assert load[3:] == pytest.approx(np.cross(middle - block.centroid, force))
    end = lb.loads.pressure("L", 1.0, at=(0.5, 0.0, 1.5)).on([block])[0]
    assert end == pytest.approx(np.array([0.0, 3.0, 0.0, 0.0, 0.0, 0.0]))
    with pytest.raises(lb.ModelError, match="on no face"):
        lb.loads.pressure("L", 1.0, at=(1.0, 1.0, 0.5)).on([block])  # in the plane of a face, in the block


def with_a_window(off):
    """A wall of 4 m x 2 m, .5 m thick, with a window of 2 m x 1 m; one corner is `off` by as much in y."""
    around = [(-2, 0), (2, 0), (2, 2), (-2, 2)], [(-1, 0.5), (1, 0.5), (1, 1.5), (-1, 1.5)]
    vertices = np.array([(x, y, z) for y in (0.0, 0.5) for ring in around for x, z in ring])
    vertices[3, 1] += off
    faces = []
    for k, n in ((0, 1), (1, 2), (2, 3), (3, 0)):
        faces += [(k, n, 4 + n, 4 + k), (8 + n, 8 + k, 12 + k, 12 + n)]  # front and back, in four parts
        faces += [(n, k, 8 + k, 8 + n), (4 + k, 4 + n, 12 + n, 12 + k)]
    return lb.Block("wall", vertices, faces, 20e3)


@pytest.mark.parametrize("off", [0.0, 1e-4])
@pytest.mark.parametrize("where", [{"facing": (0, -1, 0)}, {"at": (-1.5, 0.0, 1.0)}], ids=["facing", "at"])
def test_faces_in_one_plane_around_a_window_are_one(where, off):
    wall = with_a_window(off)
    load = lb.loads.pressure("wall", 1e3, **where).on([wall])[0]
    assert load == pytest.approx(np.array([0, 6e3, 0, 0, 0, 0]), abs=6e3 * (1e-9 + 4 * off))
    water = lb.loads.pressure("wall", unit_weight=WATER, level=1.0, **where).on([wall])[0]
    force, moment = (
        4.0 * 1.0**k / k - 2.0 * 0.5**k / k for k in (2, 3)
    )  # of depth and its square, by height
    expected = WATER * np.array([0.0, force, 0.0, moment, 0.0, 0.0])
    assert water == pytest.approx(expected, abs=WATER * (1e-9 + 8 * off))


def twisted(off):
    """A cube of 1 m, its corner at (0, 1, 1) moved out by `off`; three faces are two triangles each."""
    box = lb.Block.box("wall", (1, 1, 1), (0.5, 0.5, 0.5))
    vertices = np.array(sorted(box.vertices.tolist()))  # number 4 x + 2 y + z
    vertices[3, 0] -= off
    faces = [(0, 4, 5, 1), (4, 6, 7, 5), (0, 2, 6, 4)]
    faces += [(0, 1, 3), (0, 3, 2), (1, 5, 7), (1, 7, 3), (2, 3, 7), (2, 7, 6)]
    return lb.Block("wall", vertices, faces, 20e3)


@pytest.mark.parametrize("off", [1e-3, 5e-3, 0.03])
@pytest.mark.parametrize(
    "where",
    [{"facing": (-1, 0, 0)}, {"facing": (-1, 0.01, 0)}, {"at": (0, 0.2, 0.8)}, {"at": (0, 0.8, 0.2)}],
    ids=["facing", "facing one more", "at the upper part", "at the lower part"],
)
def test_a_twisted_face_in_two_triangles_is_one(where, off):
    """Its area seen along x is 1 m2, whatever the corner does."""
    if "at" in where:  # on the triangle: x grows to -off at the corner, from the two sides that it is not on
        where = {"at": (-off * min(where["at"][1:]), *where["at"][1:])}
    load = lb.loads.pressure("wall", 1e3, **where).on([twisted(off)])[0]
    assert load[0] == pytest.approx(1e3, rel=1e-12)


def test_a_facet_of_what_looks_towards_a_direction_is_not_the_face():
    """Two triangles at 8 degrees: each is half of the face, seen along the direction (-1, .01, 0)."""
    said = "'wall': the face closest to direction .* has 0.5 of the 0.999 m2 that look within 45 degrees"
    with pytest.raises(lb.ModelError, match=said):
        lb.loads.pressure("wall", 1e3, facing=(-1, 0.01, 0)).on([twisted(0.1)])
    part = lb.loads.pressure("wall", 1e3, at=(-0.1 * 0.2, 0.2, 0.8)).on([twisted(0.1)])[0]
    assert part[0] == pytest.approx(500.0)


def test_pressure_that_grows_upwards_is_a_difference():
    uniform = lb.loads.pressure("wall", WATER * 2.0, facing=(-1, 0, 0))
    load = (uniform + (-1) * lb.loads.pressure("wall", facing=(-1, 0, 0), unit_weight=WATER, level=2.0)).on(
        [WALL]
    )[0]
    total = 3.0 * WATER * 2.0
    assert load == pytest.approx(np.array([total, 0, 0, 0, total * (4 / 3 - 1.0), 0]))


@pytest.mark.parametrize(
    ("load", "said"),
    [
        (lambda: lb.loads.pressure("wal", 1.0, facing=(1, 0, 0)), "'wal'"),
        (lambda: lb.loads.pressure("wedge", 1.0, facing=(1, 0, -0.5)), "no face towards"),
        (lambda: lb.loads.pressure("wall", 1.0, facing=(1, 0.99, 0.98)), "closest is 54 degrees off"),
        (lambda: lb.loads.pressure("wall", 1.0, facing=(1, 1, 0)), "equally close"),
        (lambda: lb.loads.pressure("wall", 1.0, facing=(0, 0, 0)), "non-zero"),
        (lambda: lb.loads.pressure("wall", 1.0, at=(0.5, 0, 1.0)), "on no face"),
        (lambda: lb.loads.pressure("wall", 1.0, at=(0.0, 0, 2.5)), "on no face"),
        (lambda: lb.loads.pressure("wall", 1.0, at=(0.0, 0, 2.0)), "on an edge"),
        (lambda: lb.loads.pressure("wall", 1.0), "direction"),
        (lambda: lb.loads.pressure("wall", 1.0, facing=(1, 0, 0), at=(0, 0, 1)), "either"),
        (lambda: lb.loads.pressure(["wall", "wedge"], 1.0, at=(0, 0, 1)), "one point"),
        (lambda: lb.loads.pressure(["wall", "wall"], 1.0, facing=(1, 0, 0)), "twice"),
        (lambda: lb.loads.pressure([], 1.0, facing=(1, 0, 0)), "no block"),
        (lambda: lb.loads.pressure("wall", facing=(1, 0, 0)), "zero"),
        (lambda: lb.loads.pressure("wall", facing=(1, 0, 0), unit_weight=1.0), "without a level"),
        (lambda: lb.loads.pressure("wall", 1.0, facing=(1, 0, 0), level=1.0), "without a unit weight"),
        (
            lambda: lb.loads.pressure("wall", facing=(1, 0, 0), unit_weight=-1.0, level=1.0),
            "unit weight is -1.0",
        ),
        (lambda: lb.loads.pressure("wall", facing=(1, 0, 0), unit_weight=1.0, level=0.0), "below every face"),
        (lambda: lb.loads.pressure("wall", facing=(1, 0, 0), unit_weight=1.0, level=np.nan), "level is nan"),
        (lambda: lb.loads.pressure("wall", np.inf, facing=(1, 0, 0)), "pressure is inf"),
        (lambda: lb.loads.pressure("wall", "much", facing=(1, 0, 0)), "'much'"),
    ],
)
def test_wrong_pressure_is_refused(load, said):
    with pytest.raises(lb.ModelError, match=said) as caught:
        load().on(list(BODIES.values()))
    assert "\n" not in str(caught.value)

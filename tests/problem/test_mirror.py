"""Structures and loads with a mirror plane across which blocks come in pairs: one half is solved.

Sources: docs/planar.md, "One half"; closed forms in the tests. Bounds are proven intervals: with and without
the mirror they hold the same number.
"""

from dataclasses import replace
from unittest import mock

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import sparse
from scipy.spatial.transform import Rotation
from stones import model_of

import limitblocks as lb
from limitblocks import structures
from limitblocks.analysis.in_plane import in_plane
from limitblocks.analysis.stability import standing_margin
from limitblocks.problem import State
from limitblocks.problem.plane import Choice, mirror_of, reduced
from limitblocks.problem.plane.rounding import pseudo_inverses

JOINTS = {
    "points": lb.PointContact(0.6),
    "polygons at points": lb.PointContact(0.6, cone="inner"),
    "octagon": lb.OrdunaLourenco(0.6, slip="paper"),
    "circle": lb.OrdunaLourenco(0.6),
    "crushing": lb.OrdunaLourenco(0.6, compressive_strength=2e5),
    "cohesion": lb.OrdunaLourenco(0.6, cohesion=1e3, tensile_strength=5e2),
}


def facade(joint, **changes):
    size = {"length": 3.2, "courses": 3, "return_length": 1.6, "openings": ()}
    return structures.facade(joint, **(size | changes))


def tower(joint):
    return structures.tower(joint, length=2.4, width=2.4, courses=2)


def dome(joint):
    return structures.dome(joint, radius=3.0, thickness=0.5, courses=4, stones=8, running_bond=False)


def wall_pushed_out(joint):
    return structures.wall(joint, length=1.6, courses=3, direction=(0.0, 1.0, 0.0))


STRUCTURES = (facade, tower, dome, wall_pushed_out)
SYMMETRIC = [(build, name) for build in (facade, wall_pushed_out) for name in JOINTS]
SYMMETRIC += [
    (tower, "points"),
    (tower, "octagon"),
    *((dome, name) for name in ("points", "octagon", "circle")),
]


def without_mirror(analysis, model):
    with mock.patch("limitblocks.analysis.in_plane.mirror_of", return_value=None):
        return analysis(replace(model))


def same(one, other):
    """Whether two pairs of proven bounds are of one number, and narrow."""
    assert one.proven
    assert other.proven
    assert max(one.proof.width, other.proof.width) <= 1e-6
    return max(one.lower, other.lower) <= min(one.upper, other.upper)


@pytest.mark.parametrize(("build", "name"), SYMMETRIC)
def test_one_half_has_the_bounds_of_the_whole(build, name):
    model = build(JOINTS[name])
    half, whole = lb.bounds(model), without_mirror(lb.bounds, model)
    plane = in_plane(model.problem)
    assert not plane.flat
    assert len(plane.blocks) < 0.7 * len(model.free_blocks)
    assert half.solvers[0].endswith("in one half")
    assert "half" not in whole.solvers[0]
    assert same(half, whole)


FAR = (3e3, -2e3, 1e2)  # m: coordinates of a block are rounded to 5e-13 of its size


@settings(max_examples=3)
@given(st.integers(0, 10**6), st.sampled_from(["points", "octagon"]))
def test_a_plane_of_any_direction_is_found(seed, name):
    joint, matrix = JOINTS[name], Rotation.random(random_state=seed).as_matrix()
    straight = facade(joint)
    blocks = [block.moved(matrix, FAR) for block in straight.blocks]
    interfaces = [
        replace(i, centroid=matrix @ i.centroid + FAR, axes=i.axes @ matrix.T) for i in straight.interfaces
    ]
    down, push = (lb.mass_proportional(direction=matrix @ axis) for axis in ((0, 0, -1), (0, -1, 0)))
    turned = lb.Model(blocks, straight.supports, interfaces, down, push)
    assert in_plane(turned.problem).problem.C.shape == in_plane(straight.problem).problem.C.shape
    a, b = lb.bounds(straight), lb.bounds(turned)
    assert b.solvers[0].endswith("in one half")
    assert b.lower == pytest.approx(a.lower, rel=1e-7)


def pair_of_columns(joint, gap=0.0):
    """Two columns 0.5 m x 1 m x 2 m on both sides of x = 0, pushed along y."""
    stones = [lb.Block.box("ground", (4, 2, 1), (0, 0, -0.5))]
    for name, side in (("left", -1.0), ("right", 1.0)):
        at = (side * (0.25 + gap / 2), 0.0, 1.0)
        stones.append(lb.Block.box(name, (0.5, 1.0, 2.0), at, unit_weight=2e4))
    return model_of(stones, ["ground"], joint, (0.0, 1.0, 0.0))


@pytest.mark.parametrize("name", ["points", "octagon", "circle"])
def test_the_joint_of_a_pair_lies_in_the_plane_and_has_no_shear(name):
    """Two columns side by side rock at b / h, Housner (1963)."""
    model = pair_of_columns(JOINTS[name])
    assert len(in_plane(model.problem).blocks) == 1
    bounds = lb.bounds(model)
    assert bounds.solvers[0].endswith("in one half")
    assert bounds.lower == pytest.approx(0.5, rel=1e-7)
    joint = [k for k, i in enumerate(model.interfaces) if "ground" not in (i.block_i, i.block_j)]
    assert np.abs(bounds.stress_resultants[joint][0, :2]).max() <= 1e-9 * model.free_blocks[0].weight


@pytest.mark.parametrize("build", STRUCTURES, ids=lambda build: build.__name__)
def test_lifted_states_are_symmetric_and_say_the_same(build):
    problem = build(JOINTS["points"]).problem
    mirror, rng = mirror_of(problem), np.random.default_rng(0)
    for choice in Choice:
        plane = reduced(problem, mirror, choice)
        small = plane.problem
        x, y = rng.standard_normal(small.C.shape[0]), rng.random(len(small.g))
        u = plane.averaged(plane.lifted(State(1.0, x, rng.standard_normal(small.C.shape[1]), y))).u
        y[small.cones.heads] += small.cones.norm(y)
        up = plane.lifted(State(1.0, x, u, y))
        assert up.x @ (problem.C @ up.u) == pytest.approx(x @ (small.C @ u))
        assert up.y @ (problem.F @ up.x + problem.g) == pytest.approx(y @ (small.F @ x + small.g))
        assert problem.dead @ up.u == pytest.approx(small.dead @ u)
        assert problem.cones.margin(up.y).min() >= -1e-12
        # forces and strains of symmetric states are symmetric
        force, strain = problem.C.T @ up.x, problem.C @ up.u + problem.F.T @ up.y
        rates = up.u.reshape(-1, 6)
        assert np.allclose(rates[mirror.image], rates @ mirror.rates.T)
        assert np.allclose(force.reshape(-1, 6)[mirror.image], force.reshape(-1, 6) @ mirror.rates.T)
        assert np.allclose(plane.stresses @ plane.stresses_of(strain), strain)
        again = plane.averaged(up)
        assert all(np.allclose(*pair) for pair in ((again.x, x), (again.u, u), (again.y, y)))


def test_faces_of_a_groove_mirror_each_other_not_themselves():
    """Shear across the slip locks on polygons, so that the halves of a groove are no planes of their own."""
    groove = structures.wedge(JOINTS["octagon"], half_angle=np.pi / 4)
    assert not in_plane(groove.problem).flat
    assert len(in_plane(groove.problem).problem.interfaces) == 1
    assert same(lb.bounds(groove), without_mirror(lb.bounds, groove))


def test_loads_that_cancel_but_for_rounding_point_nowhere():
    """Columns pressed together and bent apart: .1 + .2 - .1 - .2 is 6e-17, which is no resultant along X."""
    stones, forces = [lb.Block.box("ground", (4, 2, 1), (0, 0, -0.5))], []
    for name, side in (("left", -1.0), ("right", 1.0)):
        for level, (along, across) in enumerate([(0.1, 0.5), (0.2, -0.5)]):
            at = (0.25 * side, 0.0, 0.5 + level)
            stones.append(lb.Block.box(f"{name} {level}", (0.5, 1.0, 1.0), at, unit_weight=2e4))
            forces.append(lb.loads.force(stones[-1].name, (-side * along, across, 0.0), at))
    found = lb.find_interfaces(stones, JOINTS["points"])
    problem = lb.Model(stones, ["ground"], found, lb.self_weight(), sum(forces[1:], forces[0])).problem
    assert 0.0 < abs(problem.live.reshape(-1, 6)[:, 0].sum()) < 1e-15 * np.abs(problem.live).sum()
    assert len(in_plane(problem).blocks) == 2


def test_forces_that_nearly_cancel_point_somewhere():
    """Stones at the corners of a square, pushed apart along one diagonal by forces that differ by 1e-5."""
    stones = [lb.Block.box("ground", (6, 6, 1), (0, 0, -0.5))]
    pushes = {(1, 1): (1.0, 1.0), (-1, -1): (-1.0 + 1e-5, -1.0 + 1e-5), (1, -1): (1, -1), (-1, 1): (-1, 1)}
    for k, at in enumerate(pushes):
        stones.append(lb.Block.box(f"stone {k}", (1.0, 1.0, 1.0), (*at, 0.5), unit_weight=2e4))
    forces = [
        lb.loads.force(f"stone {k}", (1e4 * along[0], 1e4 * along[1], 0.0), (*at, 0.5))
        for k, (at, along) in enumerate(pushes.items())
    ]
    found = lb.find_interfaces(stones, JOINTS["points"])
    problem = lb.Model(stones, ["ground"], found, lb.self_weight(), sum(forces[1:], forces[0])).problem
    assert len(in_plane(problem).blocks) == 3


def test_what_is_not_symmetric_is_not_halved():
    for name in ("points", "octagon"):
        model = facade(JOINTS[name])
        top = model.free_blocks[-1]
        assert in_plane(model.problem) is not None
        aside = lb.loads.force(top.name, (0.0, 1e-9 * top.weight, 0.0), top.centroid)
        assert in_plane(replace(model, live=model.live + aside).problem) is None
        assert in_plane(replace(model, dead=model.dead + aside).problem) is None
        for off in (1e-9, 0.0):
            blocks = [b.moved(np.eye(3), (0.0, 0.0, off)) if b is top else b for b in model.blocks]
            assert (in_plane(replace(model, blocks=blocks).problem) is None) is (off > 0.0)
        across = lb.mass_proportional(direction=(1e-9, -1.0, 0.0))
        assert in_plane(replace(model, live=across).problem) is None
        joint = lb.OrdunaLourenco(0.61, slip="paper")
        other = [replace(i, joint=joint) if k == 0 else i for k, i in enumerate(model.interfaces)]
        assert in_plane(replace(model, interfaces=other).problem) is None
        assert in_plane(structures.facade(JOINTS[name]).problem) is None  # a door and a window
        assert in_plane(facade(JOINTS[name], direction=(1.0, 0.0, 0.0)).problem) is None
        assert in_plane(facade(JOINTS[name], direction=(1.0, 1.0, 0.0)).problem) is None


@pytest.mark.parametrize("name", ["points", "octagon", "circle"])
def test_columns_of_one_shape_are_no_images_if_one_is_heavier(name):
    """Measured by their own weights their numbers are the same: it is the units that tell them apart."""
    outline = [(-0.3, 0.0), (0.4, 0.0), (0.2, 1.0), (-0.3, 1.0)]
    for share, symmetric in ((1.0, True), (2.0, False)):
        stones = [
            lb.Block.box("ground", (8, 3, 0.5), (0, 0, -0.25)),
            lb.Block.prism("left", [(x - 2, z) for x, z in outline], (-0.4, 0.5), 20e3),
            lb.Block.prism("right", [(2 - x, z) for x, z in outline], (-0.4, 0.5), share * 20e3),
        ]
        pushed = lb.mass_proportional((0.0, 1.0, 0.0))
        model = replace(model_of(stones, ["ground"], JOINTS[name]), live=pushed)
        assert (mirror_of(model.problem) is not None) is symmetric


def test_octagons_askew_are_not_halved_but_mirrored_ones_are():
    """Turned by 10 degrees all in one sense they are not images of each other; in both senses they are."""
    model = pair_of_columns(JOINTS["octagon"], gap=0.5)
    for senses, symmetric in (((1.0, 1.0), False), ((1.0, -1.0), True)):
        joints = []
        for sense, i in zip(senses, model.interfaces, strict=True):
            c, s = np.cos(np.radians(10.0)), sense * np.sin(np.radians(10.0))
            turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
            joints.append(replace(i, axes=turn @ i.axes, polygon=i.polygon @ turn[:2, :2].T))
        plane = in_plane(replace(model, interfaces=joints).problem)
        assert (plane is not None) is symmetric


def test_a_mirror_is_sought_once():
    """By the bounds, the analysis and its backward error alike."""
    problem = structures.EXAMPLES["dome"](lb.PointContact(0.6)).problem
    assert mirror_of(problem) is mirror_of(problem) is not None


def test_a_wrong_half_costs_time_and_no_more():
    """Proven in the whole problem, or the whole one is solved: also where the loads are not symmetric."""
    model = facade(JOINTS["points"])
    plane, right = in_plane(model.problem), lb.bounds(model)
    wrong = [replace(plane, stresses=1.01 * plane.stresses)]
    wrong += [replace(plane, rates=sparse.csr_array(1.01 * plane.rates))]
    wrong += [replace(plane, problem=replace(plane.problem, F=1.1 * plane.problem.F))]
    wrong += [replace(plane, problem=replace(plane.problem, C=sparse.csr_array(0.9 * plane.problem.C)))]
    for one in wrong:
        with mock.patch("limitblocks.analysis.in_plane.reduced", return_value=one):
            assert same(lb.bounds(replace(model)), right)
    top = model.free_blocks[-1]
    aside = lb.loads.force(top.name, (0.3 * top.weight, 0.0, 0.0), top.centroid)
    lopsided = replace(model, live=model.live + aside)
    truth = lb.bounds(lopsided)
    mirror = mirror_of(model.problem)
    with mock.patch("limitblocks.analysis.in_plane.mirror_of", return_value=mirror):
        found = lb.bounds(replace(lopsided))
    assert "half" not in found.solvers[0]
    assert same(found, truth)


@pytest.mark.parametrize("name", ["points", "octagon"])
def test_how_safely_the_dead_loads_stand_is_the_same(name):
    """The mean of a state and its mirror image has at least their margin."""
    model = facade(JOINTS[name])
    assert standing_margin(model) == pytest.approx(without_mirror(standing_margin, model), rel=1e-5)


def test_units_of_the_halves_may_differ():
    """Measured by other forces on one side the lifted state is the same one."""
    problem = facade(JOINTS["points"]).problem
    plane, rng = reduced(problem, mirror_of(problem)), np.random.default_rng(1)
    whole = problem.measured(problem.units.block_force * 2.0 ** rng.integers(-3, 4, len(problem.blocks)))
    small, other = plane.problem, plane.measured(whole)
    x, u, y = (rng.standard_normal(n) for n in (*small.C.shape, len(small.g)))
    state = State(1.0, x, u, y)
    one = problem.in_si(plane.lifted(state))
    two = whole.in_si(other.lifted(other.problem.dimensionless(small.in_si(state))))
    for a, b in ((one.x, two.x), (one.u, two.u), (one.y, two.y), (one.load_factor, two.load_factor)):
        assert np.allclose(a, b, rtol=1e-12, atol=0.0)


def test_points_that_coincide_where_two_interfaces_meet_are_told_apart():
    """Stones in running bond stand on the middle of two: along the joint of these they touch both."""
    model = structures.dome(JOINTS["points"], radius=2.0, thickness=0.3, courses=3, stones=10)
    plane = in_plane(model.problem)
    assert len(plane.blocks) < 0.6 * len(model.free_blocks)
    half = lb.bounds(model)
    assert half.solvers[0].endswith("in one half")
    assert same(half, without_mirror(lb.bounds, model))


@pytest.mark.parametrize("name", ["points", "octagon", "circle"])
def test_the_barrier_of_the_half_has_every_logarithm_of_the_whole(name):
    """Of a cone in a joint in the plane, which has no shear, only its head is left: one logarithm."""
    problem = pair_of_columns(JOINTS[name]).problem
    plane = reduced(problem, mirror_of(problem), Choice.EVERY)
    assert plane.barrier_of(problem.cones).sum() == problem.cones.degree


@pytest.mark.parametrize("rank", [1, 2, 3])
def test_pseudo_inverses_of_matrices_with_and_without_an_inverse(rank):
    """The conditions of Penrose (1955); what one stack has beside it must not matter."""
    rows = np.random.default_rng(rank).normal(size=(20, 3, rank))
    A = rows @ rows.transpose(0, 2, 1)
    X = pseudo_inverses(A)
    size = np.linalg.norm(A, axis=(1, 2), keepdims=True) * np.linalg.norm(X, axis=(1, 2), keepdims=True)
    for left, right in ((A @ X @ A, A), (X @ A @ X, X)):
        assert (np.abs(left - right) <= 1e-12 * size * np.abs(right).max(axis=(1, 2), keepdims=True)).all()
    assert (np.abs(A @ X - (A @ X).transpose(0, 2, 1)) <= 1e-12 * size).all()
    assert pseudo_inverses(np.zeros((2, 3, 3))).any() == 0


def test_rows_of_a_dome_are_their_images_up_to_rounding():
    """Rows that differ by rounding stand for one: kept apart, their multipliers would not be unique."""
    there = structures.dome(lb.PointContact(0.6), radius=3.0, thickness=0.4, courses=12, stones=24)
    bounds = lb.bounds(there)
    assert bounds.proven
    assert bounds.solvers[0].endswith("in one half")

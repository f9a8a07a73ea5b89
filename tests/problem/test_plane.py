"""Planar problems as planar: what is found, what is not, and that nothing of the answer changes.

Sources: docs/planar.md (the reduction by symmetry); closed forms in the tests.
"""

from dataclasses import replace
from unittest import mock

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import sparse
from scipy.spatial.transform import Rotation
from stones import block_off

import limitblocks as lb
from limitblocks import structures
from limitblocks.analysis.bounds import pairs_of_bounds
from limitblocks.analysis.in_plane import in_plane
from limitblocks.analysis.stability import dead_load_state, standing_margin
from limitblocks.problem import State
from limitblocks.problem.plane import Choice, mirror_of, reduced

PAPER = lb.OrdunaLourenco(0.65, slip="paper")
JOINTS = {
    "octagon": PAPER,
    "circle": lb.OrdunaLourenco(0.65),
    "crushing": lb.OrdunaLourenco(0.65, compressive_strength=2e5),
    "cohesion": lb.OrdunaLourenco(0.65, cohesion=1e3, tensile_strength=5e2),
    "both": lb.OrdunaLourenco(0.65, compressive_strength=2e5, cohesion=1e3, tensile_strength=5e2),
    "frictionless": lb.OrdunaLourenco(0.0),
    "points": lb.PointContact(0.65),
    "more points": lb.PointContact(0.65, points=2),
    "polygons at points": lb.PointContact(0.65, cone="inner"),
}
# Rows of an interface that neither follow from others nor coincide: slip to both sides and hinging about both
# edges; with crushing also twist under bending in both senses (Eq. 30), and the cones of three
# edges (Eq. 39). Points between corners do not imply one another.
ROWS = dict.fromkeys(JOINTS, 4) | {
    "more points": 10,
    "frictionless": 2,
    "cohesion": 6,
    "crushing": 13,
    "both": 13,
}


def wall(joint, courses=3, direction=(1.0, 0.0, 0.0)):
    return structures.wall(joint, length=1.6, courses=courses, direction=direction)


def turned(model, turn, shift=(0.0, 0.0, 0.0)):
    """The model with everything rotated; loads as forces on blocks."""
    matrix = turn.as_matrix()
    blocks = [block.moved(matrix, shift) for block in model.blocks]
    interfaces = [
        replace(i, centroid=matrix @ i.centroid + shift, axes=i.axes @ matrix.T) for i in model.interfaces
    ]
    loads = []
    for load in (model.dead, model.live):
        values = load.on(model.free_blocks)
        assert not values[:, 3:].any()
        forces = [
            lb.loads.force(block.name, tuple(matrix @ value[:3]), matrix @ block.centroid + shift)
            for block, value in zip(model.free_blocks, values, strict=True)
        ]
        loads.append(sum(forces[1:], forces[0]))
    return lb.Model(blocks, model.supports, interfaces, *loads)


def pair_of(problem):
    return next(pairs_of_bounds(problem, dead_load_state(problem), 1e-6))


@pytest.mark.parametrize("name", JOINTS)
def test_the_reduced_problem_has_the_load_factor_of_the_whole(name):
    model = wall(JOINTS[name])
    plane = in_plane(model.problem)
    assert plane is not None
    small, found = pair_of(plane.problem).state, pair_of(model.problem)
    assert found.solver.endswith("in the plane")
    with mock.patch("limitblocks.analysis.in_plane.mirror_of", return_value=None):
        large = pair_of(replace(model.problem))
    assert "plane" not in large.solver
    scale = pytest.approx(large.state.load_factor, rel=2e-6, abs=1e-9)
    assert small.load_factor == scale
    assert found.state.load_factor == scale
    assert len(plane.problem.g) <= ROWS[name] * len(plane.problem.interfaces)


@settings(max_examples=2)
@given(st.integers(0, 10**6), st.sampled_from(sorted(JOINTS)))
def test_rotation_changes_neither_the_reduction_nor_the_bounds(seed, name):
    joint = JOINTS[name]
    straight, rotation = wall(joint, courses=2), Rotation.random(random_state=seed)
    skew = turned(straight, rotation)
    one, other = in_plane(straight.problem), in_plane(skew.problem)
    assert other is not None
    assert other.problem.F.shape == one.problem.F.shape
    a, b = lb.bounds(straight), lb.bounds(skew)
    assert b.lower == pytest.approx(a.lower, rel=2e-6, abs=1e-9)
    # the mechanism stays in the turned plane
    normal = rotation.as_matrix()[:, 1]
    rates = b.displacement_rates
    assert np.abs(rates[:, :3] @ normal).max() <= 1e-9 * np.abs(rates).max()


@pytest.mark.parametrize("name", ["octagon", "points"])
def test_rounding_of_the_search_is_not_in_the_reduced_problem(name):
    """Inverses and pseudo-inverses are off by other roundings: a proof was 25 times wider with the one."""
    arch = structures.arch(JOINTS[name], radius=5.0, thickness=1.0, voussoirs=40)
    for problem in (arch.problem, wall(JOINTS[name]).problem):
        (kind,) = mirror_of(problem).kinds
        assert np.isin(kind.turn, (-1.0, 0.0, 1.0)).all()


def test_an_axis_of_the_interface_that_is_not_in_the_plane_is_no_obstacle():
    """Round friction at points is symmetric about every axis; an octagon, turned by 10 degrees, is not."""
    for joint, planar in ((lb.PointContact(0.65), True), (lb.PointContact(0.65, cone="inner"), False)):
        model = wall(joint, courses=2)
        c, s = np.cos(np.radians(10.0)), np.sin(np.radians(10.0))
        turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        swivelled = [
            replace(i, axes=turn @ i.axes, polygon=i.polygon @ turn[:2, :2].T) for i in model.interfaces
        ]
        same = replace(model, interfaces=swivelled)
        assert (in_plane(same.problem) is not None) is planar
        if planar:
            assert lb.bounds(same).lower == pytest.approx(lb.bounds(model).lower, rel=2e-6)


def test_what_is_not_planar_is_not_reduced():
    model = wall(PAPER)
    top = model.free_blocks[-1]
    pushed = lb.loads.force(top.name, (0.0, 1e-6 * top.weight, 0.0), top.centroid)
    twisted = lb.loads.moment(top.name, (0.0, 0.0, 1e-3 * top.weight))
    aside = lb.loads.force(top.name, (0.0, 0.0, -top.weight), top.centroid + np.array([0.0, 1e-3, 0.0]))
    for live in (pushed, twisted, aside):
        assert in_plane(replace(model, live=model.live + live).problem) is None
        assert in_plane(replace(model, dead=model.dead + live).problem) is None
    assert in_plane(block_off(model, 1e-3).problem) is None
    assert in_plane(block_off(model, 1e-8).problem) is None
    assert in_plane(block_off(model, 0.0).problem) is not None
    assert in_plane(wall(PAPER, direction=(1.0, 1.0, 0.0)).problem) is None
    out = wall(PAPER, direction=(0.0, 1.0, 0.0)).problem
    assert not in_plane(out).flat  # one half of it, about a plane across the wall
    assert in_plane(structures.corner(PAPER, length=1.2, return_length=1.2, courses=2).problem) is None


def test_pieces_of_a_joint_that_mirror_each_other_are_planar():
    """A pile on two stripes at y = +-0.4 m: each stripe is symmetric itself, and the other's image."""
    stones = [lb.Block.box("ground", (4, 1, 1), (0, 0, -0.5))]
    stones.append(lb.Block.box("stone", (0.5, 1.0, 2.0), (0.0, 0.0, 1.0), unit_weight=2e4))
    joint = lb.OrdunaLourenco(0.8)
    stripe = np.array([(-0.25, -0.1), (0.25, -0.1), (0.25, 0.1), (-0.25, 0.1)])
    for y, planar in ((0.4, True), (0.39, False)):
        feet = [
            lb.Interface("ground", "stone", np.array([0.0, at, 0.0]), np.eye(3), stripe, joint)
            for at in (-0.4, y)
        ]
        push = lb.mass_proportional(direction=(1.0, 0.0, 0.0))
        model = lb.Model(stones, ["ground"], feet, lb.self_weight(), push)
        assert (in_plane(model.problem) is not None) is planar
        bounds = lb.bounds(model)
        assert bounds.lower == pytest.approx(0.25, rel=1e-6)  # rocking: b / h, Housner (1963)
        if planar:
            assert bounds.solvers[0].endswith("in the plane")
            assert bounds.stress_resultants[0, 2] == pytest.approx(bounds.stress_resultants[1, 2])


@pytest.mark.parametrize("name", JOINTS)
def test_two_joints_between_the_same_blocks_are_told_apart(name):
    """A stone in the corner of an L: with six stresses either joint fits the image of the other."""
    corner = lb.Block.prism("L", [(-1, -0.2), (2, -0.2), (2, 0), (0, 0), (0, 0.4), (-1, 0.4)], (-0.5, 0.5))
    stones = [corner, lb.Block.box("stone", (0.3, 1.0, 0.6), at=(0.15, 0.0, 0.3), unit_weight=20e3)]
    joints = lb.find_interfaces(stones, JOINTS[name])
    model = lb.Model(stones, ["L"], joints, lb.self_weight(), lb.mass_proportional((1.0, 0.0, 0.0)))
    assert len(joints) == 2
    assert mirror_of(model.problem).flat


def test_mirrors_of_another_turn_of_the_plane():
    """A lone block pushed along x is symmetric about y = 0, whichever way its joint's axes lie."""
    model = structures.block(lb.OrdunaLourenco(0.3), width=1.0, height=1.0, depth=1.0)
    assert mirror_of(model.problem) is not None
    assert lb.bounds(model).lower == pytest.approx(0.3, rel=1e-7)  # slides at mu


@pytest.mark.parametrize("name", ["octagon", "both", "points"])
def test_lifted_states_satisfy_everything_out_of_the_plane_too(name):
    problem = wall(JOINTS[name]).problem
    rng = np.random.default_rng(0)
    for choice in Choice:
        plane = reduced(problem, mirror_of(problem), choice)
        small = plane.problem
        x, u = rng.standard_normal(small.C.shape[0]), plane.rates.T @ rng.standard_normal(problem.C.shape[1])
        y = rng.random(len(small.g))
        y[small.cones.heads] += small.cones.norm(y)
        up = plane.lifted(State(1.0, x, u, y))
        # virtual work, dissipation and what the rows say are the same in both
        assert up.x @ (problem.C @ up.u) == pytest.approx(x @ (small.C @ u))
        assert up.y @ (problem.F @ up.x + problem.g) == pytest.approx(y @ (small.F @ x + small.g))
        assert problem.cones.margin(up.y).min() >= -1e-12
        # forces out of the plane vanish, and so do strains that stresses of the plane do no work on
        assert np.allclose(plane.rates @ (plane.rates.T @ (problem.C.T @ up.x)), problem.C.T @ up.x)
        defect = problem.C @ up.u + problem.F.T @ up.y
        back = plane.stresses @ plane.stresses_of(defect)
        assert np.allclose(back, defect, atol=1e-9)
        again = plane.averaged(up)
        assert all(np.allclose(*pair) for pair in ((again.x, x), (again.u, u), (again.y, y)))


def test_rounding_does_not_decide_which_stresses_come_first():
    """Of a wall in mm, m and km: those that mirror each other are as large but for rounding."""
    patterns = []
    for scale in (1e-3, 1.0, 1e3):
        size = {"length": 1.2, "block_length": 0.4, "block_height": 0.2, "thickness": 0.2}
        scaled = {name: scale * one for name, one in size.items()}
        model = structures.wall(PAPER, courses=4, **scaled)
        stresses = in_plane(model.problem, Choice.FLOWING).stresses
        patterns.append((stresses.indptr.tolist(), stresses.indices.tolist()))
    assert patterns[0] == patterns[1] == patterns[2]


def test_rows_left_out_are_implied():
    problem = wall(JOINTS["both"]).problem
    mirror = mirror_of(problem)
    few, all_rows = (reduced(problem, mirror, choice).problem for choice in (Choice.FEW, Choice.EVERY))
    assert len(few.g) < len(all_rows.g)
    rng, inside = np.random.default_rng(1), 0
    dead = in_plane(problem).stresses_of(dead_load_state(problem))
    for size in (0.01, 0.1, 0.5, 1.0):
        for _ in range(50):
            x = dead + size * rng.standard_normal(len(dead)) * np.abs(dead).max()
            a, b = (p.cones.margin(p.F @ x + p.g) for p in (few, all_rows))
            at = [np.full(len(p.interfaces), np.inf) for p in (few, all_rows)]
            for least, p, margin in zip(at, (few, all_rows), (a, b), strict=True):
                np.minimum.at(least, p.member_interface, margin)
            assert ((at[0] >= 0.0) == (at[1] >= -1e-12)).all()
            inside += int((at[0] >= 0.0).sum())
    assert inside > 100  # the test has states of both kinds


def test_a_wrong_reduction_costs_time_and_no_more():
    """Stresses lifted wrongly are mended and proven in the whole problem, or it is solved."""
    model = wall(PAPER, courses=2)
    right = lb.bounds(model)
    plane = in_plane(model.problem)
    for wrong in (
        replace(plane, stresses=1.01 * plane.stresses),
        replace(plane, rates=sparse.csr_array(1.01 * plane.rates)),
        replace(plane, problem=replace(plane.problem, F=1.1 * plane.problem.F, C=0.9 * plane.problem.C)),
    ):
        again = replace(model)
        with mock.patch("limitblocks.analysis.bounds.in_plane", return_value=wrong):
            found = lb.bounds(again)
        assert found.proven or "plane" not in found.solvers[0]
        assert found.lower == pytest.approx(right.lower, rel=2e-6)


def test_planar_dead_load_margin_is_that_of_the_whole():
    """The largest margin is the same: the mean of a state and its mirror image has at least theirs."""
    for name in ("octagon", "both"):
        model = wall(JOINTS[name])
        found = standing_margin(model)
        with mock.patch("limitblocks.analysis.stability.in_plane", return_value=None):
            assert standing_margin(replace(model)) == pytest.approx(found, rel=1e-5)


def test_a_wall_of_a_thousand_blocks_is_proven():
    """With rates of one over the number of blocks, or at 3e-10, the interval is wider than the tolerance."""
    bounds = lb.bounds(structures.wall(PAPER, length=15.6, courses=26))
    assert bounds.proven
    assert bounds.solvers[0].endswith("in the plane")
    assert bounds.upper - bounds.lower <= 1e-6 * bounds.upper

"""The state of the permanent loads: what joints bear without dilatancy, and the state of least norm."""

import signal
from dataclasses import replace

import cvxpy as cp
import numpy as np
import pytest

import limitblocks as lb
from limitblocks.analysis.nonassociated import least_norm, permanent
from limitblocks.analysis.nonassociated.frozen_flow import frozen
from limitblocks.analysis.nonassociated.least_norm import by_cones, by_planes, least_state
from limitblocks.analysis.nonassociated.permanent import permanent_state
from limitblocks.analysis.nonassociated.start import bracket, own_units
from limitblocks.analysis.programs import in_cone
from limitblocks.problem import ASSOCIATED, Flow

MU = 0.6


CRUSHING = lb.OrdunaLourenco(MU, compressive_strength=3e5)


@pytest.mark.parametrize(
    "joint",
    [lb.OrdunaLourenco(MU, slip="paper"), lb.PointContact(0.0), lb.PointContact(MU), CRUSHING],
    ids=repr,
)
def test_least_state_is_the_least_norm(joint):
    """As cvxpy finds it by a solver of its own; no live load is left to help."""
    problem = lb.structures.wall(joint, length=1.2, courses=4, direction=(1.0, 0.0, 0.0)).problem
    x, W = least_state(problem, problem.compliance).x, problem.compliance
    assert problem.C.T @ x == pytest.approx(problem.dead, abs=1e-8)
    assert problem.cones.margin(problem.F @ x + problem.g).min() > -1e-8
    y = cp.Variable(len(x))
    inside = in_cone(problem.F @ y + problem.g, problem.cones)
    norm = cp.sum_squares(cp.multiply(np.sqrt(W), y))
    cp.Problem(cp.Minimize(norm), [problem.C.T @ y == problem.dead, *inside]).solve(cp.SCS, eps=1e-9)
    assert x @ (W * x) == pytest.approx(norm.value, rel=1e-7)


@pytest.mark.parametrize(
    "joint", [lb.OrdunaLourenco(MU, slip="paper"), lb.PointContact(MU, cone="inner"), lb.PointContact(0.0)]
)
def test_least_state_by_planes_is_that_by_cones(joint):
    problem = lb.structures.wall(joint, length=1.2, courses=4, direction=(1.0, 0.0, 0.0)).problem
    W = problem.compliance
    x, expected = by_planes(problem, W).x, by_cones(problem, W).x
    assert problem.C.T @ x == pytest.approx(problem.dead, abs=1e-12)
    assert (problem.F @ x + problem.g).min() > -1e-12
    assert x @ (W * x) == pytest.approx(expected @ (W * expected), rel=1e-7)


def test_least_state_that_does_not_hold_is_refused(monkeypatch):
    problem = lb.structures.wall(lb.PointContact(MU, cone="inner"), length=1.2, courses=4).problem
    rough = least_norm.OSQP | {"eps_abs": 1e-2, "eps_rel": 1e-2, "polishing": False}
    monkeypatch.setattr(least_norm, "OSQP", rough)
    assert by_planes(problem, problem.compliance) is None
    assert least_state(problem, problem.compliance) is not None
    few = least_norm.CLARABEL | {"max_iter": 5}
    monkeypatch.setattr(least_norm, "CLARABEL", few)
    assert least_state(problem, problem.compliance) is None


def test_least_state_of_a_corner_that_takes_refinement():
    """Without refinement Clarabel ends in insufficient progress."""
    size = {"length": 2.4, "return_length": 2.4, "courses": 4, "direction": (0.0, 1.0, 0.0)}
    model = lb.structures.corner(lb.OrdunaLourenco(0.8), **size)
    problem = own_units(model, bracket(model))
    assert least_state(problem, problem.compliance) is not None


@pytest.mark.parametrize("cone", ["exact", "inner"])
def test_no_permanent_state_of_blocks_that_fall_up(cone):
    problem = lb.structures.wall(lb.PointContact(MU, cone=cone), length=1.2, courses=4).problem
    assert least_state(problem, problem.compliance) is not None
    assert least_state(replace(problem, dead=-problem.dead), problem.compliance) is None
    assert permanent_state(Flow(replace(problem, dead=-problem.dead)), problem.compliance) is None


def test_ctrl_c_that_osqp_keeps_to_itself_ends_the_analysis(monkeypatch):
    """It prints that it was interrupted, and returns."""
    solve = least_norm.osqp.OSQP.solve

    def pressed(solver, **options):
        found = solve(solver, **options)
        found.info.status_val = 10  # OSQP_SIGINT of its constants.h
        return found

    monkeypatch.setattr(least_norm.osqp.OSQP, "solve", pressed)
    problem = lb.structures.wall(lb.OrdunaLourenco(0.6, slip="paper"), length=1.2, courses=3).problem
    usual = signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored in the background of a shell
    try:
        with pytest.raises(KeyboardInterrupt):
            least_state(problem, problem.compliance)
    finally:
        signal.signal(signal.SIGINT, usual)


def between(neighbours, joint):
    """A cube of 20 kN on a base, pushed along two stones beside it, fixed or as high as said."""
    high = neighbours or 1.0
    blocks = [
        lb.Block.box("base", (6.0, 2.0, 0.2), (0.0, 0.0, -0.1)),
        lb.Block.box("cube", (1.0, 1.0, 1.0), (0.0, 0.0, 0.5), 20e3),
        *(
            lb.Block.box(name, (1.0, 1.0, high), (x, 0.0, high / 2), 20e3)
            for name, x in (("west", -1.0), ("east", 1.0))
        ),
    ]
    supports = ["base"] if neighbours else ["base", "west", "east"]
    live = lb.loads.force("cube", (0.0, 20e3, 0.0), (0.0, 0.0, 0.5))
    return lb.Model(blocks, supports, lb.find_interfaces(blocks, joint), lb.self_weight(), live)


FRICTION = 0.3
BESIDE = [
    lb.OrdunaLourenco(FRICTION),
    lb.OrdunaLourenco(FRICTION, compressive_strength=3e6),
    lb.PointContact(FRICTION),
]


@pytest.mark.parametrize("joint", BESIDE, ids=repr)
@pytest.mark.parametrize("neighbours", [None, 2.0, 5.0])
def test_no_friction_without_normal_force_beside_a_cube_that_stands_on_its_base(neighbours, joint):
    """Nothing presses the neighbours against it, so that the load factor is the friction of its base.

    Of least norm the cube leans on them: its sides bear part of its weight, which takes normal forces.
    """
    model = between(neighbours, joint)
    problem = model.problem
    least = least_state(problem, problem.compliance).x
    x = permanent_state(Flow(problem), problem.compliance)
    sides = np.array(["base" not in problem.interfaces[k] for k in problem.stress_interface])
    assert np.abs(least[sides]).max() > 0.02 * np.abs(least).max()
    assert np.abs(x[sides]).max() < 1e-3 * np.abs(x).max()
    assert lb.load_path(model).collapse.load_factor == pytest.approx(FRICTION, rel=2e-3)


def test_barriers_are_not_measured_by_what_only_crushing_limits():
    """Between fixed stones the associated one is 94, and a barrier in its measure held the cube at 7.9."""
    found = lb.nonassociated(between(None, BESIDE[1]))
    assert found.associated > 50.0
    assert FRICTION <= found.load_factor < 1.5 * FRICTION


@pytest.mark.parametrize("name", ["eccentric_lintel", "pavilion_vault", "cantilever_stair", "facade"])
@pytest.mark.parametrize("joint", [lb.OrdunaLourenco(0.6), lb.PointContact(0.6)], ids=repr)
def test_permanent_state_is_a_fixed_point_of_frozen_friction(name, joint):
    """Of least norm with the friction that its normal forces leave: a convex program by another solver."""
    problem = lb.structures.EXAMPLES[name](joint).problem
    W, flow = problem.compliance, Flow(problem)
    x = permanent_state(flow, W)
    assert np.abs(problem.dead - problem.C.T @ x).max() <= 1e-8 * np.abs(x).max()
    assert problem.cones.margin(problem.F @ x + problem.g).min() >= 0.0
    again = least_state(frozen(flow, x), W).x
    assert np.abs(again - x).max() < 5e-3 * np.abs(x).max()
    least = least_state(problem, W).x  # is none
    assert np.abs(least_state(frozen(flow, least), W).x - least).max() > 5e-3 * np.abs(x).max()


def test_of_associated_flow_the_permanent_state_is_that_of_least_norm():
    problem = between(2.0, lb.PointContact(FRICTION)).problem
    x = permanent_state(Flow(problem, ASSOCIATED), problem.compliance)
    np.testing.assert_array_equal(x, least_state(problem, problem.compliance).x)


def test_where_only_self_stress_holds_a_block_the_permanent_state_is_that_of_least_norm():
    blocks = [block for block in between(None, lb.PointContact(0.7)).blocks if block.name != "base"]
    joints = lb.find_interfaces(blocks, lb.PointContact(0.7))
    push = lb.mass_proportional((0.0, 1.0, 0.0))
    model = lb.Model(blocks, ["west", "east"], joints, lb.self_weight(), push)
    problem = model.problem
    x = permanent_state(Flow(problem), problem.compliance)
    np.testing.assert_array_equal(x, least_state(problem, problem.compliance).x)
    found = lb.nonassociated(model)
    for one in (lb.load_path(model, throw=False).collapse, found):
        assert any("no stresses were found that arise" in remark for remark in one.remarks)
    for start in (x * problem.stress_units, found):
        given = lb.nonassociated(model, start=start)
        assert not any("arise under the dead loads" in remark for remark in given.remarks)
    free = lb.nonassociated(between(None, lb.PointContact(0.7)))
    assert not any("arise under the dead loads" in remark for remark in free.remarks)


def test_plane_models_whose_least_state_does_not_dilate_take_no_path(monkeypatch):
    """Multipliers of joints of this arch that carry nothing dilate: no normal force works on that."""
    monkeypatch.setattr(permanent, "at_once", None)
    problem = lb.structures.arch(
        lb.PointContact(0.7, cone="inner"), radius=1.0, thickness=0.3, voussoirs=9
    ).problem
    assert permanent_state(Flow(problem), problem.compliance) is not None

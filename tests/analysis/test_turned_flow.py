"""Table 5: where it has no solution, and what leads to one."""

from dataclasses import replace
from itertools import product

import pytest
from scipy import sparse

import limitblocks as lb
from limitblocks import structures
from limitblocks.analysis.nonassociated.determinate import state_without_solution
from limitblocks.analysis.nonassociated.means import SOFTENING, TURNED_MEANS, TURNED_SOFTENING
from limitblocks.analysis.nonassociated.start import bracket, load_scale, own_units, start_stresses
from limitblocks.analysis.polish import polish
from limitblocks.evidence.residuals import TOLERANCE, mcp_residuals
from limitblocks.problem import Flow, Turning
from tests.analysis.paths import follow

MU, HEIGHT, ARM = 0.5, 0.2, 0.45
TABLE_5 = "centre of pressure"


def bracketed(at=None, joint=None):
    """A stone 1.9 long on a square of 1, its centroid ARM off the middle, pushed across there or `at`."""
    base = lb.Block.box("base", (1, 1, 0.2), (0, 0, -0.1))
    stone = lb.Block.box("stone", (1.9, 1, HEIGHT), (ARM, 0, HEIGHT / 2), 20e3)
    interfaces = lb.find_interfaces([base, stone], joint or lb.OrdunaLourenco(MU))
    push = lb.mass_proportional((0, 1, 0))
    if at is not None:
        push = lb.loads.force("stone", (0, stone.weight, 0), at=(at, 0, HEIGHT / 2))
    return lb.Model([base, stone], ["base"], interfaces, lb.self_weight(), push)


def twists_at(arm):
    """Eq. (30), l1 = l2 = 1/2, e = (ARM, a h/2): T = a W arm = mu/2 (1 - |e1| - |e2|) W."""
    return MU / 2 * (1 - ARM) / (arm + MU / 2 * HEIGHT / 2)


def test_a_push_through_the_point_where_n_acts_turns_nothing_about_it():
    """Weight and push act at the centroid: the push passes over the centre of pressure, and does no work."""
    model = bracketed()
    with pytest.raises(
        lb.errors.NoSolution, match=r"no solution exists: .* base\|stone yields first"
    ) as caught:
        lb.nonassociated(model, turning=TABLE_5)
    result = caught.value.result
    assert result.status is lb.results.Status.NO_SOLUTION
    assert result.load_factor == pytest.approx(twists_at(ARM))
    assert result.how == "statics alone"
    kept = lb.nonassociated(model, turning=TABLE_5, throw=False)
    assert kept.status is lb.results.Status.NO_SOLUTION
    assert not lb.check_mcp(model, kept).passed


def test_about_the_centroid_the_same_push_does_work():
    found = lb.nonassociated(bracketed())
    assert found.load_factor == pytest.approx(twists_at(ARM))
    assert state_without_solution(Flow(bracketed().problem)) is None


def test_a_push_beside_the_point_where_n_acts_turns_the_stone():
    model = bracketed(at=0.75)
    found = lb.nonassociated(model, turning=TABLE_5)
    assert found.load_factor == pytest.approx(twists_at(0.75))
    assert state_without_solution(Flow(model.problem, 0.0, Turning.PRESSURE)) is None


def test_no_proof_where_statics_alone_does_not_give_the_stresses_or_nothing_holds():
    points = bracketed(joint=lb.PointContact(MU))
    assert state_without_solution(Flow(points.problem)) is None
    wall = structures.wall(lb.OrdunaLourenco(MU), length=1.2, courses=2)
    assert state_without_solution(Flow(wall.problem)) is None
    stone = bracketed().problem
    free = sparse.diags_array([1.0] * (stone.C.shape[1] - 1) + [0.0])  # about one axis nothing holds it
    assert state_without_solution(Flow(replace(stone, C=stone.C @ free))) is None
    edge = structures.block(lb.OrdunaLourenco(MU), width=1.0, height=1.0)
    stands_on_edge = replace(edge, dead=lb.self_weight() + lb.mass_proportional((MU, 0, 0)))
    assert state_without_solution(Flow(stands_on_edge.problem)) is None  # slides under its dead loads


def corner(courses, length):
    return structures.corner(
        lb.OrdunaLourenco(0.6), length=length, return_length=length, courses=courses, direction=(0, 1, 0)
    )


def test_paths_from_the_solution_about_the_centroid_lead_to_ones_of_table_5():
    """Of four about two; with the softening of paths from the permanent loads next to none."""
    closed = {TURNED_SOFTENING: 0, SOFTENING: 0}
    model = corner(4, 2.4)  # two walls that meet, pushed out of the plane of one
    enclosing = bracket(model)
    problem = own_units(model, enclosing)
    flow = Flow(problem, 0.0, Turning.PRESSURE)
    x0 = start_stresses(model, Flow(problem), problem.compliance, lb.nonassociated(model))
    power = load_scale(problem, enclosing.associated) / len(problem.blocks)
    for softening, means in product(closed, TURNED_MEANS[:4]):
        softened = replace(flow, softening=softening)
        state, _ = follow(softened, x0, problem.compliance, means=[means], power=power)
        closed[softening] += mcp_residuals(flow, polish(flow, state)).worst.value <= TOLERANCE
    assert closed[TURNED_SOFTENING] > 2 * closed[SOFTENING]


def test_where_the_first_path_is_not_closed_they_come_next():
    unfinished, whole = (lb.settings.Means(lb.settings.Barrier(), 0, budget) for budget in (1, 300))
    found = lb.nonassociated(corner(2, 1.6), turning=Turning.PRESSURE, means=[unfinished, whole])
    assert found.how.startswith("from the solution that twists about the centroid, tracked path")


def test_a_check_finds_the_residuals_that_the_answer_states():
    """Forces of 1e-12 leave it to the epsilon of Table 5, and so to the units, what a joint turns about."""
    model = structures.buttressed_wall(
        lb.OrdunaLourenco(0.32701182338616275, slip="inner", sides=10),
        length=3.2,
        courses=6,
        buttress_length=0.8,
        direction=(-1.0, 0.0, 0.0),
    )
    found = lb.nonassociated(model, turning="centre of pressure")
    check = lb.check_mcp(model, found)
    assert check.passed
    for stated in found.residuals.entries:
        assert check.residuals[stated.name] == pytest.approx(stated.value, abs=1e-12), stated.name

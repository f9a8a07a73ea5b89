"""The path in displacements of structures with contact points, and what elastic contact points carry."""

from dataclasses import replace

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.analysis.nonassociated import displacement_path, ways
from limitblocks.analysis.nonassociated.closing import Closing
from limitblocks.analysis.nonassociated.contact_points import ContactPoints, contact_points
from limitblocks.analysis.nonassociated.displacement_path import ROUNDED, pushed_over
from limitblocks.analysis.nonassociated.means import LARGE_MEANS
from limitblocks.analysis.nonassociated.permanent import permanent_state
from limitblocks.analysis.nonassociated.start import bracket, load_scale, own_units
from limitblocks.analysis.polish import defect
from limitblocks.practice import reinforced, tie
from limitblocks.problem import Flow


def sample(rounding, count=300):
    rng = np.random.default_rng(1)
    stiffness = rng.uniform(0.5, 2.0, (count, 3))
    stiffness[:, 1] = stiffness[:, 0]
    points = ContactPoints(rng.uniform(0.0, 1.0, count), stiffness, rng.normal(size=(count, 3)), rounding)
    return points, rng.normal(size=(count, 3)), rng


def test_forces_are_those_of_coulomb_friction_without_dilatancy_where_corners_are_sharp():
    points, strains, _ = sample(1e-9)
    elastic = points.x0 + strains * points.stiffness
    N = np.minimum(elastic[:, 2], 0.0)
    v = np.linalg.norm(elastic[:, :2], axis=1)
    share = np.minimum(1.0, -points.friction * N / v)
    expected = np.column_stack([share[:, None] * elastic[:, :2], N])
    assert np.abs(points.forces(strains)[0] - expected).max() < 1e-8


@pytest.mark.parametrize("rounding", [1e-9, 0.01, 1.0])
def test_forces_are_within_yield_however_round_its_corners_are(rounding):
    points, strains, _ = sample(rounding)
    forces, _ = points.forces(30.0 * strains)
    assert (forces[:, 2] < 0.0).all()
    assert (np.linalg.norm(forces[:, :2], axis=1) <= -points.friction * forces[:, 2] * (1.0 + 1e-9)).all()


def test_derivatives_of_the_forces_are_those_of_differences():
    points, strains, rng = sample(0.1)
    strains[0] = -points.x0[0] / points.stiffness[0]  # no force at all
    direction, h = rng.normal(size=strains.shape), 1e-6
    ahead, behind = points.forces(strains + h * direction)[0], points.forces(strains - h * direction)[0]
    slope = np.einsum("kij,kj->ki", points.forces(strains)[1], direction)
    assert np.abs((ahead - behind) / (2.0 * h) - slope).max() < 1e-8


@pytest.mark.parametrize(
    ("joint", "dilatancy"),
    [
        (lb.OrdunaLourenco(0.6), 0.0),
        (lb.PointContact(0.0), 0.0),
        (lb.PointContact(0.6, cone="inner"), 0.0),
        (lb.PointContact(0.6), 0.3),
        (lb.PointContact(0.6), 0.6),
    ],
)
def test_other_joints_and_dilatancy_have_no_such_path(joint, dilatancy):
    problem = lb.structures.block(joint, width=1.0, height=1.0).problem
    x0 = np.zeros(problem.C.shape[0])
    assert contact_points(Flow(problem, dilatancy), x0, ROUNDED) is None


def test_a_structure_with_a_tie_has_no_such_path():
    wall = lb.structures.wall(lb.PointContact(0.6), length=1.6, courses=3)
    block = wall.blocks[-1]
    rod = tie(block.name, block.centroid, wall.supports[0], (-3.0, 0.0, 0.0), area=1e-4, strength=235e6)
    problem = reinforced(wall, rod).problem
    assert contact_points(Flow(problem), np.zeros(problem.C.shape[0]), ROUNDED) is None


def solved(model, record=lambda _: None):
    """The solution of Eqs (54)-(59) that the path leads to, its load factor, and the flow rule."""
    problem = own_units(model, bracket(model))
    flow = Flow(problem)
    x0, scale = (
        permanent_state(Flow(problem), problem.compliance),
        load_scale(problem, bracket(model).associated),
    )
    state, _ = pushed_over(flow, x0, scale, Closing(flow, 1e-8), record)
    return state.load_factor / problem.units.live, defect(flow, state)


@pytest.mark.parametrize(
    ("friction", "width", "height", "expected"),
    [(0.5, 1.0, 4.0, 0.25), (0.2, 1.0, 2.0, 0.2), (0.9, 0.3, 1.0, 0.3)],
)
def test_a_block_slides_or_rocks(friction, width, height, expected):
    block = lb.structures.block(lb.PointContact(friction), width=width, height=height)
    load_factor, left = solved(block)
    assert left <= 1e-8
    assert abs(load_factor - expected) < 1e-6


def test_a_wedge_in_a_groove_slides_along_it():
    """Mu / sin w without dilatancy, w half of the angle of the groove."""
    wedge = lb.structures.EXAMPLES["wedge"](lb.PointContact(0.4))
    along = replace(wedge, live=lb.mass_proportional((1.0, 0.0, 0.0)))
    load_factor, left = solved(along)
    assert left <= 1e-8
    assert abs(load_factor - 0.4 * np.sqrt(2.0)) < 1e-6


@pytest.mark.parametrize(
    ("name", "push", "apart"),
    [
        ("eccentric_lintel", (1.0, 0.0, 0.0), 5e-3),  # one of an interval
        ("arch_bridge", (1.0, 0.0, 0.0), 1e-4),
        ("corner", (1.0, 0.0, 0.0), 1e-2),
    ],
)
def test_it_ends_where_increments_of_loading_do(name, push, apart):
    """Slip that stops and where it began are not kept, and corners are rounded: the corner is .7 % off."""
    model = replace(lb.structures.EXAMPLES[name](lb.PointContact(0.6)), live=lb.mass_proportional(push))
    load_factor, left = solved(model)
    assert left <= 1e-8
    assert abs(load_factor / lb.load_path(model).load_factor - 1.0) < apart


def test_the_path_turns_where_the_structure_snaps():
    """A corner pushed along: displacements fall at times; it takes 900 factors without the sign of det J."""
    corner = lb.structures.EXAMPLES["corner"](lb.PointContact(0.8))
    model = replace(corner, live=lb.mass_proportional((1.0, 0.0, 0.0)))
    met = []
    load_factor, left = solved(model, met.append)
    assert left <= 1e-8
    assert load_factor <= bracket(model).associated
    assert (np.diff([one.step_size for one in met]) > 0.0).any()
    assert met[-1].inner < 450


def test_the_path_starts_where_rounded_corners_carry_less_than_the_permanent_loads():
    """A flat arch that hardly stands: without the first point found so no step succeeds."""
    arch = lb.structures.EXAMPLES["segmental_arch"](lb.PointContact(0.6))
    met = []
    load_factor, left = solved(replace(arch, live=lb.mass_proportional((1.0, 0.0, 0.0))), met.append)
    assert met
    assert left <= 1e-8
    assert load_factor <= bracket(arch).associated


def test_a_solution_far_from_the_path_is_not_where_it_ends(monkeypatch):
    """Rounds led a facade of 223 blocks, pushed along, from .1812 to .1731; the path goes on, to .1827."""
    problem = lb.structures.block(lb.PointContact(0.5), width=1.0, height=4.0).problem
    x0, found = permanent_state(Flow(problem), problem.compliance), []

    def closing(state):
        found.append(replace(state, load_factor=state.load_factor * (1.001 if found else 0.99)))
        return found[-1]

    monkeypatch.setattr(displacement_path, "defect", lambda *_: 0.0)
    state, _ = pushed_over(Flow(problem), x0, 1.0, closing, lambda _: None)
    assert len(found) == 2
    assert state is found[1]


def test_the_solution_far_from_the_path_is_given_where_there_is_no_other(monkeypatch):
    problem = lb.structures.block(lb.PointContact(0.5), width=1.0, height=4.0).problem
    x0, found = permanent_state(Flow(problem), problem.compliance), []

    def closing(state):
        found.append(replace(state, load_factor=0.99 * state.load_factor))
        return found[-1]

    monkeypatch.setattr(displacement_path, "BUDGET", 40)
    monkeypatch.setattr(displacement_path, "defect", lambda *_: 0.0)
    state, _ = pushed_over(Flow(problem), x0, 1.0, closing, lambda _: None)
    assert state is found[-1]


def large(monkeypatch, budget=1):
    """Small models take the means of large ones, whose first path is cut."""
    first, *others = LARGE_MEANS
    monkeypatch.setattr(ways, "LARGE", 10)
    monkeypatch.setattr(ways, "LARGE_MEANS", (first._replace(budget=budget), *others))
    corner = lb.structures.EXAMPLES["corner"](lb.PointContact(0.6))
    return replace(corner, live=lb.mass_proportional((1.0, 0.0, 0.0)))


def test_a_large_structure_of_contact_points_is_pushed_in_displacements(monkeypatch):
    found = lb.nonassociated(large(monkeypatch))
    assert found.how.startswith("path in displacements, rounded corners of yield, ")
    assert found.how.endswith("of the fixed point")
    assert any("rounded corners of yield" in remark for remark in found.remarks)
    assert found.residuals.worst.value <= 1e-8


@pytest.mark.parametrize(
    ("largest", "how"), [(300, "path in displacements"), (20, "tracked path, small barrier, power 1, seed 1")]
)
def test_rounds_come_first_beyond_three_hundred_blocks(largest, how, monkeypatch):
    """Where they close the first path, as those of a house of 505 do."""
    model = large(monkeypatch)
    monkeypatch.setattr(ways, "FAR", np.inf)
    monkeypatch.setattr(ways, "LARGEST", largest)
    monkeypatch.setattr(ways, "LARGEST_MEANS", ways.LARGE_MEANS)
    assert lb.nonassociated(model).how.startswith(how)


def test_a_structure_of_other_joints_goes_on_to_a_larger_barrier(monkeypatch):
    model = large(monkeypatch)
    other = lb.structures.EXAMPLES["corner"](lb.OrdunaLourenco(0.6))
    assert "barrier 3" in lb.nonassociated(replace(other, live=model.live)).how


def test_a_path_that_used_up_its_budget_ends_in_rounds(monkeypatch):
    """From the first points rounds do not close it."""
    monkeypatch.setattr(displacement_path, "BUDGET", 10)
    corner = lb.structures.EXAMPLES["corner"](lb.PointContact(0.7))
    met = []
    _, left = solved(replace(corner, live=lb.mass_proportional((0.0, 1.0, 0.0))), met.append)
    assert met[-1].inner <= 10 + len(displacement_path.PACE) + 3
    assert np.isfinite(left)


def test_steps_that_run_away_end_in_rounds_without_a_warning(monkeypatch):
    """A tangent without energy: steps are infinite."""
    product = displacement_path.DisplacementPath.product
    monkeypatch.setattr(
        displacement_path.DisplacementPath, "product", lambda self, a, b: 0.0 * product(self, a, b)
    )
    load_factor, left = solved(lb.structures.block(lb.PointContact(0.5), width=1.0, height=4.0))
    assert np.isfinite([load_factor, left]).all()


def test_a_singular_start_is_no_path(monkeypatch):
    def singular(*_):
        raise RuntimeError("Factor is exactly singular")

    monkeypatch.setattr(displacement_path.DisplacementPath, "_factors", singular)
    problem = lb.structures.block(lb.PointContact(0.5), width=1.0, height=1.0).problem
    x0 = permanent_state(Flow(problem), problem.compliance)
    assert pushed_over(Flow(problem), x0, 1.0, lambda state: state, lambda _: None) is None


def test_the_user_may_stop_it(monkeypatch):
    def stop(one):
        if one.kind == "path" and one.residuals["theta"] < 1.0:
            raise KeyboardInterrupt

    found = lb.nonassociated(large(monkeypatch), progress=stop, throw=False)
    assert found.status is lb.results.Status.INTERRUPTED
    assert found.how == "path in displacements, rounded corners of yield, interrupted"
    # what a step of Newton's method leaves is squared
    assert found.residuals["equilibrium"] <= displacement_path.CLOSE**2

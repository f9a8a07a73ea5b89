"""Structures that nothing loads but the live load."""

from dataclasses import replace

import pytest
from stones import model_of, portal_stones

import limitblocks as lb

FT, DEPTH, WIDTH, HEIGHT, PUSH = 1e5, 0.5, 1.0, 2.0, 1e3  # tension, Pa; legs, m; live load, N
GLUED = lb.OrdunaLourenco(0.6, cohesion=1e5, tensile_strength=FT)


def weightless(joint):
    stones = [lb.Block(b.name, b.vertices, b.faces, unit_weight=0.0) for b in portal_stones()]
    push = lb.loads.force("lintel", (PUSH, 0, 0), at=(0, 0, 2.2))
    return lb.Model(stones, ["ground"], lb.find_interfaces(stones, joint), lb.self_weight(), push)


@pytest.mark.parametrize("analysis", [lb.nonassociated, lb.load_path])
@pytest.mark.parametrize("joint", [lb.OrdunaLourenco(0.6), lb.PointContact(0.6)])
def test_that_friction_alone_holds_no_weightless_structure_is_said(analysis, joint):
    with pytest.raises(lb.errors.ModelError, match=r"no dead load .* give unit weights"):
        analysis(weightless(joint))


@pytest.mark.parametrize("analysis", [lb.bounds, lb.nonassociated, lb.load_path])
def test_a_weightless_portal_stands_by_the_tension_of_its_joints(analysis):
    moment = FT * DEPTH * WIDTH * DEPTH / 2.0  # of each of four hinges, about its edge
    expected = 4.0 * moment / HEIGHT / PUSH
    assert analysis(weightless(GLUED)).load_factor == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("share", [1e-10, 1e-12])
def test_joints_too_strong_for_digits_end_in_an_error_of_the_library(share):
    strong = lb.OrdunaLourenco(0.6, cohesion=1e5, compressive_strength=5e6)
    model = model_of(portal_stones(), ["ground"], strong)
    light = replace(model, dead=share * lb.self_weight())
    try:
        found = lb.bounds(light)
    except lb.errors.SolverFailure:
        return
    rocking = (2 * 20 * 0.25 + 24 * 0.5) / (2 * 20 * 1.0 + 24 * 2.0)  # kN, m: legs and lintel
    assert found.load_factor == pytest.approx(rocking * share, rel=1e-3)


def test_dead_loads_near_the_least_number_end_in_an_error_of_the_library():
    model = model_of(portal_stones(), ["ground"], lb.OrdunaLourenco(0.6))
    faint = replace(model, dead=1e-300 * lb.self_weight())
    with pytest.raises(lb.errors.SolveError):
        lb.nonassociated(faint)


def stones(height):
    """A stone with `height` others of no weight on it, pushed along x: it slides at its friction, 0.6."""
    box, z = lb.Block.box, 0.75
    light = [box(f"light {k}", (0.8, 0.8, 0.5), (0.1, 0, z + 0.5 * k), 0.0) for k in range(height)]
    return [box("ground", (4, 4, 0.3), (0, 0, -0.15)), box("stone", (1, 1, 0.5), (0, 0, 0.25), 2e4), *light]


@pytest.mark.parametrize("joint", [lb.OrdunaLourenco(0.6), lb.PointContact(0.6), GLUED])
@pytest.mark.parametrize("analysis", [lb.nonassociated, lb.load_path, lb.stability, lb.load_factor_range])
def test_blocks_that_carry_nothing_are_named(analysis, joint):
    """Nothing measures them: the elastic step failed, and whether they stand was undecided."""
    with pytest.raises(lb.errors.ModelError, match=r"nothing acts on light 0, light 1, and one joint"):
        analysis(model_of(stones(2), ["ground"], joint))


@pytest.mark.parametrize("joint", [lb.OrdunaLourenco(0.6), lb.PointContact(0.6)])
def test_bounds_that_solve_do_not_mind_blocks_that_carry_nothing(joint):
    assert lb.bounds(model_of(stones(2), ["ground"], joint)).load_factor == pytest.approx(0.6, rel=1e-6)


def test_blocks_that_carry_nothing_are_named_where_bounds_do_not_solve():
    crushing = lb.OrdunaLourenco(0.6, compressive_strength=1e6)
    with pytest.raises(lb.errors.ModelError, match="nothing acts on light 0, and"):
        lb.bounds(model_of(stones(1), ["ground"], crushing))

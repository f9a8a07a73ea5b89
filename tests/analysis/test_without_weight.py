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

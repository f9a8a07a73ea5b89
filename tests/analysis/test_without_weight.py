"""Structures that nothing loads but the live load."""

from dataclasses import replace

import numpy as np
import pytest
from stones import model_of, portal_stones

import limitblocks as lb
from limitblocks.analysis.falling import falling
from limitblocks.problem import Flow

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


JOINTS = [
    lb.PointContact(0.6),
    lb.OrdunaLourenco(0.6),
    lb.OrdunaLourenco(0.6, slip="paper"),
    lb.OrdunaLourenco(0.6, compressive_strength=1e7),
]


@pytest.mark.parametrize("joint", JOINTS)
@pytest.mark.parametrize("analysis", [lb.bounds, lb.nonassociated])
def test_blocks_that_carry_nothing_change_nothing(analysis, joint):
    """Rounding was all there was to measure them by: no stresses of their joint were small beside it."""
    model = model_of(stones(2), ["ground"], joint)
    found = analysis(model)
    assert found.load_factor == pytest.approx(0.6, rel=1e-6)
    assert lb.check_mcp(model, found, tolerance=1e-6).passed


@pytest.mark.parametrize("joint", JOINTS)
def test_a_stone_of_no_weight_on_two_others_changes_nothing(joint):
    box = lb.Block.box
    blocks = [box("ground", (4, 4, 0.3), (0, 0, -0.15)), box("light", (0.8, 0.8, 0.5), (0.5, 0, 0.75), 0.0)]
    blocks += [box(f"stone {x}", (1, 1, 0.5), (x, 0, 0.25), 2e4) for x in (0, 1)]
    assert lb.bounds(model_of(blocks, ["ground"], joint)).load_factor == pytest.approx(0.6, rel=1e-6)


@pytest.mark.parametrize(("bed", "beside"), [(JOINTS[3], JOINTS[0]), (JOINTS[0], JOINTS[3])])
def test_a_stone_of_no_weight_beside_another_changes_nothing(bed, beside):
    """No self-stress holds it: nothing is all that it carries, which solvers do not find but for rounding."""
    box = lb.Block.box
    blocks = [box("ground", (4, 4, 0.3), (0, 0, -0.15)), box("stone", (1, 1, 1), (0, 0, 0.5), 2e4)]
    blocks.append(box("light", (0.5, 0.5, 0.5), (0.75, 0, 0.25), 0.0))
    joints = {"ground|stone": bed, "ground|light": bed, "stone|light": beside}
    model = model_of(blocks, ["ground"], bed)
    model = replace(model, interfaces=[replace(i, joint=joints[i.name]) for i in model.interfaces])
    assert lb.bounds(model).load_factor == pytest.approx(0.6, rel=1e-6)


@pytest.mark.parametrize("joint", JOINTS)
def test_blocks_that_carry_nothing_stand(joint):
    found = lb.stability(model_of(stones(1), ["ground"], joint))
    assert found.kind is lb.results.Standing.STANDS
    assert found.margin >= 0.0


@pytest.mark.parametrize("analysis", [lb.bounds, lb.nonassociated, lb.load_path])
def test_blocks_that_carry_nothing_may_be_glued_on(analysis):
    cohesion = GLUED.cohesion * 1.0 / 1e4  # on 1 m2, over the weight of the stone, 10 kN
    model = model_of(stones(1), ["ground"], GLUED)
    assert analysis(model).load_factor == pytest.approx(0.6 + cohesion, rel=1e-6)


def test_blocks_that_carry_nothing_are_named_where_increments_fail():
    with pytest.raises(lb.errors.NotConverged) as failed:
        lb.load_path(model_of(stones(2), ["ground"], lb.PointContact(0.6)))
    assert any(note.startswith("nothing acts on light 0, light 1, and") for note in failed.value.__notes__)


def test_the_way_is_that_of_the_model_without_what_carries_nothing():
    found, alone = (lb.nonassociated(model_of(stones(k), ["ground"], lb.PointContact(0.6))) for k in (2, 0))
    assert found.how == alone.how
    assert found.load_factor == pytest.approx(0.6, rel=1e-9)
    assert not found.remarks


def test_who_interrupts_on_that_way_is_given_the_state_reached():
    light = lb.Block.box("light", (0.5, 0.5, 0.3), (0, 0, 2.55), 0.0)

    def stop(_):
        raise KeyboardInterrupt

    with pytest.raises(lb.NotConverged, match=r"^interrupted") as failed:
        lb.nonassociated(model_of([*portal_stones(), light], ["ground"], JOINTS[1]), progress=stop)
    assert 0.0 < failed.value.result.load_factor < 0.25  # at which it falls


def test_what_loads_name_is_not_left_out():
    model = model_of(stones(1), ["ground"], lb.PointContact(0.6))
    pair = [lb.loads.force("light 0", (0, 0, down), at=(0.1, 0, 0.75)) for down in (-1.0, 1.0)]
    both = replace(model, dead=lb.self_weight() + pair[0] + pair[1])
    assert lb.nonassociated(both).load_factor == pytest.approx(0.6, rel=1e-6)


@pytest.mark.parametrize("force", [0.0, 1e-8])
def test_a_force_on_a_block_that_nothing_loads_is_no_rounding(force):
    model = model_of(stones(1), ["ground"], lb.OrdunaLourenco(0.6))
    found = lb.bounds(model)
    stresses = found.stress_resultants.copy()
    light = [i.name for i in model.interfaces].index("stone|light 0")
    stresses[light, 2] -= force * 1e4  # N, of the 10 kN of the stone below
    claim = lb.results.Claim(found.load_factor, stresses, dilatancy=float("inf"))
    assert lb.check_mcp(model, claim, tolerance=1e-6).passed == (force == 0.0)


def test_nothing_falls_where_no_loads_act():
    problem = model_of(stones(0), ["ground"], lb.PointContact(0.6)).problem
    with np.errstate(all="raise"):
        assert falling(Flow(problem), np.zeros_like(problem.dead)) is None


@pytest.mark.parametrize(
    ("load", "most"), [((1e4, 0.0, -2e4), np.inf), ((1e4, 0.0, 0.0), 0.0)], ids=["down, too", "along"]
)
def test_the_lower_end_of_what_a_lintel_without_weight_is_pushed_along_is_zero(load, most):
    """Nothing but friction balances a push along, and none is there without a normal force."""
    stones = [
        lb.Block.box("ground", (4, 1, 0.2), (0, 0, -0.1)),
        lb.Block.box("left", (0.5, 1, 2), (-1, 0, 1), 20e3),
        lb.Block.box("right", (0.5, 1, 2), (1, 0, 1), 20e3),
        lb.Block.box("lintel", (2.5, 1, 0.4), (0, 0, 2.2), 0.0),
    ]
    found = lb.find_interfaces(stones, lb.OrdunaLourenco(0.6))
    push = lb.loads.force("lintel", load, (0.0, 0.0, 2.4))
    answer = lb.nonassociated(lb.Model(stones, ["ground"], found, lb.self_weight(), push))
    assert answer.frictionless == 0.0
    assert not answer.unclaimed
    assert 0.0 <= answer.load_factor <= most

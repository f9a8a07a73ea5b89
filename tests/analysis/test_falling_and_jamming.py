"""Structures that fall, or jam, whatever the live load: said in so many words, never as a load factor."""

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from stones import jammed

import limitblocks as lb
from limitblocks import structures
from limitblocks.analysis import stability, unlimited
from limitblocks.analysis.nonassociated import loop

DOWN, UP = (0, 0, -1), (0, 0, 1)
ANALYSES = [lb.bounds, lb.nonassociated, lb.load_path]


def arch(thickness, direction):
    """The least thickness over radius is .107 (Milankovitch 1907)."""
    ring = structures.arch(lb.PointContact(0.5), radius=1.0, thickness=thickness, voussoirs=9)
    return replace(ring, live=lb.mass_proportional(direction))


@pytest.mark.parametrize("analysis", ANALYSES)
@pytest.mark.parametrize("direction", [DOWN, UP])
def test_what_cannot_stand_falls_though_some_load_factor_balances_it(analysis, direction):
    """At load factor -1 (down) or 1 (up) nothing weighs anything: a trivial solution, no collapse."""
    with pytest.raises(lb.errors.NoEquilibrium, match="cannot stand"):
        analysis(arch(0.05, direction))


def test_what_falls_is_proven_by_a_mechanism_after_one_state(monkeypatch):
    """The other 27 states, of further solvers and units, would only suggest it."""
    states, seen = stability._all_states, []
    monkeypatch.setattr(
        stability, "_all_states", lambda *given: (seen.append(one) or one for one in states(*given))
    )
    with pytest.raises(lb.errors.NoEquilibrium, match="cannot stand"):
        lb.bounds(arch(0.05, (1, 0, 0)))
    assert len(seen) == 1


@pytest.mark.parametrize("joint", [lb.PointContact, lb.OrdunaLourenco])
def test_a_smooth_dome_is_proven_to_fall(joint):
    """The solver breaks the flow rule by 1e-6: multipliers are moved to where they follow the rates."""
    model = structures.dome(joint(0.1), radius=2.49, thickness=0.56, courses=5, stones=18)
    with pytest.raises(lb.errors.NoEquilibrium, match="cannot stand"):
        lb.bounds(model)
    answer = lb.stability(model)
    assert answer.kind is lb.results.Standing.FALLS
    assert answer.residuals.worst.value <= 1e-7


def test_the_trivial_solution_of_what_falls_is_refused_by_the_checker():
    model = arch(0.05, DOWN)
    nothing = lb.results.Claim(
        -1.0, [[0.0] * 6 for _ in model.interfaces], generalised_stresses=[0.0] * model.problem.C.shape[0]
    )
    check = lb.check_mcp(model, nothing)
    assert check.residuals["equilibrium"] <= 1e-15
    assert check.residuals["standing"] > 1e-3
    assert not check.passed


def test_more_weight_does_not_end_what_stands():
    with pytest.raises(lb.errors.UnlimitedLoad, match="without limit"):
        lb.bounds(arch(0.25, DOWN))


def test_a_solver_that_says_nothing_of_an_unlimited_load_is_followed_by_the_next(monkeypatch):
    solve, asked = unlimited.solved, []

    def first_silent(program, solver):
        asked.append(solver)
        found = solve(program, solver)
        nothing = tuple(np.full_like(value, np.nan) for value in found.values)
        return found if solver is not asked[0] else replace(found, values=nothing)

    monkeypatch.setattr(unlimited, "solved", first_silent)
    with pytest.raises(lb.errors.UnlimitedLoad, match="without limit"):
        lb.bounds(arch(0.25, DOWN))
    assert len(asked) == 2


@pytest.mark.parametrize("bond", [0.0, 1e4])
def test_a_wall_carries_any_force_from_above_whatever_bonds_it(bond):
    """Nothing crushes; the bond may help to carry the weights, of which a little stands beside the force."""
    joint = lb.OrdunaLourenco(0.6, cohesion=bond, tensile_strength=bond)
    wall = structures.wall(joint, length=1.2, courses=4)
    with pytest.raises(lb.errors.UnlimitedLoad, match="without limit"):
        lb.bounds(replace(wall, live=lb.loads.top_force((0, 0, -1e3), (0.1, 0))))


def jack_arch():
    """Three voussoirs of a flat arch, whose joints spread upwards, between two walls that do not give way.

    The line of thrust may rise by t = .5 over half the span of 2: .5 is less than the friction.
    """
    edges = np.array([-5, -3, -1, 1, 3, 5]) / 3
    names = ["left", "stone 1", "stone 2", "stone 3", "right"]
    stones = [
        lb.Block.prism(name, [(a, 0), (b, 0), (1.1 * b, 0.5), (1.1 * a, 0.5)], (0, 1), 20e3)
        for name, a, b in zip(names, edges[:-1], edges[1:], strict=True)
    ]
    push = lb.loads.force("stone 2", (0, 0, -1e3), (0, 0.5, 0.5))
    found = lb.find_interfaces(stones, lb.PointContact(0.7))
    return lb.Model(stones, ["left", "right"], found, lb.self_weight(), push)


def test_what_jams_has_no_load_factor_that_is_none():
    """Thrust lines inside the stones carry any load, none slides: no number, and no upper end of one."""
    model = jack_arch()
    with pytest.raises(lb.errors.UnlimitedLoad, match="without limit"):
        lb.bounds(model)
    means = [lb.settings.Means(lb.settings.Barrier(), seed=0, budget=40)]
    for analysis, settings in (
        (lb.nonassociated, {"means": means}),
        (lb.load_path, {"settings": lb.settings.Settings(budget=60)}),
    ):
        with pytest.raises(lb.NotConverged, match=r"without limit .* need not exist") as caught:
            analysis(model, **settings)
        assert "load factor " not in str(caught.value).replace("bounds the load factor,", "")
        assert "load factor none found" in str(caught.value.result)
        assert caught.value.result.associated == np.inf


def test_where_the_load_is_limited_an_open_end_keeps_its_load_factor():
    wall = structures.ferris_tin_loi_wall(1, lb.PointContact(0.65))
    means = [lb.settings.Means(lb.settings.Barrier(), seed=0, budget=1)]
    with pytest.raises(lb.NotConverged, match=r"no solution within .*, load factor \d") as caught:
        lb.nonassociated(wall, means=means)
    assert "without limit" not in str(caught.value)


@pytest.mark.parametrize("analysis", [lb.nonassociated, lb.load_path])
def test_a_column_under_more_of_its_own_weight_is_refused_without_a_search(monkeypatch, analysis):
    """Normal forces alone carry it, so that no mechanism of any flow rule does positive work."""
    monkeypatch.setattr(loop, "first_to_solve", None)
    monkeypatch.setattr("limitblocks.analysis.nonassociated.load_path.loaded", None)
    model = replace(structures.ferris_tin_loi_wall(1, lb.PointContact(0.6)), live=lb.mass_proportional(DOWN))
    with pytest.raises(lb.errors.UnlimitedLoad, match="normal forces alone balance it"):
        analysis(model)


def test_bounds_send_to_the_other_analysis_only_where_it_can_answer():
    """Pressed down, normal forces carry any load; between floor and ceiling only what dilates is stuck."""
    column = replace(structures.ferris_tin_loi_wall(1, lb.PointContact(0.6)), live=lb.mass_proportional(DOWN))
    with pytest.raises(
        lb.errors.UnlimitedLoad, match="the non-associated analysis has no load factor either"
    ):
        lb.bounds(column)
    stuck = jammed(lb.OrdunaLourenco(0.6))
    with pytest.raises(lb.errors.UnlimitedLoad, match="or use the non-associated analysis"):
        lb.bounds(stuck)
    assert lb.nonassociated(stuck).load_factor > 0.0


def test_lifted_blocks_part_where_their_weight_is_gone():
    """Upwards the live load takes the weight away: at load factor 1 the top block floats."""
    found = lb.bounds(arch(0.25, UP))
    assert found.lower == pytest.approx(1.0, rel=1e-6)
    assert found.upper == pytest.approx(1.0, rel=1e-6)


@pytest.mark.parametrize("friction", [1e3, 1e8])
@pytest.mark.parametrize("kind", [lb.PointContact, lb.OrdunaLourenco])
def test_a_block_that_cannot_slide_rocks(kind, friction):
    model = structures.block(kind(friction), width=0.5, height=1.0)
    assert lb.bounds(model).lower == pytest.approx(0.5, rel=1e-6)
    assert lb.nonassociated(model).load_factor == pytest.approx(0.5, rel=1e-6)


OF_A_ROCKING_BLOCK = """
import cvxpy as cp
from limitblocks.analysis.programs import SOLVERS, Program, solved

a, x = cp.Variable(), cp.Variable(4)
two = x[2] + x[3]
balance = [6.56e-4 * a + 5.2e5 * two == 0, x[0] + x[1] == -1.344, 3.4e5 * x[1] + 6.8e5 * two == 0]
within = [-x[0] >= 0, -x[1] >= 0, -x[3] >= 0, x[3] >= 0, 6.7 - x[2] >= 0, 6.7 + x[2] >= 0]
program = Program(cp.Problem(cp.Minimize(-a), [*balance, *within]), (a, x))
load_factor, _ = solved(program, SOLVERS[-1]).values
assert abs(load_factor) < 1e-6  # x[2] = -x[1] / 2 >= 0
"""


def test_a_linear_program_of_unlike_sizes_does_not_end_the_process():
    """The block at the end of its capacity curve: presolved, HiGHS ended in "double free or corruption"."""
    subprocess.run([sys.executable, "-c", OF_A_ROCKING_BLOCK], check=True)


@pytest.mark.parametrize("bond", [1e6, 1e9])
def test_a_load_path_that_strengths_end_is_followed_however_far_it_climbs(bond):
    """Floor and ceiling of 1 m2 each hold the block by their bond: 2 c A + mu W, W = 20 kN."""
    path = lb.load_path(jammed(lb.OrdunaLourenco(0.3, cohesion=bond, tensile_strength=bond)))
    assert path.load_factor == pytest.approx(2 * bond / 20e3, rel=0.01)


def test_a_structure_that_stands_has_no_load_factor_below_zero(tmp_path):
    """Stones between walls, pressed down: they move only where the live load holds them up."""
    lower, upper = [-1.0, -0.4, 0.0, 0.5, 1.0], [-1.2, -0.6, -0.1, 0.5, 1.1]
    feet, heads = [-2.0, *lower, 2.0], [-2.0, *upper, 2.0]
    stones = [
        lb.Block.prism(f"stone {k}", [(a, 0), (b, 0), (d, 0.9), (c, 0.9)], (0, 1), 20e3)
        for k, (a, b, c, d) in enumerate(zip(feet[:-1], feet[1:], heads[:-1], heads[1:], strict=True))
    ]
    found = lb.find_interfaces(stones, lb.PointContact(0.5))
    push = lb.mass_proportional((-0.3, 0.0, -1.0))
    model = lb.Model(stones, ["stone 0", "stone 5"], found, lb.self_weight(), push)
    assert lb.stability(model).stands
    with pytest.raises(lb.NotConverged, match=r"without limit .* need not exist") as caught:
        lb.nonassociated(model)
    result = caught.value.result
    assert not result.accepted
    assert "load factor none found" in str(result)
    if lb.check_mcp(model, result).passed:
        assert result.load_factor < 0.0
        assert result.status is lb.results.Status.OTHER_WAY
        again = lb.read_result(lb.files.write_result(result, tmp_path / "result.json"), model)
        assert "No certified load factor" in lb.report(model, again, demand=1.0).text


def pushed_aside(joint, live):
    """A stone of 20 kN on the ground, pushed aside by a quarter of its weight, near the joint."""
    ground = lb.Block.box("ground", (4.0, 1.0, 0.2), (0.0, 0.0, -0.1))
    stone = lb.Block.box("stone", (1.0, 1.0, 1.0), (0.0, 0.0, 0.5), 20e3)
    aside = lb.loads.force("stone", (5e3, 0.0, 0.0), at=(0.0, 0.0, 0.02))
    load = lb.loads.force("stone", live, at=(0.0, 0.0, 0.02))
    interfaces = lb.find_interfaces([ground, stone], joint)
    return lb.Model([ground, stone], ["ground"], interfaces, lb.self_weight() + aside, load)


def test_a_stone_that_is_lifted_slides_where_the_message_says():
    """mu (W - a W) = W / 4; lifting does no work on the slip, so that Eq. (55) has no mechanism."""
    model = pushed_aside(lb.OrdunaLourenco(0.3), (0.0, 0.0, 20e3))
    said = rf"load factor {1.0 - 0.25 / 0.3:.6g}, .*; beyond it no stresses within yield balance the loads"
    with pytest.raises(lb.errors.NoSolution, match=said):
        lb.nonassociated(model)


def test_a_stone_that_is_pressed_down_yields_nowhere():
    model = pushed_aside(lb.OrdunaLourenco(0.3), (-2e3, 0.0, -20e3))
    with pytest.raises(lb.errors.NoSolution, match="however large the live load, no joint yields"):
        lb.nonassociated(model)

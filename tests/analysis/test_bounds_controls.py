"""Negative controls: a wrong result is caught by the residual that names it, and is never returned."""

from dataclasses import replace

import cvxpy as cp
import numpy as np
import pytest
from scipy.linalg import null_space

import limitblocks as lb
from limitblocks import structures
from limitblocks.analysis import programs
from limitblocks.evidence.residuals import TOLERANCE, bounds_residuals
from limitblocks.evidence.residuals import worth_of_violations

STATIC, KINEMATIC = {"equilibrium", "yield"}, {"flow", "normalisation", "multipliers", "power"}


@pytest.fixture(params=[lb.OrdunaLourenco(0.6), lb.PointContact(0.6)], ids=["OL", "PC"], scope="module")
def solved(request):
    """A limit problem and its solution as (lower, stresses, upper, rates, multipliers), dimensionless."""
    model = structures.wall(request.param, length=0.8, courses=3, direction=(1, 0.5, 0))
    problem, found = model.problem, lb.bounds(model)
    scales = problem.scales
    free = [k for k, block in enumerate(model.blocks) if block.name not in model.supports]
    rates = found.displacement_rates[free].ravel() / problem.rate_units
    lower, upper = found.lower / scales.load_factor, found.upper / scales.load_factor
    stresses = found.generalised_stresses / problem.stress_units
    return problem, (lower, stresses, upper, rates, found.flow_multipliers / scales.work)


def caught(problem, values):
    return {entry.name for entry in bounds_residuals(problem, *values).above(TOLERANCE)}


def test_the_result_itself_passes(solved):
    problem, values = solved
    assert caught(problem, values) == set()


@pytest.mark.parametrize(
    ("place", "change", "names"),
    [
        (0, lambda v: 1.01 * v, {"equilibrium", "gap"}),
        (1, lambda v: 1.01 * v, {"equilibrium"}),
        (1, lambda v: -v, {"equilibrium", "yield"}),
        (1, np.zeros_like, {"equilibrium"}),
        (2, lambda v: 1.01 * v, {"power", "gap"}),
        (3, lambda v: 1.01 * v, {"flow", "normalisation", "power"}),
        (3, lambda v: -v, {"flow", "normalisation", "power"}),
        (3, np.zeros_like, {"flow", "normalisation", "power"}),
        (4, lambda v: -v, {"flow", "multipliers"}),
        (4, lambda v: 1.01 * v, {"flow"}),
        (4, np.zeros_like, {"flow"}),
    ],
)
def test_each_mutilation_is_named_by_its_residuals(solved, place, change, names):
    problem, values = solved
    mutilated = [change(v) if k == place else v for k, v in enumerate(values)]
    assert caught(problem, mutilated) == names


def test_self_stress_beyond_the_strength_violates_yield_alone(solved):
    problem, (lower, stresses, *others) = solved
    self_stress = null_space(problem.C.T.toarray())[:, 0]
    assert caught(problem, (lower, stresses + 100.0 * self_stress, *others)) == {"yield"}


def test_multipliers_of_no_strain_rate_are_caught_where_they_are_negative(solved):
    problem, (*others, multipliers) = solved
    idle = null_space(problem.F.T.toarray())[:, 0]
    assert caught(problem, (*others, multipliers + 100.0 * idle)) == {"multipliers"}


@pytest.mark.parametrize("nothing", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("place", range(5))
@pytest.mark.filterwarnings("ignore:invalid value:RuntimeWarning")
def test_undefined_numbers_count_as_infinite(solved, place, nothing):
    problem, values = solved
    mutilated = list(values)
    mutilated[place] = np.full_like(values[place], nothing)
    found = bounds_residuals(problem, *mutilated)
    assert found.worst.value == np.inf
    assert caught(problem, mutilated) & ((STATIC | {"gap"}) if place < 2 else (KINEMATIC | {"gap"}))


@pytest.mark.parametrize("joint", [lb.OrdunaLourenco(0.6), lb.PointContact(0.6)], ids=["OL", "PC"])
def test_no_equilibrium_names_exactly_the_blocks_that_fall(joint):
    def stone(name, x, z, length=1.0):
        return lb.Block.box(name, (length, 1.0, 0.5), (x, 0, z), 20e3)

    blocks = [
        lb.Block.box("ground", (8.0, 2.0, 0.2), (0, 0, -0.1)),
        stone("left 1", -2.0, 0.25),
        stone("left 2", -1.8, 0.75),
        stone("left 3", -1.6, 1.25),
        stone("right 1", 2.0, 0.25),
        stone("right 2", 2.2, 0.75),
        stone("right 3", 2.71, 1.25),  # its centroid is 0.01 m outside the stone below
    ]
    interfaces = lb.find_interfaces(blocks, joint)
    model = lb.Model(blocks, ["ground"], interfaces, lb.self_weight(), lb.mass_proportional((-1, 0, 0)))
    with pytest.raises(lb.NoEquilibrium) as caught_error:
        lb.bounds(model)
    assert caught_error.value.blocks == ("right 3",)


@pytest.mark.parametrize("direction", [(1, 0, 0), (-1, 0, 0), (0, 1, 0)])
def test_a_stack_that_leans_too_far_falls_whatever_the_live_load(direction):
    """The harmonic stack just beyond its limit, standing on a stack that stands."""
    model = structures.overhang(lb.PointContact(0.6), count=4, length=1.0, height=0.2, fraction=1.01)
    with pytest.raises(lb.NoEquilibrium, match="block 4"):
        lb.bounds(replace(model, live=lb.mass_proportional(direction)))


def frictionless_slope(direction):
    """A block on a frictionless slope: only a force up the slope holds it."""
    angle = np.arctan2(1.0, 2.0)
    turn = np.array([(np.cos(angle), 0, np.sin(angle)), (0, 1, 0), (-np.sin(angle), 0, np.cos(angle))])
    blocks = [
        lb.Block.box("slope", (4, 1, 0.2), (0, 0, -0.1)).moved(turn, (0, 0, 0)),
        lb.Block.box("block", (1, 1, 0.5), (0, 0, 0.25), 20e3).moved(turn, (0, 0, 0)),
    ]
    interfaces = lb.find_interfaces(blocks, lb.PointContact(0.0))
    return lb.Model(blocks, ["slope"], interfaces, lb.self_weight(), lb.mass_proportional(direction))


@pytest.mark.parametrize("direction", [(1, 0, 0), (0, 1, 0), (-1, 0, 0)])
def test_a_block_on_a_frictionless_slope_has_no_equilibrium(direction):
    with pytest.raises(lb.NoEquilibrium) as caught_error:
        lb.bounds(frictionless_slope(direction))
    assert caught_error.value.blocks == ("block",)


def wrong(change):
    """Solvers that claim success with values that `change` has spoilt."""
    honest = programs._solve

    def solve(program, solver):
        found = honest(program, solver)
        return replace(found, status="optimal", values=tuple(change(v) for v in found.values))

    return solve


@pytest.mark.parametrize(
    "change",
    [
        lambda v: 1.01 * v,
        lambda v: -v,
        np.zeros_like,
        lambda v: v * np.nan,
        lambda v: v + 1e-3,
    ],
    ids=["scaled", "negated", "zero", "nan", "shifted"],
)
@pytest.mark.parametrize("joint", [lb.OrdunaLourenco(0.6), lb.PointContact(0.6)], ids=["OL", "PC"])
def test_a_wrong_answer_of_every_solver_is_refused(monkeypatch, joint, change):
    monkeypatch.setattr(programs, "_solve", wrong(change))
    with pytest.raises(lb.SolverFailure, match="residual"):
        lb.bounds(structures.wall(joint, length=0.8, courses=3))


def test_a_wrong_answer_of_the_first_solver_is_passed_over(monkeypatch):
    model = structures.wall(lb.PointContact(0.6), length=0.8, courses=3)
    expected = lb.bounds(model)
    honest, spoilt = programs._solve, wrong(lambda v: 1.01 * v)
    first = programs.SOLVERS[0]
    monkeypatch.setattr(programs, "_solve", lambda program, s: (spoilt if s is first else honest)(program, s))
    assert lb.bounds(model).lower == pytest.approx(expected.lower, rel=1e-6)


def small_load_factor():
    """A thin arch near collapse: violations of 1e-10 of forces of 20 block weights at 400 points matter."""
    model = structures.arch(lb.PointContact(0.309215), radius=1.0, thickness=0.25, voussoirs=101)
    n = len(model.free_blocks)
    angles = (np.arange(n) + 0.5) * np.pi / n - np.pi / 2
    points = np.column_stack([np.sin(angles), np.zeros(n), np.cos(angles)])
    weight = model.free_blocks[0].weight

    def load(direction):
        forces = [
            lb.force(b.name, weight * np.array(direction), at=p)
            for b, p in zip(model.free_blocks, points, strict=True)
        ]
        return sum(forces, lb.Load())

    return replace(model, dead=load((0.0, 0.0, -1.0)), live=load((1.0, 0.0, 0.0)))


def test_bounds_of_a_small_load_factor():
    """Mirrored, an arch has the same load factor; both pass the default tolerance."""
    model = small_load_factor()
    there, back = lb.bounds(model), lb.bounds(replace(model, live=model.live * -1.0))
    assert there.residuals.worst.value <= TOLERANCE
    assert there.lower == pytest.approx(back.upper, rel=1e-6)
    assert there.lower <= there.upper * (1 + 1e-7)


def test_violations_are_worth_what_they_change(solved):
    """Weak duality, upper >= lower, once the violations are paid for; and before that not."""
    problem, (lower, x, _, u, y) = solved
    assert worth_of_violations(problem, lower, x, u, y) < 1e-6
    rng, gaps = np.random.default_rng(0), []
    for size in np.repeat([1e-6, 1e-3], 10):
        dx, du, dy = (v + size * rng.normal(size=len(v)) for v in (x, u, y))
        gaps.append(problem.g @ dy - problem.dead @ du - lower)
        assert gaps[-1] >= -worth_of_violations(problem, lower, dx, du, dy)
    assert min(gaps) < 0.0


def test_an_exception_of_the_solvers_does_not_reach_the_user(monkeypatch):
    def fail(*_, **__):
        raise cp.SolverError("numbers that no user understands")

    monkeypatch.setattr(cp.Problem, "solve", fail)
    with pytest.raises(lb.SolverFailure) as caught_error:
        lb.bounds(structures.block(lb.PointContact(0.6), width=0.5, height=1.0))
    assert caught_error.value.__cause__ is None


def test_tolerance_is_obeyed():
    with pytest.raises(lb.SolverFailure):
        lb.bounds(structures.wall(lb.PointContact(0.6), length=0.8, courses=3), tolerance=1e-18)

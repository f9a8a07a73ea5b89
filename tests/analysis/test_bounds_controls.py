"""Negative controls: a wrong result is caught by the residual that names it, and is never returned."""

from dataclasses import replace

import clarabel
import cvxpy as cp
import numpy as np
import pytest
from scipy import sparse
from scipy.linalg import null_space
from stones import model_of, sloping

import limitblocks as lb
from limitblocks import structures
from limitblocks.analysis import definite, programs
from limitblocks.evidence.measure import Measure
from limitblocks.evidence.residuals import OF_BOUNDS, bounds_residuals, worth_of_violations
from limitblocks.problem import ASSOCIATED, Flow, State

STATIC, KINEMATIC = {"equilibrium", "yield"}, {"flow", "normalisation", "multipliers", "power"}


JOINTS = [lb.OrdunaLourenco(0.6, slip="paper"), lb.OrdunaLourenco(0.6), lb.PointContact(0.6)]


@pytest.fixture(params=JOINTS, ids=repr, scope="module")
def solved(request):
    """The associated flow of a wall, its solution as a dimensionless state, and the upper bound."""
    model = structures.wall(request.param, length=0.8, courses=3, direction=(1, 0.5, 0))
    problem, found = model.problem, lb.bounds(model)
    rates = found.displacement_rates[model.free].ravel()
    state = State(found.lower, found.generalised_stresses, rates, found.flow_multipliers)
    return Flow(problem, ASSOCIATED), problem.dimensionless(state), found.upper * problem.units.live


def caught(flow, state, upper):
    return {entry.name for entry in bounds_residuals(flow, state, upper).above(OF_BOUNDS)}


def test_the_result_itself_passes(solved):
    assert caught(*solved) == set()


@pytest.mark.parametrize(
    ("part", "change", "names"),
    [
        ("load_factor", lambda v: 1.01 * v, {"equilibrium", "gap", "worth"}),
        ("x", lambda v: 1.01 * v, {"equilibrium", "worth"}),
        ("x", lambda v: -v, {"equilibrium", "yield", "worth"}),
        ("x", np.zeros_like, {"equilibrium", "worth"}),
        ("u", lambda v: 1.01 * v, {"flow", "normalisation", "power", "worth"}),
        ("u", lambda v: -v, {"flow", "normalisation", "power", "worth"}),
        ("u", np.zeros_like, {"flow", "normalisation", "power", "worth"}),
        ("y", lambda v: -v, {"flow", "multipliers", "worth"}),
        ("y", lambda v: 1.01 * v, {"flow", "worth"}),
        ("y", np.zeros_like, {"flow", "worth"}),
    ],
)
def test_each_mutilation_is_named_by_its_residuals(solved, part, change, names):
    flow, state, upper = solved
    assert caught(flow, replace(state, **{part: change(getattr(state, part))}), upper) == names


def test_an_upper_bound_that_its_mechanism_does_not_have(solved):
    flow, state, upper = solved
    assert caught(flow, state, 1.01 * upper) == {"power", "gap"}


def test_self_stress_beyond_the_strength_violates_yield_alone(solved):
    """And what it may be worth: the multipliers of rows that are violated."""
    flow, state, upper = solved
    self_stress = null_space(flow.problem.C.T.toarray())[:, 0]
    violated = replace(state, x=state.x + 100.0 * self_stress)
    assert caught(flow, violated, upper) == {"yield", "worth"}


def test_multipliers_of_no_strain_rate_are_caught_where_they_are_negative(solved):
    flow, state, upper = solved
    idle = null_space(flow.problem.F.T.toarray())[:, 0]
    negative = replace(state, y=state.y + 100.0 * idle)
    assert caught(flow, negative, upper) == {"multipliers", "worth"}


@pytest.mark.parametrize("nothing", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("part", ["load_factor", "x", "u", "y", "upper"])
@pytest.mark.filterwarnings("ignore:invalid value:RuntimeWarning")
@pytest.mark.filterwarnings("ignore:overflow:RuntimeWarning")
def test_undefined_numbers_count_as_infinite(solved, part, nothing):
    flow, state, upper = solved
    if part == "upper":
        upper = nothing
    else:
        state = replace(state, **{part: np.full_like(getattr(state, part), nothing)[()]})
    assert bounds_residuals(flow, state, upper).worst.value == np.inf
    static = STATIC | {"gap"} if part in ("load_factor", "x") else KINEMATIC | {"gap"}
    assert caught(flow, state, upper) & static


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
    model = model_of(blocks, ["ground"], joint, (-1, 0, 0))
    with pytest.raises(lb.errors.NoEquilibrium) as caught_error:
        lb.bounds(model)
    assert caught_error.value.blocks == ("right 3",)


@pytest.mark.parametrize("direction", [(1, 0, 0), (-1, 0, 0), (0, 1, 0)])
def test_a_stack_that_leans_too_far_falls_whatever_the_live_load(direction):
    """The harmonic stack just beyond its limit, standing on a stack that stands."""
    model = structures.overhang(lb.PointContact(0.6), count=4, length=1.0, height=0.2, fraction=1.01)
    with pytest.raises(lb.errors.NoEquilibrium, match="block 4"):
        lb.bounds(replace(model, live=lb.mass_proportional(direction)))


@pytest.mark.parametrize("direction", [(1, 0, 0), (0, 1, 0), (-1, 0, 0)])
def test_a_block_on_a_frictionless_slope_has_no_equilibrium(direction):
    with pytest.raises(lb.errors.NoEquilibrium) as caught_error:
        lb.bounds(sloping(20e3, lb.PointContact(0.0), direction))
    assert caught_error.value.blocks == ("block",)


def wrong(change):
    """Solvers that claim success with values that `change` has spoilt."""

    def solve(program, solver):
        found = programs.solved(program, solver)
        values, duals = (tuple(map(change, part)) for part in (found.values, found.duals))
        return replace(found, status="optimal", values=values, duals=duals)

    return solve


@pytest.mark.parametrize(
    "change",
    [lambda v: 1.01 * v, lambda v: -v, np.zeros_like, lambda v: v * np.nan, lambda v: v + 1e-3],
    ids=["scaled", "negated", "zero", "nan", "shifted"],
)
@pytest.mark.parametrize("joint", [lb.OrdunaLourenco(0.6), lb.PointContact(0.6)], ids=["OL", "PC"])
@pytest.mark.parametrize("module", ["bounds", "stability"])  # the pair of bounds, the dead loads alone
def test_a_wrong_answer_of_every_solver_is_refused_or_mended(monkeypatch, module, joint, change):
    """Newton's method may find the way back to the answer; nothing else may be returned."""
    model = structures.wall(joint, length=0.8, courses=3)
    truth = lb.bounds(model)
    monkeypatch.setattr(f"limitblocks.analysis.{module}.solved", wrong(change))
    try:
        found = lb.bounds(model)
    except lb.errors.SolverFailure as error:
        assert "residual" in str(error) or "CLARABEL optimal" in str(error)  # noqa: PT017
    else:
        assert (found.lower, found.upper) == pytest.approx((truth.lower, truth.upper), rel=1e-6)


def test_a_wrong_answer_of_the_first_solver_is_passed_over(monkeypatch):
    model = structures.wall(lb.PointContact(0.6), length=0.8, courses=3)
    expected = lb.bounds(model)
    spoilt, first = wrong(lambda v: 1.01 * v), programs.SOLVERS[0]

    def solve(program, solver):
        return (spoilt if solver is first else programs.solved)(program, solver)

    monkeypatch.setattr("limitblocks.analysis.bounds.solved", solve)
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
            lb.loads.force(b.name, weight * np.array(direction), at=p)
            for b, p in zip(model.free_blocks, points, strict=True)
        ]
        return sum(forces, lb.loads.Load())

    return replace(model, dead=load((0.0, 0.0, -1.0)), live=load((1.0, 0.0, 0.0)))


def test_bounds_of_a_small_load_factor():
    """Mirrored, an arch has the same load factor; both pass the default tolerance."""
    model = small_load_factor()
    there, back = lb.bounds(model), lb.bounds(replace(model, live=model.live * -1.0))
    assert there.residuals.worst.value <= OF_BOUNDS
    assert there.lower == pytest.approx(back.upper, rel=1e-6)
    assert there.lower <= there.upper * (1 + 1e-7)


def test_violations_are_worth_what_they_change(solved):
    """Weak duality, upper >= lower, once the violations are paid for; and before that not."""
    flow, state, _ = solved
    problem = flow.problem
    assert worth_of_violations(Measure(problem, state)) < 1e-6 * state.load_factor
    rng, gaps = np.random.default_rng(0), []
    for size in np.repeat([1e-6, 1e-3], 10):
        dx, du, dy = (v + size * rng.normal(size=len(v)) for v in (state.x, state.u, state.y))
        gaps.append(problem.g @ dy - problem.dead @ du - state.load_factor)
        assert gaps[-1] >= -worth_of_violations(Measure(problem, State(state.load_factor, dx, du, dy)))
    assert min(gaps) < 0.0


def test_an_exception_of_the_solvers_does_not_reach_the_user(monkeypatch):
    def fail(*_, **__):
        raise cp.SolverError("numbers that no user understands")

    def refuse(*_):
        raise ValueError("numbers that no user understands")

    monkeypatch.setattr(cp.Problem, "solve", fail)
    monkeypatch.setattr(clarabel, "DefaultSolver", refuse)
    with pytest.raises(lb.errors.SolverFailure) as caught_error:
        lb.bounds(structures.block(lb.PointContact(0.6), width=0.5, height=1.0))
    assert caught_error.value.__cause__ is None


def test_tolerance_is_obeyed():
    with pytest.raises(lb.errors.SolverFailure) as caught_error:
        lb.bounds(structures.wall(lb.PointContact(0.6), length=0.8, courses=3), tolerance=1e-18)
    said = str(caught_error.value)
    assert said.startswith("no pair of bounds within 1e-18; the best of ")
    assert said.count("residual") == 1
    assert "verbose" not in said
    assert "Error" not in said


def test_proven_bounds_of_an_accurate_solution_are_returned_although_wider_than_the_tolerance(monkeypatch):
    """A second solution costs many times the first, and its proof takes as much."""

    def repeated(*_):
        raise AssertionError("solved again")

    model = structures.wall(lb.OrdunaLourenco(0.65, slip="paper"), length=6.8, courses=12)
    reference = lb.bounds(model)
    monkeypatch.setattr("limitblocks.analysis.bounds._with_care", repeated)
    asked = reference.proof.width / 3.0
    found = lb.bounds(model, tolerance=asked)
    assert found.proven
    assert max(found.lower, reference.lower) <= min(found.upper, reference.upper)
    assert f"of it apart, more than the tolerance of {asked:g}" in str(found)
    assert "apart" not in str(reference)


@pytest.mark.parametrize("band", [definite.BAND, -1])
def test_numbers_far_apart_and_singular_are_factorised(band, monkeypatch):
    """A block that moves freely, in units of a state: neither is regular without a shift of its own size."""
    monkeypatch.setattr(definite, "BAND", band)
    free = np.ones((2, 2))
    matrix = sparse.block_diag([1e20 * free, 1e-20 * free, 0.0 * free], format="csr")
    right = matrix @ np.arange(6.0)
    solution = definite.solver_of(sparse.csr_array(matrix))(right)
    assert np.abs(matrix @ solution - right) == pytest.approx(0.0, abs=1e-6 * np.abs(right).max())


def test_what_rounding_leaves_indefinite_is_factorised_without_roots():
    matrix = sparse.csr_array(np.array([[1.0, 2.0, 0.0], [2.0, 1.0, 1.0], [0.0, 1.0, 3.0]]))
    assert matrix @ definite.solver_of(matrix)(np.arange(3.0)) == pytest.approx(np.arange(3.0), abs=1e-9)


def test_progress_is_told_of_every_stage():
    model, said = lb.structures.ferris_tin_loi_wall(1, lb.PointContact(0.6)), []
    lb.bounds(model, progress=said.append)
    assert said == ["dead loads", "load factor", "proof"]
    lb.bounds(model, progress=said.append)  # known
    assert len(said) == 3

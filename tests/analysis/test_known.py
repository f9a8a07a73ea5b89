"""What is known of a model is not solved again, and nothing carries it further than it is true."""

import gc
import pickle
import weakref
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import cvxpy as cp
import numpy as np
import pytest
from stones import model_of

import limitblocks as lb
from limitblocks.analysis.direct import Programs
from limitblocks.analysis.nonassociated import least_norm
from limitblocks.analysis.nonassociated.start import bracket
from limitblocks.analysis.stability import dead_load_state
from limitblocks.known import known
from limitblocks.structures.examples import EXAMPLES


def column(push=(1.0, 0.0, 0.0)):
    joint = lb.OrdunaLourenco(friction=0.6)
    stones = [
        lb.Block.box("base", (2.0, 2.0, 0.2), (0, 0, -0.1)),
        lb.Block.box("stone", (0.5, 0.8, 1.0), (0, 0, 0.5), 20e3),
    ]
    return model_of(stones, ["base"], joint, push)


@pytest.fixture
def programs(monkeypatch):
    """Programs that cvxpy, Clarabel or OSQP was asked to solve."""
    solved, solve, directly, permanent = [], cp.Problem.solve, Programs.solved, least_norm.by_planes

    def counted(self, *settings, **named):
        solved.append(self)
        return solve(self, *settings, **named)

    def counted_too(self, *numbers):
        solved.append(self)
        return directly(self, *numbers)

    def counted_as_well(problem, weights):
        solved.append(problem)
        return permanent(problem, weights)

    monkeypatch.setattr(cp.Problem, "solve", counted)
    monkeypatch.setattr(least_norm, "by_planes", counted_as_well)
    monkeypatch.setattr(Programs, "solved", counted_too)
    return solved


@pytest.mark.parametrize("joint", [lb.OrdunaLourenco(0.65), lb.PointContact(0.65)])
@pytest.mark.parametrize(
    "made",
    [
        lambda joint: lb.structures.ferris_tin_loi_wall(3, joint),  # in its plane
        lambda joint: lb.structures.corner(joint, length=1.6, return_length=1.2, courses=3),
    ],
)
def test_the_answer_is_the_same_whatever_was_asked_before(made, joint):
    """The permanent stresses of whichever analysis came first were kept, equal but for rounding."""
    alone = lb.nonassociated(made(joint)).load_factor
    model = made(joint)
    path = lb.load_path(model)
    assert path.tracked == lb.nonassociated(model).load_factor == alone


def test_five_lines_of_the_readme_solve_no_program_twice(programs):
    """Margin and bounds with friction and without; two confirmations. The permanent loads take none."""
    bracket(column())
    of_bounds = len(programs)
    programs.clear()
    model = column()
    stands = lb.stability(model)
    bounds, result = lb.bounds(model), lb.nonassociated(model)
    path = lb.load_path(model)
    check = lb.check_mcp(model, result)
    _ = lb.report(model, stands, bounds, result, path, check).html
    assert check.passed
    solved = 1 + of_bounds + 2  # a confirmation is one program
    assert len(programs) == solved
    assert lb.bounds(model) is bounds
    assert len(programs) == solved


@pytest.mark.parametrize("name", ["eccentric_lintel", "barrel_vault", "cantilever_stair"])
def test_asked_again_the_answer_is_the_same_to_the_last_digit(name):
    """Their stresses are not unique: sums in another order would end at others."""
    model = EXAMPLES[name](lb.OrdunaLourenco(friction=0.7))
    first, again = lb.nonassociated(model), lb.nonassociated(model)
    assert first is not again
    for part in ("load_factor", "generalised_stresses", "displacement_rates", "flow_multipliers"):
        np.testing.assert_array_equal(getattr(first, part), getattr(again, part))


def test_each_tolerance_and_each_model_has_its_own_bounds():
    model, tight = column(), 1e-7
    bounds = lb.bounds(model)
    assert lb.bounds(model, tolerance=tight) is not bounds
    assert lb.bounds(model, tolerance=tight).tolerance == tight
    assert lb.bounds(column()) is not bounds


def test_a_changed_model_starts_without():
    model = column()
    assert lb.bounds(model).lower == pytest.approx(0.5, abs=1e-6)  # b/h along X
    turned = replace(model, live=lb.mass_proportional((0.0, 1.0, 0.0)))
    assert lb.bounds(turned).lower == pytest.approx(0.6, abs=1e-6)  # slides at mu along Y
    assert bracket(turned).associated == lb.bounds(turned).upper


def test_a_pickled_model_carries_nothing(programs):
    model = column()
    lb.nonassociated(model)
    copy = pickle.loads(pickle.dumps(model))
    before = len(programs)
    assert lb.bounds(copy) is not lb.bounds(model)
    assert len(programs) > before


def test_what_is_known_lives_as_long_as_the_model():
    model = column()
    lb.nonassociated(model)
    dies, bounds = weakref.ref(model), weakref.ref(lb.bounds(model))
    problem = weakref.ref(model.problem)
    del model
    gc.collect()
    assert dies() is None
    assert bounds() is None
    assert problem() is None


def test_what_is_known_cannot_be_written_to():
    model = column()
    with pytest.raises(ValueError, match="read-only"):
        dead_load_state(model.problem)[0] = 1.0


def test_what_is_raised_is_not_kept():
    model, tries = column(), []

    def fails():
        tries.append(1)
        raise lb.errors.SolverFailure("on purpose")

    for _ in range(2):
        with pytest.raises(lb.errors.SolverFailure):
            known(model, "nothing", fails)
    assert len(tries) == 2


def test_threads_get_one_answer():
    model = column()
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(lambda _: lb.bounds(model), range(8)))
    assert all(bounds is found[0] for bounds in found)

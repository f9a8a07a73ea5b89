"""The program of one form, solved by Clarabel itself: the answer that cvxpy has; and what a proof solves."""

from dataclasses import replace
from importlib import import_module
from itertools import product
from unittest.mock import Mock

import cvxpy as cp
import numpy as np
import pytest
from stones import leaning_walls, model_of

import limitblocks as lb
from limitblocks import structures
from limitblocks.analysis import certified, forms, limit_state, repair, splitting
from limitblocks.analysis.conic import compiled
from limitblocks.analysis.direct import FIXED, Programs, solution
from limitblocks.analysis.forms import form_of
from limitblocks.analysis.limit_state import programs_of
from limitblocks.analysis.programs import DIRECT, PLANAR, solved, static_program
from limitblocks.analysis.scales import scaled
from limitblocks.problem import Cones

JOINTS = [lb.PointContact(0.6), lb.OrdunaLourenco(0.6)]


def wall(joint, length=1.2, courses=4):
    return structures.wall(joint, length=length, courses=courses, direction=(1.0, 1.0, 0.0))


def facade(joint):
    lengths = {"length": 6.4, "return_length": 3.2}
    return structures.facade(joint, courses=7, openings=(), **lengths)


@pytest.mark.parametrize("joint", JOINTS)
def test_a_form_has_the_answer_of_the_static_program(joint):
    form = form_of(wall(joint).problem)
    state = form.problem.in_problem(Programs(form).limit_state(DIRECT))
    expected = solved(static_program(scaled(form.problem.problem)), DIRECT).values[0]
    assert state.load_factor == pytest.approx(float(expected), rel=1e-8)


@pytest.mark.parametrize("joint", [*JOINTS, lb.OrdunaLourenco(0.6, compressive_strength=2e6, cohesion=1e3)])
@pytest.mark.parametrize("direction", [(1.0, 0.0, 0.0), (1.0, 1.0, 0.0)])  # in its plane, and in space
def test_matrices_are_those_that_cvxpy_hands_over_to_clarabel(joint, direction):
    model = structures.wall(joint, length=1.2, courses=4, direction=direction)
    program = programs_of(model.problem)[0].form.limit().problem
    data, _, _ = program.get_problem_data(cp.CLARABEL)
    here = compiled(program)
    assert here.cones == Cones.of_sizes(data["dims"].nonneg, data["dims"].soc)
    assert abs(here.A - data["A"]).max() == 0.0
    assert here.A.nnz == data["A"].nnz
    assert (here.b == data["b"]).all()
    assert (here.c == data["c"]).all()


def test_an_unlimited_load_has_no_state():
    """A block between two supports that it is pushed against: no mechanism does work against the push."""
    joint = lb.PointContact(0.6)
    blocks = [
        lb.Block.box("floor", (3.0, 1.0, 1.0), (0.0, 0.0, -0.5)),
        lb.Block.box("wall", (1.0, 1.0, 1.0), (1.0, 0.0, 0.5)),
        lb.Block.box("cube", (1.0, 1.0, 1.0), (0.0, 0.0, 0.5), 16.0),
    ]
    model = model_of(blocks, ["floor", "wall"], joint)
    assert not np.isfinite(Programs(form_of(model.problem)).limit_state(DIRECT).load_factor)
    with pytest.raises(lb.errors.UnlimitedLoad):
        lb.bounds(model)


def test_multipliers_of_a_large_facade_need_equations_that_are_hardly_regularised():
    """With what Clarabel adds to the pivots by itself, 1e-8, they lack six times more of the cone."""
    lengths = {"length": 19.2, "return_length": 9.6}
    model = structures.facade(lb.PointContact(0.6), courses=21, openings=(), **lengths)
    programs = programs_of(model.problem)[0]  # of one half: 504 blocks
    p, default = programs.form.problem, {"static_regularization_constant": 1e-8}
    lack = -p.cones.margin(programs.limit_state(DIRECT).y).min()
    by_default = -p.cones.margin(programs.limit_state(DIRECT.having(default)).y).min()
    assert lack < by_default / 3.0


def not_bonded_through():
    """Four walls that lean on each other."""
    joint = lb.OrdunaLourenco(0.7, compressive_strength=2e6)
    return leaning_walls(joint, 2.0, 2.8, 20)


def plain_facade():
    sizes = {"length": 7.2, "courses": 9, "return_length": 3.2, "openings": ()}
    return structures.facade(lb.PointContact(0.3), direction=(1.0, 1.0, 0.0), **sizes)


def test_a_tower_is_proven_with_rates_near_one_and_not_as_it_is(monkeypatch):
    bounds = import_module("limitblocks.analysis.bounds")
    tower = not_bonded_through()
    assert bounds._directly(tower.problem, 1e-6, lambda _: None)[2].width < 1e-6
    monkeypatch.setattr(forms, "with_rates_near_one", scaled)
    assert bounds._directly(not_bonded_through().problem, 1e-6, lambda _: None) is None


def four_walls(courses):
    """Walls that lean on each other where the corner stones of two sides end."""
    return leaning_walls(lb.OrdunaLourenco(0.7), 2.8, 3.6, courses)


@pytest.mark.parametrize(
    "models", [lambda: [plain_facade()], lambda: map(four_walls, (8, 10, 12))], ids=["facade", "four walls"]
)
def test_what_the_first_program_leaves_open_is_proven_by_the_second(models, monkeypatch):
    """Of the towers rounding leaves two open, on one machine other ones than on the next."""
    bounds, left = import_module("limitblocks.analysis.bounds"), []
    for first in (1, 2):
        monkeypatch.setattr(bounds, "programs_of", lambda problem, k=first: programs_of(problem)[:k])
        found = [bounds._directly(model.problem, 1e-6, lambda _: None) for model in models()]
        left.append(sum(one is None or one[2].width >= 1e-6 for one in found))
    assert left[0] > left[1] == 0


def test_a_small_load_factor_is_proven_in_the_units_of_its_solution(monkeypatch):
    """The upper one of three stones slides with the one on ice below it, at the friction of that, 1e-4."""
    stones = [lb.Block.box("floor", (4, 4, 0.3), (0, 0, -0.15))]
    sizes = [(1.0 - 0.1 * k, 1.0 - 0.1 * k, 0.2) for k in range(3)]
    stones += [lb.Block.box(f"{k}", sizes[k], (0, 0, 0.1 + 0.2 * k), 2e4) for k in range(3)]
    found = [*lb.find_interfaces(stones, lb.PointContact(1.0))]
    found[1] = replace(found[1], joint=lb.PointContact(1e-4))
    dead, live = lb.self_weight(), lb.mass_proportional((0.6, 0.8, 0.0))
    bounds = import_module("limitblocks.analysis.bounds")
    monkeypatch.setattr(bounds, "_with_care", None)
    widths = []
    for again in (bounds.in_units_of, lambda *_: ()):
        monkeypatch.setattr(bounds, "in_units_of", again)
        widths.append(lb.bounds(lb.Model(stones, ["floor"], found, dead, live)).proof.width)
    assert widths[0] < 1e-8 < widths[1]


def in_plane_of(joint, courses, length):
    """Pushed along; lengths in stones."""
    return structures.wall(joint, length=0.4 * length, courses=courses)


@pytest.mark.parametrize(
    ("joint", "courses", "length", "other"),
    [
        (lb.OrdunaLourenco(0.65, slip="paper"), 22, 32, 1e-8),  # more rows than stresses
        (lb.PointContact(0.6), 26, 38, 1e-14),  # as many
    ],
)
def test_pivots_that_may_vanish_are_replaced_and_all_others_regularised(joint, courses, length, other):
    """With what suits the other joint the flow rule is satisfied worse."""
    off = []
    programs = programs_of(in_plane_of(joint, courses, length).problem)[0]
    p = programs.form.problem
    for settings in ({}, {"static_regularization_constant": other}):
        state = programs.limit_state(PLANAR.having(settings))
        off.append(np.abs(p.C @ state.u + p.F.T @ state.y).max())
    assert off[0] < off[1] / 4.0


def test_few_walls_in_a_plane_stall():
    """Vanishing pivots by 1e-6 in place of Clarabel's own 2e-7; single walls stall with either."""
    stalled = {2e-7: 0, 1e-6: 0}
    for courses, length, friction in product((10, 14), (10, 14, 18, 26), (0.4, 0.5)):
        joint = lb.OrdunaLourenco(friction, slip="paper")
        form = programs_of(in_plane_of(joint, courses, length).problem)[0].form
        program, chosen = compiled(form.limit().problem), {**form.equations, **PLANAR.settings, **FIXED}
        assert chosen["dynamic_regularization_delta"] == 1e-6
        for pivot in stalled:
            found = solution(program, chosen | {"dynamic_regularization_delta": pivot})
            stalled[pivot] += str(found.status) != "Solved"
    assert stalled[1e-6] < stalled[2e-7]


def test_walls_in_a_plane_are_proven_closer_to_1e_12_than_to_1e_11(monkeypatch):
    """Some five times, on geometric mean: single walls are those that the solver cannot solve to either."""

    def usual_width():
        sizes = ((10, 14), (11, 15), (12, 16), (13, 18))
        walls = [in_plane_of(joint, *size) for joint in JOINTS for size in sizes]
        return np.exp(np.mean(np.log([lb.bounds(wall).proof.width for wall in walls])))

    closer = usual_width()
    monkeypatch.setattr(limit_state, "PLANAR", DIRECT)
    assert closer < min(1e-8, usual_width() / 2.0)


@pytest.mark.parametrize("joint", JOINTS)
def test_what_is_proven_closely_is_not_polished(joint, monkeypatch):
    def polish(*_, **__):
        raise AssertionError("polished")

    monkeypatch.setattr(certified, "polish", polish)
    assert lb.bounds(facade(joint)).proof.width <= 1e-8


@pytest.mark.parametrize("joint", JOINTS)
def test_one_mechanism_opens_the_joints_of_both_proofs(joint, monkeypatch):
    asked, opened = [], repair.Repair.opened

    def counted(self, amount):
        asked.append(amount)
        return opened(self, amount)

    model = wall(joint)
    dead = lb.bounds(model).dead_load_stresses / model.problem.stress_units
    form = form_of(model.problem)
    state = form.problem.in_problem(Programs(form).limit_state(DIRECT))
    monkeypatch.setattr(repair.Repair, "opened", counted)
    _, proof = certified.certified(model.problem, state, dead, close=0.0, patience=1)  # two proofs
    assert proof.complete
    assert len(asked) == 1


@pytest.mark.parametrize(
    ("module", "name", "without"), [(splitting, "RELAXED", 1.0), (certified, "SPARE", 1e-30)]
)
def test_rounds_of_the_splitting_that_a_constant_saves(module, name, without, monkeypatch):
    calls, nearest = [], splitting.Splitting._nearest

    def counted(self, rows, loads):
        calls.append(rows)
        return nearest(self, rows, loads)

    def rounds():
        calls.clear()
        assert lb.bounds(wall(lb.PointContact(0.6), 12.0, 20)).proof.width <= certified.CLOSE
        return len(calls)

    monkeypatch.setattr(splitting.Splitting, "_nearest", counted)
    saving = rounds()
    monkeypatch.setattr(module, name, without)
    assert rounds() > 1.1 * saving


def test_friction_of_next_to_nothing_overflows_without_a_warning():
    mu, h = 9.149273434195618e-293, 1.1335638064158748
    push = (np.cos(4.981481785679262), np.sin(4.981481785679262), 0.0)
    model = structures.column(lb.PointContact(mu), count=2, width=2.0, height=h, depth=0.7, direction=push)
    assert lb.bounds(model).upper < 1e-6


def test_an_accurate_solution_is_not_sought_again_where_only_its_proof_takes_more(monkeypatch):
    """As with 50,000 blocks: accuracy is asked for by the block. Here the tolerance is narrow instead."""
    module = import_module("limitblocks.analysis.bounds")
    again = Mock(side_effect=LookupError)
    monkeypatch.setattr(module, "CLOSE", 0.0)
    monkeypatch.setattr(module, "_with_care", again)
    large = structures.wall(JOINTS[0], length=5.0, courses=10)
    assert lb.bounds(large, tolerance=3e-11).proof.width > 3e-11
    monkeypatch.setattr(module, "PER_BLOCK", 0.0)
    with pytest.raises(LookupError):
        lb.bounds(replace(large), tolerance=3e-11)


@pytest.mark.parametrize("joint", JOINTS)
def test_more_of_the_strict_state_is_taken_where_the_estimate_was_short(joint, monkeypatch):
    monkeypatch.setattr(certified, "NEEDED", certified.RESERVE / 2.0)
    assert lb.bounds(wall(joint)).proven
    monkeypatch.setattr(certified, "ROUNDS", 1)
    assert not lb.bounds(wall(joint)).proven

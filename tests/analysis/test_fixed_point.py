"""Solutions are fixed points of limit analysis with frozen flow; the outer loop alone finds some of them."""

from dataclasses import replace

import cvxpy as cp
import numpy as np
import pytest
from stones import jammed, model_of

import limitblocks as lb
from limitblocks.analysis.in_plane import in_plane
from limitblocks.analysis.nonassociated import each_way, finished, frozen_flow, start
from limitblocks.analysis.nonassociated.closing import closed
from limitblocks.analysis.nonassociated.fixed_point import NearestStresses, fixed_point
from limitblocks.analysis.nonassociated.frozen_flow import fixed_point_change, frozen
from limitblocks.analysis.nonassociated.in_the_plane import plane_of
from limitblocks.analysis.nonassociated.means import Means
from limitblocks.analysis.nonassociated.outer_loop import Rounds, outer_loop
from limitblocks.analysis.nonassociated.path_equations import Barrier
from limitblocks.analysis.nonassociated.path_record import off_load_path
from limitblocks.analysis.nonassociated.start import bracket
from limitblocks.analysis.programs import in_cone
from limitblocks.evidence.residuals import mcp_residuals
from limitblocks.problem import Flow, State, Turning
from limitblocks.problem.plane import Choice

MU = 0.6
FERRIS_TIN_LOI = {1: 0.640, 2: 0.563, 3: 0.356, 4: 0.264}  # (2001), zero dilatancy
JOINTS = [lb.OrdunaLourenco, lb.PointContact]


def flat_block(joint):
    """A block 1 x 1 x 0.5 m: it slides at mu < b/h."""
    stones = [
        lb.Block.box("base", (3.0, 3.0, 0.2), (0, 0, -0.1)),
        lb.Block.box("stone", (1.0, 1.0, 0.5), (0, 0, 0.25), 20e3),
    ]
    return model_of(stones, ["base"], joint)


def lintel(kind):
    return lb.structures.eccentric_lintel(kind(MU), eccentricity=0.1, direction=(1.0, 0.0, 0.0))


def pushed(load_factor):
    """The stresses of the flat block under a push, by statics: V = a W, N = -W, M = a W h/2."""
    problem = flat_block(lb.OrdunaLourenco(MU)).problem
    W, axes = 10e3, flat_block(lb.OrdunaLourenco(MU)).interfaces[0].axes
    force = np.array([load_factor * W, 0.0, -W])  # on the stone
    moment = np.cross([0.0, 0.0, 0.25], force)  # of the loads about the joint
    x = np.concatenate([axes @ force, axes @ moment])
    none = np.zeros(problem.C.shape[1]), np.zeros(len(problem.g))
    for sign in (1.0, -1.0):
        state = problem.dimensionless(State(load_factor, sign * x, *none))
        unbalanced = problem.dead + state.load_factor * problem.live - problem.C.T @ state.x
        if np.abs(unbalanced).max() < 1e-12:
            return Flow(problem), state
    raise AssertionError("not in equilibrium")


@pytest.mark.parametrize("share", [0.25, 0.5, 1.0])
def test_frozen_friction_of_a_block_is_mu_times_its_weight(share):
    """Below mu a round changes the load factor to mu; at mu, the solution, it changes nothing."""
    flow, state = pushed(share * MU)
    assert fixed_point_change(flow, state) == pytest.approx(1.0 / share - 1.0, abs=1e-7)


def test_frozen_rows_are_the_true_ones_at_their_state():
    model = lb.structures.ferris_tin_loi_wall(1, lb.OrdunaLourenco(MU))
    problem, flow = model.problem, Flow(model.problem)
    x = lb.bounds(model).generalised_stresses / problem.stress_units
    at = frozen(flow, x)
    np.testing.assert_allclose(at.F @ x + at.g, problem.F @ x + problem.g, atol=1e-8)
    np.testing.assert_array_equal(at.F.toarray(), flow.matrix(x).toarray())
    x = np.random.default_rng(0).normal(size=len(x))  # not within yield: the nearest that is
    at = frozen(flow, x)
    nearest = problem.cones.nearest(problem.F @ x + problem.g)
    np.testing.assert_allclose(at.F @ x + at.g, nearest, atol=1e-12)


def test_rounding_leaves_no_friction_limit_below_zero(monkeypatch):
    """A stone b = 0.5, h = 1 tips at b/h; the contacts that lift carry a tension of 1e-9."""
    stones = [
        lb.Block.box("base", (3, 3, 0.2), (0, 0, -0.1)),
        lb.Block.box("stone", (0.5, 1, 1), (0, 0, 0.5), 20e3),
    ]
    model = model_of(stones, ["base"], lb.PointContact(0.8))
    found = lb.nonassociated(model)
    assert found.load_factor == pytest.approx(0.5)
    problem, none = model.problem, (np.zeros(6), np.zeros(len(model.problem.g)))
    x = found.generalised_stresses / problem.stress_units
    x = x + 1e-9 * (problem.resultants.toarray()[2] > 0.0) * (np.abs(x) < 1e-6)
    assert (problem.F @ x + problem.g).min() < -1e-10
    monkeypatch.setattr(frozen_flow, "pairs_of_bounds", None)  # the first solve is enough
    assert fixed_point_change(Flow(problem), State(0.5 * problem.units.live, x, *none)) <= 1e-8


@pytest.mark.parametrize("kind", JOINTS)
def test_the_associated_state_is_no_fixed_point(kind):
    """A state within yield at load factor a: frozen at it, the limit load is at least a, here more."""
    model = lb.structures.ferris_tin_loi_wall(4, kind(0.65))
    problem, found = model.problem, lb.bounds(model)
    x = found.generalised_stresses / problem.stress_units
    none = np.zeros(problem.C.shape[1]), np.zeros(len(problem.g))
    state = State(found.lower * problem.units.live, x, *none)
    assert fixed_point_change(Flow(problem), state) > 0.01
    assert fixed_point_change(Flow(problem, 0.65), state) < 1e-6  # but one of its own flow


@pytest.mark.parametrize("kind", JOINTS)
@pytest.mark.parametrize("turning", list(Turning))
def test_every_answer_is_confirmed(kind, turning):
    model = lintel(kind)
    found = lb.nonassociated(model, method="fixed point", turning=turning)
    assert found.fixed_point_change <= 1e-7
    assert f"fixed point within {found.fixed_point_change:.1e}" in str(found)
    assert found.to_dict()["fixed_point_change"] == found.fixed_point_change
    assert found.remarks == off_load_path(found.how)  # and no other


def test_confirmation_of_one_of_many_solutions():
    """Jammed without preload: every load factor from mu on is a solution, and the associated one is none."""
    model = jammed(lb.PointContact(friction=0.3))
    for method in ("path", "fixed point"):
        found = lb.nonassociated(model, method=method)
        assert found.load_factor >= 0.3 - 1e-8
        assert found.fixed_point_change <= 1e-7


def test_confirmation_is_an_option_and_only_of_answers():
    model = flat_block(lb.OrdunaLourenco(MU))
    alone = lb.nonassociated(model, confirm=False)
    assert alone.fixed_point_change is None
    assert "fixed point" not in str(alone)
    wall = lb.structures.ferris_tin_loi_wall(1, lb.OrdunaLourenco(0.65))
    means = [lb.settings.Means(lb.settings.Barrier(), seed=0, budget=1)]
    stopped = lb.nonassociated(wall, means=means, tolerance=1e-18, throw=False)
    assert not stopped.converged
    assert stopped.fixed_point_change is None


@pytest.mark.parametrize(
    ("change", "remark"), [(np.inf, "no solver confirms"), (1e-3, "load factor changes by 1.0e-03")]
)
def test_an_answer_that_is_not_confirmed_says_so(change, remark, monkeypatch):
    monkeypatch.setattr(finished, "fixed_point_change", lambda *_: change)
    found = lb.nonassociated(flat_block(lb.OrdunaLourenco(MU)))
    assert remark in "".join(found.remarks)
    assert remark in str(found)


@pytest.mark.parametrize("number", [1, 4])  # the others in lesson 21
def test_the_loop_alone_finds_the_published_values(number):
    model = lb.structures.ferris_tin_loi_wall(number, lb.OrdunaLourenco(0.65))
    found = lb.nonassociated(model, method="fixed point")
    assert found.load_factor == pytest.approx(FERRIS_TIN_LOI[number], rel=0.01)
    assert found.how.startswith("fixed point, ")
    assert lb.check_mcp(model, found).passed
    assert found.fixed_point_change <= 1e-7
    rounds = [stage for stage in found.history if stage.kind == "fixed point"]
    assert [stage.inner for stage in rounds] == list(range(1, len(rounds) + 1))
    assert [stage.step_size for stage in rounds[:2]] == pytest.approx([0.3, 0.21])


def test_a_load_factor_that_stands_still_is_not_enough():
    """The last round changed the load factor by less than 1e-4; its residuals are far above the tolerance."""
    model = lb.structures.ferris_tin_loi_wall(3, lb.PointContact(0.65))
    found = lb.nonassociated(model, method="fixed point")
    *_, before, last, _ = found.history
    assert abs(last.load_factor / before.load_factor - 1.0) <= 1e-4
    assert max(last.residuals.values()) > 1e-4
    assert found.residuals.worst.value <= 1e-8


def test_a_loop_that_is_not_closed_raises_with_its_best_state():
    with pytest.raises(lb.NotConverged) as stopped:
        lb.nonassociated(lintel(lb.PointContact), method="fixed point", tolerance=1e-30)
    best = stopped.value.result
    assert "not closed" in best.how
    assert not best.converged
    assert len(best.history) > 10


def test_the_loop_starts_where_it_is_told():
    model = lintel(lb.PointContact)
    permanent = lb.bounds(model).dead_load_stresses
    found = [lb.nonassociated(model, method="fixed point", start=start) for start in (None, permanent)]
    first, second = (one.history[0].load_factor for one in found)
    assert abs(second - first) > 1e-3 * first


def test_bounds_that_come_no_closer_are_polished_as_they_are(monkeypatch):
    """Those of an associated flow are solutions; the block slides at its friction."""

    def no_closer(model, tolerance):
        raise lb.errors.SolverFailure(f"no pair of bounds within {tolerance:g}")

    model = flat_block(lb.PointContact(MU))
    bracket(model)
    monkeypatch.setattr(start, "bounds", no_closer)
    found = lb.nonassociated(model, dilatancy=MU)
    assert found.load_factor == pytest.approx(MU)
    assert found.how.startswith("the bounds")


def test_an_unknown_method_is_refused():
    with pytest.raises(lb.ModelError, match="'luck', expected 'path' or 'fixed point'"):
        lb.nonassociated(flat_block(lb.PointContact(MU)), method="luck")


def rounds_of(model, **changed):
    """Load factor and residual that the loop ends at with other settings."""
    problem, bounds = model.problem, lb.bounds(model)
    flow, x = Flow(problem), bounds.generalised_stresses / problem.stress_units
    state, _ = outer_loop(flow, x, 1e-8, lambda *_: None, replace(Rounds(), **changed))
    return state.load_factor / problem.units.live, mcp_residuals(flow, state).worst.value


def test_without_rotation_the_loop_ends_far_above_the_published_value():
    model = lb.structures.ferris_tin_loi_wall(4, lb.OrdunaLourenco(0.65))
    with_rotation, worst = rounds_of(model)
    without, worst_without = rounds_of(model, rotation=0.0)
    assert max(worst, worst_without) <= 1e-8  # both are solutions
    assert with_rotation == pytest.approx(FERRIS_TIN_LOI[4], rel=0.01)
    assert without > 1.05 * FERRIS_TIN_LOI[4]


def test_without_cohesion_open_contacts_leave_a_round_without_solution():
    model = lb.structures.ferris_tin_loi_wall(3, lb.PointContact(0.65))
    assert rounds_of(model)[1] <= 1e-8
    assert rounds_of(model, cohesion=0.0)[1] > 1e-3


def test_without_the_two_programs_newtons_method_starts_at_the_frozen_round():
    """The block slides at its friction."""
    load_factor, worst = rounds_of(flat_block(lb.PointContact(MU)), closing=0)
    assert load_factor == pytest.approx(MU)
    assert worst <= 1e-8


@pytest.mark.parametrize(("push", "weight"), [((0.0, 0.0, -1.0), 1.0), ((1.0, 0.0, 0.0), -1.0)])
def test_the_rounds_end_where_a_program_has_no_solution(push, weight):
    """No rates are down into the base, and no stresses hold a block that falls up."""
    problem = replace(flat_block(lb.PointContact(MU)), live=lb.mass_proportional(push)).problem
    problem = replace(problem, dead=weight * problem.dead)
    none = np.zeros(problem.C.shape[1]), np.zeros(len(problem.g))
    start, flow = State(0.0, np.zeros(problem.C.shape[0]), *none), Flow(problem)
    nearest = NearestStresses(problem)
    assert fixed_point(nearest, start, flow, 1e-8, 5) is None
    assert closed(flow, nearest, start, 1e-8) == (start, 1)


def test_what_is_frozen_at_no_stresses_is_not_confirmed():
    flow, state = pushed(MU)
    assert fixed_point_change(flow, replace(state, x=np.full_like(state.x, np.nan))) == np.inf


def portal(friction, push):
    """Mirror planes: the one in which it stands, pushed along, and the one across its span, pushed out."""
    sizes = {"span": 1.6, "pier_width": 0.8, "pier_blocks": 3, "depth": 0.8}
    return lb.structures.portal(lb.PointContact(friction), direction=push, **sizes)


def wedged(model, seed):
    """A state within yield at half the load factor, far from its mirror image, and the mean of both."""
    problem = model.problem
    plane, live = in_plane(problem, Choice.FLOWING), lb.bounds(model).lower * problem.units.live
    x = cp.Variable(problem.C.shape[0])
    far = np.random.default_rng(seed).normal(size=x.size)
    balance = problem.C.T @ x == problem.dead + live / 2.0 * problem.live
    inside = in_cone(problem.F @ x + problem.g, problem.cones)
    cp.Problem(cp.Minimize(cp.sum_squares(x - far)), [balance, *inside]).solve(solver=cp.CLARABEL)
    none = np.zeros(problem.C.shape[1]), np.zeros(len(problem.g))
    mean = plane.stresses @ plane.stresses_of(x.value)
    return plane, *(State(live / 2.0, stresses, *none) for stresses in (x.value, mean))


ACROSS = [(MU, (1.0, 0.0, 0.0), 0), (0.3, (0.0, 1.0, 0.0), 3)]


@pytest.mark.parametrize(("friction", "push", "seed"), ACROSS)
def test_a_state_that_is_not_symmetric_is_judged_in_the_whole_of_a_symmetric_structure(friction, push, seed):
    """Frozen at it the rows are not symmetric, either: its mean with the mirror image gives another value."""
    model = portal(friction, push)
    flow, (plane, state, mean) = Flow(model.problem), wedged(model, seed)
    whole, other = fixed_point_change(flow, state), fixed_point_change(flow, mean)
    assert other - whole > 4e-4
    assert fixed_point_change(flow, state, plane) == pytest.approx(whole, abs=1e-6)
    assert fixed_point_change(flow, mean, plane) == pytest.approx(other, abs=1e-6)


@pytest.mark.parametrize(("friction", "push", "seed"), ACROSS)
def test_only_symmetric_stresses_have_a_plane(friction, push, seed):
    """In whatever units."""
    model = portal(friction, push)
    _, state, mean = wedged(model, seed)
    problem = model.problem.measured(np.linspace(1.0, 7.0, 7) * model.problem.units.block_force)
    x, symmetric = (problem.dimensionless(model.problem.in_si(one)).x for one in (state, mean))
    assert plane_of(model, problem, x) is None
    there = plane_of(model, problem, symmetric)
    np.testing.assert_allclose(there.stresses @ there.stresses_of(symmetric), symmetric, atol=1e-12)


def test_an_outer_loop_that_follows_paths_and_is_interrupted_says_so(monkeypatch):
    """The progress of its first round is where the user stops it; no path is followed before."""

    def press(iteration):
        if iteration.kind == "fixed point":
            raise KeyboardInterrupt

    model = lb.structures.EXAMPLES["groin_vault"](lb.OrdunaLourenco(0.7))
    nothing = Means(Barrier(), 1, 1)
    for way in ("increments", "closed_in_rounds"):
        monkeypatch.setattr(each_way.Given, way, lambda given, *_: (given.start, "nothing"))
    with pytest.raises(lb.NotConverged, match="interrupted") as caught:
        lb.nonassociated(model, means=(nothing, nothing), progress=press)
    assert caught.value.result.status is lb.results.Status.INTERRUPTED


@pytest.mark.parametrize("rounds", [1, 8])
def test_an_outer_loop_alone_that_is_interrupted_leaves_its_best_round(rounds):
    """Each has a lesser residual than the one before, here."""
    model = lb.structures.wall(lb.OrdunaLourenco(0.65), length=1.2, courses=4)
    seen = []

    def press(iteration):
        seen.append(iteration)
        if len(seen) == rounds:
            raise KeyboardInterrupt

    with pytest.raises(lb.NotConverged, match="interrupted: flow residual") as caught:
        lb.nonassociated(model, method="fixed point", progress=press)
    found = caught.value.result
    assert found.status is lb.results.Status.INTERRUPTED
    assert found.load_factor == pytest.approx(min(one.load_factor for one in seen[:rounds]), rel=1e-12)
    assert f"not closed in {rounds} round" in found.how
    assert found.how.endswith("interrupted")

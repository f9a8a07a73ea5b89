"""Forms without multipliers: the same answers as the static program, only where the joints allow it."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from stones import leaning_walls

import limitblocks as lb
from limitblocks import structures
from limitblocks.analysis import splitting
from limitblocks.analysis.conic import compiled
from limitblocks.analysis.direct import FIXED, Programs, solution
from limitblocks.analysis.forms import Rates, Stresses, form_of, without_multipliers
from limitblocks.analysis.in_plane import in_plane
from limitblocks.analysis.interior import carried
from limitblocks.analysis.programs import DIRECT, PLANAR
from limitblocks.analysis.scales import scaled
from limitblocks.analysis.splitting import Splitting
from limitblocks.analysis.stability import _margin, standing_margin
from limitblocks.evidence.residuals import Residuals, static_residuals


@dataclass(frozen=True)
class Guided:
    """A joint of one's own: compression, and no shear by two rows, x >= 0 and -x >= 0."""

    friction: float = 0.0

    def yield_rows(self, polygons, stress_unit=1.0):
        m, rows = len(polygons), lb.PointContact(0.0).yield_rows(polygons, stress_unit)
        F, none = np.tile([(-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)], (m, 1, 1)), np.zeros((m, 3))
        resultants = np.tile(np.eye(6)[:, [2, 0]], (m, 1, 1))
        own = {"F": F, "G": F, "g": none, "pivot": none, "resultants": resultants, "linear": 3, "cones": ()}
        return replace(rows, **own, modes=rows.modes[:1] * 3)


def wall(joint):
    return structures.wall(joint, length=1.2, courses=4, direction=(1.0, 1.0, 0.0)).problem


@pytest.mark.parametrize(
    ("joint", "form"),
    [
        (lb.PointContact(0.6), Rates),
        (lb.PointContact(0.6, points=2), Rates),
        (lb.PointContact(0.0), Rates),
        (lb.PointContact(0.6, cone="inner"), Stresses),  # more planes than stresses
        (lb.OrdunaLourenco(0.6), Stresses),
        (Guided(), Stresses),  # more rows than stresses
    ],
)
def test_multipliers_are_left_out_only_where_the_rates_say_what_they_are(joint, form):
    assert type(form_of(wall(joint))) is form


def test_both_forms_have_the_same_answer():
    p = wall(lb.PointContact(0.6))
    forms = [form_of(p), Stresses(scaled(p))]
    answers = [form.problem.in_problem(Programs(form).limit_state(DIRECT)) for form in forms]
    assert isinstance(forms[0], Rates)
    assert answers[0].load_factor == pytest.approx(answers[1].load_factor, rel=1e-7)
    for z in answers:
        assert p.dead + z.load_factor * p.live == pytest.approx(p.C.T @ z.x, abs=1e-6)
        assert p.C @ z.u == pytest.approx(-p.F.T @ z.y, abs=1e-6)
        assert p.cones.margin(p.F @ z.x + p.g).min() > -1e-6
        assert p.cones.margin(z.y).min() > -1e-6


def test_rates_near_one_take_fewer_iterations():
    p = structures.wall(lb.PointContact(0.6), length=4.0, courses=12, direction=(1.0, 1.0, 0.0)).problem
    taken = []
    for form in (form_of(p), without_multipliers(scaled(p))):
        found = solution(compiled(form.limit().problem), {**form.equations, **DIRECT.settings, **FIXED})
        assert str(found.status) == "Solved"
        taken.append(found.iterations)
    assert taken[0] < taken[1]


def test_multipliers_follow_any_rates_and_share_the_room():
    form = form_of(wall(lb.PointContact(0.6)))
    p = form.problem
    u = np.random.default_rng(1).normal(size=p.C.shape[1])
    y = form.multipliers(u)
    assert p.C @ u == pytest.approx(-p.F.T @ y, abs=1e-12)
    rates, _ = Splitting(p).mechanism(p.cones.identity)
    assert p.cones.margin(form.multipliers(rates)).min() > 0.0  # linear rows, too


def test_equations_without_a_number_are_not_given_to_the_solver():
    """In the plane three of six; loads that no stress balances stay: nothing carries them."""
    p = in_plane(structures.wall(lb.OrdunaLourenco(0.6), length=1.2, courses=4).problem).problem
    program = compiled(Stresses(scaled(p)).limit().problem)
    assert len(program.b) - program.cones.height == 3 * len(p.blocks)
    beside = np.zeros(len(p.dead))
    beside[np.flatnonzero(np.bincount(p.C.indices, minlength=len(beside)) == 0)[0]] = 1.0
    answers = {
        load: Programs(Stresses(scaled(replace(p, **{load: getattr(p, load) + beside})))).limit_state(PLANAR)
        for load in ("dead", "live")
    }
    assert np.isnan(answers["dead"].load_factor)
    assert answers["live"].load_factor == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("joint", [lb.PointContact(0.6), lb.OrdunaLourenco(0.6)])
def test_stresses_strictly_within_yield_carry_the_dead_loads(joint):
    problem = wall(joint)
    x = carried(problem)
    assert Residuals(static_residuals(problem, 0.0, x)).worst.value < 1e-12
    assert problem.cones.margin(problem.F @ x + problem.g).min() > 1e-3


def test_most_of_the_room_that_there_is_is_found(monkeypatch):
    """The splitting ends with a tenth of it or less in a tower of four walls that lean on each other."""
    model = leaning_walls(lb.OrdunaLourenco(0.7), 2.0, 2.8, 10)
    p, most = model.problem, standing_margin(model)
    assert _margin(p, carried(p)) > 0.3 * most
    monkeypatch.setattr(splitting, "FEW", 1000)
    found = scaled(p).stress * Splitting(scaled(p)).stresses()
    assert 0.0 < _margin(p, found) < 0.1 * most


def test_the_mean_of_the_rows_may_be_bounded():
    """With less of them there is less room."""
    p = scaled(wall(lb.OrdunaLourenco(0.6, cohesion=1e3)))
    form, means, rooms = Stresses(p), [], []
    for share in (np.inf, 0.9):
        most = share * means[0] if means else np.inf
        v, _ = Programs(form).solved(form.within(p.dead, most), DIRECT)
        means.append(p.cones.identity @ (p.F @ v[1:] + p.g) / p.cones.degree)
        rooms.append(v[0])
    assert means[1] <= 0.9 * means[0] + 1e-8
    assert rooms[1] < rooms[0] <= 1.0 + 1e-8


def test_next_to_no_room_is_found_by_one_program():
    sizes = {"count": 3, "length": 1.0, "height": 0.3, "fraction": 1.0 - 1e-8}
    problem = structures.overhang(lb.PointContact(0.6), **sizes).problem
    assert Splitting(scaled(problem)).stresses() is None
    assert problem.cones.margin(problem.F @ carried(problem) + problem.g).min() > 0.0


@pytest.mark.parametrize("joint", [lb.PointContact(0.6), lb.OrdunaLourenco(0.6)])
@pytest.mark.parametrize("fraction", [1.0, 1.1])
def test_nothing_is_strictly_within_yield_where_the_stack_is_about_to_fall(joint, fraction):
    """The harmonic stack at its largest overhang (fraction one) stands without any margin."""
    problem = structures.overhang(joint, count=3, length=1.0, height=0.3, fraction=fraction).problem
    x = carried(problem)
    if x is not None:
        assert fraction == 1.0  # no more than rounding
        assert problem.cones.margin(problem.F @ x + problem.g).min() < 1e-12

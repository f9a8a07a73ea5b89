"""Load paths against closed forms: exact ends, a snap with both its ends, and the two ways over it."""

import runpy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

import limitblocks as lb
from limitblocks import structures
from limitblocks.analysis.nonassociated import each_way, loaded, loading, loop
from limitblocks.analysis.nonassociated import increment as increments
from limitblocks.analysis.nonassociated.increment import Increment, Tried
from limitblocks.analysis.nonassociated.permanent import permanent_state
from limitblocks.analysis.nonassociated.stretch import Visit
from limitblocks.problem import Flow
from limitblocks.reports.claims import judged_path
from limitblocks.structures.convex import hull

EXAMPLES = Path(__file__).parents[2] / "examples"
PLUG = runpy.run_path(str(EXAMPLES / "20_a_load_path_that_snaps.py"))
JAMMED = runpy.run_path(str(EXAMPLES / "15_two_right_answers.py"))


def of_plug(**options):
    model = PLUG["plug_in_its_seat"]()
    stiffness = {PLUG["SEAT"]: (PLUG["STIFF"],) * 2, PLUG["JACK"]: (PLUG["SOFT"],) * 2}
    options = {"settings": lb.settings.Settings(growth=2.0)} | options
    return model, lb.load_path(model, start=PLUG["driven_in"](model), stiffness=stiffness, **options)


@pytest.fixture(scope="module", params=["across", "along"])
def snapped(request):
    return request.param, *of_plug(snaps=request.param)


def test_a_block_between_floor_and_ceiling_keeps_the_press_it_starts_with():
    """mu (1 + 2 P/W) with P = W, and it slides without tipping: no barrier adds to P."""
    model = JAMMED["jammed_block"]()
    path = lb.load_path(model, start=JAMMED["at_rest"](model, 1.0))
    assert path.load_factor == pytest.approx(0.3 * 3, rel=1e-9)
    assert path.tracked == pytest.approx(0.3 * 3, rel=1e-5)  # .92 where its barrier does not fade first
    assert path.tracked > 0.3 * 3
    (remark,) = path.remarks
    assert remark.startswith(f"the tracked path of nonassociated ends at {path.tracked:.6g}, ")
    assert remark in str(path)


@pytest.mark.parametrize("options", [{}, {"stiffness": (1e9, 5e8)}])
def test_the_tracked_path_is_that_of_nonassociated(options):
    """In the plane, with the rows that flow: it was that of all rows, .35601 instead of .35586."""
    model = structures.ferris_tin_loi_wall(3, lb.OrdunaLourenco(0.65))
    found = lb.nonassociated(model)
    assert found.how == "tracked path, small barrier, power 1, seed 1, in the plane"
    assert lb.load_path(model, **options).tracked == pytest.approx(found.load_factor, rel=1e-9)


def test_a_tracked_path_that_the_user_stops_is_not_said_to_end_at_no_solution(monkeypatch):
    """The load path is complete by then."""
    first = loop.first_to_solve

    def stopped(*args, **options):
        state, how = first(*args, **options)
        return state, f"{how}, interrupted"

    monkeypatch.setattr(loop, "first_to_solve", stopped)
    path = lb.load_path(structures.wall(lb.OrdunaLourenco(0.6), length=1.2, courses=3))
    assert path.collapse.converged
    assert np.isnan(path.tracked)
    assert path.remarks[0].startswith("the tracked path of nonassociated was stopped by the user")


def test_a_path_that_the_user_stops_has_no_end_to_compare():
    """The difference is that between its first increment and a collapse, not that of two ways there."""

    def press(iteration):
        if iteration.kind == "step":
            raise KeyboardInterrupt

    path = lb.load_path(
        structures.wall(lb.OrdunaLourenco(0.6), length=1.2, courses=3), progress=press, throw=False
    )
    assert path.collapse.status is lb.results.Status.INTERRUPTED
    assert np.isnan(path.tracked)
    assert path.remarks[0].startswith("the user stopped this path")
    assert not any("% off" in remark for remark in path.remarks)


def test_a_path_that_does_not_end_is_not_said_to_end_elsewhere_than_the_tracked_path(monkeypatch):
    """Nor where it is judged anew, as files are."""
    monkeypatch.setattr(loaded, "endless", lambda *_: None)
    model = structures.wall(lb.PointContact(0.65), length=1.2, courses=4)
    path = lb.load_path(model, settings=lb.settings.Settings(budget=90), throw=False)
    assert not path.collapse.accepted
    assert path.tracked == pytest.approx(lb.nonassociated(model).load_factor, rel=1e-9)
    said = f"the tracked path of nonassociated ends at {path.tracked:.6g}; this path has no end to compare"
    assert path.remarks[0] == said
    assert judged_path(model, path).remarks[0] == said


def test_a_wall_leaves_its_loose_buttress_at_b_over_h():
    change = {"length": 2.0, "courses": 6, "buttress_length": 0.8, "bonded": False, "direction": (0, -1, 0)}
    path = lb.load_path(structures.buttressed_wall(lb.PointContact(0.7), **change))
    assert path.load_factor == pytest.approx(0.4 / 2.4, rel=1e-6)
    assert not path.snaps


def test_the_load_of_a_sliding_block_rises_to_friction_in_step_with_its_displacement():
    """Pushed through its contact: a = K d / W up to mu, and mu from there, K the shear stiffness."""
    model = replace(
        structures.block(lb.OrdunaLourenco(0.3), width=1.0, height=0.5),
        live=lb.loads.force("block 1", (1, 0, 0), at=(0, 0, 0)),
    )
    path = lb.load_path(model, stiffness=(1e9, 1e9))
    weight = model.free_blocks[0].weight
    moved, forces = path.curve([block.name for block in model.blocks].index("block 1"), 0)
    np.testing.assert_allclose(forces, np.minimum(1e9 * moved, 0.3 * weight), rtol=1e-5)
    assert path.load_factor == pytest.approx(0.3 * weight, rel=1e-9)
    assert "the same load factor" in path.remarks[0]
    length, work, traced = path.trace.T
    assert (np.diff(length) >= 0.0).all()
    assert np.abs(traced[work < 0.1 * work.max()]).max() <= 0.31 * weight


def test_a_plug_snaps_out_of_its_seat(snapped):
    """By hand, in the example: the greatest force, the weight after the snap, at one place of the jack."""
    _, model, path = snapped
    weight, jack = (block.weight for block in model.free_blocks)
    (snap,) = path.snaps
    greatest = PLUG["greatest"](weight) + jack
    assert snap.before.load_factor == pytest.approx(greatest, rel=2e-5)
    assert snap.after.load_factor == pytest.approx(weight + jack, rel=1e-8)
    lifted = [PLUG["lift"](model, step) for step in (snap.before, snap.after)]
    assert lifted[0] == pytest.approx(lifted[1], rel=1e-9)
    assert path.load_factor == pytest.approx(weight + jack, rel=1e-9)
    assert snap.drop == pytest.approx(snap.before.load_factor - snap.after.load_factor)
    assert path.peak == max(step.load_factor for step in path.steps) >= snap.before.load_factor
    assert all(max(step.residuals.values()) <= 1e-8 for step in path.steps)
    assert lb.check_mcp(model, path.collapse).passed


@pytest.mark.parametrize(
    ("angle", "friction", "press", "shear", "growth"),
    [
        (20, 0.6, 5, 1.0, 1.3),  # without the barrier the displacement goes back beyond the increment
        (20, 0.6, 5, 1.0, 1.4),  # the increment ends before the fold that the barrier makes come early
        (20, 0.6, 5, 1.0, 1.45),  # points far apart where the displacement is that of the fold again
        (30, 0.8, 4, 0.4, 1.7),  # an increment that begins beyond the fold that the barrier makes come early
    ],
)
def test_both_ends_of_a_snap_are_those_by_hand(monkeypatch, angle, friction, press, shear, growth):
    """The formulas of the example, with another seat and other increments."""
    w, k_n, k_s = np.radians(angle), PLUG["STIFF"], shear * PLUG["STIFF"]
    c, s, area = np.cos(w), np.sin(w), PLUG["HEIGHT"] / np.cos(w) * PLUG["DEPTH"]
    seat = lb.OrdunaLourenco(friction)
    changed = {
        "HALF_ANGLE": w,
        "SEAT": seat,
        "press": lambda weight: (press * weight, (2 * press * s - 1) * weight / (2 * c)),
    }
    for name, value in changed.items():
        monkeypatch.setitem(PLUG["driven_in"].__globals__, name, value)
    model = PLUG["plug_in_its_seat"]()
    weight, jack = (block.weight for block in model.free_blocks)
    N0, T0 = changed["press"](weight)
    slides_at = (friction * N0 - T0) / (area * (k_s * c + friction * k_n * s))
    greatest = 2 * area * slides_at * (k_s * c**2 + k_n * s**2) + jack
    path = lb.load_path(
        model,
        start=PLUG["driven_in"](model),
        stiffness={seat: (k_n, k_s), PLUG["JACK"]: (PLUG["SOFT"],) * 2},
        settings=lb.settings.Settings(growth=growth),
    )
    (snap,) = path.snaps
    assert snap.before.load_factor == pytest.approx(greatest, rel=2e-5)
    assert snap.after.load_factor == pytest.approx(weight + jack, rel=1e-8)
    assert len(path.remarks) == 1


class FourFaces:
    """A plug pressed by two pairs of faces: half angles w, areas A, forces N0 and T0, stiffnesses k.

    a, b are its half sides below; the soft pair still holds after the stiff one has slipped.
    """

    a, b, h, friction, w = 0.15, 0.2, 0.4, 0.6, np.radians([20.0, 12.0])
    k, jack_k = np.array([1e9, 1e7]), 1e7
    c, s, t = np.cos(w), np.sin(w), np.tan(w)
    A = h / c * (2 * np.array([b, a]) + h * t[::-1])

    def __init__(self):
        sides = {"left": (-1, 0), "right": (1, 0), "front": (0, -1), "back": (0, 1)}
        corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (0, self.h)]
        blocks = [
            hull("floor", [(x, y, z) for x in (-0.6, 0.6) for y in (-0.6, 0.6) for z in (-0.3, -0.1)]),
            hull("plug", [self.corner(*at) for at in corners], 20e3),
            hull(
                "jack",
                [(x * self.a, y * self.b, z) for x in (-1, 1) for y in (-1, 1) for z in (-0.1, 0)],
                20e3,
            ),
        ]
        for name, out in sides.items():
            face = np.array([self.corner(*at) for at in corners if np.dot(at[:2], out) == 1])
            blocks.append(hull(name, np.concatenate([face, face + 0.5 * np.array([*out, 0])])))
        joints = [lb.OrdunaLourenco(mu) for mu in (self.friction, self.friction + 1e-12, 0.5)]
        self.stiffness = dict(zip(joints, [(k, k) for k in (*self.k, self.jack_k)], strict=True))
        of = {"left": 0, "right": 0, "front": 1, "back": 1, "jack": 2}
        found = [
            i for i in lb.find_interfaces(blocks, joints[0]) if {i.block_i, i.block_j} & {"plug", "jack"}
        ]
        found = [
            replace(i, joint=joints[of[({i.block_i, i.block_j} - {"plug"}).pop()]]) if "plug" in i.name else i
            for i in found
        ]
        push = lb.loads.force("jack", (0, 0, 1), at=(0, 0, -0.05))
        self.model = lb.Model(blocks, ["floor", *sides], found, lb.self_weight(), push)
        self.weight, self.jack = (block.weight for block in self.model.free_blocks)
        self.N0 = np.array([5.0, 3.0]) * self.weight
        self.T0 = (2 * self.N0 * self.s - np.array([self.weight, 0])) / (
            2 * self.c
        )  # the second pair by itself
        self.start = np.zeros((len(found), 6))
        for k, i in enumerate(found):
            (other,) = {i.block_i, i.block_j} - {"plug"} if "plug" in i.name else ("floor",)
            on_j = np.array([0, 0, self.jack]) * (other == "floor")
            if other in sides:
                pair = of[other]
                N, T, c, s = self.N0[pair], self.T0[pair], self.c[pair], self.s[pair]
                out = np.array(sides[other])
                on_j = np.array([*(-out * (N * c + T * s)), N * s - T * c]) * (
                    1 if i.block_j == "plug" else -1
                )
            self.start[k, :3] = -i.axes @ on_j

    def corner(self, x, y, z):
        return x * (self.a + z * self.t[0]), y * (self.b + z * self.t[1]), z

    def force(self, d):
        """Of the jack on the plug that has risen by d."""
        N = np.maximum(self.N0 - self.k * self.A * d * self.s, 0)
        T = np.minimum(self.T0 + self.k * self.A * d * self.c, self.friction * N)
        return self.weight - 2 * (N * self.s - T * self.c).sum()

    def displacement(self, d):
        """Of the jack."""
        return d + self.force(d) / (self.jack_k * 4 * self.a * self.b)


@pytest.mark.parametrize("growth", [1.4])
def test_a_snap_ends_where_what_still_holds_carries_the_push(growth):
    """The stiff pair slips and lets go; the state after is where force and jack of the soft pair meet."""
    by = FourFaces()
    slips = (by.friction * by.N0[0] - by.T0[0]) / (by.A[0] * by.k[0] * (by.c[0] + by.friction * by.s[0]))
    free = by.N0[0] / (by.k[0] * by.A[0] * by.s[0])
    lands = brentq(lambda d: by.displacement(d) - by.displacement(slips), free, 20 * free)
    settings = lb.settings.Settings(growth=growth)
    path = lb.load_path(by.model, start=by.start, stiffness=by.stiffness, settings=settings)
    (snap,) = path.snaps
    plug = [block.name for block in by.model.blocks].index("plug")
    for state, d in ((snap.before, slips), (snap.after, lands)):
        assert state.load_factor == pytest.approx(by.force(d) + by.jack, rel=2e-5)
        assert state.displacements[plug, 2] == pytest.approx(d, rel=2e-4)
    assert path.load_factor == pytest.approx(by.weight + by.jack, rel=1e-9)


def test_a_snap_that_only_the_large_barrier_follows_is_said_to_be_rounded(monkeypatch):
    """And where a load factor that falls cannot be followed with less, the increment stands as it was."""
    follow = increments._pushed

    def lost(path, weights, rho, left, spans):
        return follow(path, weights, rho, left, spans) if spans == increments.SPANS else Tried(None, 1)

    monkeypatch.setattr(increments, "_pushed", lost)
    _, path = of_plug()
    assert path.snaps
    assert path.collapse.converged
    assert "low by some percent" in path.remarks[1]


def test_along_a_snap_the_jack_goes_back(snapped):
    how, model, path = snapped
    places = [k for k, step in enumerate(path.steps) if step.kind.endswith("snap")]
    assert [path.steps[k].kind for k in places] == ["before snap", "after snap"]
    assert path.steps[places[0]] is path.snaps[0].before
    assert path.steps[places[1]] is path.snaps[0].after
    between = path.steps[places[0] + 1 : places[1]]
    assert {step.kind for step in between} == ({"unstable"} if how == "along" else set())
    if how == "along":
        lifts = [PLUG["lift"](model, step) for step in between]
        assert min(lifts) < 0.6 * PLUG["lift"](model, path.snaps[0].before)
    document = path.to_dict()
    assert document["snaps"] == [places]
    assert len(document["trace"]) == len(path.trace)


def test_its_curve_and_its_report_show_the_snap(snapped):
    pytest.importorskip("matplotlib")
    how, model, path = snapped
    ax = lb.plots.load_path(model, path, block="jack", component="Z")
    labels = {text.get_text() for text in ax.get_legend().get_texts()}
    assert {"before snap", "after snap"} <= labels
    assert ("unstable" in labels) == (how == "along")
    assert [line.get_linestyle() for line in ax.lines].count("--") == (how == "across")
    (row,) = (row for row in lb.report(model, path).sections[0].values if row[0] == "Snap")
    assert [float(number) for number in row[1].split(" to ")] == pytest.approx(
        [path.snaps[0].before.load_factor, path.snaps[0].after.load_factor], rel=1e-6
    )


def test_a_snap_longer_than_its_increment_is_met_from_farther_back(monkeypatch):
    """Else the path is lost where it goes back beyond the start of the increment; solved in space here."""
    monkeypatch.setattr("limitblocks.analysis.in_plane.mirror_of", lambda _: None)
    whole = loading.increment
    monkeypatch.setattr(loading, "increment", lambda *args: replace(whole(*args), returned=False))
    _, path = of_plug(throw=False, settings=lb.settings.Settings(growth=2.0, budget=500))
    assert not path.collapse.converged


def test_a_path_that_uses_up_its_budget_says_so_and_which_setting_raises_it():
    """As many factorisations as asked for are not enough to leave the elastic part."""
    settings = lb.settings.Settings(budget=30)
    with pytest.raises(lb.NotConverged) as caught:
        lb.load_path(structures.wall(lb.PointContact(0.65), length=1.2, courses=4), settings=settings)
    assert any("used up their 30 factorisations; Settings(budget=...)" in n for n in caught.value.__notes__)


def test_a_polish_that_leads_elsewhere_is_no_end_of_increments(monkeypatch):
    """Nonassociated took it for one that the load path leads to."""
    monkeypatch.setattr(loading, "polish", lambda _, at: replace(at, load_factor=2.0 * at.load_factor))
    problem = structures.wall(lb.PointContact(0.65), length=1.2, courses=4).problem
    given = each_way.Given(
        Flow(problem), permanent_state(Flow(problem), problem.compliance), 1.0, 1e-8, (met := []).append
    )
    monkeypatch.setattr(each_way, "STEPS", lb.settings.Settings(budget=60))
    state, how = given.increments()
    assert how == "increments of the load path"
    assert state.load_factor / problem.units.live == pytest.approx(met[-1].load_factor)


def test_a_path_whose_increments_fail_says_which_setting_begins_with_larger_ones(monkeypatch):
    """One push without end leads on, and says so; where that finds nothing either, the error does."""
    monkeypatch.setattr(loading, "increment", lambda *_: Tried(None, 1))
    wall = structures.wall(lb.PointContact(0.65), length=1.2, courses=4)
    said = "fail, however small; Settings(first=10)"
    assert any(said in remark for remark in lb.load_path(wall).remarks)
    monkeypatch.setattr(loaded, "endless", lambda *_: None)
    with pytest.raises(lb.NotConverged) as caught:
        lb.load_path(wall)
    assert any(said in note for note in caught.value.__notes__)


def test_a_lintel_whose_end_the_polish_leaves_open_is_closed_by_pivots():
    """Which rows yield at a joint that carries next to nothing is not plain: the flow stays at 1e-4."""
    model = lb.structures.eccentric_lintel(lb.OrdunaLourenco(0.6), eccentricity=0.1, direction=(1, 0, 0))
    path = lb.load_path(model, settings=lb.settings.Settings(growth=2.0))
    assert path.collapse.residuals.worst.value <= 1e-8
    assert path.collapse.frictionless <= path.load_factor <= path.collapse.associated


def test_folds_are_where_the_displacement_turns():
    def visit(tau, forward=True):
        return Visit(None, 1.0 / tau, 0.0, forward)

    there_and_back = [visit(1), visit(2), visit(2.1, False), visit(1.5, False), visit(1.6), visit(3)]
    assert Increment(tuple(there_and_back), None, 1.0, None).folds == ((2, 5),)
    assert Increment((visit(1), visit(2)), None, 1.0, None).folds == ()
    turned_by_rounding = visit(1), visit(2), visit(2.1, False), visit(3, False)  # the displacement grew on
    assert Increment(turned_by_rounding, None, 1.0, None).folds == ()


def test_an_unknown_way_over_snaps_is_refused():
    with pytest.raises(lb.ModelError, match="snaps is 'over', expected 'across' or 'along'"):
        lb.load_path(structures.column(lb.PointContact(0.3), count=1, width=0.6, height=0.25), snaps="over")

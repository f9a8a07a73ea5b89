"""Directions, moving loads and sweeps against closed forms, and what happens to failures."""

import csv
import json
import os
import signal
import sys
from dataclasses import replace
from functools import wraps

import numpy as np
import pytest
from stones import model_of

import limitblocks as lb
from limitblocks import studies
from limitblocks.analysis.nonassociated.means import Means
from limitblocks.analysis.nonassociated.path_equations import Barrier
from limitblocks.evidence.ending import Status
from limitblocks.studies.pool import ANALYSES, INTERRUPTED, in_order
from limitblocks.studies.results import ANSWER, FLOWS

WEIGHT, B1, B2, H = 20e3, 1.0, 1.6, 2.0


def block(joint=None, live=None, width=B1, dead=None):
    blocks = [
        lb.Block.box("ground", (5, 5, 0.2), (0, 0, -0.1)),
        lb.Block.box("block", (width, B2, H), (0, 0, H / 2), WEIGHT / (width * B2 * H)),
    ]
    interfaces = lb.find_interfaces(blocks, joint or lb.PointContact(9.0))
    live = live or lb.mass_proportional((1, 0, 0))
    return lb.Model(blocks, ["ground"], interfaces, dead or lb.self_weight(), live)


def slab(overhang=1.5, half=1.0):
    """A slab on a narrower base: a force P at x > half has the load factor W half / (P (x - half))."""
    blocks = [
        lb.Block.box("ground", (2 * half, 1, 1), (0, 0, -0.5)),
        lb.Block.box("slab", (2 * (half + overhang), 1, 0.2), (0, 0, 0.1), 20e3),
    ]
    return model_of(blocks, ["ground"], lb.PointContact(0.5))


@pytest.mark.parametrize("analysis", ["bounds", "nonassociated"])
def test_rocking_against_direction(analysis):
    """About the nearer edge: min(b1 / (h |cos|), b2 / (h |sin|))."""
    count = 16 if analysis == "bounds" else 4
    series = studies.directions(block(), count, analysis=analysis)
    assert series.angles == pytest.approx(2 * np.pi * np.arange(count) / count)
    with np.errstate(divide="ignore"):
        x, y = B1 / (H * np.abs(np.cos(series.angles))), B2 / (H * np.abs(np.sin(series.angles)))
    assert series.load_factors == pytest.approx(np.minimum(x, y), rel=1e-5)
    assert series.errors == ("",) * count
    assert all(result.displacement_rates.shape == (2, 6) for result in series.results)
    assert series.load_factors[series.least] == pytest.approx(B1 / H, rel=1e-5)


@pytest.mark.parametrize("count", [3, 4, 8, 16])
def test_what_is_carried_between_directions(count):
    """Square to an edge half way between two of n, a block has cos(180 / n) times theirs."""
    half = np.pi / count
    along = lb.loads.compass(2 * count)[1::2]
    series = studies.directions(block(), along)
    every = studies.directions(block(), 72).load_factors
    assert series.between <= every.min() * (1 + 1e-9)
    assert series.between >= np.cos(half) * series.load_factors.min() * (1 - 1e-6)
    if count in (4, 8):  # the edge across X lies between the first and the last
        assert series.load_factors.min() * np.cos(half) == pytest.approx(B1 / H, rel=1e-5)
        assert series.between == pytest.approx(B1 / H, rel=1e-5)
    assert f"; {series.between:.6g} or more between neighbouring directions" in str(series)
    assert series.to_dict()["between"] == series.between


def test_chords_of_the_polar_curve():
    """Of unlimited and of none, and where no two neighbours are less than half a turn apart."""

    def between(factors, angles, convex=True):
        a = np.array(angles) * np.pi / 180
        units = np.stack([np.cos(a), np.sin(a), 0 * a], axis=1)
        own = (None,) * len(a), ("",) * len(a)
        return studies.Directions("bounds", np.array(factors, dtype=float), *own, units, convex).between

    assert between([3.0, 4.0], [0, 90]) == pytest.approx(12 / 5)  # the height of 3, 4, 5
    assert between([4.0, 3.0], [90, 0]) == pytest.approx(12 / 5)
    assert between([1.0, 9.0], [0, 45]) == 1.0  # the chord leads outwards
    assert between([2.0, np.inf], [0, 90]) == 2.0
    assert between([2.0, np.inf], [0, 150]) == pytest.approx(2 * np.sin(np.pi / 6))
    assert between([np.inf, np.inf], [0, 90]) == np.inf
    assert between([0.0, 1.0], [0, 90]) == 0.0
    assert np.isnan(between([1.0, 1.0], [0, 180]))
    assert np.isnan(between([1.0], [0]))
    assert np.isnan(between([1.0, np.nan], [0, 90]))
    assert np.isnan(between([1.0, 1.0], [0, 90], convex=False))


def test_directions_up_and_down():
    series = studies.directions(block(), lb.loads.compass(1, vertical=True))
    assert series.load_factors[1] == pytest.approx(1.0)  # lifted by its own weight
    assert series.load_factors[2] == np.inf
    assert series.errors[2].startswith("UnlimitedLoad: ")
    assert np.isnan(series.angles).tolist() == [False, True, True]
    assert series.results[2] is None


def test_the_line_says_what_the_least_answer_remarks():
    """Pushed along the diagonal Eq. (39) has 1 - n, the triangle of the stress block 1 - 2/3 sqrt(2 n)."""
    n, ground = 0.2, lb.Block.box("ground", (6, 6, 1), (0, 0, -0.5))
    pier = lb.Block.box("pier", (1, 1, 4), (0, 0, 2), 20e3)
    model = model_of([ground, pier], ["ground"], lb.OrdunaLourenco(0.9, compressive_strength=80e3 / n))
    over = (1 - n) / (1 - 2 / 3 * np.sqrt(2 * n))
    assert f"carries {over:.2f} times the moment" in str(studies.directions(model, [(1, 1, 0)]))
    assert "moment" not in str(studies.directions(model, [(1, 0, 0)]))


def test_live_load_that_cannot_be_turned():
    model = block(live=lb.loads.force("block", (1e3, 0, 0), (0, 0, 1)))
    with pytest.raises(lb.ModelError, match="PointForce"):
        studies.directions(model, 4)

    def push(direction):
        return lb.loads.force("block", 1e3 * np.array(direction), (0, 0, H))

    series = studies.directions(model, 4, live=push)
    assert "; other directions may have less" in str(series)  # the load may depend on it in any way
    sides = WEIGHT / (2e3 * H) * np.array([B1, B2, B1, B2])
    assert series.load_factors == pytest.approx(sides, rel=1e-6)


@pytest.mark.parametrize("wrong", [[(1, 0)], [], [(0, 0, 0)], [(np.nan, 0, 0)], "north", 0, True])
def test_wrong_directions_are_refused(wrong):
    with pytest.raises(lb.ModelError):
        studies.directions(block(), wrong)


def test_load_moving_over_a_cantilever():
    places = [(x, 0.0) for x in (0.0, 1.2, 2.0, 2.4, 2.6)]
    series = studies.moving_load(slab(), (0, 0, -1e3), places)
    weight = 20e3 * 5.0 * 0.2
    assert series.load_factors[0] == np.inf
    assert series.load_factors[1:4] == pytest.approx([weight / 1e3 / (x - 1.0) for x in (1.2, 2.0, 2.4)])
    assert np.isnan(series.load_factors[4])
    assert "no free block" in series.errors[4]
    assert series.worst_position == (2.4, 0.0)
    said = (
        "least load factor 14.2857 at x 2.4 m, y 0 m; other places may have less; "
        "1 unlimited; 1 without a model (ModelError: live load"
    )
    assert said in str(series)
    middle = studies.moving_load(slab(), (0, 0, -1e3), [(0.0, 0.0), (0.5, 0.0)])
    assert str(middle) == "2 analyses, no load factor; 2 unlimited"


def test_a_maker_that_fails_on_a_value_costs_its_row():
    """A ValueError of one's own, or of numpy, after hours of rows."""

    def made(friction):
        if friction > 0.5:
            raise ValueError("too rough")
        return block() if friction > 0.4 else 1 / 0

    series = studies.sweep(made, [0.3, 0.45, 0.6])
    assert [error.split(":")[0] for error in series.errors] == ["ZeroDivisionError", "", "ValueError"]
    sampled = lb.study(made, {"friction": (0.35, 0.55)}, 16, sampler="random")
    lost = (sampled.values[:, 0] > 0.5) | (sampled.values[:, 0] <= 0.4)
    assert np.isnan(sampled.load_factors).tolist() == lost.tolist()
    assert 0 < lost.sum() < 16
    with pytest.raises(lb.ModelError, match=r"is given mu .*; it takes friction"):
        lb.study(made, {"mu": (0.35, 0.55)}, 2)


def test_the_user_who_stops_one_analysis_stops_the_study(monkeypatch):
    """The path gives its best state as an error: it was a row without an answer, and the next one began."""
    asked, best = [], replace(lb.nonassociated(block()), status=Status.INTERRUPTED)

    def stopped(model, **_):
        asked.append(model)
        if len(asked) == 2:
            raise lb.NotConverged("interrupted", best)
        return lb.nonassociated(model)

    monkeypatch.setitem(ANALYSES, "nonassociated", stopped)
    series = studies.directions(block(), 4, analysis="nonassociated")
    assert len(asked) == 2
    assert series.errors == ("", *[INTERRUPTED] * 3)
    assert np.isnan(series.load_factors).tolist() == [False, True, True, True]


def test_a_state_that_is_no_solution_is_no_row_with_an_answer(monkeypatch):
    best = replace(lb.nonassociated(block()), status=Status.OUT_OF_STEPS)
    monkeypatch.setitem(ANALYSES, "nonassociated", lambda _model, **_: best)
    series = studies.directions(block(), 1, analysis="nonassociated", throw=False)
    assert np.isnan(series.load_factors).all()
    assert series.errors[0].startswith("NotConverged: not converged")
    assert series.results == (best,)


def test_load_moving_over_an_arch_is_symmetric_and_worst_off_the_crown():
    arch = lb.structures.arch(lb.PointContact(0.8), radius=5.0, thickness=0.8, voussoirs=15)
    x = np.linspace(-4.0, 4.0, 17)
    series = studies.moving_load(arch, (0, 0, -1e3), np.column_stack([x, 0 * x]))
    assert series.load_factors == pytest.approx(series.load_factors[::-1], rel=1e-6)
    assert 0.0 < abs(series.worst_position[0]) < 4.0
    least = lb.Model(
        arch.blocks,
        arch.supports,
        arch.interfaces,
        arch.dead,
        lb.loads.top_force((0, 0, -1e3), series.worst_position),
    )
    assert lb.bounds(least).lower == series.load_factors[series.least]


def test_axles_by_a_function_of_the_place():
    def axles(place):
        return lb.loads.top_force((0, 0, -1e3), place) + lb.loads.top_force((0, 0, -1e3), (place[0] - 0.4, 0))

    series = studies.moving_load(slab(), axles, [(2.4, 0.0)])
    assert series.load_factors == pytest.approx([20e3 / (1e3 * (1.4 + 1.0))])


@pytest.mark.parametrize("wrong", [{"load": (0, 0)}, {"positions": [(0, 0, 0)]}, {"positions": []}])
def test_wrong_moving_load_is_refused(wrong):
    with pytest.raises(lb.ModelError):
        studies.moving_load(**({"model": slab(), "load": (0, 0, -1), "positions": [(0, 0)]} | wrong))


@pytest.mark.parametrize("joint_type", [lb.PointContact, lb.OrdunaLourenco])
def test_sweep_over_friction(joint_type):
    frictions = (0.1, 0.3, 0.5, 0.7)
    series = studies.sweep(lambda mu: block(joint_type(mu)), frictions, parameter="friction")
    assert series.load_factors == pytest.approx([min(mu, B1 / H) for mu in frictions], rel=1e-5)
    assert (series.parameter, series.values) == ("friction", frictions)


def test_one_failure_does_not_lose_the_others():
    """A width that is no width, one that stands, one whose dead load pushes it over."""
    push = lb.self_weight() + lb.loads.force("block", (0.3 * WEIGHT, 0, 0), (0, 0, H / 2))
    done = []
    series = studies.sweep(
        lambda width: block(width=width, dead=push),
        [-1.0, 1.0, 0.5],
        parameter="width",
        progress=lambda k, n: done.append((k, n)),
    )
    assert [error.split(":")[0] for error in series.errors] == ["GeometryError", "", "NoEquilibrium"]
    assert np.isnan(series.load_factors).tolist() == [True, False, True]
    assert series.load_factors[1] == pytest.approx(1.0 / H - 0.3)
    assert done == [(2, 3), (3, 3)]


def test_not_converged_keeps_the_best_state():
    def portal(friction):
        joint = lb.PointContact(friction)
        return lb.structures.portal(joint, span=1.6, pier_width=0.4, pier_blocks=2, depth=0.4)

    series = studies.sweep(portal, [0.6], analysis="nonassociated", means=[Means(Barrier(), 0, 0)])
    assert series.errors[0].startswith("NotConverged: ")
    assert np.isnan(series.load_factors[0])
    assert not series.results[0].converged
    with pytest.raises(lb.SolveError, match="NotConverged"):
        _ = series.least


def test_errors_of_the_maker_that_are_not_ours_are_raised():
    with pytest.raises(KeyError):
        studies.sweep(lambda value: {}[value], [1.0])


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"analysis": "magic"}, "'magic'"),
        ({"workers": 0}, "workers is 0"),
        ({"workers": "2"}, "workers is '2'"),
        ({"values": []}, "no values"),
        ({"parameter": "upper"}, "has the name 'upper' of a column"),  # its values were those of the answer
    ],
)
def test_wrong_study_is_refused(arguments, said):
    with pytest.raises(lb.ModelError, match=said):
        studies.sweep(**({"maker": lambda mu: block(lb.PointContact(mu)), "values": [0.5]} | arguments))


def test_every_column_of_an_answer_is_one_that_no_parameter_may_hide():
    both = [studies.sweep(lambda mu: block(lb.PointContact(mu)), [0.5], analysis=a) for a in FLOWS]
    columns = {name for one in both for name in one.rows()[0]} - {"value"}
    assert columns == set(ANSWER)


def test_processes_give_the_same_rows_in_the_same_order():
    one, two = (studies.directions(block(), 6, workers=workers) for workers in (1, 2))
    assert two.load_factors.tolist() == one.load_factors.tolist()
    assert two.rows() == one.rows()


def _held_back(_place):
    return signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, [])


@pytest.mark.skipif(sys.platform == "win32", reason="Windows blocks no signals")
def test_ctrl_c_is_for_the_process_that_was_asked():
    """Processes that start told of it, each with a traceback."""
    assert all(in_order(_held_back, [(k,) for k in range(3)], 2))
    assert not _held_back(0)


def test_a_process_that_dies_is_our_error():
    with pytest.raises(lb.SolveError, match="process"):
        list(in_order(os._exit, [(1,), (1,)], 2))


def test_rows_as_text_numbers_and_csv(tmp_path):
    series = studies.directions(block(), lb.loads.compass(2, vertical=True))
    table = series.table().splitlines()
    assert table[0].split()[:6] == ["angle,", "rad", "x", "y", "z", "load_factor"]
    assert len(table) == 5
    # the last pushes the block into the ground
    assert table[4].split()[4:8] == ["unlimited", "none", "none", "none"]
    file = series.write_csv(tmp_path / "rows.csv")
    with file.open(newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    assert [float(row["load_factor"]) for row in rows] == series.load_factors.tolist()
    assert "UnlimitedLoad" in rows[3]["error"]
    with pytest.raises(lb.LimitBlocksError, match="exists"):
        series.write_csv(file)
    series.write_csv(file, overwrite=True)
    with pytest.raises(lb.LimitBlocksError, match="cannot write"):
        series.write_csv(tmp_path / "no" / "rows.csv")
    written = json.loads(lb.files.write_result(series, tmp_path / "rows.json").read_text())
    assert (written["study"], written["of"], len(written["rows"])) == ("Directions", "bounds", 4)
    assert written["rows"][0]["load_factor"] == series.load_factors[0]
    assert written["rows"][3]["load_factor"] is None  # JSON has no infinity
    with pytest.raises(lb.ModelError, match="holds a study"):
        lb.read_result(tmp_path / "rows.json")


def test_tables_say_units():
    block = lb.structures.block(lb.PointContact(0.5), width=1.0, height=1.0)
    found = lb.studies.directions(block, 4, workers=1)
    assert found.table().startswith("angle, rad")
    assert " rad, x " in str(found)
    assert "angle" in found.rows()[0]


def test_rows_that_fall_are_told_apart():
    """A force of 1 at 0.6 beside a base of half side 0.5: it falls."""

    def leaning(x):
        if x > 0.8:
            raise lb.ModelError("too far")
        blocks = [lb.Block.box("g", (3, 3, 1), (0, 0, -0.5)), lb.Block.box("c", (1, 1, 1), (0, 0, 0.5))]
        dead, live = lb.loads.force("c", (0, 0, -1.0), (x, 0, 1)), lb.loads.force("c", (1.0, 0, 0), (0, 0, 1))
        return lb.Model(blocks, ["g"], lb.find_interfaces(blocks, lb.PointContact(2.0)), dead, live)

    said = str(studies.sweep(leaning, (0.9, 0.6, 0.0)))
    assert "least load factor 0.5 at value 0; 1 that fall (NoEquilibrium" in said
    assert "1 without a model (ModelError: too far" in said


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ({"dilatancy": "x"}, "dilatancy is 'x', expected a finite number >= 0"),
        ({"dilatancy": -0.1}, r"dilatancy is -0\.1, expected"),
        ({"turning": "here"}, "turning is 'here', expected 'centroid' or"),
        ({"method": "fast"}, "method is 'fast', expected 'path' or"),
        ({"means": ["x"]}, "means holds 'x'"),
        ({"backward_error": -1}, "backward_error is -1, expected a number above 0"),
        ({"start": "there"}, "start is a str"),
        ({"tolerance": 0.0}, r"tolerance is 0\.0, expected a finite number > 0"),
        ({"dilatency": 0.1}, "with nonassociated is given dilatency .*; it takes dilatancy, "),
    ],
)
def test_a_slip_in_a_setting_is_one_error_before_any_row(monkeypatch, setting, words):
    def ran(model, **_):
        raise AssertionError("a row was run")

    monkeypatch.setitem(ANALYSES, "nonassociated", wraps(lb.nonassociated)(ran))
    model, asked = block(), {"analysis": "nonassociated"} | setting
    for run in (
        lambda: studies.directions(model, 2, **asked),
        lambda: studies.moving_load(model, (0.0, 0.0, -1e3), [(0.0, 0.0)], **asked),
        lambda: studies.sweep(lambda mu: block(), [0.3, 0.4], **asked),
        lambda: lb.study(lambda mu: block(), {"mu": (0.3, 0.4)}, 2, **asked),
    ):
        with pytest.raises(lb.ModelError, match=words):
            run()

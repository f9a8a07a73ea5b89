"""Load paths of a plug that its jack presses before any load: snaps that spring back beyond that."""

import runpy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import limitblocks as lb
from limitblocks import structures

PLUG = runpy.run_path(str(Path(__file__).parents[2] / "examples" / "20_a_load_path_that_snaps.py"))
JACK = PLUG["SOFT"] * PLUG["WIDTH"] * PLUG["DEPTH"]  # N/m, of either of its sides


def pressed_plug(monkeypatch, press):
    """A plug that its jack presses before any load: model, and what load_path is to be given of it."""
    model = PLUG["plug_in_its_seat"]()
    soft = [i.name in ("plug|jack", "floor|jack") for i in model.interfaces]
    bedded = (
        replace(i, joint=PLUG["JACK"]) if on else i for i, on in zip(model.interfaces, soft, strict=True)
    )
    model = replace(model, interfaces=tuple(bedded))
    pushed = press * model.free_blocks[0].weight
    monkeypatch.setitem(PLUG["driven_in"].__globals__, "press", lambda weight: pressed(weight, pushed))
    start = PLUG["driven_in"](model)
    start[soft, 2] -= pushed
    stiffness = {PLUG["SEAT"]: (PLUG["STIFF"],) * 2, PLUG["JACK"]: (PLUG["SOFT"],) * 2}
    return model, {"start": start, "stiffness": stiffness}


def pressed(weight, pushed):
    """N0 and T0 of a face."""
    N0, w = 5.0 * weight, PLUG["HALF_ANGLE"]
    return N0, (2.0 * N0 * np.sin(w) + pushed - weight) / (2.0 * np.cos(w))


def slips(model, press):
    """Force of the jack beyond its press, N, and its displacement, m, where the faces begin to slide."""
    N0, T0 = pressed(model.free_blocks[0].weight, press * model.free_blocks[0].weight)
    w = PLUG["HALF_ANGLE"]
    d = (PLUG["MU"] * N0 - T0) / (PLUG["AREA"] * PLUG["STIFF"] * (np.cos(w) + PLUG["MU"] * np.sin(w)))
    g = 2.0 * PLUG["AREA"] * PLUG["STIFF"] * d
    return g, d + g / JACK


def of_pressed_plug(monkeypatch, press, settings):
    """Model, path, and by hand the snap and the steps after it.

    The force of the jack is its press + g where the seat slides at d and it has moved by d + g / k. The floor
    bears press + jack - (k d + g), or nothing where it parts.
    A plug out of its seat bears its weight W alone, whatever the jack does.
    """
    model, given = pressed_plug(monkeypatch, press)
    weight, jack = (block.weight for block in model.free_blocks)
    pushed, k = press * weight, JACK
    g, fold = slips(model, press)
    path = lb.load_path(model, **given, settings=settings)

    def floor(lift):
        return np.maximum(0.0, pushed + jack - k * lift)

    def out_of_seat(lift):
        return weight + jack - floor(lift)

    assert path.load_factor == pytest.approx(weight + jack, rel=1e-9)
    return model, path, pushed + g + jack - floor(fold), out_of_seat, fold


@pytest.mark.parametrize(("press", "growth"), [(2.0, 2.0), (2.5, 1.4), (3.1, 1.4), (1.2, 2.0)])
def test_a_snap_that_springs_back_beyond_the_permanent_loads_is_followed(monkeypatch, press, growth):
    """By up to 18 times the displacement of the fold; the floor parts from the jack of 1.2 W before it."""
    model, path, peak, out_of_seat, place = of_pressed_plug(
        monkeypatch, press, lb.settings.Settings(growth=growth)
    )
    weight = model.free_blocks[0].weight
    (snap,) = path.snaps
    assert len(path.remarks) == 1
    assert snap.before.load_factor == pytest.approx(peak, abs=2e-4 * weight)
    assert PLUG["lift"](model, snap.before) == pytest.approx(place, rel=2e-4)
    assert PLUG["lift"](model, snap.after) == pytest.approx(PLUG["lift"](model, snap.before), rel=1e-6)
    assert path.trace[:, 1].min() < 0.0
    after = [snap.after, *(s for s in path.steps[path.steps.index(snap.after) :] if s.kind == "step")]
    lifts = np.array([PLUG["lift"](model, step) for step in after])
    assert (np.diff(lifts) > 0.0).all()
    factors = [step.load_factor for step in after]
    np.testing.assert_allclose(factors, out_of_seat(lifts), rtol=0, atol=2e-4 * weight)


@pytest.mark.parametrize(("press", "growth", "times"), [(3.2, 2.0, 125), (3.2, 1.4, 125), (3.15, 1.2, 32)])
def test_a_snap_of_a_jack_pressed_harder_is_said_to_be_passed_over(monkeypatch, press, growth, times):
    """It goes back by so many times its fold, until no face presses: the load fell to -3900 N in silence."""
    model, given = pressed_plug(monkeypatch, press)
    fold, weight, k = slips(model, press)[1], model.free_blocks[0].weight, JACK
    free = 5.0 * weight / (PLUG["AREA"] * PLUG["STIFF"] * np.sin(PLUG["HALF_ANGLE"]))
    assert -(free + (weight - press * weight) / k) / fold == pytest.approx(times, rel=0.01)
    path = lb.load_path(model, **given, settings=lb.settings.Settings(growth=growth), throw=False)
    said = [remark for remark in path.remarks if "passed over" in remark or "springs back" in remark]
    assert path.snaps or said
    for remark in said:
        assert "Settings(barrier=1e-6)" in remark


def test_a_facade_that_softens_is_not_said_to_snap():
    """Its load factor falls by .2 and .4 % within one increment, which is lost with less of the barrier."""
    size = {"length": 3.2, "courses": 5, "return_length": 1.6, "openings": [(1.2, 0.0, 0.8, 1.2)]}
    model = structures.facade(lb.PointContact(0.6), **size, direction=(0, 1, 0))
    for settings in (lb.settings.Settings(), lb.settings.Settings(barrier=1e-6)):
        assert len(lb.load_path(model, settings=settings).remarks) == 1


def test_a_smaller_barrier_follows_that_snap(monkeypatch):
    """As the remark says: mu N0 - T0 is left to slip, and the floor bears less by what the jack moves."""
    weight = pressed_plug(monkeypatch, 3.18)[0].free_blocks[0].weight
    settings = lb.settings.Settings(barrier=1e-6)
    _, path, peak, *_ = of_pressed_plug(monkeypatch, 3.18, settings)
    (snap,) = path.snaps
    assert snap.before.load_factor == pytest.approx(peak, abs=2e-4 * weight)
    assert len(path.remarks) == 1


@pytest.mark.parametrize("budget", [200, 400])
def test_a_load_path_that_is_not_followed_ends_at_its_last_step(monkeypatch, budget):
    """It ended at the weight, far from where its increments were used up: the polish alone led there."""
    model, given = pressed_plug(monkeypatch, 3.15)
    settings = lb.settings.Settings(budget=budget)
    path = lb.load_path(model, **given, settings=settings, throw=False)
    assert not path.collapse.converged
    assert path.load_factor == pytest.approx(path.steps[-2].load_factor, rel=1e-3)
    assert f"used up their {budget} factorisations" in path.remarks[-1]
    assert "without limit" not in str(path)
    with pytest.raises(lb.NotConverged) as caught:
        lb.load_path(model, **given, settings=settings)
    assert "without limit" not in str(caught.value)

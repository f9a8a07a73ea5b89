"""Increments of the load path: their first point, points on the way to their end, and those taken back."""

from dataclasses import replace

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.analysis.nonassociated import increment, loading, path_equations
from limitblocks.analysis.nonassociated.increment import Tried


def pushed_out(name, joint, **settings):
    """The load path of a structure of the gallery pushed along Y, and its factorisations."""
    model = replace(lb.structures.EXAMPLES[name](joint), live=lb.mass_proportional((0.0, 1.0, 0.0)))
    path = lb.load_path(model, settings=lb.settings.Settings(**settings), throw=False)
    return path, sum(one.inner for one in path.collapse.history)


def test_points_on_the_way_cost_less_and_lead_to_the_same_end(monkeypatch):
    path, used = pushed_out("cantilever_stair", lb.PointContact(0.7))
    monkeypatch.setattr(path_equations, "LAX", 0.0)
    exact, more = pushed_out("cantilever_stair", lb.PointContact(0.7))
    assert path.load_factor == pytest.approx(exact.load_factor, rel=1e-9)
    assert used < 0.9 * more


def test_products_are_closer_on_the_way_or_a_point_has_no_successor(monkeypatch):
    """The way to the associated load factor, .4714, that bounds prove; else increments fail on it."""
    joint = lb.OrdunaLourenco(0.7, compressive_strength=0.3e6)
    path, _ = pushed_out("arch, fill", joint, budget=400)
    assert path.collapse.converged
    assert path.load_factor == pytest.approx(path.collapse.associated, rel=1e-6)
    monkeypatch.setattr(path_equations, "CLOSER", path_equations.WIDE)
    assert not pushed_out("arch, fill", joint, budget=400)[0].collapse.converged


def test_where_newtons_method_runs_away_a_barrier_that_fades_leads_to_the_first_point(monkeypatch):
    """A column of three cubes overturns at b / h = 1 / 3 both ways."""
    model = lb.structures.column(lb.PointContact(0.7), count=3, width=0.5, height=0.5)
    found = lb.load_path(model)
    assert found.load_factor == pytest.approx(0.5 / 1.5, rel=1e-9)
    centred = increment.centred

    def runs_away(path):
        if path.barrier.power:
            raise np.linalg.LinAlgError("a state ran away")
        return centred(path)

    monkeypatch.setattr(increment, "centred", runs_away)
    again = lb.load_path(model)
    assert again.load_factor == pytest.approx(found.load_factor, rel=1e-9)
    assert again.steps[1].load_factor == pytest.approx(found.steps[1].load_factor, rel=1e-6)


def test_where_every_increment_is_taken_back_the_farthest_is_what_was_reached(monkeypatch):
    """The load path ended at load factor 0, as all of them had been taken back to be pushed once more."""
    push, pushed = loading.increment, []

    def springs_back(*given):
        if len(pushed) == 3:
            return Tried(None, 100, returned=True)
        pushed.append(push(*given))
        return pushed[-1]

    monkeypatch.setattr(loading, "increment", springs_back)
    path, _ = pushed_out("wall", lb.PointContact(0.7))
    assert not path.collapse.converged
    last = pushed[-1].increment.end.load_factor
    assert [step.kind for step in path.steps].count("step") == 3
    assert path.load_factor / path.steps[1].load_factor == pytest.approx(
        last / pushed[0].increment.end.load_factor
    )

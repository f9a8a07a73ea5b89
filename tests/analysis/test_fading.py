"""Points on the way to the end of an increment, where the barrier fades: not as near the path as the end."""

from dataclasses import replace

import pytest

import limitblocks as lb
from limitblocks.analysis.nonassociated import path_equations


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

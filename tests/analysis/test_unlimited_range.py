"""The exact range of a stone that can be wedged without limit, and what the command line prints of it."""

import json
import math
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.analysis.load_factor_range import search


@pytest.fixture(scope="module")
def askew():
    """A stone between two leaning faces, of friction .75 and .34: it jams along X, and no load moves it."""
    left, right = math.tan(0.35), math.tan(0.5)

    def prism(name, outline, unit_weight=None):
        return lb.Block.prism(name, outline, (-0.5, 0.5), unit_weight, along="x")

    blocks = [
        prism("a", [(0, 0), (left, 1), (left + 0.3, 1), (left + 0.3, -0.3), (0, -0.3)]),
        prism("b", [(0, 0), (-right, 1), (-right - 0.3, 1), (-right - 0.3, -0.3), (0, -0.3)]),
        prism("stone", [(0, 0), (left, 1), (-right, 1)], 20e3),
    ]
    found = lb.find_interfaces(blocks, lb.PointContact(0.5, cone="outer", sides=4))
    interfaces = [
        replace(one, joint=lb.PointContact(friction, cone="outer", sides=4))
        for one in found
        for face, friction in (("a", 0.75), ("b", 0.34))
        if {one.block_i, one.block_j} == {face, "stone"}
    ]
    push = lb.mass_proportional((1, 0, 0))
    return lb.Model(blocks, ["a", "b"], interfaces, lb.self_weight(), push)


def test_no_load_factor_is_the_greatest_where_stresses_can_be_added_without_end(askew, tmp_path):
    """Self-stress balances the live load: the limit of the search was called the greatest, and proven."""
    found = lb.load_factor_range(askew, paths=2, mechanisms=0, exact=True)
    assert found.unlimited
    assert found.greatest.load_factor == found.greatest.bound == found.certified[1] == np.inf
    assert str(found.greatest) == "without limit (proven)"
    assert all(one.check.passed and one.load_factor in found for one in found.answers)
    assert found.intervals[-1][1] == np.inf
    assert 1e6 in found
    assert found.least.proven
    assert found.least.load_factor not in (0.0, np.inf)
    again = lb.read_result(found.save(tmp_path / "range.json"), askew)
    assert again.intervals == found.intervals
    assert str(again.greatest) == str(found.greatest)


def test_without_a_ray_nothing_is_proven_of_the_greatest(askew, monkeypatch):
    """What is found up to where the search ends is a solution, and no more."""
    monkeypatch.setattr("limitblocks.analysis.load_factor_range.answers.ray", lambda *_: None)
    found = lb.load_factor_range(askew, paths=1, mechanisms=0, exact=True)
    assert found.greatest.answer.check.passed
    assert not found.greatest.proven
    assert found.greatest.bound == np.inf


def test_the_least_is_never_below_the_bracket_though_time_runs_out(askew, monkeypatch):
    monkeypatch.setattr(search, "exact_extreme", lambda *_: (None, -np.inf, np.inf, 10.0, 0.0))
    found = lb.load_factor_range(askew, paths=1, mechanisms=0, exact=True)
    assert found.least.bound == pytest.approx(max(found.frictionless, 0.0), abs=1e-5)


def test_only_json_is_printed_whatever_a_solver_prints_first(tmp_path):
    """In a process of its own: HiGHS prints its banner once in each, past what Python prints."""
    joint = lb.PointContact(0.5, cone="outer", sides=4)
    file = lb.structures.wedge(joint, half_angle=math.pi / 3).save(tmp_path / "wedge.json")
    words = [sys.executable, "-m", "limitblocks", "range", file, "--exact", "--json", "--paths", "1"]
    done = subprocess.run([*words, "--mechanisms", "0"], capture_output=True, text=True, check=True)
    assert json.loads(done.stdout)["analysis"] == "range"

"""Stresses that arise under the dead loads: the path to them, and where none is needed."""

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.analysis import unstressed
from limitblocks.analysis.nonassociated import permanent
from limitblocks.analysis.nonassociated.permanent import permanent_state
from limitblocks.analysis.unstressed import arising, joint_compliance
from limitblocks.problem import Flow


@pytest.mark.parametrize("first", [0.3, 0.6])
@pytest.mark.parametrize("left", [1e-8, 1e-9, 1e-10])
def test_a_path_that_comes_close_to_its_end_arrives(monkeypatch, first, left):
    """Its last correction goes past the end; from there it looked back along the tangent, and was lost."""
    monkeypatch.setattr(unstressed, "LONG", first)
    size = {"length": 2.4, "return_length": 2.4, "courses": 4}
    problem = lb.structures.corner(lb.OrdunaLourenco(0.3), **size).problem
    assert arising(Flow(problem), joint_compliance(problem), 1e-5, left) is not None


@pytest.mark.parametrize("joint", [lb.PointContact(0.6), lb.OrdunaLourenco(0.6, compressive_strength=3e5)])
def test_what_arises_hardly_depends_on_the_barrier(joint):
    size = {"length": 3.2, "courses": 5, "return_length": 1.6}
    problem = lb.structures.facade(joint, openings=[(1.2, 0.0, 0.8, 1.2)], **size).problem
    flow, W = Flow(problem), joint_compliance(problem)
    found, exact = arising(flow, W, permanent.FIRST[0], permanent.LEFT).x, arising(flow, W).x
    assert np.abs(found - exact).max() < 2e-3 * np.abs(exact).max()


def test_where_the_dead_loads_hardly_stand_a_path_from_a_large_barrier_finds_what_arises():
    """Of three boxes the light uppermost one overhangs by .45 of its length, and falls beyond half of it."""
    blocks = [lb.Block.box("ground", (20.0, 20.0, 1.0), (0.0, 0.0, -0.5))]
    for k, (x, weight) in enumerate(((0.0, 20e3), (0.0, 20e3), (0.45, 20.0))):
        blocks.append(lb.Block.box(f"box {k}", (1.0, 1.0, 1.0), (x, 0.0, k + 0.5), weight))
    joints = lb.find_interfaces(blocks, lb.OrdunaLourenco(0.6))
    push = lb.mass_proportional((1.0, 0.0, 0.0))
    problem = lb.Model(blocks, ["ground"], joints, lb.self_weight(), push).problem
    flow, W = Flow(problem), joint_compliance(problem)
    small, large = (arising(flow, W, first, permanent.LEFT) for first in permanent.FIRST)
    assert small is None
    np.testing.assert_array_equal(permanent_state(flow, problem.compliance), large.x)

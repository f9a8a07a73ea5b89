"""Stresses that arise under the dead loads: the path to them, and where none is needed."""

from dataclasses import replace

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.analysis import stability as answers
from limitblocks.analysis import unstressed
from limitblocks.analysis.in_si import resultants_of
from limitblocks.analysis.nonassociated import permanent
from limitblocks.analysis.nonassociated.path_layout import Layout
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
    found = arising(flow, W, unstressed.SMALL, unstressed.LEAST, along_path=False).x
    exact = arising(flow, W).x
    assert np.abs(found - exact).max() < 2e-3 * np.abs(exact).max()


WEIGHTS, OVERHANG = (20e3, 20e3, 20.0), 0.499


def stacked(beside):
    """Three boxes, the light uppermost one overhanging by .499 of its length; it falls beyond half of it.

    `beside`, a light stone in a row of three that bear two others: these turn, and it yields at its sides.
    """
    places = [(0.0, 0.5, 1.0), (0.0, 1.5, 1.0), (OVERHANG, 2.5, 1.0)]
    weights = list(WEIGHTS)
    if beside:
        places += [(3.0, 0.5, 1.0), (4.0, 0.5, 1.0), (5.0, 0.5, 1.0), (4.6, 1.5, 1.6), (3.3, 1.5, 1.0)]
        weights += [20e3, 2e3, 20e3, 20e3, 5e3]
    blocks = [lb.Block.box("ground", (20.0, 20.0, 1.0), (0.0, 0.0, -0.5))]
    for k, ((x, z, length), weight) in enumerate(zip(places, weights, strict=True)):
        blocks.append(lb.Block.box(f"box {k}", (length, 1.0, 1.0), (x, 0.0, z), weight))
    joints = lb.find_interfaces(blocks, lb.OrdunaLourenco(0.6))
    return lb.Model(blocks, ["ground"], joints, lb.self_weight(), lb.mass_proportional((1.0, 0.0, 0.0)))


def test_where_the_dead_loads_hardly_stand_steps_from_a_small_barrier_find_what_arises():
    problem = stacked(beside=True).problem
    flow, W = Flow(problem), joint_compliance(problem)
    large = arising(flow, W).x
    x = permanent_state(flow, problem.compliance)
    assert np.abs(x - large).max() < 2e-3 * np.abs(large).max()


def test_what_arises_in_a_stair_is_found_by_steps_that_lower_the_barrier_tenfold():
    """Not by steps to .03 of it or less."""
    problem = lb.structures.EXAMPLES["cantilever_stair"](lb.OrdunaLourenco(0.4)).problem
    flow, W = Flow(problem), joint_compliance(problem)
    found = arising(flow, W, unstressed.SMALL, unstressed.LEAST, along_path=False)
    exact = arising(flow, W)
    assert np.abs(found.x - exact.x).max() < 2e-3 * np.abs(exact.x).max()


def test_steps_cost_less_than_a_path_from_the_same_barrier(monkeypatch):
    """Factorisations of what arises in a stair."""
    problem = lb.structures.EXAMPLES["cantilever_stair"](lb.OrdunaLourenco(0.4)).problem
    flow, W, made, used = Flow(problem), joint_compliance(problem), [], {}
    factors = Layout.factors
    monkeypatch.setattr(Layout, "factors", lambda *given: made.append(0) or factors(*given))
    for along_path in (False, True):
        made.clear()
        assert arising(flow, W, unstressed.SMALL, unstressed.LEAST, along_path=along_path) is not None
        used[along_path] = len(made)
    assert used[False] < 0.8 * used[True]


def test_joints_that_nowhere_yield_bear_what_statics_says_without_a_path(monkeypatch):
    """The weights above each joint, and the moment of the light box about the centre of its contact area."""
    monkeypatch.setattr(permanent, "at_once", None)
    problem = stacked(beside=False).problem
    found = resultants_of(problem, permanent_state(Flow(problem), problem.compliance))
    above, light = np.cumsum(WEIGHTS[::-1])[::-1], WEIGHTS[-1]
    np.testing.assert_allclose(found[:, 2], -above, rtol=1e-9)
    levers = np.array([OVERHANG, OVERHANG, OVERHANG / 2.0])
    np.testing.assert_allclose(np.linalg.norm(found[:, 3:5], axis=1), light * levers, rtol=1e-9)
    np.testing.assert_allclose(found[:, [0, 1, 5]], 0.0, atol=1e-9 * above[0])


@pytest.mark.parametrize(
    "arch",
    [
        lb.structures.arch_bridge(lb.OrdunaLourenco(0.75), span=6.8, rise=1.0, thickness=0.69, voussoirs=19),
        lb.structures.arch(
            lb.OrdunaLourenco(0.8),
            radius=1.18,
            thickness=0.242,
            voussoirs=22,
            fill=lb.structures.Fill(5.38),
        ),
        lb.structures.arch(
            lb.OrdunaLourenco(1.0, slip="outer", sides=4), radius=4.88, thickness=0.62, voussoirs=39
        ),
    ],
    ids=["bridge", "arch with fill", "arch"],
)
def test_arches_whose_path_from_a_large_barrier_finds_no_start_stand_by_themselves(arch):
    found = lb.stability(arch)
    assert found.kind is lb.results.Standing.STANDS
    assert found.residuals.worst.value <= 1e-8
    assert lb.nonassociated(arch).load_factor > 0.0


def test_stresses_that_nearly_arise_do_not(monkeypatch):
    """Displacements 1e-4 too large: of a stone that stands it is then not known whether it does."""
    model = lb.structures.block(lb.OrdunaLourenco(0.6), width=1.0, height=1.0)
    own = answers.may_arise

    def off(flow, weights):
        return (replace(one, u=1.0001 * one.u) for one in own(flow, weights))

    assert lb.stability(model).stands
    monkeypatch.setattr(answers, "may_arise", off)
    with pytest.raises(lb.errors.SolverFailure, match="whether they arise by themselves is undecided"):
        lb.stability(model)


def test_a_vault_stands_where_steps_from_a_small_barrier_find_what_arises():
    """The path to it finds no start, and rounds of least norm stall: whether it stands was left undecided."""
    size = {"radius": 1.5, "thickness": 0.4, "length": 2.4, "courses": 9, "stones": 3, "embrace": 1.1}
    found = lb.stability(lb.structures.barrel_vault(lb.OrdunaLourenco(0.42), **size))
    assert found.stands
    assert found.residuals.worst.value <= 1e-6

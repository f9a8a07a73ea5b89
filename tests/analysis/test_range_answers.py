"""What is kept of the states that a search for a range meets, and what is said of them."""

from dataclasses import replace

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.analysis.falling import Fall
from limitblocks.analysis.load_factor_range.answers import Collected, of_result
from limitblocks.analysis.nonassociated.start import state_of
from limitblocks.evidence.range_answer import Origin
from limitblocks.problem import Flow, State


def test_a_load_factor_that_was_searched_and_then_reached_is_reached():
    rocking = lb.structures.block(lb.PointContact(0.6), width=0.4, height=1.0)  # at b / h
    flow = Flow(rocking.problem)
    state = state_of(rocking, rocking.problem, lb.nonassociated(rocking))
    collected = Collected(flow, (0.0, 2.0 * state.load_factor), state.load_factor, False)
    for origin in (Origin.SEARCHED, Origin.REACHED, Origin.REACHED):
        assert collected.add(state, "", origin, keep=True)
    assert [one.origin for one in collected.found] == [Origin.SEARCHED, Origin.REACHED]


@pytest.mark.parametrize(
    "joint", [lb.PointContact(0.6), lb.PointContact(0.6, cone="outer", sides=4), lb.OrdunaLourenco(0.6)]
)
def test_where_nothing_slips_the_thrust_is_that_of_the_permanent_loads(joint):
    """It rocks; multipliers of friction at the points that open are none of a slip."""
    model = lb.structures.block(joint, width=0.4, height=1.0)
    (answer,) = lb.load_factor_range(model, paths=1, mechanisms=0).answers
    assert answer.load_factor == pytest.approx(0.4, rel=1e-6)
    assert (answer.share, answer.thrust, answer.local) == (1.0, 1.0, False)


@pytest.mark.parametrize("unit_weight", [None, 0.0], ids=["left out", "zero"])
def test_blocks_without_weight_that_forces_press_and_push(unit_weight):
    """The upper stone, a quarter of the volume, slides at its friction; ZeroDivisionError, no unit weight."""
    stones = [
        lb.Block.box("ground", (4, 4, 0.2), at=(0, 0, -0.1)),
        lb.Block.box("lower", (2, 1, 1.5), at=(0, 0, 0.75), unit_weight=unit_weight),
        lb.Block.box("upper", (1, 1, 1), at=(0, 0, 2), unit_weight=unit_weight),
    ]
    frictions = {"lower": lb.PointContact(0.9), "upper": lb.PointContact(0.3)}
    beds = lb.find_interfaces(stones, lambda i, j: frictions[max(i.name, j.name)])
    press, push = (lb.loads.force("upper", force, (0, 0, 1.5)) for force in ((0, 0, -9e3), (9e3, 0, 0)))
    model = lb.Model(stones, ["ground"], beds, press, push)
    assert lb.load_path(model).load_factor == pytest.approx(0.3, rel=1e-6)
    (answer,) = lb.load_factor_range(model, paths=1, mechanisms=0).answers
    assert answer.load_factor == pytest.approx(0.3, rel=1e-6)
    assert (answer.moving, answer.share) == (("upper",), pytest.approx(1.0 / (3.0 + 1.0)))


def test_which_blocks_move_does_not_depend_on_the_axes():
    """One moves at 1, the other at 9e-4: less than the thousandth that counts, whatever their components."""
    stones = [lb.Block.box("ground", (4, 4, 0.2), at=(0, 0, -0.1))]
    stones += [
        lb.Block.box(name, (1, 1, 1), at=(x, 0, 0.5), unit_weight=2e4) for name, x in (("a", -1), ("b", 1))
    ]
    joint, push = lb.PointContact(0.6), lb.mass_proportional((1, 0, 0))
    model = lb.Model(stones, ["ground"], lb.find_interfaces(stones, joint), lb.self_weight(), push)
    result, flow = lb.nonassociated(model, confirm=False), Flow(model.problem)
    for direction in ((1, 0, 0), (1, 1, 0)):
        rates = np.zeros((3, 6))
        rates[1, :3], rates[2, 0] = np.divide(direction, np.linalg.norm(direction)), 9e-4
        found = replace(result, displacement_rates=rates)
        assert of_result(model, flow, np.zeros(flow.problem.C.shape[0]), found, Origin.SEARCHED).moving == (
            "a",
        )
        fall = Fall(flow, model.problem.dead, State(0.0, np.zeros(0), rates[1:].ravel(), np.zeros(0)))
        assert fall.blocks == ("a",)

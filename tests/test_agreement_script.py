"""The script that counts how far the load factor depends on how it is found."""

import math

import numpy as np
import pytest
import scripts_as_modules

import limitblocks as lb
from matrix import Case


@pytest.fixture(scope="module")
def script():
    return scripts_as_modules.script("agreement")


def case_of(friction):
    joint = lb.PointContact(friction)
    return Case("block", joint, "along", lb.structures.block(joint, width=1.0, height=2.0))


def test_a_block_rocks_however_it_is_found(script):
    """It turns over its edge at width over height, 1/2, as friction is more than that."""
    _, found, pushed, turned, warned = script.row(case_of(0.7))
    assert (found, pushed, turned) == pytest.approx((0.5, 0.5, 0.5), rel=1e-6)
    assert not warned


def test_what_has_no_answer_is_not_compared(script):
    stone = lb.Block.box("stone", (1.0, 1.0, 1.0), (0.6, 0.0, 0.5), 20e3)
    base = lb.Block.box("base", (1.0, 1.0, 0.2), (0.0, 0.0, -0.1))
    seat = lb.find_interfaces([base, stone], lb.PointContact(0.6))
    falls = lb.Model([base, stone], ["base"], seat, lb.self_weight(), lb.mass_proportional((1.0, 0.0, 0.0)))
    _, found, pushed, turned, _ = script.row(Case("overhang", lb.PointContact(0.6), "along", falls))
    assert all(map(math.isnan, (found, pushed, turned)))


def test_differences_are_counted_by_size_and_unknown_ones_left_out(script):
    differences = np.array([0.0, -5e-7, 5e-4, -0.02, np.nan])
    said = "4 models, 2 within 0.0001 %, 3 within 0.1 %, 3 within 1 %, the largest 2 %"
    assert script.counted(differences) == said


def test_a_model_in_another_order_is_the_same_model(script):
    model = case_of(0.7).model
    turned = script.in_another_order(model)
    assert [block.name for block in turned.blocks] == [block.name for block in model.blocks][::-1]
    assert lb.bounds(turned).upper == pytest.approx(0.5, rel=1e-8)

"""Models whose load factors are known exactly: random ones, weights far apart, tiny and huge frictions."""

import sys
from pathlib import Path

import numpy as np
import pytest

import limitblocks as lb
from limitblocks import structures

sys.path.insert(0, str(Path(__file__).parents[1] / "oracle"))
import draw
import judge
import random_models
import shapes
from coulomb import Truth

SEEDS = range(60)
RECORD = judge.recorded()
NEEDED = {
    399: "units of the state before",
    585: "unlimited load on one block: what it does not reach is judged by the dead loads",
    1770: "self-stress between two walls, bounded",
    2132: "polish, weights over 13 decades",
    2809: "shears in units of friction",
    4261: "multipliers that follow the rates",
    41166: "another pair where the first is not proven",
    450098: "double root of the closed form",
    771082: "stresses of the dead loads that balance them",
    990163: "bounds that say themselves how far apart they are",
    990236: "proven by what the result carries",
}


@pytest.mark.parametrize(
    "seed", [*SEEDS, *(pytest.param(seed, id=f"{seed} {NEEDED[seed]}") for seed in NEEDED)]
)
def test_random_model(seed):
    case = random_models.case(seed)
    expected = judge.truth_of(case, RECORD)
    assert expected.verdict != "undecided"
    verdict = judge.judged(case.model, expected)
    assert verdict.outcome == "right", verdict.said


@pytest.mark.parametrize("seed", [450192, 470098, 470513, 450385, 470451])
def test_what_paths_leave_open_is_closed_by_increments_or_the_outer_loop(seed):
    """Weights over up to 14 decades; the last two need the outer loop."""
    case = random_models.case(seed)
    verdict = judge.judged_nonassociated(case, judge.truth_of(case, RECORD))
    assert verdict.outcome == "right", verdict.said
    found = lb.nonassociated(case.model)
    assert found.how.startswith(("increments", "fixed point"))
    frozen = found.how.startswith("fixed point")
    assert any("frozen friction" in remark for remark in found.remarks) is frozen


@pytest.mark.parametrize("seed", [770083, 990173])
def test_paths_start_from_what_proves_that_dead_loads_stand_where_nothing_else_is_found(seed):
    """Weights over 14 decades, hardly any room within yield: neither a path nor a program ends."""
    case = random_models.case(seed)
    verdict = judge.judged_nonassociated(case, judge.truth_of(case, RECORD))
    assert verdict.outcome == "right", verdict.said
    assert any("stresses were found that arise" in remark for remark in lb.nonassociated(case.model).remarks)


def apart(*stones):
    """Cubes (side, weight, friction) on one floor, far from each other."""
    x, boxes = 0.0, {}
    for k, (side, _, _) in enumerate(stones):
        boxes[f"b{k}"] = ((x, 0.0, 0.0), (x + side, side, side))
        x += 3 * side
    floor = draw.floor_under(boxes)
    frictions = iter([friction for _, _, friction in stones])
    interfaces = shapes.touching({**floor, **boxes}, lambda: lb.PointContact(next(frictions)))
    blocks = [shapes.box("floor", *floor["floor"])]
    blocks += [
        shapes.box(name, *ends, weight)
        for (name, ends), (_, weight, _) in zip(boxes.items(), stones, strict=True)
    ]
    return lb.Model(blocks, ["floor"], interfaces, lb.self_weight(), lb.mass_proportional((1, 0, 0)))


@pytest.mark.parametrize(
    ("stones", "expected"),
    [
        pytest.param([(10.0, 2e7, 0.6), (0.02, 0.16, 0.3)], 0.3, id="10 m and 2 cm"),
        pytest.param([(1.0, 1.0, 0.4), (1.0, 1e7, 0.8)], 0.4, id="beside 1e7 times the weight"),
        pytest.param([(1.0, 1e-8, 0.4), (1.0, 1e8, 0.8)], 0.4, id="beside 1e16 times the weight"),
        pytest.param([(1.0, 1e-8, 0.8), (1.0, 1e8, 0.4)], 0.4, id="the heavy one slides"),
    ],
)
def test_cubes_apart(stones, expected):
    verdict = judge.judged(apart(*stones), Truth("number", expected))
    assert verdict.outcome == "right", verdict.said


def test_friction_that_double_precision_cannot_tell_from_none_is_never_wrong():
    model = structures.block(lb.PointContact(1e-9), width=0.5, height=1.0)
    assert judge.judged(model, Truth("number", 1e-9)).outcome in {"right", "refused"}


@pytest.mark.parametrize("friction", [1e-6, 1e-3, 1e3, 1e7])
def test_cube_of_extreme_friction(friction):
    model = structures.block(lb.PointContact(friction), width=0.5, height=1.0)
    verdict = judge.judged(model, Truth("number", min(friction, 0.5)))
    assert verdict.outcome == "right", verdict.said


@pytest.mark.parametrize("friction", [1e8, 1e9])
def test_where_friction_is_beyond_reason_the_interval_is_proven_and_widens_with_its_rounding(friction):
    bounds = lb.bounds(structures.block(lb.PointContact(friction), width=0.5, height=1.0))
    assert bounds.proven
    assert bounds.lower <= 0.5 <= bounds.upper
    assert bounds.upper - bounds.lower < 100.0 * np.finfo(float).eps * friction


@pytest.mark.parametrize("seed", [1, 6, 42])
def test_polished_states_prove_what_a_solver_leaves_too_wide(seed):
    assert lb.bounds(random_models.case(seed).model).proven

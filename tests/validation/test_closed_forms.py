"""Closed forms beside those of docs/validation.md: one rigid body, stacks, leaves, a tilted ground."""

from functools import partial

import numpy as np
import pytest
from stones import jammed, model_of

import limitblocks as lb
from cases.case import ANALYSES, FLOWS
from cases.closed_forms import leaves
from limitblocks import structures

CLOSE = 1e-5  # without dilatancy: residuals of 1e-6 allow the load factor an error a few times as large


@pytest.fixture(params=[lb.OrdunaLourenco, lb.PointContact], ids=lambda kind: kind.__name__)
def joint_type(request):
    return request.param


def assert_bounds(model, expected):
    result = lb.bounds(model)
    assert (result.lower, result.upper) == pytest.approx((expected, expected), rel=1e-6)


@pytest.mark.parametrize("flow", FLOWS)
def test_leaves_with_a_smooth_joint_rock_one_by_one(joint_type, flow):
    build = partial(leaves, between=joint_type(0.0))
    assert ANALYSES[flow](build, joint_type(0.6)) == pytest.approx(0.12 / 2.4, rel=CLOSE)


@pytest.mark.parametrize("fraction", [0.0, 0.5, 0.9, 0.999])
@pytest.mark.parametrize("count", [1, 4, 8])
def test_overhang_below_the_harmonic_limit(joint_type, count, fraction):
    length, height, friction = 1.0, 0.4, 0.7
    model = structures.overhang(
        joint_type(friction), count=count, length=length, height=height, fraction=fraction
    )
    reach = max(block.vertices[:, 0].max() for block in model.free_blocks) - length
    assert reach == pytest.approx(fraction * length / 2 * sum(1 / i for i in range(1, count + 1)))
    assert_bounds(model, min(friction, (1 - fraction) * length / (count * height)))


@pytest.mark.parametrize("count", [1, 4, 8])
def test_overhang_beyond_the_harmonic_limit_falls(joint_type, count):
    model = structures.overhang(joint_type(0.7), count=count, length=1.0, height=0.4, fraction=1.001)
    with pytest.raises(lb.errors.NoEquilibrium):
        lb.bounds(model)


def test_block_under_a_ceiling_without_friction_slides_at_once(joint_type):
    result = lb.bounds(jammed(joint_type(0.0)))
    assert result.lower == pytest.approx(0.0, abs=1e-6)
    assert result.upper == pytest.approx(0.0, abs=1e-6)


def tilted(model, angle):
    """`model` with its ground tilted about Y, sloping down towards +X; live load along the slope."""
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([(c, 0, s), (0, 1, 0), (-s, 0, c)])
    blocks = [block.moved(turn, (0, 0, 0)) for block in model.blocks]
    joint = model.interfaces[0].joint
    return model_of(blocks, model.supports, joint, turn @ (1, 0, 0))


@pytest.mark.parametrize("angle", [0.1, 0.2])
def test_tilting_plane_is_equivalent_to_a_horizontal_load(joint_type, angle):
    level = structures.wall(joint_type(0.5), length=1.2, courses=4)
    load_factor = lb.bounds(level).lower
    # across the slope the weight is cos(angle), along it sin(angle): (sin + x) / cos = load factor
    assert_bounds(tilted(level, angle), load_factor * np.cos(angle) - np.sin(angle))


def test_tilting_plane_ends_at_the_load_factor(joint_type):
    b, h, friction = 0.4, 1.0, 0.6
    level = structures.block(joint_type(friction), width=b, height=h)
    limit = np.arctan(min(friction, b / h))
    assert lb.bounds(tilted(level, limit - 1e-4)).lower > 0.0
    with pytest.raises(lb.errors.NoEquilibrium):
        lb.bounds(tilted(level, limit + 1e-4))

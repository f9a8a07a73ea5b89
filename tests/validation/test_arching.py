"""Arching: stones between abutments that do not give way carry loads by thrust alone, up to crushing.

The thrust H presses on H / (b f) of the depth, at the top in midspan and at the bottom at the abutments: it
carries the moment H (d - H / (b f)), at most b d^2 f / 4.
"""

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.practice import settlement

SPAN, DEPTH, WIDTH, STRENGTH, GAMMA = 3.0, 0.4, 0.5, 2e6, 20e3
GREATEST = WIDTH * DEPTH**2 * STRENGTH / 4  # moment, N m
WEIGHT = GAMMA * SPAN * DEPTH * WIDTH


def beam(stones, live, friction=0.8):
    """Stones on end side by side between two abutments, without anything below."""
    length, size = SPAN / stones, (1.0, WIDTH, DEPTH)
    blocks = [lb.Block.box(name, size, (x, 0, 0)) for name, x in (("left", -0.5), ("right", SPAN + 0.5))]
    blocks += [
        lb.Block.box(f"stone {k + 1}", (length, WIDTH, DEPTH), ((k + 0.5) * length, 0, 0), GAMMA)
        for k in range(stones)
    ]
    joint = lb.OrdunaLourenco(friction, compressive_strength=STRENGTH)
    found = lb.find_interfaces(blocks, joint)
    return lb.Model(blocks, ["left", "right"], found, lb.self_weight(), live)


MIDDLE = lb.loads.line_load((0, 0, -1 / WIDTH), (SPAN / 2, -WIDTH / 2), (SPAN / 2, WIDTH / 2))  # 1 N in all


@pytest.mark.parametrize("stones", [2, 6])
def test_a_load_in_midspan_crushes_three_joints(stones):
    model = beam(stones, MIDDLE)
    expected = (GREATEST - WEIGHT * SPAN / 8) / (SPAN / 4)
    assert lb.bounds(model).lower == pytest.approx(expected, rel=1e-6)
    found = lb.nonassociated(model)
    assert found.load_factor == pytest.approx(expected, rel=1e-6)
    assert lb.interface_states(model, found).state.count("crush") == 3


def test_an_even_load_is_carried_up_to_the_same_moment():
    names = [f"stone {k}" for k in range(1, 7)]
    model = beam(6, lb.loads.pressure(names, 1.0, facing=(0, 0, 1)))
    expected = 8 * (GREATEST - WEIGHT * SPAN / 8) / (WIDTH * SPAN**2)  # Pa
    assert lb.nonassociated(model).load_factor == pytest.approx(expected, rel=1e-6)


def test_friction_below_the_slope_of_the_thrust_lets_the_stones_slide():
    """P + W = 2 mu H at the abutments, and (P / 4 + W / 8) L = H (d - H / (b f)): associated."""
    friction, most = 0.1, WIDTH * DEPTH * STRENGTH
    assert 2 * friction * most / 2 < GREATEST / (SPAN / 4)  # more than slides at the thrust of that moment
    rise = DEPTH - friction * SPAN / 2
    thrust = most / DEPTH / 2 * (rise + np.sqrt(rise**2 + WEIGHT * SPAN * DEPTH / most / 2))
    expected = 2 * friction * thrust - WEIGHT
    model = beam(2, MIDDLE, friction)
    assert lb.bounds(model).lower == pytest.approx(expected, rel=1e-6)
    assert lb.nonassociated(model).load_factor <= expected * (1 + 1e-6)


@pytest.mark.parametrize(("way", "root"), [(1, -1), (-1, 1)])
def test_least_and_greatest_thrust_of_stones_that_crush(way, root):
    """Both roots of H (d - H / (b f)) = W L / 8, as the abutment gives way and as it is pushed in."""
    found = settlement(beam(2, MIDDLE), "right", (way, 0, 0))
    half = STRENGTH * WIDTH * DEPTH / 2
    thrust = half + root * np.sqrt(half**2 - STRENGTH * WIDTH * WEIGHT * SPAN / 8)
    assert found.nonassociated == pytest.approx(way * thrust, rel=1e-6)
    assert found.lower == pytest.approx(way * thrust, rel=1e-5)

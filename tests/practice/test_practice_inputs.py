"""Axles that spread through fill, masses that move, water in joints and an element that vibrates."""

import numpy as np
import pytest
from stones import model_of

import limitblocks as lb
from limitblocks.practice import Deck, Vehicle, element_acceleration, uplift, vehicle_load
from limitblocks.practice.moving_masses import moving_masses

SLABS = [
    lb.Block.box("left", (3, 1, 1), (-1.5, 0, 0.5), 1.0),
    lb.Block.box("right", (3, 1, 1), (1.5, 0, 0.5), 1.0),
]
GROUND = lb.Block.box("ground", (8, 2, 1), (0, 0, -0.5))


def slabs():
    stones = [GROUND, *SLABS]
    return model_of(stones, ["ground"], lb.PointContact(0.6))


def test_a_road_below_the_stones_by_rounding_is_on_them():
    slab = lb.Block.prism("slab", [(-1, 0), (1, 0), (1, 0.1 + 0.2), (-1, 0.1 + 0.2)], (-1, 1), 1.0)
    base = lb.Block.box("ground", (2, 2, 1), (0, 0, -0.5))
    model = model_of([base, slab], ["ground"], lb.PointContact(0.6))
    assert slab.vertices.max() > 0.3
    load = vehicle_load(model, Vehicle((80e3,)), Deck(0.3), 0.0)
    assert load.on([slab])[0] == pytest.approx([0, 0, -80e3, 0, 0, 0])


@pytest.mark.parametrize(("at", "left"), [(0.25, 0.25), (0.0, 0.5), (-0.25, 0.75), (0.75, 0.0)])
def test_an_axle_spreads_over_its_contact_and_twice_its_way_through_the_fill(at, left):
    """Contact .3 and .7 of fill at 1 in 2: a length of 1 m, shared by both slabs, about its middle."""
    load = vehicle_load(slabs(), Vehicle((80e3,)), Deck(1.7, spread=0.5), at).on(SLABS)
    assert -load[:, 2] == pytest.approx([left * 80e3, (1 - left) * 80e3])
    moment = load[:, 4].sum() - load[:, 2] @ [block.centroid[0] for block in SLABS]  # about y: -x Fz
    assert moment == pytest.approx(80e3 * at, abs=1e-6)
    assert not load[:, :2].any()


def test_axles_stand_at_their_distances_and_those_on_the_approaches_load_nothing():
    load = vehicle_load(slabs(), Vehicle((80e3, 50e3), (0.0, 2.0)), Deck(1.0), -1.0).on(SLABS)
    assert -load[:, 2] == pytest.approx([80e3, 50e3])
    load = vehicle_load(slabs(), Vehicle((80e3, 50e3), (0.0, 9.0)), Deck(1.0), -1.0).on(SLABS)
    assert -load[:, 2] == pytest.approx([80e3, 0.0])


@pytest.mark.parametrize(("slow", "counted"), [(0.05, 2), (1e-7, 1)])
def test_a_mass_that_moves_a_little_counts_and_one_that_rests_does_not(slow, counted):
    rates = np.zeros((3, 6))
    rates[1, 0], rates[2, 0] = slow * 2.0, 2.0
    masses, scale = moving_masses(slabs(), rates)
    assert [one.name for one in masses] == ["left", "right"][-counted:]
    assert [one.horizontal for one in masses] == pytest.approx([slow, 1.0][-counted:])
    assert scale == pytest.approx(0.5)


def test_a_share_of_the_water_pressure():
    """A quarter of it, .5 m deep at the foot of the slabs and up to there between them."""
    load = uplift(slabs(), 0.5, share=0.25).on(SLABS)
    assert load[:, 2] == pytest.approx([0.25 * 9810 * 0.5 * 3.0] * 2)
    assert load[:, 0] == pytest.approx(np.array([-1.0, 1.0]) * 0.25 * 9810 * 0.5**2 / 2)


def test_acceleration_of_an_element_between_the_ends_of_its_formula():
    """EN 1998-1 (4.25): 0.2 1.2 (3 1.5 / (1 + 0.5^2) - 0.5) at half the height and half the period."""
    half = element_acceleration(0.2, 1.2, z=3.0, height=6.0, element_period=0.2, building_period=0.4)
    assert half == pytest.approx(0.24 * 3.1)

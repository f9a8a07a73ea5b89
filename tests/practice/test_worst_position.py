"""Vehicles on a deck: axles, dispersion, and where they are worst."""

import json
from dataclasses import replace

import facades
import numpy as np
import pytest

import limitblocks as lb
from limitblocks.practice import (
    Deck,
    PartialFactors,
    Vehicle,
    adequacy,
    design_model,
    vehicle_load,
    worst_position,
)

JOINT = lb.PointContact(0.7)


def beam():
    """A lintel of 4 m on two piers: an axle has to lift one end, or nothing."""
    return facades.beam(JOINT)


def test_a_vehicle_runs_in_the_middle_of_a_bridge_wherever_that_is():
    """A bridge drawn beside the X axis: the overhang tips about x = 3, P (x - 3) = W (3 - 2)."""
    moved = [
        lb.Block(one.name, np.add(one.vertices, (0, 7.5, 0)), one.faces, one.unit_weight)
        for one in beam().blocks
    ]
    model = replace(beam(), blocks=moved, interfaces=lb.find_interfaces(moved, JOINT))
    found = worst_position(model, Vehicle((10e3,), contact=1e-3), Deck(level=0.5), (3.2, 3.95), positions=4)
    assert (found.deck.y, Deck(0.5, y=7.2).on(model).y) == (7.5, 7.2)
    assert found.bounds.upper == pytest.approx(20e3 * 2.0 / 10e3 / (found.position - 3.0), rel=1e-6)


def test_the_search_finds_the_worst_position_between_the_first_ones():
    """P (x - 3) = W (3 - 2): worst is x = 4 less half the contact, from where on less stands on the beam."""
    model, vehicle, deck = beam(), Vehicle((10e3,), contact=1e-4), Deck(level=0.5)
    found = worst_position(model, vehicle, deck, (3.2, 4.8), positions=4)
    assert found.position == pytest.approx(3.99995, abs=5e-6)
    assert found.bounds.upper == pytest.approx(40e3 / 10e3 / (found.position - 3.0), rel=1e-6)
    assert found.load_factors.min() < 0.8 * found.load_factors[:4].min()
    assert np.isinf(found.load_factors[np.argmax(found.positions)])


def test_a_vehicle_longer_than_the_structure_is_looked_at_until_its_first_axle_leaves():
    """P (x - 3) = W (3 - 2) under the first axle, which is the heavy one; its middle is at most .1 m off."""
    found = worst_position(beam(), Vehicle((10e3, 1e3), (0.0, 100.0), contact=0.2), Deck(level=0.5))
    assert found.position == pytest.approx(3.9, abs=1e-3)
    assert found.bounds.upper == pytest.approx(40e3 / 10e3 / 0.9, rel=1e-4)


@pytest.mark.parametrize("at", [3.85, 3.95, 4.0, 4.1])
@pytest.mark.parametrize("depth", [0.0, 0.3])
def test_the_part_of_an_axle_beyond_the_blocks_does_nothing(at, depth):
    """The overhang tips about x = 3 under what is left of an even load, at the middle of what is left."""
    model, half = beam(), 0.15 + 0.5 * depth
    axle = vehicle_load(model, Vehicle((10e3,)), Deck(level=0.5 + depth), at)
    left = min(4.0 - (at - half), 2 * half)
    moment = 10e3 * left / (2 * half) * (at - half + left / 2 - 3.0)
    assert lb.bounds(replace(model, live=axle)).upper == pytest.approx(40e3 / moment, rel=1e-9)


def test_a_printed_envelope_says_what_stands_beside_the_blocks():
    found = worst_position(beam(), Vehicle((10e3, 5e3), (0.0, 2.0)), Deck(level=0.5), (3.5, 3.9), positions=3)
    assert "10 of 15 kN of axles stand on the blocks" in str(found)
    assert "axles" not in str(worst_position(beam(), Vehicle((10e3,)), Deck(0.5), (3.5, 3.8), positions=3))


def test_a_search_interrupted_before_any_answer_has_none():
    def first(*_):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):  # off the overhang at x = 4
        worst_position(beam(), Vehicle((10e3,)), Deck(level=0.5), (4.2, 5.0), positions=3, progress=first)


def test_an_interrupted_search_keeps_the_positions_tried():
    """The overhang tips about x = 3: P (x - 3) = W (3 - 2); of four positions two are done, 1 and 3."""
    places = []

    def second(x, _factor):
        places.append(x)
        if len(places) == 2:
            raise KeyboardInterrupt

    model, vehicle, deck = beam(), Vehicle((10e3,), contact=1e-3), Deck(level=0.5)
    found = worst_position(model, vehicle, deck, (3.2, 3.8), positions=4, progress=second)
    assert found.positions == pytest.approx([3.2, 3.6])
    assert found.bounds.upper == pytest.approx(20e3 * 2.0 / 10e3 / 0.6, rel=1e-6)
    assert not found.complete
    assert not found.to_dict()["complete"]
    assert "may be worse" in str(found)
    assert "may be worse" in lb.report(model, found).text


def test_vehicle_of_two_axles_and_dispersion():
    """Forces and moments of two axles; through a fill each acts on contact + 2 spread depth, evenly."""
    model, deck = beam(), Deck(level=1.5, spread=0.5)
    load = vehicle_load(model, Vehicle((10e3, 20e3), (0.0, 1.2), contact=0.2), deck, 1.5)
    total = load.on(model.free_blocks)[0]
    assert total[:3] == pytest.approx([0, 0, -30e3])
    assert total[4] == pytest.approx(10e3 * (1.5 - 2.0) + 20e3 * (2.7 - 2.0))
    (_, first), _ = load.terms
    assert np.ptp([first.start[0], first.end[0]]) == pytest.approx(0.2 + 2 * 0.5 * 1.0)


def test_axle_on_the_approach_puts_nothing_on_the_bridge():
    model = beam()
    alone = vehicle_load(model, Vehicle((10e3, 20e3), (0.0, -9.0)), Deck(level=0.5), 2.0)
    assert alone.on(model.free_blocks)[0, 2] == pytest.approx(-10e3)
    with pytest.raises(lb.ModelError, match="stands on a free block"):
        vehicle_load(model, Vehicle((10e3,)), Deck(level=0.5), 40.0)


def test_a_vehicle_on_a_design_model_has_gamma_q():
    """The overhang tips about x = 3: gamma_Q P (x - 3) = gamma_G W (3 - 2)."""
    factors = PartialFactors(gamma_G=0.9, gamma_Q=1.5, gamma_M=1.0)
    model, vehicle, deck = design_model(beam(), factors), Vehicle((10e3, 1e3), (0.0, 9.0)), Deck(level=0.5)
    found = worst_position(model, replace(vehicle, contact=1e-3), deck, (3.2, 3.95), positions=4)
    expected = 0.9 * 40e3 * (3.0 - 2.0) / (1.5 * 10e3 * (found.position - 3.0))
    assert found.bounds.lower == pytest.approx(expected, rel=1e-6)
    assert found.position == pytest.approx(3.95, abs=1e-3)
    assert "axles times gamma_Q 1.5; 15 of 16.5 kN" in str(found)
    assert "times gamma_Q 1.5" in lb.report(model, found).text
    moved = lb.studies.moving_load(model, (0, 0, -10e3), [(3.95, 0.0)])
    assert moved.load_factors == pytest.approx(0.9 * 40e3 / (1.5 * 10e3 * 0.95), rel=1e-6)
    turned = lb.studies.directions(model, [(0, 0, -1)], live=lambda to: force(to, 3.95))
    assert turned.load_factors == pytest.approx(0.9 * 40e3 / (1.5 * 10e3 * 0.95), rel=1e-6)
    with pytest.raises(lb.ModelError, match="design values already"):
        adequacy(found.model, factors)


def force(direction, x):
    """10 kN along a direction at a place of the overhang."""
    return lb.loads.force("beam", 10e3 * np.array(direction), (x, 0, 0.5))


def test_no_place_beside_the_worst_position_carries_less():
    """The definition of worst: on an arch it lies between the places of the search."""
    arch = lb.structures.arch(lb.PointContact(0.8), radius=5.0, thickness=0.8, voussoirs=11)
    vehicle, deck = Vehicle((10e3,), contact=0.3), Deck(level=6.0)
    found = worst_position(arch, vehicle, deck, (-3.0, 3.0), positions=5)
    for x in found.position + np.array([-0.04, -0.02, 0.02, 0.04]):
        there = replace(arch, live=vehicle_load(arch, vehicle, found.deck, float(x)))
        assert lb.bounds(there).lower >= found.bounds.lower * (1.0 - 2e-5)


def test_a_file_keeps_gamma_q(tmp_path):
    """The overhang tips about x = 3: gamma_Q P (x - 3) = gamma_G W (3 - 2), of the model read back, too."""
    factors, model = PartialFactors(gamma_G=0.9, gamma_Q=1.5, gamma_M=1.0), beam()
    file, moved = tmp_path / "result.json", replace(model, live=force((0, 0, -1), 3.95))
    adequacy(moved, factors, without_dilatancy=False).save(file)
    again = [lb.read(design_model(model, factors).save(tmp_path / "model.json"))]
    again.append(lb.read_result(file, moved).model)
    for design in again:
        found = lb.studies.moving_load(design, (0, 0, -10e3), [(3.95, 0.0)])
        assert found.load_factors == pytest.approx(0.9 * 40e3 / (1.5 * 10e3 * 0.95), rel=1e-6)
        with pytest.raises(lb.ModelError, match="design values already"):
            adequacy(design, factors)
    assert again[0].digest == design_model(model, factors).digest
    assert "gamma_Q" not in model.to_dict()
    document = design_model(model, factors).to_dict()
    (tmp_path / "units.json").write_text(json.dumps(document | {"units": {"length": "ft", "force": "kip"}}))
    assert lb.read(tmp_path / "units.json").gamma_Q == 1.5
    (tmp_path / "wrong.json").write_text(json.dumps(document | {"gamma_Q": 150.0}))
    with pytest.raises(lb.ModelError, match=r"gamma_Q is 150.0, expected a finite number > 0"):
        lb.read(tmp_path / "wrong.json")

"""Bridges of several spans and rings: an independent program in the plane, identities, weights, misuse."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from planar_bridge import Bridge, load_factor, measures
from stones import model_of

import limitblocks as lb
from limitblocks.geometry.polygon import areas
from limitblocks.loads import top_force
from limitblocks.practice import Deck, Vehicle, passive_fill, reinforced, vehicle_load, worst_position
from limitblocks.practice.envelope import line_of
from limitblocks.structures import Fill, arch_bridge

JOINT = lb.PointContact(0.6)
STRONG = lb.OrdunaLourenco(0.6, cohesion=2e6, tensile_strength=2e6)


def bridge(at=-0.75, **settings):
    """A bridge with a force of 1 kN at X = `at` on its extrados; no fill."""
    shape = {"span": 3.0, "rise": 0.75, "thickness": 0.22, "voussoirs": 15, "depth": 2.0} | settings
    model = arch_bridge(JOINT, **shape)
    return replace(model, live=top_force((0, 0, -1e3), (at, 0.0)))


@pytest.mark.parametrize(
    ("shape", "loaded"),
    [
        ({}, 0),
        ({"rings": 2}, 0),
        ({"rings": 3, "between": 0.3}, 0),
        ({"rings": 2, "between": 0.0}, 0),
        ({"spans": 2}, 0),
        ({"spans": 2, "rings": 2, "between": 0.4}, 0),
        ({"spans": 3, "width": 0.4}, 1),
    ],
    ids=str,
)
def test_another_program_has_the_same_load_factor(shape, loaded):
    """Spans, piers and rings: the same model, within 1e-6."""
    own = Bridge(**shape)
    at = loaded * (own.span + own.width) - 0.75
    settings = {"spans": own.spans, "rings": own.rings, "ring_joint": lb.PointContact(own.between)}
    model = bridge(at, pier_width=own.width, pier_height=own.height, **settings)
    found = lb.bounds(model)
    assert found.proven
    assert found.upper == pytest.approx(load_factor(own, at, loaded), rel=1e-6)


def test_another_program_with_passive_fill():
    """On each facet K gamma times the integral of the depth over its height, at its centre of pressure."""
    own, level, K, gamma = Bridge(), 1.3, 3.0, 20e3
    pulls = []
    for j in range(15):
        z1, z2 = own.point(0, 1, j)[1], own.point(0, 1, j + 1)[1]
        low, high = sorted((z1, z2))
        if high - low < 1e-9:
            continue
        force = K * gamma * own.depth * ((level - low) ** 2 - (level - high) ** 2) / 2
        below = (
            2 / 3 * ((level - low) ** 3 - (level - high) ** 3) / ((level - low) ** 2 - (level - high) ** 2)
        )
        inwards = 1.0 if z2 > z1 else -1.0
        pulls.append(((0.0, level - below), (inwards, 0.0), (0.0, force), (0, 0, j), None))
    model = bridge()
    fill = passive_fill(model, level, unit_weight=gamma, coefficient=K)
    found = lb.bounds(reinforced(model, *fill))
    assert found.upper == pytest.approx(load_factor(own, -0.75, pulls=pulls), rel=1e-6)


def test_passive_fill_of_two_rings_is_on_the_outer_one():
    """Faces that another ring covers but for rounding errors were held by 1e-12 N, below the crown."""
    model = arch_bridge(lb.PointContact(0.6), span=3.0, rise=0.8, thickness=0.3, voussoirs=11, rings=2)
    found = passive_fill(model, 0.9, unit_weight=18e3, coefficient=3.0)
    assert found
    assert all("ring 2" in one.interface.block_i for one in found)


def test_passive_fill_of_faces_askew_and_on_both_sides():
    """Triangles of area A, pressures p at corners x: int p x = A (sum p sum x + sum p x) / 12."""
    corners = np.array([(0.0, 0, 0), (3.0, 0, 0), (0.0, 2, 0), (0.5, 0.4, 1.5)])
    faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
    stones = [lb.Block.box("ground", (9, 9, 1), (0, 0, -0.5)), lb.Block("stone", corners, faces, 20e3)]
    model = model_of(stones, ["ground"], lb.PointContact(0.6))
    d, level, K, gamma = np.array([0.8, 0.6, 0]), 2.0, 3.0, 18e3
    fill = passive_fill(model, level, unit_weight=gamma, coefficient=K, along=d)
    assert len(fill) == 3
    for one, face in zip(fill, faces[1:], strict=True):
        x = corners[list(face)]
        area = np.cross(x[1] - x[0], x[2] - x[0]) @ d / 2  # on the upright plane across the deck
        p = K * gamma * (level - x[:, 2])
        push = abs(area) * p.mean()
        at = (p.sum() * x.sum(axis=0) + p @ x) / 12 / p.mean()
        own = one.interface
        assert own.joint.strength * areas(own.polygon) == pytest.approx(push, rel=1e-12)
        assert own.axes[2] == pytest.approx(-np.sign(area) * d, abs=1e-12)
        off = own.centroid - at
        assert off - off @ d * d == pytest.approx(np.zeros(3), abs=1e-12)


def test_bond_is_needed_where_it_is():
    """A bond between that of dry rings and the strong one gives a load factor between both."""
    weak = lb.OrdunaLourenco(0.6, cohesion=5e3)
    dry, some, whole = (lb.bounds(bridge(rings=2, ring_joint=joint)).upper for joint in (JOINT, weak, STRONG))
    assert dry * 1.01 < some < whole * 0.99


def test_a_wide_pier_is_an_abutment():
    """The loaded span falls alone where the piers are heavy: the load factor of one span."""
    alone = lb.bounds(bridge()).upper
    assert lb.bounds(bridge(spans=2, pier_width=4.0)).upper == pytest.approx(alone, rel=1e-6)
    slender = lb.bounds(bridge(spans=2, pier_width=0.4, pier_height=3.0)).upper
    assert slender < 0.9 * alone


@pytest.mark.parametrize("rise", [0.75, 1.5])
@pytest.mark.parametrize("rings", [1, 2])
def test_weights_by_formula(rise, rings):
    """Voussoirs are trapezia between circles; fill is what they leave below its level."""
    own = Bridge(rise=rise, spans=2, rings=rings, width=0.7)
    model = arch_bridge(JOINT, span=3.0, rise=rise, thickness=0.22, voussoirs=15, depth=2.0, spans=2,
                        rings=rings, pier_width=0.7, pier_height=1.5, fill=Fill(0.3, 18e3))  # fmt: skip
    half = 2 * np.arctan(2 * rise / 3.0)
    inner = (3.0**2 / 4 + rise**2) / (2 * rise)
    outer = inner + 0.22
    arches = 2 * 15 * (outer**2 - inner**2) / 2 * np.sin(2 * half / 15)
    up, inward = 0.22 * np.cos(half), 0.22 * np.sin(half)
    piers = 0.7 * 1.5 + (0.7 - inward) * up
    assert sum(block.volume for block in model.free_blocks) == pytest.approx(2.0 * (arches + piers))
    level = max(block.vertices[:, 2].max() for block in model.free_blocks) + 0.3
    edge = [own.point(k, rings, j) for k in (0, 1) for j in range(16)]
    area = measures(np.array([*edge, (edge[-1][0], level), (edge[0][0], level)]))[0]
    weight = -model.dead.on(model.free_blocks)[:, 2].sum()
    assert weight == pytest.approx(2.0 * (20e3 * (arches + piers) + 18e3 * area))


def test_names_and_supports():
    model = bridge(spans=2, rings=2, pier_width=0.5)
    assert model.supports == ("left abutment", "right abutment", "base 1")
    names = {block.name for block in model.free_blocks}
    assert {"span 2 ring 1 voussoir 15", "pier 1 block 4", "pier 1 springer"} <= names
    assert len(model.interfaces) == 2 * (2 * 16 + 15) + 4 + 1
    # between rings only, on the springings there is the joint of the arch
    made = bridge(rings=2, ring_joint=STRONG)
    assert [i.name.count("ring") for i in made.interfaces if i.joint == STRONG] == [2] * 15


def test_worst_position_over_two_spans():
    """By symmetry a position and its mirror image have one load factor; the envelope has two lows."""
    model = bridge(spans=2, pier_width=0.5, pier_height=1.5)
    deck, vehicle = Deck(level=2.6), Vehicle((1e3,))
    found = worst_position(model, vehicle, deck, (-1.3, 4.8), positions=9)
    order = np.argsort(found.positions[:9])
    envelope = found.load_factors[:9][order]
    assert envelope == pytest.approx(envelope[::-1], rel=1e-5)
    mirrored = replace(model, live=vehicle_load(model, vehicle, deck, 3.5 - found.position))
    assert lb.bounds(mirrored).upper == pytest.approx(found.bounds.upper, rel=1e-5)
    assert found.bounds.upper <= found.load_factors.min() * (1 + 1e-6)


@pytest.mark.parametrize(("spans", "voussoirs", "rise"), [(1, 11, 0.9), (2, 11, 0.75), (2, 14, 0.9)])
def test_the_worst_position_is_not_a_local_one(spans, voussoirs, rise):
    """On one face a force moves linearly, 1 / load factor is convex: the worst place is an end of a face."""
    shape = {"rise": rise, "spans": spans, "voussoirs": voussoirs}
    own, ends = Bridge(**shape), []
    for k in range(spans):
        x = [own.point(k, 1, j)[0] for j in range(voussoirs + 1)]
        ends += [(k, at) for a, b in pairwise(x) for at in (a + 1e-6, b - 1e-6) if abs(at - 3.5 * k) < 1.2]
    least = min(load_factor(own, at, k) for k, at in ends)
    model = bridge(pier_width=0.5, pier_height=1.5, **shape)
    found = worst_position(model, Vehicle((1e3,), contact=1e-6), Deck(3.0, spread=0.0), positions=5)
    assert found.bounds.upper == pytest.approx(least, rel=1e-4)


def test_no_worse_position_where_an_axle_begins_or_ends_at_an_edge():
    """At x = -.6414 m a wheel has just left a stone: 3 % less than beside the halved parts."""
    model = arch_bridge(
        lb.PointContact(0.52), span=3.63, rise=1.22, thickness=0.43, voussoirs=13, spans=2, pier_width=0.95,
        pier_height=1.61, fill=Fill(0.49, 18e3), depth=2.75,
    )  # fmt: skip
    level = max(block.vertices[:, 2].max() for block in model.free_blocks) + 0.49
    lorry, deck = Vehicle((76.8e3, 65.4e3), (0.0, -1.72), contact=0.28), Deck(level)
    there = lb.bounds(replace(model, live=vehicle_load(model, lorry, deck, -0.6414)))
    found = worst_position(model, lorry, deck, positions=9)
    assert found.bounds.lower <= there.upper * (1 + 1e-3)


@pytest.mark.parametrize(("spread", "y"), [(0.0, None), (0.5, None), (0.2, 0.6)])
def test_the_power_of_a_vehicle_is_that_of_its_load(spread, y):
    """Over two spans and a pier beside the X axis, through rates of all kinds, where axles are partly beyond
    the blocks, and over a gap between them."""
    made, vehicle = bridge(spans=2, pier_width=0.5), Vehicle((60e3, 100e3), (0.0, 1.7))
    stones = [
        lb.Block(one.name, np.add(one.vertices, (0, 0.3, 0)), one.faces, 20e3)
        for one in made.blocks
        if one.name != "span 1 voussoir 8"
    ]
    model = replace(made, blocks=stones, interfaces=lb.find_interfaces(stones, JOINT))
    deck, rng = Deck(3.4, spread, y).on(model), np.random.default_rng(1)
    places, rates = np.linspace(-1.8, 3.6, 23), rng.normal(size=(len(model.blocks), 6))
    moving = rates[model.free]
    loads = [vehicle_load(model, vehicle, deck, x).on(model.free_blocks) for x in places.tolist()]
    line = line_of(model, vehicle, deck)
    wanted = [float(np.sum(load * moving)) for load in loads]
    assert line.powers(rates, line.standing(places)) == pytest.approx(np.array(wanted), rel=1e-9, abs=1e-6)


def test_fill_is_listed_as_fill_and_not_drawn(tmp_path):
    """Resistance of fill raises the load factor; pictures have no line of it, tables what presses."""
    model = bridge()
    fill = passive_fill(model, 1.3, unit_weight=20e3, coefficient=3.0)
    held = reinforced(model, *fill)
    assert lb.bounds(held).upper > 1.2 * lb.bounds(model).upper
    assert {one.interface.name for one in fill} <= {
        f"fill span 1 voussoir {k}|left abutment" for k in range(1, 16)
    }
    made = lb.report(held, lb.bounds(held))
    assert "tie-yield" not in made.html.split("<style")[0]
    assert "passive resistance of fill" in made.markdown
    again = lb.read(held.save(tmp_path / "held.json"))
    assert again.digest == held.digest


def test_a_stone_that_spans_the_width_feels_where_across_it_an_axle_is():
    """The moment about X is -P y; how much it takes of the load factor is a matter of the joint."""
    factors = {}
    for joint in (lb.PointContact(0.6), lb.OrdunaLourenco(0.6)):
        fill = Fill(height=0.3, unit_weight=18e3)
        model = arch_bridge(joint, span=3.0, rise=0.75, thickness=0.3, voussoirs=11, fill=fill, depth=2.0)
        road = max(block.vertices[:, 2].max() for block in model.free_blocks) + 0.3
        middle = np.mean([block.centroid[1] for block in model.free_blocks])
        for beside in (0.0, 0.9):
            load = vehicle_load(model, Vehicle((60e3,)), Deck(road, y=middle + beside), 1.051)
            forces = load.on(model.free_blocks)
            assert forces[:, 2].sum() == pytest.approx(-60e3)
            assert forces[:, 3].sum() == pytest.approx(-60e3 * beside, abs=1.0)
            factors[type(joint), beside] = lb.bounds(replace(model, live=load)).lower
    assert factors[lb.PointContact, 0.9] == pytest.approx(factors[lb.PointContact, 0.0], rel=1e-6)
    assert factors[lb.OrdunaLourenco, 0.9] < 0.9 * factors[lb.OrdunaLourenco, 0.0]

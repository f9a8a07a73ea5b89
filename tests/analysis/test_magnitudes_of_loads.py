"""Self weight and fill that are forgotten, given twice or on both sides of a wall are asked about."""

from dataclasses import replace

import pytest

import limitblocks as lb
from limitblocks import structures
from limitblocks.analysis.magnitudes import questions
from limitblocks.analysis.magnitudes_of_bridges import of_axles, of_passive


def block():
    return structures.block(lb.OrdunaLourenco(0.6), width=0.5, height=1.0, unit_weight=20e3)


@pytest.mark.parametrize(
    ("dead", "said"),
    [
        (lb.loads.fill(18e3, 1.5), "lacks the weight of block 'block 1', 1e+04 N: add self_weight()"),
        (lb.self_weight() - lb.self_weight(), "lacks the weight of block 'block 1'"),
        (lb.self_weight() + lb.self_weight(), "has 2 times the weight of block 'block 1', 1e+04 N"),
        (1.35 * (lb.self_weight() + 0.1 * lb.self_weight()), ""),
        (1.5 * lb.self_weight(), ""),
        (lb.loads.tilting((1, 0, 0)).at(1.5), ""),
        (lb.loads.force("block 1", (0, 0, -9.7e3), (0, 0, 0.5)), ""),  # the weight of a curved stone
    ],
)
def test_self_weight_that_is_forgotten_or_given_twice_is_asked_about(dead, said):
    """A block of .5 m x 1 m x 1 m and 20 kN/m3: 10 kN."""
    asked = questions(replace(block(), dead=dead))
    assert len(asked) == bool(said)
    assert not said or said in asked[0]


@pytest.mark.parametrize(
    ("to", "factor", "asked"),
    [
        ((0, 0, 1), 1.0, "(0, 0, 1)"),
        ((0, 0, -1), -1.0, "(0, 0, 1)"),
        ((0, -1, 0), 1.0, "(0, -1, 0)"),
        ((0.1, 0, -1), 1.0, ""),
    ],
)
def test_weights_that_do_not_act_downwards_are_asked_about(to, factor, asked):
    """Gravity with the wrong sign, or along Y as in a plane."""
    found = questions(replace(block(), dead=factor * lb.mass_proportional(to)))
    said = "the dead load has the weight of block 'block 1', 1e+04 N, along {}: meant? Down is (0, 0, -1)"
    assert found == [said.format(asked)] * bool(asked)


@pytest.mark.parametrize(
    ("dead", "live"),
    [
        (0.1 * lb.mass_proportional((1, 0, 0)), lb.self_weight()),
        (
            lb.loads.force("block 1", (0, 0, -10e3), (0, 0, 0.5)) + 0.1 * lb.mass_proportional((1, 0, 0)),
            lb.mass_proportional((1, 0, 0)),
        ),
    ],
    ids=["the weight grows", "the weight is a force"],
)
def test_a_push_beside_weights_that_another_load_has_is_not_asked_about(dead, live):
    assert questions(replace(block(), dead=dead, live=live)) == []


def test_axles_of_vehicles_far_from_each_other_are_not_asked_about():
    assert of_axles([60e3, 60e3, 60e3, 60e3], [0.0, 1.8, 60.0, 61.8]) == []


@pytest.mark.parametrize(
    ("degrees", "said"), [(30, "30 deg are 0.333, passive 3"), (45, "45 deg are 0.172, passive 5.83")]
)
def test_an_angle_for_a_coefficient_of_earth_pressure_is_asked_about(degrees, said):
    """Rankine: tan^2(45 -+ phi/2), 1/3 and 3 of 30 degrees."""
    asked = f"coefficient of earth pressure is {degrees}: degrees? {said} (Rankine)"
    dead = lb.self_weight() + lb.loads.fill(18e3, 1.5, earth_pressure=degrees)
    assert questions(replace(block(), dead=dead)) == of_passive(degrees) == [asked]
    assert of_passive(17.5) == []  # Caquot and Kerisel, 40 degrees on a rough wall
    assert of_passive(90) == ["coefficient of earth pressure is 90, more than of any soil"]


@pytest.mark.parametrize(
    ("level", "said"), [(301.0, "301 m is 300 m above"), (1500.0, "1500 m is 1499 m above"), (41, "")]
)
def test_fill_in_millimetres_is_asked_about(level, said):
    """On a block 1 m high: 300 mm over it, or up to 1500 mm."""
    asked = questions(replace(block(), dead=lb.self_weight() + lb.loads.fill(18e3, level)))
    assert asked == [f"fill up to Z = {said} the structure: millimetres? see units"] * bool(said)


def test_weights_given_as_forces_are_not_forgotten_where_one_is_left_out():
    """A block of soil that the load factor moves, say, beside a wall of 20 kN."""
    model = lb.structures.column(lb.PointContact(0.6), count=2, width=1.0, height=1.0)
    weight = lb.loads.force("block 1", (0, 0, -model.free_blocks[0].weight), (0, 0, 0.5))
    assert questions(replace(model, dead=weight)) == []


@pytest.mark.parametrize(
    ("factor", "lacks"),
    [(0.01, True), (0.5, True), (0.9, False), (1.0, False), (1.35, False), (1.5, False), (2.0, True)],
)
def test_weights_given_as_forces_with_a_partial_factor_are_not_forgotten(factor, lacks):
    model = block()
    (own,) = model.free_blocks
    weight = factor * lb.loads.force(own.name, (0, 0, -own.weight), own.centroid.tolist())
    asked = questions(replace(model, dead=weight))
    assert any("lacks the weight" in one for one in asked) == lacks


def test_self_weight_that_the_load_factor_multiplies_is_not_forgotten():
    held = lb.loads.force("block 1", (5e3, 0, 0), (0, 0, 0.5))
    assert questions(replace(block(), dead=held, live=lb.mass_proportional((0, 0, -1)))) == []


@pytest.mark.parametrize(
    ("more", "asked"),
    [
        (lb.loads.fill(18e3, 2.5), 1),
        (lb.loads.fill(18e3, 2.5004), 1),  # rounded to a millimetre
        (lb.loads.fill(20e3, 2.5, blocks=["voussoir 1", "voussoir 2"]), 1),
        (lb.loads.fill(3e3, 2.3), 0),  # a heavier layer below
        (lb.loads.fill(3e3, 2.5), 0),  # water in it: 21 kN/m3
        (0.35 * lb.loads.fill(18e3, 2.5), 0),  # what a partial factor adds
        (lb.loads.fill(13e3, 2.5), 1),  # 31 kN/m3: heavier than concrete
        (lb.loads.fill(5e3 / 0.5, 3.0) - lb.loads.fill(5e3 / 0.5, 2.5), 0),  # a surcharge of 5 kN/m2
        (-1.0 * lb.loads.fill(18e3, 2.5, blocks="voussoir 1"), 0),
    ],
)
def test_fill_given_twice_is_asked_about(more, asked):
    """Up to .3 m above the crown of a ring of 2 m and .4 m: 2.5 m."""
    model = structures.arch(lb.PointContact(0.7), radius=2.0, thickness=0.4, voussoirs=8, fill=(0.3, 18e3))
    said = questions(replace(model, dead=model.dead + more))
    assert len(said) == asked
    assert all("Z = 2.5 m on blocks 'voussoir 1', 'voussoir 2'" in one for one in said)


@pytest.mark.parametrize(("weights", "asked"), [((5e3, 5e3), 1), ((18e3, 3e3), 0), ((18e3, 18e3), 1)])
@pytest.mark.parametrize("gamma_G", [1.0, 1.5])
def test_parts_of_one_fill_are_not_asked_about_whatever_factor_both_have(weights, asked, gamma_G):
    model = block()
    dead = model.dead + sum(lb.loads.fill(one, 2.0) for one in weights)
    assert len(questions(replace(model, dead=gamma_G * dead))) == asked


@pytest.mark.parametrize("batter", [0.0, 1e-3, 0.5])
def test_fill_on_both_sides_of_a_wall_is_asked_about(batter):
    """K gamma h2 / 2 of 2 m on each side of a wall whose front leans, too; none where it ends there."""
    wall = lb.Block.prism("wall", [(-1, 0), (1, 0), (1 - batter, 2), (-0.5, 2)], (-1, 1), 23e3)
    blocks = [lb.Block.box("ground", (6, 3, 0.5), (0, 0, -0.25)), wall]
    live, found = lb.mass_proportional((1, 0, 0)), lb.find_interfaces(blocks, lb.PointContact(0.6))
    for side in ({}, {"beyond": (0, 0), "towards": (-1, 0, 0)}):
        dead = lb.self_weight() + lb.loads.fill(18e3, 2.0, earth_pressure=0.33, **side)
        asked = questions(lb.Model(blocks, ["ground"], found, dead, live))
        assert len(asked) == (batter > 0.0 and not side)
        assert not asked or asked[0].startswith(
            "fill presses block 'wall' from both sides, where 23.76 kN of its earth pressure cancel"
        )


@pytest.mark.parametrize(
    ("beyond", "towards", "asked"),
    [((0.25, 7), (2, 0, 0), 1), ((0.3, 0), (1, 0, 0), 0), ((0.25, 0), (-1, 0, 0), 0), (None, None, 0)],
)
def test_fill_twice_beyond_one_plane_is_asked_about_wherever_on_it_its_place_is(beyond, towards, asked):
    """On a block from x = 0 to .5 m."""
    model = block()
    fills = (
        lb.loads.fill(18e3, 2.0, beyond=at, towards=to)
        for at, to in (((0.25, 0), (1, 0, 0)), (beyond, towards))
    )
    said = questions(replace(model, dead=sum(fills, model.dead)))
    assert ["twice" in one for one in said] == [True] * asked


@pytest.mark.parametrize("name", ["arch", "arch, five facets", "dome", "two spans"])
def test_fill_over_a_vault_is_on_both_sides_of_it(name):
    joint, ring = lb.PointContact(0.6), {"thickness": 0.3, "voussoirs": 5}
    model = {
        "arch": lambda: structures.arch(joint, radius=2.0, **ring),
        "arch, five facets": lambda: structures.arch(joint, radius=2.0, facets=5, **ring),
        "dome": lambda: structures.dome(joint, radius=2.0, thickness=0.4, courses=3, stones=6),
        "two spans": lambda: structures.arch_bridge(
            joint, span=3.0, rise=0.7, spans=2, pier_width=0.7, pier_height=1.0, **ring
        ),
    }[name]()
    for level in (1.5, 5.0):
        load = lb.loads.fill(18e3, level, earth_pressure=0.33)
        assert questions(replace(model, dead=model.dead + load)) == []

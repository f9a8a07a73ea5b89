"""Misuse of practice is one line that names the thing, its value and what would be right."""

from dataclasses import replace

import facades
import pytest

import limitblocks as lb
from limitblocks.joints import Backfill, Tie
from limitblocks.practice import (
    Deck,
    Element,
    Floor,
    FloorMode,
    PartialFactors,
    Rocking,
    Spectrum,
    Vehicle,
    adequacy,
    capacity_curve,
    dowel,
    element_acceleration,
    least_masses,
    least_ties,
    passive_fill,
    reinforced,
    settlement,
    settlement_to_collapse,
    strip,
    tie,
    uplift,
    vehicle_load,
    verification,
    worst_position,
)

NAN = float("nan")
SITE = Spectrum(2.0, 1.2, 2.5, 0.5)
MODE = FloorMode(0.4, 1.2, 1.0)
CAR = Vehicle((1e3,))
LEFT = lb.Block.box("left", (1.0, 1.0, 1.0), (-4.0, 0.0, 0.5), 20e3)
PULL = lb.loads.force("wall", (1e3, 0, 0), at=(0, 0, 5))


def rod(**more):
    return tie("ground", (3, 0, 0), "wall", (0, 0, 4), **{"area": 1e-4, "strength": 2e8} | more)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"q": 0.5}, "q is 0.5, expected a finite number >= 1"),
        ({"q": NAN}, "q is nan, expected a finite number >= 1"),
        ({"confidence": 0.9}, "FC is 0.9, expected a finite number >= 1"),
        ({"demand": None}, "demand is a NoneType, expected Spectrum"),
        ({"demand": (2.0, 1.2, 2.5, 0.5)}, "demand is a tuple, expected Spectrum"),
        ({"demand": Spectrum(245.0, 1.2, 2.5, 0.5)}, "a_g is 245 m/s2, 25 g; expected at most 2 g"),
        ({"curve": "curve.json"}, "curve is a str, expected CapacityCurve"),
        ({"floor": MODE}, "floor is a FloorMode, expected Floor"),
        ({"confidence": 13.5}, "FC is 13.5, expected a finite number >= 1 and <= 2"),
        ({"damping": 0.05}, "damping, at SLV and at SLC, is 0.05, expected two finite numbers"),
        ({"damping": (0.08, NAN)}, "damping, at SLV and at SLC, is (0.08, nan), expected two finite numbers"),
        ({"damping": ([1], 2)}, "damping, at SLV and at SLC, is ([1], 2), expected two finite numbers"),
        ({"elastic_period": -1.0}, "T_0 is -1.0, expected a finite number >= 0 and <= 10 in s"),
        ({"elastic_period": 150.0}, "T_0 is 150.0, expected a finite number >= 0 and <= 10 in s"),  # of ms
    ],
)  # fmt: skip
def test_verification(facade, answer, given, words):
    settings = {"demand": SITE, "q": 2.0} | given
    with pytest.raises(lb.ModelError) as caught:
        verification(facade, answer, settings.pop("demand"), **settings)
    assert str(caught.value).startswith(words)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("live", "words"),
    [
        (PULL, "the live load has a PointForce; expected weights and added masses"),
        (2.0 * lb.mass_proportional((1, 0, 0)), "the live load has the weights times 2; expected 1"),
        (
            lb.mass_proportional((0.6, 0, -0.8)),
            "the live load acts along (0.6, 0, -0.8); expected one horizontal",
        ),
    ],
)
def test_verification_of_other_loads(facade, live, words):
    pushed = replace(facade, dead=lb.self_weight(), live=live)
    with pytest.raises(lb.ModelError) as caught:
        verification(pushed, lb.nonassociated(pushed), SITE, q=2.0)
    assert str(caught.value).startswith(words)


@pytest.mark.parametrize(
    ("misuse", "words"),
    [
        (lambda wall: settlement("m.json", "right", (0, 0, -1)), "model is a str, expected a Model"),
        (lambda wall: reinforced(wall, "rod"), "what a structure is reinforced with is a str, exp"),
        (lambda wall: reinforced(wall, [rod()]),
         "what a structure is reinforced with is a list, expected Element, as of tie, strip or dowel; "
         "several are given one by one: reinforced(model, *elements)"),
        (lambda wall: reinforced(wall, tie("Wall", (0, 0, 4), "ground", (3, 0, 0), area=1e-4, strength=2e8)),
         "tie Wall|ground: 'Wall' is not a block of the model; did you mean 'wall'?"),
        (lambda wall: tie(wall.blocks[1], (0, 0, 4), "ground", (3, 0, 0), area=1e-4, strength=2e8),
         "name of a block that a tie joins is a Block, expected str"),
        (lambda wall: tie("wall", (0, 0, 4.5), "ground", (1e-12, 0, 4.5), area=1e-4, strength=2e8),
         "tie wall|ground: both anchors are at [0.0, 0.0, 4.5]; a tie needs a length"),
        (lambda wall: Element("wall"), "interface of an element is a str, expected Interface"),
        (lambda wall: strip(rod().interface, (0, 0, 4), width=0.1, capacity=1.0),
         "strip across tie ground|wall: expected a joint in which two blocks touch"),
        (lambda wall: dowel(rod().interface, (0, 0, 4), diameter=0.1, capacity=1.0),
         "dowel across tie ground|wall: expected a joint in which two blocks touch"),
        (lambda wall: tie("a", (0, 0, 0), "a", (1, 0, 0), area=1, strength=1),
         "tie a|a: both ends are in block 'a'; a tie joins two blocks"),
        (lambda wall: rod(strength=-1.0), "tie ground|wall: strength is -1.0, expected a finite number"),
        (lambda wall: rod(area=0.0), "tie ground|wall: area is 0.0, expected a finite number"),
        (lambda wall: rod(pull_out=-8e3), "tie ground|wall: pull_out is -8000.0, expected a finite number"),
        (lambda wall: rod(pull_out="8e3"), "tie ground|wall: pull_out is '8e3', expected a finite number"),
        (lambda wall: rod(pull_out=8e3, prestress=9e3),
         "tie ground|wall: prestress is 9000 N, expected 0 to less than the 8000 N it can carry"),
        (lambda wall: rod(number_of=0), "tie ground|wall: number_of is 0, expected a whole number"),
        (lambda wall: Tie(-1.0), "strength of a tie is -1.0 Pa, expected a finite stress > 0"),
        (lambda wall: Tie(1.0, 1.0, 2.0),
         "prestress of a tie is 2.0 Pa, expected 0 to less than its strength, 1 Pa"),
        (lambda wall: rod(prestress=True), "tie ground|wall: prestress is True, expected a finite"),
        (lambda wall: dowel("a|b", (0, 0, 0), diameter=0.02, capacity=1.0), "interface of a dowel is a str"),
        (lambda wall: dowel(wall.interfaces[0], (9, 9, 9), diameter=0.02, capacity=1.0),
         "dowel across ground|wall: at is [9.0, 9.0, 9.0], not on the joint"),
        (lambda wall: strip(wall.interfaces[0], (-250, 0, 0), width=0.1, capacity=1.0),
         "strip across ground|wall: at is [-250.0, 0.0, 0.0], not on the joint"),
        (lambda wall: reinforced(replace(wall, supports=["ground", "left"], blocks=[*wall.blocks, LEFT]),
                                 tie("left", (-4, 0, 1), "ground", (0, 0, 0), area=1e-4, strength=2e8)),
         "tie left|ground: both ends are in supports, which do not move"),
        (lambda wall: least_ties(wall, [rod(prestress=1e3)], 0.3),
         "candidate tie ground|wall has a prestress of 1000 N, expected none"),
        (lambda wall: least_ties(wall, [dowel(wall.interfaces[0], (0, 0, 0), diameter=1, capacity=1)], 1),
         "candidate dowel ground|wall is no tie or strip"),
        (lambda wall: least_ties(wall, [Element(replace(wall.interfaces[0], joint=Backfill(1e3)))], 1),
         "candidate fill ground|wall is no tie or strip"),
        (lambda wall: least_ties(wall, 5, 0.3), "candidates is 5, expected a sequence of Element"),
        (lambda wall: least_masses(wall, [5], 0.3), "places are [5], expected a block and a point each"),
        (lambda wall: least_masses(wall, ("wall", (0, 0, 2)), 0.3), "places are ('wall', (0, 0, 2)), exp"),
        (lambda wall: least_masses(wall, [("wall", (0, 2))], 0.3),
         "place on block 'wall': at is (0, 2), expected three finite numbers"),
        (lambda wall: least_masses("m.json", [("wall", (0, 0, 2))], 0.3), "model is a str, expected a Model"),
        (lambda wall: capacity_curve("m.json"), "model is a str, expected a Model"),
        (lambda wall: settlement_to_collapse("m.json", "ground", (0, 0, -1)), "model is a str, expected"),
        (lambda wall: reinforced("m.json", rod()), "model is a str, expected a Model"),
        (lambda wall: adequacy("m.json", PartialFactors(1, 1, 1)), "model is a str, expected a Model"),
        (lambda wall: uplift("m.json", 1.0), "model is a str, expected a Model"),
        (lambda wall: passive_fill("m.json", 5.0, unit_weight=18e3, coefficient=3.0),
         "model is a str, expected a Model"),
        (lambda wall: least_ties(wall, [], 0.3), "least_ties needs at least one tie to choose from"),
        (lambda wall: least_masses(replace(wall, live=PULL), [("wall", (0, 0, 2))], 0.3),
         "least_masses needs a live load with one mass-proportional term, once; it has none"),
        (lambda wall: least_masses(replace(wall, live=2.0 * wall.live), [("wall", (0, 0, 2))], 0.3),
         "least_masses needs a live load with one mass-proportional term, once; it has 2 times it"),
        (lambda wall: settlement(replace(wall, supports=["ground", "left"], blocks=[*wall.blocks, LEFT],
                                         dead=0.0 * lb.self_weight()), "ground", (0, 0, -1)),
         "settlement: the dead loads are zero; there is no reaction to lose"),
        (lambda wall: Floor(()), "a floor spectrum needs at least one mode of the building"),
        (lambda wall: Floor((0.4,)), "modes of the building holds 0.4, expected a sequence of FloorMode"),
        (lambda wall: Floor(MODE), "modes of the building is FloorMode(period=0.4"),
        (lambda wall: FloorMode(300.0, 1.3, 1.0),
         "period of a mode is 300.0, expected a finite number > 0 and <= 10 in s"),  # of ms
        (lambda wall: FloorMode(0.3, 1.3, 1.0, 5.0),
         "damping of a mode is 5.0, expected a finite number > 0 and <= 0.3"),  # of per cent
        (lambda wall: SITE.displacement(1.0, 8.0), "damping is 8.0, expected a finite number >= 0 and <="),
        (lambda wall: FloorMode.first(0.4, 2.5, 1.0), "storeys is 2.5, expected a whole number"),
        (lambda wall: SITE.acceleration(-1.0), "period is -1.0, expected a finite number >= 0 in s"),
        (lambda wall: SITE.displacement(NAN), "period is nan, expected a finite number >= 0 in s"),
        (lambda wall: Floor((MODE,)).acceleration(SITE, NAN), "period is nan, expected a finite number >= 0"),
        (lambda wall: Floor((MODE,), a=1.5, b=0.5), "a is 1.5 and b is 0.5, expected 0 < a <= b"),
        (lambda wall: Vehicle(1e3), "axles are 1000.0 at (0.0,), expected a list of N"),
        (lambda wall: vehicle_load("m.json", CAR, Deck(5.0), 0.0), "model is a str, expected a Model"),
        (lambda wall: worst_position("m.json", CAR, Deck(5.0, y=0.0)), "model is a str, expected a Model"),
        (lambda wall: Vehicle((1.0, 2.0), (0.0,)), "a vehicle of 2 axles has 1 distance, expected one for"),
        (lambda wall: Vehicle((-1.0,)), "axle load is -1.0, expected a finite number > 0 in N"),
        (lambda wall: Deck(1.0, spread=-1.0), "spread is -1.0, expected a finite number >= 0"),
        (lambda wall: Deck(1.0, y=NAN), "line y of the deck is nan"),
        (lambda wall: vehicle_load(wall, CAR, Deck(-5.0), 0.0), "the road at -5 m is below the structure"),
        (lambda wall: vehicle_load(wall, CAR, Deck(4.99), 0.0), "the road at 4.99 m is below the structure"),
        (lambda wall: vehicle_load(wall, CAR, Deck(5.0), NAN), "position is nan"),
        (lambda wall: worst_position(wall, (1e3,), Deck(5.0)), "vehicle is a tuple, expected Vehicle"),
        (lambda wall: worst_position(wall, CAR, Deck(5.0), (1.0,)), "between, X of the first axle, is (1"),
        (lambda wall: worst_position(wall, CAR, Deck(5.0), (0.0, [1.5])), "between, X of the first axle,"),
        (lambda wall: worst_position(wall, CAR, Deck(5.0), (2.0, 1.0)),
         "between 2 and 1 m in 25 positions there is nothing to search"),
        (lambda wall: worst_position(wall, CAR, Deck(5.0), (4.2, 5.0), positions=3),
         "with the first axle between 4.2 and 5 m the vehicle stands off the structure"),
        (lambda wall: worst_position(wall, CAR, Deck(5.0), positions=2), "positions is 2, expected"),
        (lambda wall: uplift(wall, 1.0, share=2.0),
         "share of the water pressure is 2.0, expected a finite number > 0 and <= 1"),
        (lambda wall: uplift(wall, -1.0, interfaces=wall.interfaces),
         "interface ground|wall lies above the water at -1 m"),
        (lambda wall: uplift(wall, NAN), "level of the water is nan"),
        (lambda wall: uplift(wall, 1.0, interfaces=2 * [*wall.interfaces]),
         "interface ground|wall is given twice, expected once"),
        (lambda wall: uplift(wall, -0.5), "no joint reaches below the water at -0.5 m; the lowest at 0 m"),
        (lambda wall: uplift(wall, 1.0, interfaces=wall.interfaces[0]), "interfaces is <interface 'ground"),
        (lambda wall: uplift(wall, 1.0, interfaces=["ground|wall"]), "interfaces holds 'ground|wall'"),
        (lambda wall: passive_fill(wall, 9.0, unit_weight=1.0, coefficient=1.0),
         "no block has a face that leans along the deck below the fill at 9 m"),
        (lambda wall: passive_fill(wall, 8.0, unit_weight=18e3, coefficient=3.0, blocks="wall"),
         "blocks is 'wall', expected a sequence of str"),
        (lambda wall: passive_fill(wall, 8.0, unit_weight=18e3, coefficient=3.0, along=(0, 0, 1)),
         "direction along the deck is (0.0, 0.0, 1.0), expected a horizontal direction"),
        (lambda wall: Vehicle((1e3, 2e3), (1.0, 2.5)), "the first axle is 1 m from itself, expected 0"),
        (lambda wall: adequacy(wall, 1.5), "factors is a float, expected PartialFactors"),
        (lambda wall: PartialFactors(1.35, -1.5, 2.0), "gamma_Q is -1.5, expected a finite number > 0"),
        (lambda wall: PartialFactors(1.35, 1.5, 0.0), "gamma_M is 0.0, expected a finite number > 0"),
        (lambda wall: adequacy(reinforced(wall, rod()), PartialFactors(1.0, 1.0, 1.0)),
         "the model has ties, dowels or passive fill: give gamma_S"),
        (lambda wall: PartialFactors(None, 1.5, 1.0), "gamma_G is None, expected a finite number > 0"),
        (lambda wall: PartialFactors(135, 150, 220), "gamma_G is 135, expected a finite number > 0 and <= 1"),
        (lambda wall: adequacy(reinforced(wall, rod(prestress=15e3)), PartialFactors(1.35, 1, 1, 1, 1.15)),
         "tie with a prestress of 150 MPa: times gamma_G 1.35 it is not below the strength 200 MPa over gam"),
        (lambda wall: capacity_curve(wall, steps=1), "steps is 1, expected a whole number of at least 2"),
        (lambda wall: capacity_curve(wall, largest=0.0), "largest is 0.0, expected a displacement > 0 in m"),
        (lambda wall: capacity_curve(wall, control=("stone", (0, 0, 0))),
         "control block 'stone' is not a block of the model"),
        (lambda wall: capacity_curve(wall, control=("ground", (0, 0, 0))),
         "the control point of block 'ground' does not move along the live load; choose a block and a point"),
        (lambda wall: capacity_curve(wall, largest="1"), "largest is '1', expected a displacement > 0 in m"),
        (lambda wall: capacity_curve(wall, control=("wall", (50, 0, 1))),
         "control point (50, 0, 1) is not on block 'wall', which reaches from (-0.25, -0.5, 0) to"),
        (lambda wall: capacity_curve(wall, control="12"), "control is '12', expected a block and a point"),
        (lambda wall: capacity_curve(wall, control=([1], 2)), "control is ([1], 2), expected a block and a"),
        (lambda wall: verification("m.json", lb.nonassociated(wall), SITE, q=2.0), "model is a str, exp"),
        (lambda wall: capacity_curve(replace(wall, live=lb.loads.moment("wall", (0, 1e3, 0)))),
         "the live loads add up to no force; a capacity curve needs a direction"),
        (lambda wall: Spectrum(2.0, 1.2, 1.0, 0.5), "F0 is 1.0, expected a finite number >= 2.2 and <= 10"),
        (lambda wall: Spectrum(2.45, 1.2, 2.5, 500.0),
         "T_C is 500.0, expected a finite number > 0 and <= 1.6 in s"),
        (lambda wall: Spectrum(-0.2 * 9.81, 1.2, 2.5, 0.5),
         "a_g is -1.962, expected a finite number > 0 in m/s2"),
        (lambda wall: settlement(wall, "post", (0, 0, -1)),
         "settlement: 'post' is not a block of the model; expected one of the supports 'ground'"),
        (lambda wall: settlement(facades.beam(), "right", (0, 0, 0)),
         "settlement of 'right': direction is (0, 0, 0), expected a non-zero vector"),
        (lambda wall: settlement(wall, "wall", (0, 0, -1)),
         "settlement: 'wall' is a free block; expected one of the supports 'ground'"),
        (lambda wall: replace(wall, supports=["ground", "ground"]),
         "support 'ground' is named 2 times; once is enough"),
        (lambda wall: settlement_to_collapse(wall, "ground", (0, 0, -1), step="1 cm"),
         "step is '1 cm', expected a finite number > 0 in m"),
        (lambda wall: settlement_to_collapse(wall, "ground", (0, 0, -1), accuracy=-1.0),
         "accuracy is -1.0, expected a finite number > 0 in m"),
        (lambda wall: settlement_to_collapse(wall, "ground", (0, 0, -1), largest=0.0),
         "largest is 0.0, expected a settlement > 0 in m"),
        (lambda wall: Rocking(1.0, 0.0), "height is 0.0, expected a finite number > 0 in m"),
        (lambda wall: Rocking(1.0, 2.0).period(1.0),
         "amplitude is 1.0 of the slenderness, expected 0 to less than 1"),
        (lambda wall: element_acceleration(
            0.2, 1.0, z=9.0, height=3.0, element_period=0, building_period=1
         ), "height of the element is 9.0 m, above the building of 3.0 m"),
        (lambda wall: Rocking(0.2, 1.0).period("a"), "amplitude is 'a', expected a finite number"),
    ],
)  # fmt: skip
def test_arguments(facade, misuse, words):
    with pytest.raises(lb.LimitBlocksError) as caught:
        misuse(facade)
    assert str(caught.value).startswith(words)
    assert "\n" not in str(caught.value)


def test_what_slides_freely_has_no_capacity_to_verify():
    """scipy found no ground acceleration that sets it off."""
    model = lb.structures.block(lb.OrdunaLourenco(0.0), width=0.5, height=1.0)
    result = lb.nonassociated(model)
    linear = verification(model, result, SITE, q=2.0)
    assert (linear.checks[0].satisfied, linear["a_g,SLD"]) == (False, 0.0)
    with pytest.raises(lb.errors.ModelError, match="meets no resistance"):
        verification(model, result, SITE, q=2.0, curve=capacity_curve(model))
